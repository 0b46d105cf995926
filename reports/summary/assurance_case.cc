// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/assurance_case.h"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "base/plural.h"
#include "reports/summary/bodies_statement.h"
#include "reports/summary/load_statement.h"
#include "reports/summary/scope.h"
#include "reports/summary/sentences.h"
#include "reports/summary/time_statement.h"
#include "reports/summary/wording.h"

namespace taut {
namespace {

using Kind = AssuranceNode::Kind;

/// Nodes, numbered by kind as they are added.
class Builder {
 public:
  /// @returns the id
  std::string add(Kind kind, const std::string& text, const std::string& label = "") {
    AssuranceNode node;
    node.kind = kind;
    node.id = fmt::format("{}{}", prefix(kind), ++counts_[kind]);
    node.text = text;
    node.label = label.empty() ? text : label;
    nodes_.push_back(node);
    return node.id;
  }
  std::string add_undeveloped(const std::string& text) {
    const std::string id = add(Kind::kGoal, text);
    nodes_.back().is_undeveloped = true;
    return id;
  }
  void support(const std::string& goal, const std::string& by) { node(goal).supported_by.push_back(by); }
  void put_in_context(const std::string& goal, const std::string& of) { node(goal).in_context_of.push_back(of); }
  [[nodiscard]] std::vector<AssuranceNode> nodes() && { return std::move(nodes_); }

 private:
  static const char* prefix(Kind kind) {
    switch (kind) {
      case Kind::kGoal: return "G";
      case Kind::kStrategy: return "S";
      case Kind::kSolution: return "Sn";
      case Kind::kContext: return "C";
      case Kind::kAssumption: return "A";
      case Kind::kJustification: break;
    }
    return "J";
  }
  AssuranceNode& node(const std::string& id) {
    for (AssuranceNode& node : nodes_) {
      if (node.id == id) return node;
    }
    return nodes_.emplace_back();
  }

  std::map<Kind, int> counts_;
  std::vector<AssuranceNode> nodes_;
};

std::string capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string short_digest(const std::string& digest) { return digest.substr(0, 8) + "…"; }

/// What the claim is about, and under which assumptions.
void add_scope(Builder& builder, const ReportContext& scene, const std::string& claim) {
  const Certificate& certificate = scene.certificate;
  const DisplayUnits& units = scene.illustration.units;
  const auto context = [&](const std::string& text, const std::string& label) {
    builder.put_in_context(claim, builder.add(Kind::kContext, text, label));
  };
  context(fmt::format("Machine and limits: the exact numbers of the certificate's problem, SHA-256 {}.",
                      certificate.problem_sha256),
          fmt::format("Machine and limits: as stated (problem {})", short_digest(certificate.problem_sha256)));
  const LoadStatement load = stated_load(certificate);
  context(fmt::format("Loads: {} {}{}{}", load.total, load.spread, load.inertia.empty() ? "" : " ", load.inertia),
          load.inertia.empty() ? "Loads: all of the stated set" : "Loads: all of the stated set, with its inertia");
  if (is_move(certificate)) {
    const TimeLaw& law = *certificate.path.timing;
    context(
        fmt::format("{} The move takes T = {}: a cubic B-spline of time with {} control values, part of the path.",
                    time_limits_text(*certificate.problem.time, units), seconds_text(law.duration_s()),
                    law.controls.size()),
        fmt::format("Time: T = {}; limits of speed, acceleration and power as stated", seconds_text(law.duration_s())));
  }
  context(fmt::format("Tolerances: {}", tolerances_text(certificate.problem.tolerances, units)),
          certificate.problem.tolerances ? "Tolerances: as stated, all at once" : "Tolerances: none");
  if (certificate.problem.bodies) {
    const std::size_t count = pairs(*certificate.problem.bodies).size();
    context(fmt::format("Bodies: {}", bodies_text(certificate.problem)),
            fmt::format("Bodies: as stated, {} checked{}", plural(count, "pair"),
                        unchecked_classes(*certificate.problem.bodies).empty() ? "" : "; some classes are not"));
  }
  context(fmt::format("Path: {}, the exact waypoints of the certificate's path, SHA-256 {}.",
                      plural(certificate.path.segments(), "segment"), certificate.path_sha256),
          fmt::format("Path: {} (path {})", plural(certificate.path.segments(), "segment"),
                      short_digest(certificate.path_sha256)));
  for (const ScopeItem& item : assumed(certificate)) {
    builder.put_in_context(claim, builder.add(Kind::kAssumption, item.text, capitalised(item.brief)));
  }
}

/// How the claim is shown.
void add_proof(Builder& builder, const ReportContext& scene, const std::string& claim) {
  const Certificate& certificate = scene.certificate;
  const std::string boxes = plural(count_boxes(certificate), "box");
  const std::string by_boxes =
      builder.add(Kind::kStrategy,
                  fmt::format("Argument over all of the path: it is divided into {}, pieces that leave no gap; nothing "
                              "is sampled.",
                              boxes),
                  fmt::format("Argue over {} that cover the whole path; nothing is sampled", boxes));
  builder.support(claim, by_boxes);
  builder.put_in_context(
      by_boxes,
      builder.add(Kind::kJustification,
                  "Interval arithmetic with outward rounding encloses every tension and length over a whole box, and "
                  "how far bodies are apart, for every stated load and deviation. The theorems and their proofs are in "
                  "docs/theory.md.",
                  "Interval arithmetic with outward rounding encloses every value over a box (docs/theory.md)"));
  builder.put_in_context(
      by_boxes, builder.add(Kind::kJustification,
                            "The program that searched is not believed: a second program, with equations, parser and "
                            "arithmetic of its own, proves each box again.",
                            "A second program, with equations and arithmetic of its own, proves each box again"));
  const bool has_bodies = certificate.problem.bodies.has_value();
  const bool in_time = is_move(certificate);
  const std::string each = builder.add(
      Kind::kGoal,
      fmt::format(
          "The boxes cover the path without gaps. Over each of them, {}every tension and every length is strictly "
          "inside its limits, {}{}the force Jacobian is not singular{}.",
          in_time ? "at all times at which the move is there, " : "",
          in_time ? "every speed, acceleration and power is below the limit that is stated of it, " : "",
          has_bodies ? "" : "and ",
          has_bodies ? fmt::format(", and the bodies of every checked pair are farther apart than their clearance{}",
                                   but_in_contacts(*certificate.problem.bodies))
                     : ""),
      fmt::format("The boxes leave no gap; over each, tensions and lengths{} are inside their limits{} det J ≠ 0{}",
                  in_time ? " and rates" : "", has_bodies ? "," : " and", has_bodies ? ", bodies apart" : ""));
  builder.support(by_boxes, each);
  const Margins& margins = *certificate.margins;
  builder.support(
      each,
      builder.add(Kind::kSolution,
                  fmt::format("The certificate, SHA-256 {}. {}", certificate.footer_sha256,
                              margins_text(margins.tension_N, margins.length_m, in_time ? "" : margins.wrench_scale,
                                           scene.illustration.units, margins.clearance_m)),
                  fmt::format("Certificate: {}, SHA-256 {}", boxes, short_digest(certificate.footer_sha256))));
  builder.support(each, builder.add(Kind::kSolution,
                                    fmt::format("{} proved the certificate again: {}.", scene.recheck.checker,
                                                scene.recheck.message),
                                    fmt::format("{}: proved again, accepted", scene.recheck.checker)));
}

}  // namespace

std::vector<AssuranceNode> assurance_case(const ReportContext& scene, const std::string& title) {
  if (scene.verdict != "proved" || !scene.certificate.margins) return {};
  Builder builder;
  const std::string top = builder.add(Kind::kGoal, fmt::format("The move “{}” is acceptably safe.", title));
  const std::string hazards = builder.add(
      Kind::kStrategy,
      "Argument over what the certificate proves and, one by one, over what it does not cover, which others have to "
      "show.",
      "Argue over what is proved and, one by one, over what is not covered");
  builder.support(top, hazards);
  const bool has_tolerances = scene.certificate.problem.tolerances.has_value();
  const bool has_bodies = scene.certificate.problem.bodies.has_value();
  const bool in_time = is_move(scene.certificate);
  const std::string claim = builder.add(
      Kind::kGoal,
      fmt::format(
          "At every {} of the move, under every stated load{}, all six tensions and all six lengths are "
          "strictly inside their limits, {}{}no singular pose is met{}.",
          in_time ? "time" : "pose",
          std::string(in_time ? " with its inertia" : "") +
              (has_tolerances ? " and for every machine within the tolerances" : ""),
          in_time ? "every stated limit of speed, acceleration and power is kept, " : "", has_bodies ? "" : "and ",
          has_bodies ? fmt::format(", and the bodies of every checked pair are farther apart than their clearance{}",
                                   but_in_contacts(*scene.certificate.problem.bodies))
                     : ""));
  builder.support(hazards, claim);
  add_scope(builder, scene, claim);
  add_proof(builder, scene, claim);
  for (const ScopeItem& item : not_covered(scene.certificate)) {
    builder.support(hazards, builder.add_undeveloped(item.goal));
  }
  return std::move(builder).nodes();
}

const char* name(AssuranceNode::Kind kind) {
  switch (kind) {
    case Kind::kGoal: return "goal";
    case Kind::kStrategy: return "strategy";
    case Kind::kSolution: return "solution";
    case Kind::kContext: return "context";
    case Kind::kAssumption: return "assumption";
    case Kind::kJustification: break;
  }
  return "justification";
}

nlohmann::json to_json(const std::vector<AssuranceNode>& nodes) {
  if (nodes.empty()) return {};
  nlohmann::json list = nlohmann::json::array();
  for (const AssuranceNode& node : nodes) {
    list.push_back({{"id", node.id},
                    {"kind", name(node.kind)},
                    {"undeveloped", node.is_undeveloped},
                    {"text", node.text},
                    {"supported_by", node.supported_by},
                    {"in_context_of", node.in_context_of}});
  }
  return {{"top", nodes.front().id}, {"nodes", std::move(list)}};
}

}  // namespace taut
