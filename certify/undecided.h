// SPDX-License-Identifier: GPL-3.0-or-later
// Why something stayed undecided: each reason has words, for certificates and messages, and a short code that never
// changes.
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
  kBodies,
  kSlowing,
};
inline constexpr std::size_t kUndecidedReasons = 19;

/// The words for a reason, which may be followed by a place: "bisection depth reached at". `at_pose` has words for a
/// single pose, or is null.
struct UndecidedWords {
  const char* words;
  const char* at_pose;
};
[[nodiscard]] UndecidedWords words(Undecided reason);

/// Why something stayed undecided, as certificates and messages say it: the words for one of the reasons, with text
/// before and after them. It can't be made from anything else, so every stated reason has a code.
class Reason {
 public:
  Reason() = default;  ///< None: empty.
  Reason(Undecided reason,
         std::string_view behind = {});  // NOLINT(google-explicit-constructor): is one, without a place
  /// The words for a single pose. @pre There are such words.
  [[nodiscard]] static Reason at_pose(Undecided reason, std::string_view behind = {});
  [[nodiscard]] Reason preceded_by(std::string_view before) const;

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] bool empty() const { return text_.empty(); }
  friend std::ostream& operator<<(std::ostream& out, const Reason& reason);

 private:
  std::string text_;
};

/// The code of a reason, as "U3".
[[nodiscard]] std::string code(Undecided reason);

/// The reason that the text of a message or certificate states; nothing if it is none of these.
[[nodiscard]] std::optional<Undecided> undecided_reason(std::string_view text);

/// The text followed by the code of its reason, "… singular or nearly so [U5]"; unchanged if it states none.
[[nodiscard]] std::string with_code(const std::string& text);

}  // namespace taut
