// SPDX-License-Identifier: GPL-3.0-or-later
// Errors in what comes from outside: a case file, a path, a flag, a certificate. They are caught once, in main, and end
// the program with exit code 3.
#pragma once

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/sanitize.h"

namespace taut {

/// What kind of input is wrong: the short codes that `taut explain` explains. E1 comes first; new ones go to the end.
enum class ErrorCode {
  kUse,          ///< the command line
  kFile,         ///< a file or directory can't be read or written
  kCase,         ///< a case file, or the case in it
  kPath,         ///< a path to be audited
  kCertificate,  ///< not a certificate, an altered one, or one of another version
  kAtlas,        ///< a file with an atlas
  kKey,          ///< a key that signs
  kBrowser,      ///< there is none to print with
  kRegress,      ///< a folder of cases, or its baseline
};
inline constexpr std::size_t kErrorCodes = 9;

/// "E3"
[[nodiscard]] inline std::string text(ErrorCode code) { return "E" + std::to_string(static_cast<int>(code) + 1); }

/// Where the outside world is wrong, as far as it is known; the message says it, too.
struct InputPlace {
  std::string file = {};
  std::size_t line = 0;    ///< from 1; 0: unknown, or the file as a whole
  std::string field = {};  ///< in a case, "load.mass"; in a table, the column
};

/// The message names the place, the value seen and what was expected: "robot.yaml:12: load.mass: got 'NaN', expected a
/// positive decimal". It is one line without characters that steer a terminal, whatever the file contains.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message, InputPlace place = {}, std::optional<ErrorCode> code = {})
      : std::runtime_error(sanitize(message)), place_(std::move(place)), code_(code) {}
  InputError(ErrorCode code, const std::string& message, InputPlace place = {})
      : InputError(message, std::move(place), code) {}
  [[nodiscard]] const InputPlace& place() const { return place_; }
  [[nodiscard]] std::optional<ErrorCode> code() const { return code_; }

 private:
  InputPlace place_;
  std::optional<ErrorCode> code_;
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

/// Calls `read`; an InputError without a code that it throws gets this one.
template <class Read>
decltype(auto) with_error_code(ErrorCode code, Read read) {
  try {
    return read();
  } catch (const InputError& error) {
    if (error.code()) throw;
    throw InputError(code, error.what(), error.place());
  }
}

/// The same for what comes from a file: if the error names no file, this one's name begins the message.
template <class Read>
decltype(auto) with_error_code(ErrorCode code, const std::string& file, Read read) {
  return with_error_code(code, [&]() -> decltype(auto) {
    try {
      return read();
    } catch (const InputError& error) {
      const InputPlace& place = error.place();
      if (error.code() || !place.file.empty()) throw;
      throw InputError(file + ": " + error.what(), {file, place.line, place.field});
    }
  });
}

}  // namespace taut
