// SPDX-License-Identifier: GPL-3.0-or-later
#include "planner/smooth.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <stdexcept>

namespace taut {
namespace {

/// Bits of the control points, which identify a segment exactly.
using Key = std::vector<double>;

Key key_of(const Segment& segment) {
  Key key;
  for (const Waypoint* waypoint : segment.controls()) {
    const auto& [x, half_turns, normals] = waypoint->parameters();
    key.insert(key.end(), x.begin(), x.end());
    key.insert(key.end(), half_turns.begin(), half_turns.end());
  }
  return key;
}

class Smoother {
 public:
  Smoother(const Path& straight, const std::vector<std::size_t>& stops, const SmoothProblem& problem)
      : problem_(problem), longest_(problem.length(straight)) {
    path_.interpolation = Interpolation::kCubicBSpline;
    for (std::size_t k = 0; k < straight.waypoints.size(); ++k) {
      constexpr std::size_t kStop = 3;  // so often a control point stands where the curve is to pass it
      const std::size_t copies = std::ranges::binary_search(stops, k) ? kStop : 1;
      path_.waypoints.insert(path_.waypoints.end(), copies, straight.waypoints[k]);
    }
  }

  std::optional<SmoothPath> run() {
    constexpr int kMostRounds = 12;
    for (int round = 0; round < kMostRounds && !problem_.stop.stop_requested(); ++round) {
      judge();
      std::vector<bool> refine = edges_to_refine();
      if (std::ranges::none_of(refine, [](bool wanted) { return wanted; })) {
        const double length = problem_.length(path_);
        constexpr double kRounding = 1e-9;  // where nothing is rounded, both are as long
        if (length <= longest_ * (1 + kRounding)) return finish(length);
        refine.assign(refine.size(), true);
      }
      divide(refine);
    }
    return std::nullopt;
  }

 private:
  /// Proves the new segments.
  void judge() {
    std::vector<std::size_t> fresh;
    path_.tubes.clear();
    for (std::size_t k = 0; k < path_.segments(); ++k) {
      const Segment segment = path_.segment(k);
      if (!segment.control[0]->parameters().normals.empty())
        path_.tubes.push_back(problem_.prover.suitable_tube(segment));
      if (proofs_.try_emplace(key_of(segment)).second) fresh.push_back(k);
    }
    judged_ += static_cast<int>(fresh.size());
    tbb::parallel_for(std::size_t{0}, fresh.size(), [&](std::size_t i) {
      const Segment segment = path_.segment(fresh[i]);
      proofs_.at(key_of(segment)) = problem_.prover.prove(segment, problem_.clearance, problem_.stop, ProofAim::kProve);
    });
  }

  /// Edges between control points k and k + 1 that belong to a segment which is not proved.
  [[nodiscard]] std::vector<bool> edges_to_refine() const {
    std::vector<bool> refine(path_.waypoints.size() - 1, false);
    for (std::size_t k = 0; k < path_.segments(); ++k) {
      if (proofs_.at(key_of(path_.segment(k))).verdict == Verdict::kProved) continue;
      for (std::size_t i = 0; i < 3; ++i) refine[k + i] = true;
    }
    return refine;
  }

  void divide(const std::vector<bool>& edges) {
    std::vector<Waypoint> finer = {path_.waypoints.front()};
    for (std::size_t k = 0; k < edges.size(); ++k) {
      const Waypoint& a = path_.waypoints[k];
      const Waypoint& b = path_.waypoints[k + 1];
      if (edges[k] && a != b) finer.push_back(problem_.halfway(a, b));
      finer.push_back(b);
    }
    path_.waypoints = std::move(finer);
  }

  std::optional<SmoothPath> finish(double length) {
    SmoothPath result{path_, {}, length, judged_};
    result.proof = prove_path(
        problem_.prover, result.path, [&](const Segment& segment) { return &proofs_.at(key_of(segment)); },
        problem_.stop);
    if (result.proof.verdict != Verdict::kProved) return std::nullopt;
    return result;
  }

  const SmoothProblem& problem_;
  double longest_;
  Path path_;
  std::map<Key, SegmentProof> proofs_;
  int judged_ = 0;
};

}  // namespace

std::optional<SmoothPath> smooth(const Path& straight, const std::vector<std::size_t>& stops,
                                 const SmoothProblem& problem) {
  if (straight.timing) throw std::logic_error("proofs of segments at rest are known by control points alone");
  if (straight.segments() == 0) return std::nullopt;
  return Smoother(straight, stops, problem).run();
}

}  // namespace taut
