// SPDX-License-Identifier: GPL-3.0-or-later
// The verdict and the numbers that a move is judged by, for people on standard output: what commands print first.
#pragma once

#include <string>

#include "reports/summary/summary.h"

namespace taut {

/// Prints "REFUTED - DO NOT RUN: at waypoint …", wrapped and coloured on a terminal.
/// @param word      as verdict_in_full() has it, or "UNCHECKED"
/// @param sentence  what follows it; may have several lines
void print_verdict(const std::string& word, const std::string& sentence);

/// Prints the key numbers of the report's first page, a line each.
void print_key_numbers(const std::vector<KeyNumber>& numbers);

/// Prints what to_text() made of a summary: its first line begins with the verdict and a colon.
void print_text_report(const std::string& text);

}  // namespace taut
