#include "reports/scene.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace taut {

namespace {

constexpr std::size_t kPathSamples = 800;  ///< along the whole path; about one a pixel of a wide plot

}  // namespace

Scene::Scene(const nlohmann::json& certificate)
    : view(read_certificate(certificate)),
      sampler(view.problem),
      samples(sampler.along(view.path, kPathSamples)),
      travel(sampler, view.path),
      ranges(view.segment_boxes.empty() ? PathRanges()
                                        : path_ranges(Prover(view.problem), view.path, view.segment_boxes)) {}

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
