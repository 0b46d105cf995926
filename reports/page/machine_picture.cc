// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/machine_picture.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "problem/expression.h"
#include "reports/page/body_shapes.h"
#include "reports/summary/load_statement.h"
#include "reports/summary/shown_bodies.h"

namespace taut {

namespace {

using Eigen::Vector3d;

constexpr double kFont = 15;       ///< [px]
constexpr double kDisc = 11;       ///< radius of a cable's number
constexpr double kMargin = 30;     ///< around what is drawn: room for names
constexpr double kFoot = 52;       ///< below it: scale and axes
constexpr double kArrow = 66;      ///< length of the load's arrow
constexpr double kThinTube = 2.5;  ///< radius below which it can't be told from the path

Html line(const char* kind, const Point2& a, const Point2& b) {
  return html("<path class=\"{}\" d=\"{}\"/>", kind, path_data({a, b}, false));
}

Html words(const char* kind, const Point2& centre, const std::string& text) {
  return html("<text class=\"{}\" x=\"{}\" y=\"{}\">{}</text>", kind, coordinate(centre.x()),
              coordinate(centre.y() + 0.36 * kFont), text);
}

/// One picture while it is drawn.
class Picture {
 public:
  Picture(const ReportContext& scene, const MachineView& view, double position,
          const std::array<Nearness, kCables>& nearness, const PictureSize& size);

  [[nodiscard]] Html draw(const std::string& caption, const Html& note);

 private:
  [[nodiscard]] Point2 place(const Vector3d& p) const { return (view_(p) - centre_) * scale_ + middle_; }
  [[nodiscard]] std::vector<Point2> placed(const std::vector<Vector3d>& points) const;
  void frame();
  void grid();
  void base();
  void shown_frame();
  void shown_payload();
  void bodies();
  void nearest_bodies();
  void ghosts();
  void track();
  void strokes();
  void platform();
  void load();
  void names();
  void discs();
  void scale_and_axes();
  /// Whether a side of the platform is in front of p.
  [[nodiscard]] bool is_hidden(const Vector3d& p) const;
  void stroke(const char* kind, const char* casing, const Vector3d& a, const Vector3d& b);
  Point2 label(const char* kind, const std::string& text, const std::vector<LabelPlacer::Candidate>& candidates);

  const ReportContext& scene_;
  const MachineView& view_;
  double position_;
  const std::array<Nearness, kCables>& nearness_;
  PathSample sample_;
  std::vector<Vector3d> base_, platform_;
  std::vector<Face> sides_;
  double width_;
  double greatest_height_;
  double height_ = 0;
  double scale_ = 1;                      ///< [px/m]
  Point2 centre_ = Point2::Zero();        ///< of what is drawn [m]
  Point2 middle_ = Point2::Zero();        ///< of where it is drawn [px]
  Html behind_, between_, front_, text_;  ///< the platform is after `between_`
  LabelPlacer labels_{Point2::Zero()};
  std::vector<std::tuple<std::string, std::string, Point2>> body_names_;  ///< name, kind, and where it is
};

Picture::Picture(const ReportContext& scene, const MachineView& view, double position,
                 const std::array<Nearness, kCables>& nearness, const PictureSize& size)
    : scene_(scene),
      view_(view),
      position_(position),
      nearness_(nearness),
      sample_(scene.sampler.at(scene.certificate.path, position)),
      base_(base_of(scene)),
      platform_(platform_at(scene, sample_.pose)),
      sides_(hull_faces(platform_)),
      width_(size.width),
      greatest_height_(size.greatest_height) {
  frame();
}

std::vector<Point2> Picture::placed(const std::vector<Vector3d>& points) const {
  std::vector<Point2> result;
  for (const Vector3d& p : points) result.push_back(place(p));
  return result;
}

/// Fits everything that is ever drawn, at any place of the path, so that all pictures of a report have one scale.
void Picture::frame() {
  Eigen::AlignedBox2d bounds;
  for (const Vector3d& p : view_.swept) {
    bounds.extend(view_(p));
    bounds.extend(view_(view_.foot(p)));
  }
  const MachineView::Grid& grid = view_.grid;
  for (const int a : grid.across) {
    for (const int b : grid.inward) {
      bounds.extend(view_(grid.step * (a * view_.across + b * view_.inward) + grid.height * view_.up));
    }
  }
  const Point2 room(width_ - 16, greatest_height_ - kMargin - kFoot);
  scale_ = room.cwiseQuotient(bounds.sizes()).minCoeff();
  centre_ = bounds.center();
  height_ = scale_ * bounds.sizes().y() + kMargin + kFoot;
  middle_ = Point2(width_ / 2, kMargin + scale_ * bounds.sizes().y() / 2);
  labels_ = LabelPlacer(Point2(width_, height_ - kFoot + 6));
}

void Picture::grid() {
  const MachineView::Grid& g = view_.grid;
  const auto at = [&](int a, int b) {
    return place(g.step * (a * view_.across + b * view_.inward) + g.height * view_.up);
  };
  std::string lines;
  for (int a = g.across[0]; a <= g.across[1]; ++a) lines += path_data({at(a, g.inward[0]), at(a, g.inward[1])}, false);
  for (int b = g.inward[0]; b <= g.inward[1]; ++b) lines += path_data({at(g.across[0], b), at(g.across[1], b)}, false);
  behind_ += html("<path class=\"grid\" d=\"{}\"/>", lines);
}

/// A line in space, where the platform hides it behind it, elsewhere in front.
void Picture::stroke(const char* kind, const char* casing, const Vector3d& a, const Vector3d& b) {
  constexpr int kPieces = 48;
  const auto at = [&](int k) -> Vector3d { return a + static_cast<double>(k) / kPieces * (b - a); };
  behind_ += line(kind, place(a), place(b));
  for (int from = 0; from < kPieces;) {
    if (is_hidden(0.5 * (at(from) + at(from + 1)))) {
      ++from;
      continue;
    }
    int to = from + 1;
    while (to < kPieces && !is_hidden(0.5 * (at(to) + at(to + 1)))) ++to;
    front_ += line(casing, place(at(from)), place(at(to))) + line(kind, place(at(from)), place(at(to)));
    from = to;
  }
}

bool Picture::is_hidden(const Vector3d& p) const {
  const Vector3d towards = view_.towards();
  const double reach = 0.02 * (platform_[0] - platform_[3]).norm();
  for (const Face& side : sides_) {
    const double faces = side.normal.dot(towards);
    if (faces <= 1e-3) continue;
    const double ahead = side.normal.dot(side.corners[0] - p) / faces;  // from p to the side's plane, along the view
    if (ahead <= reach) continue;
    const Point2 at = view_(p);
    bool is_inside = true;
    for (std::size_t i = 0; is_inside && i < side.corners.size(); ++i) {
      const Point2 a = view_(side.corners[i]);
      const Point2 along = view_(side.corners[(i + 1) % side.corners.size()]) - a;
      is_inside = along.x() * (at - a).y() - along.y() * (at - a).x() < 0;  // y points down: clockwise
    }
    if (is_inside) return true;
  }
  return false;
}

/// Anchors with what may carry them: posts to the ground if the platform hangs, and their sides, hatched if they are
/// all in one plane.
void Picture::base() {
  const std::vector<Vector3d> anchors = distinct(base_);
  const std::vector<Face> sides = hull_faces(anchors);
  if (sides.size() == 2) {
    const std::vector<Point2> outline = placed(sides[0].corners);
    std::string lines;
    for (const auto& [a, b] : hatching(outline, 9)) lines += path_data({a, b}, false);
    behind_ +=
        html("<path class=\"fixed\" d=\"{}\"/><path class=\"hatch\" d=\"{}\"/>", path_data(outline, true), lines);
  }
  double above = 0;
  for (const Vector3d& a : anchors) above += view_.up.dot(a) / static_cast<double>(anchors.size());
  const bool is_carried_by_shown_frame = scene_.illustration.decoration.frame.has_value();
  if (!is_carried_by_shown_frame && above > view_.up.dot(sample_.pose.p_WP)) {
    for (const Vector3d& a : anchors) {
      const Point2 foot = place(view_.foot(a));
      behind_ += line("foot", foot - Point2(9, 0), foot + Point2(9, 0));
      behind_ += line("post", foot, place(a));  // what carries the machine is not known: behind all that is
    }
  }
  for (const Face& side : sides) {
    for (std::size_t i = 0; i < side.corners.size(); ++i) {
      const Vector3d& a = side.corners[i];
      const Vector3d& b = side.corners[(i + 1) % side.corners.size()];
      const bool is_first = std::tuple(a.x(), a.y(), a.z()) < std::tuple(b.x(), b.y(), b.z());  // each edge is of two
      if (is_first) stroke("frame", "unseen-casing", a, b);
    }
  }
  if (sides.empty() && anchors.size() > 1) stroke("frame", "unseen-casing", anchors.front(), anchors.back());
}

void Picture::shown_frame() {
  const std::optional<ShownBody>& frame = scene_.illustration.decoration.frame;
  if (!frame) return;
  behind_ += html("<path class=\"shown\" d=\"{}\"/>",
                  edges_data(*frame, view_.towards(), [&](const Vector3d& p) { return place(p); }));
}

void Picture::shown_payload() {
  const std::optional<ShownBody>& payload = scene_.illustration.decoration.payload;
  if (!payload) return;
  const Matrix3<double> turn = rotation(scene_.sampler.model().angles, sample_.pose.angles);
  const auto at = [&](const Vector3d& p) { return place(sample_.pose.p_WP + turn * p); };
  std::vector<Point2> points;
  for (const std::array<double, 3>& p : payload->corners) points.push_back(at(Vector3d(p[0], p[1], p[2])));
  std::vector<Point2> outline;
  for (const std::size_t i : hull(points)) outline.push_back(points[i]);
  between_ += html("<path class=\"shown payload\" d=\"{}\"/><path class=\"shown edges\" d=\"{}\"/>",
                   path_data(outline, true), edges_data(*payload, turn.transpose() * view_.towards(), at));
}

/// Bodies that may not touch: those behind the platform first, with the edges of those that have some and their names.
void Picture::bodies() {
  constexpr std::size_t kMostCorners = 24;  // of a body whose edges are drawn
  const Matrix3<double> turn = rotation(scene_.sampler.model().angles, sample_.pose.angles);
  const Vector3d towards = view_.towards();
  const double depth = towards.dot(sample_.pose.p_WP);
  for (const BodyShape& body : body_shapes(scene_)) {
    const auto at = [&](const Vector3d& p) -> Vector3d {
      return body.is_obstacle ? p : Vector3d(sample_.pose.p_WP + turn * p);
    };
    const char* const kind = body.is_obstacle ? "" : " carried";
    if (body.is_half_space) {
      const auto corners = view_.plane(body.normal, body.offset);
      const std::vector<Point2> outline = placed({corners.begin(), corners.end()});
      behind_ += html("<path class=\"body half-space\" d=\"{}\"/>", path_data(outline, true));
      body_names_.emplace_back(body.name, kind, outline.front());
      continue;
    }
    std::vector<Vector3d> points;
    for (const Vector3d& p : body.points) points.push_back(at(p));
    for (const Vector3d& p : body.mesh ? body.box() : std::vector<Vector3d>()) points.push_back(at(p));
    if (points.empty()) continue;
    Vector3d middle = Vector3d::Zero();
    for (const Vector3d& p : points) middle += p / static_cast<double>(points.size());
    Html& layer = !body.is_obstacle ? between_ : towards.dot(middle) < depth ? behind_ : front_;
    if (body.mesh) {
      layer += html("<path class=\"body-edges{}\" d=\"{}\"/>", kind,
                    edges_data(*body.mesh, body.is_obstacle ? towards : Vector3d(turn.transpose() * towards),
                               [&](const Vector3d& p) { return place(at(p)); }));
    } else {
      layer += html("<path class=\"body{}\" d=\"{}\"/>", kind,
                    path_data(outline_of(placed(points), scale_ * body.radius), true));
      if (points.size() > 2 && points.size() <= kMostCorners) {
        std::string seen, unseen;
        for (const Face& face : hull_faces(points)) {
          (face.normal.dot(towards) > 0 ? seen : unseen) += path_data(placed(face.corners), true);
        }
        layer += html("<path class=\"body-edges unseen{0}\" d=\"{1}\"/><path class=\"body-edges{0}\" d=\"{2}\"/>", kind,
                      unseen, seen);
      }
    }
    body_names_.emplace_back(body.name, kind, place(middle));
  }
}

/// The nearest points of the pair that has the least left, where they can be told apart in the picture.
void Picture::nearest_bodies() {
  if (!scene_.bodies || scene_.distances.least.empty() || found_no_path(scene_.certificate)) return;
  const std::vector<BodyDistance> nearest =
      scene_.bodies->nearest(scene_.sampler.model(), scene_.sampler.rigid_pose(sample_), 1);
  if (nearest.empty()) return;
  const Point2 a = place(nearest[0].at[0]);
  const Point2 b = place(nearest[0].at[1]);
  front_ += line("apart-casing", a, b) + line("apart", a, b);
  for (const Point2& end : {a, b}) {
    front_ +=
        html("<circle class=\"apart-end\" cx=\"{}\" cy=\"{}\" r=\"3\"/>", coordinate(end.x()), coordinate(end.y()));
    labels_.keep_clear({end, {4, 4}});
  }
}

/// The outlines of the platform at the start and at the goal, unless it is shown there.
void Picture::ghosts() {
  const auto last = static_cast<double>(scene_.certificate.path.segments());
  std::vector<std::pair<std::string, double>> ends = {{"S", 0.0}};
  if (last > 0) ends.emplace_back("G", last);
  for (const auto& [letter, at] : ends) {
    if (std::abs(at - position_) < 1e-9) continue;
    const std::vector<Point2> all = placed(platform_at(scene_, scene_.sampler.at(scene_.certificate.path, at).pose));
    std::vector<Point2> outline;
    for (const std::size_t i : hull(all)) outline.push_back(all[i]);
    behind_ += html("<path class=\"ghost fill\" d=\"{}\"/>", path_data(outline, true));
    between_ += html("<path class=\"ghost\" d=\"{}\"/>", path_data(outline, true));
    front_ += html("<path class=\"ghost faint\" d=\"{}\"/>", path_data(outline, true));
  }
}

/// The path of the origin, and the tube in which it may be where that is thick enough to be seen.
void Picture::track() {
  if (found_no_path(scene_.certificate)) return;
  std::vector<Point2> points;
  for (const PathSample& sample : scene_.samples) {
    const Point2 p = place(sample.pose.p_WP);
    constexpr double kApart = 0.7;
    if (points.empty() || (p - points.back()).norm() > kApart) points.push_back(p);
  }
  const bool moves = points.size() > 1;
  if (!moves) points.push_back(points.front());  // a dot
  const std::string data = path_data(points, false);
  if (const auto& tolerances = scene_.certificate.problem.tolerances) {
    const double radius = scale_ * evaluate_constant<double>(tolerances->position_m);
    if (radius > kThinTube) {
      front_ += html("<path class=\"tube\" stroke-width=\"{}\" d=\"{}\"/>", coordinate(2 * radius), data);
    }
  }
  if (!moves) return;
  front_ += html("<path class=\"track-casing\" d=\"{}\"/><path class=\"track\" d=\"{}\"/>", data, data);
}

void Picture::platform() {
  const Vector3d towards = view_.towards();
  Html sides;
  for (const Face& side : sides_) {
    if (side.normal.dot(towards) <= 0) continue;
    const double lit = side.normal.dot((view_.up + 0.5 * towards).normalized());
    sides += html("<path class=\"side {}\" d=\"{}\"/>",
                  lit > 0.6   ? "lit"
                  : lit > 0.1 ? "half-lit"
                              : "dim",
                  path_data(placed(side.corners), true));
  }
  if (sides_.empty()) sides = line("side", place(platform_[0]), place(platform_[kCables - 1]));
  between_ += sides;
}

void Picture::strokes() {
  for (std::size_t i = 0; i < kCables; ++i) {
    const std::string kind = fmt::format("cable {}", name(nearness_[i]));
    stroke(kind.c_str(), "cable-casing", base_[i], platform_[i]);
    labels_.avoid(place(base_[i]), place(platform_[i]));
  }
  for (const Vector3d& b : platform_) {
    if (is_hidden(b)) continue;
    const Point2 at = place(b);
    front_ += html("<circle class=\"joint\" cx=\"{}\" cy=\"{}\" r=\"2.6\"/>", coordinate(at.x()), coordinate(at.y()));
  }
  for (const Vector3d& a : distinct(base_)) {
    const Point2 at = place(a);
    front_ += html("<rect class=\"anchor\" x=\"{}\" y=\"{}\" width=\"11\" height=\"11\" rx=\"2\"/>",
                   coordinate(at.x() - 5.5), coordinate(at.y() - 5.5));
    labels_.keep_clear({at, {5, 5}});
  }
}

Point2 Picture::label(const char* kind, const std::string& text,
                      const std::vector<LabelPlacer::Candidate>& candidates) {
  const Point2 at = candidates[labels_.place(half_size(text, kFont), candidates)].centre;
  text_ += words(kind, at, text);
  return at;
}

/// Candidates around a point, above first.
std::vector<LabelPlacer::Candidate> around(const Point2& p, const Point2& half, double away) {
  std::vector<LabelPlacer::Candidate> result;
  for (const double more : {0.0, 9.0, 20.0, 34.0}) {
    for (const auto& [x, y] : {std::pair(0, -1), {1, -1}, {-1, -1}, {1, 0}, {-1, 0}, {1, 1}, {-1, 1}, {0, 1}}) {
      const Point2 offset(x * (half.x() + (y == 0 ? away + more : 0)), y * (half.y() + away + more));
      result.push_back({p + offset, 0.1 * static_cast<double>(result.size())});
    }
  }
  return result;
}

/// The sign of a centre of gravity: a circle with two quarters filled.
Html centre_of_gravity(const Point2& at) {
  const auto quarter = [&](double from_x, double from_y, double to_x, double to_y) {
    return fmt::format("M{} {}L{} {}A6 6 0 0 1 {} {}Z", coordinate(at.x()), coordinate(at.y()),
                       coordinate(at.x() + from_x), coordinate(at.y() + from_y), coordinate(at.x() + to_x),
                       coordinate(at.y() + to_y));
  };
  return html("<circle class=\"gravity\" cx=\"{}\" cy=\"{}\" r=\"6\"/><path class=\"quarters\" d=\"{}{}\"/>",
              coordinate(at.x()), coordinate(at.y()), quarter(0, -6, 6, 0), quarter(0, 6, -6, 0));
}

void Picture::load() {
  const Vector3d from = load_point_at(scene_, sample_.pose);
  const Point2 at = place(from);
  const Model<double>& model = scene_.sampler.model();
  const Vector3d force =
      nominal_wrench(model.loads, model.wrench, rotation(model.angles, sample_.pose.angles)).head<3>();
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& b : platform_) middle += b / kCables;
  std::vector<Vector3d> carried = weights_at(scene_, sample_.pose);
  carried.push_back(from);
  for (const Vector3d& p : carried) {
    if ((place(p) - place(middle)).norm() > 12) front_ += line("stalk", place(middle), place(p));
  }
  carried.pop_back();
  for (const Vector3d& p : carried) front_ += centre_of_gravity(place(p));
  const Html dot = html("<circle class=\"load\" cx=\"{}\" cy=\"{}\" r=\"5\"/>", coordinate(at.x()), coordinate(at.y()));
  labels_.keep_clear({at, {5, 5}});
  if (!(force.norm() > 0) || !force.allFinite()) {
    front_ += dot;
    return;
  }
  const Vector3d pull = force.normalized();
  Point2 along = kArrow * Point2(view_.right().dot(pull), -view_.upward().dot(pull));
  const double length = along.norm();
  along = length > 1 ? Point2(along / length) : Point2(0, 1);
  const Point2 across(-along.y(), along.x());
  const Point2 tip = at + std::max(length, 14.0) * along;
  const Point2 neck = tip - 13 * along;
  front_ += html("<path class=\"load-casing\" d=\"{}\"/>", path_data({at, tip}, false)) + dot +
            html("<path class=\"load-shaft\" d=\"{}\"/>", path_data({at, neck}, false)) +
            html("<path class=\"load\" d=\"{}\"/>", path_data({tip, neck + 6 * across, neck - 6 * across}, true));
  labels_.keep_clear({0.5 * (neck + tip), {7, 9}});
  labels_.avoid(at, tip);
  const std::string text = brief_load(scene_.certificate.problem.load);
  std::vector<LabelPlacer::Candidate> candidates;
  const Point2 half = half_size(text, kFont);
  for (const double t : {1.0, 0.8, 0.6, 1.2}) {
    for (const double side : {1.0, -1.0}) {
      candidates.push_back(
          {at + t * (tip - at) + Point2(side * (half.x() + 12), 0), 0.05 * static_cast<double>(candidates.size())});
    }
  }
  for (LabelPlacer::Candidate next : around(tip, half, 8)) {
    next.cost += 1;
    candidates.push_back(next);
  }
  label("load-words", text, candidates);
}

void Picture::names() {
  const std::vector<Vector3d> anchors = distinct(base_);
  std::vector<std::string> texts(anchors.size());  // "A1 A2" where anchors coincide
  for (std::size_t i = 0; i < kCables; ++i) {
    const auto nearest =
        std::ranges::min_element(anchors, {}, [&](const Vector3d& p) { return (p - base_[i]).norm(); });
    std::string& text = texts[static_cast<std::size_t>(nearest - anchors.begin())];
    text += fmt::format("{}A{}", text.empty() ? "" : " ", i + 1);
  }
  for (std::size_t k = 0; k < anchors.size(); ++k) {
    label("name", texts[k], around(place(anchors[k]), half_size(texts[k], kFont), 8));
  }
  for (const auto& [name, kind, at] : body_names_) {
    constexpr std::size_t kLongest = 24;
    if (name.size() > kLongest) continue;
    label(fmt::format("body-name{}", kind).c_str(), name, around(at, half_size(name, kFont), 2));
  }
  const auto last = static_cast<double>(scene_.certificate.path.segments());
  std::vector<std::pair<std::string, double>> ends = {{"S", 0.0}};
  if (last > 0) ends.emplace_back("G", last);
  for (const auto& [letter, at] : ends) {
    const std::vector<Vector3d> corners = platform_at(scene_, scene_.sampler.at(scene_.certificate.path, at).pose);
    std::vector<LabelPlacer::Candidate> candidates;
    Point2 middle = Point2::Zero();
    for (const Vector3d& b : corners) middle += place(b) / kCables;
    for (const double more : {11.0, 18.0, 27.0}) {
      for (const Vector3d& b : corners) {
        const Point2 p = place(b);
        const double away = (p - middle).norm();
        const Point2 out = away > 1 ? Point2((p - middle) / away) : Point2(0, 1);
        candidates.push_back({p + more * out, 0.02 * more});
      }
    }
    label("end", letter, candidates);
  }
}

void Picture::discs() {
  for (std::size_t i = 0; i < kCables; ++i) {
    const Point2 a = place(base_[i]);
    const Point2 b = place(platform_[i]);
    const Point2 along = b - a;
    const Point2 aside = along.norm() > 1 ? Point2(Point2(-along.y(), along.x()) / along.norm()) : Point2(1, 0);
    std::vector<LabelPlacer::Candidate> candidates;
    for (const double side : {0.0, 22.0, -22.0, 38.0, -38.0}) {
      for (int k = 0; k <= 15; ++k) {
        const double t = 0.5 + (k % 2 == 0 ? 1 : -1) * 0.025 * ((k + 1) / 2);
        const bool is_on = side == 0;
        candidates.push_back({a + t * along + side * aside, (is_on ? 0 : 2 + std::abs(side) / 20) + 0.03 * k,
                              is_on ? static_cast<int>(i) : -1});
      }
    }
    const std::size_t chosen = labels_.place({kDisc, kDisc}, candidates);
    const Point2& at = candidates[chosen].centre;
    const char* kind = name(nearness_[i]);
    if (chosen > 15) {
      const double t = std::clamp((at - a).dot(along) / std::max(along.squaredNorm(), 1.0), 0.0, 1.0);
      text_ += line("leader", at, a + t * along);
    }
    text_ += html("<circle class=\"disc {}\" cx=\"{}\" cy=\"{}\" r=\"{}\"/>", kind, coordinate(at.x()),
                  coordinate(at.y()), coordinate(kDisc)) +
             words(fmt::format("number {}", kind).c_str(), at, std::to_string(i + 1));
  }
}

void Picture::scale_and_axes() {
  const double length = scale_ * view_.grid.step;
  const double y = height_ - 24;
  const Point2 from(14, y);
  const Point2 to(14 + length, y);
  const DisplayUnit& unit = scene_.illustration.units.length;
  text_ += html("<path class=\"scale\" d=\"{}{}{}\"/>", path_data({from, to}, false),
                path_data({from - Point2(0, 5), from + Point2(0, 5)}, false),
                path_data({to - Point2(0, 5), to + Point2(0, 5)}, false)) +
           html("<text class=\"scale-words\" x=\"14\" y=\"{}\">{}</text>", coordinate(y + 19),
                fmt::format("{:g} {} (grid)", unit.approx(view_.grid.step), unit.name()));
  constexpr double kLong = 26;
  std::array<Point2, 3> tips;
  Eigen::AlignedBox2d bounds(Point2::Zero());
  for (Eigen::Index c = 0; c < 3; ++c) {
    tips[static_cast<std::size_t>(c)] = kLong * view_(Vector3d::Unit(c));
    bounds.extend(Point2(1.45 * tips[static_cast<std::size_t>(c)]));
  }
  const Point2 origin = Point2(width_ - 18, height_ - 14) - bounds.max();
  for (std::size_t c = 0; c < 3; ++c) {
    const std::string axis(1, "xyz"[c]);
    text_ += line(fmt::format("axis {}", axis).c_str(), origin, origin + tips[c]);
    const Point2 out = tips[c].norm() > 4 ? Point2(tips[c] + 9 * tips[c].normalized()) : Point2(9, -9);
    text_ += words("axis-name", origin + out, axis);
  }
}

Html Picture::draw(const std::string& caption, const Html& note) {
  grid();
  ghosts();
  shown_frame();
  base();
  shown_payload();
  bodies();
  platform();
  strokes();
  track();
  nearest_bodies();
  load();
  names();
  discs();
  scale_and_axes();
  return html(
      "<figure class=\"machine\"><figcaption>{}</figcaption><svg viewBox=\"0 0 {} {}\" role=\"img\" "
      "aria-label=\"The machine. {}\">{}{}{}{}</svg>{}</figure>\n",
      caption, coordinate(width_), coordinate(height_), caption, behind_, between_, front_, text_, note);
}

}  // namespace

std::array<Nearness, kCables> nearness_at(const Model<double>& model, const Statics<double>& statics) {
  std::array<Nearness, kCables> result;
  for (std::size_t i = 0; i < kCables; ++i) {
    const double d = statics.length[i];
    result[i] = nearness_of_length({d, d}, model.length_lower[i], model.length_upper[i]);
    if (!statics.regular) {
      result[i] = Nearness::kOut;
      continue;
    }
    const Range f = {statics.tension[i] - statics.tension_below[i], statics.tension[i] + statics.tension_above[i]};
    result[i] = worse(result[i], worse(nearness_to_slack(f, model.tension_lower[i], model.tension_upper[i]),
                                       nearness_to_top(f, model.tension_upper[i])));
  }
  return result;
}

Html bodies_note(const ReportContext& scene) {
  if (!scene.bodies) return {};
  const BodiesText& bodies = *scene.certificate.problem.bodies;
  if (bodies.platform.empty() && bodies.obstacles.empty()) return {};
  constexpr std::size_t kMostNames = 6;
  Html text;
  if (!bodies.obstacles.empty())
    text += html("Grey-blue: obstacles, <bdi>{}</bdi>. ", body_names(bodies.obstacles, kMostNames));
  if (!bodies.platform.empty())
    text += html("Green: on the platform, <bdi>{}</bdi>. ", body_names(bodies.platform, kMostNames));
  const bool has_line = !scene.distances.least.empty() && !found_no_path(scene.certificate);
  return html("<p class=\"note\">{}They are <b>checked</b>, as far as pairs are.{}</p>\n", text,
              has_line ? " Between two dots: the pair that is nearest to its clearance." : "");
}

Html shown_bodies_note(const ReportContext& scene) {
  const Decoration& shown = scene.illustration.decoration;
  if (!shown.frame && !shown.payload) return {};
  const char* what = shown.frame && shown.payload ? "The frame and the payload in thin lines are"
                     : shown.frame                ? "The frame in thin lines is"
                                                  : "The payload in thin lines is";
  return html("<p class=\"note\">{} drawn as the case says: <b>not checked</b>.</p>\n", what);
}

Html machine_picture(const ReportContext& scene, double position, const std::array<Nearness, kCables>& nearness,
                     const std::string& caption, const Html& note) {
  return machine_picture(scene, MachineView(scene), position, nearness, caption, {}, note);
}

Html machine_picture(const ReportContext& scene, const MachineView& view, double position,
                     const std::array<Nearness, kCables>& nearness, const std::string& caption, const PictureSize& size,
                     const Html& note) {
  const Path& path = scene.certificate.path;
  if (path.waypoints.empty()) return {};
  if (!view.is_drawable) {
    return html(
        "<figure class=\"machine\"><figcaption>{}</figcaption><p class=\"note\">No picture: the machine's "
        "numbers are too large, too small or too far from its origin to be drawn.</p></figure>\n",
        caption);
  }
  const auto last = static_cast<double>(path.segments());
  const double at = position > 0 ? std::min(position, last) : 0;
  return Picture(scene, view, at, nearness, size).draw(caption, note);
}

}  // namespace taut
