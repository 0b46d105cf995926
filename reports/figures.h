// The report's pictures. All of them are floating-point samples of what the certificate is about.
#pragma once

#include "reports/markup.h"
#include "reports/scene.h"

namespace taut {

/// The robot at the first and the last waypoint, and at the witness if there is one, seen from the side.
[[nodiscard]] Html robot_figure(const Scene& scene);
/// f0 ± v of each cable along the path, between its limits.
[[nodiscard]] Html tension_figure(const Scene& scene);
/// Length of each cable along the path, between its limits.
[[nodiscard]] Html length_figure(const Scene& scene);
/// Position and orientation of the platform along the path.
[[nodiscard]] Html pose_figure(const Scene& scene);
/// Whether any values of the space's parameters, which are two, give a pose: then there is a plane to draw.
[[nodiscard]] bool is_plane(const SpaceText& space);
/// The plane of two parameters with the feasible set, the atlas and the path; nothing unless there is one.
[[nodiscard]] Html slice_figure(const Scene& scene);

}  // namespace taut
