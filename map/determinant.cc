// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/determinant.h"

#include <array>
#include <span>
#include <stdexcept>

#include "certify/box_proof.h"
#include "map/cell_inverse.h"

namespace taut {
namespace {

/// The minors of rows 3 r, 3 r + 1 and 3 r + 2, by the set of their columns as bits.
template <class Form>
std::array<Form, 64> minors(const Matrix6<Form>& d, int r) {
  std::array<Form, 64> of_two, result;
  const int first = 3 * r;
  for (int a = 0; a < 6; ++a) {
    for (int b = a + 1; b < 6; ++b) {
      of_two.at(static_cast<std::size_t>(1 << a | 1 << b)) =
          d(first, a) * d(first + 1, b) - d(first, b) * d(first + 1, a);
    }
  }
  for (int a = 0; a < 6; ++a) {
    for (int b = a + 1; b < 6; ++b) {
      for (int c = b + 1; c < 6; ++c) {
        const auto pair = [&](int i, int j) { return of_two.at(static_cast<std::size_t>(1 << i | 1 << j)); };
        result.at(static_cast<std::size_t>(1 << a | 1 << b | 1 << c)) =
            d(first + 2, a) * pair(b, c) - d(first + 2, b) * pair(a, c) + d(first + 2, c) * pair(a, b);
      }
    }
  }
  return result;
}

/// Laplace's expansion by the upper three rows.
template <class Form>
Form determinant(const Matrix6<Form>& d) {
  const std::array<Form, 64> upper = minors(d, 0), lower = minors(d, 1);
  Form sum(0.0);
  for (int a = 0; a < 6; ++a) {
    for (int b = a + 1; b < 6; ++b) {
      for (int c = b + 1; c < 6; ++c) {
        const auto columns = static_cast<std::size_t>(1 << a | 1 << b | 1 << c);
        const Form term = upper.at(columns) * lower.at(63 - columns);
        const bool is_even = (a + b + c) % 2 == 1;  // 0 + 1 + 2 = 3 is the identity
        sum = is_even ? sum + term : sum - term;
      }
    }
  }
  return sum;
}

template <std::size_t N>
class DeterminantSignOf final : public DeterminantSign {
 public:
  using Form = CellForm<N>;

  DeterminantSignOf(const Problem& problem, const MapSpace& space)
      : proof_(make_proof_model(problem)), pose_(pose_tape(problem)) {
    const bool is_bounded = run_upward([&] {
      for (std::size_t k = 0; k < N; ++k) {
        lower_[k] = evaluate_constant<Interval>(space.axes[k].lower);
        extent_[k] = evaluate_constant<Interval>(space.axes[k].upper) - lower_[k];
      }
    });
    if (!is_bounded) throw InputError("space: got a range whose ends are beyond the range of binary64, or not defined");
  }

  [[nodiscard]] bool is_nonzero(const Cell& cell) const override {
    bool result = false;
    const bool is_valid = run_upward([&] { result = keeps_sign(cell); });
    return is_valid && result;
  }

 private:
  [[nodiscard]] bool keeps_sign(const Cell& cell) const {
    Gradient<Interval, N> offset;
    std::array<Form, N> parameters;
    for (std::size_t k = 0; k < N; ++k) {
      offset[k] = Interval(-cell.radius(k), cell.radius(k));
      const Interval mid(cell.mid(k));
      Gradient<Interval, N> slope(0.0);
      slope[k] = extent_[k];
      parameters[k] = {lower_[k] + mid * extent_[k], slope, lower_[k] + (mid + offset[k]) * extent_[k]};
    }
    const Pose<Form> pose = evaluate_pose(pose_, std::span<const Form>(parameters));
    Vector3<Form> p_WP = pose.p_WP;
    Matrix3<Form> r_WP = rotation(proof_.model.angles, pose.angles);
    for (int i = 0; i < 3; ++i) {
      p_WP(i).tighten(offset);
      for (int j = 0; j < 3; ++j) r_WP(i, j).tighten(offset);
    }
    Matrix6<Form> d = cable_geometry(proof_.model, p_WP, r_WP).force_density;
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) d(i, j).tighten(offset);
    }
    Form value = determinant(d);
    value.tighten(offset);
    return certainly_positive(value.range) || certainly_positive(-value.range);
  }

  ProofModel<Interval> proof_;
  Evaluator<Form> pose_;
  std::array<Interval, N> lower_, extent_;  ///< λ_k = lower_k + t_k extent_k
};

}  // namespace

std::unique_ptr<DeterminantSign> make_determinant_sign(const Problem& problem, const MapSpace& space) {
  switch (space.size()) {
    case 2: return std::make_unique<DeterminantSignOf<2>>(problem, space);
    case 3: return std::make_unique<DeterminantSignOf<3>>(problem, space);
    default: throw std::logic_error("a map of neither two nor three axes");
  }
}

}  // namespace taut
