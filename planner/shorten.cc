// SPDX-License-Identifier: GPL-3.0-or-later
#include "planner/shorten.h"

#include <array>
#include <cmath>

namespace taut {
namespace {

class Shortener {
 public:
  Shortener(std::vector<Coordinates>& path, const ShortenProblem& problem, const ShortenOptions& options)
      : path_(path), problem_(problem), options_(options) {}

  ShortenResult run() {
    result_.cost_before = result_.cost_after = total();
    for (double edges = kFewestEdges; edges <= options_.edges && may_go_on() && !is_shortest(); edges *= 2) {
      sweep_until_settled(result_.cost_after / edges);
    }
    leave_out();
    result_.cost_after = total();
    return result_;
  }

 private:
  // With few vertices the path takes its overall shape in a few sweeps; many vertices would need far more.
  static constexpr double kFewestEdges = 2.0;

  void sweep_until_settled(double edge_length) {
    for (int sweep = 0; sweep < options_.max_sweeps && may_go_on(); ++sweep) {
      leave_out();
      divide(edge_length);
      for (std::size_t k = 1; k + 1 < path_.size() && may_go_on(); ++k) relax(k);
      for (std::size_t k = path_.size() - 1; k-- > 1 && may_go_on();) relax(k);
      const double cost = total();
      const double gain = result_.cost_after - cost;
      result_.cost_after = cost;
      if (gain < options_.least_gain * cost || is_shortest()) break;
    }
  }

  [[nodiscard]] bool may_go_on() const {
    return result_.edges_checked < options_.max_edges_checked && !problem_.stop.stop_requested();
  }
  [[nodiscard]] bool is_shortest() const {
    return result_.cost_after <= (1 + options_.least_gain) * problem_.least_cost;
  }
  [[nodiscard]] bool project(Coordinates& vertex) const { return !problem_.project || problem_.project(vertex); }
  [[nodiscard]] double cost(std::size_t a, std::size_t b) const { return problem_.cost(path_[a], path_[b]); }
  [[nodiscard]] double total() const {
    double sum = 0;
    for (std::size_t k = 1; k < path_.size(); ++k) sum += cost(k - 1, k);
    return sum;
  }
  bool edge_ok(const Coordinates& a, const Coordinates& b) {
    ++result_.edges_checked;
    return problem_.edge_ok(a, b);
  }

  /// Joins a vertex straight to the farthest one for which that is allowed and not longer, trying ever nearer ones.
  void leave_out() {
    std::size_t from = 0;
    while (from + 2 < path_.size() && may_go_on()) {
      double along = 0;
      for (std::size_t k = from; k + 1 < path_.size(); ++k) along += cost(k, k + 1);
      std::size_t to = path_.size() - 1;
      while (to > from + 1) {
        if (cost(from, to) <= (1 + kLeastLocalGain) * along && edge_ok(path_[from], path_[to])) {
          path_.erase(path_.begin() + static_cast<std::ptrdiff_t>(from) + 1,
                      path_.begin() + static_cast<std::ptrdiff_t>(to));
          break;
        }
        const std::size_t nearer = from + 1 + (to - from - 1) / 2;
        for (std::size_t k = nearer; k < to; ++k) along -= cost(k, k + 1);
        to = nearer;
      }
      ++from;
    }
  }

  /// Halves edges until none is longer than `edge_length`. The halves of an edge that is ok are ok, but for rounding at
  /// the new vertex, so they are asked about.
  void divide(double edge_length) {
    for (std::size_t k = 0; k + 1 < path_.size() && may_go_on();) {
      Coordinates middle = 0.5 * (path_[k] + path_[k + 1]);
      const double whole = cost(k, k + 1);
      const bool divided =
          whole > edge_length && project(middle) && edge_ok(path_[k], middle) && edge_ok(middle, path_[k + 1]) &&
          problem_.cost(path_[k], middle) + problem_.cost(middle, path_[k + 1]) <= (1 + kCostTolerance) * whole;
      if (divided) {
        path_.insert(path_.begin() + static_cast<std::ptrdiff_t>(k) + 1, middle);
      } else {
        ++k;
      }
    }
  }

  /// Moves vertex k downhill on the cost of its two edges, halving the step until both are ok.
  void relax(std::size_t k) {
    const Coordinates& before = path_[k - 1];
    const Coordinates& after = path_[k + 1];
    const auto through = problem_.cost_through ? problem_.cost_through(before, after) : [&](const Coordinates& x) {
      return problem_.cost(before, x) + problem_.cost(x, after);
    };
    const auto local = [&](Coordinates x) { return project(x) ? through(x) : HUGE_VAL; };
    const double now = local(path_[k]);
    const Coordinates target = minimiser(path_[k], (after - before).norm(), local);
    const double best = local(target);
    if (!(best < now * (1 - kLeastLocalGain))) return;
    constexpr int kHalvings = 5;
    double step = 1.0;
    for (int halving = 0; halving < kHalvings && may_go_on(); ++halving, step *= 0.5) {
      Coordinates x = path_[k] + step * (target - path_[k]);
      if (project(x) && local(x) < now * (1 - kLeastLocalGain) && edge_ok(before, x) && edge_ok(x, after)) {
        path_[k] = x;
        return;
      }
    }
  }

  /// A few steps of steepest descent with central differences and a step that adapts.
  template <class F>
  static Coordinates minimiser(Coordinates x, double scale, const F& f) {
    constexpr int kSteps = 8;
    const double h = 1e-4 * scale;
    double value = f(x);
    double step = 0.25 * scale;
    for (int k = 0; k < kSteps && h > 0; ++k) {
      Coordinates gradient = x;  // all entries are set below
      for (int j = 0; j < x.size(); ++j) {
        Coordinates up = x;
        Coordinates down = x;
        up[j] += h;
        down[j] -= h;
        gradient[j] = (f(up) - f(down)) / (2 * h);
      }
      const double size = gradient.norm();
      if (!(size > 1e-9)) break;
      bool moved = false;
      for (int halving = 0; halving < 4 && !moved; ++halving) {
        const Coordinates trial = x - (step / size) * gradient;
        const double trial_value = f(trial);
        moved = trial_value < value;
        if (moved) {
          x = trial;
          value = trial_value;
        } else {
          step *= 0.4;
        }
      }
      if (!moved) break;
    }
    return x;
  }

  // The tolerance is relative because costs are measured by samples.
  static constexpr double kLeastLocalGain = 1e-6;
  static constexpr double kCostTolerance = 1e-4;

  std::vector<Coordinates>& path_;
  const ShortenProblem& problem_;
  const ShortenOptions& options_;
  ShortenResult result_;
};

}  // namespace

ShortenResult shorten(std::vector<Coordinates>& path, const ShortenProblem& problem, const ShortenOptions& options) {
  return Shortener(path, problem, options).run();
}

}  // namespace taut
