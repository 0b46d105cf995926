// SPDX-License-Identifier: GPL-3.0-or-later
// What a program sets up before anything else, so that it ends with an exit code of its own whatever happens.
#pragma once

namespace taut {

/// To be called once, before any other initialisation. `program` is its name in messages, `code` that of an internal
/// failure, or empty.
///
/// Standard streams that are closed are replaced by ones that fail, so that no file that is opened later takes their
/// number and is written to by a message. What would abort the program (an exception that cannot be caught, GMP without
/// memory, a failed assertion) writes a line to stderr and ends the program with exit code 4, an internal failure.
void prepare_process(const char* program, const char* code) noexcept;

}  // namespace taut
