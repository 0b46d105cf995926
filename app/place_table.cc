// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/place_table.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

constexpr double kRounding_m = 1e-9;         // of poses and lengths that are computed, far more than they err by
constexpr double kRoundingOfTurn = 1e-9;     // likewise
constexpr double kLeastResolution = 1e-7;    // a tenth of a micrometre: nothing measures less
constexpr double kShareOfResolution = 0.01;  // of what is allowed, that a slack may be
constexpr int kLeastDepth = 2;               // so that no bend is missed that changes its sign at a middle
constexpr int kMostDepth = 20;
constexpr std::size_t kMostNodes = 400'000;  // then cells stay as long as they are, and slacks as large

Eigen::Vector4d coefficients(const Eigen::Quaterniond& q) { return q.coeffs(); }

PlaceTable::Node node_at(const PoseSampler& sampler, const Segment& segment, double s) {
  PlaceTable::Node node;
  node.s = static_cast<double>(segment.index) + s;
  node.pose = sampler.rigid_pose(segment, s);
  node.pose.q.normalize();
  node.length = cable_lengths(sampler.model(), node.pose);
  if (segment.law != Interpolation::kCableLengths) return node;
  node.length = lengths_at(segment, s);
  return node;
}

/// Of the two quaternions of its rotation, the one that is nearer to `before`.
void continue_from(const RigidPose& before, RigidPose& pose) {
  if (before.q.dot(pose.q) < 0) pose.q.coeffs() = -pose.q.coeffs();
}

/// Cuts from [lower, upper] of u what is not |x + u slope| <= radius. @returns whether anything is left.
bool cut_line(double x, double slope, double radius, double& lower, double& upper) {
  if (!(radius >= 0)) return false;
  if (slope == 0) return std::abs(x) <= radius && lower <= upper;
  const double a = (-radius - x) / slope, b = (radius - x) / slope;
  lower = std::max(lower, std::min(a, b));
  upper = std::min(upper, std::max(a, b));
  return lower <= upper;
}

/// The same for vectors.
template <class Vector>
bool cut_vector(const Vector& x, const Vector& slope, double radius, double& lower, double& upper) {
  const double square = slope.squaredNorm(), along = -x.dot(slope);
  if (!(radius >= 0)) return false;
  if (square == 0) return x.norm() <= radius && lower <= upper;
  const double nearest = along / square;
  const double beside = (x + nearest * slope).norm();
  if (!(beside <= radius)) return false;
  const double half = std::sqrt((radius - beside) * (radius + beside) / square);
  lower = std::max(lower, nearest - half);
  upper = std::min(upper, nearest + half);
  return lower <= upper;
}

}  // namespace

PlaceTable::PlaceTable(const PoseSampler& sampler, const Path& path, std::vector<Piece> pieces,
                       const Resolution& resolution)
    : pieces_(std::move(pieces)) {
  std::size_t index = path.segments();  // none yet
  Segment segment;
  for (const Piece& piece : pieces_) {
    const auto k = std::min(static_cast<std::size_t>(piece.lower), path.segments() - 1);
    if (k != index) segment = path.segment(index = k);
    const auto from = static_cast<double>(k);
    if (nodes_.empty()) nodes_.push_back(node_at(sampler, segment, piece.lower - from));
    append(sampler, segment, node_at(sampler, segment, piece.upper - from), resolution, 0);
  }
}

void PlaceTable::append(const PoseSampler& sampler, const Segment& segment, const Node& end,
                        const Resolution& resolution, int depth) {
  const Node begin = nodes_.back();
  const auto from = static_cast<double>(segment.index);
  Node middle = node_at(sampler, segment, 0.5 * (begin.s + end.s) - from);
  continue_from(begin.pose, middle.pose);
  Node last = end;
  continue_from(middle.pose, last.pose);
  Cell cell;
  bool is_fine = true;
  const auto slack = [&](double bend, double rounding, double allowed) {
    is_fine = is_fine && bend <= std::max(kLeastResolution, kShareOfResolution * allowed);
    return bend + rounding;
  };
  for (std::size_t i = 0; i < kCables; ++i) {
    const double bend = std::abs(middle.length[i] - 0.5 * (begin.length[i] + last.length[i]));
    cell.length_slack[i] = slack(bend, kRounding_m, resolution.length[i]);
  }
  cell.position_slack =
      slack((middle.pose.p - 0.5 * (begin.pose.p + last.pose.p)).norm(), kRounding_m, resolution.position);
  cell.turn_slack =
      slack((coefficients(middle.pose.q) - 0.5 * (coefficients(begin.pose.q) + coefficients(last.pose.q))).norm(),
            kRoundingOfTurn, resolution.turn);
  const bool is_last = depth >= kMostDepth || nodes_.size() > kMostNodes;
  if (depth < kLeastDepth || !(is_fine || is_last)) {
    append(sampler, segment, middle, resolution, depth + 1);
    append(sampler, segment, last, resolution, depth + 1);
    return;
  }
  for (const Node& node : {middle, last}) {
    nodes_.push_back(node);
    cells_.push_back(cell);
  }
}

std::size_t PlaceTable::cell_at(double s) const {
  const auto next = std::upper_bound(nodes_.begin(), nodes_.end(), s, [](double x, const Node& n) { return x < n.s; });
  const auto after = static_cast<std::size_t>(next - nodes_.begin());
  return std::min(after == 0 ? 0 : after - 1, cells_.size() - 1);
}

std::span<const PlaceTable::Piece> PlaceTable::pieces_at(const PlaceInterval& places) const {
  const auto first = std::partition_point(pieces_.begin(), pieces_.end(),
                                          [&](const Piece& piece) { return piece.upper < places.lower; });
  const auto end =
      std::partition_point(first, pieces_.end(), [&](const Piece& piece) { return piece.lower <= places.upper; });
  return {first, end};
}

std::optional<PlaceInterval> PlaceTable::window(std::size_t cell, const PlaceTarget& target, PlaceTarget::Mask mask,
                                                double factor) const {
  const Node& a = nodes_[cell];
  const Node& b = nodes_[cell + 1];
  const Cell& c = cells_[cell];
  mask &= target.mask;
  double lower = 0, upper = 1;
  for (std::size_t k = 0; k < PlaceTarget::kLengths; ++k) {
    if ((mask & PlaceTarget::bit(k)) == 0) continue;
    const std::size_t i = k % kCables;
    const double radius = factor * target.length_allowed[k] + c.length_slack[i];
    if (!cut_line(a.length[i] - target.length[k], b.length[i] - a.length[i], radius, lower, upper)) return {};
  }
  if ((mask & PlaceTarget::bit(PlaceTarget::kPosition)) != 0) {
    const Vector3<double> off = a.pose.p - target.position, way = b.pose.p - a.pose.p;
    if (!cut_vector(off, way, factor * target.position_allowed + c.position_slack, lower, upper)) return {};
  }
  if ((mask & PlaceTarget::bit(PlaceTarget::kTurn)) != 0) {
    const Eigen::Vector4d first = coefficients(a.pose.q), way = coefficients(b.pose.q) - first;
    const double sign = first.dot(target.turn) < 0 ? -1 : 1;
    const Eigen::Vector4d off = first - sign * target.turn;
    if (!cut_vector(off, way, factor * target.turn_allowed + c.turn_slack, lower, upper)) return {};
  }
  return PlaceInterval{a.s + lower * (b.s - a.s), a.s + upper * (b.s - a.s)};
}

std::vector<PlaceInterval> PlaceTable::places(const PlaceTarget& target, PlaceTarget::Mask mask, std::size_t first_cell,
                                              std::size_t end_cell, double factor) const {
  std::vector<PlaceInterval> result;
  for (std::size_t k = first_cell; k < end_cell; ++k) {
    const std::optional<PlaceInterval> found = window(k, target, mask, factor);
    if (!found) continue;
    if (!result.empty() && result.back().upper >= found->lower) {
      result.back().upper = found->upper;
    } else {
      result.push_back(*found);
    }
  }
  return result;
}

PlaceTable::Fit PlaceTable::best_fit(const PlaceTarget& target, PlaceTarget::Mask mask, std::size_t first_cell,
                                     std::size_t end_cell) const {
  // Cells that are left with a factor are few with a smaller one.
  std::vector<std::size_t> cells;
  double high = 1;
  constexpr double kMostFactor = 1e30;
  for (; cells.empty() && high < kMostFactor; high *= 4) {
    for (std::size_t k = first_cell; k < end_cell; ++k) {
      if (window(k, target, mask, high)) cells.push_back(k);
    }
    if (!cells.empty()) break;
  }
  if (cells.empty()) return {nodes_[first_cell].s, high};  // nothing is allowed at all
  double low = high > 1 ? high / 4 : 0;
  constexpr int kHalvings = 24;
  std::vector<std::size_t> left;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    left.clear();
    std::ranges::copy_if(cells, std::back_inserter(left),
                         [&](std::size_t cell) { return window(cell, target, mask, middle).has_value(); });
    if (left.empty()) {
      low = middle;
    } else {
      high = middle;
      cells.swap(left);
    }
  }
  const PlaceInterval places = *window(cells.front(), target, mask, high);
  return {0.5 * (places.lower + places.upper), high};
}

PlaceTable::Node PlaceTable::at(double s) const {
  const std::size_t k = cell_at(s);
  const Node& a = nodes_[k];
  const Node& b = nodes_[k + 1];
  const double u = std::clamp((s - a.s) / (b.s - a.s), 0.0, 1.0);
  Node node;
  node.s = s;
  node.pose.p = (1 - u) * a.pose.p + u * b.pose.p;
  node.pose.q = Eigen::Quaterniond(Eigen::Vector4d((1 - u) * coefficients(a.pose.q) + u * coefficients(b.pose.q)));
  node.pose.q.normalize();
  for (std::size_t i = 0; i < kCables; ++i) node.length[i] = (1 - u) * a.length[i] + u * b.length[i];
  return node;
}

PlaceTable::Spread PlaceTable::spread(const PlaceInterval& places, const Node& from) const {
  Spread result;
  const auto consider = [&](const Node& node) {
    result.position = std::max(result.position, (node.pose.p - from.pose.p).norm());
    result.turn = std::max(result.turn, node.pose.q.angularDistance(from.pose.q));
  };
  double position_slack = 0, turn_slack = 0;
  consider(at(places.lower));
  consider(at(places.upper));
  for (std::size_t k = cell_at(places.lower); k < cells_.size() && nodes_[k].s <= places.upper; ++k) {
    if (nodes_[k].s >= places.lower) consider(nodes_[k]);
    position_slack = std::max(position_slack, cells_[k].position_slack);
    turn_slack = std::max(turn_slack, cells_[k].turn_slack);
  }
  // `from` is on a chord, too. An angle is less than 4 times the distance of its quaternions.
  result.position += 2 * position_slack;
  result.turn += 2 * 4 * turn_slack;
  return result;
}

}  // namespace taut
