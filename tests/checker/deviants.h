// SPDX-License-Identifier: GPL-3.0-or-later
// Machines that deviate, for the tests of what tolerances take away: at random, and as far as they can.
#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "tests/checker/kernel.h"

namespace taut::checker {

inline std::string decimal(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9f", x);
  return text;
}

/// Tolerances that are about `size` times half a millimetre, some of them none at all.
inline TolerancesText tolerances(std::mt19937_64& random, double size, bool length_controlled) {
  const auto random_decimal = [&](double most) {
    return random() % 5 == 0 ? std::string("0") : decimal(size * most * uniform(random, 0.2, 1));
  };
  TolerancesText result;
  std::array<DecimalText, 6> lengths;
  for (std::size_t i = 0; i < 6; ++i) {
    result.base_anchor_m[i] = random_decimal(5e-4);
    result.platform_anchor_m[i] = random_decimal(5e-4);
    result.wrench[i] = (random() % 2 == 0 ? "-" : "") + random_decimal(i < 3 ? 0.02 : 0.001);
    lengths[i] = random_decimal(5e-4);
  }
  result.load_point_m = random_decimal(1e-3);
  result.position_m = random_decimal(5e-4);
  result.orientation_rad = random_decimal(3e-3);
  if (length_controlled) result.cable_length_m = lengths;
  return result;
}

/// The machine that deviates, and where it is.
template <class S>
struct Deviated {
  campaign::Machine<S> machine;
  campaign::RigidPose<S> pose;
};
/// Nothing where its pose is not found.
template <class S>
std::optional<Deviated<S>> deviated(const campaign::Machine<S>& machine, const campaign::Tolerances<S>& within,
                                    campaign::RigidPose<S> pose, const campaign::Deviation& by) {
  const campaign::Machine<S> deviant = campaign::deviate(machine, within, by);
  if (within.lengths_lead()) {
    const campaign::Six<S> commanded = campaign::lengths(machine, pose);
    constexpr int kSteps = 4;  // along the way to the deviation, so that no other assembly is found
    for (int step = 1; step <= kSteps; ++step) {
      const S share(static_cast<double>(step) / kSteps);
      campaign::Machine<S> between = machine;
      campaign::Six<S> wanted;
      for (std::size_t i = 0; i < 6; ++i) {
        if (within.length_controlled) {
          between.a[i] = machine.a[i] + share * (deviant.a[i] - machine.a[i]);
          between.b[i] = machine.b[i] + share * (deviant.b[i] - machine.b[i]);
        }
        wanted[i] = commanded[i] + share * within.length[i] * S(by.length[i]);
      }
      const auto found = campaign::hold(between, pose, wanted, 30);
      if (!found) return std::nullopt;
      pose = *found;
    }
  }
  pose.p = pose.p + campaign::scaled(within.position, by.position);
  pose.r = multiply(campaign::turn(campaign::scaled(within.turn, by.turn)), pose.r);
  return Deviated<S>{deviant, pose};
}
template <class S>
std::optional<campaign::StaticsAt<S>> deviating(const campaign::Machine<S>& machine,
                                                const campaign::Tolerances<S>& within,
                                                const campaign::RigidPose<S>& pose, const campaign::Deviation& by) {
  const auto there = deviated(machine, within, pose, by);
  if (!there) return std::nullopt;
  return campaign::statics(there->machine, there->pose);
}

/// Each block just inside of its unit ball.
inline void extend(campaign::Deviation& x) {
  campaign::for_each_block(x, [](std::span<double> block) {
    double size = 0;
    for (const double c : block) size += c * c;
    if (size == 0) return;
    for (double& c : block) c *= (1 - 1e-12) / std::sqrt(size);
  });
}

inline campaign::Deviation random_deviation(std::mt19937_64& random) {
  campaign::Deviation x;
  campaign::for_each_block(x, [&](std::span<double> block) {
    for (double& c : block) c = uniform(random, -1, 1);
  });
  extend(x);
  if (random() % 3 == 0) {
    campaign::for_each_block(x, [&](std::span<double> block) {
      const double part = uniform(random, 0, 1);
      for (double& c : block) c *= part;
    });
  }
  return x;
}

/// As far as possible up the gradient of what `target` says of the machine that deviates.
template <class Target>
campaign::Deviation steepest(const Target& target) {
  campaign::Deviation x;
  campaign::Deviation gradient;
  std::vector<double*> into;
  campaign::for_each_block(gradient, [&](std::span<double> block) {
    for (double& c : block) into.push_back(&c);
  });
  std::vector<double*> from;
  campaign::for_each_block(x, [&](std::span<double> block) {
    for (double& c : block) from.push_back(&c);
  });
  for (std::size_t k = 0; k < from.size(); ++k) {
    *from[k] = 0.05;
    const double up = target(x);
    *from[k] = -0.05;
    *into[k] = up - target(x);
    *from[k] = 0;
  }
  extend(gradient);
  return gradient;
}

}  // namespace taut::checker
