// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/tolerance_limits.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "problem/decimal.h"

namespace taut {
namespace {

/// A tolerance is `unit` times n/1024, n whole: exact decimals.
constexpr long kStated = 1024;
const char* const kPart = "0.0009765625";
constexpr long kMostGrowth = 1L << 40;
constexpr double kResolution = 1.0 / 64;  // of the size found

Decimal size_of(const DecimalText& unit, long n) {
  return Decimal::parse(unit) * Decimal::parse(std::to_string(n)) * Decimal::parse(kPart);
}

double number(const DecimalText& text) { return ScalarTraits<double>::from_decimal(text); }

template <std::size_t N>
double largest(const std::array<DecimalText, N>& texts) {
  double result = 0;
  for (const DecimalText& text : texts) result = std::max(result, std::abs(number(text)));
  return result;
}

/// A trial that fails should do so soon.
constexpr ProofOptions kTrial = {.max_bits = 128,
                                 .max_boxes = 500,
                                 .max_multiprecision_boxes = 1,
                                 .motion_depth = 5,
                                 .singular_depth = 6,
                                 .tolerance_depth = 4};

/// One kind of tolerance of a problem, as something that grows.
class Growing {
 public:
  Growing(const Problem& problem, ToleranceKind kind, double length) : problem_(problem), kind_(kind) {
    if (!problem_.tolerances) problem_.tolerances.emplace();
    original_ = *problem_.tolerances;
    stated_ = size(original_);
    if (stated_ == 0) set_unit(length);
  }

  [[nodiscard]] bool is_possible() const { return stated_ > 0 || size(original_) > 0; }
  [[nodiscard]] double stated() const { return stated_; }
  /// n at which the tolerance is as stated.
  [[nodiscard]] long start() const { return stated_ > 0 ? kStated : 0; }

  [[nodiscard]] Problem at(long n) const {
    Problem result = problem_;
    TolerancesText& t = *result.tolerances;
    const auto grow = [n](const DecimalText& unit) { return size_of(unit, n).text(); };
    const auto grow_all = [&](const auto& units, auto& sizes) { std::ranges::transform(units, sizes.begin(), grow); };
    switch (kind_) {
      case ToleranceKind::kBaseAnchors: grow_all(original_.base_anchor_m, t.base_anchor_m); break;
      case ToleranceKind::kPlatformAnchors: grow_all(original_.platform_anchor_m, t.platform_anchor_m); break;
      case ToleranceKind::kLoadPoint: t.load_point_m = grow(original_.load_point_m); break;
      case ToleranceKind::kLoad: grow_all(original_.wrench, t.wrench); break;
      case ToleranceKind::kPosition: t.position_m = grow(original_.position_m); break;
      case ToleranceKind::kOrientation:
        t.orientation_rad = fmt::format("({})*{}", original_.orientation_rad, grow("1"));
        break;
      case ToleranceKind::kCableLengths: grow_all(*original_.cable_length_m, *t.cable_length_m); break;
    }
    return result;
  }

  /// Rounded down.
  [[nodiscard]] double size_at(long n) const {
    const double exact = size(original_) * (static_cast<double>(n) / kStated);
    return n == 0 ? 0.0 : std::nextafter(exact * (1 - 1e-15), 0.0);
  }

 private:
  [[nodiscard]] double size(const TolerancesText& t) const {
    switch (kind_) {
      case ToleranceKind::kBaseAnchors: return largest(t.base_anchor_m);
      case ToleranceKind::kPlatformAnchors: return largest(t.platform_anchor_m);
      case ToleranceKind::kLoadPoint: return number(t.load_point_m);
      case ToleranceKind::kLoad: return largest(t.wrench);
      case ToleranceKind::kPosition: return number(t.position_m);
      case ToleranceKind::kOrientation: return evaluate_constant<double>(t.orientation_rad);
      case ToleranceKind::kCableLengths: break;
    }
    return largest(*t.cable_length_m);
  }

  /// A ten-millionth of the robot for 1024 parts, or of w0.
  void set_unit(double length) {
    constexpr double kLittle = 1e-7;
    const DecimalText little = fmt::format("{:.3g}", kLittle * length);
    switch (kind_) {
      case ToleranceKind::kBaseAnchors: original_.base_anchor_m.fill(little); break;
      case ToleranceKind::kPlatformAnchors: original_.platform_anchor_m.fill(little); break;
      case ToleranceKind::kLoadPoint: original_.load_point_m = little; break;
      case ToleranceKind::kLoad:
        std::ranges::transform(problem_.load.wrench, original_.wrench.begin(), [](const DecimalText& w) {
          return (Decimal::parse(w) * Decimal::parse("0.0000001")).text();
        });
        break;
      case ToleranceKind::kPosition: original_.position_m = little; break;
      case ToleranceKind::kOrientation: original_.orientation_rad = "0.0000001"; break;
      case ToleranceKind::kCableLengths: original_.cable_length_m->fill(little); break;
    }
  }

  Problem problem_;
  ToleranceKind kind_;
  TolerancesText original_;  ///< of one unit: n = 1024
  double stated_ = 0;
};

/// The largest n at which the whole path was proved.
long grow(const Growing& growing, const Path& path, const std::stop_token& stop) {
  const auto proves = [&](long n, const Segment& segment) {
    if (stop.stop_requested()) return false;
    const Prover prover(growing.at(n), kTrial);
    return prover.prove(prover.prepared(segment), 0, stop).verdict == Verdict::kProved;
  };
  long best = kMostGrowth;
  std::unique_ptr<Prover> at_best;
  for (std::size_t k = 0; k < path.segments() && best > growing.start(); ++k) {
    const Segment segment = path.segment(k);
    if (at_best && at_best->prove(at_best->prepared(segment), 0, stop).verdict == Verdict::kProved) continue;
    long proved = growing.start();
    long next = std::max<long>(2 * proved, kStated);
    while (next < best && proves(next, segment)) {
      proved = next;
      next *= 2;
    }
    long failed = std::min(next, best);
    while (failed - proved > std::max<long>(1, static_cast<long>(kResolution * static_cast<double>(proved)))) {
      const long middle = proved + (failed - proved) / 2;
      (proves(middle, segment) ? proved : failed) = middle;
    }
    best = proved;
    at_best = std::make_unique<Prover>(growing.at(best), kTrial);
  }
  return best;
}

}  // namespace

const char* name(ToleranceKind kind) {
  switch (kind) {
    case ToleranceKind::kBaseAnchors: return "base_anchors";
    case ToleranceKind::kPlatformAnchors: return "platform_anchors";
    case ToleranceKind::kLoadPoint: return "load_point";
    case ToleranceKind::kLoad: return "load";
    case ToleranceKind::kPosition: return "position";
    case ToleranceKind::kOrientation: return "orientation";
    case ToleranceKind::kCableLengths: break;
  }
  return "cable_length";
}

std::vector<ToleranceLimit> tolerance_limits(const Problem& problem, const Path& path, const std::stop_token& stop) {
  std::vector<ToleranceKind> kinds = {ToleranceKind::kBaseAnchors, ToleranceKind::kPlatformAnchors,
                                      ToleranceKind::kPosition, ToleranceKind::kOrientation};
  if (problem.load.items.empty()) {  // items have their own tolerances
    kinds.insert(kinds.begin() + 2, {ToleranceKind::kLoadPoint, ToleranceKind::kLoad});
  }
  if (problem.tolerances && problem.tolerances->cable_length_m) kinds.push_back(ToleranceKind::kCableLengths);
  const double length = make_model<double>(problem).characteristic_length;
  std::vector<ToleranceLimit> limits(kinds.size());
  tbb::parallel_for(std::size_t{0}, kinds.size(), [&](std::size_t i) {
    const Growing growing(problem, kinds[i], length);
    limits[i] = {kinds[i], growing.stated(), growing.stated()};
    if (growing.is_possible())
      limits[i].proved = std::max(growing.stated(), growing.size_at(grow(growing, path, stop)));
  });
  if (stop.stop_requested()) return {};  // they might have grown further
  return limits;
}

}  // namespace taut
