// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/monitor.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "base/input_error.h"
#include "kinematics/move_sampler.h"
#include "kinematics/time_law.h"
#include "problem/decimal.h"
#include "problem/expression.h"
#include "problem/rows.h"
#include "reports/summary/numbers.h"

namespace taut {
namespace {

constexpr std::size_t kCellsNearby = 256;  ///< that are looked at on either side before all of the path is
constexpr double kRounding_s = 1e-9;       ///< far more than times are rounded by

double norm_of(const std::array<DecimalText, 3>& text) {
  return Vector3<double>(nearest_double(text[0]), nearest_double(text[1]), nearest_double(text[2])).norm();
}

/// How far the length of cable i of a real machine may be from the commanded one [m].
double length_tolerance(const Problem& problem, const ToleranceNumbers& tolerances, std::size_t i) {
  const double ends = tolerances.platform_anchor[i] + tolerances.base_anchor[i];
  const double tracking = tolerances.position + tolerances.orientation * (norm_of(problem.robot.platform_anchors_m[i]) +
                                                                          tolerances.platform_anchor[i]);
  const RowsText* const rows = stated_rows(problem);
  const double by_rows = rows != nullptr ? nearest_double(rows->error_m[i]) : 0;
  return by_rows + tracking + (tolerances.cable_length ? (*tolerances.cable_length)[i] : ends);
}

/// How far errors of lengths lead the platform's origin, and how far they turn it, to first order at a pose.
std::pair<double, double> led_by(const Model<double>& model, const RigidPose& pose,
                                 const std::array<double, kCables>& errors) {
  Matrix6<double> rates;  // of lengths, by velocity and angular velocity
  for (std::size_t i = 0; i < kCables; ++i) {
    const Vector3<double> arm = pose.q * model.p_PB[i];
    const Vector3<double> along = (pose.p + arm - model.p_WA[i]).normalized();
    rates.row(static_cast<Eigen::Index>(i)) << along.transpose(), arm.cross(along).transpose();
  }
  const Matrix6<double> inverse = rates.inverse();
  std::pair<double, double> led = {0, 0};
  for (std::size_t j = 0; j < kCables; ++j) {
    const auto column = inverse.col(static_cast<Eigen::Index>(j));
    led.first += errors[j] * column.head<3>().norm();
    led.second += errors[j] * column.tail<3>().norm();
  }
  return led;
}

/// Of a machine whose pose is tracked: where straight lengths between rows lead it is added to how far it may be off.
ToleranceNumbers tolerances_of(const ProvedPath& proved, const PoseSampler& sampler) {
  ToleranceNumbers result = tolerance_numbers(proved.problem);
  const RowsText* const rows = stated_rows(proved.problem);
  if (result.cable_length || rows == nullptr) return result;
  std::array<double, kCables> errors;
  std::ranges::transform(rows->error_m, errors.begin(), [](const DecimalText& x) { return nearest_double(x); });
  double position = 0, turn = 0;
  constexpr int kPlaces = 32;  // of a segment
  for (std::size_t k = 0; k < proved.path.segments(); ++k) {
    for (int n = 0; n <= kPlaces; ++n) {
      const RigidPose pose = sampler.rigid_pose(proved.path.segment(k), static_cast<double>(n) / kPlaces);
      const auto [by, angle] = led_by(sampler.model(), pose, errors);
      position = std::max(position, by);
      turn = std::max(turn, angle);
    }
  }
  constexpr double kBetweenPlaces = 1.1;
  result.position += kBetweenPlaces * position;
  result.orientation += kBetweenPlaces * turn;
  return result;
}

double chord(double angle) { return 2 * std::sin(std::min(angle, 3.14159265358979) / 4); }

}  // namespace

const char* name(AlarmKind kind) {
  switch (kind) {
    case AlarmKind::kLength: return "length";
    case AlarmKind::kPosition: return "position";
    case AlarmKind::kOrientation: return "orientation";
    case AlarmKind::kAhead: return "ahead of the law";
    case AlarmKind::kBackwards: return "backwards";
    case AlarmKind::kWinchSpeed: return "winch speed";
    case AlarmKind::kTension: return "tension";
    case AlarmKind::kLoad: break;
  }
  return "load";
}

namespace {

PlaceTable make_table(const ProvedPath& proved, const PoseSampler& sampler,
                      const std::array<double, kCables>& length_allowed, double position, double turn) {
  return {sampler, proved.path, tension_pieces(proved), {length_allowed, position, chord(turn)}};
}

std::array<double, kCables> allowed_of(const Problem& problem, const GaugeErrors& errors) {
  std::array<double, kCables> result;
  const ToleranceNumbers tolerances = tolerance_numbers(problem);
  for (std::size_t i = 0; i < kCables; ++i) {
    result[i] = length_tolerance(problem, tolerances, i) + errors.length_m;
  }
  return result;
}

}  // namespace

Monitor::Monitor(ProvedPath proved, const GaugeErrors& errors)
    : proved_(std::move(proved)),
      errors_(errors),
      sampler_(proved_.problem),
      tolerances_(tolerances_of(proved_, sampler_)),
      length_allowed_(allowed_of(proved_.problem, errors)),
      table_(make_table(proved_, sampler_, length_allowed_, position_allowed(), orientation_allowed())),
      load_(proved_.problem) {
  for (std::size_t i = 0; i < kCables; ++i) {
    const double ends = tolerances_.platform_anchor[i] + tolerances_.base_anchor[i];
    pose_allowed_[i] = length_tolerance(proved_.problem, tolerances_, i) + ends + errors_.position_m +
                       errors_.orientation_rad * norm_of(proved_.problem.robot.platform_anchors_m[i]);
    if (!is_move() || !proved_.problem.time) continue;
    const TimeText::Limit& limit = proved_.problem.time->winch_speed_m_s[i];
    if (limit) winch_speed_[i] = evaluate_constant<double>(*limit);
  }
}

PlaceTarget Monitor::target_of(const MeasuredRow& row) const {
  PlaceTarget target;
  for (std::size_t i = 0; i < kCables; ++i) {
    if (!row.length_m[i]) continue;
    target.mask |= PlaceTarget::bit(i);
    target.length[i] = *row.length_m[i];
    target.length_allowed[i] = length_allowed_[i];
  }
  if (!row.pose) return target;
  RigidPose pose = *row.pose;
  pose.q.normalize();
  if (is_length_controlled()) {
    // The tolerances say nothing of where the platform is, but of which lengths it has there.
    const std::array<double, kCables> lengths = cable_lengths(sampler_.model(), pose);
    for (std::size_t i = 0; i < kCables; ++i) {
      target.mask |= PlaceTarget::bit(kCables + i);
      target.length[kCables + i] = lengths[i];
      target.length_allowed[kCables + i] = pose_allowed_[i];
    }
    return target;
  }
  target.mask |= PlaceTarget::bit(PlaceTarget::kPosition) | PlaceTarget::bit(PlaceTarget::kTurn);
  target.position = pose.p;
  target.position_allowed = position_allowed();
  target.turn = pose.q.coeffs();
  target.turn_allowed = chord(orientation_allowed());
  return target;
}

double Monitor::first_time(double s) const { return s <= 0 ? 0 : MoveSampler::time_of(*proved_.path.timing, s); }

double Monitor::last_time(double s) const {
  const TimeLaw& law = *proved_.path.timing;
  double from = 0, to = law.duration_s();
  constexpr int kHalvings = 60;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (from + to);
    (at_time(law, middle).s <= s ? from : to) = middle;
  }
  return to;
}

Monitor::Places Monitor::all_places(const PlaceTarget& target) const {
  return table_.places(target, target.mask, 0, table_.cells());
}

Monitor::Places Monitor::reachable(double time_s) const {
  const double passed = time_s - *last_time_s_ + 2 * errors_.time_s + kRounding_s;
  const auto end = static_cast<double>(proved_.path.segments());
  Places result;
  for (const PlaceInterval& from : places_) {
    const double time = last_time(from.upper) + passed;
    const double to = time >= proved_.path.timing->duration_s() ? end : at_time(*proved_.path.timing, time).s;
    if (!result.empty() && result.back().upper >= from.lower) {
      result.back().upper = std::max(result.back().upper, to);
    } else {
      result.push_back({from.lower, std::max(from.upper, to)});
    }
  }
  return result;
}

Monitor::Places Monitor::places_among(const PlaceTarget& target, const Places& among) const {
  constexpr double kShareOfRounding = 1e-12;  // of a place
  Places result;
  for (const PlaceInterval& part : among) {
    const std::size_t first = table_.cell_at(part.lower), end = table_.cell_at(part.upper) + 1;
    for (PlaceInterval found : table_.places(target, target.mask, first, end)) {
      found.lower = std::max(found.lower, part.lower * (1 - kShareOfRounding));
      found.upper = std::min(found.upper, part.upper * (1 + kShareOfRounding));
      if (found.lower <= found.upper) result.push_back(found);
    }
  }
  return result;
}

const PlaceInterval& Monitor::nearest(const Places& places) const {
  return *std::ranges::min_element(places, {}, [&](const PlaceInterval& part) {
    return std::max({0.0, part.lower - last_place_, last_place_ - part.upper});
  });
}

Alarm Monitor::off_path_alarm(const PlaceTarget& target, std::size_t check, double s) const {
  const PlaceTable::Node here = table_.at(s);
  Alarm alarm;
  if (check < PlaceTarget::kLengths) {
    alarm.cable = static_cast<int>(check % kCables);
    const double length = here.length[check % kCables], allowed = target.length_allowed[check];
    alarm.measured = target.length[check];
    alarm.lower = length - allowed;
    alarm.upper = length + allowed;
  } else if (check == PlaceTarget::kPosition) {
    alarm.kind = AlarmKind::kPosition;
    alarm.measured = (target.position - here.pose.p).norm();
    alarm.upper = position_allowed();
  } else {
    alarm.kind = AlarmKind::kOrientation;
    alarm.measured = Eigen::Quaterniond(target.turn).angularDistance(here.pose.q);
    alarm.upper = orientation_allowed();
  }
  return alarm;
}

void Monitor::add_off_path(const PlaceTarget& target, RowVerdict& verdict) const {
  // If all fit a place but one gauge, it is that one.
  std::vector<PlaceTarget::Mask> suspects;
  for (std::size_t k = 0; k < PlaceTarget::kChecks; ++k) {
    const PlaceTarget::Mask one = PlaceTarget::bit(k);
    if (k / kCables == 1) continue;  // lengths of a measured pose are one gauge
    if ((target.mask & one) != 0 && (target.mask & ~one) != 0) suspects.push_back(one);
  }
  constexpr PlaceTarget::Mask kPoseLengths = ((1U << kCables) - 1) << kCables;
  if ((target.mask & kPoseLengths) != 0 && (target.mask & ~kPoseLengths) != 0) suspects.push_back(kPoseLengths);
  std::optional<PlaceTable::Fit> best;
  PlaceTarget::Mask blamed = 0;
  for (const PlaceTarget::Mask suspect : suspects) {
    const PlaceTarget::Mask others = target.mask & ~suspect;
    // One or two numbers fit somewhere by chance.
    if (std::popcount(others) < 3 || table_.places(target, others, 0, table_.cells()).empty()) continue;
    const PlaceTable::Fit fit = table_.best_fit(target, others, 0, table_.cells());
    if (best && best->factor <= fit.factor) continue;
    best = fit;
    blamed = suspect;
  }
  const PlaceTable::Fit fit = best ? *best : table_.best_fit(target, target.mask, 0, table_.cells());
  const PlaceTarget::Mask among = best ? blamed : target.mask;
  Alarm worst;
  double furthest = -1;
  for (std::size_t k = 0; k < PlaceTarget::kChecks; ++k) {
    if ((among & PlaceTarget::bit(k)) == 0) continue;
    const Alarm alarm = off_path_alarm(target, k, fit.s);
    const double middle = alarm.kind == AlarmKind::kLength ? 0.5 * (alarm.lower + alarm.upper) : 0;
    const double allowed = std::max(alarm.upper - middle, 1e-9);
    if (const double off = std::abs(alarm.measured - middle) / allowed; off > furthest) {
      furthest = off;
      worst = alarm;
    }
  }
  worst.is_alone = best.has_value();
  verdict.place = fit.s;
  verdict.shares.place = furthest;
  verdict.alarms.push_back(worst);
}

void Monitor::locate(const MeasuredRow& row, const PlaceTarget& target, Places& places, RowVerdict& verdict) {
  const bool has_history = is_move() && row.time_s && last_time_s_ && !places_.empty();
  if (has_history) {
    const Places may_be = reachable(*row.time_s);
    places = places_among(target, may_be);
    if (places.empty()) {
      places = all_places(target);
      if (places.empty()) {
        add_off_path(target, verdict);
        places_ = may_be;  // it may have come so far meanwhile
      } else {
        const PlaceInterval& found = nearest(places);
        Alarm alarm;
        if (found.upper < may_be.front().lower) {
          alarm.kind = AlarmKind::kBackwards;
          alarm.measured = found.upper;
          alarm.lower = may_be.front().lower;
          alarm.upper = may_be.back().upper;
        } else {
          alarm.kind = AlarmKind::kAhead;
          double least = HUGE_VAL;
          for (const PlaceInterval& from : places_) {
            if (from.lower <= found.upper) least = std::min(least, first_time(found.lower) - last_time(from.upper));
          }
          alarm.measured = least;
          alarm.upper = *row.time_s - *last_time_s_ + 2 * errors_.time_s;
        }
        verdict.alarms.push_back(alarm);
      }
    }
  } else {
    if (has_place_) {
      const std::size_t cell = table_.cell_at(last_place_);
      places = table_.places(target, target.mask, cell - std::min(cell, kCellsNearby),
                             std::min(cell + kCellsNearby, table_.cells()));
    }
    if (places.empty()) places = all_places(target);
    if (places.empty()) add_off_path(target, verdict);
  }
  if (!places.empty()) places_ = places;
  if (is_move() && row.time_s) last_time_s_ = row.time_s;
}

void Monitor::check_winches(const MeasuredRow& row, RowVerdict& verdict) {
  if (!row.time_s) return;
  for (std::size_t i = 0; i < kCables; ++i) {
    if (!winch_speed_[i] || !row.length_m[i]) continue;
    const double v = *winch_speed_[i], length = *row.length_m[i], time = *row.time_s;
    // Each of two lengths is off by so much; clocks, by time_s each.
    const double off = 2 * length_allowed_[i] + v * (2 * errors_.time_s + kRounding_s) + 1e-9;
    const LengthAt now{time, length};
    std::optional<Envelope>& envelope = envelopes_[i];
    if (!envelope) envelope = {now, now};
    const auto falling = [&](const LengthAt& x) { return x.length_m - v * x.time_s; };
    const auto rising = [&](const LengthAt& x) { return x.length_m + v * x.time_s; };
    const double out = falling(now) - falling(envelope->least), in = rising(envelope->greatest) - rising(now);
    if (std::max(out, in) > off) {
      const LengthAt& before = out > in ? envelope->least : envelope->greatest;
      Alarm alarm;
      alarm.kind = AlarmKind::kWinchSpeed;
      alarm.cable = static_cast<int>(i);
      alarm.measured = std::abs(length - before.length_m);
      alarm.over_s = time - before.time_s;
      alarm.upper = v * alarm.over_s + off;
      verdict.alarms.push_back(alarm);
      envelope = {now, now};
      continue;
    }
    if (out < 0) envelope->least = now;
    if (in < 0) envelope->greatest = now;
  }
}

std::vector<Alarm> Monitor::check_tensions(const MeasuredRow& row, const PlaceInterval& places, double s,
                                           ResidualShares& shares) const {
  if (std::ranges::none_of(row.tension_N, [](const auto& tension) { return tension.has_value(); })) return {};
  constexpr double kShareOfRounding = 1e-12;
  const auto share_in = [&](const PlaceTable::Piece& piece, std::size_t i) {
    const double middle = 0.5 * (piece.tension[i][0] + piece.tension[i][1]);
    const double half =
        0.5 * (piece.tension[i][1] - piece.tension[i][0]) + errors_.tension_N + kShareOfRounding * std::abs(middle);
    return std::abs(*row.tension_N[i] - middle) / half;
  };
  // That piece in which the worst of all tensions is best.
  const PlaceTable::Piece* best = nullptr;
  double least = HUGE_VAL, least_distance = HUGE_VAL;
  for (const PlaceTable::Piece& piece : table_.pieces_at(places)) {
    double worst = 0;
    for (std::size_t i = 0; i < kCables; ++i) {
      if (row.tension_N[i]) worst = std::max(worst, share_in(piece, i));
    }
    const double distance = std::max({0.0, piece.lower - s, s - piece.upper});
    // Of pieces without an alarm the nearest.
    const double rank = std::max(worst, 1.0);
    if (rank < least || (rank == least && distance < least_distance)) {
      least = rank;
      least_distance = distance;
      best = &piece;
      shares.tension = worst;
    }
  }
  std::vector<Alarm> alarms;
  for (std::size_t i = 0; best != nullptr && i < kCables; ++i) {
    if (!row.tension_N[i] || !(share_in(*best, i) > 1)) continue;
    Alarm alarm;
    alarm.kind = AlarmKind::kTension;
    alarm.cable = static_cast<int>(i);
    alarm.measured = *row.tension_N[i];
    alarm.lower = best->tension[i][0] - errors_.tension_N;
    alarm.upper = best->tension[i][1] + errors_.tension_N;
    alarms.push_back(alarm);
  }
  return alarms;
}

std::vector<Alarm> Monitor::check_load(const MeasuredRow& row, const PlaceInterval& places, double s,
                                       ResidualShares& shares) const {
  std::array<double, kCables> tension;
  for (std::size_t i = 0; i < kCables; ++i) {
    if (!row.tension_N[i]) return {};
    tension[i] = *row.tension_N[i];
  }
  if (is_length_controlled() && !row.pose) return {};  // then the tolerances do not say where the platform is
  const PlaceTable::Node here = table_.at(s);
  const PlaceTable::Spread spread = table_.spread(places, here);
  WrenchTest::Place place;
  place.commanded_turn = tolerances_.orientation;
  if (row.pose) {
    place.pose = *row.pose;
    place.pose.q.normalize();
    place.position_off = errors_.position_m;
    place.turn_off = errors_.orientation_rad;
    if (is_length_controlled()) {
      place.commanded_turn = place.pose.q.angularDistance(here.pose.q) + place.turn_off + spread.turn;
    }
  } else {
    place.pose = here.pose;
    place.position_off = tolerances_.position + spread.position;
    place.turn_off = tolerances_.orientation + spread.turn;
  }
  if (is_move()) {
    place.places = {s};
    constexpr int kPlaces = 5;
    for (int k = 0; k < kPlaces && places.upper > places.lower; ++k) {
      place.places.push_back(places.lower + (places.upper - places.lower) * k / (kPlaces - 1));
    }
  }
  const WrenchVerdict verdict = load_.judge(proved_.path, place, tension, errors_.tension_N);
  shares.load = verdict.share;
  if (!verdict.is_outside) return {};
  Alarm alarm;
  alarm.kind = AlarmKind::kLoad;
  alarm.measured = verdict.residual;
  alarm.upper = verdict.allowed;
  alarm.guess = verdict.guess;
  return {alarm};
}

RowVerdict Monitor::judge(const MeasuredRow& row) {
  RowVerdict verdict;
  const PlaceTarget target = target_of(row);
  if (!has_place_ && is_move() && row.time_s) last_place_ = at_time(*proved_.path.timing, *row.time_s).s;
  Places places;
  locate(row, target, places, verdict);
  check_winches(row, verdict);
  const auto forces = [&](const Places& candidates) {
    // Some of them may be apart, as where a path crosses itself: the row is good if it is good at one.
    std::optional<RowVerdict> first;
    Places left = candidates;
    while (!left.empty()) {
      const PlaceInterval part = nearest(left);
      RowVerdict here;
      const std::size_t begin = table_.cell_at(part.lower), end = table_.cell_at(part.upper) + 1;
      const PlaceTable::Fit fit = table_.best_fit(target, target.mask, begin, end);
      here.place = std::clamp(fit.s, part.lower, part.upper);
      here.shares.place = fit.factor;
      here.alarms = check_tensions(row, part, *here.place, here.shares);
      std::ranges::move(check_load(row, part, *here.place, here.shares), std::back_inserter(here.alarms));
      if (!first || here.is_good()) first = here;
      if (here.is_good()) break;
      std::erase_if(left, [&](const PlaceInterval& other) { return other.lower == part.lower; });
    }
    return first;
  };
  if (std::optional<RowVerdict> found = forces(places); found) {
    const bool is_timed = is_move() && row.time_s;
    if (!found->is_good() && !is_timed) {
      if (const std::optional<RowVerdict> elsewhere = forces(all_places(target)); elsewhere && elsewhere->is_good()) {
        found = elsewhere;
      }
    }
    verdict.place = found->place;
    verdict.shares = found->shares;
    std::ranges::move(found->alarms, std::back_inserter(verdict.alarms));
    last_place_ = *found->place;
    has_place_ = true;
  }
  if (is_move() && verdict.place) {
    verdict.law_s = first_time(*verdict.place);
    if (row.time_s) verdict.lead_s = *verdict.law_s - *row.time_s;
  }
  return verdict;
}

}  // namespace taut
