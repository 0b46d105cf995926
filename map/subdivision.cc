// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/subdivision.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>

#include "map/known_verdicts.h"

namespace taut {
namespace {

/// An undecided leaf that may be halved further.
struct Pending {
  Cell cell;
  std::uint32_t node = 0;
  std::uint32_t known = 0;   ///< its node in KnownVerdicts
  std::uint64_t proved = 0;  ///< of a cell that contains it
};

CellVerdict known_verdict(const KnownVerdicts& known, std::uint32_t number) {
  const MapNode& node = known.nodes.at(number);
  if (node.axis == KnownVerdicts::kNotJudged) throw std::logic_error("a map of known verdicts: one is not known");
  CellVerdict result;
  result.kind = node.kind;
  result.reason = node.reason;
  result.regular = node.regular;
  result.is_tolerance = node.axis == KnownVerdicts::kTolerance;
  if (node.axis < kMaxMapAxes) result.axis = node.axis;
  return result;
}

class Subdivision {
 public:
  /// Cells are judged by `proof`, or as `known` says. Refers to its arguments.
  Subdivision(const CellProof* proof, const KnownVerdicts* known, const MapSpace& space,
              const SubdivisionOptions& options)
      : options_(options),
        proof_(proof),
        known_(known),
        rule_(space, options.least_width),
        pending_(kMaxCellHalvings + 1) {
    map_.space = space;
    map_.nodes.emplace_back();
    map_.share[0] = 1;
    pending_[0].push_back({});
  }

  CellMap run() {
    for (std::deque<Pending>& cells : pending_) {
      // Cells of one size are judged in the order in which their parents were.
      while (!cells.empty()) {
        if (is_finished()) return std::move(map_);
        const auto end = cells.begin() + static_cast<std::ptrdiff_t>(std::min(kBatch, cells.size()));
        const std::vector<Pending> batch(cells.begin(), end);
        cells.erase(cells.begin(), end);
        judge(batch);
      }
    }
    map_.end = CellMap::End::kWidth;
    return std::move(map_);
  }

 private:
  /// Shares are looked at after so many cells, whatever the number of threads is.
  static constexpr std::size_t kBatch = 4096;
  static constexpr std::size_t kGrain = 64;
  using Clock = std::chrono::steady_clock;

  bool is_finished() {
    using End = CellMap::End;
    if (map_.share[0] <= options_.undecided_share) {
      map_.end = End::kShare;
    } else if (map_.leaves() + kBatch > options_.most_cells) {
      map_.end = End::kCells;
    } else if (options_.stop.stop_requested()) {
      map_.end = End::kStopped;
    } else if (std::chrono::duration<double>(Clock::now() - begin_).count() > options_.seconds) {
      map_.end = End::kTime;
    } else {
      return false;
    }
    return true;
  }

  void judge(std::span<const Pending> batch) {
    verdicts_.resize(batch.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, batch.size(), kGrain), [&](const auto& range) {
      for (std::size_t n = range.begin(); n < range.end(); ++n) {
        verdicts_[n] =
            known_ != nullptr ? known_verdict(*known_, batch[n].known) : proof_->judge(batch[n].cell, batch[n].proved);
      }
    });
    map_.judged += batch.size();
    for (std::size_t n = 0; n < batch.size(); ++n) settle(batch[n], verdicts_[n]);
    if (options_.progress) options_.progress({map_.leaves(), map_.share[0]});
  }

  void settle(const Pending& pending, const CellVerdict& verdict) {
    MapNode& node = map_.nodes[pending.node];
    node.kind = verdict.kind;
    node.reason = verdict.reason;
    node.regular = verdict.regular;
    if (verdict.kind != CellKind::kUndecided) {
      const double volume = pending.cell.volume();
      map_.share[0] -= volume;
      map_.share[static_cast<std::size_t>(verdict.kind)] += volume;
      return;
    }
    const std::optional<std::size_t> axis = rule_.axis(pending.cell, verdict);
    if (!axis) {
      if (verdict.is_tolerance) map_.tolerance_share += pending.cell.volume();
      return;
    }
    const auto child = static_cast<std::uint32_t>(map_.nodes.size());
    const std::uint32_t known = known_ != nullptr ? known_->nodes[pending.known].child : 0;
    node.child = child;
    node.axis = static_cast<std::uint8_t>(*axis);
    map_.nodes.emplace_back();
    map_.nodes.emplace_back();
    for (unsigned side = 0; side < 2; ++side) {
      const Cell half = pending.cell.half(*axis, side);
      pending_[static_cast<std::size_t>(half.halvings())].push_back(
          {half, child + side, known_ != nullptr ? known + side : 0, verdict.proved});
    }
  }

  const SubdivisionOptions& options_;
  Clock::time_point begin_ = Clock::now();
  const CellProof* proof_;
  const KnownVerdicts* known_;
  HalvingRule rule_;
  CellMap map_;
  std::vector<std::deque<Pending>> pending_;  ///< by the number of halvings: the largest first
  std::vector<CellVerdict> verdicts_;
};

}  // namespace

HalvingRule::HalvingRule(const MapSpace& space, double least_width) : axes_(space.size()) {
  for (std::size_t k = 0; k < axes_; ++k) {
    const double halvings = std::floor(std::log2(1 / least_width));
    deepest_.at(k) = static_cast<int>(std::clamp(halvings, 0.0, double{kMaxCellDepth}));
  }
}

int HalvingRule::most_halvings() const {
  return std::min(std::accumulate(deepest_.begin(), deepest_.end(), 0), kMaxCellHalvings);
}

std::optional<std::size_t> HalvingRule::axis(const Cell& cell, const CellVerdict& verdict) const {
  if (verdict.kind != CellKind::kUndecided || verdict.is_tolerance) return std::nullopt;
  if (cell.halvings() >= kMaxCellHalvings) return std::nullopt;
  if (cell.depth.at(verdict.axis) < deepest_.at(verdict.axis)) return verdict.axis;
  std::optional<std::size_t> widest;
  for (std::size_t k = 0; k < axes_; ++k) {
    if (cell.depth[k] < deepest_[k] && (!widest || cell.depth[k] < cell.depth[*widest])) widest = k;
  }
  return widest;
}

CellMap subdivide(const Problem& problem, const MapSpace& space, const SubdivisionOptions& options) {
  const std::unique_ptr<CellProof> proof = make_cell_proof(problem, space);
  return Subdivision(proof.get(), nullptr, space, options).run();
}

CellMap subdivide(const KnownVerdicts& known, const MapSpace& space, const SubdivisionOptions& options) {
  return Subdivision(nullptr, &known, space, options).run();
}

}  // namespace taut
