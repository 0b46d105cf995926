// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/confirm.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <span>

#include "checker/format/parts.h"
#include "checker/kernel/box_proof.h"
#include "checker/near_waypoints.h"
#include "checker/parallel.h"
#include "checker/witness.h"

namespace taut::checker {
namespace {

std::string name_of(std::size_t segment, const Box& box) {
  return fmt::format("segment {}, box [{}, {}]", segment, box.begin.get_str(), box.end.get_str());
}

std::string name_of(const Witness& witness) {
  return fmt::format("the witness at segment {}, s = {}", witness.at.segment, witness.at.s.get_str());
}

class Confirmation {
 public:
  Confirmation(const Certificate& certificate, const ConfirmOptions& options)
      : certificate_(certificate), problem_(certificate.problem), path_(certificate.path), options_(options) {}

  Theorem::Counts run() {
    require_waypoints_in_range();
    require_query();
    if (certificate_.witness) {
      const Witness& witness = *certificate_.witness;
      confirm_witness(witness, name_of(witness));
      if (is_implied(problem_, path_)) {
        confirm_motion(witness, proved_parts(), 0, places(witness).second, name_of(witness));
      }
    }
    for (std::size_t i = 0; i < certificate_.stretch_texts.size(); ++i) {
      for (const Witness& witness : certificate_.stretch(i).inner) {
        confirm_witness(witness, fmt::format("stretch {}: {}", i, name_of(witness)));
      }
    }
    for_each(certificate_.segment_texts.size(), options_.threads, [&](std::size_t k) { prove_segment(k); });
    return {certificate_.segment_texts.size(), certificate_.boxes, bits_};
  }

 private:
  /// `prove(machine)` at a precision. @throws Rejected naming `what` where it throws Undefined or Rejected.
  template <class Prove>
  void at_precision(int bits, const std::string& what, const Prove& prove) {
    options_.before_box();
    const WorkingPrecision precision(bits);
    for (int seen = bits_; seen < bits && !bits_.compare_exchange_weak(seen, bits);) continue;
    try {
      prove(machine(bits));
    } catch (const Undefined& why) {
      throw Rejected("not confirmed: " + what + ": " + why.what());
    } catch (const Rejected& why) {
      throw Rejected(what + ": " + why.what());
    }
  }

  const Machine& machine(int bits) {
    const std::lock_guard lock(mutex_);
    std::unique_ptr<Machine>& result = machines_[bits];
    if (result == nullptr) result = std::make_unique<Machine>(problem_);
    return *result;
  }

  void prove_segment(std::size_t k) {
    const Segment segment = certificate_.segment(k);
    const Margins& margins = segment.margins;
    const bool has_pairs = problem_.bodies && !problem_.bodies->pairs.empty();
    const bool are_positive = margins.tension > 0 && margins.length > 0 && (!has_pairs || margins.clearance > 0);
    if (!segment.boxes.empty() && (!are_positive || margins.wrench_scale < 1)) {
      throw Rejected("segment " + std::to_string(k) +
                     ": claims a margin that is not positive, or a wrench scale below 1");
    }
    for (std::size_t i = 0; i < segment.boxes.size(); ++i) {
      const Box& box = segment.boxes[i];
      at_precision(box.bits, name_of(k, box), [&](const Machine& machine) {
        const Bounds bounds = prove_box(machine, problem_, path_, k, box, segment.apart_of(i), margins.clearance);
        const auto require = [](const Ball& bound, const mpq_class& claimed, const std::string& what) {
          if (certainly_nonnegative(bound - Ball(claimed))) return;
          throw Undefined(what + " is not proved as claimed");
        };
        require(bounds.tension, margins.tension, "the tension margin");
        require(bounds.length, margins.length, "the length margin");
        require(bounds.wrench_scale, margins.wrench_scale, "the wrench scale");
        if (problem_.bodies) {
          const std::string pair = has_pairs ? " of " + problem_.bodies->pairs[bounds.closest_pair].name : "";
          require(bounds.clearance.value(), margins.clearance, "the clearance" + pair);
        }
        require_near_waypoints(machine, problem_, path_, k, box);
      });
    }
  }

  // ---- Witnesses ----------------------------------------------------------------------------------------------------

  void confirm_witness(const Witness& witness, const std::string& name) {
    if (witness.kind == WitnessKind::kSingular) {
      confirm_sign_change(witness, name);
      return;
    }
    at_precision(witness.at_box.bits, name, [&](const Machine& machine) {
      if (witness.kind == WitnessKind::kContact) {
        confirm_contact(machine, problem_, path_, witness);
      } else {
        confirm_violation(machine, problem_, path_, witness);
      }
      require_near_waypoints(machine, problem_, path_, witness.at.segment, witness.at_box);
    });
  }

  /// det D has opposite signs at two places, and the path is continuous in between with all lengths positive. As
  /// det J = det D / (product of the lengths), it vanishes somewhere between (intermediate value theorem).
  void confirm_sign_change(const Witness& witness, const std::string& name) {
    const auto sign = [&](const PathPoint& place, const Box& how) {
      int result = 0;
      at_precision(how.bits, name, [&](const Machine& machine) {
        const Ball det = determinant_at(machine, problem_, path_, place, how);
        result = certainly_positive(det) ? 1 : certainly_negative(det) ? -1 : 0;
        if (result == 0) throw Undefined("the sign of det D is not known");
      });
      return result;
    };
    if (sign(witness.at, witness.at_box) == sign(witness.to, witness.to_box)) {
      throw Rejected(name + ": det D has the same sign at both places");
    }
    const auto [first, last] = places(witness);
    // Boxes of segments are of no use here, as they do not overlap with stretches, in which such witnesses are.
    confirm_motion(witness, {}, first, last, name);
  }

  using Parts = std::vector<std::pair<mpq_class, mpq_class>>;  ///< of the path, from one abscissa to another

  /// The boxes of `segments`.
  [[nodiscard]] Parts proved_parts() const {
    Parts parts;
    for (std::size_t k = 0; k < certificate_.segment_texts.size(); ++k) {
      for (const Box& box : certificate_.segment(k).boxes) {
        parts.emplace_back(abscissa({k, box.begin}), abscissa({k, box.end}));
      }
    }
    return parts;
  }

  /// The witness's motion boxes and these `parts`, on which boxes of segments show the motion, cover the path from one
  /// place to another. So the motion is continuous there (and where it is implied, the one that begins in the first
  /// tube: where two boxes meet, one tube contains the other, and holds one pose only).
  void confirm_motion(const Witness& witness, Parts parts, mpq_class reached, const mpq_class& to,
                      const std::string& name) {
    const bool is_singular = witness.kind == WitnessKind::kSingular;
    const mpq_class first_place = places(witness).first;
    for (const MotionBox& part : witness.motion) {
      at_precision(part.box.bits, name + ": motion: " + name_of(part.segment, part.box), [&](const Machine& machine) {
        // Between the places of a sign change, too, parameters are in their ranges.
        const bool is_between = is_singular && abscissa({part.segment, part.box.end}) > first_place;
        const Ranges ranges = is_between ? Ranges::kRequired : Ranges::kIgnored;
        (void)commanded_geometry(machine, problem_, path_, part.segment, part.box, ranges);
        require_near_waypoints(machine, problem_, path_, part.segment, part.box);
      });
      parts.emplace_back(abscissa({part.segment, part.box.begin}), abscissa({part.segment, part.box.end}));
    }
    std::ranges::sort(parts);
    for (const auto& [begin, end] : parts) {
      if (begin <= reached && end > reached) reached = end;
    }
    if (reached < to) throw Rejected(name + ": the path is not shown to lead there from its beginning");
  }

  // ---- The query ----------------------------------------------------------------------------------------------------

  void require_waypoints_in_range() {
    const auto has_range = [](const Parameter& x) { return x.kind == ParameterKind::kRange; };
    if (has_poses(path_.law) || std::ranges::none_of(problem_.parameters, has_range)) return;
    for (std::size_t k = 0; k < path_.waypoints.size(); ++k) {
      constexpr int kBits = 256;
      at_precision(kBits, "waypoint " + std::to_string(k),
                   [&](const Machine&) { require_in_range(problem_, stated_parameters(path_.waypoints[k])); });
    }
  }

  /// Each waypoint of the case occurs along the path, in order, the first first and the last last. Of a path of a
  /// single waypoint, that one is among them.
  void require_query() {
    if (problem_.query.empty()) return;  // an audit: the path is what was asked about
    const std::span<const Waypoint> path = path_.waypoints;
    const std::size_t last = problem_.query.size() - 1;
    if (path.size() == 1) {
      for (std::size_t c = 0; c <= last; ++c) {
        if (is_same(path[0], query_waypoint(c))) return;
      }
      throw Rejected("the path's one waypoint is none of the query's");
    }
    const std::size_t passes = path_.law == Law::kStraight ? 1 : 3;
    std::size_t k = 0;
    for (std::size_t c = 0; c <= last; ++c) {
      const std::vector<double> x = query_waypoint(c);
      // Whether the path goes through it: a spline does where it stands three times in a row.
      const auto is_passed = [&](std::size_t at) {
        const auto there = path.subspan(at, passes);
        return std::ranges::all_of(there, [&](const Waypoint& w) { return w == there[0] && is_same(w, x); });
      };
      while (c > 0 && k + passes <= path.size() && !is_passed(k)) ++k;
      if (k + passes > path.size() || !is_passed(k) || (c == last && !is_passed(path.size() - passes))) {
        throw Rejected("query waypoint " + std::to_string(c) + ": the path does not pass it, or not in its turn");
      }
    }
  }

  /// The case's waypoint c, each of its coordinates rounded to the nearest binary64.
  std::vector<double> query_waypoint(std::size_t c) const {
    std::vector<double> x;
    for (const Expression& typed : problem_.query[c]) x.push_back(nearest_binary64(typed, c));
    return x;
  }

  static double nearest_binary64(const Expression& typed, std::size_t c) {
    // The last is for an exact 0 such as cos(pi/2): it is told from the least binary64 beyond 1075 bits only.
    for (const int bits : {128, 512, 1200, 4096}) {
      const WorkingPrecision precision(bits);
      try {
        const Ball x = typed.evaluate<MeanValueForm>({}).range();
        const auto rounded = [](const Ball& end) { return arf_get_d(arb_midref(end.get()), ARF_RND_NEAR); };
        if (const double nearest = rounded(lowest(x)); rounded(highest(x)) == nearest) return nearest;
      } catch (const Undefined&) {
        continue;  // at this precision
      }
    }
    throw Rejected("not confirmed: query waypoint " + std::to_string(c) + ": the binary64 nearest to what was typed");
  }

  /// Whether a waypoint of the path is the case's one at x: "The query" in docs/certificate-format.md.
  [[nodiscard]] bool is_same(const Waypoint& waypoint, const std::vector<double>& x) const {
    const auto matches = [&](const std::vector<double>& expected, std::size_t odd) {
      for (std::size_t j = 0; j < x.size(); ++j) {
        const bool is_odd = waypoint.half_turns[j] % 2 != 0;
        if (waypoint.x[j] != expected[j] || is_odd != (j == odd)) return false;
      }
      return true;
    };
    if (matches(x, x.size())) return true;
    if (!problem_.flip) return false;
    const auto [phi, theta] = *problem_.flip;
    std::vector<double> flipped = x;
    flipped[theta] *= -1;
    return matches(flipped, phi);
  }

  const Certificate& certificate_;
  const Problem& problem_;
  const Path& path_;
  const ConfirmOptions& options_;
  std::mutex mutex_;
  std::map<int, std::unique_ptr<Machine>> machines_;  ///< by precision
  std::atomic<int> bits_ = 0;
};

}  // namespace

Theorem::Counts confirm(const Certificate& certificate, const ConfirmOptions& options) {
  return Confirmation(certificate, options).run();
}

}  // namespace taut::checker
