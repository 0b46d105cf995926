// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/proved_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "base/input_error.h"
#include "certificate/certificate_reader.h"
#include "certify/box_ranges.h"
#include "problem/decimal.h"
#include "reports/summary/numbers.h"

namespace taut {
namespace {

constexpr std::size_t kFewestPieces = 512;  ///< into which the path is halved at least, so that ranges are of one place
constexpr std::size_t kManyBoxes = 20'000;  ///< these are not halved

/// What the theorem's margin leaves of the limits, rounded outward.
TensionPiece::Ranges ranges_by_margin(const RobotText& robot, const Margins& margins) {
  const Rational margin = Decimal::parse(margins.tension_N).rational();
  TensionPiece::Ranges result;
  for (std::size_t i = 0; i < kCables; ++i) {
    result[i] = {below(Rational(Decimal::parse(robot.tension_N[i].lower).rational() + margin)),
                 above(Rational(Decimal::parse(robot.tension_N[i].upper).rational() - margin))};
  }
  return result;
}

std::vector<DyadicBox> halved(const DyadicBox& box, int times) {
  if (times == 0) return {box};
  std::vector<DyadicBox> result = halved(box.left(), times - 1);
  std::ranges::copy(halved(box.right(), times - 1), std::back_inserter(result));
  return result;
}

std::vector<std::vector<DyadicBox>> halved_boxes(const std::vector<std::vector<DyadicBox>>& boxes) {
  std::size_t count = 0;
  for (const auto& segment : boxes) count += segment.size();
  int times = 0;
  for (; count > 0 && count << static_cast<unsigned>(times) < kFewestPieces;) ++times;
  std::vector<std::vector<DyadicBox>> result;
  for (const auto& segment : boxes) {
    std::vector<DyadicBox>& pieces = result.emplace_back();
    for (const DyadicBox& box : segment) std::ranges::copy(halved(box, times), std::back_inserter(pieces));
  }
  return result;
}

}  // namespace

ProvedPath proved_path(const Certificate& certificate) {
  if (certificate.verdict != Verdict::kProved) {
    throw InputError(
        fmt::format("got the verdict '{}', expected a path that is proved", taut::name(certificate.verdict)));
  }
  ProvedPath result{certificate.problem, certificate.path, {}, {}};
  for (std::size_t k = 0; k < certificate.path.segments(); ++k) {
    const bool is_there = k < certificate.segments.size();
    result.boxes.push_back(is_there ? dyadic_boxes(certificate.segments[k].boxes) : std::vector<DyadicBox>());
    const std::optional<Margins>& margins =
        is_there && certificate.segments[k].margins ? certificate.segments[k].margins : certificate.margins;
    if (!margins) throw InputError(fmt::format("segments[{}]: got no margins, expected those of a proof", k));
    result.margins.push_back(*margins);
  }
  return result;
}

std::vector<TensionPiece> tension_pieces(const ProvedPath& proved) {
  Problem problem = proved.problem;
  problem.bodies.reset();  // they say nothing of tensions
  const std::vector<std::vector<DyadicBox>> boxes = halved_boxes(proved.boxes);
  std::size_t count = 0;
  for (const auto& segment : boxes) count += segment.size();
  RangeOptions options;
  if (count > kManyBoxes) options.most_halvings = 0;
  const PathRanges ranges = path_ranges(Prover(problem), proved.path, boxes, options);
  std::vector<TensionPiece> result;
  for (std::size_t k = 0; k < proved.path.segments(); ++k) {
    const auto from = static_cast<double>(k);
    const TensionPiece::Ranges by_margin = ranges_by_margin(problem.robot, proved.margins[k]);
    double reached = 0;
    const auto fill_to = [&](double s) {
      if (s > reached) result.push_back({from + reached, from + s, by_margin});
    };
    for (const BoxRanges& piece : k < ranges.segments.size() ? ranges.segments[k] : std::vector<BoxRanges>()) {
      const double lower = piece.box.lower().approx(), upper = piece.box.upper().approx();
      if (lower < reached) continue;
      fill_to(lower);
      TensionPiece::Ranges tension;
      for (std::size_t i = 0; i < kCables; ++i) {
        tension[i] = {std::max(piece.tension[i].lower, by_margin[i][0]),
                      std::min(piece.tension[i].upper, by_margin[i][1])};
      }
      result.push_back({from + lower, from + upper, tension});
      reached = upper;
    }
    fill_to(1);
  }
  return result;
}

std::vector<TensionPiece> tension_pieces(const checker::CheckResult& checked) {
  return tension_pieces(
      proved_path(read_certificate(checked.theorem ? checked.theorem->certificate() : *checked.certificate)));
}

}  // namespace taut
