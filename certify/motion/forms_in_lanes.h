// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel of certify/lanes on Interval, SlopeForm and Model: what is the same equation for all six cables.
#pragma once

#include <memory>

#include "certify/arithmetic/gradient.h"
#include "certify/arithmetic/interval.h"
#include "certify/arithmetic/slope_form.h"
#include "certify/lanes/kernel.h"
#include "kinematics/model.h"
#include "kinematics/moving_load.h"

namespace taut {

/// Null where an anchor's coordinate is known so badly that its sign is not, which the kernel takes for granted.
[[nodiscard]] std::shared_ptr<const lanes::Machine> make_lanes_machine(const Model<Interval>& model);

namespace lanes_detail {

inline lanes::Ends ends(const Interval& x) { return {-x.lower(), x.upper()}; }
inline Interval interval(const lanes::IntervalRow& row, std::size_t i) {
  return {-row.minus_lower.x[i], row.upper.x[i]};
}
inline const Interval& slope(const Interval& slope, std::size_t) { return slope; }
inline Interval& slope(Interval& slope, std::size_t) { return slope; }
template <std::size_t N>
const Interval& slope(const Gradient<Interval, N>& slope, std::size_t k) {
  return slope[k];
}
template <std::size_t N>
Interval& slope(Gradient<Interval, N>& slope, std::size_t k) {
  return slope[k];
}

}  // namespace lanes_detail

template <int N, class Slope>
[[nodiscard]] lanes::Form<N> lanes_form(const SlopeForm<Interval, Slope>& x) {
  using namespace lanes_detail;
  lanes::Form<N> result;
  result.at_mid = ends(x.at_mid);
  for (int k = 0; k < N; ++k) result.slope[k] = ends(slope(x.slope, static_cast<std::size_t>(k)));
  result.range = ends(x.range);
  return result;
}

template <int N, class Slope>
[[nodiscard]] lanes::PoseForms<N> lanes_pose(const Vector3<SlopeForm<Interval, Slope>>& p_WP,
                                             const Matrix3<SlopeForm<Interval, Slope>>& r_WP) {
  lanes::PoseForms<N> result;
  for (int i = 0; i < 3; ++i) {
    result.p[i] = lanes_form<N>(p_WP(i));
    for (int j = 0; j < 3; ++j) result.r[i][j] = lanes_form<N>(r_WP(i, j));
  }
  return result;
}

/// Of cable i.
template <class Slope, int N>
void set_from_lanes(const lanes::FormRow<N>& row, std::size_t i, SlopeForm<Interval, Slope>& result) {
  using namespace lanes_detail;
  result.at_mid = interval(row.at_mid, i);
  for (int k = 0; k < N; ++k) slope(result.slope, static_cast<std::size_t>(k)) = interval(row.slope[k], i);
  result.range = interval(row.range, i);
}

[[nodiscard]] lanes::PlatformRates lanes_rates(const PathRates<Interval>& x);
[[nodiscard]] lanes::PlatformRates lanes_rates(const ThirdPathRates<Interval>& x);

}  // namespace taut
