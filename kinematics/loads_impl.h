// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of loads.h.
#pragma once

namespace taut {

namespace loads_detail {

template <class A, class B>
[[nodiscard]] auto cross(const Eigen::Matrix<A, 3, 1>& a, const Eigen::Matrix<B, 3, 1>& b) {
  using S = decltype(a(0) * b(0));
  return Eigen::Matrix<S, 3, 1>(a(1) * b(2) - a(2) * b(1), a(2) * b(0) - a(0) * b(2), a(0) * b(1) - a(1) * b(0));
}

template <class S>
[[nodiscard]] S dot(const Eigen::Matrix<S, 3, 1>& a, const Eigen::Matrix<S, 3, 1>& b) {
  return a(0) * b(0) + a(1) * b(1) + a(2) * b(2);
}

template <class S>
[[nodiscard]] S dot(const Eigen::Matrix<S, 6, 1>& a, const Eigen::Matrix<S, 6, 1>& b) {
  S sum = a(0) * b(0);
  for (int k = 1; k < 6; ++k) sum = sum + a(k) * b(k);
  return sum;
}

template <class S>
[[nodiscard]] S norm(const Eigen::Matrix<S, 3, 1>& a) {
  return euclidean_norm(a(0), a(1), a(2));
}

template <class S, class K>
[[nodiscard]] Eigen::Matrix<S, 3, 1> turned(const Eigen::Matrix<S, 3, 3>& r, const Eigen::Matrix<K, 3, 1>& x) {
  Eigen::Matrix<S, 3, 1> y;
  for (int i = 0; i < 3; ++i) y(i) = r(i, 0) * x(0) + r(i, 1) * x(1) + r(i, 2) * x(2);
  return y;
}

template <class S, class K>
[[nodiscard]] Eigen::Matrix<S, 3, 1> in_world(const Eigen::Matrix<S, 3, 3>& r, Axes axes,
                                              const Eigen::Matrix<K, 3, 1>& x) {
  if (axes == Axes::kPlatform) return turned(r, x);
  return {S(x(0)), S(x(1)), S(x(2))};
}

/// The wrench (F ; r × F + M) about P_m, in W, of a force and a moment about c in the given axes.
template <class S, class K>
[[nodiscard]] Eigen::Matrix<S, 6, 1> about_load_point(const Eigen::Matrix<S, 3, 3>& r_WP, Axes axes,
                                                      const Eigen::Matrix<S, 3, 1>& lever,
                                                      const Eigen::Matrix<K, 6, 1>& w) {
  const Eigen::Matrix<S, 3, 1> force = in_world(r_WP, axes, Eigen::Matrix<K, 3, 1>(w(0), w(1), w(2)));
  const Eigen::Matrix<S, 3, 1> moment = in_world(r_WP, axes, Eigen::Matrix<K, 3, 1>(w(3), w(4), w(5)));
  const Eigen::Matrix<S, 3, 1> turning = cross(lever, force);
  Eigen::Matrix<S, 6, 1> result;
  for (int k = 0; k < 3; ++k) {
    result(k) = force(k);
    result(3 + k) = turning(k) + moment(k);
  }
  return result;
}

template <class K>
[[nodiscard]] Eigen::Matrix<K, 3, 1> vector_of(const RationalVector& text) {
  return {from_rational<K>(text[0]), from_rational<K>(text[1]), from_rational<K>(text[2])};
}

template <class K>
void set_shape(const VectorSet& set, typename LoadModel<K>::Item& item) {
  using Shape = typename LoadModel<K>::Shape;
  item.nominal = item.offset = K(0.0);
  item.direction = {K(0.0), K(0.0), K(0.0)};
  const auto unit = [](const RationalVector& text) {
    const Eigen::Matrix<K, 3, 1> x = vector_of<K>(text);
    const K size = norm(x);
    return Eigen::Matrix<K, 3, 1>(x(0) / size, x(1) / size, x(2) / size);
  };
  if (const auto* ball = std::get_if<BallOfVectors>(&set)) {
    item.shape = Shape::kBall;
    item.radius = from_rational<K>(ball->radius);
  } else if (const auto* disc = std::get_if<DiscOfVectors>(&set)) {
    item.shape = Shape::kDisc;
    item.radius = from_rational<K>(disc->radius);
    item.direction = unit(disc->normal);
  } else {
    const auto& segment = std::get<SegmentOfVectors>(set);
    const K lower = from_rational<K>(segment.lower), upper = from_rational<K>(segment.upper);
    const K middle = K(0.5) * (lower + upper);
    const bool holds_zero = !certainly_positive(lower) && !certainly_positive(-upper);
    item.shape = Shape::kSegment;
    item.radius = K(0.5) * (upper - lower);
    item.direction = unit(segment.direction);
    item.nominal = holds_zero ? K(0.0) : middle;
    item.offset = holds_zero ? middle : K(0.0);
  }
}

}  // namespace loads_detail

template <class K>
LoadModel<K> make_load_model(const LoadText& load) {
  using namespace loads_detail;
  using Model = LoadModel<K>;
  const Eigen::Matrix<K, 3, 1> load_point = vector_of<K>(load.point_m);
  const auto lever = [&](const RationalVector& at) { return Eigen::Matrix<K, 3, 1>(vector_of<K>(at) - load_point); };
  Model model;
  for (const LoadItem& text : load.items) {
    typename Model::Item& item = model.items.emplace_back();
    item.lever = {K(0.0), K(0.0), K(0.0)};
    item.reach = K(0.0);
    if (const auto* weight = std::get_if<Weight>(&text.what)) {
      const K lower = from_rational<K>(weight->mass_lower), upper = from_rational<K>(weight->mass_upper);
      item.lever = lever(weight->at);
      item.direction = vector_of<K>(load.gravity_m_s2);
      item.nominal = K(0.5) * (lower + upper);
      item.radius = K(0.5) * (upper - lower);
      item.offset = K(0.0);
      item.reach = from_rational<K>(weight->at_tolerance);
      item.varies = weight->mass_lower != weight->mass_upper;
      item.swings = weight->at_tolerance != "0";
    } else if (const auto* force = std::get_if<Force>(&text.what)) {
      item.kind = Model::Kind::kForce;
      item.axes = force->axes;
      item.lever = lever(force->at);
      set_shape<K>(force->set, item);
    } else if (const auto* moment = std::get_if<Moment>(&text.what)) {
      item.kind = Model::Kind::kMoment;
      item.axes = moment->axes;
      set_shape<K>(moment->set, item);
    } else {
      const auto& cases = std::get<LoadCases>(text.what);
      item.kind = Model::Kind::kCases;
      item.axes = cases.axes;
      item.lever = lever(cases.at);
      for (int k = 0; k < 6; ++k) {
        item.mean(k) = K(0.0);
        for (const auto& w : cases.wrenches) {
          item.mean(k) = item.mean(k) + from_rational<K>(w[static_cast<std::size_t>(k)]);
        }
        item.mean(k) = item.mean(k) / K(static_cast<double>(cases.wrenches.size()));
      }
      for (const auto& w : cases.wrenches) {
        typename Model::Wrench& deviation = item.deviations.emplace_back();
        for (int k = 0; k < 6; ++k) {
          deviation(k) = from_rational<K>(w[static_cast<std::size_t>(k)]) - item.mean(k);
        }
      }
    }
  }
  return model;
}

template <class S, class K>
LoadsAtPose<S> loads_at(const LoadModel<K>& model, const Eigen::Matrix<S, 3, 3>& r_WP) {
  using namespace loads_detail;
  using Kind = typename LoadModel<K>::Kind;
  LoadsAtPose<S> result;
  result.nominal.setConstant(S(0.0));
  result.items.reserve(model.items.size());
  for (const auto& item : model.items) {
    typename LoadsAtPose<S>::Item& at = result.items.emplace_back();
    at.lever = turned(r_WP, item.lever);
    if (item.kind == Kind::kCases) {
      at.line = about_load_point(r_WP, item.axes, at.lever, item.mean);
      for (int k = 0; k < 6; ++k) result.nominal(k) = result.nominal(k) + at.line(k);
      for (const auto& deviation : item.deviations) {
        at.deviations.push_back(about_load_point(r_WP, item.axes, at.lever, deviation));
      }
      continue;
    }
    at.direction = in_world(r_WP, item.axes, item.direction);
    const Eigen::Matrix<S, 3, 1> turning =
        item.kind == Kind::kMoment ? at.direction : Eigen::Matrix<S, 3, 1>(cross(at.lever, at.direction));
    for (int k = 0; k < 3; ++k) {
      at.line(k) = item.kind == Kind::kMoment ? S(0.0) : at.direction(k);
      at.line(3 + k) = turning(k);
    }
    for (int k = 0; k < 6; ++k) result.nominal(k) = result.nominal(k) + at.line(k) * item.nominal;
  }
  return result;
}

template <class S, class K>
DensityRange<S> density_range(const LoadModel<K>& model, const LoadsAtPose<S>& at, const Eigen::Matrix<S, 6, 1>& y) {
  using namespace loads_detail;
  using Model = LoadModel<K>;
  using Vector = Eigen::Matrix<S, 3, 1>;
  const Vector y_force(y(0), y(1), y(2)), y_moment(y(3), y(4), y(5));
  DensityRange<S> sum{S(0.0), S(0.0)};
  const auto add = [&](const S& below, const S& above) {
    sum.below = sum.below + below;
    sum.above = sum.above + above;
  };
  for (std::size_t n = 0; n < model.items.size(); ++n) {
    const auto& item = model.items[n];
    const auto& here = at.items[n];
    switch (item.kind) {
      case Model::Kind::kWeight: {
        if (!item.varies && !item.swings) break;
        const S a = dot(y, here.line);
        const S b = item.swings ? S(norm(Vector(cross(here.direction, y_moment))) * item.reach) : S(0.0);
        const S mean = b * item.nominal;
        add(mean + absolute(S(a - b)) * item.radius, mean + absolute(S(a + b)) * item.radius);
        break;
      }
      case Model::Kind::kForce:
      case Model::Kind::kMoment: {
        if (item.shape == Model::Shape::kSegment) {
          const S a = dot(y, here.line);
          const S size = absolute(a) * item.radius, shift = a * item.offset;
          add(size - shift, size + shift);
          break;
        }
        Vector g = y_moment;
        if (item.kind == Model::Kind::kForce) g = Vector(y_force + cross(y_moment, here.lever));
        if (item.shape == Model::Shape::kDisc) {
          const S along = dot(g, here.direction);
          for (int k = 0; k < 3; ++k) g(k) = g(k) - along * here.direction(k);
        }
        const S size = norm(g) * item.radius;
        add(size, size);
        break;
      }
      case Model::Kind::kCases: {
        S most = dot(y, here.deviations.front());
        S least = -most;
        for (std::size_t j = 1; j < here.deviations.size(); ++j) {
          const S value = dot(y, here.deviations[j]);
          most = larger(most, value);
          least = larger(least, S(-value));
        }
        add(least, most);
        break;
      }
    }
  }
  return sum;
}

}  // namespace taut
