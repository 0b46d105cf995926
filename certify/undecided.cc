// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/undecided.h"

#include <ostream>

namespace taut {

UndecidedWords words(Undecided reason) {
  switch (reason) {
    case Undecided::kWaypointRange:
      return {"a waypoint lies outside the closed range of a parameter, or may",
              "it lies outside the closed range of a parameter, or its nearest binary64 does"};
    case Undecided::kParameterRange:
      return {"a parameter leaves its closed range, or may", "a parameter is outside its closed range, or may be"};
    case Undecided::kUndefined:
      return {"the pose or an equation is not defined on all of the box",
              "the pose or an equation is not defined there"};
    case Undecided::kNoMotion:
      return {
          "no single motion was proved to exist there (on the constraints, with the cables' lengths, or between "
          "orientations half a turn apart)",
          "no single pose on the constraints was proved to exist there"};
    case Undecided::kSingular:
      return {"the force Jacobian is singular or nearly so", "the force Jacobian is singular, or nearly so, there"};
    case Undecided::kTolerances: return {"the tolerances are too large for a proof at", nullptr};
    case Undecided::kPrecision: return {"precision reached at", "a margin vanishes there, or nearly so"};
    case Undecided::kDepth: return {"bisection depth reached at", nullptr};
    case Undecided::kBoxBudget: return {"the budget of boxes is spent", nullptr};
    case Undecided::kClearance: return {"closer to a limit than the clearance asked for", nullptr};
    case Undecided::kInterrupted: return {"interrupted", nullptr};
    case Undecided::kNoSegment: return {"the path has no segment", nullptr};
    case Undecided::kNoPathFound: return {"the component of the start was covered by", nullptr};
    case Undecided::kChartBudget: return {"charts is spent", nullptr};
    case Undecided::kTimeBudget: return {" s is spent", nullptr};
    case Undecided::kOutsideManifold:
      return {"of the query cannot be held within the limits, in floating point", nullptr};
    case Undecided::kKernel: return {"the checker's kernel does not confirm what was found", nullptr};
    case Undecided::kSlowing: return {"a limit may not be kept while the move is slowed down", nullptr};
    case Undecided::kBodies: return {"bodies were not proved to stay apart:", nullptr};
  }
  return {"", nullptr};
}

Reason::Reason(Undecided reason, std::string_view behind) : text_(words(reason).words) { text_ += behind; }

Reason Reason::at_pose(Undecided reason, std::string_view behind) {
  Reason result;
  result.text_ = words(reason).at_pose;
  result.text_ += behind;
  return result;
}

Reason Reason::preceded_by(std::string_view before) const {
  Reason result = *this;
  result.text_.insert(0, before);
  return result;
}

std::ostream& operator<<(std::ostream& out, const Reason& reason) { return out << reason.text_; }

std::string code(Undecided reason) { return "U" + std::to_string(static_cast<int>(reason) + 1); }

std::optional<Undecided> undecided_reason(std::string_view text) {
  for (std::size_t k = 0; k < kUndecidedReasons; ++k) {
    const auto reason = static_cast<Undecided>(k);
    const UndecidedWords known = words(reason);
    if (text.find(known.words) != std::string_view::npos) return reason;
    if (known.at_pose != nullptr && text.find(known.at_pose) != std::string_view::npos) return reason;
  }
  return std::nullopt;
}

std::string with_code(const std::string& text) {
  const std::optional<Undecided> reason = undecided_reason(text);
  return reason ? text + " [" + code(*reason) + "]" : text;
}

}  // namespace taut
