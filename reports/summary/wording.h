// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers, names and places as text.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "base/plural.h"
#include "kinematics/model.h"
#include "reports/summary/scene.h"

namespace taut {

/// The same number, without an exponent if it is readable without.
[[nodiscard]] std::string plain(const DecimalText& decimal);
/// The same length in millimetres, exactly.
[[nodiscard]] std::string millimetres(const DecimalText& metres);
/// `digits` significant digits, rounded towards −∞ or +∞, without an exponent if it is readable without.
[[nodiscard]] std::string rounded_down(double x, int digits = 4);
[[nodiscard]] std::string rounded_up(double x, int digits = 4);
/// The same rounded to nearest.
[[nodiscard]] std::string rounded_to_nearest(double x, int digits = 4);
/// The number that a text of these begins with; not a number if it is none.
[[nodiscard]] double number_in(const std::string& text);
/// An SI value in a unit, without its name, in the fewest digits (at least three) that keep it on its side of a limit:
/// rounded up, for what stays below an upper limit or is proved at most that.
[[nodiscard]] std::string up_text(double si, double limit_si, const DisplayUnit& unit);
/// The same rounded down, for what stays above a lower limit or is proved at least that.
[[nodiscard]] std::string down_text(double si, double limit_si, const DisplayUnit& unit);
/// The same rounded towards the limit, for samples: wherever one is shown, so that no two places differ, and as what a
/// witness proves of the same place is.
[[nodiscard]] std::string sampled_text(double si, double limit_si, const DisplayUnit& unit);
/// The text with a minus sign for each hyphen that begins a number: "(-1, 2)" becomes "(−1, 2)". Not for numbers that
/// are to be copied, nor for commands.
[[nodiscard]] std::string with_minus_signs(std::string_view text);
/// The first `digits` significant digits of a decimal, the rest cut off: rounded towards 0, exactly.
[[nodiscard]] std::string truncated(const DecimalText& decimal, int digits = 3);
/// "1.12", "1.0009": a factor of at least 1, cut off after three digits, or after the first that tells it from 1.
[[nodiscard]] std::string growth_text(const DecimalText& factor);
/// "(-190.5256, -110, 0)": exactly.
[[nodiscard]] std::string triple(const std::array<DecimalText, 3>& metres, const DisplayUnit& unit);
/// "0.2°" if the angle was typed in degrees, else "0.0035 rad (0.200535°)"; exactly the same angle, but in the
/// brackets, which are left out where no precision here tells six digits.
[[nodiscard]] std::string angle_text(const ExpressionText& radians);

/// The names of a waypoint's numbers, and their units.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> coordinates(const Certificate& certificate);
/// Its numbers, such as "-2.3" or "-2.3 + 2π": they read back exactly.
[[nodiscard]] std::vector<std::string> coordinate_texts(const Waypoint& waypoint);
/// "(phi, theta) = (-2.3, 1.6)"
[[nodiscard]] std::string waypoint_text(const Certificate& certificate, const Waypoint& waypoint);
/// "segment 1, between waypoints 1 and 2"
[[nodiscard]] std::string segment_text(const Certificate& certificate, int k);
/// "s = 3/8 of segment 1, …"
[[nodiscard]] std::string point_text(const Certificate& certificate, const PathPoint& point);
/// "p = (0, 0, 350) mm, φ = …", in the case's angles, within the range that people use: rounded to a
/// micrometre and a thousandth of a degree.
[[nodiscard]] std::string pose_text(const ReportContext& scene, const Pose<double>& pose);

/// The signs of a pose's angles: φ, θ, σ; roll, pitch, yaw; α, β, γ; turn.
[[nodiscard]] std::vector<std::string> angle_symbols(AngleKind kind);
/// "tilt φ, θ and torsion σ, with R = Rz(φ) Ry(θ) Rz(σ − φ)"
[[nodiscard]] std::string rotation_formula(const AnglesText& angles);

/// "4.2 m", "12 mm": rounded.
[[nodiscard]] std::string distance_text(double metres);
/// "4.2 m into the move (segment 17)", or the angle turned if the platform's origin does not move; with the time, if
/// the path has times. Of a move in time "4.2 s after the start (segment 3, s = 0.2)".
/// `position` counts segments: k + s is the point s of segment k.
[[nodiscard]] std::string place_text(const ReportContext& scene, double position);
/// "segment 17 at s = 0.525, 4.2 m into the move, t = 3 s"; of two places that differ in six digits, "between segment 2
/// at s = 0.5 and segment 2 at s = 0.625, …", with the travel to the first.
[[nodiscard]] std::string place_in_full(const ReportContext& scene, double from, double to);

}  // namespace taut
