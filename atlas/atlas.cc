// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/atlas.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "atlas/atlas_file.h"

namespace taut {
namespace {

// Two charts are neighbours only if the distance of each centre from the other's tangent space is at most this fraction
// of the distance along it: a slope of 27 degrees, even if epsilon allows more.
constexpr double kMaxSlope = 0.5;
// Neighbours are up to two radii apart. There a curved manifold is four times as far from the tangent space as at one
// radius, and has turned by twice the angle.
constexpr double kDistanceGrowth = 4.0;
// The bisectors with charts further away than this many radii do not meet the chart's ball.
constexpr double kReach = 2.0;
// The same for sampled polytopes. Twice the distance contains 2^n times as many charts, and the nearer ones shorten all
// rays that the others would.
constexpr double kSampledReach = 1.4;
// Half side of the cube from which polytopes are cut, in radii. All its corners are outside the ball, also for n = 1.
constexpr double kCube = 1.25;
constexpr const char* kOutside = "its centre is outside the domain";
// Centres closer than this fraction of a radius are the same point.
constexpr double kSamePoint = 1e-9;

using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxDimension, kMaxDimension>;

double absolute_determinant(const SmallMatrix& a) {
  if (a.rows() == 1) return std::abs(a(0, 0));
  if (a.rows() == 2) return std::abs(a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0));
  return std::abs(a.determinant());
}

// The centres of two frames, each in the other's tangent space.
struct View {
  TangentVector u_ab;  // b's centre in a's tangent space
  TangentVector u_ba;
  double distance_ab;  // of b's centre from a's tangent space
  double distance_ba;

  View(const Frame& a, const Frame& b) {
    const Eigen::VectorXd from_a_to_b = b.point() - a.point();
    const double squared_distance = from_a_to_b.squaredNorm();
    u_ab = a.tangent_part(from_a_to_b);
    u_ba = -b.tangent_part(from_a_to_b);
    distance_ab = std::sqrt(std::max(0.0, squared_distance - u_ab.squaredNorm()));
    distance_ba = std::sqrt(std::max(0.0, squared_distance - u_ba.squaredNorm()));
  }

  [[nodiscard]] bool near(double epsilon) const {
    return distance_ab <= std::min(epsilon, kMaxSlope * u_ab.norm()) &&
           distance_ba <= std::min(epsilon, kMaxSlope * u_ba.norm());
  }
};

bool tangents_agree(const Frame& a, const Frame& b, double min_cosine) {
  SmallMatrix product(a.tangent().cols(), b.tangent().cols());
  for (int i = 0; i < product.rows(); ++i) {
    for (int j = 0; j < product.cols(); ++j) product(i, j) = a.tangent().col(i).dot(b.tangent().col(j));
  }
  // The singular values s_i are cosines, so prod s_i^2 >= 1 - sum (1 - s_i^2); this bound nearly always suffices.
  const double least_squared = 1.0 - static_cast<double>(product.rows()) + product.squaredNorm();
  return least_squared >= min_cosine * min_cosine || absolute_determinant(product) >= min_cosine;
}

// Nothing if the tangent spaces of a parent and a new centre differ too much; else the radius at which the manifold,
// with the curvature that it has between them, is epsilon away from its tangent space.
std::optional<double> flat_radius(const Frame& parent, const Frame& child, const AtlasOptions& options) {
  const View view(parent, child);
  if (!view.near(options.epsilon) || !tangents_agree(parent, child, options.min_tangent_cosine)) return std::nullopt;
  const double left_by = std::max(view.distance_ab, view.distance_ba);
  if (left_by == 0) return std::numeric_limits<double>::infinity();
  return view.u_ab.norm() * std::sqrt(options.epsilon / left_by);
}

ChartPolytope make_polytope(int dimension, double radius) {
  if (dimension > Polytope::kMaxDimension) return SampledPolytope(dimension, kCube * radius);
  return Polytope(dimension, kCube * radius);
}

double circumradius(const Chart& chart) {
  return std::visit([](const auto& polytope) { return polytope.circumradius(); }, chart.polytope);
}

bool has_facet(const Chart& chart, int facet) {
  return std::visit([facet](const auto& polytope) { return polytope.has_facet(facet); }, chart.polytope);
}

void clip(Chart& chart, const TangentVector& normal, double offset, int facet) {
  std::visit([&](auto& polytope) { polytope.clip(normal, offset, facet); }, chart.polytope);
}

// The external corner to be tried next: the one furthest out, or, with `direction`, the one nearest to it. -1 if none.
int external_corner(const Chart& chart, const TangentVector* direction) {
  return std::visit(
      [&](const auto& polytope) {
        int best = -1;
        double best_score = -std::numeric_limits<double>::infinity();
        for (int c = 0; c < polytope.corners(); ++c) {
          const double distance = polytope.distance(c);
          if (polytope.is_marked(c) || chart.covers(distance)) continue;
          const double score = direction ? polytope.corner(c).dot(*direction) / distance : distance;
          if (score > best_score) {
            best_score = score;
            best = c;
          }
        }
        return best;
      },
      chart.polytope);
}

double cosine_of_double_angle(double cosine) { return std::max(0.0, 2 * cosine * cosine - 1); }

}  // namespace

void AtlasOptions::validate() const {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(std::string("AtlasOptions: ") + what);
  };
  require(radius > 0 && std::isfinite(radius), "radius must be positive");
  require(epsilon > 0, "epsilon must be positive");
  require(min_tangent_cosine > 0 && min_tangent_cosine < 1, "min_tangent_cosine must be between 0 and 1");
  require(step > 0 && step < kReach, "step must be between 0 and 2");
  require(max_halvings >= 0 && max_halvings <= 20, "max_halvings must be between 0 and 20");
  require(max_charts >= 1, "max_charts must be positive");
}

Atlas::Atlas(const Manifold& manifold, const AtlasOptions& options)
    : manifold_(manifold),
      options_(options),
      reach_(manifold.dimension() > Polytope::kMaxDimension ? kSampledReach : kReach) {
  options_.validate();
  if (manifold.dimension() < 1 || manifold.dimension() > kMaxDimension) {
    throw std::invalid_argument("Atlas: manifold dimension must be between 1 and 6");
  }
  if (manifold.coordinate_dimension() < 1 || manifold.coordinate_dimension() > kMaxCoordinates) {
    throw std::invalid_argument("Atlas: a point must be named by 1 to 8 coordinates");
  }
}

Atlas::Atlas(const Manifold& manifold, const AtlasOptions& options, const AtlasFile& file) : Atlas(manifold, options) {
  file.require_on(manifold);
  file_ = &file;
  index_ = NeighbourIndex(file.places());
  charts_.resize(file.size());
}

void Atlas::restore(int id) const {
  static_cast<void>(frame(id));
  charts_[id] = std::make_unique<Chart>(Chart{std::move(stored_frames_.extract(id).mapped()), file_->radius(id),
                                              file_->polytope(id), file_->complete(id)});
  const auto pending = pending_cuts_.extract(id);
  if (pending.empty()) return;
  const Frame& own = charts_[id]->frame;
  for (const int other : pending.mapped()) {
    const Frame& theirs = charts_[other]->frame;
    clip(*charts_[id], own.tangent_coordinates(theirs.point()), (own.point() - theirs.point()).squaredNorm() / 2,
         other);
  }
}

double Atlas::radius(int id) const { return charts_[id] ? charts_[id]->radius : file_->radius(id); }

double Atlas::circumradius(int id) const {
  return charts_[id] ? taut::circumradius(*charts_[id]) : file_->circumradius(id);
}

const Frame& Atlas::frame(int id) const {
  if (charts_[id]) return charts_[id]->frame;
  const auto [frame, is_new] = stored_frames_.try_emplace(id);
  if (is_new && !manifold_.frame_at(file_->coordinates(id), frame->second)) file_->fail_at(id, kOutside);
  return frame->second;
}

Coordinates Atlas::coordinates(int id) const {
  return charts_[id] ? Coordinates(charts_[id]->frame.coordinates()) : file_->coordinates(id);
}

bool Atlas::complete(int id) const { return charts_[id] ? charts_[id]->complete : file_->complete(id); }

std::optional<int> Atlas::add(const Coordinates& coordinates) {
  ++frame_evaluations_;
  if (!manifold_.frame_at(coordinates, candidate_)) return std::nullopt;
  std::optional<int> same;
  const double closest = kSamePoint * options_.radius;
  index_.visit(NeighbourIndex::locate(candidate_.point()), 0, [&](int other, double squared_distance) {
    if (squared_distance > closest * closest) return;
    if ((restored(other).frame.point() - candidate_.point()).norm() <= closest) same = other;
  });
  return same ? *same : insert(options_.radius);
}

bool Atlas::expand(int chart_id, int budget, std::optional<int> target) {
  if (complete(chart_id)) return true;
  Chart& chart = restored(chart_id);
  TangentVector direction;
  if (target) direction = chart.frame.tangent_coordinates(restored(*target).frame.point());
  const int first_new = size();
  while (true) {
    const int corner = external_corner(chart, target ? &direction : nullptr);
    if (corner < 0) return chart.complete = true;
    if (size() >= options_.max_charts || size() - first_new >= budget) return false;
    grow_towards(chart_id, corner);
  }
}

// Tries to make a chart in the direction of an external corner, at shorter and shorter distances. The corner is marked
// first. If a chart is made, its bisector cuts the corner off; if not, the mark says that the corner was tried.
void Atlas::grow_towards(int parent_id, int corner) {
  Chart& parent = restored(parent_id);
  const TangentVector direction = std::visit(
      [corner](auto& polytope) -> TangentVector {
        polytope.mark(corner);
        return polytope.corner(corner).normalized();
      },
      parent.polytope);
  double distance = options_.step * parent.radius;
  bool too_curved = false;  // why the last distance failed: too curved, or else outside the domain
  Coordinates coordinates;
  for (int halvings = 0; halvings <= options_.max_halvings; ++halvings, distance /= 2) {
    ++frame_evaluations_;
    const bool projected = manifold_.project(parent.frame, distance * direction, coordinates);
    if (projected && !manifold_.frame_at(coordinates, candidate_)) {
      too_curved = false;
      continue;
    }
    const std::optional<double> flat = projected ? flat_radius(parent.frame, candidate_, options_) : std::nullopt;
    if (!flat) {
      too_curved = true;
      continue;
    }
    if (too_curved) parent.radius = distance / options_.step;
    insert(std::min({options_.radius, 2 * parent.radius, *flat}));
    return;
  }
}

// Makes a chart of the candidate. The nearest neighbours cut it first, so that most others have nothing left to cut.
int Atlas::insert(double radius) {
  const int id = size();
  charts_.push_back(std::make_unique<Chart>(
      Chart{std::move(candidate_), radius, make_polytope(manifold_.dimension(), radius), false}));
  const auto centre = charts_[id]->frame.point();
  const double reach = reach_ * radius;
  const NeighbourIndex::Point place = NeighbourIndex::locate(centre);
  near_.clear();
  index_.visit(place, reach, [&](int other, double /*squared_distance*/) {
    const double squared_distance = (frame(other).point() - centre).squaredNorm();
    const double both_reach = reach_ * std::max(radius, this->radius(other));
    if (squared_distance <= both_reach * both_reach) near_.emplace_back(squared_distance, other);
  });
  std::sort(near_.begin(), near_.end());
  for (const auto& [squared_distance, other] : near_) separate(other, id, squared_distance);
  index_.insert(id, place, reach);
  return id;
}

void Atlas::separate(int a, int b, double squared_distance) {
  const double reach =
      std::min(reach_ * std::max(radius(a), radius(b)), 2 * std::max(circumradius(a), circumradius(b)));
  if (squared_distance > reach * reach) return;
  const View view(frame(a), frame(b));
  if (!view.near(kDistanceGrowth * options_.epsilon)) return;
  const double min_cosine = cosine_of_double_angle(options_.min_tangent_cosine);
  if (!tangents_agree(frame(a), frame(b), min_cosine)) return;
  if (charts_[a]) {
    clip(*charts_[a], view.u_ab, squared_distance / 2, b);
  } else if (squared_distance / 2 < circumradius(a) * view.u_ab.norm()) {
    pending_cuts_[a].push_back(b);
  }
  clip(*charts_[b], view.u_ba, squared_distance / 2, a);
}

bool Atlas::grow_all(const std::function<bool()>& go_on) {
  for (int id = 0; id < size(); ++id) {
    if ((go_on && !go_on()) || !expand(id)) return false;
  }
  return true;
}

bool Atlas::is_as_stored(int id) const { return !charts_[id] && !pending_cuts_.contains(id); }

bool Atlas::is_bounded_by(int chart, int other) const {
  return is_as_stored(chart) ? file_->are_neighbours(chart, other) : has_facet(restored(chart), other);
}

std::vector<int> Atlas::neighbours(int chart) const {
  std::vector<int> result;
  if (is_as_stored(chart)) {
    const std::span<const int> stored = file_->neighbours(chart);
    result.assign(stored.begin(), stored.end());
  } else {
    result = std::visit([](const auto& polytope) { return polytope.cutting_facets(); }, restored(chart).polytope);
  }
  std::erase_if(result, [&](int other) { return !is_bounded_by(other, chart); });
  return result;
}

}  // namespace taut
