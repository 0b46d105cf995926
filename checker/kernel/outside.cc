// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/outside.h"

#include "checker/kernel/rotation.h"

namespace taut::checker {
namespace {

/// The numbers in the middle of the balls.
Vector6<Ball> middles(Vector6<Ball> x) {
  for (Ball& entry : x) entry = middle(entry);
  return x;
}

}  // namespace

OutsideProof::OutsideProof(const Machine& machine, const Problem& problem, std::span<const CellForm> parameters)
    : machine_(machine) {
  Vector6<CellForm> pose;
  for (std::size_t c = 0; c < 6; ++c) pose[c] = problem.pose[c].evaluate<CellForm>(parameters);
  R_ = orientation(problem, pose);
  for (std::size_t i = 0; i < kCables; ++i) {
    d_[i] = multiply(R_, machine.platform[i]);
    for (std::size_t c = 0; c < 3; ++c) d_[i][c] += pose[c] - CellForm(machine.base[i][c]);
    squared_[i] = squared_norm(d_[i]);
  }
}

bool OutsideProof::holds(const OutsideReason& reason) {
  if (reason.kind == OutsideReason::Kind::kLength) return is_beyond_length(reason.cable, reason.side);
  return is_unbalanced(reason);
}

bool OutsideProof::is_beyond_length(std::size_t cable, std::size_t side) const {
  const Ball limit = sqr(machine_.length_limits[cable][side]);
  const Ball squared = squared_[cable].range();
  return certainly_nonnegative(side == 0 ? limit - squared : squared - limit);
}

/// J, and the numbers that y is made of.
void OutsideProof::set_columns() {
  if (has_columns_) return;
  Matrix6<Ball> D;
  for (std::size_t j = 0; j < kCables; ++j) {
    if (!certainly_positive(squared_[j].range())) throw Undefined("a cable may have no length");
    const CellForm inverse = apply(Function::kInverse, apply(Function::kSqrt, squared_[j]));
    arm_[j] = multiply(R_, machine_.arms[j]);
    const Vector3<CellForm> moment = cross(arm_[j], d_[j]);
    for (std::size_t c = 0; c < 6; ++c) {
      const CellForm& entry = c < 3 ? d_[j][c] : moment[c - 3];
      J_[c][j] = entry * inverse;
      D[c][j] = middle(entry.at);
      for (std::size_t k = 0; k < kCellAxes; ++k) S_[k][c][j] = middle(entry.slope[k]);
    }
  }
  C_ = approximate_inverse(D);
  has_columns_ = true;
}

Vector6<CellForm> OutsideProof::row(const OutsideReason& reason) const {
  Vector6<Ball> row = C_[reason.cable];
  if (reason.side == 0) {
    for (Ball& y : row) y = -y;
  }
  Vector6<CellForm> result;
  for (std::size_t c = 0; c < 6; ++c) result[c].at = row[c];
  for (std::size_t k = 0; k < kCellAxes && reason.kind == OutsideReason::Kind::kFollowing; ++k) {
    const Vector6<Ball> change = middles(multiply(multiply(row, S_[k]), C_));
    for (std::size_t c = 0; c < 6; ++c) result[c].slope[k] = -change[c];
  }
  return result;
}

/// y . w for a w of K, one at each u.
CellForm OutsideProof::work(const Vector6<CellForm>& y) const {
  Vector6<Ball> in_middle;  // numbers
  Vector6<CellForm> w;
  for (std::size_t c = 0; c < 6; ++c) {
    in_middle[c] = y[c].at;
    w[c] = CellForm(machine_.wrench[c]);
  }
  if (machine_.ellipsoid) {
    const Vector6<Ball> z = middles(multiply(in_middle, *machine_.ellipsoid));
    const Ball size = length_range(z);
    const Vector6<Ball> Lz = multiply(*machine_.ellipsoid, z);
    for (std::size_t c = 0; c < 6 && certainly_positive(size); ++c) w[c].at += Lz[c] / size;
  }
  Matrix3<Ball> R;  // numbers, close to the rotation in the middle: only to choose with
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) R[i][j] = middle(R_[i][j].at);
  }
  for (const Load& item : machine_.items) {
    const Wrench chosen = item.maximizers(item.lever(R, in_middle)).front();
    const Vector6<CellForm> about_load_point = item.about_load_point(R_, chosen);
    for (std::size_t c = 0; c < 6; ++c) w[c] += about_load_point[c];
  }
  CellForm result;
  for (std::size_t c = 0; c < 6; ++c) result += y[c] * w[c];
  return result;
}

bool OutsideProof::is_unbalanced(const OutsideReason& reason) {
  set_columns();
  const Vector6<CellForm> y = row(reason);
  CellForm left = work(y);
  for (std::size_t j = 0; j < kCables; ++j) {
    CellForm pull;
    for (std::size_t c = 0; c < 6; ++c) pull += y[c] * J_[c][j];
    const auto& [least, most] = machine_.tension_limits[j];
    const Ball over = pull.range();
    if (certainly_nonnegative(over)) {
      left -= most * pull;
    } else {
      left -= least * pull;
      const Ball highest_pull = highest(over);
      if (certainly_positive(highest_pull)) left -= CellForm(from_zero_to((most - least) * highest_pull));
    }
  }
  return certainly_positive(left.range());
}

}  // namespace taut::checker
