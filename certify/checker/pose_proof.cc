#include "certify/checker/pose_proof.h"

namespace taut::checker {
namespace {

template <class T>
Vector3<T> cross(const Vector3<T>& a, const Vector3<T>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector3<Form> rotate(const Matrix3<Form>& R, const Vector3<Interval>& x) {
  Vector3<Form> result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) result[i] += R[i][j] * Form(x[j]);
  }
  return result;
}

/// Rz(phi) Ry(theta) Rz(psi), multiplied out.
Matrix3<Form> rotation(const Form& phi, const Form& theta, const Form& psi) {
  const Form ca = cos(phi), sa = sin(phi), cb = cos(theta), sb = sin(theta), cg = cos(psi), sg = sin(psi);
  return {{{ca * cb * cg - sa * sg, -(ca * cb * sg) - sa * cg, ca * sb},
           {sa * cb * cg + ca * sg, ca * cg - sa * cb * sg, sa * sb},
           {-(sb * cg), sb * sg, cb}}};
}

/// Brings to row c the row below it whose entry in column c is largest in the middle (any choice is sound).
/// Returns whether rows were exchanged.
template <class Row>
bool exchange_pivot(std::array<Row, 6>& A, std::size_t c) {
  std::size_t best = c;
  for (std::size_t i = c + 1; i < 6; ++i) {
    if (certainly_positive(abs(middle(A[i][c])) - abs(middle(A[best][c])))) best = i;
  }
  if (best == c) return false;
  std::swap(A[c], A[best]);
  return true;
}

/// Gauss-Jordan elimination of [A | I] in intervals: it runs to the end only if no pivot contains zero, which proves
/// every matrix in A non-singular and encloses its inverse.
Matrix6<Interval> inverse(const Matrix6<Interval>& A) {
  std::array<std::array<Interval, 12>, 6> W;
  for (std::size_t i = 0; i < 6; ++i) {
    std::copy(A[i].begin(), A[i].end(), W[i].begin());
    W[i][6 + i] = Interval(1);
  }
  for (std::size_t c = 0; c < 6; ++c) {
    exchange_pivot(W, c);
    for (std::size_t j = c + 1; j < 12; ++j) W[c][j] = W[c][j] / W[c][c];
    for (std::size_t i = 0; i < 6; ++i) {
      if (i == c) continue;
      for (std::size_t j = c + 1; j < 12; ++j) W[i][j] -= W[i][c] * W[c][j];
    }
  }
  Matrix6<Interval> result;
  for (std::size_t i = 0; i < 6; ++i) std::copy(W[i].begin() + 6, W[i].end(), result[i].begin());
  return result;
}

Matrix6<Interval> multiply(const Matrix6<Interval>& A, const Matrix6<Interval>& B) {
  Matrix6<Interval> result;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      if (A[i][k].is_exactly_zero()) continue;
      for (std::size_t j = 0; j < 6; ++j) result[i][j] += A[i][k] * B[k][j];
    }
  }
  return result;
}

/// D^-1 on the box, as argued in the header.
Matrix6<Form> inverse(const Matrix6<Form>& D) {
  Matrix6<Interval> slope;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) slope[i][j] = D[i][j].slope;
  }
  const Matrix6<Interval> Y_mid = inverse(mid(D));

  Matrix6<Interval> C;
  Vector6<Interval> C_largest;  // in each column
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      C[i][j] = middle(Y_mid[i][j]);
      C_largest[j] = max(C_largest[j], abs(C[i][j]));
    }
  }
  Matrix6<Interval> A = multiply(C, mid(D));
  const Matrix6<Interval> A_slope = multiply(C, slope);
  Interval rho;
  for (std::size_t i = 0; i < 6; ++i) {
    Interval row_sum;
    for (std::size_t j = 0; j < 6; ++j) {
      if (i == j) A[i][j] -= Interval(1);
      A[i][j] += A_slope[i][j] * Interval::plus_minus_one();  // the mean value theorem, entry by entry
      row_sum += abs(A[i][j]);
    }
    rho = max(rho, row_sum);
  }
  const Interval gap = Interval(1) - rho;
  if (!certainly_positive(gap)) throw Undefined("the matrix of force densities may be singular");

  // (1): |(B C)_ij| <= sum_k |B_ik| max_k |C_kj| <= rho / (1 - rho) C_largest_j.
  Matrix6<Interval> Y = C;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) Y[i][j] += rho / gap * C_largest[j] * Interval::plus_minus_one();
  }
  // (2)
  const Matrix6<Interval> AY = multiply(A, Y);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) Y[i][j] = intersection(Y[i][j], C[i][j] - AY[i][j]);
  }
  // (3)
  const Matrix6<Interval> Y_slope = multiply(multiply(Y, slope), Y);
  Matrix6<Form> result;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) result[i][j] = Form::enclose(Y_mid[i][j], -Y_slope[i][j], Y[i][j]);
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

Matrix6<Interval> mid(const Matrix6<Form>& D) {
  Matrix6<Interval> result;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) result[i][j] = D[i][j].mid;
  }
  return result;
}

Interval determinant(Matrix6<Interval> A) {
  Interval result(1);
  for (std::size_t c = 0; c < 6; ++c) {
    if (exchange_pivot(A, c)) result = -result;
    result = result * A[c][c];
    for (std::size_t i = c + 1; i < 6; ++i) {
      const Interval factor = A[i][c] / A[c][c];
      for (std::size_t j = c + 1; j < 6; ++j) A[i][j] -= factor * A[c][j];
    }
  }
  return result;
}

Model::Model(const Problem& problem, int bits) : problem_(problem), bits_(bits) {
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
  M_inverse_ = inverse_cholesky_factor(problem.ellipsoid);
}

Vector6<Form> Model::pose(const Waypoint& from, const Waypoint& to, const Box& box) const {
  Form s;  // m + r u
  s.mid = Interval(mpq_class((box.begin + box.end) / 2));
  s.slope = Interval(mpq_class((box.end - box.begin) / 2));
  s.range = hull(Interval(box.begin), Interval(box.end));

  std::vector<Form> parameters;
  for (std::size_t j = 0; j < from.x.size(); ++j) {
    const auto value = [&](const Waypoint& w) {
      const Interval x{mpq_class(w.x[j])};
      return w.half_turns[j] == 0 ? x : x + Interval(w.half_turns[j]) * Interval::pi();
    };
    const Interval start = value(from);
    // Where the ends are the same number the parameter is constant, whatever rounding makes of the difference.
    const bool fixed = from.x[j] == to.x[j] && from.half_turns[j] == to.half_turns[j];
    parameters.push_back(fixed ? Form(start) : Form(start) + s * Form(value(to) - start));
  }
  Vector6<Form> result;
  for (std::size_t c = 0; c < 6; ++c) result[c] = problem_.pose[c].evaluate(parameters);
  return result;
}

Geometry Model::geometry(const Vector6<Form>& pose) const {
  const Matrix3<Form> R = rotation(pose[3], pose[4], pose[5] - pose[3]);
  Geometry result;
  for (std::size_t i = 0; i < 6; ++i) {
    Vector3<Form> d = rotate(R, platform_[i]);
    for (std::size_t c = 0; c < 3; ++c) d[c] += pose[c] - Form(base_[i][c]);
    const Form squared = sqr(d[0]) + sqr(d[1]) + sqr(d[2]);
    if (!certainly_positive(squared.range)) throw Undefined("a cable may have no length");
    result.length[i] = sqrt(squared);
    const Vector3<Form> moment = cross(rotate(R, arm_[i]), d);
    for (std::size_t c = 0; c < 3; ++c) {
      result.D[c][i] = d[c];
      result.D[3 + c][i] = moment[c];
    }
  }
  return result;
}

Tensions Model::tensions(const Geometry& geometry) const {
  const Matrix6<Form> Y = inverse(geometry.D);
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
