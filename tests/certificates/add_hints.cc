// SPDX-License-Identifier: GPL-3.0-or-later
// Says how the kernel proves what a certificate of the tests states. expand.py gives it certificates that lack only
// that, one on each line, and gets them back in order.
//
// A box of a segment becomes one or more boxes that the kernel proves at one go. Where it proves none, because what
// the certificate states is false, the box stays as it is, and has hints that would do if it were true. What is
// malformed is left alone.
#include <algorithm>
#include <array>
#include <iostream>
#include <map>
#include <memory>
#include <string>

#include "certificate/implied_motion.h"
#include "checker/format/reader.h"
#include "checker/format/writer.h"
#include "checker/kernel/box_proof.h"
#include "checker/near_waypoints.h"
#include "checker/witness.h"

namespace taut {
namespace {

using checker::Box;
using nlohmann::json;

constexpr std::array<int, 5> kBits = {64, 128, 256, 512, 1024};
constexpr std::size_t kRungs = 4;  ///< of parts, where there are tolerances

class Hints {
 public:
  explicit Hints(const std::string& text) : certificate_(checker::read_certificate(text)), result_(json::parse(text)) {}

  json add() {
    for (std::size_t k = 0; k < certificate_.segment_texts.size(); ++k) {
      const checker::Segment segment = certificate_.segment(k);
      json boxes = json::array();
      for (std::size_t i = 0; i < segment.boxes.size(); ++i) {
        apart_ = segment.apart_of(i);
        const auto proves = [&](Box& part, std::size_t rung) { return prove(k, segment.margins, part, rung); };
        for (const Box& part : cover(k, segment.boxes[i], proves)) {
          boxes.push_back(to_json(part, has_tolerances()));
          if (!segment.changes[i].empty()) boxes.back()["apart"] = checker::apart_to_json(segment.changes[i]);
        }
      }
      result_["segments"][k]["boxes"] = std::move(boxes);
    }
    if (certificate_.witness) add_to(result_["witness"], *certificate_.witness, true);
    for (std::size_t i = 0; i < certificate_.stretch_texts.size(); ++i) {
      const checker::Stretch stretch = certificate_.stretch(i);
      for (std::size_t j = 0; j < stretch.inner.size(); ++j) {
        add_to(result_["stretches"][i]["inner"][j], stretch.inner[j], false);
      }
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] const checker::Problem& problem() const { return certificate_.problem; }
  [[nodiscard]] const checker::Path& path() const { return certificate_.path; }
  [[nodiscard]] bool has_tolerances() const { return problem().tolerances.has_value(); }
  [[nodiscard]] bool is_implied() const { return checker::is_implied(problem(), path()); }

  /// @pre `bits` are the working precision
  const checker::Machine& machine(int bits) {
    std::unique_ptr<checker::Machine>& result = machines_[bits];
    if (result == nullptr) result = std::make_unique<checker::Machine>(problem());
    return *result;
  }

  /// Whether there is a pose to state the box by; if not, the box keeps what it had.
  bool place(std::size_t k, Box& box) {
    if (!is_implied()) return true;
    const auto near = find_motion(machine(box.bits), problem(), path(), k, box);
    if (near) box.near = near;
    return near.has_value();
  }

  /// Looks for hints of this rung with which the kernel proves the box, with these margins. Leaves what it tried.
  bool prove(std::size_t k, const checker::Margins& margins, Box& box, std::size_t rung) {
    if (!has_tolerances()) return at_some_precision(k, box, [&] { return is_proved(k, margins, box); });
    constexpr std::array<int, kRungs> kParts = {1, 4, 16, 64};
    constexpr std::array<int, 3> kGuesses = {1, 3, 12};
    box.parts = kParts[rung];
    return std::ranges::any_of(kGuesses, [&](int guesses) {
      box.guesses = guesses;
      return is_proved(k, margins, box);
    });
  }

  /// If not, the box is stated at the least precision.
  template <class Holds>
  bool at_some_precision(std::size_t k, Box& box, const Holds& holds) {
    const Box before = box;
    for (const int bits : kBits) {
      box = before;
      box.bits = bits;
      if (holds()) return true;
    }
    box = before;
    (void)is_true([&] {
      const checker::WorkingPrecision precision(box.bits);
      return place(k, box);
    });
    return false;
  }

  bool is_proved(std::size_t k, const checker::Margins& margins, Box& box) {
    work_ += box.parts * box.guesses;
    return is_true([&] {
      const checker::WorkingPrecision precision(box.bits);
      const checker::Machine& machine = this->machine(box.bits);
      if (!place(k, box)) return false;
      const checker::Bounds bounds = prove_box(machine, problem(), path(), k, box, apart_);
      require_near_waypoints(machine, problem(), path(), k, box);
      const auto is_kept = [](const checker::Ball& bound, const mpq_class& claimed) {
        return certainly_nonnegative(bound - checker::Ball(claimed));
      };
      return is_kept(bounds.tension, margins.tension) && is_kept(bounds.length, margins.length) &&
             is_kept(bounds.wrench_scale, margins.wrench_scale) &&
             (!bounds.clearance || is_kept(*bounds.clearance, margins.clearance));
    });
  }

  bool show_motion(std::size_t k, Box& box) {
    return at_some_precision(k, box, [&] {
      ++work_;
      return is_true([&] {
        const checker::WorkingPrecision precision(box.bits);
        if (!place(k, box)) return false;
        (void)commanded_geometry(machine(box.bits), problem(), path(), k, box);
        require_near_waypoints(machine(box.bits), problem(), path(), k, box);
        return true;
      });
    });
  }

  template <class Statement>
  static bool is_true(const Statement& statement) {
    try {
      return statement();
    } catch (const checker::Undefined&) {
      return false;
    } catch (const checker::Rejected&) {
      return false;
    }
  }

  struct Task {
    Box box;
    std::size_t rung = 0;
    int halvings = 0;
  };

  /// Parts of the box, halved where `proves(box, rung)` holds of a midpoint but not of all of a box. Where it does not
  /// even hold of a midpoint, at any rung, what is left is stated as it is.
  template <class Proves>
  std::vector<Box> cover(std::size_t k, const Box& whole, const Proves& proves) {
    constexpr int kMostWork = 5000;
    constexpr int kMostHalvings = 16;  ///< on one rung
    std::vector<Box> result;
    std::vector<Task> open = {{whole}};
    if (k < path().inner_poses.size()) {
      for (const checker::InnerPose& inner : path().inner_poses[k]) {
        if (inner.s <= open.back().box.begin || inner.s >= open.back().box.end) continue;
        open.push_back(open.back());
        open[open.size() - 2].box.end = open.back().box.begin = inner.s;
      }
      std::ranges::reverse(open);
    }
    work_ = 0;
    while (!open.empty()) {
      Task task = open.back();
      open.pop_back();
      Box box = task.box;
      if (proves(box, task.rung)) {
        result.push_back(box);
        continue;
      }
      const mpq_class middle = (box.begin + box.end) / 2;
      Box point = task.box;
      point.begin = point.end = middle;
      if (gave_up_ || work_ > kMostWork) {
        gave_up_ = true;
        result.push_back(box);
      } else if (task.halvings < kMostHalvings && proves(point, task.rung)) {
        ++task.halvings;
        open.push_back(task);
        open.back().box.begin = middle;
        open.push_back(task);
        open.back().box.end = middle;
      } else if (has_tolerances() && task.rung + 1 < kRungs) {
        ++task.rung;
        task.halvings = 0;
        open.push_back(task);
      } else {
        gave_up_ = true;
        box = task.box;
        (void)proves(box, 0);  // to state it as it would be if it were true
        result.push_back(box);
      }
    }
    return result;
  }

  void add_to(json& written, checker::Witness witness, bool is_of_path) {
    const auto is_before = [](const checker::PathPoint& a, const checker::PathPoint& b) {
      return a.segment != b.segment ? a.segment < b.segment : a.s < b.s;
    };
    checker::PathPoint first = witness.at;
    checker::PathPoint last = witness.at;
    if (witness.kind == checker::WitnessKind::kSingular) {
      place_both(witness);
      written["at_proof"] = proof_to_json(witness.at_box);
      written["to_proof"] = proof_to_json(witness.to_box);
      (is_before(witness.to, witness.at) ? first : last) = witness.to;
    } else {
      place_violation(witness);
      written["proof"] = proof_to_json(witness.at_box);
      if (written.contains("deviation") && written["deviation"].contains("way")) {
        written["deviation"]["way"] = way_to_json(*witness.deviation);
      }
    }
    if (is_implied() && is_of_path) first = {0, 0};
    json motion = json::array();
    for (std::size_t k = first.segment; path().segments() > 0 && k <= last.segment; ++k) {
      Box box;
      box.begin = k == first.segment ? first.s : mpq_class(0);
      box.end = k == last.segment ? last.s : mpq_class(1);
      if (box.begin == box.end) continue;
      box.near = witness.at_box.near;
      for (Box& part : cover(k, box, [&](Box&tried, std::size_t) { return show_motion(k, tried); })) {
        motion.push_back(to_json(checker::MotionBox{k, std::move(part)}));
      }
    }
    written["motion"] = std::move(motion);
  }

  void place_both(checker::Witness& witness) {
    for (const auto& end : {std::pair(witness.at, &witness.at_box), std::pair(witness.to, &witness.to_box)}) {
      const auto& point = end.first;
      Box* const box = end.second;
      for (const int bits : kBits) {
        Box tried = *box;
        tried.bits = bits;
        const bool holds = is_true([&] {
          const checker::WorkingPrecision precision(bits);
          if (!place(point.segment, tried)) return false;
          if (bits == kBits[0]) *box = tried;
          return !contains_zero(determinant_at(machine(bits), problem(), path(), point, tried));
        });
        if (!holds) continue;
        *box = tried;
        break;
      }
    }
  }

  static bool contains_zero(const checker::Ball& x) { return !certainly_positive(x) && !certainly_negative(x); }

  /// A way that stays at the commanded pose: for a deviation that leads nowhere.
  static void stay(checker::Witness& witness, const checker::Witness& at) {
    witness.at_box = at.at_box;
    for (checker::InnerPose& pose : witness.deviation->poses) pose.x = at.deviation->poses.front().x;
  }

  void place_violation(checker::Witness& witness) {
    bool is_first = true;
    for (const int bits : kBits) {
      checker::Witness tried = witness;
      tried.at_box.bits = bits;
      const bool holds = is_true([&] {
        const checker::WorkingPrecision precision(bits);
        const checker::Machine& machine = this->machine(bits);
        if (!place(witness.at.segment, tried.at_box)) return false;
        if (tried.deviation && !tried.deviation->boxes.empty()) {
          const checker::Geometry stated =
              commanded_geometry(machine, problem(), path(), witness.at.segment, tried.at_box);
          const Model<double> model = make_model<double>(problem_from_json(result_["problem"]));
          if (!find_way(machine, stated, model, *tried.deviation, bits)) {
            if (is_first && !tried.deviation->poses.empty()) stay(witness, tried);
            return false;
          }
        }
        if (is_first) witness = tried;
        is_first = false;
        if (tried.kind == checker::WitnessKind::kContact) {
          confirm_contact(machine, problem(), path(), tried);
        } else {
          confirm_violation(machine, problem(), path(), tried);
        }
        return true;
      });
      if (!holds) continue;
      witness = tried;
      return;
    }
  }

  checker::Certificate certificate_;
  json result_;
  std::map<int, std::unique_ptr<checker::Machine>> machines_;
  checker::Apart apart_;  ///< of the box that is proved
  int work_ = 0;
  bool gave_up_ = false;  ///< once something is false, it does not matter what else is
};

}  // namespace
}  // namespace taut

int main() {
  std::ios::sync_with_stdio(false);
  std::string line;
  while (std::getline(std::cin, line)) {
    try {
      std::cout << taut::Hints(line).add().dump() << '\n';
    } catch (const taut::checker::Malformed&) {
      std::cout << line << '\n';
    }
  }
}
