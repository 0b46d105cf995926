// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/robot_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "base/input_error.h"
#include "reports/page/body_shapes.h"
#include "reports/page/drawing.h"
#include "reports/page/machine_view.h"
#include "reports/summary/display_units.h"
#include "reports/summary/shown_bodies.h"

namespace taut {

namespace {

using Eigen::Vector3d;

constexpr double kPad = 64;   ///< around what is drawn: room for names and dimensions
constexpr double kHead = 24;  ///< above the views: their titles
constexpr double kFoot = 76;  ///< below them: axes and scale

/// A robot at a pose, as it is drawn.
struct DrawnRobot {
  std::vector<Vector3d> base, platform;  ///< anchors [m]
  Vector3d load;                         ///< point [m]
  Vector3d force;                        ///< nominal, at this pose [N]
  Vector3d down;                         ///< in the drawing
  DisplayUnit length;
  Vector3d origin;                ///< of the platform [m]
  Matrix3<double> turn;           ///< of the platform
  std::vector<BodyShape> bodies;  ///< drawn, too

  /// Where a point of a body is in W.
  [[nodiscard]] Vector3d at(const BodyShape& body, const Vector3d& p) const {
    return body.is_obstacle ? p : Vector3d(origin + turn * p);
  }
};

DrawnRobot drawn_robot(const Model<double>& model, const LoadText& load, const Pose<double>& pose,
                       const DisplayUnit& length) {
  const Matrix3<double> turn = rotation(model.angles, pose.angles);
  DrawnRobot result{{model.p_WA.begin(), model.p_WA.end()},
                    {},
                    pose.p_WP + turn * model.p_PM,
                    nominal_wrench(model.loads, model.wrench, turn).head<3>(),
                    downward(model, load),
                    length,
                    pose.p_WP,
                    turn,
                    {}};
  for (const Vector3d& b : model.p_PB) result.platform.emplace_back(pose.p_WP + turn * b);
  return result;
}

/// What of its bodies is drawn, as points: all that the platform carries, of obstacles what is near, and of half-spaces
/// what is next to a machine that is not far from them.
std::vector<Vector3d> drawn_parts(const DrawnRobot& robot) {
  std::vector<Vector3d> machine = robot.base, result;
  std::ranges::copy(robot.platform, std::back_inserter(machine));
  machine.push_back(robot.load);
  for (const BodyShape& body : robot.bodies) {
    if (body.is_obstacle) continue;
    for (const Vector3d& p : body.box()) result.push_back(robot.at(body, p));
  }
  std::ranges::copy(result, std::back_inserter(machine));
  std::ranges::copy(near_parts(robot.bodies, machine), std::back_inserter(result));
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : machine) box.extend(p);
  for (const BodyShape& body : robot.bodies) {
    if (!body.is_half_space) continue;
    const double height = body.normal.dot(robot.load) - body.offset;
    if (std::abs(height) < box.diagonal().norm()) result.emplace_back(robot.load - height * body.normal);
  }
  return result;
}

/// Looks along right × down.
struct View {
  const char* title;
  Vector3d right;
  Vector3d down;
  [[nodiscard]] Point2 operator()(const Vector3d& p) const { return {right.dot(p), down.dot(p)}; }
};

std::array<View, 3> views(const Vector3d& down) {
  const Vector3d across = across_of(-down);
  const Vector3d inward = across.cross(down);  // up × across
  return {View{"From the front", across, down}, View{"From the side", inward, down},
          View{"From above", across, -inward}};
}

Html line(const char* kind, const Point2& a, const Point2& b) {
  return html("<path class=\"{}\" d=\"{}\"/>", kind, path_data({a, b}, false));
}

Html words(const char* kind, const Point2& at, const std::string& text) {
  return html("<text class=\"{}\" x=\"{}\" y=\"{}\">{}</text>", kind, coordinate(at.x()), coordinate(at.y()), text);
}

Html arrow(const char* kind, const Point2& from, const Point2& to) {
  const Point2 along = (to - from).normalized();
  const Point2 across(-along.y(), along.x());
  const double head = std::min(8.0, 0.5 * (to - from).norm());
  return line(kind, from, to) + line(kind, to, to - head * along + 0.5 * head * across) +
         line(kind, to, to - head * along - 0.5 * head * across);
}

/// Names of points; coinciding points share one label: "A1 A2".
std::vector<std::pair<Point2, std::string>> names(const std::vector<Point2>& points, char letter) {
  std::vector<std::pair<Point2, std::string>> result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto same =
        std::ranges::find_if(result, [&](const auto& entry) { return (entry.first - points[i]).norm() < 4; });
    const std::string name = fmt::format("{}{}", letter, i + 1);
    if (same == result.end()) {
      result.emplace_back(points[i], name);
    } else {
      same->second += " " + name;
    }
  }
  return result;
}

/// Lines between all pairs of distinct points, each pair once.
Html frame(const char* kind, const std::vector<Point2>& points) {
  Html result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if ((points[i] - points[j]).norm() > 1) result += line(kind, points[i], points[j]);
    }
  }
  return result;
}

/// One of the three views while it is drawn.
class Projection {
 public:
  Projection(const DrawnRobot& robot, const View& view, const Point2& corner, double side, double scale,
             const Eigen::AlignedBox2d& bounds, double page_height);
  [[nodiscard]] Html draw();

 private:
  [[nodiscard]] Point2 place(const Vector3d& p) const { return (view_(p) - middle_) * scale_ + centre_; }
  void bodies();
  /// The part of a half-space that is seen from its side; nothing of others.
  [[nodiscard]] std::vector<Point2> seen_from_aside(const BodyShape& half_space) const;
  void dimensions();
  /// Between two heights or two distances to the right [m], drawn beyond the points that have them.
  void horizontal(double from, double to, double y, double from_y, double to_y);
  void vertical(double from, double to, double x, double from_x, double to_x);
  [[nodiscard]] std::string size(double metres) const {
    return fmt::format("{:.4g}", robot_.length.approx(std::abs(metres)));
  }
  /// @param is_inside  it may be on the point, and is best there; else beside it
  void label(const char* kind, const std::string& text, const Point2& at, bool is_inside = false);

  const DrawnRobot& robot_;
  const View& view_;
  const Eigen::AlignedBox2d& bounds_;  ///< of what is drawn [m]
  Point2 corner_;
  double page_height_;
  double scale_;  ///< [px/m]
  Point2 middle_;
  Point2 centre_;
  Eigen::AlignedBox2d box_;  ///< of what is drawn [px]
  std::vector<Point2> a_, b_;
  Html drawn_;
  LabelPlacer labels_;
  std::vector<std::tuple<std::string, std::string, Point2>> body_names_;  ///< name, kind, and where it is
};

Projection::Projection(const DrawnRobot& robot, const View& view, const Point2& corner, double side, double scale,
                       const Eigen::AlignedBox2d& bounds, double page_height)
    : robot_(robot),
      view_(view),
      bounds_(bounds),
      corner_(corner),
      page_height_(page_height),
      scale_(scale),
      middle_(bounds.center()),
      centre_(corner + Point2(side / 2, side / 2)),
      labels_(Point2(1e4, 1e4)) {
  for (const Vector3d& p : robot.base) a_.push_back(place(p));
  for (const Vector3d& p : robot.platform) b_.push_back(place(p));
  for (const std::vector<Point2>* points : {&a_, &b_}) {
    for (const Point2& p : *points) box_.extend(p);
  }
  box_.extend(place(robot.load));
  for (const Vector3d& p : drawn_parts(robot)) box_.extend(place(p));
}

std::vector<Point2> Projection::seen_from_aside(const BodyShape& half_space) const {
  constexpr double kFlat = 1e-6, kMore = 0.05;
  const Point2 normal = view_(half_space.normal);
  if (!(normal.norm() > 1 - kFlat)) return {};
  const Point2 more = Point2::Constant(kMore * bounds_.sizes().maxCoeff());
  const Point2 low = bounds_.min() - more, high = bounds_.max() + more;
  const std::array<Point2, 4> corners{low, Point2(high.x(), low.y()), high, Point2(low.x(), high.y())};
  std::vector<Point2> result;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Point2 &a = corners[k], &b = corners[(k + 1) % corners.size()];
    const double above_a = normal.dot(a) - half_space.offset, above_b = normal.dot(b) - half_space.offset;
    if (above_a <= 0) result.push_back(a);
    if ((above_a <= 0) != (above_b <= 0)) result.emplace_back(a + above_a / (above_a - above_b) * (b - a));
  }
  for (Point2& p : result) p = (p - middle_) * scale_ + centre_;
  return result;
}

void Projection::bodies() {
  constexpr std::size_t kLongestName = 24;
  const Eigen::AlignedBox2d frame((bounds_.min() - middle_) * scale_ + centre_,
                                  (bounds_.max() - middle_) * scale_ + centre_);
  for (const BodyShape& body : robot_.bodies) {
    const char* const kind = body.is_obstacle ? "" : " carried";
    const auto at = [&](const Vector3d& p) { return place(robot_.at(body, p)); };
    const Vector3d in_world = view_.down.cross(view_.right);
    const Vector3d towards = body.is_obstacle ? in_world : Vector3d(robot_.turn.transpose() * in_world);
    std::vector<Point2> outline;
    if (body.is_half_space) {
      outline = seen_from_aside(body);
    } else {
      for (const Vector3d& p : body.mesh != nullptr ? body.box() : body.points) outline.push_back(at(p));
      if (body.mesh == nullptr) outline = outline_of(outline, scale_ * body.radius);
    }
    Eigen::AlignedBox2d seen;
    for (const Point2& p : outline) seen.extend(p);
    seen = seen.intersection(frame);
    if (seen.isEmpty()) continue;
    drawn_ += body.mesh != nullptr
                  ? html("<path class=\"edges{}\" d=\"{}\"/>", kind, edges_data(*body.mesh, towards, at))
                  : html("<path class=\"body{}\" d=\"{}\"/>", kind, path_data(outline, true));
    if (body.name.size() <= kLongestName) body_names_.emplace_back(body.name, kind, seen.center());
  }
}

void Projection::horizontal(double from, double to, double y, double from_y, double to_y) {
  if (!(to - from > 3)) return;
  drawn_ += line("extension", {from, from_y}, {from, y}) + line("extension", {to, to_y}, {to, y}) +
            arrow("dimension", {(from + to) / 2, y}, {from, y}) + arrow("dimension", {(from + to) / 2, y}, {to, y});
  const std::string text = size((to - from) / scale_);
  const Point2 at((from + to) / 2, y - 4);
  labels_.keep_clear({at - Point2(0, 4), half_size(text, 12)});
  drawn_ += words("measure", at, text);
}

void Projection::vertical(double from, double to, double x, double from_x, double to_x) {
  if (!(to - from > 3)) return;
  drawn_ += line("extension", {from_x, from}, {x, from}) + line("extension", {to_x, to}, {x, to}) +
            arrow("dimension", {x, (from + to) / 2}, {x, from}) + arrow("dimension", {x, (from + to) / 2}, {x, to});
  const std::string text = size((to - from) / scale_);
  const Point2 at(x - 4, (from + to) / 2);
  const Point2 half = half_size(text, 12);
  labels_.keep_clear({at - Point2(4, 0), {half.y(), half.x()}});
  drawn_ += html("<text class=\"measure\" transform=\"translate({} {}) rotate(-90)\">{}</text>", coordinate(at.x()),
                 coordinate(at.y()), text);
}

/// The base's overall width above and height on the left, the platform's below and on the right, and between them how
/// far the platform's lowest anchor hangs below the base's highest one.
void Projection::dimensions() {
  const auto least = [](const std::vector<Point2>& points, int c) {
    return *std::ranges::min_element(points, {}, [c](const Point2& p) { return p(c); });
  };
  const auto greatest = [](const std::vector<Point2>& points, int c) {
    return *std::ranges::max_element(points, {}, [c](const Point2& p) { return p(c); });
  };
  const Point2 left = least(a_, 0), right = greatest(a_, 0), top = least(a_, 1), bottom = greatest(a_, 1);
  horizontal(left.x(), right.x(), box_.min().y() - 34, left.y(), right.y());
  vertical(top.y(), bottom.y(), box_.min().x() - 30, top.x(), bottom.x());
  const Point2 b_left = least(b_, 0), b_right = greatest(b_, 0), b_top = least(b_, 1), b_bottom = greatest(b_, 1);
  horizontal(b_left.x(), b_right.x(), box_.max().y() + 52, b_left.y(), b_right.y());
  vertical(b_top.y(), b_bottom.y(), box_.max().x() + 28, b_top.x(), b_bottom.x());
  const bool is_level = view_.down.dot(robot_.down) > 0.5;  // else seen from above
  if (is_level) vertical(top.y(), b_bottom.y(), box_.max().x() + 54, top.x(), b_bottom.x());
}

void Projection::label(const char* kind, const std::string& text, const Point2& at, bool is_inside) {
  const Point2 half = half_size(text, 12);
  std::vector<LabelPlacer::Candidate> candidates;
  if (is_inside) candidates.push_back({at, 0});
  for (const double away : {6.0, 12.0, 20.0}) {
    for (const auto& [x, y] : {std::pair(1, -1), {-1, -1}, {1, 1}, {-1, 1}, {0, -1}, {0, 1}}) {
      candidates.push_back(
          {at + Point2(x * (half.x() + 4), y * (half.y() + away - 2)), 0.1 * static_cast<double>(candidates.size())});
    }
  }
  const Point2& chosen = candidates[labels_.place(half, candidates)].centre;
  drawn_ += words(kind, chosen + Point2(0, 4), text);
}

Html Projection::draw() {
  drawn_ += words("title", {corner_.x() - kPad + 8, kHead - 6}, view_.title);
  bodies();
  drawn_ += frame("base", a_) + frame("platform", b_);
  for (std::size_t i = 0; i < kCables; ++i) {
    drawn_ += line("cable", a_[i], b_[i]);
    labels_.avoid(a_[i], b_[i]);
  }
  dimensions();
  for (const auto& [at, name] : names(a_, 'A')) label("a", name, at);
  for (const auto& [at, name] : names(b_, 'B')) label("b", name, at);
  for (std::size_t i = 0; i < kCables; ++i) {
    std::vector<LabelPlacer::Candidate> candidates;
    for (int k = 0; k < 15; ++k) {
      const double t = 0.42 + (k % 2 == 0 ? 1 : -1) * 0.04 * ((k + 1) / 2);
      candidates.push_back({a_[i] + t * (b_[i] - a_[i]), 0.05 * k, static_cast<int>(i)});
    }
    const Point2 tag = candidates[labels_.place({8, 8}, candidates)].centre;
    drawn_ += html("<circle class=\"tag\" cx=\"{}\" cy=\"{}\" r=\"8\"/>", coordinate(tag.x()), coordinate(tag.y())) +
              words("number", tag + Point2(0, 4), std::to_string(i + 1));
  }
  for (const auto& [name, kind, at] : body_names_) label(("body-name" + kind).c_str(), name, at, true);
  const Point2 from = place(robot_.load);
  drawn_ += html("<circle class=\"load\" cx=\"{}\" cy=\"{}\" r=\"3\"/>", coordinate(from.x()), coordinate(from.y()));
  if (robot_.force.norm() > 0) {
    const Point2 pull = view_(robot_.force.normalized()) * 30;
    if (pull.norm() > 1) drawn_ += arrow("load", from, from + pull);
  }
  // The world's axes, those that are seen.
  const Point2 origin(corner_.x() - kPad / 2, page_height_ - 42);
  for (int c = 0; c < 3; ++c) {
    const Point2 axis = view_(Vector3d::Unit(c)) * 24;
    if (axis.norm() < 3) continue;
    drawn_ += arrow("axis", origin, origin + axis) +
              words("soft", origin + 1.4 * axis + Point2(0, 4), std::string(1, "xyz"[c]));
  }
  return drawn_;
}

struct Views {
  Html drawn;
  double width = 0;
  double height = 0;
};

/// The three views beside each other, each `side` pixels wide; nothing where the robot has no size that can be drawn.
std::optional<Views> three_views(const DrawnRobot& robot, double side) {
  const std::array<View, 3> all = views(robot.down);
  const std::vector<Vector3d> parts = drawn_parts(robot);
  std::array<Eigen::AlignedBox2d, 3> bounds;
  double widest = 0;  // one scale for all of them [m]
  for (std::size_t v = 0; v < all.size(); ++v) {
    for (const std::vector<Vector3d>* points : {&robot.base, &robot.platform}) {
      for (const Vector3d& p : *points) bounds[v].extend(all[v](p));
    }
    bounds[v].extend(all[v](robot.load));
    for (const Vector3d& p : parts) bounds[v].extend(all[v](p));
    widest = std::max(widest, bounds[v].sizes().maxCoeff());
  }
  if (!(widest > 0) || !std::isfinite(widest) || !robot.load.allFinite()) return std::nullopt;
  const double scale = side / widest;
  double tallest = 0;
  for (const Eigen::AlignedBox2d& box : bounds) tallest = std::max(tallest, box.sizes().y() * scale);
  const double shift = (tallest - side) / 2;  // views are as high as the highest of them
  Views result{{}, 3 * (side + 2 * kPad), kHead + 2 * kPad + tallest + kFoot};
  for (std::size_t v = 0; v < all.size(); ++v) {
    const Point2 corner(kPad + static_cast<double>(v) * (side + 2 * kPad), kHead + kPad + shift);
    result.drawn += Projection(robot, all[v], corner, side, scale, bounds[v], result.height).draw();
  }
  const double metres = round_length(widest / 4);
  const double y = result.height - 26;
  const double x = result.width - 24 - metres * scale;
  result.drawn += line("scale", {x, y}, {x + metres * scale, y}) + line("scale", {x, y - 4}, {x, y + 4}) +
                  line("scale", {x + metres * scale, y - 4}, {x + metres * scale, y + 4}) +
                  words("soft", {x + metres * scale / 2, y - 8},
                        fmt::format("{:g} {}", robot.length.approx(metres), robot.length.name()));
  return result;
}

constexpr const char* kStyle =
    "svg{background:#fff;font:12px sans-serif}path{fill:none}text{text-anchor:middle}"
    ".base{stroke:#66707d;stroke-width:1.4}.platform{stroke:#8a5a00;stroke-width:1.8}"
    ".cable{stroke:#1d2329;stroke-width:1}.load{stroke:#b3261e;stroke-width:2.4}.axis{stroke:#59636e;stroke-width:1.2}"
    ".scale{stroke:#1d2329;stroke-width:2}.tag{fill:#fff;stroke:#59636e}.number{font-weight:600}"
    ".extension{stroke:#b8bfc6;stroke-width:.7}.dimension{stroke:#3f4b57;stroke-width:.9}.measure{fill:#1d2329}"
    ".a,.soft{fill:#59636e}.b{fill:#8a5a00}.title{font-weight:600;font-size:14px;text-anchor:start}"
    ".body{fill:#8595a6;fill-opacity:.38}.body.carried{fill:#7fae9f;fill-opacity:.5}"
    ".edges{stroke:#41566b;stroke-width:.8}.edges.carried{stroke:#24594b}"
    ".body-name{fill:#41566b}.body-name.carried{fill:#24594b}"
    ".loaded{fill:#b3261e;text-anchor:start}";

/// "Red: the load, 1 N along (0, 0, 1)"
std::string load_words(const DrawnRobot& robot, const DisplayUnit& unit) {
  if (!(robot.force.norm() > 0)) return "Red: the load point; the centre load has no force";
  const Vector3d along = robot.force.normalized();
  return fmt::format("Red: the load, {:.4g} {} along ({:.3g}, {:.3g}, {:.3g})", unit.approx(robot.force.norm()),
                     unit.name(), along(0) + 0.0, along(1) + 0.0, along(2) + 0.0);
}

}  // namespace

std::string robot_drawing(const CaseSummary& summary) {
  if (summary.waypoints.empty()) {
    throw InputError(ErrorCode::kUse,
                     "--out: the case has no query, expected one: the robot is drawn at its first waypoint");
  }
  const DisplayUnits units(summary.source.units);
  DrawnRobot robot =
      drawn_robot(summary.sampler.model(), summary.source.problem.load, summary.waypoints.front().pose, units.length);
  std::map<std::string, ShownBody> meshes;
  if (const auto& bodies = summary.source.problem.bodies) {
    meshes = shown_meshes(*bodies);
    robot.bodies = body_shapes(*bodies, summary.bodies->bodies(), meshes);
  }
  constexpr double kSide = 330;
  const std::optional<Views> views = three_views(robot, kSide);
  if (!views) throw InputError(ErrorCode::kUse, "--out: the robot has no pose or size there that can be drawn");
  constexpr double kTitle = 52;
  const std::string& name = summary.source.problem.name;
  const Html heading = words("title", {kPad / 2, 22}, name + ", at the first waypoint of its query") +
                       words("loaded", {kPad / 2, 42},
                             fmt::format("{}. {}Dimensions in {}.", load_words(robot, units.force),
                                         robot.bodies.empty() ? "" : "Grey: obstacles. Green: bodies on the platform. ",
                                         units.length.name()));
  return html(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} "
             "{1}\"><title>{2}</title><style>{3}</style>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>{4}"
             "<g transform=\"translate(0 {5})\">{6}</g></svg>\n",
             coordinate(views->width), coordinate(views->height + kTitle), name, kStyle, heading, kTitle, views->drawn)
      .str();
}

Html dimensioned_views(const ReportContext& scene) {
  if (scene.samples.empty() || !MachineView(scene).is_drawable) return {};
  const DisplayUnits& units = scene.illustration.units;
  const DrawnRobot robot =
      drawn_robot(scene.sampler.model(), scene.certificate.problem.load, scene.samples.front().pose, units.length);
  constexpr double kSide = 190;
  const std::optional<Views> views = three_views(robot, kSide);
  if (!views) return {};
  return html(
      "<figure class=\"dimensioned\"><figcaption>The machine at the start, from the front, from the side and from "
      "above; dimensions in {}</figcaption>\n<div class=\"scroll\"><svg viewBox=\"0 0 {} {}\" role=\"img\" "
      "aria-label=\"Three dimensioned views of the machine\">{}</svg></div>\n<p class=\"note\">Above and on the left: "
      "the base's anchors over all. Below and on the right: the platform's anchors over all, and outermost how far the "
      "lowest of them is below the highest of the base. {}; rounded.</p></figure>\n",
      units.length.name(), coordinate(views->width), coordinate(views->height), views->drawn,
      load_words(robot, units.force));
}

}  // namespace taut
