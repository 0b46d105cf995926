// SPDX-License-Identifier: GPL-3.0-or-later
// How near a cable comes to its limits: one rule for the first page's colours, the pictures and the plots.
#pragma once

#include "certificate/certificate.h"
#include "certify/box_ranges.h"

namespace taut {

/// Calm is drawn grey, near amber, close vermilion, and out of the limits red.
enum class Nearness { kCalm, kNear, kClose, kOut };

/// "calm", "near", "close" or "out": the names of the style sheet's classes and of JSON.
[[nodiscard]] const char* name(Nearness nearness);
/// The worse of the two.
[[nodiscard]] Nearness worse(Nearness a, Nearness b);

/// How near a tension comes to going slack: by the limit as a share of the least tension, near from 75 % and close from
/// 95 %; where the limit is not positive, by the distance to it as a share of the width between the limits, near below
/// 25 % and close below 5 %.
[[nodiscard]] Nearness nearness_to_slack(const Range& tension, double lower_limit, double upper_limit);
/// How near it comes to its upper limit: by the greatest tension as a share of that limit, near from 75 %, close from
/// 95 %.
[[nodiscard]] Nearness nearness_to_top(const Range& tension, double upper_limit);
/// How near a length comes to either of its limits: by what is left as a share of the width between them, near below
/// 5 % and close below 2 %.
[[nodiscard]] Nearness nearness_of_length(const Range& length, double lower_limit, double upper_limit);

/// How near two bodies come to the clearance asked of them: by the clearance as a share of their distance, near from
/// 75 % and close from 95 %; where it is 0, by the distance as a share of `size`, such as that of the machine, near
/// below 1 % and close below 0.2 %. @param distance  in m, like the others
[[nodiscard]] Nearness nearness_of_bodies(double distance, double clearance, double size);

}  // namespace taut
