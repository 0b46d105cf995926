#include "reports/sentences.h"

#include <fmt/format.h>

#include <algorithm>

#include "reports/wording.h"

namespace taut {

namespace {

/// " (0.05 N to 0.5 N)" where it is the same for all six cables.
std::string common_limits(const std::array<Limits, kCables>& limits, bool length) {
  if (!std::all_of(limits.begin(), limits.end(), [&](const Limits& l) { return l == limits[0]; })) return "";
  const auto text = [&](const DecimalText& value) { return length ? millimetres(value) : plain(value); };
  return fmt::format(" ({} to {} {})", text(limits[0].lower), text(limits[0].upper), length ? "mm" : "N");
}

/// The segment that a margin of the whole path comes from.
std::string where_least(const CertificateView& view, std::string MarginsView::*margin) {
  const auto least = std::find_if(view.segments.begin(), view.segments.end(), [&](const SegmentView& segment) {
    return segment.margins.*margin == (*view.margins).*margin;
  });
  return least == view.segments.end() ? "no segment" : fmt::format("segment {}", least->from);
}

std::string closest_text(const Scene& scene) {
  const Model<double>& model = scene.sampler.model();
  const std::optional<Closest> tension = closest_tension(model, scene.samples);
  const std::optional<Closest> length = closest_length(model, scene.samples);
  if (!tension || !length) return "";
  const int last = std::max(0, static_cast<int>(scene.view.path.segments()) - 1);
  const auto segment = [&](const Closest& c) { return std::min(static_cast<int>(c.position), last); };
  const auto limit = [](const Closest& c) { return c.upper ? "upper" : "lower"; };
  return fmt::format(
      "In floating-point samples of the path, cable {} comes closest to a tension limit: within {:.2g} N of its {} "
      "limit, {:.2g} % of the way between its limits, in segment {}. Cable {} comes closest to a length limit: within "
      "{:.3g} mm of its {} limit, in segment {}.",
      tension->cable + 1, tension->margin, limit(*tension), 100 * tension->fraction, segment(*tension),
      length->cable + 1, 1000 * length->margin, limit(*length), segment(*length));
}

std::vector<std::string> proved_text(const Scene& scene) {
  const CertificateView& view = scene.view;
  const RobotText& robot = view.problem.robot;
  std::vector<std::string> result = {"Proved: this motion is wrench-feasible, from its first pose to its last."};
  if (!view.path.waypoints.empty()) {
    result.push_back(
        fmt::format("At every pose on the way from {} to {}, and for every load in the given ellipsoid of wrenches, "
                    "the six cables of "
                    "\u201C{}\u201D balance the load with each tension strictly within its limits{}, each cable length "
                    "is strictly within "
                    "its limits{}, and no singular pose is met. The motion has {}; it was proved as a whole, in {} "
                    "without gaps, not "
                    "at samples.",
                    waypoint_text(view, view.path.waypoints.front()), waypoint_text(view, view.path.waypoints.back()),
                    view.problem.name, common_limits(robot.tension_N, false), common_limits(robot.length_m, true),
                    plural(view.segments.size(), "segment"), plural(view.boxes, "box")));
  }
  result.push_back(fmt::format(
      "Proved reserves along the whole motion: every tension stays at least {} N inside its limits (least "
      "in {}), every "
      "length at least {} mm (least in {}), and the load ellipsoid could grow at least {}-fold before a tension "
      "limit is reached "
      "(least in {}).",
      plain(view.margins->tension_N), where_least(view, &MarginsView::tension_N), millimetres(view.margins->length_m),
      where_least(view, &MarginsView::length_m), plain(view.margins->wrench_scale),
      where_least(view, &MarginsView::wrench_scale)));
  if (const std::string closest = closest_text(scene); !closest.empty()) result.push_back(closest);
  return result;
}

std::vector<std::string> refuted_text(const Scene& scene) {
  const WitnessView& witness = *scene.view.witness;
  std::vector<std::string> result = {"Refuted: this motion is not wrench-feasible."};
  const std::string at = point_text(scene.view, witness.at);
  const Pose<double> pose = scene.sampler.at(scene.view.path, witness.at.position).pose;
  if (witness.to) {
    result.push_back(fmt::format(
        "The determinant of the force Jacobian has opposite signs at {} and at {}. Somewhere between these two poses "
        "the motion therefore passes a singular pose, where the cables can't balance every load.",
        at, point_text(scene.view, *witness.to)));
    result.push_back(fmt::format("The first of the two poses, rounded: {}. The second: {}.", pose_text(pose),
                                 pose_text(scene.sampler.at(scene.view.path, witness.to->position).pose)));
    return result;
  }
  const bool length = witness.kind.starts_with("length");
  const bool upper = witness.kind.ends_with("max");
  const auto text = [&](const DecimalText& value) { return length ? millimetres(value) : plain(value); };
  const char* unit = length ? "mm" : "N";
  const std::string subject =
      length ? fmt::format("cable {} has a length", witness.cable)
             : fmt::format("some load in the given ellipsoid of wrenches gives cable {} a tension", witness.cable);
  result.push_back(fmt::format("At {}, {} of {} {} {}: not {} its {} limit of {} {}.", at, subject,
                               upper ? "at least" : "at most",
                               upper ? text(witness.value_lower) : text(witness.value_upper), unit,
                               upper ? "below" : "above", upper ? "upper" : "lower", text(witness.limit), unit));
  result.push_back(fmt::format("That value was proved to lie between {} and {} {}. The pose, rounded: {}.",
                               text(witness.value_lower), text(witness.value_upper), unit, pose_text(pose)));
  return result;
}

std::vector<std::string> undecided_text(const Scene& scene) {
  const UndecidedView& open = *scene.view.undecided;
  std::vector<std::string> result = {"Undecided: nothing is claimed about this motion."};
  result.push_back(
      fmt::format("It was neither proved nor refuted; that does not mean that it is unsafe. Reason: {}", open.reason));
  if (open.segment) {
    result.push_back(fmt::format(
        "What is open lies on {}{}.", segment_text(scene.view, *open.segment),
        open.box_lower.empty() ? "" : fmt::format(", from s = {} to s = {}", open.box_lower, open.box_upper)));
  }
  return result;
}

}  // namespace

std::vector<std::string> verdict_text(const Scene& scene) {
  if (scene.view.verdict == "proved") return proved_text(scene);
  return scene.view.verdict == "refuted" ? refuted_text(scene) : undecided_text(scene);
}

}  // namespace taut
