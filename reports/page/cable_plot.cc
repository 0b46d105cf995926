// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/cable_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/summary/cable_use.h"
#include "reports/summary/numbers.h"

namespace taut {

namespace {

// Of the drawing [px]; room for the labels at the left, and for the axis below.
constexpr double kLeft = 52;
constexpr double kRight = 8;
constexpr double kTop = 8;
constexpr double kBottom = 26;
constexpr double kWidth = 560;
constexpr double kHeight = 160;
constexpr double kBeyond = 0.3;  ///< of the width between the limits that is shown beyond each of them

struct Frame {
  double lower = 0, upper = 1;  ///< [N, m]
  double last = 1;              ///< position

  [[nodiscard]] double x(double position) const { return kLeft + (kWidth - kLeft - kRight) * position / last; }
  [[nodiscard]] double y(double value) const {
    const double share = std::clamp((value - lower) / (upper - lower), 0.0, 1.0);
    return kTop + (kHeight - kTop - kBottom) * (1 - share);
  }
};

/// The area between least and greatest value, in pieces where there is no value.
std::string area(const std::vector<std::pair<double, Range>>& samples, const Frame& frame) {
  std::string path;
  for (std::size_t begin = 0; begin < samples.size();) {
    std::size_t end = begin;
    while (end < samples.size() && std::isfinite(samples[end].second.lower + samples[end].second.upper)) ++end;
    std::string there;
    std::string back;
    for (std::size_t k = begin; k < end; ++k) {
      const auto& [position, range] = samples[k];
      there += fmt::format("{}{:.1f} {:.1f}", k == begin ? 'M' : 'L', frame.x(position), frame.y(range.upper));
      back.insert(0, fmt::format("L{:.1f} {:.1f}", frame.x(position), frame.y(range.lower)));
    }
    if (end > begin) path += there + back + "Z";
    begin = std::max(end, begin + 1);
  }
  return path;
}

Html limit(const Frame& frame, double value, const std::string& text) {
  const double y = frame.y(value);
  return html(
      "<path class=\"limit\" d=\"M{:.1f} {:.1f}H{:.1f}\"/><text x=\"{:.1f}\" y=\"{:.1f}\" class=\"end\">{}</text>",
      kLeft, y, kWidth - kRight, kLeft - 5, y + 4, text);
}

}  // namespace

Html cable_plot(const ReportContext& scene, const CablePlot& plot) {
  if (scene.certificate.path.segments() == 0 || scene.samples.empty() || found_no_path(scene.certificate)) return {};
  const RobotText& robot = scene.certificate.problem.robot;
  const Limits& limits = (plot.is_length ? robot.length_m : robot.tension_N)[plot.cable];
  const double lower = nearest_double(limits.lower);
  const double upper = nearest_double(limits.upper);
  const double beyond = kBeyond * (upper - lower);
  const Frame frame{lower - beyond, upper + beyond, std::max(scene.samples.back().position, 1e-300)};
  std::vector<std::pair<double, Range>> values;
  for (const PathSample& sample : scene.samples) {
    const Statics<double>& s = sample.statics;
    const double d = s.length[plot.cable];
    const double f = s.tension[plot.cable];
    values.emplace_back(sample.position, plot.is_length
                                             ? Range{d, d}
                                             : Range{f - s.tension_below[plot.cable], f + s.tension_above[plot.cable]});
  }
  const DisplayUnit& unit = scene.illustration.units.of(plot.is_length);
  const double right = kWidth - kRight;
  const double bottom = kHeight - kBottom;
  const auto forbidden = [&](double from, double to) {
    return html("<rect class=\"forbidden\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>", kLeft, from,
                right - kLeft, to - from);
  };
  const Html mark =
      plot.marked ? html("<path class=\"mark\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>", frame.x(*plot.marked), kTop, bottom)
                  : Html();
  const std::string what = fmt::format("{} of cable {} along the move [{}]", plot.is_length ? "Length" : "Tension",
                                       plot.cable + 1, unit.name());
  const Certificate& certificate = scene.certificate;
  const std::string basis =
      std::string(certificate.problem.tolerances ? " on the machine as stated" : "") +
      (certificate.path.interpolation == Interpolation::kCableLengths ? " at poses found next to the reference" : "");
  return html(
      "<figure class=\"cable-plot\"><figcaption>{}, sampled{}; shaded: beyond a limit{}</figcaption><svg "
      "viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">{}{}<path class=\"band\" d=\"{}\"/>{}{}{}"
      "<rect class=\"frame\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/><text x=\"{}\" y=\"{}\">start</text>"
      "<text x=\"{}\" y=\"{}\" class=\"end\">end</text></svg></figure>\n",
      what, basis,
      !plot.marked         ? ""
      : plot.is_of_deviant ? "; dashed: where a machine within the tolerances breaks it"
                           : "; dashed: where it is broken",
      kWidth, kHeight, what, forbidden(kTop, frame.y(upper)), forbidden(frame.y(lower), bottom), area(values, frame),
      limit(frame, lower, unit.exact(limits.lower)), limit(frame, upper, unit.exact(limits.upper)), mark, kLeft, kTop,
      right - kLeft, bottom - kTop, kLeft, kHeight - 8, right, kHeight - 8);
}

Html distance_plot(const ReportContext& scene, const BrokenLimit& broken) {
  if (!scene.bodies) return {};
  if (scene.certificate.path.segments() == 0 || scene.samples.empty() || found_no_path(scene.certificate)) return {};
  const std::size_t pair = broken.bodies->pair;
  std::vector<std::pair<double, Range>> values;
  double least = 0;
  double greatest = broken.bodies->clearance;
  std::vector<double> clearance;
  for (const PathSample& sample : scene.samples) {
    const BodyDistance there = scene.bodies.value().at(scene.sampler.model(), scene.sampler.rigid_pose(sample), pair);
    values.emplace_back(sample.position, Range{there.distance, there.distance});
    clearance.push_back(there.clearance);
    least = std::min({least, there.distance, there.clearance});
    greatest = std::max({greatest, there.distance, there.clearance});
  }
  const double beyond = 0.08 * std::max(greatest - least, 1e-300);
  const Frame frame{least - beyond, greatest + beyond, std::max(scene.samples.back().position, 1e-300)};
  const DisplayUnit& unit = scene.illustration.units.length;
  const double right = kWidth - kRight;
  const double bottom = kHeight - kBottom;
  std::string forbidden = fmt::format("M{} {:.1f}", kLeft, bottom);  // in steps halfway between samples
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double next = k + 1 < values.size() ? (values[k].first + values[k + 1].first) / 2 : values[k].first;
    forbidden += fmt::format("V{:.1f}H{:.1f}", frame.y(clearance[k]), frame.x(next));
  }
  forbidden += fmt::format("V{:.1f}Z", bottom);
  const std::string what = fmt::format("Distance of {} along the move [{}]", scene.bodies->name(pair), unit.name());
  const Html zero = broken.bodies->clearance != 0 ? limit(frame, 0, "0") : Html();
  return html(
      "<figure class=\"cable-plot\"><figcaption>{}, sampled; below 0: how deep in each other, about; shaded: nearer "
      "than "
      "the clearance; dashed: where that is broken</figcaption><svg viewBox=\"0 0 {} {}\" role=\"img\" "
      "aria-label=\"{}\"><path class=\"forbidden\" d=\"{}\"/>"
      "<path class=\"band\" d=\"{}\"/>{}{}<path class=\"mark\" d=\"M{:.1f} {:.1f}V{:.1f}\"/><rect class=\"frame\" "
      "x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/><text x=\"{}\" y=\"{}\">start</text><text x=\"{}\" y=\"{}\" "
      "class=\"end\">end</text></svg></figure>\n",
      what, kWidth, kHeight, what, forbidden, area(values, frame), zero,
      limit(frame, broken.bodies->clearance, unit.exact(broken.limit)), frame.x(broken.position), kTop, bottom, kLeft,
      kTop, right - kLeft, bottom - kTop, kLeft, kHeight - 8, right, kHeight - 8);
}

}  // namespace taut
