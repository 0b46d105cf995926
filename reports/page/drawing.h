// SPDX-License-Identifier: GPL-3.0-or-later
// What drawings of a machine are made of: hulls, hatching, and places for labels such that none hides another.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

namespace taut {

using Point2 = Eigen::Vector2d;

/// Coordinate in a picture: one decimal at most, and finite for any x, so that hostile numbers stay short.
[[nodiscard]] std::string coordinate(double x);
/// "M0 0L1 0", and "Z" if it is closed.
[[nodiscard]] std::string path_data(const std::vector<Point2>& points, bool closed);

/// The greatest of 1, 2 and 5 times a power of ten that is not above `most`. @pre most is finite and above 0
[[nodiscard]] double round_length(double most);

/// Indices of the corners of the convex hull in the plane, counter-clockwise where y points up. Points that coincide
/// give one corner.
[[nodiscard]] std::vector<std::size_t> hull(const std::vector<Point2>& points);

/// The corners of the outline of all within a radius of the convex hull of some points.
[[nodiscard]] std::vector<Point2> outline_of(const std::vector<Point2>& points, double radius);

/// A side of a body in space.
struct Face {
  std::vector<Eigen::Vector3d> corners;  ///< counter-clockwise, seen from outside
  Eigen::Vector3d normal;                ///< outward, of length 1
};
/// The sides of the convex hull of a few points; a flat one has two, opposite to each other. None if the points are on
/// a line.
[[nodiscard]] std::vector<Face> hull_faces(const std::vector<Eigen::Vector3d>& points);
/// The points without those that coincide with one before.
[[nodiscard]] std::vector<Eigen::Vector3d> distinct(const std::vector<Eigen::Vector3d>& points);

/// Oblique lines, `spacing` apart, inside a convex polygon: pairs of ends.
[[nodiscard]] std::vector<std::pair<Point2, Point2>> hatching(const std::vector<Point2>& polygon, double spacing);

/// A label's rectangle.
struct LabelBox {
  Point2 centre;
  Point2 half;  ///< half its width and height
};
/// About the room that a text takes in the report's typeface.
[[nodiscard]] Point2 half_size(const std::string& text, double font_size);

/// Finds places for labels inside a frame, each apart from those before.
class LabelPlacer {
 public:
  explicit LabelPlacer(const Point2& frame) : frame_(frame) {}

  /// No label is to cover this.
  void keep_clear(const LabelBox& box) { taken_.push_back(box); }
  /// Labels should rather not be on this line.
  void avoid(const Point2& a, const Point2& b) { lines_.emplace_back(a, b); }

  struct Candidate {
    Point2 centre;
    double cost = 0;    ///< 0 for the best; 1 is as bad as to be on a line
    int own_line = -1;  ///< index of the avoided line that the label belongs to
  };
  /// The index of the best candidate for a label, which is from then on kept clear. @pre there is a candidate
  std::size_t place(const Point2& half, const std::vector<Candidate>& candidates);

 private:
  [[nodiscard]] double cost(const LabelBox& box, int own_line) const;

  Point2 frame_;
  std::vector<LabelBox> taken_;
  std::vector<std::pair<Point2, Point2>> lines_;
};

}  // namespace taut
