// SPDX-License-Identifier: GPL-3.0-or-later
// Rotations from quaternions of any length but 0.
//
// R(q) = M(q) / |q|^2 with q = (x, y, z, w), w the scalar part, and M the matrix of quadratic forms below. R(q) is a
// rotation whatever the length of q, so binary64 quaternions are exact orientations. docs/theory.md, "Motions between
// poses".
#pragma once

#include "kinematics/model.h"

namespace taut {

template <class S>
struct Quaternion {
  S x, y, z, w;
};

template <class S>
[[nodiscard]] Quaternion<S> conjugate(const Quaternion<S>& q) {
  return {-q.x, -q.y, -q.z, q.w};
}

/// R(p q) = R(p) R(q).
template <class S>
[[nodiscard]] Quaternion<S> operator*(const Quaternion<S>& p, const Quaternion<S>& q) {
  return {p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y, p.w * q.y + p.y * q.w + p.z * q.x - p.x * q.z,
          p.w * q.z + p.z * q.w + p.x * q.y - p.y * q.x, p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z};
}

/// R(q). Divides by |q|^2.
template <class S>
[[nodiscard]] Matrix3<S> rotation(const Quaternion<S>& q) {
  const S xx = sqr(q.x), yy = sqr(q.y), zz = sqr(q.z), ww = sqr(q.w);
  const S xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z, wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  const S scale = S(1.0) / (xx + yy + zz + ww);
  const S twice = scale + scale;
  Matrix3<S> r;
  r(0, 0) = (ww + xx - yy - zz) * scale;
  r(0, 1) = (xy - wz) * twice;
  r(0, 2) = (xz + wy) * twice;
  r(1, 0) = (xy + wz) * twice;
  r(1, 1) = (ww - xx + yy - zz) * scale;
  r(1, 2) = (yz - wx) * twice;
  r(2, 0) = (xz - wy) * twice;
  r(2, 1) = (yz + wx) * twice;
  r(2, 2) = (ww - xx - yy + zz) * scale;
  return r;
}

}  // namespace taut
