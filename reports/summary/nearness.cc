// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/nearness.h"

#include <algorithm>

namespace taut {

namespace {

constexpr double kNearTension = 0.75;  ///< of a limit of tension
constexpr double kCloseTension = 0.95;
constexpr double kNearLength = 0.05;  ///< of the width between the limits of length
constexpr double kCloseLength = 0.02;
constexpr double kNearBodies = 0.01;  ///< of the size of the machine, where no clearance is asked for
constexpr double kCloseBodies = 0.002;

Nearness by_use(double used) {
  if (!(used < 1)) return Nearness::kOut;
  if (used >= kCloseTension) return Nearness::kClose;
  return used >= kNearTension ? Nearness::kNear : Nearness::kCalm;
}

}  // namespace

const char* name(Nearness nearness) {
  switch (nearness) {
    case Nearness::kCalm: return "calm";
    case Nearness::kNear: return "near";
    case Nearness::kClose: return "close";
    case Nearness::kOut: break;
  }
  return "out";
}

Nearness worse(Nearness a, Nearness b) { return std::max(a, b); }

Nearness nearness_to_slack(const Range& tension, double lower_limit, double upper_limit) {
  if (!(tension.lower > lower_limit)) return Nearness::kOut;
  if (lower_limit > 0) return by_use(lower_limit / tension.lower);
  return by_use(1 - (tension.lower - lower_limit) / (upper_limit - lower_limit));
}

Nearness nearness_to_top(const Range& tension, double upper_limit) {
  if (!(tension.upper < upper_limit)) return Nearness::kOut;
  return upper_limit > 0 ? by_use(tension.upper / upper_limit) : Nearness::kClose;
}

Nearness nearness_of_length(const Range& length, double lower_limit, double upper_limit) {
  if (!(length.lower > lower_limit && length.upper < upper_limit)) return Nearness::kOut;
  const double left = std::min(length.lower - lower_limit, upper_limit - length.upper) / (upper_limit - lower_limit);
  if (left < kCloseLength) return Nearness::kClose;
  return left < kNearLength ? Nearness::kNear : Nearness::kCalm;
}

Nearness nearness_of_bodies(double distance, double clearance, double size) {
  if (!(distance > clearance)) return Nearness::kOut;
  if (clearance > 0) return by_use(clearance / distance);
  if (clearance < 0) return by_use(distance / clearance);  // of the depth
  if (distance < kCloseBodies * size) return Nearness::kClose;
  return distance < kNearBodies * size ? Nearness::kNear : Nearness::kCalm;
}

}  // namespace taut
