// Why something stayed undecided: each reason with the words that certificates and messages tell it in, and a short code that stays.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace taut {

/// In the order of their codes, U1 first: new ones go to the end.
enum class Undecided {
  kWaypointRange,
  kParameterRange,
  kUndefined,
  kNoMotion,
  kSingular,
  kTolerances,
  kPrecision,
  kDepth,
  kBoxBudget,
  kClearance,
  kInterrupted,
  kNoSegment,
  kNoPathFound,
  kChartBudget,
  kTimeBudget,
  kOutsideManifold,
};
inline constexpr std::size_t kUndecidedReasons = 16;

/// The words for it, which may be followed by a place: "bisection depth reached at". Of a single pose, where others fit better: `at_pose`.
struct UndecidedWords {
  const char* words;
  const char* at_pose;
};
[[nodiscard]] UndecidedWords words(Undecided reason);

/// "U3"
[[nodiscard]] std::string code(Undecided reason);

/// The reason that a text tells, in a message or in a certificate; nothing where it is none of ours.
[[nodiscard]] std::optional<Undecided> undecided_reason(std::string_view text);

/// The text with the code of its reason behind it: "… singular or nearly so [U5]"; without, where it has none.
[[nodiscard]] std::string with_code(const std::string& text);

}  // namespace taut
