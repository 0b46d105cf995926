#include "checker/check.h"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "checker/certificate.h"
#include "checker/deviation.h"
#include "checker/held.h"
#include "checker/motion.h"
#include "checker/pose_proof.h"
#include "checker/signature.h"

namespace taut::checker {
namespace {

/// Tried in turn on each statement; the last failure counts.
constexpr std::array<int, 6> kPrecisions = {128, 256, 512, 1024, 2048, 4096};
/// Halvings of one box, and pieces that they may make. A prover proves a box at one go, so few are needed; at a true minimum
/// that was claimed to 15 digits a second-order enclosure needs some 25 halvings.
constexpr int kMostHalvings = 60;
constexpr int kMaxPieces = 2000;
/// Pieces that all boxes together may need on the average, beyond those that one may: so the work is bounded by a
/// file's size.
constexpr std::size_t kMeanPieces = 50;
/// Parts of the way to a deviation (deviation.h): 4^h after h halvings of a box, up to this, which is the prover's most, too.
constexpr int kMostParts = 16;

enum class Answer { kYes, kNo, kUnknown };

/// x >= 0?
Answer is_nonnegative(const Interval& x) {
  if (certainly_nonnegative(x)) return Answer::kYes;
  return certainly_negative(x) ? Answer::kNo : Answer::kUnknown;
}

std::string digits(const Interval& x) {
  char buffer[64];
  mpfr_snprintf(buffer, sizeof buffer, "%.6Rg", middle(x).lower());
  return buffer;
}

std::string show(const Box& box) { return std::string("[") + box.begin.get_str() + ", " + box.end.get_str() + "]"; }

class Checker {
 public:
  Checker(const Certificate& certificate, CheckResult& result, const std::stop_token& stop)
      : certificate_(certificate), result_(result), stop_(stop) {}

  void confirm_proved() {
    require_waypoints_in_range();
    require_query();
    prove_segments();
    require_near_waypoints();
  }

  void confirm_refuted() {
    require_waypoints_in_range();
    if (certificate_.path.waypoints.size() == 1) {
      require_query_waypoint(certificate_.path.waypoints.front());
    } else {
      require_query();
    }
    confirm_witness(*certificate_.witness, "the witness");
    for (std::size_t i = 0; i < certificate_.stretches.size(); ++i) {
      for (const Witness& witness : certificate_.stretches[i].inner) {
        confirm_witness(witness, "stretch " + std::to_string(i) + ": the witness");
      }
    }
    prove_segments();
    require_near_waypoints();
  }

 private:
  /// The statement, at the lowest precision that does. `prove` throws Undefined for "not at this precision".
  template <class Prove>
  void escalate(const Prove& prove) {
    for (std::size_t i = 0; i < kPrecisions.size(); ++i) {
      try {
        if (models_[i] == nullptr) models_[i] = std::make_unique<Model>(certificate_.problem, kPrecisions[i]);
        const WorkingPrecision precision(kPrecisions[i]);
        prove(*models_[i]);
        result_.counts.bits = std::max(result_.counts.bits, kPrecisions[i]);
        return;
      } catch (const Undefined& open) {
        if (i + 1 == kPrecisions.size()) throw Rejected(std::string("not confirmed: ") + open.what());
      }
    }
  }

  void heed_stop() const {
    if (stop_.stop_requested()) throw Interrupted("interrupted");
  }

  /// The boxes of all segments.
  void prove_segments() {
    for (std::size_t k = 0; k < certificate_.segments.size(); ++k) {
      const Segment& segment = certificate_.segments[k];
      const Margins& margins = segment.margins;
      if (!segment.boxes.empty() && (margins.tension <= 0 || margins.length <= 0 || margins.wrench_scale < 1)) {
        throw Rejected("segment " + std::to_string(k) +
                       ": claims a margin that is not positive, or a wrench scale below 1");
      }
      for (const Box& box : segment.boxes) {
        const std::string where = "segment " + std::to_string(k) + ", box ";
        escalate([&](const Model& model) {
          cover(k, box, where, [&](const Box& piece, int halvings) {
            const int parts = halvings < 2 ? 1 << (2 * halvings) : kMostParts;
            if (const auto doubt = doubt_piece(model, k, piece, parts, where + show(piece))) throw Undefined(*doubt);
          });
        });
      }
    }
  }

  /// Shows something for every s of the box, of segment k: of each of finitely many pieces that cover it, none of which
  /// reaches across an inner pose of the reference, by `prove`, which is given a piece and the number of halvings that
  /// led to it, and throws Undefined where it fails. Where it fails of the middle of a piece alone, which is as small
  /// as pieces get, halving would not help: then this throws Undefined, too.
  template <class Prove>
  void cover(std::size_t k, const Box& box, const std::string& where, const Prove& prove) {
    struct Piece {
      Box box;
      int halvings;
    };
    std::vector<Piece> open = {{box, 0}};
    if (k < certificate_.path.inner_poses.size()) {
      const std::vector<InnerPose>& inner = certificate_.path.inner_poses[k];
      for (auto next = first_after(inner, box.begin); next != inner.end() && next->s < box.end; ++next) {
        open.back().box.end = next->s;
        open.push_back({{next->s, box.end}, 0});
      }
      std::ranges::reverse(open);
    }
    const auto require_moderate = [&](std::size_t pieces) {
      if (pieces <= kMeanPieces * certificate_.boxes + kMaxPieces) return;
      throw Rejected("not confirmed: the boxes are too large to be proved in a reasonable time");
    };
    require_moderate(result_.counts.pieces + open.size());
    const auto at_first = static_cast<int>(open.size());
    int pieces = 0;
    while (!open.empty()) {
      heed_stop();
      const Piece piece = open.back();
      open.pop_back();
      try {
        prove(piece.box, piece.halvings);
        ++pieces;
      } catch (const Undefined& doubt) {
        const mpq_class middle = (piece.box.begin + piece.box.end) / 2;
        try {
          prove({middle, middle}, kMostHalvings);
        } catch (const Undefined& reason) {
          throw Undefined(where + show(piece.box) + ": " + reason.what());
        }
        if (piece.halvings == kMostHalvings || static_cast<int>(open.size()) + pieces >= kMaxPieces + at_first) {
          throw Rejected("not confirmed: " + where + show(piece.box) + ": " + doubt.what());
        }
        open.push_back({{middle, piece.box.end}, piece.halvings + 1});
        open.push_back({{piece.box.begin, middle}, piece.halvings + 1});
      }
    }
    result_.counts.pieces += static_cast<std::size_t>(pieces);
    require_moderate(result_.counts.pieces);
  }

  /// Nothing, where the segment's claim holds for every s of the box; else what could not be shown.
  /// @throws Rejected where the claim is certainly false at the middle of the box.
  std::optional<std::string> doubt_piece(const Model& model, std::size_t k, const Box& box, int parts,
                                         const std::string& where) const {
    const Situation at = situation(model, k, box);
    const Geometry& geometry = at.geometry;
    const Inverse inverse = checker::inverse(geometry.D);  // J is non-singular on the box
    const Tensions tensions = model.tensions(geometry, inverse.Y);
    const Margins& claimed = certificate_.segments[k].margins;
    const Form tension_margin{Interval(claimed.tension)};
    const Form length_margin{Interval(claimed.length)};
    const Form scale{Interval(claimed.wrench_scale)};
    const bool is_one_place = box.begin == box.end;
    Losses loss;
    if (model.deviation() != nullptr) {
      const bool is_held = is_held_by_lengths(certificate_.problem, certificate_.path);
      loss = losses(model, geometry, inverse, at.pose, is_held, Interval(claimed.wrench_scale), parts);
    }
    std::optional<std::string> doubt;
    const auto require = [&](const char* what, std::size_t i, const Form& left, const Form& right,
                             const Interval& loss_of_it) {
      const Form excess = left - right;
      const std::string statement = "cable " + std::to_string(i + 1) + ": " + what;
      if (certainly_negative(excess.mid)) {
        throw Rejected(where + ", " + statement + " is false at its middle, by " + digits(-excess.mid));
      }
      if (is_one_place && certainly_negative(excess.range - highest(loss_of_it))) {
        throw Rejected("not confirmed: " + where + ", " +
                       statement);  // what deviations take is not a matter of rounding
      }
      if (!certainly_nonnegative(excess.range - loss_of_it) && !doubt) doubt = statement + " not confirmed";
    };
    for (std::size_t i = 0; i < kCables; ++i) {
      const Form above = tensions.centre[i] - Form(model.tension_limit(i, false));
      const Form below = Form(model.tension_limit(i, true)) - tensions.centre[i];
      const Form& v = tensions.spread[i];
      require("lower tension margin as claimed", i, above - v, tension_margin, loss.tension[i][0]);
      require("upper tension margin as claimed", i, below - v, tension_margin, loss.tension[i][1]);
      require("wrench scale as claimed, at the lower tension limit,", i, above, scale * v, loss.scaled[i][0]);
      require("wrench scale as claimed, at the upper tension limit,", i, below, scale * v, loss.scaled[i][1]);
      require("lower length margin as claimed", i, geometry.length[i] - Form(model.length_limit(i, false)),
              length_margin, loss.length[i]);
      require("upper length margin as claimed", i, Form(model.length_limit(i, true)) - geometry.length[i],
              length_margin, loss.length[i]);
    }
    return doubt;
  }

  /// Where the path leads on a box of segment k, unless lengths say where. Between waypoints inside their
  /// ranges parameters stay inside, by convexity; those of a motion that is only implied need not.
  Frame stated_pose(std::size_t k, const Box& box) const {
    const Problem& problem = certificate_.problem;
    if (certificate_.path.interpolation == Interpolation::kGeodesic) return geodesic(certificate_.path, k, box);
    const std::vector<Form> at = parameters(problem, certificate_.path, k, box);
    if (!problem.constraints.empty()) require_in_range(at, "segment " + std::to_string(k));
    return frame(coordinates(problem, at));
  }

  /// The machine as it is stated, at the pose that is commanded.
  struct Situation {
    Frame pose;
    Geometry geometry;
  };

  /// On a box of segment k, which reaches across no inner pose.
  Situation situation(const Model& model, std::size_t k, const Box& box) const {
    const Path& path = certificate_.path;
    if (path.interpolation != Interpolation::kCableLengths) {
      const Frame pose = stated_pose(k, box);
      return {pose, model.geometry(pose)};
    }
    try {
      const Vector6<Form> L = commanded_lengths(path, k, box);
      const Frame pose = held_by_lengths(model, reference(path, k, box), L);
      Situation result{pose, model.geometry(pose)};
      result.geometry.length = L;
      return result;
    } catch (const Undefined& why) {
      throw Undefined(std::string("the pose held by the lengths: ") + why.what());
    }
  }

  Situation situation_at(const Model& model, const Place& place) const {
    return situation(model, place.segment, {place.s, place.s});
  }

  void confirm_witness(const Witness& witness, const std::string& name) {
    escalate([&](const Model& model) {
      heed_stop();
      if (witness.kind == WitnessKind::kSingular) {
        confirm_sign_change(model, witness, name);
      } else {
        confirm_violation(model, witness, name);
      }
    });
  }

  /// Whether anchors or lengths deviate: else a machine that is held by lengths stays where it is.
  static bool moves_platform(const WitnessDeviation& by) {
    const auto is_zero = [](const mpq_class& x) { return x == 0; };
    const auto are_zero = [&](const auto& rows) {
      return std::ranges::all_of(rows, [&](const auto& row) { return std::ranges::all_of(row, is_zero); });
    };
    return !are_zero(by.base_anchors) || !are_zero(by.platform_anchors) ||
           !std::ranges::all_of(*by.cable_lengths, is_zero);
  }

  /// The geometry of the machine that a witness is about, by `deviant`, which gets that machine's numbers.
  Geometry geometry_of(const Witness& witness, const Model& model, std::optional<Model>& deviant) const {
    const Situation stated = situation_at(model, witness.at);
    if (!witness.deviation) return stated.geometry;
    const WitnessDeviation& by = *witness.deviation;
    Problem problem = certificate_.problem;
    const Tolerances& within = *problem.tolerances;
    const auto require_within = [](const std::array<mpq_class, 3>& x, const mpq_class& tolerance, const char* what) {
      if (x[0] * x[0] + x[1] * x[1] + x[2] * x[2] > tolerance * tolerance) {
        throw Rejected(std::string("false: the witness's deviation is within the tolerance of ") + what);
      }
    };
    for (std::size_t i = 0; i < kCables; ++i) {
      require_within(by.base_anchors[i], within.base_anchors[i], "a base anchor");
      require_within(by.platform_anchors[i], within.platform_anchors[i], "a platform anchor");
      for (std::size_t c = 0; c < 3; ++c) {
        problem.base_anchors[i][c] += by.base_anchors[i][c];
        problem.platform_anchors[i][c] += by.platform_anchors[i][c];
      }
      problem.wrench[i] += by.wrench * within.wrench[i];
    }
    require_within(by.load_point, within.load_point, "the load point");
    require_within({by.wrench, 0, 0}, 1, "the wrench");
    require_within(by.position, within.position, "the position");
    for (std::size_t c = 0; c < 3; ++c) problem.load_point[c] += by.load_point[c];
    Vector3<Form> u;
    for (std::size_t c = 0; c < 3; ++c) u[c] = Form(Interval(by.turn[c]));
    const Interval angle = Interval(2) * atan(sqrt(squared_norm(u).range));
    require(is_nonnegative(model.deviation()->angle - angle),
            "the witness's deviation is within the tolerance of the angle");
    deviant.emplace(problem, model.bits());
    Frame pose = stated.pose;
    if (by.cable_lengths) {
      Vector6<Interval> errors;
      for (std::size_t i = 0; i < kCables; ++i) {
        const mpq_class& error = (*by.cable_lengths)[i];
        require_within({error, 0, 0}, within.cable_length ? (*within.cable_length)[i] : 0, "a cable's length");
        errors[i] = Interval(error);
      }
      if (moves_platform(by)) {
        try {
          pose = deviated_pose(model, stated.pose, stated.geometry.length, *deviant, errors, [this] { heed_stop(); });
        } catch (const Undefined& open) {
          // Each step costs digits, but no way costs so many: then it is smaller steps that would help. An attempt may take seconds.
          constexpr int kEnough = 512;
          if (model.bits() >= kEnough) throw Rejected(std::string("not confirmed: ") + open.what());
          throw;
        }
      }
    }
    for (std::size_t c = 0; c < 3; ++c) pose.p[c] += Form(Interval(by.position[c]));
    pose.R = multiply(rotation({u[0], u[1], u[2], Form(Interval(1))}), pose.R);
    return deviant->geometry(pose);
  }

  /// Under the law of cable lengths inner poses are the certificate's own choice. A witness between them is of the path only
  /// where a motion is proved that leads to its pose from one of the segment's waypoints.
  void require_connected(const Model& model, const Place& at, const std::string& name) {
    const Path& path = certificate_.path;
    if (at.segment >= path.inner_poses.size() || path.inner_poses[at.segment].empty()) return;
    const auto exists = [&](const Box& piece, int) { (void)situation(model, at.segment, piece); };
    try {
      cover(at.segment, {0, at.s}, name + ": from the waypoint before, ", exists);
      return;
    } catch (const Undefined&) {  // then from the other side
    } catch (const Rejected&) {
    }
    cover(at.segment, {at.s, 1}, name + ": from the waypoint behind, ", exists);
  }

  void confirm_violation(const Model& stated, const Witness& witness, const std::string& name) {
    require_connected(stated, witness.at, name);
    const auto i = static_cast<std::size_t>(witness.cable);
    std::optional<Model> deviant;
    const Geometry geometry = geometry_of(witness, stated, deviant);
    const Model& model = deviant ? *deviant : stated;
    Interval value = geometry.length[i].range;
    Interval excess;  // beyond the limit; a violation where >= 0, as limits are open
    switch (witness.kind) {
      case WitnessKind::kTensionMin: {
        const Tensions tensions = model.tensions(geometry);
        value = tensions.centre[i].range - tensions.spread[i].range;
        excess = model.tension_limit(i, false) - value;
        break;
      }
      case WitnessKind::kTensionMax: {
        const Tensions tensions = model.tensions(geometry);
        value = tensions.centre[i].range + tensions.spread[i].range;
        excess = value - model.tension_limit(i, true);
        break;
      }
      case WitnessKind::kLengthMin: excess = model.length_limit(i, false) - value; break;
      case WitnessKind::kLengthMax: excess = value - model.length_limit(i, true); break;
      case WitnessKind::kSingular: throw std::logic_error("a sign change is confirmed elsewhere");
    }
    require(is_nonnegative(excess), name + " violates its limit (the quantity is about " + digits(value) + ")");
    require(is_nonnegative(value - Interval(witness.value_lower)), "the lower end of the value of " + name);
    require(is_nonnegative(Interval(witness.value_upper) - value), "the upper end of the value of " + name);
  }

  /// det D has opposite signs at two places, and D is continuous in between with all lengths positive, so that
  /// det J = det D / (product of the lengths) vanishes somewhere. Continuity is not free: the case's expressions may
  /// jump (1/x, tan, atan2). A Form of the geometry exists only where they don't.
  void confirm_sign_change(const Model& model, const Witness& witness, const std::string& name) {
    require_connected(model, witness.at, name);
    const auto det = [&](const Place& place) { return determinant(mid(situation_at(model, place).geometry.D)); };
    const Interval product = det(witness.at) * det(witness.to);
    if (certainly_positive(product)) throw Rejected(name + ": det D has the same sign at both places");
    if (!certainly_negative(product)) throw Undefined(name + ": the signs of det D");
    const auto before = [](const Place& a, const Place& b) {
      return a.segment != b.segment ? a.segment < b.segment : a.s < b.s;
    };
    const auto [begin, end] = std::minmax(witness.at, witness.to, before);
    for (std::size_t k = begin.segment; k <= end.segment; ++k) {
      const Box box = {k == begin.segment ? begin.s : 0, k == end.segment ? end.s : 1};
      if (box.begin == box.end && begin.segment != end.segment) continue;  // a place, which is in the neighbour, too
      cover(k, box, name + ": segment " + std::to_string(k) + ", ",
            [&](const Box& piece, int /*halvings*/) { (void)situation(model, k, piece); });
    }
  }

  void require_waypoints_in_range() {
    if (has_poses(certificate_.path.interpolation)) return;  // those of the free coordinates have none
    for (std::size_t k = 0; k < certificate_.path.waypoints.size(); ++k) {
      const std::vector<double>& x = certificate_.path.waypoints[k].x;
      escalate([&](const Model&) {
        std::vector<Form> at;
        for (const double value : x) at.emplace_back(Interval{mpq_class(value)});  // in a range there are no half turns
        require_in_range(at, "waypoint " + std::to_string(k));
      });
    }
  }

  /// Parameters of kind range are in their closed ranges.
  void require_in_range(const std::vector<Form>& at, const std::string& where) const {
    for (std::size_t j = 0; j < at.size(); ++j) {
      const Parameter& parameter = certificate_.problem.parameters[j];
      if (parameter.kind != Kind::kRange) continue;
      for (const Form& excess : {at[j] - parameter.lower.evaluate({}), parameter.upper.evaluate({}) - at[j]}) {
        const std::string what = where + ": " + parameter.name + " in its range";
        if (certainly_negative(excess.mid)) throw Rejected("false: " + what);
        if (!certainly_nonnegative(excess.range)) throw Undefined(what);
      }
    }
  }

  /// Each waypoint of the case occurs along the path, in order, the first first and the last last.
  void require_query() {
    if (certificate_.problem.query.empty()) return;  // an audit: the path is what was asked about
    const std::size_t passes = certificate_.path.interpolation == Interpolation::kStraight ? 1 : 3;
    const std::span<const Waypoint> path = certificate_.path.waypoints;
    const std::size_t last = certificate_.problem.query.size() - 1;
    std::size_t k = 0;
    for (std::size_t c = 0; c <= last; ++c) {
      const std::vector<double> x = query_waypoint(c);
      // Whether the path goes through it: a spline does where it stands three times in a row.
      const auto is_passed = [&](std::size_t at) {
        const auto there = path.subspan(at, passes);
        return std::all_of(there.begin(), there.end(),
                           [&](const Waypoint& w) { return w == there[0] && is_same(w, x); });
      };
      while (c > 0 && k + passes <= path.size() && !is_passed(k)) ++k;
      if (k + passes > path.size() || !is_passed(k) || (c == last && !is_passed(path.size() - passes))) {
        throw Rejected("query waypoint " + std::to_string(c) + ": the path does not pass it, or not in its turn");
      }
      require_reached(k, c);
      if (c == last) require_reached(path.size() - passes, c);
    }
  }

  /// In an audit the path itself is what was asked about: wherever a proved box begins or ends at a joint, the motion passes next
  /// to what the path states there.
  void require_near_waypoints() {
    if (!certificate_.problem.query.empty() || certificate_.problem.constraints.empty()) return;
    if (certificate_.path.interpolation == Interpolation::kGeodesic) return;  // no constraints: the reader asks for it
    for (std::size_t k = 0; k < certificate_.segments.size(); ++k) {
      const std::vector<Box>& boxes = certificate_.segments[k].boxes;
      if (boxes.empty()) continue;
      const std::string where = "segment " + std::to_string(k) + ": the pose on the constraints at its ";
      if (boxes.front().begin == 0) require_near(k, {0, 0}, where + "begin");
      if (boxes.back().end == 1) require_near(k, {1, 1}, where + "end");
    }
  }

  /// The pose on the constraints where the path passes its waypoint k, the case's waypoint c.
  void require_reached(std::size_t k, std::size_t c) {
    if (certificate_.problem.constraints.empty()) return;
    const Path& path = certificate_.path;
    const bool is_end = k > 0 && k >= path.segments();
    const std::string what = "query waypoint " + std::to_string(c) + ": the pose on the constraints";
    require_near(is_end ? path.segments() - 1 : k, is_end ? Box{1, 1} : Box{0, 0}, what);
  }

  /// Where the space has constraints, the pose reached at the begin or the end of segment k, which is on them, is next to what the
  /// path states there: normals and tube are the certificate's own choice, and could lead anywhere. Each coordinate is
  /// between those of the control points that matter there, or hardly beyond. "The query" in docs/certificate-format.md.
  void require_near(std::size_t k, const Box& place, const std::string& what) {
    const Path& path = certificate_.path;
    const std::span<const Waypoint> controls = path.controls(k);
    // Of a straight segment one matters at either end, of a spline's three; the one of a path that stays matters itself.
    const std::size_t others = controls.size() == 1 ? 0 : 1;
    const auto stated = controls.subspan(place.begin == 0 ? 0 : others, controls.size() - others);
    const std::span<const Waypoint> near =
        path.interpolation == Interpolation::kCubicBSpline ? stated : stated.first(1);
    escalate([&](const Model& model) {
      const Vector6<Form> reached = coordinates(certificate_.problem, parameters(certificate_.problem, path, k, place));
      std::vector<Vector6<Form>> asked;
      for (const Waypoint& waypoint : near) {
        asked.push_back(coordinates(certificate_.problem, stated_parameters(waypoint)));
      }
      for (std::size_t i = 0; i < 6; ++i) {
        const Interval room = Interval(mpq_class(1, 50)) * (i < 3 ? model.platform_size() : Interval(1));
        for (const bool is_above : {false, true}) {
          Answer answer = Answer::kNo;  // whether some control point is as far on that side
          for (const Vector6<Form>& other : asked) {
            const Interval beyond = reached[i].range - other[i].range;
            const Answer here = is_nonnegative(room + (is_above ? -beyond : beyond));
            if (here == Answer::kYes || (here == Answer::kUnknown && answer == Answer::kNo)) answer = here;
          }
          require(answer, what + " is next to what the path states");
        }
      }
    });
  }

  /// The waypoint is one of the case's.
  void require_query_waypoint(const Waypoint& waypoint) {
    if (certificate_.problem.query.empty()) return;
    for (std::size_t c = 0; c < certificate_.problem.query.size(); ++c) {
      if (!is_same(waypoint, query_waypoint(c))) continue;
      require_reached(0, c);
      return;
    }
    throw Rejected("the path's one waypoint is none of the query's");
  }

  /// The case's waypoint c, each of its coordinates rounded to the nearest binary64.
  std::vector<double> query_waypoint(std::size_t c) {
    std::vector<double> x;
    for (const Expression& typed : certificate_.problem.query[c]) x.push_back(nearest_binary64(typed, c));
    return x;
  }

  double nearest_binary64(const Expression& typed, std::size_t c) {
    // The last is for an exact 0 such as cos(pi/2): it is told from the least binary64 beyond 1075 bits only.
    for (const int bits : {128, 512, 1200, 4096}) {
      const WorkingPrecision precision(bits);
      try {
        const Interval x = typed.evaluate({}).range;
        const double nearest = mpfr_get_d(x.lower(), MPFR_RNDN);
        if (mpfr_get_d(x.upper(), MPFR_RNDN) == nearest) return nearest;
      } catch (const Undefined&) {
        continue;  // at this precision
      }
    }
    throw Rejected("not confirmed: query waypoint " + std::to_string(c) + ": the binary64 nearest to what was typed");
  }

  /// Whether a waypoint of the path is the case's one at x: "The query" in docs/certificate-format.md.
  [[nodiscard]] bool is_same(const Waypoint& waypoint, const std::vector<double>& x) const {
    const auto matches = [&](const std::vector<double>& expected, int odd) {
      for (std::size_t j = 0; j < x.size(); ++j) {
        const bool is_odd = waypoint.half_turns[j] % 2 != 0;
        if (waypoint.x[j] != expected[j] || is_odd != (static_cast<int>(j) == odd)) return false;
      }
      return true;
    };
    if (matches(x, -1)) return true;
    if (!certificate_.problem.flip) return false;
    const auto [phi, theta] = *certificate_.problem.flip;
    std::vector<double> flipped = x;
    flipped[static_cast<std::size_t>(theta)] *= -1;
    return matches(flipped, phi);
  }

  static void require(Answer answer, const std::string& what) {
    if (answer == Answer::kNo) throw Rejected("false: " + what);
    if (answer == Answer::kUnknown) throw Undefined(what);
  }

  const Certificate& certificate_;
  CheckResult& result_;
  const std::stop_token& stop_;
  std::array<std::unique_ptr<Model>, kPrecisions.size()> models_;
};

/// The certificate's problem is the case's. In an audit the path is what was asked about: so the case's query does not
/// matter, nor its space where the path goes through the free coordinates.
/// @returns what of the case was not compared
std::vector<std::string> require_problem(nlohmann::json problem, const nlohmann::json& of_case) {
  std::vector<std::string> not_compared;
  if (problem["query"]["waypoints"].empty()) {
    if (problem["query"] != of_case["query"]) not_compared.emplace_back("the case's query");
    problem["query"] = of_case["query"];
    if (problem["space"] == coordinate_space() && problem["space"] != of_case["space"]) {
      const bool has_constraints = !of_case["space"]["constraints"].empty();
      not_compared.emplace_back(has_constraints ? "the case's space with its constraints" : "the case's space");
      problem["space"] = of_case["space"];
    }
  }
  if (problem != of_case) throw Rejected("the certificate is about another problem");
  return not_compared;
}

bool is_same(const Path& path, const Waypoint& waypoint, const ExpectedPath::Waypoint& expected) {
  if (path.interpolation != Interpolation::kCableLengths) {
    return waypoint.x == expected.x && (has_poses(path.interpolation) || waypoint.half_turns == expected.half_turns);
  }
  constexpr std::size_t kPose = 7;  // px, py, pz, qx, qy, qz, qw; then the lengths
  constexpr double kSameAssembly = 1e-6;
  if (waypoint.x.size() != expected.x.size() ||
      !std::equal(waypoint.x.begin() + kPose, waypoint.x.end(), expected.x.begin() + kPose)) {
    return false;
  }
  const auto is_near = [&](int sign) {  // q and -q are one pose
    for (std::size_t i = 0; i < kPose; ++i) {
      const double other = i < 3 ? expected.x[i] : sign * expected.x[i];
      if (!(std::abs(waypoint.x[i] - other) <= kSameAssembly)) return false;
    }
    return true;
  };
  return is_near(1) || is_near(-1);
}

/// The certificate's path is the file's: its law, its waypoints and, where either names the other, its digest.
void require_path(const nlohmann::json& json, const Path& path, const std::string& sha256, const ExpectedPath& file) {
  const auto fail = [&](const std::string& what) {
    throw Rejected("the path is not that of " + file.name + ": " + what);
  };
  if (!file.certificate_sha256.empty() && file.certificate_sha256 != sha256) {
    fail("the file names another certificate's SHA-256");
  }
  const std::string& law = json["path"]["interpolation"].get_ref<const std::string&>();
  if (law != file.interpolation) {
    fail("the certificate's interpolation is " + law + ", the file's is " + file.interpolation);
  }
  const bool stays = file.waypoints.size() == 1 && path.waypoints.size() == 2;  // a segment that stays at one pose
  if (path.waypoints.size() != file.waypoints.size() && !stays) {
    fail("the certificate has " + std::to_string(path.waypoints.size()) + " waypoints, the file has " +
         std::to_string(file.waypoints.size()));
  }
  for (std::size_t k = 0; k < path.waypoints.size(); ++k) {
    const ExpectedPath::Waypoint& expected = file.waypoints[stays ? 0 : k];
    if (is_same(path, path.waypoints[k], expected)) continue;
    fail("waypoint " + std::to_string(k) + " differs from " + expected.place + " of the file");
  }
  const nlohmann::json& source = json["source"];
  if (file.certificate_sha256.empty() && !source.is_null() && source["sha256"] != file.sha256) {
    fail("the file that was audited has another SHA-256");
  }
}

/// Asks to stop where the caller does, and when the time is up.
class Budget {
 public:
  Budget(const std::stop_token& caller, std::optional<double> seconds)
      : on_caller_(caller, [this] { source_.request_stop(); }) {
    if (!seconds) return;
    constexpr double kLongest = 1e9;  // [s]: a clock counts no more than some centuries
    const auto allowed = std::chrono::duration_cast<std::chrono::milliseconds>(
        std::chrono::duration<double>(std::min(*seconds, kLongest)));
    timer_ = std::jthread([this, allowed](const std::stop_token& finished) {
      std::mutex mutex;
      std::unique_lock lock(mutex);
      std::condition_variable_any never;
      never.wait_for(lock, finished, allowed, [] { return false; });
      if (!finished.stop_requested()) source_.request_stop();
    });
  }
  [[nodiscard]] std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
  std::stop_callback<std::function<void()>> on_caller_;
  std::jthread timer_;  // last: joins before the rest goes
};

std::string seconds_text(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%g s", seconds);
  return text;
}

std::string plural(std::size_t n, const std::string& what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : what == "box" || what == "stretch" ? "es" : "s");
}

/// What a file says may be printed on a terminal and searched by scripts: here it is one line of printable ASCII, with
/// \xNN for any other byte.
std::string printable(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c >= ' ' && c <= '~') {
      result += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    result += {'\\', 'x', "0123456789abcdef"[byte >> 4U], "0123456789abcdef"[byte & 15U]};
  }
  return result;
}

std::string describe_accepted(const Certificate& certificate, const CheckResult& result) {
  const std::string bits = "; " + std::to_string(result.counts.bits) + " bits";
  const std::string audit = certificate.problem.query.empty() ? "an audit, " : "";
  if (certificate.verdict == Verdict::kRefuted) {
    const std::string refuted = audit + "refuted again: the witness is confirmed";
    if (certificate.stretches.empty()) return refuted + bits;
    const auto open = std::count_if(certificate.stretches.begin(), certificate.stretches.end(),
                                    [](const Stretch& stretch) { return stretch.inner.empty(); });
    return refuted + ", " + plural(certificate.stretches.size(), "stretch") + " (" + std::to_string(open) +
           " open), and nothing outside of them: " + plural(result.counts.boxes, "box") + " (" +
           std::to_string(result.counts.pieces) + " after splitting)" + bits;
  }
  return audit + "proved again: " + plural(result.counts.segments, "segment") + ", " +
         plural(result.counts.boxes, "box") + " (" + std::to_string(result.counts.pieces) +
         " after splitting), tension margin >= " + certificate.margins[0] +
         " N, length margin >= " + certificate.margins[1] + " m, wrench scale >= " + certificate.margins[2] + bits;
}

/// Signer, case, path file and verdict are those that were asked for.
void require_asked_for(const Certificate& certificate, const CheckOptions& options, CheckResult& result) {
  const nlohmann::json& json = *result.certificate;
  result.is_trusted = std::ranges::find(options.trusted, result.signer) != options.trusted.end();
  if (!options.trusted.empty() && !result.is_trusted) {
    throw Rejected(result.signer.empty() ? "nobody signed it" : "nobody trusted signed it");
  }
  if (options.problem != nullptr) {
    result.not_compared = require_problem(json["problem"], *options.problem);
  } else {
    result.not_compared.emplace_back("case");
  }
  if (options.path != nullptr) {
    require_path(json, certificate.path, result.sha256, *options.path);
  } else {
    result.not_compared.emplace_back("path file");
  }
  if (!options.expect || certificate.verdict == Verdict::kUndecided) return;
  const bool expects_proved = *options.expect == Theorem::Verdict::kProved;
  if (expects_proved != (certificate.verdict == Verdict::kProved)) {
    throw Rejected("the certificate says " + json["verdict"].get<std::string>() + ", expected " +
                   (expects_proved ? "proved" : "refuted"));
  }
}

}  // namespace

const char* name(Outcome outcome) {
  switch (outcome) {
    case Outcome::kAccepted: return "accepted";
    case Outcome::kRejected: return "rejected";
    case Outcome::kUndecided: return "undecided";
    case Outcome::kUnchecked: return "unchecked";
    case Outcome::kMalformed: break;
  }
  return "malformed";
}

std::string sha256(const std::string& bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1) {
    throw std::runtime_error("SHA-256 is not available");
  }
  std::string hex;
  for (unsigned int i = 0; i < size; ++i) {
    hex += "0123456789abcdef"[digest[i] >> 4U];
    hex += "0123456789abcdef"[digest[i] & 15U];
  }
  return hex;
}

CheckResult check(const std::string& bytes, const CheckOptions& options) {
  const Budget budget(options.stop, options.max_seconds);
  CheckResult result;
  result.sha256 = sha256(bytes);
  try {
    nlohmann::json json = parse_json(bytes);
    result.signer = take_signature(json).value_or("");
    const Certificate certificate = read_certificate(json);
    result.certificate = std::make_shared<const nlohmann::json>(std::move(json));
    result.is_audit = certificate.problem.query.empty();
    result.counts.segments = certificate.segments.size();
    result.counts.boxes = certificate.boxes;
    require_asked_for(certificate, options, result);
    if (certificate.verdict == Verdict::kUndecided) {
      result.outcome = Outcome::kUndecided;
      result.message = "the certificate claims nothing: " + printable(certificate.undecided_reason);
      return result;
    }
    if (options.max_seconds && *options.max_seconds <= 0) throw Interrupted("no time");
    const bool is_proved = certificate.verdict == Verdict::kProved;
    const std::stop_token stop = budget.token();
    Checker checker(certificate, result, stop);
    if (is_proved) {
      checker.confirm_proved();
    } else {
      checker.confirm_refuted();
    }
    result.message = describe_accepted(certificate, result);
    result.theorem = Theorem(is_proved ? Theorem::Verdict::kProved : Theorem::Verdict::kRefuted, result.certificate,
                             result.sha256, result.counts);
    result.outcome = Outcome::kAccepted;
  } catch (const Malformed& error) {
    result.outcome = Outcome::kMalformed;
    result.message = printable(error.what());
  } catch (const Rejected& error) {
    result.outcome = Outcome::kRejected;
    result.message = printable(error.what());
  } catch (const Interrupted&) {
    if (options.stop.stop_requested()) throw;
    result.outcome = Outcome::kUnchecked;
    const double seconds = options.max_seconds.value_or(0);
    result.message = seconds > 0 ? "the budget of " + seconds_text(seconds) + " ran out before all was proved"
                                 : "nothing was proved, as no time was allowed for it";
  }
  return result;
}

}  // namespace taut::checker
