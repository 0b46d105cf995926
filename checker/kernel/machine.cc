// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/machine.h"

namespace taut::checker {
namespace {

/// L = M^-T with E = M M', M lower triangular with a positive diagonal. Such an M exists exactly if E is positive
/// definite. M^-1 follows by forward substitution.
Matrix6<Ball> ellipsoid_factor(const std::array<std::array<mpq_class, 6>, 6>& E) {
  Matrix6<Ball> M;
  Matrix6<Ball> L;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      Ball rest(E[i][j]);
      for (std::size_t k = 0; k < j; ++k) rest -= M[i][k] * M[j][k];
      if (i == j && !certainly_positive(rest)) throw Undefined("the wrench ellipsoid may not be positive definite");
      M[i][j] = i == j ? sqrt(rest) : rest / M[j][j];
    }
    for (std::size_t j = 0; j <= i; ++j) {
      Ball rest(i == j ? 1 : 0);
      for (std::size_t k = j; k < i; ++k) rest -= M[i][k] * L[j][k];
      L[j][i] = rest / M[i][i];
    }
  }
  return L;
}

Tolerances<Ball, Ball> enclosed(const ToleranceBounds& exact) {
  Tolerances<Ball, Ball> result;
  result.base_anchors = balls(exact.base_anchors);
  result.platform_anchors = balls(exact.platform_anchors);
  result.load_point = Ball(exact.load_point);
  result.wrench = balls(exact.wrench);
  result.position = Ball(exact.position);
  result.orientation = magnitude(exact.orientation.evaluate<MeanValueForm>({}).range());
  if (exact.cable_length) result.cable_length = balls(*exact.cable_length);
  return result;
}

}  // namespace

Inverse::Inverse(const Matrix6<MeanValueForm>& D) {
  const Matrix6<Ball> at = map(D, [](const MeanValueForm& f) { return f.at; });
  const Matrix6<Ball> slope = map(D, [](const MeanValueForm& f) { return f.slope; });
  C_ = approximate_inverse(at);
  const Matrix6<Ball> CD = multiply(C_, at);
  const Matrix6<Ball> CD_slope = multiply(C_, slope);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) A_[i][j] = {i == j ? CD[i][j] - Ball(1) : CD[i][j], CD_slope[i][j]};
  }
  N_ = map(A_, [](const MeanValueForm& f) { return magnitude(f.range()); });
  gap_ = lowest(Ball(1) - norm(N_));
  if (!certainly_positive(gap_)) throw Undefined("the matrix of force densities may be singular");
}

Vector6<MeanValueForm> Inverse::times_P(const Vector6<Ball>& y) const {
  Ball largest;
  for (const Ball& x : y) largest = larger(largest, magnitude(x));
  const Ball bound = highest(largest / gap_);
  Vector6<Ball> q;
  for (std::size_t i = 0; i < 6; ++i) {
    q[i] = magnitude(y[i]);
    for (std::size_t j = 0; j < 6; ++j) q[i].add_product(N_[i][j], bound);
  }
  const Vector6<Ball> rest = multiply(N_, multiply(N_, q));
  Vector6<MeanValueForm> result;
  for (std::size_t i = 0; i < 6; ++i) {
    Ball at = y[i];
    Ball slope;
    for (std::size_t j = 0; j < 6; ++j) {
      at -= A_[i][j].at * y[j];
      slope -= A_[i][j].slope * y[j];
    }
    result[i] = {plus_minus(at, rest[i]), std::move(slope)};
  }
  return result;
}

Matrix6<MeanValueForm> Inverse::times(const Matrix6<Ball>& B) const {
  const Matrix6<Ball> CB = multiply(C_, B);
  Matrix6<MeanValueForm> result;
  for (std::size_t k = 0; k < 6; ++k) {
    const Vector6<MeanValueForm> column = times_P({CB[0][k], CB[1][k], CB[2][k], CB[3][k], CB[4][k], CB[5][k]});
    for (std::size_t i = 0; i < 6; ++i) result[i][k] = column[i];
  }
  return result;
}

Matrix6<MeanValueForm> Inverse::rows() const {
  Matrix6<Ball> identity;
  for (std::size_t i = 0; i < 6; ++i) identity[i][i] = Ball(1);
  return times(identity);
}

Machine::Machine(const Problem& problem) {
  load_point = balls(problem.load_point);
  wrench = balls(problem.wrench);
  if (problem.ellipsoid) ellipsoid = ellipsoid_factor(*problem.ellipsoid);
  for (const LoadItem& item : problem.items) items.emplace_back(item, problem.load_point, problem.gravity);
  for (std::size_t i = 0; i < kCables; ++i) {
    base[i] = balls(problem.base_anchors[i]);
    platform[i] = balls(problem.platform_anchors[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      arms[i][c] = Ball(mpq_class(problem.platform_anchors[i][c] - problem.load_point[c]));
    }
    tension_limits[i] = {Ball(problem.tension[i].lower), Ball(problem.tension[i].upper)};
    length_limits[i] = {Ball(problem.length[i].lower), Ball(problem.length[i].upper)};
  }
  if (problem.tolerances) tolerances = enclosed(*problem.tolerances);
  if (problem.time && problem.time->rows) row_errors = balls(problem.time->rows->error);
  if (problem.bodies) bodies.emplace(problem);
}

Geometry Machine::geometry(const Frame& pose) const {
  Geometry result;
  result.pose = pose;
  for (std::size_t i = 0; i < 6; ++i) {
    Vector3<MeanValueForm> d = multiply(pose.R, platform[i]);
    for (std::size_t c = 0; c < 3; ++c) d[c] += pose.p[c] - MeanValueForm(base[i][c]);
    const MeanValueForm squared = squared_norm(d);
    if (!certainly_positive(squared.range())) throw Undefined("a cable may have no length");
    result.length[i] = apply(Function::kSqrt, squared);
    if (!certainly_positive(result.length[i].range())) throw Undefined("a cable may have no length");
    result.d[i] = d;
    result.arm[i] = multiply(pose.R, arms[i]);
    const Vector3<MeanValueForm> moment = cross(result.arm[i], d);
    for (std::size_t c = 0; c < 3; ++c) {
      result.D[c][i] = d[c];
      result.D[3 + c][i] = moment[c];
    }
  }
  return result;
}

Tensions Machine::tensions(const Geometry& geometry, const Inverse& inverse, const Vector6<Ball>& beside) const {
  Tensions result;
  if (ellipsoid) {
    const Matrix6<MeanValueForm> Z = inverse.times(*ellipsoid);
    for (std::size_t i = 0; i < 6; ++i) {
      MeanValueForm squared;
      for (const MeanValueForm& z : Z[i]) squared += sqr(z);
      result.radius[0][i] = result.radius[1][i] = apply(Function::kSqrt, squared);
    }
  }
  if (items.empty()) {
    result.density = inverse.times(beside);
  } else {
    add_items(geometry.pose.R, inverse, beside, result);
  }
  return result;
}

/// The nominal wrench w is known to first order: D^-1 w = D^-1 c + sum_k (column k of D^-1) (w - c)_k, with c the
/// numbers in the middle of w. The first term is much closer than a sum over columns.
void Machine::add_items(const Matrix3<MeanValueForm>& R, const Inverse& inverse, const Vector6<Ball>& beside,
                        Tensions& to) const {
  const Matrix6<MeanValueForm> Y = inverse.rows();
  Vector6<MeanValueForm> nominal;
  for (std::size_t k = 0; k < 6; ++k) nominal[k] = MeanValueForm(beside[k]);
  for (const Load& item : items) {
    const Vector6<MeanValueForm> w = item.nominal_about_load_point(R);
    for (std::size_t k = 0; k < 6; ++k) nominal[k] += w[k];
  }
  Vector6<Ball> centre;
  for (std::size_t k = 0; k < 6; ++k) centre[k] = middle(nominal[k].at);
  to.density = inverse.times(centre);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < 6; ++k) to.density[i] += Y[i][k] * (nominal[k] - MeanValueForm(centre[k]));
    for (const Load& item : items) {
      const Lever<MeanValueForm> y = item.lever(R, Y[i]);
      to.radius[0][i] += item.above(-y);
      to.radius[1][i] += item.above(y);
    }
  }
}

}  // namespace taut::checker
