// SPDX-License-Identifier: GPL-3.0-or-later
#include "formal/search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <utility>

#include "base/input_error.h"
#include "formal/held_poses.h"
#include "formal/load.h"
#include "formal/slope.h"
#include "problem/expression.h"
#include "problem/rational.h"

namespace taut::formal {
namespace {

constexpr int kMostDepth = 20;
constexpr int kFigures = 20;
/// What is kept of each limit beyond what Coq asks for, as a share of its range: Coq may compute with 30 bits.
constexpr double kSpare = 1e-5;
constexpr double kLargestNorm = 0.999;

using Matrix = std::array<std::array<double, 6>, 6>;

/// What is the same for all boxes; made under run_upward().
struct Machine {
  std::array<Vector, 6> base, platform, lever;
  std::array<Interval, kBalls> radii;
  Load load;
  std::array<std::array<Interval, 2>, 6> tension, length;
};

/// The expressions that require_in_scope() allows, on slopes.
std::vector<Slope> evaluate(const ExpressionTape& tape, const std::vector<Slope>& parameters) {
  std::vector<Slope> slots;
  for (const Instruction& step : tape.instructions()) {
    const auto a = [&]() -> const Slope& { return slots.at(static_cast<std::size_t>(step.a)); };
    const auto b = [&]() -> const Slope& { return slots.at(static_cast<std::size_t>(step.b)); };
    const auto index = static_cast<std::size_t>(step.a);
    switch (step.op) {
      case Op::kConstant: {
        const DecimalText& text = tape.constants().at(index);
        slots.emplace_back(text == "pi" ? ScalarTraits<Interval>::pi() : exact(text));
        break;
      }
      case Op::kParameter: slots.push_back(Slope(parameters.at(index))); break;
      case Op::kAdd: slots.push_back(a() + b()); break;
      case Op::kSubtract: slots.push_back(a() - b()); break;
      case Op::kMultiply: slots.push_back(a() * b()); break;
      case Op::kDivide: slots.push_back(a() / b()); break;
      case Op::kNegate: slots.push_back(-a()); break;
      case Op::kPower: {
        Slope product = a();
        for (int i = 1; i < step.b; ++i) product = product * a();
        slots.push_back(product);
        break;
      }
      case Op::kSqrt: slots.push_back(sqrt(a())); break;
      case Op::kSin: {
        const SinCos<Slope> both = sincos(a());
        slots.push_back(both.sin);
        slots.push_back(both.cos);
        break;
      }
      case Op::kCos: break;  // pushed by the kSin before it
      default: throw std::logic_error("an expression outside of the scope");
    }
  }
  std::vector<Slope> values;
  for (const int output : tape.outputs()) values.push_back(slots.at(static_cast<std::size_t>(output)));
  return values;
}

Interval constant(const ExpressionText& text) { return evaluate(ExpressionTape({text}, {}, {}), {}).front().mid; }

Machine machine(const Problem& problem) {
  Machine m;
  const TolerancesText tolerances = problem.tolerances.value_or(TolerancesText{});
  m.radii[kPosition] = exact(tolerances.position_m);
  m.radii[kTurn] = constant(tolerances.orientation_rad);
  m.radii[kLoadPoint] = exact(tolerances.load_point_m);
  const Vector load_point = within(kLoadPoint, m.radii[kLoadPoint], exact(problem.load.point_m));
  for (std::size_t i = 0; i < 6; ++i) {
    Interval& at_base = m.radii[base_ball(i)] = exact(tolerances.base_anchor_m[i]);
    Interval& at_platform = m.radii[platform_ball(i)] = exact(tolerances.platform_anchor_m[i]);
    m.base[i] = within(base_ball(i), at_base, exact(problem.robot.base_anchors_m[i]));
    m.platform[i] = within(platform_ball(i), at_platform, exact(problem.robot.platform_anchors_m[i]));
    m.lever[i] = m.platform[i] - load_point;
    m.tension[i] = {exact(problem.robot.tension_N[i].lower), exact(problem.robot.tension_N[i].upper)};
    m.length[i] = {exact(problem.robot.length_m[i].lower), exact(problem.robot.length_m[i].upper)};
  }
  m.load = Load(problem.load, tolerances);
  return m;
}

/// v turned about the axis `axis` of the world.
Vector turned_about(const SinCos<Slope>& angle, std::size_t axis, const Vector& v) {
  const std::size_t y = (axis + 1) % 3;
  const std::size_t z = (axis + 2) % 3;
  Vector result = v;
  result[y] = angle.cos * v[y] - angle.sin * v[z];
  result[z] = angle.sin * v[y] + angle.cos * v[z];
  return result;
}

using Columns = std::array<Vector, 3>;

/// The images of the unit vectors.
template <class Turn>
Columns images(const Turn& turn) {
  Columns columns;
  for (std::size_t i = 0; i < 3; ++i) {
    columns[i][i] = Slope(Interval(1.0));
    columns[i] = turn(columns[i]);
  }
  return columns;
}

Columns rotation(const AnglesText& stated, const std::vector<Slope>& pose) {
  const AngleKind kind = stated.kind;
  if (kind == AngleKind::kAxis) {
    const Vector axis = unit_along({exact(stated.axis[0]), exact(stated.axis[1]), exact(stated.axis[2])});
    const SinCos<Slope> angle = sincos(pose[3]);
    return images([&](const Vector& v) { return turned_about(axis, angle, v); });
  }
  std::array<Slope, 3> angles{pose[3], pose[4], pose[5]};
  std::array<std::size_t, 3> axes{2, 1, 2};
  if (kind == AngleKind::kTiltAndTorsion) angles[2] = pose[5] - pose[3];
  if (kind == AngleKind::kRollPitchYaw) {
    std::swap(angles[0], angles[2]);
    axes[2] = 0;
  }
  return images([&](Vector v) {
    for (std::size_t k = 3; k-- > 0;) v = turned_about(sincos(angles[k]), axes[k], v);
    return v;
  });
}

/// So that quaternions of any length can be brought near to 1.
int largest_exponent(std::span<const double> q) {
  double largest = 0;
  for (const double x : q) largest = std::max(largest, std::abs(x));
  return largest > 0 ? std::ilogb(largest) : 0;
}

/// Turned by the quaternion with vector part u and scalar part w, of any length.
class QuaternionTurn {
 public:
  QuaternionTurn(const Vector& u, const Slope& w) : u_(u) {
    const Slope square = dot(u, u);
    inverse_ = Slope(Interval(1.0)) / (square + w * w);
    straight_ = w * w - square;
    twice_ = Slope(Interval(2.0)) * w;
  }
  [[nodiscard]] Vector operator()(const Vector& v) const {
    const Slope along = Slope(Interval(2.0)) * dot(u_, v);
    const Vector across = cross(u_, v);
    Vector result;
    for (std::size_t i = 0; i < 3; ++i) {
      result[i] = inverse_ * (straight_ * v[i] + along * u_[i] + twice_ * across[i]);
    }
    return result;
  }

 private:
  Vector u_;
  Slope inverse_, straight_, twice_;
};

Slope on_line(Interval begin, Interval end, const Slope& s) { return Slope(begin) + s * Slope(end - begin); }

/// From one pose to another: R_0, and then a turn about an axis. In exact numbers, so that how small a turn is does not
/// matter.
class Geodesic {
 public:
  /// Under run_upward().
  explicit Geodesic(const Segment& segment) {
    std::array<std::array<Rational, 4>, 2> q;
    for (std::size_t end = 0; end < 2; ++end) {
      const PoseNumbers& x = segment.control[end]->pose();
      const int exponent = largest_exponent(std::span(x).subspan(3, 4));
      for (std::size_t i = 0; i < 4; ++i) q[end][i] = Rational(std::ldexp(x[3 + i], -exponent));
      for (std::size_t i = 0; i < 3; ++i) position_[end][i] = Interval(x[i]);
    }
    const auto& [p, r] = q;
    std::array<Interval, 3> vector;
    Vector u;
    for (std::size_t x = 0; x < 3; ++x) {
      const std::size_t y = (x + 1) % 3, z = (x + 2) % 3;
      const Rational part = p[3] * r[x] - r[3] * p[x] - (p[y] * r[z] - p[z] * r[y]);
      turns_ = turns_ || part != 0;
      vector[x] = nearly(part);
      u[x] = Slope(nearly(p[x]));
    }
    first_.emplace(u, Slope(nearly(p[3])));
    if (!turns_) return;
    axis_ = unit_along(vector);
    angle_ = Interval(2.0) * atan(norm(vector) / nearly(p[3] * r[3] + p[0] * r[0] + p[1] * r[1] + p[2] * r[2]));
  }

  [[nodiscard]] Vector position(const Slope& s) const {
    Vector result;
    for (std::size_t i = 0; i < 3; ++i) result[i] = on_line(position_[0][i], position_[1][i], s);
    return result;
  }
  [[nodiscard]] Columns columns(const Slope& s) const {
    const SinCos<Slope> angle = sincos(s * Slope(angle_));
    return images([&](const Vector& v) { return (*first_)(turns_ ? turned_about(axis_, angle, v) : v); });
  }

 private:
  std::array<std::array<Interval, 3>, 2> position_;
  std::optional<QuaternionTurn> first_;  ///< R_0
  Vector axis_;
  Interval angle_{0.0};
  bool turns_ = false;
};

/// Straight from pose to pose, and in lengths.
struct Chord {
  const HeldPose &begin, &end;

  [[nodiscard]] Slope coordinate(std::size_t j, const Slope& s) const {
    const int exponent = j < 3 ? 0
                               : std::max(largest_exponent(std::span(begin.pose).last(4)),
                                          largest_exponent(std::span(end.pose).last(4)));
    return on_line(Interval(std::ldexp(begin.pose[j], -exponent)), Interval(std::ldexp(end.pose[j], -exponent)), s);
  }
  [[nodiscard]] Vector position(const Slope& s) const { return {coordinate(0, s), coordinate(1, s), coordinate(2, s)}; }
  [[nodiscard]] Columns columns(const Slope& s) const {
    return images(QuaternionTurn({coordinate(3, s), coordinate(4, s), coordinate(5, s)}, coordinate(6, s)));
  }
  [[nodiscard]] Slope length(std::size_t i, const Slope& s) const {
    return on_line(nearly(begin.lengths[i]), nearly(end.lengths[i]), s);
  }
};

/// Half of |d|^2 - L^2.
Slope excess(const Vector& d, const Slope& length) { return Slope(Interval(0.5)) * (dot(d, d) - length * length); }

/// Anywhere on the box.
Slope whole(const Slope& f) { return Slope(f.over); }
Vector whole(const Vector& v) { return {whole(v[0]), whole(v[1]), whole(v[2])}; }

/// Any vector of coordinates from -1 to 1 times a size.
Vector any_vector(std::size_t ball, double size) {
  Vector v;
  for (std::size_t i = 0; i < 3; ++i) {
    Slopes::Block unit = kZeros;
    unit[i] = Interval(1.0);
    v[i] = Slope(Interval(size)) * Slope(Interval(-1.0, 1.0), Interval(-1.0, 1.0), Interval(0.0), Slopes(ball, unit));
  }
  return v;
}

bool invert(Matrix a, Matrix& inverse) {
  inverse = {};
  for (std::size_t i = 0; i < 6; ++i) inverse[i][i] = 1;
  for (std::size_t k = 0; k < 6; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < 6; ++i) pivot = std::abs(a[i][k]) > std::abs(a[pivot][k]) ? i : pivot;
    if (!(std::abs(a[pivot][k]) > 0)) return false;
    std::swap(a[k], a[pivot]);
    std::swap(inverse[k], inverse[pivot]);
    const double factor = 1 / a[k][k];
    for (std::size_t j = 0; j < 6; ++j) {
      a[k][j] *= factor;
      inverse[k][j] *= factor;
    }
    for (std::size_t i = 0; i < 6; ++i) {
      const double share = a[i][k];
      if (i == k) continue;
      for (std::size_t j = 0; j < 6; ++j) {
        a[i][j] -= share * a[k][j];
        inverse[i][j] -= share * inverse[k][j];
      }
    }
  }
  return true;
}

/// An inverse of the matrix, in whole numbers of about twenty bits of its smallest row. @return their scale; none if
/// there is no inverse
std::optional<int> whole_inverse(const Matrix& matrix, std::array<std::array<long, 6>, 6>& numbers) {
  Matrix inverse{};
  if (!invert(matrix, inverse)) return std::nullopt;
  double smallest = HUGE_VAL;
  for (const auto& row : inverse) {
    double largest = 0;
    for (const double x : row) largest = std::max(largest, std::abs(x));
    smallest = std::min(smallest, largest);
  }
  if (!(smallest > 0 && smallest < HUGE_VAL)) return std::nullopt;
  const int scale = std::clamp(kFigures - std::ilogb(smallest), 1, 60);
  const double unit = std::ldexp(1.0, scale);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      if (!(std::abs(inverse[i][j]) * unit < 1e18)) return std::nullopt;
      numbers[i][j] = std::lrint(inverse[i][j] * unit);
    }
  }
  return scale;
}

const Segment kNoSegment;

/// One segment's search.
class Judge {
 public:
  Judge(const Problem& problem, const Machine& machine, const ExpressionTape& tape, const Segment& segment)
      : problem_(problem), tape_(tape), segment_(segment), machine_(machine) {
    if (segment.law == Interpolation::kGeodesic) geodesic_.emplace(segment);
  }
  /// Where lengths are held.
  Judge(const Problem& problem, const Machine& machine, const ExpressionTape& tape, const HeldPose& begin,
        const HeldPose& end)
      : problem_(problem), tape_(tape), segment_(kNoSegment), machine_(machine), chord_(Chord{begin, end}) {}

  /// Sets the numbers of a box; whether Coq will accept it. Under run_upward().
  bool judge(Box& box) {
    const double width = std::ldexp(1.0, -box.depth);
    const double begin = static_cast<double>(box.index) * width;
    reach_ = {Interval(-width / 2, width / 2), machine_.radii};
    const Slope at(Interval(begin + width / 2), Interval(begin, begin + width), Interval(1.0));
    if (chord_ && !holds_lengths(at, box.tube.emplace())) return false;
    place(at);
    return choose(box) && contracts(box) && is_inside(box);
  }

 private:
  /// The machine along the chord, and the lengths that it holds.
  struct Held {
    Vector position;
    std::array<Vector, 6> arms;
    std::array<Slope, 6> lengths;
  };
  using Intervals = std::array<std::array<Interval, 6>, 6>;

  [[nodiscard]] Held along_chord(const Slope& at) const {
    Held held{chord_->position(at), {}, {}};
    const Columns columns = chord_->columns(at);
    for (std::size_t i = 0; i < 6; ++i) {
      held.arms[i] = tight(image(columns, machine_.platform[i]), reach_);
      held.lengths[i] = chord_->length(i, at);
    }
    return held;
  }

  /// Of half of |d|^2 - L^2 by the tube's coordinates, anywhere in it.
  [[nodiscard]] Intervals derivative(const Held& held) const {
    const PoseTube& tube = chord_->begin.tube;
    const QuaternionTurn turn(any_vector(kTurn, tube.turn), Slope(Interval(1.0)));
    const Vector position = whole(held.position) + any_vector(kPosition, tube.position);
    Intervals result;
    for (std::size_t i = 0; i < 6; ++i) {
      const Slope changed = excess(position + turn(whole(held.arms[i])) - machine_.base[i], whole(held.lengths[i]));
      for (std::size_t j = 0; j < 6; ++j) {
        const auto& block = changed.slopes[j < 3 ? kPosition : kTurn];
        result[i][j] = block ? (*block)[j % 3] : Interval(0.0);
      }
    }
    return result;
  }

  static Interval entry(const TubeBox& tube, std::size_t k, std::size_t i) {
    return Interval(std::ldexp(static_cast<double>(tube.inverse[k][i]), -tube.scale));
  }

  /// Of I - C A.
  static double norm_left(const TubeBox& tube, const Intervals& derivative) {
    double norm = 0;
    for (std::size_t k = 0; k < 6; ++k) {
      double sum = 0;
      for (std::size_t j = 0; j < 6; ++j) {
        Interval left(k == j ? 1.0 : 0.0);
        for (std::size_t i = 0; i < 6; ++i) left -= entry(tube, k, i) * derivative[i][j];
        sum += magnitude(left);
      }
      norm = std::max(norm, sum);
    }
    return norm;
  }

  /// Three coordinates of the guess from this one on, times a size.
  static Vector guessed(const TubeBox& tube, std::size_t first, double size) {
    Vector u;
    for (std::size_t i = 0; i < 3; ++i) u[i] = Slope(Interval(size) * share(tube.guess[first + i]));
    return u;
  }

  /// C times half of |d|^2 - L^2 at the guess: a step of Newton's method.
  [[nodiscard]] std::array<Slope, 6> step(const Held& held, const TubeBox& tube) const {
    const PoseTube& size = chord_->begin.tube;
    const QuaternionTurn turn(guessed(tube, 3, size.turn), Slope(Interval(1.0)));
    const Vector position = held.position + guessed(tube, 0, size.position);
    std::array<Slope, 6> result;
    for (std::size_t i = 0; i < 6; ++i) {
      const Slope off = excess(tight(position + turn(held.arms[i]) - machine_.base[i], reach_), held.lengths[i]);
      for (std::size_t k = 0; k < 6; ++k) result[k] = result[k] + Slope(entry(tube, k, i)) * off;
    }
    return result;
  }

  /// Sets the guess. @return whether it is in the tube
  bool guess(const Held& held, TubeBox& tube) const {
    constexpr int kSteps = 3;
    for (int round = 0; round < kSteps; ++round) {
      const std::array<Slope, 6> moved = step(held, tube);
      for (std::size_t k = 0; k < 6; ++k) {
        const double by = std::ldexp(midpoint_approx(moved[k].mid), kTubeBits);
        if (!(std::abs(by) < kOne)) return false;
        tube.guess[k] = std::clamp(tube.guess[k] - std::lrint(by), -kOne, kOne);
      }
    }
    return true;
  }

  /// Sets the numbers by which there is one pose with these lengths in the tube, and how far it may be from the guess.
  bool holds_lengths(const Slope& at, TubeBox& tube) {
    const PoseTube& size = chord_->begin.tube;
    const Held held = along_chord(at);
    const Intervals slopes = derivative(held);
    Matrix middle{};
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) middle[i][j] = midpoint_approx(slopes[i][j]);
    }
    const std::optional<int> scale = whole_inverse(middle, tube.inverse);
    if (!scale) return false;
    tube.scale = *scale;
    if (!guess(held, tube)) return false;
    double farthest = 0;
    for (const Slope& moved : step(held, tube)) farthest = std::max(farthest, magnitude(tight(moved, reach_).over));
    // Coq may compute with few bits: a little more costs little.
    constexpr double kLittle = 1e-3, kAmple = 1.25;
    const double left = norm_left(tube, slopes) + kLittle;
    const double within = farthest / (1 - left) * kAmple + kLittle;
    if (!(left < 1 && within < 1)) return false;
    tube.left = std::lrint(std::ceil(std::ldexp(left, kTubeBits)));
    tube.within = std::lrint(std::ceil(std::ldexp(within, kTubeBits)));
    const auto is_inside = [&](long n) { return std::abs(n) + tube.within <= kOne; };
    constexpr double kMostTurn = 0.125;
    if (tube.left >= kOne || !std::ranges::all_of(tube.guess, is_inside) || size.turn > kMostTurn) return false;
    reach_.radii[kPosition] = share(tube.within) * Interval(size.position) * Interval(1.75);
    reach_.radii[kTurn] = share(tube.within) * Interval(size.turn) * Interval(5.25);
    // Poses are enclosed around the guess.
    turn_.emplace(guessed(tube, 3, size.turn), Slope(Interval(1.0)));
    shift_ = guessed(tube, 0, size.position);
    return true;
  }
  static constexpr long kOne = 1L << kTubeBits;
  static Interval share(long n) { return Interval(std::ldexp(static_cast<double>(n), -kTubeBits)); }

  void place(const Slope& at) {
    Vector position;
    if (chord_) {
      position = chord_->position(at) + shift_;
      columns_ = chord_->columns(at);
      for (Vector& column : columns_) column = (*turn_)(column);
    } else if (geodesic_) {
      position = geodesic_->position(at);
      columns_ = geodesic_->columns(at);
    } else {
      const std::vector<Slope> pose = evaluate(tape_, parameters(at));
      position = {pose[0], pose[1], pose[2]};
      columns_ = rotation(problem_.space.angles, pose);
    }
    for (Vector& column : columns_) column = turned(reach_.radii[kTurn], column);
    position = within(kPosition, reach_.radii[kPosition], position);
    for (std::size_t i = 0; i < 6; ++i) {
      const Vector d = tight(position + image(columns_, machine_.platform[i]) - machine_.base[i], reach_);
      const Vector moment = cross(tight(image(columns_, machine_.lever[i]), reach_), d);
      length_[i] = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
      for (std::size_t k = 0; k < 3; ++k) {
        d_[k][i] = d[k];
        d_[k + 3][i] = moment[k];
      }
    }
  }

  [[nodiscard]] std::vector<Slope> parameters(const Slope& at) const {
    std::vector<Slope> result;
    for (std::size_t j = 0; j < problem_.space.parameters.size(); ++j) {
      const Polynomial<Interval> x = coordinate_polynomial<Interval>(segment_, j);
      Slope value = Slope(x.c[0]) + at * Slope(x.c[1]);
      if (x.cubic) value = Slope(x.c[0]) + at * (Slope(x.c[1]) + at * (Slope(x.c[2]) + at * Slope(x.c[3])));
      result.push_back(value);
    }
    return result;
  }

  /// C and x0.
  bool choose(Box& box) {
    Matrix middle{};
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) middle[i][j] = midpoint_approx(d_[i][j].mid);
    }
    const std::optional<int> scale = whole_inverse(middle, box.inverse);
    if (!scale) return false;
    box.scale = *scale;
    const double unit = std::ldexp(1.0, box.scale);
    unit_ = std::ldexp(1.0, -box.scale);
    for (std::size_t i = 0; i < 6; ++i) {
      parts_[i] = machine_.load.part(row(box, i), columns_, reach_);
      const double density = midpoint_approx(parts_[i].form.mid);
      if (!(std::abs(density) * unit < 1e18)) return false;
      box.densities[i] = std::lrint(density * unit);
    }
    return true;
  }

  [[nodiscard]] std::array<Interval, 6> row(const Box& box, std::size_t i) const {
    std::array<Interval, 6> result;
    for (std::size_t k = 0; k < 6; ++k) result[k] = scaled(box.inverse[i][k]);
    return result;
  }
  [[nodiscard]] Interval scaled(long n) const { return unit_ * Interval(static_cast<double>(n)); }

  /// Sets E = I - C D and its norm.
  bool contracts(const Box& box) {
    norm_ = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < 6; ++j) {
        Slope product;
        for (std::size_t k = 0; k < 6; ++k) product = product + Slope(scaled(box.inverse[i][k])) * d_[k][j];
        e_[i][j] = tight(Slope(Interval(i == j ? 1.0 : 0.0)) - product, reach_).over;
        sum += magnitude(e_[i][j]);
      }
      norm_ = std::max(norm_, sum);
    }
    return norm_ < kLargestNorm;
  }

  /// What C maps the load to, without C D x0.
  [[nodiscard]] Interval residual(const Box& box, std::size_t i) const {
    Slope balanced;
    for (std::size_t k = 0; k < 6; ++k) {
      Slope row;
      for (std::size_t j = 0; j < 6; ++j) row = row + d_[k][j] * Slope(scaled(box.densities[j]));
      balanced = balanced + Slope(scaled(box.inverse[i][k])) * row;
    }
    return tight(parts_[i].form - balanced, reach_).over + parts_[i].others;
  }

  [[nodiscard]] bool is_inside(const Box& box) const {
    std::array<Interval, 6> w;
    double largest = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      w[i] = residual(box, i);
      largest = std::max(largest, magnitude(w[i]));
    }
    const double bound = largest / (1 - norm_);
    std::array<Interval, 6> y;
    y.fill(Interval(-bound, bound));
    for (int round = 0; round < 2; ++round) {
      const std::array<Interval, 6> before = y;
      for (std::size_t i = 0; i < 6; ++i) {
        y[i] = w[i];
        for (std::size_t j = 0; j < 6; ++j) y[i] += e_[i][j] * before[j];
      }
    }
    for (std::size_t i = 0; i < 6; ++i) {
      const Interval length = tight(length_[i], reach_).over;
      if (!keeps(machine_.length[i], length)) return false;
      if (!keeps(machine_.tension[i], length * (scaled(box.densities[i]) + y[i]))) return false;
    }
    return true;
  }

  [[nodiscard]] static bool keeps(const std::array<Interval, 2>& limits, Interval value) {
    const double spare = kSpare * (limits[1].upper() - limits[0].lower());
    return limits[0].upper() + spare < value.lower() && value.upper() + spare < limits[1].lower();
  }

  const Problem& problem_;
  const ExpressionTape& tape_;
  const Segment& segment_;
  const Machine& machine_;
  std::optional<Geodesic> geodesic_;
  std::optional<Chord> chord_;
  Vector shift_;                        ///< of the guess from the chord
  std::optional<QuaternionTurn> turn_;  ///< likewise
  Reach reach_;
  Columns columns_;            ///< of the rotation
  std::array<Part, 6> parts_;  ///< what the load makes of each row of C
  std::array<std::array<Slope, 6>, 6> d_;
  std::array<std::array<Interval, 6>, 6> e_;
  std::array<Slope, 6> length_;
  double norm_ = 0;
  double unit_ = 1;
};

}  // namespace

int bits(const Problem& problem, const Path& path) {
  double largest = 0, shortest = HUGE_VAL;
  for (std::size_t i = 0; i < 6; ++i) {
    for (const DecimalText& x : problem.robot.base_anchors_m[i]) {
      largest = std::max(largest, std::abs(midpoint_approx(exact(x))));
    }
    shortest = std::min(shortest, midpoint_approx(exact(problem.robot.length_m[i].lower)));
  }
  constexpr int kUsual = 30, kSpareBits = 4, kMost = 200;
  const double ratio = largest / std::max(shortest, 1e-3);
  const int found = ratio > 1 ? kUsual + std::ilogb(ratio) - kSpareBits : kUsual;
  double tube = HUGE_VAL, longest = 0;
  if (path.interpolation == Interpolation::kCableLengths) {
    const std::vector<HeldPose> poses = held_poses(path);
    for (const HeldPose& pose : std::span(poses).first(poses.size() - 1)) {
      tube = std::min({tube, pose.tube.position, pose.tube.turn});
      for (const Rational& length : pose.lengths) longest = std::max(longest, length.convert_to<double>());
    }
  }
  constexpr int kBitsOfTube = 24;
  const int for_tube = tube < HUGE_VAL ? std::ilogb(longest / tube) + kBitsOfTube : kUsual;
  return std::clamp(std::max(found, for_tube), kUsual, kMost);
}

std::optional<std::vector<std::vector<Box>>> find_boxes(const Certificate& certificate, const SearchProgress& progress,
                                                        const std::stop_token& stop) {
  const Problem& problem = certificate.problem;
  std::vector<std::string> names;
  for (const Parameter& parameter : problem.space.parameters) names.push_back(parameter.name);
  const ExpressionTape tape({problem.space.pose.begin(), problem.space.pose.end()}, names, problem.space.constants);
  Machine made;
  const bool is_turn_enclosed = run_upward([&] {
    made = machine(problem);
    Faults<Interval>::clear();
    if (problem.tolerances) (void)constant(problem.tolerances->orientation_rad);
  });
  if (!is_turn_enclosed) {
    throw InputError(
        fmt::format("tolerances.orientation: got '{}', expected an expression without roots of 0 and "
                    "divisions by 0, which Coq does not enclose",
                    problem.tolerances->orientation_rad));
  }
  std::vector<std::vector<Box>> all;
  std::size_t count = 0;
  const bool is_held = certificate.path.interpolation == Interpolation::kCableLengths;
  const std::vector<HeldPose> poses = is_held ? held_poses(certificate.path) : std::vector<HeldPose>{};
  const std::size_t motions = is_held ? poses.size() - 1 : certificate.path.segments();
  for (std::size_t k = 0; k < motions; ++k) {
    const Segment segment = is_held ? kNoSegment : certificate.path.segment(k);
    std::optional<Judge> judge;
    std::vector<Box> open{Box{}};
    all.emplace_back();
    while (!open.empty()) {
      if (stop.stop_requested()) return std::nullopt;
      progress(k, motions, count);
      Box box = open.back();
      open.pop_back();
      bool accepted = false;
      const bool is_valid = run_upward([&] {
        if (!judge && is_held) judge.emplace(problem, made, tape, poses[k], poses[k + 1]);
        if (!judge) judge.emplace(problem, made, tape, segment);
        Faults<Interval>::clear();
        accepted = judge->judge(box);
      });
      if (is_valid && accepted) {
        all.back().push_back(box);
        ++count;
        continue;
      }
      if (box.depth == kMostDepth) {
        double place = std::ldexp(static_cast<double>(box.index), -box.depth);
        if (is_held) {
          const double end = poses[k + 1].segment == poses[k].segment ? poses[k + 1].s : 1;
          place = poses[k].s + place * (end - poses[k].s);
        }
        throw InputError(
            fmt::format("segment {}: got a place near s = {:.6f} where even a box of 2^-{} is too large "
                        "for Coq's arithmetic, expected more room{}",
                        (is_held ? poses[k].segment : k) + 1, place, kMostDepth,
                        problem.tolerances || is_held ? " (here Coq needs more of it than taut: docs/formal.md)" : ""));
      }
      open.push_back(Box{box.depth + 1, 2 * box.index + 1});
      open.push_back(Box{box.depth + 1, 2 * box.index});
    }
  }
  return all;
}

}  // namespace taut::formal
