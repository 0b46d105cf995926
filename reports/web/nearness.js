// SPDX-License-Identifier: GPL-3.0-or-later
// How near a cable is to its limits: the same rule as reports/summary/nearness.cc.

export const NEARNESS = ["calm", "near", "close", "out"];

const byUse = (used) => (!(used < 1) ? 3 : used >= 0.95 ? 2 : used >= 0.75 ? 1 : 0);

const toSlack = (least, lower, upper) => {
  if (!(least > lower)) return 3;
  return byUse(lower > 0 ? lower / least : 1 - (least - lower) / (upper - lower));
};

const toTop = (greatest, upper) => {
  if (!(greatest < upper)) return 3;
  return upper > 0 ? byUse(greatest / upper) : 2;
};

const ofLength = (length, lower, upper) => {
  if (!(length > lower && length < upper)) return 3;
  const left = Math.min(length - lower, upper - length) / (upper - lower);
  return left < 0.02 ? 2 : left < 0.05 ? 1 : 0;
};

/// One of NEARNESS: to the nearest limit of a cable, for tensions from `least` to `greatest` and a length; `slack` is
/// how far beyond its limits a length may seem to be, as samples are rounded. NaN is out.
export function nearness([least, greatest], [lower, upper], length, [shortest, longest], slack = 0) {
  const d = ofLength(length, shortest - slack, longest + slack);
  return NEARNESS[Math.max(toSlack(least, lower, upper), toTop(greatest, upper), d)];
}
