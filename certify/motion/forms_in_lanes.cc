// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/motion/forms_in_lanes.h"

namespace taut {
namespace {

using lanes_detail::ends;

constexpr std::size_t kLanes = lanes::kWidth;

/// Lanes beyond the last cable repeat the first one's numbers.
std::size_t cable(std::size_t lane) { return lane < kCables ? lane : 0; }

/// Nothing where some entry has members of both signs.
template <class F>
bool set_signed(const F& entry, lanes::SignedRow& row) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const Interval& x = entry(cable(lane));
    const bool is_negative = x.upper() <= 0 && x.lower() < 0;
    if (!is_negative && x.lower() < 0) return false;
    row.sign.x[lane] = is_negative ? -1.0 : 1.0;
    row.least.x[lane] = is_negative ? -x.upper() : x.lower();
    row.greatest.x[lane] = is_negative ? -x.lower() : x.upper();
  }
  return true;
}

}  // namespace

std::shared_ptr<const lanes::Machine> make_lanes_machine(const Model<Interval>& model) {
  lanes::Machine machine{};
  machine.is_arm_platform = true;
  for (int axis = 0; axis < 3; ++axis) {
    const auto platform = [&](std::size_t i) -> const Interval& { return model.p_PB[i](axis); };
    const auto arm = [&](std::size_t i) -> const Interval& { return model.p_MB[i](axis); };
    if (!set_signed(platform, machine.platform[axis]) || !set_signed(arm, machine.arm[axis])) return nullptr;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const lanes::Ends base = ends(model.p_WA[cable(lane)](axis));
      machine.base[axis].minus_lower.x[lane] = base.minus_lower;
      machine.base[axis].upper.x[lane] = base.upper;
      const Interval &b = platform(cable(lane)), &m = arm(cable(lane));
      if (b.lower() != m.lower() || b.upper() != m.upper()) machine.is_arm_platform = false;
    }
  }
  machine.has_ellipsoid = model.has_ellipsoid;
  machine.is_ellipsoid_diagonal = model.ellipsoid_is_diagonal;
  for (int i = 0; i < 6 && model.has_ellipsoid; ++i) {
    for (int j = i; j < 6; ++j) {  // upper triangular
      if (i == j || !model.ellipsoid_is_diagonal) machine.root[i][j] = ends(model.ellipsoid_root(i, j));
    }
  }
  return std::make_shared<lanes::Machine>(machine);
}

namespace {

void set(lanes::Ends (&to)[3], const Vector3<Interval>& from) {
  for (int k = 0; k < 3; ++k) to[k] = ends(from(k));
}

}  // namespace

lanes::PlatformRates lanes_rates(const PathRates<Interval>& x) {
  lanes::PlatformRates result;
  set(result.p, x.p);
  set(result.p1, x.p1);
  set(result.p2, x.p2);
  set(result.w, x.w);
  set(result.w1, x.w1);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result.r[i][j] = ends(x.r_WP(i, j));
  }
  return result;
}

lanes::PlatformRates lanes_rates(const ThirdPathRates<Interval>& x) {
  lanes::PlatformRates result = lanes_rates(static_cast<const PathRates<Interval>&>(x));
  set(result.p3, x.p3);
  set(result.w2, x.w2);
  return result;
}

}  // namespace taut
