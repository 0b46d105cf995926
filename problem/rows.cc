// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/rows.h"

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/sanitize.h"
#include "problem/decimal.h"

namespace taut {
namespace {

constexpr const char* kPlace = "time.rows";

/// a h²/8: how far a length that runs straight between two rows of a move may be from the move's.
Rational sag(const TimeText& time, std::size_t i, const Rational& step_s) {
  const TimeText::Limit& limit = time.winch_acceleration_m_s2[i];
  if (!limit) {
    throw FieldError(kPlace, fmt::format("no limit of the acceleration of winch {}", i + 1),
                     "expected one of all six, under time.winches.acceleration: how far lengths that run straight "
                     "between two rows may be from the move's depends on it");
  }
  try {
    return evaluate_exactly(*limit) * step_s * step_s / 8;
  } catch (const InputError&) {
    throw FieldError(fmt::format("time.winches.acceleration[{}]", i), "'" + excerpt(*limit) + "'",
                     "expected a number, as the errors of rows are made of it");
  }
}

/// The least multiple of 1e-12 that is not below x >= 0.
DecimalText rounded_up(const Rational& x) {
  using boost::multiprecision::cpp_int;
  constexpr std::int64_t kParts = 1'000'000'000'000;
  const Rational parts = x * kParts;
  const cpp_int whole = (numerator(parts) + denominator(parts) - 1) / denominator(parts);
  return Decimal::parse(whole.str() + "e-12").text();
}

}  // namespace

RowsText rows_between(const TimeText& time, const Rational& step_s, const std::array<Rational, kCables>& off_m) {
  RowsText rows{rounded_up(step_s), {}};
  const Rational step = Decimal::parse(rows.step_s).rational();
  const Rational rounding = Decimal::parse(kRowRounding_m).rational();
  for (std::size_t i = 0; i < kCables; ++i) rows.error_m[i] = rounded_up(sag(time, i, step) + off_m[i] + rounding);
  return rows;
}

void validate_rows(const TimeText& time) {
  const RowsText& rows = *time.rows;
  const auto number = [](const char* key, const DecimalText& text) {
    try {
      return Decimal::parse(text).rational();
    } catch (const InputError& error) {
      throw FieldError(fmt::format("{}.{}", kPlace, key), "'" + excerpt(text) + "'", error.what());
    }
  };
  const Rational step = number("step_s", rows.step_s);
  if (step <= 0) {
    throw FieldError(fmt::format("{}.step_s", kPlace), rows.step_s, "expected a time above zero between two rows");
  }
  for (std::size_t i = 0; i < kCables; ++i) {
    if (number("error_m", rows.error_m[i]) > sag(time, i, step)) continue;
    throw FieldError(fmt::format("{}.error_m[{}]", kPlace, i), rows.error_m[i],
                     "expected more than an eighth of the square of the time between two rows, times the limit of that "
                     "winch's acceleration");
  }
}

}  // namespace taut
