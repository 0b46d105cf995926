// SPDX-License-Identifier: GPL-3.0-or-later
#include "planner/move_fit.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "kinematics/pose_conversion.h"

namespace taut {
namespace {

constexpr std::size_t kLeastPieces = 3;      // each end takes three equal control points
constexpr std::size_t kMostPieces = 19'997;  // of a law's 20,000 control values
constexpr std::size_t kRowsOfPiece = 2;      // at least, on average: fewer would let the spline pass all rows
constexpr double kNearEnough = 0.01;         // of the rounding
constexpr double kNearer = 0.8;              // what twice as many pieces have to come to
constexpr double kSmoother = 1.15;           // how much farther the smoothest fit may be
constexpr double kBelowOne = 1 - 1e-6;       // leaves something to proved bounds
constexpr double kLeastPenalty = -6, kMostPenalty = 6;  // powers of ten, a row
constexpr double kLightPenalty = -2;

RowOffset offset(const Model<double>& model, const RigidPose& a, const RigidPose& b, const RowRounding& rounding) {
  RowOffset result;
  result.position_m = (a.p - b.p).norm();
  const Eigen::Quaterniond turn = a.q.conjugate() * b.q;
  result.angle_rad = 2 * std::atan2(turn.vec().norm(), std::abs(turn.w()));
  if (rounding.length_m > 0) {
    const std::array<double, kCables> of_a = cable_lengths(model, a), of_b = cable_lengths(model, b);
    for (std::size_t i = 0; i < kCables; ++i) result.length_m = std::max(result.length_m, std::abs(of_a[i] - of_b[i]));
    result.share = result.length_m / rounding.length_m;
  } else {
    result.share = std::max(result.position_m / rounding.position_m, result.angle_rad / rounding.angle_rad);
  }
  if (!std::isfinite(result.share)) result.share = std::numeric_limits<double>::infinity();
  return result;
}

class Fitter {
 public:
  Fitter(const Problem& problem, std::span<const TimedRow> rows, const Rational& duration, const RowRounding& rounding)
      : sampler_(problem),
        rows_(rows),
        duration_(duration),
        rounding_(rounding),
        parameters_(problem.space.parameters.size()),
        differences_(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(parameters_)) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      poses_.push_back(sampler_.rigid_pose(sampler_.pose(rows[i].parameters)));
      for (std::size_t j = 0; j < parameters_; ++j) {
        differences_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
            rows[i].parameters[j] - rows.front().parameters[j];
      }
    }
  }

  MoveFit run() {
    const std::size_t most = std::clamp((rows_.size() - 1) / kRowsOfPiece, kLeastPieces, kMostPieces);
    Fit best = nearest(kLeastPieces);
    for (std::size_t pieces = kLeastPieces; pieces < most && best.worst.share > kNearEnough;) {
      pieces = std::min(2 * pieces, most);
      Fit next = nearest(pieces);
      const bool is_nearer = next.worst.share < kNearer * best.worst.share;
      if (best.worst.share <= kBelowOne && !is_nearer) break;
      if (next.worst.share < best.worst.share) best = std::move(next);
    }
    if (best.worst.share <= kBelowOne) best = smoothest(std::move(best));
    return {path(best), best.worst};
  }

 private:
  /// Values of the spline's control points after the first, which stand for three each at the ends.
  struct Fit {
    std::size_t pieces = 0;
    Eigen::MatrixXd values;  ///< one row a value, over the first row's parameters
    RowOffset worst;
  };

  [[nodiscard]] Eigen::Index value_of(std::size_t control, std::size_t pieces) const {
    return static_cast<Eigen::Index>(std::clamp<std::size_t>(control, 2, pieces) - 2);
  }

  /// A row's weights of control points k to k + 3.
  struct Place {
    std::size_t piece;
    std::array<double, 4> weights;
  };
  [[nodiscard]] Place place(double time_s, std::size_t pieces) const {
    const double at = time_s / duration_.convert_to<double>() * static_cast<double>(pieces);
    const auto piece = static_cast<std::size_t>(std::clamp(std::floor(at), 0.0, static_cast<double>(pieces - 1)));
    const double u = std::clamp(at - static_cast<double>(piece), 0.0, 1.0), v = 1 - u;
    return {piece,
            {v * v * v / 6, (3 * u * u * u - 6 * u * u + 4) / 6, (-3 * u * u * u + 3 * u * u + 3 * u + 1) / 6,
             u * u * u / 6}};
  }

  [[nodiscard]] Fit fit(std::size_t pieces, double penalty_exponent) const {
    const auto size = static_cast<Eigen::Index>(pieces - 1);
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(size, static_cast<Eigen::Index>(parameters_));
    const auto add = [&](std::size_t first, const std::array<double, 4>& weights, double factor) {
      for (std::size_t a = 0; a < weights.size(); ++a) {
        for (std::size_t b = 0; b < weights.size(); ++b) {
          entries.emplace_back(value_of(first + a, pieces), value_of(first + b, pieces),
                               factor * weights[a] * weights[b]);
        }
      }
    };
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const Place at = place(rows_[i].time_s, pieces);
      add(at.piece, at.weights, 1);
      for (std::size_t a = 0; a < at.weights.size(); ++a) {
        right.row(value_of(at.piece + a, pieces)) += at.weights[a] * differences_.row(static_cast<Eigen::Index>(i));
      }
    }
    const double rows_of_piece = static_cast<double>(rows_.size()) / static_cast<double>(pieces);
    for (std::size_t k = 0; k < pieces; ++k) add(k, {-1, 3, -3, 1}, rows_of_piece * std::pow(10, penalty_exponent));
    Eigen::SparseMatrix<double> normal(size, size);
    normal.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>> solver(normal);
    Fit result{pieces, solver.solve(right), {}};
    result.worst = worst(result);
    return result;
  }

  [[nodiscard]] RowOffset worst(const Fit& fit) const {
    RowOffset result;
    std::vector<double> parameters(parameters_);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const Place at = place(rows_[i].time_s, fit.pieces);
      parameters = rows_.front().parameters;
      for (std::size_t a = 0; a < at.weights.size(); ++a) {
        const Eigen::Index value = value_of(at.piece + a, fit.pieces);
        for (std::size_t j = 0; j < parameters_; ++j) {
          parameters[j] += at.weights[a] * fit.values(value, static_cast<Eigen::Index>(j));
        }
      }
      RowOffset row = offset(sampler_.model(), sampler_.rigid_pose(sampler_.pose(parameters)), poses_[i], rounding_);
      row.row = i;
      if (i == 0 || row.share > result.share) result = row;
    }
    return result;
  }

  /// The fit that is nearest to the rows: next to none of a penalty, which follows noise, or a light one.
  [[nodiscard]] Fit nearest(std::size_t pieces) const {
    Fit free = fit(pieces, kLeastPenalty), light = fit(pieces, kLightPenalty);
    return light.worst.share < free.worst.share ? light : free;
  }

  /// The largest penalty under which all rows stay about as near as they are.
  [[nodiscard]] Fit smoothest(Fit best) const {
    const double most = std::min(kBelowOne, std::max(kNearEnough, kSmoother * best.worst.share));
    double near = kLeastPenalty, far = kMostPenalty;
    constexpr double kFineEnough = 0.05;
    while (far - near > kFineEnough) {
      const double middle = (near + far) / 2;
      Fit next = fit(best.pieces, middle);
      if (next.worst.share <= most) {
        best = std::move(next);
        near = middle;
      } else {
        far = middle;
      }
    }
    return best;
  }

  [[nodiscard]] Path path(const Fit& fit) const {
    Path result;
    result.interpolation = Interpolation::kCubicBSpline;
    TimeLaw law{Rational(duration_ / fit.pieces).convert_to<double>(), {}};
    for (std::size_t i = 0; i < fit.pieces + 3; ++i) {
      std::vector<double> x = rows_.front().parameters;
      for (std::size_t j = 0; j < parameters_; ++j) {
        x[j] += fit.values(value_of(i, fit.pieces), static_cast<Eigen::Index>(j));
      }
      result.waypoints.emplace_back(std::move(x), std::vector<int>(parameters_, 0));
      law.controls.push_back(static_cast<double>(i) - 1);  // σ(t) = t/h
    }
    result.timing = std::move(law);
    return result;
  }

  PoseSampler sampler_;
  std::span<const TimedRow> rows_;
  Rational duration_;
  RowRounding rounding_;
  std::size_t parameters_;
  Eigen::MatrixXd differences_;  ///< of the rows' parameters from the first row's
  std::vector<RigidPose> poses_;
};

}  // namespace

MoveFit fit_move(const Problem& problem, std::span<const TimedRow> rows, const Rational& duration,
                 const RowRounding& rounding) {
  return Fitter(problem, rows, duration, rounding).run();
}

std::optional<MovingEnd> moving_end(const Problem& problem, std::span<const TimedRow> rows,
                                    const RowRounding& rounding) {
  constexpr double kFar = 16;          // roundings, beyond which half the way tells how it was gone
  constexpr double kLeastPower = 1.5;  // of time: 2 at constant acceleration, 1 at constant speed
  const PoseSampler sampler(problem);
  for (const bool is_last : {false, true}) {
    const auto row = [&](std::size_t i) -> const TimedRow& { return rows[is_last ? rows.size() - 1 - i : i]; };
    const auto from_end = [&](std::size_t i) {
      return offset(sampler.model(), sampler.rigid_pose(sampler.pose(row(0).parameters)),
                    sampler.rigid_pose(sampler.pose(row(i).parameters)), rounding);
    };
    const auto seconds = [&](std::size_t i) { return std::abs(row(i).time_s - row(0).time_s); };
    std::size_t far = 2;
    while (far + 1 < rows.size() && from_end(far).share < kFar) ++far;
    std::size_t half = 1;
    while (half + 1 < far && seconds(half + 1) <= seconds(far) / 2) ++half;
    const RowOffset near = from_end(half), all = from_end(far);
    if (all.share < kFar) continue;
    const double power = std::log(all.share / near.share) / std::log(seconds(far) / seconds(half));
    if (!(power < kLeastPower)) continue;
    return MovingEnd{is_last, near.position_m / seconds(half), near.angle_rad / seconds(half)};
  }
  return std::nullopt;
}

}  // namespace taut
