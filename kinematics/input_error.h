// The outside world is wrong: a case file, a path, a flag, a certificate. Caught once, in main; exit code 3.
#pragma once

#include <stdexcept>
#include <string>

namespace taut {

/// Names the place, the value seen and what was expected: "robot.yaml:12: load.mass: got 'NaN', expected a
/// positive decimal".
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace taut
