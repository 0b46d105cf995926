// SPDX-License-Identifier: GPL-3.0-or-later
// Why something stayed undecided: each reason with the words that certificates and messages tell it in, and a short
// code that stays.
#pragma once

#include <array>
#include <iosfwd>
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
  kKernel,
};
inline constexpr std::size_t kUndecidedReasons = 17;

/// The words for it, which may be followed by a place: "bisection depth reached at". For a single pose
/// `at_pose`, where other words fit better.
struct UndecidedWords {
  const char* words;
  const char* at_pose;
};
[[nodiscard]] UndecidedWords words(Undecided reason);

/// Why something stayed undecided, as certificates and messages say it: the words for one of the reasons, with what
/// stands before and behind them. It can't be made of anything else, so that every reason that is told has a code.
class Reason {
 public:
  Reason() = default;  ///< None: empty.
  Reason(Undecided reason,
         std::string_view behind = {});  // NOLINT(google-explicit-constructor): is one, without a place
  /// The reason in the words for a single pose. @pre There are such words.
  [[nodiscard]] static Reason at_pose(Undecided reason);
  [[nodiscard]] Reason preceded_by(std::string_view before) const;

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] bool empty() const { return text_.empty(); }
  friend std::ostream& operator<<(std::ostream& out, const Reason& reason);

 private:
  std::string text_;
};

/// The code of a reason, as "U3".
[[nodiscard]] std::string code(Undecided reason);

/// The reason that a text tells, in a message or in a certificate; nothing where it is none of ours.
[[nodiscard]] std::optional<Undecided> undecided_reason(std::string_view text);

/// The text with the code of its reason behind it: "… singular or nearly so [U5]"; without, where it has none.
[[nodiscard]] std::string with_code(const std::string& text);

}  // namespace taut
