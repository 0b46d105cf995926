// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/sensitivity_json.h"

#include <fmt/format.h>

#include <array>
#include <string>

#include "certify/severity.h"
#include "reports/summary/headroom_summary.h"

namespace taut {
namespace {

using nlohmann::json;
using Parameter = DesignParameter;

constexpr std::array<const char*, 6> kAxes = {"x", "y", "z", "x", "y", "z"};

const char* name(Parameter::Kind kind) {
  switch (kind) {
    case Parameter::Kind::kBaseAnchor: return "base_anchor";
    case Parameter::Kind::kPlatformAnchor: return "platform_anchor";
    case Parameter::Kind::kLoadPoint: return "load_point";
    case Parameter::Kind::kWrench: return "wrench";
    case Parameter::Kind::kWeight: return "weight";
    case Parameter::Kind::kMass: return "mass";
    case Parameter::Kind::kTensionLower: return "tension_lower";
    case Parameter::Kind::kTensionUpper: return "tension_upper";
    case Parameter::Kind::kLengthLower: return "length_lower";
    case Parameter::Kind::kLengthUpper: return "length_upper";
    case Parameter::Kind::kTolerance: break;
  }
  return "tolerance";
}

const char* name(Change::Kind kind) {
  switch (kind) {
    case Change::Kind::kTensionLower: return "tension_lower";
    case Change::Kind::kTensionUpper: return "tension_upper";
    case Change::Kind::kLengthLower: return "length_lower";
    case Change::Kind::kLengthUpper: return "length_upper";
    case Change::Kind::kWrench: return "weight";
    case Change::Kind::kMass: return "mass";
    case Change::Kind::kBaseAnchor: return "base_anchor";
    case Change::Kind::kPlatformAnchor: break;
  }
  return "platform_anchor";
}

/// The unit of a parameter in SI.
const char* unit(const Parameter& p) {
  switch (p.kind) {
    case Parameter::Kind::kWrench: return p.axis < 3 ? "N" : "N m";
    case Parameter::Kind::kTensionLower:
    case Parameter::Kind::kTensionUpper: return "N";
    case Parameter::Kind::kWeight:
    case Parameter::Kind::kTolerance: return "1";
    case Parameter::Kind::kMass: return "kg";
    default: return "m";
  }
}

bool has_cable(Parameter::Kind kind) {
  return kind != Parameter::Kind::kLoadPoint && kind != Parameter::Kind::kWrench && kind != Parameter::Kind::kWeight &&
         kind != Parameter::Kind::kMass && kind != Parameter::Kind::kTolerance;
}

bool has_axis(Parameter::Kind kind) {
  return kind == Parameter::Kind::kBaseAnchor || kind == Parameter::Kind::kPlatformAnchor ||
         kind == Parameter::Kind::kLoadPoint || kind == Parameter::Kind::kWrench;
}

json derivative_json(const Problem& problem, const Derivative& d, bool length) {
  const Parameter& p = d.parameter;
  const double step = natural_step(problem, p);
  return {{"parameter", p.kind == Parameter::Kind::kTolerance ? taut::name(p.uncertainty.kind) : name(p.kind)},
          {"item", p.uncertainty.kind == UncertaintyKind::kLoadItem ? json(p.uncertainty.item) : json()},
          {"cable", has_cable(p.kind) ? json(p.index + 1) : json()},
          {"axis", has_axis(p.kind) ? json(kAxes.at(p.axis)) : json()},
          {"of_moment", p.kind == Parameter::Kind::kWrench && p.axis >= 3},
          {"derivative", d.value},
          {"unit", fmt::format("{}/{}", length ? "m" : "N", unit(p))},
          {"step", step},
          {"gain", d.value * step}};
}

json change_json(const ProvedChange& change) {
  const Change::Kind kind = change.change.kind;
  const bool is_anchor = kind == Change::Kind::kBaseAnchor || kind == Change::Kind::kPlatformAnchor;
  return {{"change", name(kind)},
          {"item", kind == Change::Kind::kMass ? json(change.change.item) : json()},
          {"cable", is_anchor ? json(change.change.index + 1) : json()},
          {"axis", is_anchor ? json(kAxes.at(change.change.axis)) : json()},
          {"before", change.before},
          {"value", change.value ? json(*change.value) : json()},
          {"unit", std::string(unit(kind))},
          {"complete", change.is_complete}};
}

}  // namespace

const char* verdict_name(Verdict verdict) {
  return verdict == Verdict::kProved ? "proved" : verdict == Verdict::kRefuted ? "refuted" : "undecided";
}

json to_json(const Problem& problem, const CaseSensitivity& found) {
  json derivatives = json::array();
  json changes = json::array();
  const Sensitivity& s = found.sensitivity;
  const bool length = s.tightest && !s.tightest->singular && is_length(s.tightest->budget.id);
  for (const Derivative& d : s.derivatives) derivatives.push_back(derivative_json(problem, d, length));
  for (const ProvedChange& change : s.changes) changes.push_back(change_json(change));
  return {{"verdict", verdict_name(found.verdict)},
          {"segments", found.segments},
          {"headroom", to_json(found.headroom)},
          {"derivatives", derivatives},
          {"changes", changes}};
}

}  // namespace taut
