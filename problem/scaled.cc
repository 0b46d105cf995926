// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/scaled.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "problem/expression.h"
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

void scale_set(LoadText& load, const Decimal& factor) {
  const Decimal least = Decimal::parse(kLeastFactorOfSet);
  const Decimal by = reciprocal_square_below(std::max(factor, least));
  for (auto& row : load.ellipsoid) {
    for (DecimalText& entry : row) entry = (Decimal::parse(entry) * by).text();
  }
}

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
    case UncertaintyKind::kAll: break;
  }
  return "all";
}

const char* unit(UncertaintyKind kind) {
  switch (kind) {
    case UncertaintyKind::kLoad: return "N, N m";
    case UncertaintyKind::kOrientation: return "rad";
    case UncertaintyKind::kWrenchSet:
    case UncertaintyKind::kAll: return "1";
    default: return "m";
  }
}

double size_of(const Problem& problem, UncertaintyKind kind) {
  if (kind == UncertaintyKind::kWrenchSet || kind == UncertaintyKind::kAll) return 1;
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

bool is_stated(const Problem& problem, UncertaintyKind kind) { return size_of(problem, kind) > 0; }

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
    case UncertaintyKind::kAll: throw std::logic_error("K has no unit");
  }
  return problem;
}

Problem with_uncertainty_scaled(Problem problem, UncertaintyKind kind, const Decimal& factor) {
  const bool is_all = kind == UncertaintyKind::kAll;
  for (const UncertaintyKind single : single_uncertainties()) {
    if (!is_all && single != kind) continue;
    if (single == UncertaintyKind::kWrenchSet) scale_set(problem.load, factor);
    if (problem.tolerances) scale_tolerance(*problem.tolerances, single, factor);
  }
  return problem;
}

}  // namespace taut
