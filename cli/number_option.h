// SPDX-License-Identifier: GPL-3.0-or-later
// Options that are numbers.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <string>

namespace taut {

/// Accepts a finite decimal number for which `is_accepted` is true; `expected` describes such numbers in messages.
inline CLI::Validator number(const std::string& expected, bool (*is_accepted)(double)) {
  const auto complaint = [=](const std::string& text) -> std::string {
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto [read, error] = std::from_chars(text.data() + (text.starts_with('+') ? 1 : 0), end, value);
    const bool is_number = error == std::errc() && read == end && std::isfinite(value);
    return is_number && is_accepted(value) ? "" : fmt::format("got '{}', expected {}", text, expected);
  };
  return {complaint, ""};
}

inline CLI::Validator positive_number(const std::string& expected = "a number above 0") {
  return number(expected, [](double value) { return value > 0; });
}

}  // namespace taut
