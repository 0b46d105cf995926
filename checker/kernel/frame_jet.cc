// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/frame_jet.h"

#include <algorithm>

#include "checker/kernel/curve.h"
#include "checker/kernel/rotation.h"

namespace taut::checker {
namespace {

/// a + b pi by s over a box.
SecondJet jet(const Polynomial& a, const Polynomial& b, const Box& box) {
  const auto is_still = [](const Polynomial& p) {
    return std::all_of(p.begin() + 1, p.end(), [](const auto& c) { return c == 0; });
  };
  if (is_still(a) && is_still(b)) return SecondJet(form(a, b).range());
  const auto by_s = [&](const auto& map) { return form(over(map(a), box), over(map(b), box)).range(); };
  return {by_s([](const Polynomial& p) { return p; }), by_s([](const Polynomial& p) { return derivative(p); }),
          by_s([](const Polynomial& p) { return derivative(derivative(p)); })};
}

template <class Number>
SecondJet jet_of(std::span<const Waypoint> controls, const Number& number, const Box& box) {
  return jet(mixed(controls, number), {}, box);
}

Matrix3<Ball> map(const Matrix3<SecondJet>& R, Ball SecondJet::*what) {
  Matrix3<Ball> result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) result[i][j] = R[i][j].*what;
  }
  return result;
}

/// Of the skew part of M.
Vector3<Ball> axis_of(const Matrix3<Ball>& M) {
  return {half(M[2][1] - M[1][2]), half(M[0][2] - M[2][0]), half(M[1][0] - M[0][1])};
}

FrameJet with_axes(Vector3<SecondJet> p, Matrix3<SecondJet> R) {
  const Matrix3<Ball> back = transposed(map(R, &SecondJet::value));
  FrameJet result{std::move(p), std::move(R), {}, {}, std::nullopt};
  result.w = axis_of(multiply(map(result.R, &SecondJet::first), back));
  result.w1 = axis_of(multiply(map(result.R, &SecondJet::second), back));
  return result;
}

/// R' = [w] R and R'' = [w'] R + [w] R'.
Matrix3<SecondJet> turning(const Matrix3<Ball>& R, const Vector3<Ball>& w, const Vector3<Ball>& w1) {
  const Matrix3<Ball> columns = transposed(R);
  Matrix3<SecondJet> result;
  for (std::size_t j = 0; j < 3; ++j) {
    const Vector3<Ball> first = cross(w, columns[j]), second = cross(w1, columns[j]) + cross(w, first);
    for (std::size_t i = 0; i < 3; ++i) result[i][j] = {columns[j][i], first[i], second[i]};
  }
  return result;
}

FrameJet along_geodesic(std::span<const Waypoint> controls, const Box& box) {
  Vector3<SecondJet> p;
  for (std::size_t c = 0; c < 3; ++c)
    p[c] = jet_of(
        controls, [c](const Waypoint& x) { return x.x[c]; }, box);
  const Vector3<Ball> w = geodesic_turn(controls);
  return {p, turning(range(geodesic(controls, box).R), w, {}), w, {}, std::nullopt};
}

Vector6<Ball> ranges(const Vector6<MeanValueForm>& y) {
  Vector6<Ball> result;
  for (std::size_t i = 0; i < y.size(); ++i) result[i] = y[i].range();
  return result;
}

Vector6<Ball> minus(Vector6<Ball> x) {
  for (Ball& entry : x) entry = -entry;
  return x;
}

}  // namespace

CommandedMotion::CommandedMotion(const Machine& machine, const Problem& problem, const Path& path, std::size_t k,
                                 const Box& box)
    : machine_(machine), problem_(problem), path_(path), k_(k), box_(box) {
  if (!is_implied(problem, path)) return;
  if (!box.near) throw std::logic_error("a box without the place of its implied motion");
  const bool by_lengths = path.law == Law::kCableLengths;
  zero_ = only_zero(*equations(box), by_lengths ? Ball(1) : Ball(path.tubes.at(k)), *box.near);
}

std::unique_ptr<Equations> CommandedMotion::equations(const Box& box) const {
  if (path_.law == Law::kCableLengths) return motion_equations(length_controlled(machine_, path_, k_, box, box_));
  return motion_equations(machine_, problem_, path_, k_, box);
}

FrameJet CommandedMotion::over_box() const { return over(box_, zero_); }

FrameJet CommandedMotion::at(const mpq_class& s) const {
  if (s < box_.begin || s > box_.end) throw std::logic_error("a place outside its box");
  Box here = box_;
  here.begin = here.end = s;
  if (!is_implied(problem_, path_)) return over(here, {});
  // s = m + r u.
  const mpq_class m = (box_.begin + box_.end) / 2, r = (box_.end - box_.begin) / 2;
  const Ball u = r == 0 ? Ball() : Ball(mpq_class((s - m) / r));
  Vector6<MeanValueForm> known;
  for (std::size_t i = 0; i < known.size(); ++i) known[i] = MeanValueForm(zero_[i].at + u * zero_[i].slope);
  constexpr int kNarrowings = 4;
  return over(here, narrowed(*equations(here), known, kNarrowings));
}

FrameJet CommandedMotion::over(const Box& box, const Vector6<MeanValueForm>& zero) const {
  if (path_.law == Law::kGeodesic) return along_geodesic(path_.controls(k_), box);
  if (path_.law == Law::kCableLengths) return of_lengths(box, zero);
  const std::vector<SecondJet> at = parameters(box, zero);
  Vector6<SecondJet> pose;
  for (std::size_t c = 0; c < 6; ++c) pose[c] = problem_.pose[c].evaluate<SecondJet>(at);
  return with_axes({pose[0], pose[1], pose[2]}, orientation(problem_, pose));
}

std::vector<SecondJet> CommandedMotion::parameters(const Box& box, const Vector6<MeanValueForm>& zero) const {
  const std::span<const Waypoint> controls = path_.controls(k_);
  const std::size_t k = problem_.constraints.size();
  std::vector<SecondJet> line, normals;  // l, and N by rows
  for (std::size_t j = 0; j < controls[0].x.size(); ++j) {
    const auto [a, b] = coordinate(controls, j);
    line.push_back(jet(a, b, box));
    for (std::size_t i = j * k; i < (j + 1) * k; ++i) {
      normals.push_back(jet_of(
          controls, [i](const Waypoint& w) { return w.normals[i]; }, box));
    }
  }
  if (k == 0) return line;

  const Vector6<Ball> y = ranges(zero);
  const auto with_unknowns = [&](const Vector6<Ball>& y1, const Vector6<Ball>& y2) {
    std::vector<SecondJet> result = line;
    for (std::size_t j = 0; j < line.size(); ++j) {
      for (std::size_t i = 0; i < k; ++i) {
        result[j] = result[j] + normals[j * k + i] * SecondJet(y[i], y1[i], y2[i]);
      }
    }
    return result;
  };
  const auto along = [&](const Vector6<Ball>& y1, Ball SecondJet::*what) {
    const std::vector<SecondJet> at = with_unknowns(y1, {});
    Vector6<Ball> result;
    for (std::size_t e = 0; e < k; ++e) result[e] = problem_.constraints[e].evaluate<SecondJet>(at).*what;
    return result;
  };
  const Contraction by_y(*equations(box), y);
  const Vector6<Ball> y1 = minus(by_y.divide(along({}, &SecondJet::first)));
  const Vector6<Ball> y2 = minus(by_y.divide(along(y1, &SecondJet::second)));
  return with_unknowns(y1, y2);
}

FrameJet CommandedMotion::of_lengths(const Box& box, const Vector6<MeanValueForm>& zero) const {
  const Frame pose = pose_at(length_controlled(machine_, path_, k_, box, box_), zero);
  const Vector3<Ball> p = range(pose.p);
  const Matrix3<Ball> R = range(pose.R);
  Vector6<SecondJet> length;
  std::array<Vector3<Ball>, kCables> x, d;
  Matrix6<Ball> rows;
  Vector6<Ball> products;
  for (std::size_t i = 0; i < kCables; ++i) {
    length[i] = jet_of(
        path_.controls(k_), [i](const Waypoint& w) { return w.x[7 + i]; }, box);
    x[i] = multiply(R, machine_.platform[i]);
    const Vector3<Ball> from_base = p - machine_.base[i];
    d[i] = from_base + x[i];
    const Vector3<Ball> moment = cross(x[i], from_base);  // = x cross d
    for (std::size_t c = 0; c < 3; ++c) {
      rows[i][c] = d[i][c];
      rows[i][3 + c] = moment[c];
    }
    products[i] = length[i].value * length[i].first;
  }
  const Contraction by_rates(rows);
  const auto halves = [](const Vector6<Ball>& of) {
    return std::pair(Vector3<Ball>{of[0], of[1], of[2]}, Vector3<Ball>{of[3], of[4], of[5]});
  };
  const auto [p1, w] = halves(by_rates.divide(products));
  Vector6<Ball> rest;
  for (std::size_t i = 0; i < kCables; ++i) {
    const Vector3<Ball> turned = cross(w, x[i]);
    rest[i] = sqr(length[i].first) - squared_norm(p1 + turned) - dot(d[i], cross(w, turned));
  }
  const auto [p2, w1] = halves(by_rates.divide(rest));
  FrameJet result{{}, turning(R, w, w1), w, w1, length};
  for (std::size_t c = 0; c < 3; ++c) result.p[c] = {p[c], p1[c], p2[c]};
  return result;
}

}  // namespace taut::checker
