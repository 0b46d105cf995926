// SPDX-License-Identifier: GPL-3.0-or-later
// A still picture of the machine at one place of its path, for the first page, for paper and for browsers that draw no
// moving picture. It is computed in floating point and proves nothing.
#pragma once

#include <array>
#include <string>

#include "reports/page/machine_view.h"
#include "reports/page/markup.h"
#include "reports/summary/nearness.h"

namespace taut {

/// How near each cable is to the nearer of its limits at one pose, over all loads and in floating point; out where the
/// pose is singular.
[[nodiscard]] std::array<Nearness, kCables> nearness_at(const Model<double>& model, const Statics<double>& statics);

/// The size of a picture's page [px], of which its text has 15.
struct PictureSize {
  double width = 520;
  double greatest_height = 600;
};

/// The machine at a position of the path, its cables coloured by how near they are to their limits; the start and the
/// goal as dashed outlines; fitted to all that the path sweeps. Nothing if there is no path, and words where numbers
/// are too large to be drawn. @param position counts segments; clamped to the path
/// @param note  below the picture
[[nodiscard]] Html machine_picture(const ReportContext& scene, double position,
                                   const std::array<Nearness, kCables>& nearness, const std::string& caption,
                                   const Html& note);
/// The same, where many pictures of a machine share a view. @pre `view` is of `scene`
[[nodiscard]] Html machine_picture(const ReportContext& scene, const MachineView& view, double position,
                                   const std::array<Nearness, kCables>& nearness, const std::string& caption,
                                   const PictureSize& size, const Html& note = {});

/// Says what of the picture is a body that is checked; nothing where there are none.
[[nodiscard]] Html bodies_note(const ReportContext& scene);
/// Says of the frame and the payload that pictures show that nothing checks them; nothing where none are shown.
[[nodiscard]] Html shown_bodies_note(const ReportContext& scene);

}  // namespace taut
