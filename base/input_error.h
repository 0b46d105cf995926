// SPDX-License-Identifier: GPL-3.0-or-later
// Errors in what comes from outside: a case file, a path, a flag, a certificate. They are caught once, in main, and end
// the program with exit code 3.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/sanitize.h"

namespace taut {

/// The place of the error, as far as it is known; the message names it, too.
struct InputPlace {
  std::string file = {};
  std::size_t line = 0;    ///< from 1; 0: unknown, or the file as a whole
  std::string field = {};  ///< in a case, "load.mass"; in a table, the column
};

/// The message names the place, the value seen and what was expected: "robot.yaml:12: load.mass: got 'NaN', expected a
/// positive decimal". It is one line without characters that steer a terminal, whatever the file contains.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message, InputPlace place = {})
      : std::runtime_error(sanitize(message)), place_(std::move(place)) {}
  [[nodiscard]] const InputPlace& place() const { return place_; }

 private:
  InputPlace place_;
};

/// A field of a problem is wrong: "robot.length[2]: got [0.5, 0.1], expected 0 <= lower < upper".
class FieldError : public InputError {
 public:
  FieldError(std::string field, std::string seen, std::string expected);
  [[nodiscard]] const std::string& field() const { return field_; }
  [[nodiscard]] const std::string& seen() const { return seen_; }  ///< may be empty
  [[nodiscard]] const std::string& expected() const { return expected_; }

 private:
  std::string field_, seen_, expected_;
};

}  // namespace taut
