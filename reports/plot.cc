#include "reports/plot.h"

#include <algorithm>
#include <cmath>

namespace taut {

namespace {

constexpr double kLeft = 52;    ///< room for the numbers and the label of the y axis
constexpr double kBottom = 38;  ///< of the x axis
constexpr double kTop = 8;
constexpr double kRight = 32;     ///< for the limits
constexpr double kFarAway = 1e5;  ///< anything beyond is outside every picture

double tick_step(const Span& span, int count, bool whole) {
  const double rough = span.length() / count;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough * 0.8) {
      step = factor * power;
      break;
    }
  }
  return whole ? std::max(1.0, step) : step;
}

std::string tick_text(double value, double step) {
  const int decimals = std::clamp(static_cast<int>(-std::floor(std::log10(step) + 1e-9)), 0, 12);
  std::string text = fmt::format("{:.{}f}", std::abs(value) < step * 1e-6 ? 0.0 : value, decimals);
  if (text.front() == '-') text.replace(0, 1, "\u2212");
  return text;
}

}  // namespace

void Span::include(double x) {
  if (!std::isfinite(x)) return;
  lower = std::min(lower, x);
  upper = std::max(upper, x);
}

std::vector<double> ticks(const Span& span, int count, bool whole) {
  std::vector<double> result;
  if (!(span.length() > 0) || !std::isfinite(span.length())) return result;
  const double step = tick_step(span, count, whole);
  const double first = std::ceil(span.lower / step - 1e-9);
  for (int i = 0; i <= 4 * count; ++i) {
    const double value = (first + i) * step;
    if (value > span.upper + 1e-9 * span.length()) break;
    result.push_back(value);
  }
  return result;
}

std::string coordinate(double x) {
  const double bounded = std::isfinite(x) ? std::clamp(x, -kFarAway, kFarAway) : kFarAway;
  const double tenths = std::round(bounded * 10);
  if (std::fmod(tenths, 10) == 0) return fmt::format("{:.0f}", tenths == 0 ? 0.0 : tenths / 10);
  return fmt::format("{:.1f}", tenths / 10);
}

std::string Plot::polyline(const std::vector<PlotPoint>& points, bool closed) const {
  std::string data;
  bool drawing = false;
  for (const PlotPoint& point : points) {
    if (!std::isfinite(point.x) || !std::isfinite(point.y)) {
      drawing = false;
      continue;
    }
    data += fmt::format("{}{} {}", drawing ? 'L' : 'M', coordinate(x(point.x)), coordinate(y(point.y)));
    drawing = true;
  }
  if (closed && !data.empty()) data += "Z";
  return data;
}

Html Plot::svg(const Html& content, const std::string& description, const Html& overlay) const {
  Html grid;
  Html numbers;
  const double x_step = tick_step(x_.span, x_.tick_count, x_.whole);
  for (const double value : ticks(x_.span, x_.tick_count, x_.whole)) {
    const std::string at = coordinate(x(value));
    grid += html("<path class=\"grid\" d=\"M{} 0V{}\"/>", at, coordinate(height_));
    numbers += html("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>", at, coordinate(height_ + 14),
                    tick_text(value, x_step));
  }
  const double y_step = tick_step(y_.span, y_.tick_count, y_.whole);
  for (const double value : ticks(y_.span, y_.tick_count, y_.whole)) {
    const std::string at = coordinate(y(value));
    grid += html("<path class=\"grid\" d=\"M0 {}H{}\"/>", at, coordinate(width_));
    numbers += html("<text x=\"-6\" y=\"{}\" text-anchor=\"end\">{}</text>", coordinate(y(value) + 3.5),
                    tick_text(value, y_step));
  }
  for (const double value : y_.limits) {
    numbers += html("<text class=\"bound\" x=\"{}\" y=\"{}\">{:.4g}</text>", coordinate(width_ + 4),
                    coordinate(y(value) + 3.5), value);
  }
  return html(
      "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\"><g transform=\"translate({} {})\">\n"
      "{}<svg width=\"{}\" height=\"{}\">{}</svg>\n"
      "<rect class=\"frame\" width=\"{}\" height=\"{}\"/>{}"
      "<text class=\"label\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>"
      "<text class=\"label\" transform=\"translate(-41 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>"
      "{}</g></svg>\n",
      coordinate(kLeft + width_ + kRight), coordinate(kTop + height_ + kBottom), description, coordinate(kLeft),
      coordinate(kTop), grid, coordinate(width_), coordinate(height_), content, coordinate(width_), coordinate(height_),
      numbers, coordinate(width_ / 2), coordinate(height_ + 31), x_.label, coordinate(height_ / 2), y_.label, overlay);
}

}  // namespace taut
