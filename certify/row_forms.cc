// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/row_forms.h"

namespace taut {

RowForms row_forms(const InverseBound<Interval>& inverse, double radius) {
  // P C has the value C ± Q0|C| at m and slopes −(A1 ± W) C. With A1 in Â ± its half widths, slopes are −Â C but for
  // what is at most (W + half widths + rounding)|C|. Row k of |C| has the Euclidean norms f_k and m_k.
  std::array<Six, 6> c, slope;
  std::array<double, 6> force_size, moment_size;
  for (int j = 0; j < 6; ++j) {
    c[static_cast<std::size_t>(j)] = Six::generate([&](int i) { return inverse.c()(i, j); });
    slope[static_cast<std::size_t>(j)] = Six(0.0);
  }
  for (int k = 0; k < 6; ++k) {
    const auto row = static_cast<std::size_t>(k);
    const auto size = [&](int j) {
      return size_of(std::array<double, 3>{inverse.c()(k, j), inverse.c()(k, j + 1), inverse.c()(k, j + 2)});
    };
    force_size[row] = size(0);
    moment_size[row] = size(3);
  }
  const Square<double> slope_bound = inverse.slope_bound();
  RowForms rows;
  rows.radius = radius;
  VectorForm<Six>&force = rows.force, &moment = rows.moment;
  force.mid_error = moment.mid_error = force.slope_error = moment.slope_error = Six(kUnderflow);
  for (std::size_t k = 0; k < 6; ++k) {
    const auto entry = [&](const auto& of) { return Six::generate([&](std::size_t i) { return of(i); }); };
    const Six upper = entry([&](std::size_t i) { return inverse.a1()[i][k].upper(); });
    const Six minus_lower = entry([&](std::size_t i) { return -inverse.a1()[i][k].lower(); });
    const Six mid = Six(0.5) * upper - Six(0.5) * minus_lower;
    const Six w = entry([&](std::size_t i) { return slope_bound[i][k]; });
    const Six error = w + max(upper - mid, mid + minus_lower) + Six(kRounding) * abs(mid);
    const Six q0 = entry([&](std::size_t i) { return inverse.q0()[i][k]; });
    for (int j = 0; j < 6; ++j) {
      Six& s = slope[static_cast<std::size_t>(j)];
      s = s - mid * Six(inverse.c()(static_cast<int>(k), j));
    }
    force.mid_error += q0 * Six(force_size[k]);
    moment.mid_error += q0 * Six(moment_size[k]);
    force.slope_error += error * Six(force_size[k]);
    moment.slope_error += error * Six(moment_size[k]);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    force.mid[k] = c[k];
    moment.mid[k] = c[3 + k];
    force.slope[k] = slope[k];
    moment.slope[k] = slope[3 + k];
  }
  for (VectorForm<Six>* v : {&force, &moment}) {
    v->mid_size = size_of(v->mid) + Six(kUnderflow);
    v->slope_size = size_of(v->slope) + Six(kUnderflow);
  }
  return rows;
}

}  // namespace taut
