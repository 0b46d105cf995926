// SPDX-License-Identifier: GPL-3.0-or-later
// What kind of input is wrong: what stands behind an error's code.
#pragma once

#include <cstddef>
#include <string>

#include "base/input_error.h"

namespace taut {

/// Each has a short code that stays, E1 first; new ones go to the end.
enum class InputKind {
  kUse,          ///< the command line
  kFile,         ///< a file or directory can't be read or written
  kCase,         ///< a case file, or the case in it
  kPath,         ///< a path to be audited
  kCertificate,  ///< a certificate that is none, was altered, or is of another version
  kAtlas,        ///< a file with an atlas
  kKey,          ///< a key that signs
  kBrowser,      ///< there is none to print with
  kRegress,      ///< a folder of cases, or its baseline
};
inline constexpr std::size_t kInputKinds = 9;

/// "E3"
[[nodiscard]] inline std::string code(InputKind kind) { return "E" + std::to_string(static_cast<int>(kind) + 1); }

/// An InputError of a known kind.
class InputErrorOfKind : public InputError {
 public:
  InputErrorOfKind(const InputError& error, InputKind kind) : InputError(error.what(), error.place()), kind_(kind) {}
  InputErrorOfKind(InputKind kind, const std::string& message, InputPlace place = {})
      : InputError(message, std::move(place)), kind_(kind) {}
  [[nodiscard]] InputKind kind() const { return kind_; }

 private:
  InputKind kind_;
};

/// Calls `read`; an InputError that it throws is of that kind, unless it is known to be of another.
template <class Read>
decltype(auto) reading(InputKind kind, Read read) {
  try {
    return read();
  } catch (const InputErrorOfKind&) {
    throw;
  } catch (const InputError& error) {
    throw InputErrorOfKind(error, kind);
  }
}

/// The same of what came from a file: its name begins the message, unless the error names one.
template <class Read>
decltype(auto) reading(InputKind kind, const std::string& file, Read read) {
  return reading(kind, [&]() -> decltype(auto) {
    try {
      return read();
    } catch (const InputErrorOfKind&) {
      throw;
    } catch (const InputError& error) {
      const InputPlace& place = error.place();
      if (!place.file.empty()) throw;
      throw InputError(file + ": " + error.what(), {file, place.line, place.field});
    }
  });
}

}  // namespace taut
