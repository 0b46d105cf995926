// Options that are numbers.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

#include "base/input_error.h"
#include "problem/decimal.h"
#include "problem/scalar.h"

namespace taut {

/// Accepts a decimal number for which `is_accepted` is true; `expected` describes such numbers in messages.
inline CLI::Validator number(const std::string& expected, bool (*is_accepted)(double)) {
  const auto complaint = [=](const std::string& text) -> std::string {
    try {
      if (is_accepted(ScalarTraits<double>::from_decimal(Decimal::parse(text).text()))) return "";
    } catch (const InputError&) {  // then it isn't a number
    }
    return fmt::format("got '{}', expected {}", text, expected);
  };
  return {complaint, ""};
}

inline CLI::Validator positive_number(const std::string& expected = "a number above 0") {
  return number(expected, [](double value) { return value > 0; });
}

}  // namespace taut
