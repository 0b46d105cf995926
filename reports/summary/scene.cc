#include "reports/summary/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace taut {

namespace {

constexpr std::size_t kPathSamples = 800;   ///< along the whole path; about one a pixel of a wide plot
constexpr std::size_t kManyBoxes = 20'000;  ///< more are not halved: each is a fraction of a pixel

PathRanges ranges_of(const CertificateView& view) {
  if (view.boxes == 0) return {};
  RangeOptions options;
  if (view.boxes > kManyBoxes) options.most_halvings = 0;
  return path_ranges(Prover(view.problem), view.path, view.segment_boxes, options);
}

bool is_covered(const std::vector<DyadicBox>& boxes) {
  Dyadic reached{0, 0};
  for (const DyadicBox& box : boxes) {
    if (box.lower() != reached) return false;
    reached = box.upper();
  }
  return reached == Dyadic{1, 0};
}

}  // namespace

Scene::Scene(const nlohmann::json& certificate)
    : view(read_certificate(certificate)),
      sampler(view.problem),
      samples(sampler.along(view.path, kPathSamples)),
      travel(sampler, view.path),
      ranges(ranges_of(view)) {
  ranges_are_whole = !view.segments.empty() && view.segments.size() == view.path.segments() && ranges.missing == 0 &&
                     std::ranges::all_of(view.segment_boxes, is_covered);
}

std::string unit(const SpaceText& space, std::size_t j) {
  const Parameter& parameter = space.parameters[j];
  for (std::size_t c = 0; c < space.pose.size(); ++c) {
    if (space.pose[c] == parameter.name) return c < 3 ? "m" : "rad";
  }
  const bool angular = parameter.kind == ParameterKind::kPeriodic ||
                       (parameter.range_lower + parameter.range_upper).find("pi") != std::string::npos;
  return angular ? "rad" : "";
}

std::string in_brackets(const std::string& unit) { return unit.empty() ? "" : fmt::format("[{}]", unit); }

}  // namespace taut
