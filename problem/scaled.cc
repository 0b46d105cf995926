// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/scaled.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "problem/expression.h"
#include "problem/rational.h"
#include "problem/scalar.h"

namespace taut {
namespace {

constexpr const char* kLeastFactorOfSet = "1e-12";
constexpr double kMostTurn = 1 - 1e-9;  // [rad]; a tolerance is below 1

double number(const DecimalText& text) { return ScalarTraits<double>::from_decimal(text); }

template <std::size_t N>
double largest(const std::array<DecimalText, N>& texts) {
  double result = 0;
  for (const DecimalText& text : texts) result = std::max(result, std::abs(number(text)));
  return result;
}

/// A decimal of about 30 digits that is not above 1 / factor².
Decimal reciprocal_square_below(const Decimal& factor) {
  using boost::multiprecision::cpp_int;
  using boost::multiprecision::cpp_rational;
  constexpr int kDigits = 30;
  const cpp_rational root = factor.rational();
  const cpp_rational exact = 1 / cpp_rational(root * root);
  const int exponent = static_cast<int>(std::floor(std::log10(exact.convert_to<double>()))) - kDigits;
  const cpp_rational scale = boost::multiprecision::pow(cpp_int(10), static_cast<unsigned>(std::abs(exponent)));
  const cpp_rational shifted = exponent < 0 ? cpp_rational(exact * scale) : cpp_rational(exact / scale);
  const cpp_int mantissa = boost::multiprecision::numerator(shifted) / boost::multiprecision::denominator(shifted);
  return Decimal::parse(fmt::format("{}e{}", mantissa.str(), exponent));
}

void scale_ellipsoid(EllipsoidText& ellipsoid, const Decimal& factor) {
  const Decimal least = Decimal::parse(kLeastFactorOfSet);
  const Rational by = reciprocal_square_below(std::max(factor, least)).rational();
  for (auto& row : ellipsoid) {
    for (RationalText& entry : row) entry = rational_text(parse_rational(entry) * by);
  }
}

// ---- Items ----------------------------------------------------------------------------------------------------------

void scale_size(RationalText& size, const Rational& factor) { size = rational_text(parse_rational(size) * factor); }

/// Scales a range about `centre`.
void scale_range(RationalText& lower, RationalText& upper, const Rational& centre, const Rational& factor) {
  for (RationalText* end : {&lower, &upper}) {
    *end = rational_text(centre + factor * (parse_rational(*end) - centre));
  }
}

Rational middle(const RationalText& lower, const RationalText& upper) {
  return (parse_rational(lower) + parse_rational(upper)) / 2;
}

void scale(const std::string& name, Weight& weight, const Rational& factor) {
  scale_range(weight.mass_lower, weight.mass_upper, middle(weight.mass_lower, weight.mass_upper), factor);
  scale_size(weight.at_tolerance, factor);
  if (parse_rational(weight.mass_lower) < 0) {
    throw FieldError(fmt::format("load.items[{}].mass", name), weight.mass_lower, "expected a mass >= 0");
  }
}

void scale(VectorSet& set, const Rational& factor) {
  if (auto* ball = std::get_if<BallOfVectors>(&set)) return scale_size(ball->radius, factor);
  if (auto* disc = std::get_if<DiscOfVectors>(&set)) return scale_size(disc->radius, factor);
  auto& segment = std::get<SegmentOfVectors>(set);
  const bool holds_zero = parse_rational(segment.lower) <= 0 && parse_rational(segment.upper) >= 0;
  scale_range(segment.lower, segment.upper, holds_zero ? Rational(0) : middle(segment.lower, segment.upper), factor);
}

void scale(LoadCases& cases, const Rational& factor) {
  for (std::size_t k = 0; k < 6; ++k) {
    Rational mean = 0;
    for (const auto& wrench : cases.wrenches) mean += parse_rational(wrench[k]);
    mean /= cases.wrenches.size();
    for (auto& wrench : cases.wrenches) {
      wrench[k] = rational_text(mean + factor * (parse_rational(wrench[k]) - mean));
    }
  }
}

void scale(LoadItem& item, const Decimal& factor) {
  const Rational by = factor.rational();
  if (auto* weight = std::get_if<Weight>(&item.what)) return scale(item.name, *weight, by);
  if (auto* force = std::get_if<Force>(&item.what)) return scale(force->set, by);
  if (auto* moment = std::get_if<Moment>(&item.what)) return scale(moment->set, by);
  scale(std::get<LoadCases>(item.what), by);
}

bool deviates(const VectorSet& set) {
  if (const auto* ball = std::get_if<BallOfVectors>(&set)) return parse_rational(ball->radius) != 0;
  if (const auto* disc = std::get_if<DiscOfVectors>(&set)) return parse_rational(disc->radius) != 0;
  const auto& segment = std::get<SegmentOfVectors>(set);
  return parse_rational(segment.lower) != parse_rational(segment.upper);
}

bool deviates(const LoadItem& item) {
  if (const auto* weight = std::get_if<Weight>(&item.what)) {
    return parse_rational(weight->mass_lower) != parse_rational(weight->mass_upper) ||
           parse_rational(weight->at_tolerance) != 0;
  }
  if (const auto* force = std::get_if<Force>(&item.what)) return deviates(force->set);
  if (const auto* moment = std::get_if<Moment>(&item.what)) return deviates(moment->set);
  const auto& wrenches = std::get<LoadCases>(item.what).wrenches;
  return std::ranges::any_of(wrenches, [&](const auto& wrench) {
    return !std::ranges::equal(wrench, wrenches.front(), {}, parse_rational, parse_rational);
  });
}

/// Those of one item, or of all of K.
void scale_load(LoadText& load, const Uncertainty& uncertainty, const Decimal& factor) {
  const bool is_one = uncertainty.kind == UncertaintyKind::kLoadItem;
  if (load.ellipsoid && !is_one) scale_ellipsoid(*load.ellipsoid, factor);
  bool is_found = !is_one;
  for (LoadItem& item : load.items) {
    if (is_one && item.name != uncertainty.item) continue;
    scale(item, factor);
    is_found = true;
  }
  if (!is_found) throw FieldError("load.items", "no item '" + uncertainty.item + "'", "expected one of that name");
}

// ---- Tolerances -----------------------------------------------------------------------------------------------------

void scale_tolerance(TolerancesText& t, UncertaintyKind kind, const Decimal& factor) {
  const auto scale = [&](DecimalText& size) { size = (Decimal::parse(size) * factor).text(); };
  switch (kind) {
    case UncertaintyKind::kBaseAnchors: std::ranges::for_each(t.base_anchor_m, scale); break;
    case UncertaintyKind::kPlatformAnchors: std::ranges::for_each(t.platform_anchor_m, scale); break;
    case UncertaintyKind::kLoadPoint: scale(t.load_point_m); break;
    case UncertaintyKind::kLoad: std::ranges::for_each(t.wrench, scale); break;
    case UncertaintyKind::kPosition: scale(t.position_m); break;
    case UncertaintyKind::kOrientation:
      if (t.orientation_rad != "0") t.orientation_rad = fmt::format("({})*{}", t.orientation_rad, factor.text());
      if (!(evaluate_constant<double>(t.orientation_rad) < kMostTurn)) {
        throw FieldError("tolerances.orientation", t.orientation_rad, "below 1 rad");
      }
      break;
    case UncertaintyKind::kCableLengths:
      if (t.cable_length_m) std::ranges::for_each(*t.cable_length_m, scale);
      break;
    case UncertaintyKind::kWrenchSet:
    case UncertaintyKind::kLoadItem:
    case UncertaintyKind::kAll: break;
  }
}

}  // namespace

const char* name(UncertaintyKind kind) {
  switch (kind) {
    case UncertaintyKind::kBaseAnchors: return "base_anchors";
    case UncertaintyKind::kPlatformAnchors: return "platform_anchors";
    case UncertaintyKind::kLoadPoint: return "load_point";
    case UncertaintyKind::kLoad: return "load";
    case UncertaintyKind::kPosition: return "position";
    case UncertaintyKind::kOrientation: return "orientation";
    case UncertaintyKind::kCableLengths: return "cable_length";
    case UncertaintyKind::kWrenchSet: return "wrench_set";
    case UncertaintyKind::kLoadItem: return "load_item";
    case UncertaintyKind::kAll: break;
  }
  return "all";
}

const char* unit(UncertaintyKind kind) {
  switch (kind) {
    case UncertaintyKind::kLoad: return "N, N m";
    case UncertaintyKind::kOrientation: return "rad";
    case UncertaintyKind::kWrenchSet:
    case UncertaintyKind::kLoadItem:
    case UncertaintyKind::kAll: return "1";
    default: return "m";
  }
}

double size_of(const Problem& problem, UncertaintyKind kind) {
  using enum UncertaintyKind;
  if (kind == kWrenchSet || kind == kAll || kind == kLoadItem) return 1;
  if (!problem.tolerances) return 0;
  const TolerancesText& t = *problem.tolerances;
  switch (kind) {
    case UncertaintyKind::kBaseAnchors: return largest(t.base_anchor_m);
    case UncertaintyKind::kPlatformAnchors: return largest(t.platform_anchor_m);
    case UncertaintyKind::kLoadPoint: return number(t.load_point_m);
    case UncertaintyKind::kLoad: return largest(t.wrench);
    case UncertaintyKind::kPosition: return number(t.position_m);
    case UncertaintyKind::kOrientation: return evaluate_constant<double>(t.orientation_rad);
    default: break;
  }
  return t.cable_length_m ? largest(*t.cable_length_m) : 0;
}

std::vector<std::string> deviating_items(const LoadText& load) {
  std::vector<std::string> names;
  for (const LoadItem& item : load.items) {
    if (deviates(item)) names.push_back(item.name);
  }
  return names;
}

bool is_stated(const Problem& problem, const Uncertainty& uncertainty) {
  const LoadText& load = problem.load;
  switch (uncertainty.kind) {
    case UncertaintyKind::kWrenchSet:
      return load.ellipsoid || std::ranges::any_of(load.items, [](const LoadItem& item) { return deviates(item); });
    case UncertaintyKind::kLoadItem: {
      const std::vector<std::string> names = deviating_items(load);
      return std::ranges::find(names, uncertainty.item) != names.end();
    }
    case UncertaintyKind::kAll:
      return std::ranges::any_of(single_uncertainties(),
                                 [&](UncertaintyKind kind) { return is_stated(problem, kind); });
    default: return size_of(problem, uncertainty.kind) > 0;
  }
}

std::vector<Uncertainty> stated_uncertainties(const Problem& problem) {
  const std::vector<std::string> items = deviating_items(problem.load);
  const bool is_one_item = items.size() == 1 && !problem.load.ellipsoid;
  std::vector<Uncertainty> result;
  for (const UncertaintyKind kind : single_uncertainties()) {
    if (kind == UncertaintyKind::kWrenchSet && is_one_item) continue;
    if (is_stated(problem, kind)) result.emplace_back(kind);
  }
  for (const std::string& item : items) result.emplace_back(UncertaintyKind::kLoadItem, item);
  return result;
}

Problem with_unit_uncertainty(Problem problem, UncertaintyKind kind) {
  if (!problem.tolerances) problem.tolerances.emplace();
  TolerancesText& t = *problem.tolerances;
  switch (kind) {
    case UncertaintyKind::kBaseAnchors: t.base_anchor_m.fill("1"); break;
    case UncertaintyKind::kPlatformAnchors: t.platform_anchor_m.fill("1"); break;
    case UncertaintyKind::kLoadPoint: t.load_point_m = "1"; break;
    case UncertaintyKind::kLoad: t.wrench = problem.load.wrench; break;
    case UncertaintyKind::kPosition: t.position_m = "1"; break;
    case UncertaintyKind::kOrientation: t.orientation_rad = "0.1"; break;
    case UncertaintyKind::kCableLengths: t.cable_length_m.emplace().fill("1"); break;
    case UncertaintyKind::kWrenchSet:
    case UncertaintyKind::kLoadItem:
    case UncertaintyKind::kAll: throw std::logic_error("K has no unit");
  }
  return problem;
}

Problem with_uncertainty_scaled(Problem problem, const Uncertainty& uncertainty, const Decimal& factor) {
  const bool is_all = uncertainty.kind == UncertaintyKind::kAll;
  if (uncertainty.kind == UncertaintyKind::kLoadItem) scale_load(problem.load, uncertainty, factor);
  for (const UncertaintyKind single : single_uncertainties()) {
    if (!is_all && single != uncertainty.kind) continue;
    if (single == UncertaintyKind::kWrenchSet) scale_load(problem.load, single, factor);
    if (problem.tolerances) scale_tolerance(*problem.tolerances, single, factor);
  }
  return problem;
}

}  // namespace taut
