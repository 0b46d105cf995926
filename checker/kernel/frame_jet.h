// SPDX-License-Identifier: GPL-3.0-or-later
// How the commanded pose changes along a box: p(s) and R(s) with their first two derivatives by s.
//
// With R' = [w] R, R'' R^T = [w'] + [w]^2, whose second term is symmetric. By the law of the path:
//   parameters    by the problem's expressions, as SecondJets of s.
//   constraints   y(s) is the only zero of g(y, s) in its tube (motion.h), where g is as smooth as its expressions and
//                 its partial derivatives G by y are regular. So y is as smooth as g (implicit function theorem). In
//                     0 = d/ds g(y(s), s),    0 = d2/ds2 g(y(s), s),
//                 y' enters the first and y'' the second as G y' and G y''; all else is what SecondJets of s give where
//                 y' (or y'') is taken for 0.
//   geodesic      p is straight, and w constant: the turn from R0 to R1, in W.
//   lengths       |d_i|^2 = L_i^2 with d_i = p + R b_i - a_i and L_i'' = 0, so with x_i = R b_i and d_i' = p' + w x x_i
//                     d_i . (p' + w x x_i) = L_i L_i',
//                     d_i . (p'' + w' x x_i) = L_i'^2 - |d_i'|^2 - d_i . (w x (w x x_i)),
//                 six linear equations each, whose rows are (d_i ; x_i x d_i).
#pragma once

#include <memory>
#include <optional>

#include "checker/kernel/motion.h"
#include "checker/kernel/second_jet.h"

namespace taut::checker {

struct FrameJet {
  Vector3<SecondJet> p;
  Matrix3<SecondJet> R;
  Vector3<Ball> w, w1;                       ///< w and w' [rad], axes of W
  std::optional<Vector6<SecondJet>> length;  ///< L_i, where the path states them
};

/// The motion of segment k over a box that reaches across no inner pose.
class CommandedMotion {
 public:
  /// @throws Undefined where the motion is implied and was not shown to be the only one in its tube.
  CommandedMotion(const Machine& machine, const Problem& problem, const Path& path, std::size_t k, const Box& box);

  /// For every s of the box. @throws Undefined where it is not enclosed well enough.
  [[nodiscard]] FrameJet over_box() const;
  /// At a place of the box. @throws Undefined as over_box()
  [[nodiscard]] FrameJet at(const mpq_class& s) const;

 private:
  /// Over `box`, a part of the box, on which the unknowns are within `zero`.
  [[nodiscard]] FrameJet over(const Box& box, const Vector6<MeanValueForm>& zero) const;
  [[nodiscard]] std::unique_ptr<Equations> equations(const Box& box) const;
  [[nodiscard]] std::vector<SecondJet> parameters(const Box& box, const Vector6<MeanValueForm>& zero) const;
  [[nodiscard]] FrameJet of_lengths(const Box& box, const Vector6<MeanValueForm>& zero) const;

  const Machine& machine_;
  const Problem& problem_;
  const Path& path_;
  std::size_t k_;
  const Box& box_;
  Vector6<MeanValueForm> zero_;  ///< of an implied motion, over the box
};

}  // namespace taut::checker
