// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/report_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <span>

#include "kinematics/pose_conversion.h"
#include "problem/expression.h"
#include "problem/rational.h"
#include "problem/scalar.h"
#include "reports/page/body_shapes.h"
#include "reports/page/machine_view.h"
#include "reports/page/map_frame.h"
#include "reports/page/plane.h"
#include "reports/page/plane_map.h"
#include "reports/summary/angles.h"
#include "reports/summary/cable_use.h"
#include "reports/summary/headroom_summary.h"
#include "reports/summary/load_statement.h"
#include "reports/summary/nearness.h"
#include "reports/summary/numbers.h"
#include "reports/summary/shown_bodies.h"
#include "reports/summary/time_statement.h"
#include "reports/summary/wording.h"
#include "reports/summary/worst_place.h"

namespace taut {

using nlohmann::json;

namespace {

constexpr std::size_t kMostBins = 1500;  ///< of boxes and of segments; finer than the pixels of a wide plot

/// The nearest number with `digits` digits. @pre x is finite
double shortened(double x, int digits = 7) {
  const std::string text = fmt::format("{:.{}e}", x, digits - 1);
  std::from_chars(text.data(), text.data() + text.size(), x);  // leaves x where the result would be infinite
  return x;
}

json number(double x) { return std::isfinite(x) ? json(shortened(x)) : json(); }

/// A number with seven digits that is not above x, or not below x if `up`.
json outward(double x, bool up) {
  if (!std::isfinite(x)) return {};
  double result = shortened(x);
  const double step = 1e-6 * std::abs(x);
  for (int i = 1; i <= 3 && (up ? result < x : result > x); ++i) result = shortened(up ? x + i * step : x - i * step);
  return (up ? result < x : result > x) ? json(x) : json(result);
}

template <class Values>
json numbers(const Values& values) {
  json list = json::array();
  for (const double x : values) list.push_back(number(x));
  return list;
}

json point(const Vector3<double>& p) { return numbers(std::array{p(0), p(1), p(2)}); }

json robot(const Model<double>& model) {
  const Vector6<double> nominal =
      nominal_wrench(model.loads, model.wrench, Matrix3<double>(Matrix3<double>::Identity()));
  json base = json::array();
  json platform = json::array();
  json tension = json::array();
  json length = json::array();
  for (std::size_t i = 0; i < kCables; ++i) {
    base.push_back(point(model.p_WA[i]));
    platform.push_back(point(model.p_PB[i]));
    tension.push_back(numbers(std::array{model.tension_lower[i], model.tension_upper[i]}));
    length.push_back(numbers(std::array{model.length_lower[i], model.length_upper[i]}));
  }
  return {{"base", base},
          {"platform", platform},
          {"load_point", point(model.p_PM)},
          {"force", point(Vector3<double>(nominal.head<3>()))},
          {"tension", tension},
          {"length", length}};
}

/// How near a range comes to its limits: the class, and within it a number that grows towards the limits.
struct Closeness {
  Nearness nearness = Nearness::kCalm;
  double use = 0;
  auto operator<=>(const Closeness&) const = default;
};

Closeness closeness(const Use& use, bool is_length) {
  const Range& range = use.range;
  const double lower = use.lower_limit;
  const double upper = use.upper_limit;
  const double width = upper - lower;
  if (is_length) {
    return {nearness_of_length(range, lower, upper), 1 - std::min(range.lower - lower, upper - range.upper) / width};
  }
  const double of_slack = lower > 0 && range.lower > 0 ? lower / range.lower : 1 - (range.lower - lower) / width;
  return {worse(nearness_to_slack(range, lower, upper), nearness_to_top(range, upper)),
          std::max(of_slack, upper > 0 ? range.upper / upper : 1)};
}

/// What the whole path asks of one quantity of the six cables: ranges, how near they come to their limits, and the
/// cables' indices, the nearest first.
json cable_uses(const std::array<Use, kCables>& uses, bool is_length, bool is_proved) {
  std::array<Closeness, kCables> close;
  std::array<std::size_t, kCables> order{};
  json ranges = json::array();
  json classes = json::array();
  for (std::size_t i = 0; i < kCables; ++i) {
    const Range& range = uses[i].range;
    order[i] = i;
    close[i] = closeness(uses[i], is_length);
    classes.push_back(name(close[i].nearness));
    ranges.push_back(is_proved ? json{outward(range.lower, false), outward(range.upper, true)}
                               : numbers(std::array{range.lower, range.upper}));
  }
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return close[a] > close[b]; });
  return {{"order", order}, {"nearness", classes}, {"ranges", ranges}};
}

void widen(Range& range, double low, double high) { range = {std::min(range.lower, low), std::max(range.upper, high)}; }

/// Widens the ranges to all regular samples, between which more is possible, and to what the witness proves.
void widen_to_the_whole_path(const ReportContext& scene, CableUse& use) {
  for (const PathSample& sample : scene.samples) {
    const Statics<double>& s = sample.statics;
    for (std::size_t i = 0; i < kCables && s.regular; ++i) {
      widen(use.tension[i].range, s.tension[i] - s.tension_below[i], s.tension[i] + s.tension_above[i]);
      widen(use.length[i].range, s.length[i], s.length[i]);
    }
  }
  if (!scene.gravest) return;
  const PathWitness& witness = scene.gravest->violation;
  if (witness.singular || witness.contact || witness.rate) return;
  const MarginKind kind = witness.margin.kind;
  const bool is_length = kind == MarginKind::kLengthMin || kind == MarginKind::kLengthMax;
  widen((is_length ? use.length : use.tension)[static_cast<std::size_t>(witness.margin.cable)].range,
        nearest_double(witness.value_lower), nearest_double(witness.value_upper));
}

/// What all of the path asks of the cables: proved, or else sampled; null where nothing is known.
json cables(const ReportContext& scene) {
  CableUse use = cable_use(scene);
  if (use.source == CableUse::Source::kNone) return nullptr;
  if (use.source == CableUse::Source::kProvedParts) {  // as the first page has it
    if (const CableUse sampled = sampled_use(scene); sampled.source != CableUse::Source::kNone) use = sampled;
  }
  const bool is_proved = use.source == CableUse::Source::kProved;
  if (!is_proved) widen_to_the_whole_path(scene, use);
  return {{"is_proved", is_proved},
          {"tension", cable_uses(use.tension, false, is_proved)},
          {"length", cable_uses(use.length, true, is_proved)}};
}

json json_columns(std::span<const std::vector<double>> list) {
  json result = json::array();
  for (const std::vector<double>& column : list) result.push_back(numbers(column));
  return result;
}

/// The nominal force's components at the samples; none of a load whose nominal force is the same at all of them.
json forces(const ReportContext& scene) {
  const Model<double>& model = scene.sampler.model();
  std::array<std::vector<double>, 3> columns;
  const auto force_at = [&](const Matrix3<double>& turn) -> Vector3<double> {
    return nominal_wrench(model.loads, model.wrench, turn).head<3>();
  };
  const Vector3<double> level = force_at(Matrix3<double>::Identity());
  bool is_same = true;
  for (const PathSample& sample : scene.samples) {
    const Vector3<double> force = force_at(rotation(model.angles, sample.pose.angles));
    is_same = is_same && (force - level).norm() <= 1e-9 * level.norm();
    for (std::size_t c = 0; c < 3; ++c) columns[c].push_back(force(static_cast<Eigen::Index>(c)));
  }
  return is_same ? json::array() : json_columns(columns);
}

/// The angles of one sample after another, as they are shown: those of poses go on from the last ones.
class ShownAngleSequence {
 public:
  ShownAngleSequence(AngleKind kind, bool is_of_poses) : kind_(kind), is_of_poses_(is_of_poses) {}

  std::array<double, 3> next(const std::array<double, 3>& stated, const Eigen::Quaterniond& q) {
    if (!is_of_poses_) return stated;  // else they are wrapped
    std::array<double, 3> shown{};
    if (kind_ == AngleKind::kTiltAndTorsion) {
      tilt_ = tilt_and_torsion(q, tilt_);
      for (std::size_t c = 0; c < 3; ++c) shown[c] = tilt_->value(c);
      return shown;
    }
    shown = angles_of(kind_, q.toRotationMatrix());
    if (before_) shown = nearest_angles(kind_, shown, *before_);
    before_ = shown;
    return shown;
  }

 private:
  AngleKind kind_;
  bool is_of_poses_;
  std::optional<TiltAndTorsion> tilt_;
  std::optional<std::array<double, 3>> before_;
};

/// Columns with one entry for each sample.
json samples(const ReportContext& scene) {
  const Model<double>& model = scene.sampler.model();
  std::vector<double> position, distance, turned, scale, sign;
  const AngleKind kind = shown_angles(scene.certificate).kind;
  const std::vector<std::string> symbols = angle_symbols(kind);
  std::array<std::vector<double>, 3> p;
  std::vector<std::vector<double>> angles(symbols.size());
  std::array<std::vector<double>, 4> q;
  std::array<std::vector<double>, kCables> tension, tension_below, tension_above, length;
  std::vector<std::vector<double>> parameters;
  json time = json::array();
  ShownAngleSequence shown_angles_of(kind, has_poses(scene.certificate.path.interpolation));
  Eigen::Quaterniond last = Eigen::Quaterniond::Identity();
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  for (const PathSample& sample : scene.samples) {
    position.push_back(sample.position);
    distance.push_back(scene.travel.distance_m(sample.position));
    turned.push_back(scene.travel.turned_rad(sample.position));
    if (sample.in_time) {
      time.push_back(number(sample.in_time->time_s));  // that of a place is the first at which a move is there
    } else if (const auto t = scene.travel.time_s(sample.position)) {
      time.push_back(number(*t));
    }
    RigidPose pose = scene.sampler.rigid_pose(sample);
    if (pose.q.dot(last) < 0) pose.q.coeffs() *= -1;
    last = pose.q;
    const std::array<double, 3> shown = shown_angles_of.next(sample.pose.angles, pose.q);
    for (std::size_t c = 0; c < 3; ++c) p[c].push_back(pose.p(static_cast<Eigen::Index>(c)));
    for (std::size_t c = 0; c < angles.size(); ++c) angles[c].push_back(shown[c]);
    for (std::size_t c = 0; c < 4; ++c) q[c].push_back(pose.q.coeffs()(static_cast<Eigen::Index>(c)));
    const Statics<double>& s = sample.statics;
    sign.push_back(!s.regular ? 0 : s.determinant > 0 ? 1 : -1);
    // By how much K could grow is not asked of a move.
    scale.push_back(s.regular && !sample.in_time ? wrench_scale_approx(model, s) : kUnknown);
    for (std::size_t i = 0; i < kCables; ++i) {
      length[i].push_back(s.length[i]);
      tension[i].push_back(s.regular ? s.tension[i] : kUnknown);
      tension_below[i].push_back(s.regular ? s.tension_below[i] : kUnknown);
      tension_above[i].push_back(s.regular ? s.tension_above[i] : kUnknown);
    }
    if (is_plane(scene.certificate.problem.space)) {
      parameters.resize(2);
      for (std::size_t j = 0; j < 2; ++j) parameters[j].push_back(sample.parameters[j]);
    }
  }
  return {{"position", numbers(position)},
          {"distance", numbers(distance)},
          {"turned", numbers(turned)},
          {"time", time},
          {"p", json_columns(p)},
          {"q", json_columns(q)},
          {"angles", json_columns(angles)},
          {"angle_names", symbols},
          {"length", json_columns(length)},
          {"tension", json_columns(tension)},
          {"tension_below", json_columns(tension_below)},
          {"tension_above", json_columns(tension_above)},
          {"force", forces(scene)},
          {"wrench_scale", numbers(scale)},
          {"sign", numbers(sign)},
          {"parameters", json_columns(parameters)}};
}

/// Consecutive boxes, and the ranges of tensions and lengths on them.
struct Bin {
  double from = 0;
  double to = 0;
  std::array<Range, kCables> tension;
  std::array<Range, kCables> length;
};

/// Ranges of boxes; those in the same one of kMostBins parts of the path are united. Thinner gaps would be invisible in
/// a picture and are closed.
std::vector<Bin> bins(const PathRanges& ranges) {
  std::vector<Bin> result;
  const auto segments = static_cast<double>(ranges.segments.size());
  const double width = segments / kMostBins;
  std::size_t pieces = 0;
  for (const auto& segment : ranges.segments) pieces += segment.size();
  const bool unite = pieces > kMostBins;
  double bin_of_last = -1;
  for (std::size_t k = 0; k < ranges.segments.size(); ++k) {
    for (const BoxRanges& box : ranges.segments[k]) {
      const double from = static_cast<double>(k) + box.box.lower().approx();
      const double to = static_cast<double>(k) + box.box.upper().approx();
      const double bin = std::floor(from / width);
      if (unite && bin == bin_of_last && from - result.back().to < width) {
        Bin& last = result.back();
        last.to = to;
        for (std::size_t i = 0; i < kCables; ++i) {
          last.tension[i] = hull(last.tension[i], box.tension[i]);
          last.length[i] = hull(last.length[i], box.length[i]);
        }
      } else {
        result.push_back({from, to, box.tension, box.length});
      }
      bin_of_last = bin;
    }
  }
  return result;
}

json bands(const std::vector<Bin>& bins) {
  json from = json::array();
  json to = json::array();
  for (const Bin& bin : bins) {
    from.push_back(number(bin.from));
    to.push_back(number(bin.to));
  }
  const auto columns = [&](std::array<Range, kCables> Bin::*what) {
    json result = json::array();
    for (std::size_t i = 0; i < kCables; ++i) {
      json lower = json::array();
      json upper = json::array();
      for (const Bin& bin : bins) {
        lower.push_back(outward((bin.*what)[i].lower, false));
        upper.push_back(outward((bin.*what)[i].upper, true));
      }
      result.push_back({{"lower", lower}, {"upper", upper}});
    }
    return result;
  };
  return {{"from", from}, {"to", to}, {"tension", columns(&Bin::tension)}, {"length", columns(&Bin::length)}};
}

/// The least margins of runs of segments, at most kMostBins of them; null where nothing is proved.
json margins(const std::vector<CertificateSegment>& segments, bool has_bodies, bool in_time) {
  const std::size_t together = (segments.size() + kMostBins - 1) / kMostBins;
  json result = {{"from", json::array()}, {"to", json::array()}};
  const auto column = [&](const char* key, const auto& margin) {
    json list = json::array();
    for (std::size_t k = 0; k < segments.size(); k += together) {
      std::optional<double> least;
      for (std::size_t i = k; i < std::min(k + together, segments.size()); ++i) {
        if (!segments[i].margins) continue;
        const double value = nearest_double(margin(*segments[i].margins));
        least = std::min(value, least.value_or(value));
      }
      list.push_back(least ? outward(*least, false) : json());
    }
    result[key] = list;
  };
  column("tension_N", [](const Margins& m) { return m.tension_N; });
  column("length_m", [](const Margins& m) { return m.length_m; });
  if (!in_time) column("wrench_scale", [](const Margins& m) { return m.wrench_scale; });
  if (has_bodies) column("clearance_m", [](const Margins& m) { return m.clearance_m.value_or("0"); });
  for (std::size_t k = 0; k < segments.size(); k += together) {
    result["from"].push_back(k);
    result["to"].push_back(std::min(k + together, segments.size()));
  }
  return result;
}

/// Where the path is not proved: {from, to, violated}. Those of one kind that a picture would not show apart are one.
json stretches(const Certificate& certificate) {
  struct Part {
    double from = 0;
    double to = 0;
    bool violated = false;
  };
  std::vector<Part> list;
  const double thin = static_cast<double>(certificate.path.segments()) / kMostBins;
  for (const Stretch& stretch : certificate.stretches) {
    const Part next = {position(stretch.begin), position(stretch.end), stretch.violations.has_value()};
    if (certificate.stretches.size() > kMostBins && !list.empty() && list.back().violated == next.violated &&
        next.from - list.back().to < thin) {
      list.back().to = next.to;
    } else {
      list.push_back(next);
    }
  }
  if (const auto& open = certificate.undecided; open && open->segment && list.empty()) {
    list.push_back({*open->segment + (open->box ? open->box->first.approx() : 0.0),
                    *open->segment + (open->box ? open->box->second.approx() : 1.0), false});
  }
  json result = json::array();
  for (const Part& s : list) {
    result.push_back({{"from", number(s.from)}, {"to", number(s.to)}, {"violated", s.violated}});
  }
  return result;
}

/// Rates of the six winches at the samples, and their limits; null of what is no move. Of power only where it has one.
json winches(const ReportContext& scene) {
  if (!is_move(scene.certificate)) return nullptr;
  const std::vector<RateLimit> limits = rate_limits(*scene.certificate.problem.time);
  json result = json::object();
  for (const RateKind kind : {RateKind::kWinchSpeed, RateKind::kWinchAcceleration, RateKind::kWinchPower}) {
    std::array<json, kCables> stated;
    for (const RateLimit& limit : limits) {
      if (limit.id.kind == kind) stated[static_cast<std::size_t>(limit.id.cable)] = number(limit.value);
    }
    const bool is_limited = std::ranges::any_of(stated, [](const json& limit) { return !limit.is_null(); });
    if (kind == RateKind::kWinchPower && !is_limited) continue;
    std::array<std::vector<double>, kCables> columns;
    for (const PathSample& sample : scene.samples) {
      for (std::size_t i = 0; i < kCables; ++i) {
        const MoveSample& at = *sample.in_time;
        columns[i].push_back(kind == RateKind::kWinchSpeed          ? at.winches.speed[i]
                             : kind == RateKind::kWinchAcceleration ? at.winches.acceleration[i]
                                                                    : at.winch_power[i]);
      }
    }
    result[name(kind)] = {{"limits", stated}, {"values", json_columns(columns)}};
  }
  return result;
}

/// From where the pictures look, as machine_view.h has it; null where the machine can't be drawn.
json view(const ReportContext& scene) {
  const MachineView view(scene);
  if (!view.is_drawable) return nullptr;
  return {{"across", point(view.across)},
          {"up", point(view.up)},
          {"azimuth", number(view.azimuth)},
          {"elevation", number(view.elevation)},
          {"ground", number(view.grid.height)},
          {"step", number(view.grid.step)},
          {"columns", view.grid.across},
          {"rows", view.grid.inward},
          {"load", brief_load(scene.certificate.problem.load)}};
}

/// As in an illustration, with corners in metres.
json decoration(const Decoration& shown) {
  json result = to_json(shown);
  const auto corners = [](const ShownBody& body) {
    json list = json::array();
    for (const std::array<double, 3>& corner : body.corners) {
      for (const double x : corner) list.push_back(number(x));
    }
    return list;
  };
  if (shown.frame) result["frame"]["corners"] = corners(*shown.frame);
  if (shown.payload) result["payload"]["corners"] = corners(*shown.payload);
  return result;
}

json triangles(const ShownBody& body) {
  json corners = json::array();
  json indices = json::array();
  for (const std::array<double, 3>& corner : body.corners) {
    for (const double x : corner) corners.push_back(number(x));
  }
  for (const auto& triangle : body.triangles) {
    for (const std::uint32_t i : triangle) indices.push_back(i);
  }
  return {{"corners", corners}, {"triangles", indices}};
}

json shape(const BodyShape& body, const MachineView& view) {
  json result = {{"name", body.name}, {"is_obstacle", body.is_obstacle}};
  if (body.mesh) {
    result.update(triangles(*body.mesh));
  } else if (body.is_half_space) {
    json corners = json::array();
    for (const Vector3<double>& p : view.plane(body.normal, body.offset)) corners.push_back(point(p));
    result["plane"] = std::move(corners);
  } else {
    json points = json::array();
    for (const Vector3<double>& p : body.points) points.push_back(point(p));
    result["points"] = std::move(points);
    result["radius"] = number(body.radius);
  }
  json box = json::array();
  for (const Vector3<double>& p : body.box()) box.push_back(point(p));
  result["box"] = std::move(box);
  return result;
}

/// The pair with the least left at each sample, and its nearest points.
json nearest_bodies(const DistancesAlong& along) {
  std::vector<double> pair, distance, clearance, cone;
  std::array<std::vector<double>, 3> first, second;
  for (const BodyDistance& nearest : along.least) {
    pair.push_back(static_cast<double>(nearest.pair));
    distance.push_back(nearest.distance);
    clearance.push_back(nearest.clearance);
    cone.push_back(nearest.is_in_cone ? 1 : 0);
    for (std::size_t c = 0; c < 3; ++c) {
      first[c].push_back(nearest.at[0](static_cast<Eigen::Index>(c)));
      second[c].push_back(nearest.at[1](static_cast<Eigen::Index>(c)));
    }
  }
  return {{"pair", numbers(pair)}, {"distance", numbers(distance)}, {"clearance", numbers(clearance)},
          {"cone", numbers(cone)}, {"first", json_columns(first)},  {"second", json_columns(second)}};
}

/// Shapes, cables as bodies, and distances at the samples; null where the problem has no bodies.
json bodies(const ReportContext& scene) {
  if (!scene.bodies) return nullptr;
  const MachineView view(scene);
  const BodyModel<double>& model = scene.bodies->bodies();
  const DistancesAlong& along = scene.distances;
  json shapes = json::array();
  if (view.is_drawable) {
    for (const BodyShape& body : body_shapes(scene)) shapes.push_back(shape(body, view));
  }
  json names = json::object();
  for (const BodyDistance& nearest : along.least)
    names[std::to_string(nearest.pair)] = scene.bodies->name(nearest.pair);
  json pairs = json::array();
  for (std::size_t n = 0; n < along.nearest.size(); ++n) {
    pairs.push_back({{"name", scene.bodies->name(along.nearest[n])},
                     {"clearance", numbers(along.clearance[n])},
                     {"distance", numbers(along.distance[n])}});
  }
  const auto& checked = scene.certificate.problem.bodies->clearance_m;
  json free_ends = json::array();
  for (const auto& ends : model.cable_free) free_ends.push_back(numbers(ends));
  return {{"shapes", shapes},       {"cable_radius", numbers(model.cable_radius)},
          {"free_ends", free_ends}, {"has_cables", checked[1] || checked[2] || checked[3]},
          {"names", names},         {"nearest", nearest_bodies(along)},
          {"pairs", pairs}};
}

/// The centres of gravity of the load's weights, in the axes of the platform.
json weights(const LoadText& load) {
  json result = json::array();
  for (const LoadItem& item : load.items) {
    const auto* weight = std::get_if<Weight>(&item.what);
    if (!weight) continue;
    std::array<double, 3> at{};
    for (std::size_t c = 0; c < 3; ++c) at[c] = from_rational<double>(weight->at[c]);
    result.push_back(numbers(at));
  }
  return result;
}

json witness(const ReportContext& scene) {
  if (!scene.gravest) return nullptr;
  const PathWitness& violation = scene.gravest->violation;
  const bool singular = violation.singular;
  return {{"position", number(position(violation.at))},
          {"to", singular ? number(position(violation.to)) : json()},
          {"kind", singular            ? "singular"
                   : violation.contact ? "contact"
                   : violation.rate    ? name(violation.rate->kind)
                                       : name(violation.margin.kind)},
          {"cable", violation.rate ? (is_of_winch(violation.rate->kind) ? violation.rate->cable + 1 : 0)
                    : singular || violation.contact ? 0
                                                    : violation.margin.cable + 1}};
}

/// Where poses are implied and the path is refuted, the end of the certificate's own witness: up to there the move is
/// proved to pass the poses that boxes and witnesses are about.
json reached(const ReportContext& scene) {
  if (!is_implied(scene.certificate) || !scene.certificate.witness) return nullptr;
  const PathWitness& own = scene.certificate.witness->violation;
  const double end = position(own.at);
  return number(own.singular ? std::max(end, position(own.to)) : end);
}

/// Radius of the tube around the path in which the platform's origin may be [m]; null if no such tolerance is stated.
json tube_radius(const Problem& problem) {
  if (!problem.tolerances) return nullptr;
  const double radius = evaluate_constant<double>(problem.tolerances->position_m);
  return radius > 0 ? number(radius) : json();
}

/// How far each uncertainty could go alone, in the words of the sentence that says so.
json tolerances(const ReportContext& scene) {
  json result = json::array();
  const Problem& problem = scene.certificate.problem;
  if (!problem.tolerances || !scene.illustration.headroom) return result;
  for (const EachAlone& alone : each_alone(*scene.illustration.headroom, problem, scene.illustration.units)) {
    result.push_back({{"what", alone.what}, {"words", alone.words()}, {"used", number(alone.used)}});
  }
  return result;
}

json spans(const std::array<Span, 2>& window) {
  json result = json::array();
  for (const Span& span : window) result.push_back(numbers(std::array{span.lower, span.upper}));
  return result;
}

/// A proved map, or null.
json map(const std::optional<PlaneMap>& map) {
  if (!map) return nullptr;
  json areas = json::object();
  for (const PlaneMap::Area& area : map->areas) areas[area.kind] = area.path;
  const auto share = [&](CellKind kind) { return map->share.at(static_cast<std::size_t>(kind)); };
  return {{"window", spans(map->window)},
          {"turns", map->turns},
          {"flip", map->flip ? json(*map->flip) : json()},
          {"units", kAreaUnits},
          {"areas", areas},
          {"cells", map->cells},
          {"inside", number(share(CellKind::kInside))},
          {"undecided", number(share(CellKind::kUndecided))}};
}

/// A part of the plane: with a proved map, or else with fields on a grid.
json grid(const PlaneGrid& grid, const std::optional<PlaneMap>& of) {
  json result = {{"window", spans(grid.window)}, {"columns", grid.columns}, {"rows", grid.rows}, {"map", map(of)}};
  if (of) return result;
  result["tension"] = contour_text(grid.tension, grid.columns);
  result["length"] = contour_text(grid.length, grid.columns);
  result["det_J"] = contour_text(grid.determinant, grid.columns);
  return result;
}

/// Name, unit and the factor that brings parameter j into the unit in which it is shown.
json plane_axis(const ReportContext& scene, std::size_t j) {
  const SpaceText& space = scene.certificate.problem.space;
  const DisplayUnits& units = scene.illustration.units;
  const std::string si = unit(space, j);
  json axis = {{"name", space.parameters[j].name}, {"unit", si}, {"factor", 1}};
  if (si == "m") axis.update({{"unit", units.length.name()}, {"factor", units.length.approx(1)}});
  if (si == "rad" && units.in_degrees) axis.update({{"unit", "°"}, {"factor", 180 / std::numbers::pi}});
  return axis;
}

json plane(const ReportContext& scene) {
  const std::optional<PlaneMap> map = plane_map(scene);
  const std::optional<Plane> plane = sample_plane(scene, !map);
  if (!plane) return nullptr;
  const std::optional<PlaneMap> part = map && plane->detail ? plane_map(scene, plane->detail->window) : std::nullopt;
  // For thousands of points in a picture four digits suffice and keep the page small.
  const auto drawn = [&](double x) { return std::isfinite(x) ? json(shortened(x, 4)) : json(); };
  json charts = json::array();
  for (const auto& polygon : plane->charts) {
    json corners = json::array();
    for (const auto& corner : polygon) {
      for (const double x : corner) corners.push_back(drawn(x));
    }
    charts.push_back(std::move(corners));
  }
  json waypoints = json::array();
  if (scene.certificate.path.waypoints.size() <= kMostBins) {
    for (const Waypoint& waypoint : scene.certificate.path.waypoints) waypoints.push_back(numbers(resolved(waypoint)));
  }
  return {{"axes", {plane_axis(scene, 0), plane_axis(scene, 1)}},
          {"grid", grid(plane->grid, map)},
          {"detail", plane->detail ? grid(*plane->detail, part ? part : map) : json()},
          {"charts", charts},
          {"all_charts", scene.illustration.charts.size()},
          {"waypoints", waypoints}};
}

}  // namespace

namespace {

/// A unit, and by what SI values are multiplied to be in it.
json display_unit(const DisplayUnit& unit) { return {{"name", unit.name()}, {"factor", unit.approx(1)}}; }

}  // namespace

json report_data(const ReportContext& scene) {
  const Certificate& certificate = scene.certificate;
  const std::optional<double> worst = worst_place(scene, cable_use(scene));
  return {{"verdict", scene.verdict},
          {"segments", certificate.path.segments()},
          {"is_spline", certificate.path.interpolation == Interpolation::kCubicBSpline},
          {"units",
           {{"length", display_unit(scene.illustration.units.length)},
            {"force", display_unit(scene.illustration.units.force)}}},
          {"robot", robot(scene.sampler.model())},
          {"samples", samples(scene)},
          {"cables", cables(scene)},
          {"bands", scene.ranges.segments.empty() ? json() : bands(bins(scene.ranges))},
          {"margins", margins(certificate.segments, certificate.problem.bodies.has_value(), is_move(certificate))},
          {"winches", winches(scene)},
          {"bodies", bodies(scene)},
          {"stretches", stretches(certificate)},
          {"witness", witness(scene)},
          {"reached", reached(scene)},
          {"weights", weights(certificate.problem.load)},
          {"decoration", decoration(scene.illustration.decoration)},
          {"is_found", !found_no_path(certificate)},
          {"worst", worst ? number(*worst) : json()},
          {"view", view(scene)},
          {"tube_m", tube_radius(certificate.problem)},
          {"tolerances", tolerances(scene)},
          {"plane", plane(scene)}};
}

std::string script_safe(const json& value) {
  std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  std::string result;
  result.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      result += "\\u003c";
    } else {
      result += c;
    }
  }
  return result;
}

}  // namespace taut
