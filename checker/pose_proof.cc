#include "checker/pose_proof.h"

namespace taut::checker {
namespace {

Vector3<Form> rotate(const Matrix3<Form>& R, const Vector3<Interval>& x) {
  Vector3<Form> result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) result[i] += R[i][j] * Form(x[j]);
  }
  return result;
}

/// M^-1 with E = M M', M lower triangular with a positive diagonal. Such an M exists exactly if E is positive definite.
Matrix6<Interval> inverse_cholesky_factor(const std::array<std::array<mpq_class, 6>, 6>& E) {
  Matrix6<Interval> M;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      Interval rest(E[i][j]);
      for (std::size_t k = 0; k < j; ++k) rest -= M[i][k] * M[j][k];
      if (i == j && !certainly_positive(rest)) throw Undefined("the wrench ellipsoid may not be positive definite");
      M[i][j] = i == j ? sqrt(rest) : rest / M[j][j];
    }
  }
  return inverse(M);  // lower triangular again: what stands above the diagonal encloses zeros, and is not used
}

}  // namespace

// (1): |(B C)_ij| <= sum_k |B_ik| max_k |C_kj| <= rho / (1 - rho) max_k |C_kj|.
Matrix6<Interval> inverses(const Matrix6<Interval>& C, const Matrix6<Interval>& A) {
  const Interval rho = norm(A);
  const Interval gap = Interval(1) - rho;
  if (!certainly_positive(gap)) throw Undefined("the matrix of force densities may be singular");
  Vector6<Interval> C_largest;  // in each column
  for (const Vector6<Interval>& row : C) {
    for (std::size_t j = 0; j < 6; ++j) C_largest[j] = max(C_largest[j], abs(row[j]));
  }
  Matrix6<Interval> Y = C;
  for (Vector6<Interval>& row : Y) {
    for (std::size_t j = 0; j < 6; ++j) row[j] += rho / gap * C_largest[j] * Interval::plus_minus_one();
  }
  constexpr int kRefinements = 2;  // by (2), each better by the factor rho
  for (int step = 0; step < kRefinements; ++step) {
    const Matrix6<Interval> AY = multiply(A, Y);
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) Y[i][j] = intersection(Y[i][j], C[i][j] - AY[i][j]);
    }
  }
  return Y;
}

Inverse inverse(const Matrix6<Form>& D) {
  Matrix6<Interval> slope;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) slope[i][j] = D[i][j].slope;
  }
  const Matrix6<Interval> Y_mid = inverse(mid(D));
  Inverse result;
  result.C = middle(Y_mid);
  result.A = multiply(result.C, mid(D));
  const Matrix6<Interval> A_slope = multiply(result.C, slope);
  for (std::size_t i = 0; i < 6; ++i) {
    result.A[i][i] -= Interval(1);
    for (std::size_t j = 0; j < 6; ++j) {
      result.A[i][j] += A_slope[i][j] * Interval::plus_minus_one();  // the mean value theorem, entry by entry
    }
  }
  const Matrix6<Interval> Y = inverses(result.C, result.A);
  const Matrix6<Interval> Y_slope = multiply(multiply(Y, slope), Y);  // (3)
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) result.Y[i][j] = Form::enclose(Y_mid[i][j], -Y_slope[i][j], Y[i][j]);
  }
  return result;
}

Matrix6<Interval> mid(const Matrix6<Form>& D) {
  Matrix6<Interval> result;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) result[i][j] = D[i][j].mid;
  }
  return result;
}

Model::Model(const Problem& problem, int bits) : bits_(bits) {
  const WorkingPrecision precision(bits);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      base_[i][c] = Interval(problem.base_anchors[i][c]);
      platform_[i][c] = Interval(problem.platform_anchors[i][c]);
      arm_[i][c] = Interval(mpq_class(problem.platform_anchors[i][c] - problem.load_point[c]));
    }
    tension_[i] = {Interval(problem.tension[i].lower), Interval(problem.tension[i].upper)};
    length_[i] = {Interval(problem.length[i].lower), Interval(problem.length[i].upper)};
    wrench_[i] = Interval(problem.wrench[i]);
  }
  for (std::size_t c = 0; c < 3; ++c) load_point_[c] = Interval(problem.load_point[c]);
  M_inverse_ = inverse_cholesky_factor(problem.ellipsoid);
  if (!problem.tolerances) return;
  const Tolerances& tolerances = *problem.tolerances;
  Deviation& deviation = deviation_.emplace();
  for (std::size_t i = 0; i < 6; ++i) {
    deviation.base[i] = Interval(tolerances.base_anchors[i]);
    deviation.platform[i] = Interval(tolerances.platform_anchors[i]);
    if (tolerances.cable_length) deviation.length[i] = Interval((*tolerances.cable_length)[i]);
    deviation.wrench[i] = Interval(tolerances.wrench[i]);
  }
  deviation.load_point = Interval(tolerances.load_point);
  deviation.position = Interval(tolerances.position);
  deviation.angle = abs(tolerances.orientation.evaluate({}).range);
}

Model Model::towards(const Model& other, const Interval& part) const {
  Model result = *this;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      result.base_[i][c] += part * (other.base_[i][c] - base_[i][c]);
      result.platform_[i][c] += part * (other.platform_[i][c] - platform_[i][c]);
    }
  }
  return result;
}

Interval Model::platform_size() const {
  Interval sum;
  for (const Vector3<Interval>& b : platform_) sum += sqrt(squared_norm(b));
  return sum / Interval(6);
}

Geometry Model::geometry(const Frame& pose) const {
  Geometry result;
  for (std::size_t i = 0; i < 6; ++i) {
    Vector3<Form> d = rotate(pose.R, platform_[i]);
    for (std::size_t c = 0; c < 3; ++c) d[c] += pose.p[c] - Form(base_[i][c]);
    const Form squared = squared_norm(d);
    if (!certainly_positive(squared.range)) throw Undefined("a cable may have no length");
    result.length[i] = sqrt(squared);
    result.d[i] = d;
    result.arm[i] = rotate(pose.R, arm_[i]);
    const Vector3<Form> moment = cross(result.arm[i], d);
    for (std::size_t c = 0; c < 3; ++c) {
      result.D[c][i] = d[c];
      result.D[3 + c][i] = moment[c];
    }
  }
  return result;
}

Tensions Model::tensions(const Geometry& geometry, const Matrix6<Form>& Y) const {
  Tensions result;
  for (std::size_t i = 0; i < 6; ++i) {
    Form density;
    Form variance;
    for (std::size_t k = 0; k < 6; ++k) {
      if (!wrench_[k].is_exactly_zero()) density += Y[i][k] * Form(wrench_[k]);
      Form component;  // of M^-1 y_i'
      for (std::size_t j = 0; j <= k; ++j) {
        if (!M_inverse_[k][j].is_exactly_zero()) component += Form(M_inverse_[k][j]) * Y[i][j];
      }
      variance += sqr(component);
    }
    result.centre[i] = geometry.length[i] * density;
    result.spread[i] = geometry.length[i] * sqrt(variance);
  }
  return result;
}

}  // namespace taut::checker
