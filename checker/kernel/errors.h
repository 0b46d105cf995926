// SPDX-License-Identifier: GPL-3.0-or-later
// What can go wrong while a certificate is checked: four kinds, each with its own type.
#pragma once

#include <stdexcept>

namespace taut::checker {

/// The file is not a certificate: unreadable, cut, altered, or against docs/certificate-format.md. Exit code 3.
struct Malformed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Well formed, but a statement in it is false or was not confirmed. Exit code 1.
struct Rejected : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// An enclosure was asked for where it does not exist: division by what may be zero, a root of what may be negative,
/// a matrix that may be singular, a zero that may leave its box. Says nothing about the truth of a certificate by
/// itself; a checker rejects the statement that needed the enclosure, and a prover splits the box.
struct Undefined : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Somebody asked to stop, or the time that was allowed is over.
struct Interrupted : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace taut::checker
