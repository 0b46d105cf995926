#include "reports/figures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>

#include "reports/plot.h"

namespace taut {

namespace {

constexpr double kDegrees = 180 / 3.14159265358979323846;
constexpr double kMillimetres = 1000;
constexpr double kPanelWidth = 270;  ///< of small multiples, three to a row
constexpr double kPanelHeight = 150;

Axis path_axis(const Scene& scene) {
  const Path& path = scene.view.path;
  const Html label = html("{}", path.interpolation == Interpolation::kCubicBSpline ? "segment" : "waypoint");
  return {{0, std::max(1.0, static_cast<double>(path.segments()))}, label, 8, true};
}

/// The witness's points and the open box, over the whole height of a plot along the path.
Html marks(const Scene& scene, const Plot& plot) {
  Html result;
  const auto line = [&](double position) {
    result += html("<path class=\"mark\" d=\"M{} 0V{}\"/>", coordinate(plot.x(position)), coordinate(plot.height()));
  };
  if (const auto& witness = scene.view.witness) {
    line(witness->at.position);
    if (witness->to) line(witness->to->position);
  }
  if (const auto& open = scene.view.undecided; open && open->segment) {
    const double from = plot.x(*open->segment + open->lower);
    const double to = plot.x(*open->segment + open->upper);
    result += html("<rect class=\"open\" x=\"{}\" width=\"{}\" height=\"{}\"/>", coordinate(from),
                   coordinate(std::max(2.0, to - from)), coordinate(plot.height()));
  }
  return result;
}

/// What lies beyond an open interval of limits.
Html forbidden(const Plot& plot, const Span& limits) {
  const double top = std::clamp(plot.y(limits.upper), 0.0, plot.height());
  const double bottom = std::clamp(plot.y(limits.lower), 0.0, plot.height());
  return html(
      "<rect class=\"forbidden\" width=\"{0}\" height=\"{1}\"/><rect class=\"forbidden\" y=\"{2}\" width=\"{0}\" "
      "height=\"{3}\"/><path class=\"limit\" d=\"M0 {1}H{0}M0 {2}H{0}\"/>",
      coordinate(plot.width()), coordinate(top), coordinate(bottom), coordinate(plot.height() - bottom));
}

/// An axis that shows the limits, and a little beyond; up to half of their width beyond where the data go there.
Axis limited_axis(const Span& limits, const Span& data, const Html& label) {
  const double width = limits.length();
  const Span shown = {
      std::max(std::min(limits.lower - 0.1 * width, data.lower - 0.04 * width), limits.lower - 0.5 * width),
      std::min(std::max(limits.upper + 0.1 * width, data.upper + 0.04 * width), limits.upper + 0.5 * width)};
  return {shown, label, 6, false, {limits.lower, limits.upper}};
}

Html panel(const Html& title, const Html& picture) {
  return html("<figure class=\"panel\"><figcaption>{}</figcaption>{}</figure>\n", title, picture);
}

/// "0.08 … 0.42 N"
Html extent(const Span& data, const char* unit) { return html("{:.3g} … {:.3g} {}", data.lower, data.upper, unit); }

std::vector<std::vector<PlotPoint>> regular_runs(const Scene& scene, std::size_t cable, int sign) {
  std::vector<std::vector<PlotPoint>> runs(1);
  double determinant = 0;
  for (const PathSample& sample : scene.samples) {
    const Statics<double>& s = sample.statics;
    if (!s.regular || s.determinant * determinant < 0) runs.emplace_back();  // f0 has a pole between
    determinant = s.regular ? s.determinant : 0;
    if (s.regular) runs.back().push_back({sample.position, s.tension[cable] + sign * s.variation[cable]});
  }
  return runs;
}

Html tension_panel(const Scene& scene, std::size_t cable) {
  const Model<double>& model = scene.sampler.model();
  const Span limits = {model.tension_lower[cable], model.tension_upper[cable]};
  const auto low = regular_runs(scene, cable, -1);
  const auto middle = regular_runs(scene, cable, 0);
  const auto high = regular_runs(scene, cable, 1);
  Span data = Span::empty();
  for (std::size_t r = 0; r < low.size(); ++r) {
    for (const PlotPoint& point : low[r]) data.include(point.y);
    for (const PlotPoint& point : high[r]) data.include(point.y);
  }
  const Plot plot(kPanelWidth, kPanelHeight, path_axis(scene), limited_axis(limits, data, html("tension [N]")));
  Html curves = forbidden(plot, limits);
  for (std::size_t r = 0; r < low.size(); ++r) {
    std::vector<PlotPoint> band = low[r];
    band.insert(band.end(), high[r].rbegin(), high[r].rend());
    curves += html("<path class=\"band\" d=\"{}\"/><path class=\"curve\" d=\"{}\"/>", plot.polyline(band, true),
                   plot.polyline(middle[r]));
  }
  return panel(html("Cable {} <span>{}</span>", cable + 1, extent(data, "N")),
               plot.svg(curves + marks(scene, plot), fmt::format("Tension of cable {} along the path", cable + 1)));
}

Html length_panel(const Scene& scene, std::size_t cable) {
  const Model<double>& model = scene.sampler.model();
  const Span limits = {model.length_lower[cable] * kMillimetres, model.length_upper[cable] * kMillimetres};
  Span data = Span::empty();
  std::vector<PlotPoint> points;
  for (const PathSample& sample : scene.samples) {
    points.push_back({sample.position, sample.statics.length[cable] * kMillimetres});
    data.include(points.back().y);
  }
  const Plot plot(kPanelWidth, kPanelHeight, path_axis(scene), limited_axis(limits, data, html("length [mm]")));
  const Html curves =
      forbidden(plot, limits) + html("<path class=\"curve\" d=\"{}\"/>", plot.polyline(points)) + marks(scene, plot);
  return panel(html("Cable {} <span>{}</span>", cable + 1, extent(data, "mm")),
               plot.svg(curves, fmt::format("Length of cable {} along the path", cable + 1)));
}

Html all_cables(const Scene& scene, Html (*make)(const Scene&, std::size_t)) {
  Html panels;
  for (std::size_t i = 0; i < kCables; ++i) panels += make(scene, i);
  return html("<div class=\"panels\">{}</div>\n", panels);
}

/// Three coordinates of the pose along the path, drawn apart by dash pattern as well as by colour.
Html coordinates_panel(const Scene& scene, const std::array<Html, 3>& names, const char* unit,
                       const std::function<double(const Pose<double>&, int)>& value) {
  Span data = Span::empty();
  std::array<std::vector<PlotPoint>, 3> points;
  for (const PathSample& sample : scene.samples) {
    for (int c = 0; c < 3; ++c) {
      points[c].push_back({sample.position, value(sample.pose, c)});
      data.include(points[c].back().y);
    }
  }
  const double pad = std::max(0.06 * data.length(), 1e-3 * std::max(1.0, std::abs(data.upper)));
  const Plot plot(430, kPanelHeight, path_axis(scene), {{data.lower - pad, data.upper + pad}, html("[{}]", unit), 5});
  Html curves;
  Html legend;
  for (int c = 0; c < 3; ++c) {
    curves += html("<path class=\"curve c{}\" d=\"{}\"/>", c, plot.polyline(points[c]));
    legend +=
        html("<span class=\"key\"><svg viewBox=\"0 0 24 8\"><path class=\"curve c{}\" d=\"M0 4H24\"/></svg>{}</span> ",
             c, names[c]);
  }
  return panel(legend, plot.svg(curves + marks(scene, plot), "Pose along the path"));
}

// ---- The plane of two parameters.

constexpr double kSliceWidth = 860;
constexpr double kCell = 2.5;             ///< of the raster, in units of the picture
constexpr std::size_t kMaxCharts = 6000;  ///< drawn; more would only blacken the picture and swell the page

/// Copies of a point of the plane that are the same pose: turns of periodic parameters, and the flip.
struct Image {
  std::array<double, 2> offset{};
  std::array<double, 2> sign = {1, 1};
  [[nodiscard]] PlotPoint of(double x, double y) const { return {sign[0] * x + offset[0], sign[1] * y + offset[1]}; }
};

std::vector<Image> images(const SpaceText& space) {
  std::vector<Image> result;
  constexpr double kPi = 3.14159265358979323846;
  for (int i = -4; i <= 4; ++i) {
    for (int j = -4; j <= 4; ++j) {
      Image image;
      const std::array<int, 2> half_turns = {i, j};
      bool valid = true;
      for (std::size_t c = 0; c < 2; ++c) {
        image.offset[c] = half_turns[c] * kPi;
        const bool periodic = space.parameters[c].kind == ParameterKind::kPeriodic;
        if (half_turns[c] == 0) continue;
        if (!periodic) valid = false;
        if (half_turns[c] % 2 == 0) continue;
        if (!space.flip || (*space.flip)[0] != static_cast<int>(c)) {
          valid = false;
        } else {
          image.sign[static_cast<std::size_t>((*space.flip)[1])] = -1;
        }
      }
      if (valid) result.push_back(image);
    }
  }
  return result;
}

/// What the picture shows of parameter j: the path, and all of a turn, a range, or half a turn of θ.
Span window(const Scene& scene, std::size_t j) {
  constexpr double kPi = 3.14159265358979323846;
  const SpaceText& space = scene.view.problem.space;
  const Parameter& parameter = space.parameters[j];
  Span path = Span::empty();
  for (const Waypoint& waypoint : scene.view.path.waypoints) path.include(resolved(waypoint)[j]);
  if (!(path.length() >= 0)) {  // no path: the query will do
    for (const auto& waypoint : scene.view.problem.query) path.include(evaluate_constant<double>(waypoint[j]));
  }
  const double pad = 0.05 * std::max(path.length(), 1e-3);
  if (parameter.kind == ParameterKind::kPeriodic) {
    if (path.lower >= -kPi && path.upper <= kPi) return {-kPi, kPi};
    const double middle = (path.lower + path.upper) / 2;
    return {std::min(path.lower - pad, middle - kPi), std::max(path.upper + pad, middle + kPi)};
  }
  if (parameter.kind == ParameterKind::kRange) {
    return {evaluate_constant<double>(parameter.range_lower), evaluate_constant<double>(parameter.range_upper)};
  }
  if (space.flip && (*space.flip)[1] == static_cast<int>(j)) {
    constexpr double kPad = 0.15;  // [rad]
    if (-path.lower > path.upper) return {std::min(path.lower - kPad, -kPi), path.upper > 0 ? path.upper + kPad : 0};
    return {path.lower < 0 ? path.lower - kPad : 0, std::max(path.upper + kPad, kPi)};
  }
  for (const ChartView& chart : scene.view.charts) {
    for (const auto& corner : chart.corners) path.include(corner[j]);
  }
  const double margin = std::max(0.08 * path.length(), 0.05);
  return {path.lower - margin, path.upper + margin};
}

/// Runs of equal cells, row by row, as one path a class.
class Raster {
 public:
  Raster(const Sampler& sampler, const Plot& plot, const Span& x, const Span& y)
      : columns_(static_cast<int>(plot.width() / kCell)), rows_(static_cast<int>(plot.height() / kCell)) {
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        const double u = x.lower + x.length() * (column + 0.5) / columns_;
        const double v = y.upper - y.length() * (row + 0.5) / rows_;
        const Statics<double> s = statics(sampler.model(), sampler.pose({u, v}));
        cells_.push_back(feasibility(sampler.model(), s));
        determinant_.push_back(s.regular ? s.determinant : 0);
      }
    }
    width_ = plot.width() / columns_;
    height_ = plot.height() / rows_;
  }

  [[nodiscard]] Html cells() const {
    std::array<std::string, 4> data;
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_;) {
        const Feasibility kind = cells_[row * columns_ + column];
        int end = column + 1;
        while (end < columns_ && cells_[row * columns_ + end] == kind) ++end;
        data[static_cast<std::size_t>(kind)] +=
            fmt::format("M{} {}h{}v1h-{}z", column, row, end - column, end - column);
        column = end;
      }
    }
    Html result;
    constexpr std::array<const char*, 4> kClasses = {"inside", "tension", "length", "both"};
    for (std::size_t kind = 0; kind < 4; ++kind) {
      result += html("<path class=\"{}\" d=\"{}\"/>", kClasses[kind], data[kind]);
    }
    return html("<g class=\"raster\" transform=\"scale({:.4f} {:.4f})\">{}</g>", width_, height_, result);
  }

  /// Where det J changes sign between neighbouring samples: marching squares.
  [[nodiscard]] Html singular_locus() const {
    std::string data;
    for (int row = 0; row + 1 < rows_; ++row) {
      for (int column = 0; column + 1 < columns_; ++column) {
        std::vector<PlotPoint> ends;
        const auto edge = [&](int column0, int row0, int column1, int row1) {
          const double a = determinant_[row0 * columns_ + column0];
          const double b = determinant_[row1 * columns_ + column1];
          if (a * b >= 0) return;
          const double t = a / (a - b);
          ends.push_back(
              {(column0 + 0.5 + t * (column1 - column0)) * width_, (row0 + 0.5 + t * (row1 - row0)) * height_});
        };
        edge(column, row, column + 1, row);
        edge(column + 1, row, column + 1, row + 1);
        edge(column, row + 1, column + 1, row + 1);
        edge(column, row, column, row + 1);
        for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
          data += fmt::format("M{} {}L{} {}", coordinate(ends[i].x), coordinate(ends[i].y), coordinate(ends[i + 1].x),
                              coordinate(ends[i + 1].y));
        }
      }
    }
    return html("<path class=\"singular\" d=\"{}\"/>", data);
  }

 private:
  int columns_;
  int rows_;
  double width_ = 0;
  double height_ = 0;
  std::vector<Feasibility> cells_;   ///< rows_ × columns_, at the centres of cells
  std::vector<double> determinant_;  ///< likewise
};

Html atlas(const Scene& scene, const Plot& plot, const std::vector<Image>& copies) {
  std::string data;
  const std::size_t count = std::min(scene.view.charts.size(), kMaxCharts);
  for (std::size_t k = 0; k < count; ++k) {
    const ChartView& chart = scene.view.charts[k];
    for (const Image& image : copies) {
      const PlotPoint centre = image.of(chart.centre[0], chart.centre[1]);
      const double x = plot.x(centre.x);
      const double y = plot.y(centre.y);
      if (x < -20 || x > plot.width() + 20 || y < -20 || y > plot.height() + 20) continue;
      std::vector<PlotPoint> corners;
      corners.reserve(chart.corners.size());
      for (const auto& corner : chart.corners) corners.push_back(image.of(corner[0], corner[1]));
      data += plot.polyline(corners, true);
    }
  }
  return html("<path class=\"chart\" d=\"{}\"/>", data);
}

Html disc(const Plot& plot, const PlotPoint& point, const char* name, const char* letter) {
  return html("<circle class=\"{}\" cx=\"{}\" cy=\"{}\" r=\"8\"/><text class=\"letter\" x=\"{}\" y=\"{}\">{}</text>",
              name, coordinate(plot.x(point.x)), coordinate(plot.y(point.y)), coordinate(plot.x(point.x)),
              coordinate(plot.y(point.y) + 3.6), letter);
}

Html cross(const Plot& plot, const std::vector<double>& at) {
  return html("<path class=\"witness\" transform=\"translate({} {})\" d=\"M-7 -7L7 7M-7 7L7 -7\"/>",
              coordinate(plot.x(at[0])), coordinate(plot.y(at[1])));
}

Html slice_path(const Scene& scene, const Plot& plot) {
  const Path& path = scene.view.path;
  if (path.waypoints.empty()) return {};
  std::vector<PlotPoint> points;
  Html dots;
  for (const PathSample& sample : scene.samples) points.push_back({sample.parameters[0], sample.parameters[1]});
  for (const Waypoint& waypoint : path.waypoints) {
    const std::vector<double> at = resolved(waypoint);
    dots += html("<circle cx=\"{}\" cy=\"{}\" r=\"2.2\"/>", coordinate(plot.x(at[0])), coordinate(plot.y(at[1])));
  }
  const std::string line = plot.polyline(points);
  Html result = html("<path class=\"casing\" d=\"{0}\"/><path class=\"path\" d=\"{0}\"/><g class=\"waypoints\">{1}</g>",
                     line, dots);
  if (const auto& open = scene.view.undecided; open && open->segment) {
    const std::vector<double> from = scene.sampler.at(path, *open->segment + open->lower).parameters;
    const std::vector<double> to = scene.sampler.at(path, *open->segment + open->upper).parameters;
    result += html("<path class=\"opening\" d=\"{}\"/>", plot.polyline({{from[0], from[1]}, {to[0], to[1]}}));
  }
  return result;
}

/// Start, goal and witness, on top of everything.
Html slice_marks(const Scene& scene, const Plot& plot) {
  const Path& path = scene.view.path;
  if (path.waypoints.empty()) return {};
  const std::vector<double> start = resolved(path.waypoints.front());
  const std::vector<double> goal = resolved(path.waypoints.back());
  Html result = disc(plot, {goal[0], goal[1]}, "goal", "G") + disc(plot, {start[0], start[1]}, "start", "S");
  if (const auto& witness = scene.view.witness) {
    result += cross(plot, scene.sampler.at(path, witness->at.position).parameters);
    if (witness->to) result += cross(plot, scene.sampler.at(path, witness->to->position).parameters);
  }
  return result;
}

Html swatch(const char* kind, const Html& words) {
  return html(
      "<span class=\"key\"><svg viewBox=\"0 0 16 10\"><rect class=\"{}\" width=\"16\" height=\"10\"/></svg>{}</span> ",
      kind, words);
}

Html stroke(const char* kind, const Html& words) {
  return html("<span class=\"key\"><svg viewBox=\"0 0 24 10\"><path class=\"{}\" d=\"M0 5H24\"/></svg>{}</span> ", kind,
              words);
}

// ---- The robot.

using Point2 = Eigen::Vector2d;

/// Convex hull, counter-clockwise (Andrew's monotone chain).
std::vector<Point2> hull(std::vector<Point2> points) {
  std::sort(points.begin(), points.end(),
            [](const Point2& a, const Point2& b) { return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y()); });
  std::vector<Point2> result;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t begin = result.size();
    for (const Point2& p : points) {
      while (result.size() >= begin + 2) {
        const Point2 u = result[result.size() - 1] - result[result.size() - 2];
        const Point2 v = p - result.back();
        if (u.x() * v.y() - u.y() * v.x() > 0) break;
        result.pop_back();
      }
      result.push_back(p);
    }
    result.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return result;
}

/// Looks at the world from the side and a little from above, with the load pulling down.
class Camera {
 public:
  explicit Camera(const Vector6<double>& wrench) {
    Eigen::Vector3d down = wrench.head<3>();
    down = down.norm() > 0 ? Eigen::Vector3d(down.normalized()) : Eigen::Vector3d(-Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d reference = std::abs(down.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
    const Eigen::Vector3d side = (reference - reference.dot(down) * down).normalized();
    const Eigen::Vector3d depth = down.cross(side);
    constexpr double kAzimuth = 0.35;    // [rad] turns the triangles out of the plane of view
    constexpr double kElevation = 0.35;  // [rad]
    right_ = std::cos(kAzimuth) * side + std::sin(kAzimuth) * depth;
    const Eigen::Vector3d away = -std::sin(kAzimuth) * side + std::cos(kAzimuth) * depth;
    down_ = std::cos(kElevation) * down - std::sin(kElevation) * away;
  }
  [[nodiscard]] Point2 operator()(const Eigen::Vector3d& p) const { return {right_.dot(p), down_.dot(p)}; }

 private:
  Eigen::Vector3d right_;
  Eigen::Vector3d down_;
};

struct Drawing {
  std::array<Point2, kCables> base;
  std::array<Point2, kCables> platform;
  Point2 load;
};

Drawing draw(const Scene& scene, const Camera& camera, const Pose<double>& pose) {
  const Model<double>& model = scene.sampler.model();
  const Matrix3<double> r_WP = rotation(pose.phi, pose.theta, pose.sigma);
  Drawing result;
  for (std::size_t i = 0; i < kCables; ++i) {
    result.base[i] = camera(model.p_WA[i]);
    result.platform[i] = camera(pose.p_WP + r_WP * model.p_PB[i]);
  }
  result.load = camera(pose.p_WP + r_WP * model.p_PM);
  return result;
}

std::string polygon(const std::vector<Point2>& points, const std::function<Point2(const Point2&)>& place) {
  std::string data;
  for (const Point2& point : points) {
    const Point2 p = place(point);
    data += fmt::format("{}{} {}", data.empty() ? 'M' : 'L', coordinate(p.x()), coordinate(p.y()));
  }
  return data + "Z";
}

}  // namespace

bool is_plane(const SpaceText& space) { return space.parameters.size() == 2 && space.constraints.empty(); }

Html tension_figure(const Scene& scene) { return all_cables(scene, tension_panel); }
Html length_figure(const Scene& scene) { return all_cables(scene, length_panel); }

Html pose_figure(const Scene& scene) {
  const Html position = coordinates_panel(scene, {html("px"), html("py"), html("pz")}, "mm",
                                          [](const Pose<double>& pose, int c) { return pose.p_WP(c) * kMillimetres; });
  const Html orientation = coordinates_panel(scene, {html("phi φ"), html("theta θ"), html("sigma σ")}, "deg",
                                             [](const Pose<double>& pose, int c) {
                                               return (c == 0 ? pose.phi : c == 1 ? pose.theta : pose.sigma) * kDegrees;
                                             });
  return html("<div class=\"panels two\">{}{}</div>\n", position, orientation);
}

Html slice_figure(const Scene& scene) {
  const SpaceText& space = scene.view.problem.space;
  if (!is_plane(space)) return {};
  const std::array<Span, 2> spans = {window(scene, 0), window(scene, 1)};
  const bool same_unit = unit(space, 0) == unit(space, 1);
  const double ratio = same_unit ? std::clamp(spans[1].length() / spans[0].length(), 0.3, 1.0) : 0.6;
  const auto axis = [&](std::size_t j) -> Axis {
    return {spans[j], html("{} {}", space.parameters[j].name, in_brackets(unit(space, j))), 8};
  };
  const Plot plot(kSliceWidth, std::round(kSliceWidth * ratio), axis(0), axis(1));
  const Raster raster(scene.sampler, plot, spans[0], spans[1]);
  const Html picture =
      raster.cells() + atlas(scene, plot, images(space)) + raster.singular_locus() + slice_path(scene, plot);
  Html keys = swatch("inside", html("in C: all limits kept")) + swatch("tension", html("a tension out of limits")) +
              swatch("length", html("a length out of limits")) + swatch("both", html("both")) +
              stroke("singular", html("det J = 0")) + stroke("path", html("path, S to G"));
  if (!scene.view.charts.empty()) keys += stroke("chart", html("charts of the atlas ({})", scene.view.charts.size()));
  if (scene.view.charts.size() > kMaxCharts) keys += html("<span>(the first {} are drawn)</span>", kMaxCharts);
  if (scene.view.witness) keys += stroke("witness", html("witness"));
  if (scene.view.undecided && scene.view.undecided->segment) keys += stroke("opening", html("left open"));
  return html(
      "<figure class=\"slice\">{}<figcaption>{}</figcaption></figure>\n",
      plot.svg(picture, "The plane of the two parameters: feasible set, atlas and path", slice_marks(scene, plot)),
      keys);
}

Html robot_figure(const Scene& scene) {
  const Path& path = scene.view.path;
  if (path.waypoints.empty()) return {};
  std::vector<std::pair<Html, double>> views = {{html("Waypoint 0 (start)"), 0.0}};
  if (const auto& witness = scene.view.witness) {
    views.emplace_back(html("At the witness"), witness->at.position);
  } else if (path.segments() > 1) {
    const std::size_t middle = path.segments() / 2;
    const char* what = path.interpolation == Interpolation::kStraight ? "Waypoint" : "Start of segment";
    views.emplace_back(html("{} {}", what, middle), static_cast<double>(middle));
  }
  if (path.segments() > 0) {
    views.emplace_back(html("Waypoint {} (goal)", path.waypoints.size() - 1), static_cast<double>(path.segments()));
  }

  const Camera camera(scene.sampler.model().wrench);
  Eigen::AlignedBox2d bounds;
  std::vector<Drawing> drawings;
  for (const auto& [title, position] : views) {
    drawings.push_back(draw(scene, camera, scene.sampler.at(path, position).pose));
    for (const Point2& p : drawings.back().base) bounds.extend(p);
    for (const Point2& p : drawings.back().platform) bounds.extend(p);
    bounds.extend(drawings.back().load);
  }
  constexpr double kPad = 26;
  constexpr double kSide = 300;  // of the picture's longer side
  const double scale = kSide / bounds.sizes().maxCoeff();
  const auto place = [&](const Point2& p) -> Point2 { return (p - bounds.min()) * scale + Point2(kPad, kPad); };
  const Point2 size = bounds.sizes() * scale + Point2(2 * kPad, 2 * kPad);
  Html panels;
  for (std::size_t k = 0; k < views.size(); ++k) {
    const Drawing& d = drawings[k];
    Html cables;
    for (std::size_t i = 0; i < kCables; ++i) {
      const Point2 a = place(d.base[i]);
      const Point2 b = place(d.platform[i]);
      const Point2 label = 0.62 * a + 0.38 * b;
      const bool marked = scene.view.witness && scene.view.witness->cable == static_cast<int>(i) + 1;
      cables += html(
          "<path class=\"cable{}\" d=\"M{} {}L{} {}\"/><circle class=\"tag\" cx=\"{}\" cy=\"{}\" r=\"7\"/>"
          "<text class=\"letter dark\" x=\"{}\" y=\"{}\">{}</text>",
          marked ? " marked" : "", coordinate(a.x()), coordinate(a.y()), coordinate(b.x()), coordinate(b.y()),
          coordinate(label.x()), coordinate(label.y()), coordinate(label.x()), coordinate(label.y() + 3.6), i + 1);
    }
    const Point2 load = place(d.load);
    panels += panel(
        views[k].first,
        html("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"The robot\">"
             "<path class=\"base\" d=\"{}\"/>{}<path class=\"platform\" d=\"{}\"/>"
             "<circle class=\"load\" cx=\"{}\" cy=\"{}\" r=\"3.5\"/></svg>",
             coordinate(size.x()), coordinate(size.y()), polygon(hull({d.base.begin(), d.base.end()}), place), cables,
             polygon(hull({d.platform.begin(), d.platform.end()}), place), coordinate(load.x()), coordinate(load.y())));
  }
  return html("<div class=\"panels robots\">{}</div>\n", panels);
}

}  // namespace taut
