// SPDX-License-Identifier: GPL-3.0-or-later
// An atlas: charts that cover a manifold, grown one by one (multidimensional continuation).
//
// Chart i has a centre x_i with tangent space Phi_i, a radius r_i within which the tangent space is close to the
// manifold, and a polytope P_i in that tangent space, the points that are nearer to x_i than to the charts around it.
// A vertex of P_i outside the ball of radius r_i is *external*: nothing covers that corner yet, so a new chart is made
// in its direction. Above three dimensions polytopes are known along fixed rays only (sampled_polytope.h), whose ends
// take the place of vertices; charts then cover densely, but gaps between rays may remain. If two charts lie on the
// same sheet, the bisector of their centres cuts both polytopes. In the tangent space of i it is
//
//   u . u_j <= |x_j - x_i|^2 / 2,   u_j = Phi_i^T (x_j - x_i).                               (1)
//
// This differs from Henderson's cut in two ways. It does not depend on the radii, so that a radius may shrink later
// without changing any other chart; the price is a few more charts where radii differ. And the right side is the
// distance in the ambient space. The polytopes are then slices of one Voronoi diagram of that space, and charts agree
// on which of them touch, except in near-ties (on a sphere, always).
// A new centre lies in its parent's polytope, at least step * radius / 2^max_halvings from every other centre.
// Therefore a compact manifold has finitely many charts. Up to three dimensions they cover it.
//
// Sources: M. E. Henderson, "Multiple parameter continuation", 2002; J. M. Porta, L. Jaillet, O. Bohigas,
// "Randomized path planning on manifolds based on higher-dimensional continuation", 2012.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include "atlas/manifold.h"
#include "atlas/neighbour_index.h"
#include "atlas/polytope.h"
#include "atlas/sampled_polytope.h"

namespace taut {

/// Lengths are in the ambient space's unit.
struct AtlasOptions {
  double radius = 0.15;             ///< largest chart radius
  double epsilon = 0.15;            ///< largest distance of a new centre from its parent's tangent space
  double min_tangent_cosine = 0.8;  ///< least product of the cosines of the angles between two neighbours' tangents
  double step = 0.95;               ///< distance from a chart to a new centre, in radii
  int max_halvings = 3;             ///< how often that distance is halved before a direction is given up
  int max_charts = 200000;

  /// @throws std::invalid_argument naming the field at fault.
  void validate() const;
};

using ChartPolytope = std::variant<Polytope, SampledPolytope>;  ///< sampled above Polytope::kMaxDimension

struct Chart {
  Frame frame;
  double radius;
  ChartPolytope polytope;
  bool complete = false;  ///< every external corner has been tried

  /// Whether a point of the tangent space, at this distance from the centre, is in the ball, up to rounding.
  [[nodiscard]] bool covers(double distance) const { return distance <= radius * (1 + 1e-9); }
};

class AtlasFile;

class Atlas {
 public:
  /// @throws std::invalid_argument for inconsistent options or dimensions that are not supported.
  Atlas(const Manifold& manifold, const AtlasOptions& options);

  /// Begins with the charts of a file, which must outlive the atlas; each chart is read when it is needed. The atlas
  /// then behaves exactly as the saved one would have. @pre `options` are the file's, except for max_charts.
  /// @throws InputError if the file's charts do not lie on the manifold; members that read a chart may throw it, too.
  Atlas(const Manifold& manifold, const AtlasOptions& options, const AtlasFile& file);

  /// Adds a chart centred at exactly these coordinates, unless one is already centred at the same point. Returns the
  /// chart, or nullopt outside the domain. Ignores max_charts.
  std::optional<int> add(const Coordinates& coordinates);

  /// Makes charts around a chart until all external corners of its polytope have been tried, or until `budget` charts
  /// have been made. If a chart is given as `target`, corners in its direction come first. New charts get the last ids.
  /// @returns whether the chart is complete; false if max_charts is reached before.
  bool expand(int chart, int budget = std::numeric_limits<int>::max(), std::optional<int> target = std::nullopt);

  /// Expands every chart, in order of creation, while go_on() is true (if it is set). @returns whether all are
  /// complete; false if max_charts is reached before.
  bool grow_all(const std::function<bool()>& go_on = {});

  /// Charts that bound this one's polytope and whose polytopes it bounds, ascending.
  [[nodiscard]] std::vector<int> neighbours(int chart) const;

  [[nodiscard]] int size() const { return static_cast<int>(charts_.size()); }
  /// Not thread-safe: a stored chart is restored on first use.
  [[nodiscard]] const Chart& chart(int id) const { return restored(id); }
  /// Coordinates of the chart's centre; cheaper than chart(id) for a stored chart.
  [[nodiscard]] Coordinates coordinates(int id) const;
  [[nodiscard]] bool complete(int id) const;
  /// The centres with their reach, as one tree of the neighbour index.
  [[nodiscard]] NeighbourIndex::Entries places() const { return index_.tree(); }
  [[nodiscard]] const Manifold& manifold() const { return manifold_; }
  [[nodiscard]] const AtlasOptions& options() const { return options_; }
  [[nodiscard]] long distance_evaluations() const { return index_.distance_evaluations(); }
  [[nodiscard]] long frame_evaluations() const { return frame_evaluations_; }

 private:
  void grow_towards(int parent, int corner);
  int insert(double radius);
  void separate(int a, int b, double squared_distance);
  Chart& restored(int id) const {
    if (!charts_[id]) restore(id);
    return *charts_[id];
  }
  void restore(int id) const;
  double radius(int id) const;
  double circumradius(int id) const;  ///< of the polytope; an upper bound if it has pending cuts
  const Frame& frame(int id) const;
  bool is_as_stored(int id) const;
  bool is_bounded_by(int chart, int other) const;

  const Manifold& manifold_;
  AtlasOptions options_;
  double reach_;  ///< the distance up to which centres bound each other's polytopes, in radii
  const AtlasFile* file_ = nullptr;
  // Frame and polytope of a stored chart are made on first use. Until then the chart is null here, and cuts by later
  // charts are pending.
  mutable std::vector<std::unique_ptr<Chart>> charts_;
  mutable std::unordered_map<int, Frame> stored_frames_;
  mutable std::unordered_map<int, std::vector<int>> pending_cuts_;
  NeighbourIndex index_;
  Frame candidate_;                           ///< the frame of the next chart
  std::vector<std::pair<double, int>> near_;  ///< buffer of insert(): squared distance, chart
  long frame_evaluations_ = 0;
};

}  // namespace taut
