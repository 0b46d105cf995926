#include "checker/held.h"

#include <algorithm>
#include <cmath>

#include "checker/krawczyk.h"

namespace taut::checker {
namespace {

template <class Get>
Vector3<Interval> parts(const Vector3<Form>& x, const Get& get) {
  return {get(x[0]), get(x[1]), get(x[2])};
}

template <class Get>
Matrix3<Interval> parts(const Matrix3<Form>& x, const Get& get) {
  return {parts(x[0], get), parts(x[1], get), parts(x[2], get)};
}

constexpr auto kMid = [](const Form& x) { return x.mid; };
constexpr auto kSlope = [](const Form& x) { return x.slope; };
constexpr auto kRange = [](const Form& x) { return x.range; };

/// R(v, 1).
Matrix3<Form> turn_by(const Vector3<Form>& v) { return rotation({v[0], v[1], v[2], Form(Interval(1))}); }
/// Likewise: I + 2 / (1 + |v|^2) ([v] + [v]^2), [v]^2 = v v' - |v|^2 I.
Matrix3<Interval> turn_by(const Vector3<Interval>& v) {
  const Interval scale = Interval(2) / (Interval(1) + squared_norm(v));
  Matrix3<Interval> R = {{{-sqr(v[1]) - sqr(v[2]), v[0] * v[1] - v[2], v[0] * v[2] + v[1]},
                          {v[0] * v[1] + v[2], -sqr(v[0]) - sqr(v[2]), v[1] * v[2] - v[0]},
                          {v[0] * v[2] - v[1], v[1] * v[2] + v[0], -sqr(v[0]) - sqr(v[1])}}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) R[i][j] = Interval(i == j ? 1 : 0) + scale * R[i][j];
  }
  return R;
}

/// g of the header.
class HeldByLengths : public Equations {
 public:
  HeldByLengths(const Model& model, const Reference& reference, const Vector6<Form>& L)
      : model_(model),
        reference_(reference),
        L_(L),
        position_(mpq_class(reference.tube.position)),
        turn_(mpq_class(reference.tube.turn)) {}

  [[nodiscard]] std::size_t unknowns() const override { return 6; }

  [[nodiscard]] Derivatives derivatives(const Vector6<Interval>& z) const override {
    const Vector3<Interval> v = turn(z);
    const Matrix3<Interval> R_v = turn_by(v);
    const Vector3<Interval> p = parts(reference_.pose.p, kRange) + position(z);
    const Matrix3<Interval> R = multiply(R_v, parts(reference_.pose.R, kRange));
    const Vector3<Interval> p_mid = parts(reference_.pose.p, kMid) + position(z);
    const Matrix3<Interval> R_mid = multiply(R_v, parts(reference_.pose.R, kMid));
    const Vector3<Interval> p_drift = parts(reference_.pose.p, kSlope);
    const Vector3<Interval> w = multiply(R_v, parts(reference_.turning, kRange));
    const Vector3<Interval> w_mid = multiply(R_v, parts(reference_.turning, kMid));
    const Vector3<Interval> w_drift = multiply(R_v, parts(reference_.turning, kSlope));
    const Interval turning = turn_ * Interval(2) / (Interval(1) + squared_norm(v));
    Derivatives result;
    for (std::size_t i = 0; i < 6; ++i) {
      const Vector3<Interval>& a = model_.base_anchors()[i];
      const Vector3<Interval>& b = model_.platform_anchors()[i];
      const Vector3<Interval> Rb = multiply(R, b);
      const Vector3<Interval> from_a = p - a;
      const Vector3<Interval> d = from_a + Rb;
      const Vector3<Interval> x = cross(Rb, from_a);  // = cross(Rb, d)
      const Vector3<Interval> x_turned = x + cross(x, v);
      for (std::size_t c = 0; c < 3; ++c) {
        result.by_y[i][c] = position_ * d[c];
        result.by_y[i][3 + c] = turning * x_turned[c];
      }
      const Vector3<Interval> Rb_mid = multiply(R_mid, b);
      const Vector3<Interval> d_mid = p_mid + Rb_mid - a;
      result.by_u[i] = dot(d_mid, p_drift + cross(w_mid, Rb_mid)) - L_[i].mid * L_[i].slope;
      const Vector3<Interval> turned = cross(w, Rb);
      result.by_uu[i] =
          squared_norm(p_drift + turned) + dot(d, cross(w_drift, Rb) + cross(w, turned)) - sqr(L_[i].slope);
    }
    return result;
  }

  [[nodiscard]] Vector6<Interval> at_middle(const Vector6<Interval>& z) const override {
    const Vector3<Interval> p = parts(reference_.pose.p, kMid) + position(z);
    const Matrix3<Interval> R = multiply(turn_by(turn(z)), parts(reference_.pose.R, kMid));
    Vector6<Interval> result;
    for (std::size_t i = 0; i < 6; ++i) {
      const Vector3<Interval> d = p + multiply(R, model_.platform_anchors()[i]) - model_.base_anchors()[i];
      result[i] = (squared_norm(d) - sqr(L_[i].mid)) / Interval(2);
    }
    return result;
  }

  [[nodiscard]] Frame pose(const Vector6<Form>& z) const {
    const Form position(position_);
    const Form turn(turn_);
    return {reference_.pose.p + position * Vector3<Form>{z[0], z[1], z[2]},
            multiply(turn_by(turn * Vector3<Form>{z[3], z[4], z[5]}), reference_.pose.R)};
  }

  [[nodiscard]] Vector3<Interval> position(const Vector6<Interval>& z) const {
    return position_ * Vector3<Interval>{z[0], z[1], z[2]};
  }
  [[nodiscard]] Vector3<Interval> turn(const Vector6<Interval>& z) const {
    return turn_ * Vector3<Interval>{z[3], z[4], z[5]};
  }

 private:
  const Model& model_;
  const Reference& reference_;
  const Vector6<Form>& L_;
  Interval position_;
  Interval turn_;
};

Vector6<Form> at_middle(const Vector6<Form>& x) {
  Vector6<Form> result;
  for (std::size_t i = 0; i < 6; ++i) result[i] = Form(x[i].mid);
  return result;
}

Reference at_middle(const Reference& x) {
  Reference result;  // which does not turn
  result.tube = x.tube;
  for (std::size_t i = 0; i < 3; ++i) {
    result.pose.p[i] = Form(x.pose.p[i].mid);
    for (std::size_t j = 0; j < 3; ++j) result.pose.R[i][j] = Form(x.pose.R[i][j].mid);
  }
  return result;
}

}  // namespace

Frame held_by_lengths(const Model& model, const Reference& reference, const Vector6<Form>& L) {
  for (const Form& length : L) {
    if (!certainly_positive(length.range)) throw Undefined("a cable may have no length");
  }
  const Interval whole(1);
  const Reference reference_mid = at_middle(reference);
  const Vector6<Form> L_mid = at_middle(L);
  const HeldByLengths at_mid(model, reference_mid, L_mid);
  const HeldByLengths over_box(model, reference, L);
  const Vector6<Interval> near = approximate_zero(at_mid);
  const Zero mid = only_zero(at_mid, whole, near);
  const Zero range = only_zero(over_box, whole, near);
  Vector6<Form> z;
  for (std::size_t i = 0; i < 6; ++i) z[i] = Form::enclose(mid.y[i], range.slope[i], range.y[i]);
  return over_box.pose(z);
}

Frame deviated_pose(const Model& stated, const Frame& pose, const Vector6<Form>& L, const Model& deviant,
                    const Vector6<Interval>& errors, const std::function<void()>& before_step) {
  const double size = mpfr_get_d(stated.platform_size().lower(), MPFR_RNDN);
  if (!std::isfinite(size)) throw Undefined("a platform without a size");
  Frame here = pose;
  // Steps of 2^-h of the way, each proved in some tube around where it begins; as large as can be proved.
  constexpr int kMostHalvings = 8;
  constexpr int kTubes = 8;
  constexpr int kMoreTubes = 4;  // for each halving
  constexpr int kNarrowest = 32;
  constexpr int kSteady = 4;  // steps of a size before a larger one is tried
  mpq_class t = 0;
  int halvings = 0;
  int widest = 1;
  int steady = 0;
  while (t < 1) {
    before_step();
    mpq_class next = t + mpq_class(1, 1 << halvings);
    if (next > 1) next = 1;
    const Interval on_the_way = hull(Interval(t), Interval(next));
    Vector6<Form> L_on_the_way;
    Vector6<Form> L_next;
    for (std::size_t i = 0; i < 6; ++i) {
      L_on_the_way[i] = Form(L[i].range + on_the_way * errors[i]);
      L_next[i] = Form(L[i].range + Interval(next) * errors[i]);
    }
    const Model machines = stated.towards(deviant, on_the_way);
    const Model machine = stated.towards(deviant, Interval(next));
    Reference still = at_middle({here, {}, {}});
    bool is_followed = false;
    const int end = std::min(widest + kTubes + kMoreTubes * halvings, kNarrowest + 1);
    for (int k = widest; !is_followed && k < end; ++k) {
      still.tube.turn = std::ldexp(1.0, -k);
      still.tube.position = size * still.tube.turn;
      try {
        (void)held_by_lengths(machines, still, L_on_the_way);
        here = held_by_lengths(machine, still, L_next);
        is_followed = true;
        widest = k;
      } catch (const Undefined&) {
        continue;
      }
    }
    if (is_followed) {
      t = next;
      if (++steady == kSteady) {
        steady = 0;
        halvings = std::max(0, halvings - 1);
        widest = std::max(1, widest - 1);
      }
    } else {
      steady = 0;
      widest = std::max(1, widest - 2);
      if (++halvings > kMostHalvings) throw Undefined("the pose to which the deviation leads");
    }
  }
  return here;
}

}  // namespace taut::checker
