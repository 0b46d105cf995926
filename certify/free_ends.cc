// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/free_ends.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "base/input_error.h"
#include "certify/headroom.h"
#include "problem/decimal.h"

namespace taut {
namespace {

constexpr std::size_t kBase = 0;
constexpr std::size_t kPlatform = 1;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

double number(const DecimalText& text) { return ScalarTraits<double>::from_decimal(text); }

/// The least decimal of two digits that is not below x > 0.
DecimalText two_digits_above(double x) {
  const int exponent = static_cast<int>(std::floor(std::log10(x))) - 1;
  const auto steps = static_cast<long>(std::ceil(x * std::pow(10.0, -exponent) * (1 - 1e-12)));
  return Decimal::parse(fmt::format("{}e{}", steps, exponent)).text();
}

Vector3<double> cable_vector(const Model<double>& model, const RigidPose& pose, std::size_t i) {
  return pose.p + pose.q * model.p_PB[i] - model.p_WA[i];
}

/// The longest free ends that are tried [m].
double longest_free_end(const PoseSampler& sampler, std::span<const Segment> segments) {
  constexpr double kOfCable = 0.2;
  double shortest = kInfinite;
  for (const Segment& segment : segments) {
    for (const double s : {0.0, 0.5, 1.0}) {
      const RigidPose pose = sampler.rigid_pose(segment, s);
      for (std::size_t i = 0; i < kCables; ++i) {
        shortest = std::min(shortest, cable_vector(sampler.model(), pose, i).norm());
      }
    }
  }
  return kOfCable * shortest;
}

/// What is nearest to each other at samples, in floating point.
class NearAnchors {
 public:
  /// @param longest  what is nearer to an anchor than this is near it
  NearAnchors(const Prover& prover, double longest)
      : bodies_(*prover.bodies()), sampler_(prover.sampler()), longest_(longest) {}

  /// Which free ends all pairs that are too near, or if there are none the nearest pair, would need to be longer; none
  /// where one of these is no matter of free ends.
  [[nodiscard]] std::array<bool, 2> ends_in_the_way(std::span<const Segment> segments,
                                                    const std::stop_token& stop) const {
    constexpr std::size_t kSamples = 400;  // of a path
    constexpr std::size_t kMostOfSegment = 48;
    const std::size_t of_segment = std::clamp<std::size_t>(kSamples / segments.size(), 1, kMostOfSegment);
    std::array<bool, 2> found{};
    double least = kInfinite;
    std::optional<std::size_t> end_of_least;
    for (const Segment& segment : segments) {
      for (std::size_t k = 0; k <= of_segment; ++k) {
        if (stop.stop_requested()) return {};
        const RigidPose pose = sampler_.rigid_pose(segment, static_cast<double>(k) / static_cast<double>(of_segment));
        for (std::size_t n = 0; n < bodies_.bodies().pairs.size(); ++n) {
          const double room = bodies_.room(sampler_.model(), pose, n);
          if (room > 0 && !(room < least)) continue;
          const std::optional<std::size_t> end = end_near(pose, n);
          if (room < least) {
            least = room;
            end_of_least = end;
          }
          if (room > 0) continue;
          if (!end) return {};
          found[*end] = true;
        }
      }
    }
    if (least > 0 && end_of_least) found[*end_of_least] = true;
    return found;
  }

 private:
  /// The end of cables near which a pair's nearest points are, where its bodies are made fast to one another there.
  [[nodiscard]] std::optional<std::size_t> end_near(const RigidPose& pose, std::size_t n) const {
    const CheckedPair<double>& pair = bodies_.bodies().pairs[n];
    if (pair.kind == PairClass::kPlatformObstacles || pair.kind == PairClass::kExitCones) return std::nullopt;
    const PointPair nearest = bodies_.nearest(sampler_.model(), pose, n);
    for (const std::size_t end : {kBase, kPlatform}) {
      if (!are_made_fast(pair, end) || !is_near(pose, pair.first, nearest.first, end)) continue;
      if (pair.kind == PairClass::kCablesCables && !is_near(pose, pair.second, nearest.second, end)) continue;
      return end;
    }
    return std::nullopt;
  }

  /// Whether a pair may touch at this end by construction.
  [[nodiscard]] static bool are_made_fast(const CheckedPair<double>& pair, std::size_t end) {
    switch (pair.kind) {
      case PairClass::kCablesObstacles: return end == kBase;
      case PairClass::kCablesPlatform: return end == kPlatform;
      case PairClass::kCablesCables: return end == kBase ? pair.shares_base : pair.shares_platform;
      case PairClass::kPlatformObstacles:
      case PairClass::kExitCones: break;
    }
    return false;
  }

  /// @param shares  of the two ends of its checked part
  [[nodiscard]] bool is_near(const RigidPose& pose, std::size_t cable, const std::vector<std::int64_t>& shares,
                             std::size_t end) const {
    if (shares.size() != 2) return false;
    const std::array<double, 2>& free = bodies_.bodies().cable_free[cable];
    const double checked = cable_vector(sampler_.model(), pose, cable).norm() - free[kBase] - free[kPlatform];
    return free[end] + dyadic_share(shares[1 - end]).approx() * checked <= longest_;
  }

  const BodySampler& bodies_;
  const PoseSampler& sampler_;
  double longest_;
};

/// Proofs of the whole path with other free ends.
class FreeEndSearch {
 public:
  FreeEndSearch(const Problem& problem, std::span<const Segment> segments, const std::stop_token& stop)
      : problem_(problem), segments_(segments), stop_(stop) {}

  [[nodiscard]] std::optional<ProvedFreeEnds> find(const std::array<bool, 2>& in_the_way, double longest) {
    FreeEnds ends;
    for (const std::size_t end : {kBase, kPlatform}) {
      if (in_the_way[end]) ends[end] = two_digits_above(longest);
    }
    if (!proves(ends)) return std::nullopt;
    for (const std::size_t end : {kBase, kPlatform}) {
      if (ends[end]) shorten(ends, end);
    }
    return ProvedFreeEnds{ends, !stop_.stop_requested()};
  }

 private:
  /// By bisection of their ratio. @pre proves(ends)
  void shorten(FreeEnds& ends, std::size_t end) {
    double stated = kInfinite;
    for (const auto& of_cable : problem_.bodies->cables.free_ends_m) stated = std::min(stated, number(of_cable[end]));
    double proved = number(*ends[end]);
    constexpr double kShortest = 1e-4;  // of the longest
    double failed = std::max(stated, kShortest * proved);
    while (!stop_.stop_requested()) {
      FreeEnds tried = ends;
      tried[end] = two_digits_above(std::sqrt(failed * proved));
      const double length = number(*tried[end]);
      if (!(length < proved)) return;
      if (proves(tried)) {
        ends = tried;
        proved = length;
      } else {
        failed = length;
      }
    }
  }

  [[nodiscard]] bool proves(const FreeEnds& ends) {
    if (stop_.stop_requested()) return false;
    try {
      const Prover prover(with_free_ends(problem_, ends), kTrial);
      const auto is_proved = [&](std::size_t k) {
        return prover.prove(segments_[k], 0, stop_, ProofAim::kProve).verdict == Verdict::kProved;
      };
      if (!is_proved(last_failed_)) return false;
      for (std::size_t k = 0; k < segments_.size(); ++k) {
        if (k == last_failed_ || is_proved(k)) continue;
        last_failed_ = k;
        return false;
      }
      return true;
    } catch (const InputError&) {
      return false;  // so long that there is no such problem
    }
  }

  const Problem& problem_;
  std::span<const Segment> segments_;
  const std::stop_token& stop_;
  std::size_t last_failed_ = 0;  ///< which is tried first
};

}  // namespace

Problem with_free_ends(Problem problem, const FreeEnds& free_ends) {
  for (auto& of_cable : problem.bodies.value().cables.free_ends_m) {
    for (const std::size_t end : {kBase, kPlatform}) {
      if (!free_ends[end]) continue;
      if (Decimal::parse(of_cable[end]) < Decimal::parse(*free_ends[end])) of_cable[end] = *free_ends[end];
    }
  }
  validate(problem);
  return problem;
}

std::optional<ProvedFreeEnds> find_free_ends(const Prover& prover, std::span<const Segment> segments,
                                             const std::stop_token& stop) {
  if (prover.bodies() == nullptr || segments.empty()) return std::nullopt;
  const double longest = longest_free_end(prover.sampler(), segments);
  if (!(longest > 0 && longest < kInfinite)) return std::nullopt;
  const std::array<bool, 2> in_the_way = NearAnchors(prover, longest).ends_in_the_way(segments, stop);
  if (!in_the_way[kBase] && !in_the_way[kPlatform]) return std::nullopt;
  return FreeEndSearch(prover.problem(), segments, stop).find(in_the_way, longest);
}

}  // namespace taut
