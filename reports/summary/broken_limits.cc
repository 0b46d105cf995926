// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/broken_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iterator>
#include <limits>

#include "certify/severity.h"
#include "problem/expression.h"
#include "reports/summary/hints.h"
#include "reports/summary/numbers.h"
#include "reports/summary/sentences.h"
#include "reports/summary/time_statement.h"
#include "reports/summary/wording.h"

namespace taut {
namespace {

/// Whether both are about the same limit, and proved of poses of the same standing.
bool is_same(const BrokenLimit& a, const BrokenLimit& b) {
  if (a.is_reached != b.is_reached) return false;
  if (a.is_singular || b.is_singular) return a.is_singular && b.is_singular;
  if (a.bodies || b.bodies) return a.bodies && b.bodies && a.bodies->pair == b.bodies->pair;
  if (a.rate || b.rate) return a.rate == b.rate;
  return a.margin == b.margin;
}

bool is_same(const PathPoint& a, const PathPoint& b) {
  return a.on_segment == b.on_segment && a.index == b.index && a.s == b.s;
}

/// Whether the move is proved to pass the poses of a witness of a stretch: where poses are implied, those of the
/// certificate's own.
bool is_reached(const Certificate& certificate, const PathWitness& witness) {
  if (!is_implied(certificate)) return true;
  if (!certificate.witness) return false;
  const PathWitness& own = certificate.witness->violation;
  return is_same(witness.at, own.at) && witness.singular == own.singular &&
         (!witness.singular || is_same(witness.to, own.to));
}

/// Graver than any limit that is not next to a singular pose, and the graver the nearer.
double severity_of(const BodyDistance& bodies) {
  constexpr double kGrave = 1e9;
  return kGrave - bodies.left();
}

void set_bodies(const ReportContext& scene, BrokenLimit& broken, const BodyDistance& bodies) {
  broken.bodies = bodies;
  broken.limit = asked_exactly(bodies, pairs(*scene.certificate.problem.bodies).at(bodies.pair));
  broken.value = bodies.distance;
  broken.severity = severity_of(bodies);
}

/// What the witness alone says, where a mesh is not there to measure.
BodyDistance proved_distance(const ReportContext& scene, const PathWitness& witness) {
  BodyDistance result;
  result.pair = witness.contact->pair;
  result.clearance = nearest_double(pairs(*scene.certificate.problem.bodies).at(result.pair).clearance_m);
  result.distance = std::max(0.0, result.clearance - nearest_double(witness.depth_m));
  return result;
}

BrokenLimit broken_limit(const ReportContext& scene, const PathWitness& witness) {
  BrokenLimit broken;
  broken.proof = witness;
  broken.is_singular = witness.singular;
  broken.is_reached = is_reached(scene.certificate, witness);
  broken.position = broken.to = position(witness.at);
  if (witness.contact) {
    set_bodies(
        scene, broken,
        scene.bodies ? distance_at(scene, broken.position, witness.contact->pair) : proved_distance(scene, witness));
    return broken;
  }
  broken.severity = taut::severity_of(witness, scene.certificate.problem);
  if (witness.singular) {
    broken.to = position(witness.to);
    return broken;
  }
  if (witness.rate) {
    broken.rate = witness.rate;
    broken.value = nearest_double(witness.value_lower);
    return broken;
  }
  broken.margin = witness.margin;
  broken.limit = witness.limit;
  broken.value = nearest_double(is_upper(witness.margin) ? witness.value_lower : witness.value_upper);
  return broken;
}

/// Adds a limit, or keeps the graver of what is known of it.
void add(std::vector<BrokenLimit>& all, BrokenLimit broken) {
  const auto known = std::ranges::find_if(all, [&](const BrokenLimit& other) { return is_same(other, broken); });
  if (known == all.end()) {
    all.push_back(std::move(broken));
  } else if (broken.severity > known->severity) {
    *known = std::move(broken);
  }
}

/// What the witnesses of a stretch break; with them the certificate's own, which may be inside the stretch.
std::vector<BrokenLimit> broken_in(const ReportContext& scene, const Stretch& stretch) {
  std::vector<BrokenLimit> result;
  if (!stretch.violations) return result;
  add(result, broken_limit(scene, stretch.violations->first.violation));
  add(result, broken_limit(scene, stretch.violations->second.violation));
  if (!scene.certificate.witness) return result;
  BrokenLimit gravest = broken_limit(scene, scene.certificate.witness->violation);
  const auto [from, to] = std::minmax(gravest.position, gravest.to);
  if (from >= position(stretch.begin) && to <= position(stretch.end)) add(result, std::move(gravest));
  return result;
}

std::vector<BrokenLimit> proved_limits(const ReportContext& scene) {
  std::vector<BrokenLimit> all;
  if (scene.certificate.witness) add(all, broken_limit(scene, scene.certificate.witness->violation));
  for (const Stretch& stretch : scene.certificate.stretches) {
    for (BrokenLimit& broken : broken_in(scene, stretch)) {
      const auto known = std::ranges::find_if(all, [&](const BrokenLimit& other) { return is_same(other, broken); });
      broken.stretches = known == all.end() ? 1 : ++known->stretches;
      add(all, std::move(broken));
    }
  }
  return all;
}

/// Where det J is 0 in a sample, or first changes its sign between two.
std::optional<BrokenLimit> sampled_singular_pose(const ReportContext& scene) {
  BrokenLimit broken;
  broken.is_singular = true;
  broken.severity = std::numeric_limits<double>::infinity();
  if (const std::vector<double> changes = sign_changes(scene.samples); !changes.empty()) {
    broken.to = changes.front();
    for (const PathSample& sample : scene.samples) {
      if (sample.position < broken.to && sample.statics.regular) broken.position = sample.position;
    }
    return broken;
  }
  const auto singular = std::ranges::find_if(
      scene.samples, [&](const PathSample& s) { return is_nearly_singular(scene.sampler.model(), s.statics); });
  if (singular == scene.samples.end()) return std::nullopt;
  broken.position = broken.to = singular->position;
  return broken;
}

std::vector<BrokenLimit> sampled_limits(const ReportContext& scene) {
  std::vector<BrokenLimit> all;
  if (auto singular = sampled_singular_pose(scene)) all.push_back(*std::move(singular));
  const Model<double>& model = scene.sampler.model();
  const RobotText& robot = scene.certificate.problem.robot;
  for (const PathSample& sample : scene.samples) {
    const bool has_tensions = !is_nearly_singular(model, sample.statics);
    for (const MarginId margin : all_margins()) {
      if (!is_length(margin) && !has_tensions) continue;
      BrokenLimit broken;
      broken.margin = margin;
      broken.value = limited_quantity(sample.statics, margin);
      const double beyond = -slack(model, broken.value, margin);
      if (!(beyond >= 0)) continue;
      const Limits& limits = limits_of(robot, margin);
      broken.limit = is_upper(margin) ? limits.upper : limits.lower;
      broken.severity = beyond / (nearest_double(limits.upper) - nearest_double(limits.lower));
      broken.position = broken.to = sample.position;
      add(all, std::move(broken));
    }
  }
  return all;
}

/// Of a move, what samples show to be too fast: of winches the one that uses most of its limit.
std::vector<BrokenLimit> sampled_rates(const ReportContext& scene) {
  std::vector<BrokenLimit> all;
  for (const RateUse& use : rate_uses(scene)) {
    if (!(use.share() >= 1)) continue;
    BrokenLimit& broken = all.emplace_back();
    broken.rate = use.limit.id;
    broken.value = use.size;
    broken.severity = use.share() - 1;
    broken.position = broken.to = use.position;
  }
  return all;
}

/// Of the pairs that come nearest, those that samples show too near.
std::vector<BrokenLimit> sampled_contacts(const ReportContext& scene) {
  std::vector<BrokenLimit> all;
  const DistancesAlong& along = scene.distances;
  for (std::size_t n = 0; n < along.nearest.size(); ++n) {
    const double position = scene.samples[along.nearest_at[n]].position;
    const BodyDistance bodies = distance_at(scene, position, along.nearest[n]);
    if (bodies.left() > 0) continue;
    BrokenLimit& broken = all.emplace_back();
    broken.position = broken.to = position;
    set_bodies(scene, broken, bodies);
  }
  return all;
}

void sort_by_severity(std::vector<BrokenLimit>& limits) {
  std::ranges::stable_sort(limits, std::greater<>(), &BrokenLimit::severity);
}

}  // namespace

BodyDistance distance_at(const ReportContext& scene, double position, std::size_t pair) {
  const PathSample sample = scene.sampler.at(scene.certificate.path, position);
  return scene.bodies.value().at(scene.sampler.model(), scene.sampler.rigid_pose(sample), pair);
}

std::vector<BrokenLimit> broken_limits(const ReportContext& scene) {
  std::vector<BrokenLimit> result = proved_limits(scene);
  sort_by_severity(result);
  std::ranges::stable_partition(result, &BrokenLimit::is_reached);
  const Certificate& certificate = scene.certificate;
  const bool is_shown = !found_no_path(certificate) && certificate.path.interpolation != Interpolation::kCableLengths;
  if (!is_shown || certificate.verdict == Verdict::kProved) return result;
  std::vector<BrokenLimit> sampled = sampled_limits(scene);
  std::ranges::move(sampled_contacts(scene), std::back_inserter(sampled));
  std::ranges::move(sampled_rates(scene), std::back_inserter(sampled));
  sort_by_severity(sampled);
  const std::size_t proved = result.size();
  for (BrokenLimit& broken : sampled) {
    const auto is_known = [&](const BrokenLimit& other) { return is_same(other, broken); };
    if (std::any_of(result.begin(), result.begin() + static_cast<std::ptrdiff_t>(proved), is_known)) continue;
    result.push_back(std::move(broken));
  }
  return result;
}

std::string what_text(const BrokenLimit& broken) {
  const bool deviates = broken.proof && broken.proof->deviation;
  const char* const machine = deviates ? "on a machine within the tolerances" : "";
  if (broken.is_singular) return machine;
  if (broken.bodies && broken.bodies->is_in_cone) return "is left";
  if (broken.bodies) return broken.bodies->distance < 0 ? "in each other" : "nearer than their clearance";
  const bool upper = !broken.rate && is_upper(broken.margin);
  const char* const what = broken.rate                ? too_fast_text(broken.rate->kind)
                           : is_length(broken.margin) ? (upper ? "too long" : "too short")
                           : upper                    ? "above its top tension"
                                                      : "below its slack limit";
  return fmt::format("{}{}{}", what, deviates ? ", " : "", machine);
}

std::string subject_text(const ReportContext& scene, const BrokenLimit& broken) {
  if (broken.is_singular) return "Singular pose";
  if (broken.bodies) {
    const BodiesText& bodies = *scene.certificate.problem.bodies;
    return name(bodies, pairs(bodies).at(broken.bodies->pair));
  }
  if (broken.rate) return subject_of(*broken.rate);
  return fmt::format("Cable {}", broken.margin.cable + 1);
}

std::string amount_text(const ReportContext& scene, const BrokenLimit& broken) {
  if (broken.is_singular) return "the cables cannot balance every load";
  if (broken.bodies) {
    const DisplayUnit& length = scene.illustration.units.length;
    return fmt::format("{}; {}", apart_text(*broken.bodies, length),
                       asked_text(*broken.bodies, *scene.certificate.problem.bodies, length));
  }
  const DisplayUnits& units = scene.illustration.units;
  const Problem& problem = scene.certificate.problem;
  if (broken.rate && broken.proof) {
    return fmt::format("at least {}; limit {}", rate_value_text(*broken.proof, problem, units),
                       rate_limit_text(*problem.time, *broken.rate, units));
  }
  if (broken.rate) {
    const ExpressionText& text = limit_of(*problem.time, *broken.rate);
    return fmt::format("about {}; limit {}",
                       size_text({{*broken.rate, text, evaluate_constant<double>(text)}, broken.value}, units),
                       rate_limit_text(*problem.time, *broken.rate, units));
  }
  const bool length = is_length(broken.margin);
  const DisplayUnit& unit = units.of(length);
  const std::string limit = fmt::format("limit {} {}", unit.exact(broken.limit), unit.name());
  if (!broken.proof) {
    return fmt::format("about {} {}; {}", sampled_text(broken.value, nearest_double(broken.limit), unit), unit.name(),
                       limit);
  }
  if (is_all_but_singular(*broken.proof, scene.certificate.problem)) {
    return fmt::format("{} a million times the greatest limit, next to a singular pose; {}",
                       is_upper(broken.margin) ? "more than" : "below minus", limit);
  }
  return fmt::format("at {} {}; {}", is_upper(broken.margin) ? "least" : "most",
                     value_text(*broken.proof, scene.illustration.units), limit);
}

std::string where_text(const ReportContext& scene, const BrokenLimit& broken) {
  std::string text = place_in_full(scene, broken.position, broken.to);
  if (const std::string rows = rows_text(scene, broken.position); !rows.empty()) text += "; " + rows;
  if (broken.bodies && scene.bodies) {
    const DisplayUnit& length = scene.illustration.units.length;
    const auto& [first, second] = broken.bodies->at;
    text += broken.bodies->distance < 0 ? fmt::format("; about {}", point_in_space(first, length))
                                        : fmt::format("; between about {} and {}", point_in_space(first, length),
                                                      point_in_space(second, length));
  }
  if (broken.stretches > 1) text += fmt::format("; in {} stretches", broken.stretches);
  return text;
}

std::string known_by(const BrokenLimit& broken) {
  if (!broken.is_proved()) return "samples";
  return broken.is_reached ? "proved" : "proved of the pose in its tube, not that the move leads there";
}

std::string rows_text(const ReportContext& scene, double position) {
  const auto& source = scene.certificate.source;
  if (!source) return "";
  const auto last = static_cast<double>(scene.certificate.path.segments());
  const double at = std::clamp(position, 0.0, last);
  const auto before = scene.illustration.lines.line_of(static_cast<std::size_t>(std::floor(at)));
  const auto behind = scene.illustration.lines.line_of(static_cast<std::size_t>(std::ceil(at)));
  if (!before || !behind) return "";
  return *before == *behind ? fmt::format("line {}", *before) : fmt::format("lines {}-{}", *before, *behind);
}

std::string audited_file(const ReportContext& scene) {
  const auto& source = scene.certificate.source;
  return source ? std::filesystem::path(source->file).filename().string() : "";
}

std::string table_text(const ReportContext& scene) {
  const auto& table = scene.illustration.table;
  if (!table || !scene.certificate.source || !scene.certificate.path.timing) return "";
  return fmt::format(
      "The move was fitted to the table {}: all {} of its rows lie within {} of {} at their times, says the program "
      "that fitted it; the checker is not told of rows. {}",
      audited_file(scene), table->rows, table->rounding, table->is_of_lengths ? "its cable lengths" : "it",
      scene.certificate.problem.time->rows
          ? "What is said of tensions, lengths, clearances and singular poses is about lengths that run straight from "
            "row "
            "to row of such a table, too."
          : "The rows' last digits, and how a drive joins the rows, are no part of the move.");
}

}  // namespace taut
