// What can go wrong while a certificate is checked: three kinds, each with its own type.
#pragma once

#include <stdexcept>

namespace taut::checker {

/// The file is not a certificate: unreadable, cut, altered, or against docs/certificate-format.md. Exit code 3.
struct Malformed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Well formed, but a statement in it is false or could not be confirmed. Exit code 1.
struct Rejected : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// An enclosure was asked for where the function may be undefined (or has no bounded derivative) on part of the
/// box: division by something that may be zero, a root of something that may be negative, a matrix that may be
/// singular. Says nothing about the certificate by itself: the box is split, and rejected if that does not help.
struct Undefined : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace taut::checker
