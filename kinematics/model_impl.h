// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of model.h.
#pragma once

#include "base/input_error.h"

namespace taut {

template <class S>
Matrix6<S> ellipsoid_root(const Matrix6<S>& ellipsoid, bool is_diagonal) {
  if (is_diagonal) {
    Matrix6<S> root;
    for (int i = 0; i < 6; ++i) {
      if (!certainly_positive(ellipsoid(i, i))) {
        throw InputError("load.ellipsoid: got a matrix that is not (provably) positive definite");
      }
      for (int j = 0; j < 6; ++j) root(i, j) = i == j ? S(S(1.0) / sqrt(ellipsoid(i, i))) : S(0.0);
    }
    return root;
  }
  // E = M M^T, M lower triangular.
  Matrix6<S> m;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) m(i, j) = S(0.0);
  }
  for (int j = 0; j < 6; ++j) {
    S pivot = ellipsoid(j, j);
    for (int k = 0; k < j; ++k) pivot = pivot - sqr(m(j, k));
    if (!certainly_positive(pivot)) {
      throw InputError("load.ellipsoid: got a matrix that is not (provably) positive definite");
    }
    m(j, j) = sqrt(pivot);
    for (int i = j + 1; i < 6; ++i) {
      S sum = ellipsoid(i, j);
      for (int k = 0; k < j; ++k) sum = sum - m(i, k) * m(j, k);
      m(i, j) = sum / m(j, j);
    }
  }
  // L = M^-T: row i of M^-1 by forward substitution, transposed.
  Matrix6<S> root;
  for (int column = 0; column < 6; ++column) {
    for (int i = 0; i < 6; ++i) {
      if (i < column) {
        root(column, i) = S(0.0);
        continue;
      }
      S sum = S(i == column ? 1.0 : 0.0);
      for (int k = column; k < i; ++k) sum = sum - m(i, k) * root(column, k);
      root(column, i) = sum / m(i, i);
    }
  }
  return root;
}

template <class S>
Angles<S> make_angles(const AnglesText& text) {
  Angles<S> angles;
  angles.kind = text.kind;
  angles.cross.setConstant(S(0.0));
  angles.square.setConstant(S(0.0));
  if (text.kind != AngleKind::kAxis) return angles;
  const auto n = [&](int i) { return S(ScalarTraits<S>::from_decimal(text.axis[static_cast<std::size_t>(i)])); };
  const S square = sqr(n(0)) + sqr(n(1)) + sqr(n(2));
  const S norm = sqrt(square);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    angles.cross(j, i) = n(k) / norm;
    angles.cross(i, j) = -(n(k) / norm);
    angles.square(i, i) = -((sqr(n(j)) + sqr(n(k))) / square);
    angles.square(i, j) = angles.square(j, i) = n(i) * n(j) / square;
  }
  return angles;
}

template <class S>
Model<S> make_model_without_ellipsoid(const Problem& problem) {
  using Traits = ScalarTraits<S>;
  Model<S> model;
  const auto vector = [](const std::array<DecimalText, 3>& text) {
    return Vector3<S>(Traits::from_decimal(text[0]), Traits::from_decimal(text[1]), Traits::from_decimal(text[2]));
  };
  model.p_PM = vector(problem.load.point_m);
  model.angles = make_angles<S>(problem.space.angles);
  double reach = 0;
  for (int i = 0; i < kCables; ++i) {
    const auto n = static_cast<std::size_t>(i);
    model.p_WA[n] = vector(problem.robot.base_anchors_m[n]);
    model.p_PB[n] = vector(problem.robot.platform_anchors_m[n]);
    for (int axis = 0; axis < 3; ++axis) model.p_MB[n](axis) = model.p_PB[n](axis) - model.p_PM(axis);
    model.tension_lower[n] = Traits::from_decimal(problem.robot.tension_N[n].lower);
    model.tension_upper[n] = Traits::from_decimal(problem.robot.tension_N[n].upper);
    model.length_lower[n] = Traits::from_decimal(problem.robot.length_m[n].lower);
    model.length_upper[n] = Traits::from_decimal(problem.robot.length_m[n].upper);
    double square = 0;
    for (const auto& text : problem.robot.platform_anchors_m[n]) {
      square += sqr(ScalarTraits<double>::from_decimal(text));
    }
    reach += std::sqrt(square) / kCables;
  }
  model.characteristic_length = reach;
  for (int i = 0; i < 6; ++i) model.wrench(i) = Traits::from_decimal(problem.load.wrench[static_cast<std::size_t>(i)]);
  model.loads = make_load_model<S>(problem.load);
  return model;
}

/// Of a canonical decimal.
inline bool is_zero(const DecimalText& text) { return text == "0"; }

inline bool has_diagonal_ellipsoid(const LoadText& load) {
  for (std::size_t i = 0; load.ellipsoid && i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      if (i != j && !is_zero((*load.ellipsoid)[i][j])) return false;
    }
  }
  return true;
}

template <class S>
void set_ellipsoid(const LoadText& load, Model<S>& model) {
  model.has_ellipsoid = load.ellipsoid.has_value();
  model.ellipsoid_is_diagonal = has_diagonal_ellipsoid(load);
  if (!load.ellipsoid) {
    model.ellipsoid.setConstant(S(0.0));
    model.ellipsoid_root.setConstant(S(0.0));
    return;
  }
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      const DecimalText& text = (*load.ellipsoid)[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
      model.ellipsoid(i, j) = is_zero(text) ? S(0.0) : S(from_rational<S>(text));
    }
  }
  model.ellipsoid_root = ellipsoid_root(model.ellipsoid, model.ellipsoid_is_diagonal);
}

template <class S>
Model<S> make_model(const Problem& problem) {
  Model<S> model = make_model_without_ellipsoid<S>(problem);
  set_ellipsoid(problem.load, model);
  return model;
}

inline ExpressionTape tape_of(const SpaceText& space, const std::vector<ExpressionText>& expressions) {
  std::vector<std::string> names;
  for (const Parameter& parameter : space.parameters) names.push_back(parameter.name);
  return ExpressionTape(expressions, names, space.constants);
}

inline ExpressionTape pose_tape(const Problem& problem) {
  return tape_of(problem.space, {problem.space.pose.begin(), problem.space.pose.end()});
}

inline ExpressionTape constraint_tape(const Problem& problem) {
  return tape_of(problem.space, problem.space.constraints);
}

}  // namespace taut
