// The report's sections with pictures: the move, and plots of what happens along it.
#pragma once

#include "reports/markup.h"
#include "reports/scene.h"

namespace taut {

/// The robot in its poses; nothing where there is no path.
[[nodiscard]] Html move_section(const Scene& scene);
/// Tensions, lengths and pose along the path, and the plane of two parameters; each where there is one.
[[nodiscard]] Html plot_sections(const Scene& scene);

}  // namespace taut
