// SPDX-License-Identifier: GPL-3.0-or-later
// Set-up at the start of a program, which makes it end with one of its own exit codes whatever happens.
#pragma once

namespace taut {

/// Call this once, before any other initialisation. `program` is the program's name in messages, `code` the code that
/// messages of internal failures end with; it may be empty.
///
/// Standard streams that are closed are replaced by ones on which every use fails. Otherwise a file opened later would
/// take the number of the stream, and messages would be written into it. Whatever would abort the program (an exception
/// that cannot be caught, GMP without memory, a failed assertion, a stack that cannot grow under a limit of memory)
/// writes a line to stderr and ends the program with exit code 4, an internal failure.
void prepare_process(const char* program, const char* code) noexcept;

}  // namespace taut
