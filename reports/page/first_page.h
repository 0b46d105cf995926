// SPDX-License-Identifier: GPL-3.0-or-later
// The report's first page: everything that the person who signs it has to know, usually on one sheet of A4.
#pragma once

#include "reports/page/markup.h"
#include "reports/summary/summary.h"

namespace taut {

/// Scope, verdict, the numbers that matter, the machine where it matters most, what is not covered, and the declaration
/// to sign. A move that is not proved has what stands against it in place of the six cables.
[[nodiscard]] Html first_page(const ReportContext& scene, const Summary& summary);

/// The line above the title: what the document is, its number, revision and date, or lines to write on.
[[nodiscard]] Html masthead(const std::string& document, const std::string& revision, const std::string& date);
/// What stands below a title: that nothing checks it.
[[nodiscard]] Html title_note();
/// The load in words, with its items.
[[nodiscard]] Html load_words(const std::string& load_name, const LoadStatement& load);
/// A tick of "proved", a cross of "refuted", else an exclamation mark.
[[nodiscard]] Html verdict_icon(const std::string& verdict);

/// What the first page says briefly, in full: motion, proof and re-check.
[[nodiscard]] Html verdict_section(const Summary& summary);

/// The six cables of a move that is not proved, behind the first page.
[[nodiscard]] Html cables_section(const ReportContext& scene, const Summary& summary);

}  // namespace taut
