// Axes and curves as inline SVG. Colours and fonts come from the page's style by class, so that a picture follows the
// reader's light or dark theme.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "reports/markup.h"

namespace taut {

/// Values on an axis, lower < upper.
struct Span {
  double lower = 0;
  double upper = 1;
  /// Contains nothing yet; lower > upper.
  [[nodiscard]] static Span empty() {
    return {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  }
  [[nodiscard]] double length() const { return upper - lower; }
  /// Widened to contain x; NaN and infinities are ignored.
  void include(double x);
};

/// About `count` round numbers (1, 2 or 5 times a power of ten apart, whole ones where `whole`) within `span`.
[[nodiscard]] std::vector<double> ticks(const Span& span, int count, bool whole = false);

/// Coordinate in a picture: one decimal at most, and finite for any x, so that hostile numbers stay short.
[[nodiscard]] std::string coordinate(double x);

struct Axis {
  Span span;
  Html label;  ///< name and unit
  int tick_count = 5;
  bool whole = false;               ///< ticks are counts
  std::vector<double> limits = {};  ///< written at the far side
};

struct PlotPoint {
  double x = 0;
  double y = 0;
};

/// A rectangle of `width` by `height` units of the picture that shows axis spans; points outside it are cut off.
class Plot {
 public:
  Plot(double width, double height, Axis x, Axis y)
      : width_(width), height_(height), x_(std::move(x)), y_(std::move(y)) {}

  [[nodiscard]] double x(double value) const { return (value - x_.span.lower) / x_.span.length() * width_; }
  [[nodiscard]] double y(double value) const { return (y_.span.upper - value) / y_.span.length() * height_; }
  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] double height() const { return height_; }

  /// Path data of a polyline; it breaks at points that are not finite.
  [[nodiscard]] std::string polyline(const std::vector<PlotPoint>& points, bool closed = false) const;

  /// The rectangle with `content` in it, framed by ticks, their numbers and the axes' labels, as an <svg> that scales
  /// with the page. `overlay` may reach beyond the rectangle; `description` is what a screen reader says.
  [[nodiscard]] Html svg(const Html& content, const std::string& description, const Html& overlay = {}) const;

 private:
  double width_;
  double height_;
  Axis x_;
  Axis y_;
};

}  // namespace taut
