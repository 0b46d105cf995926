// SPDX-License-Identifier: GPL-3.0-or-later
// What a report says that is not in the certificate: how the document is called, and what the independent checker found.
#pragma once

#include <string>

namespace taut {

/// How the independent checker ended with the certificate. There is no report of a certificate that it rejects.
struct Recheck {
  enum class Result {
    kUnchecked,  ///< it was not proved within the budget: nothing is known of what the certificate claims
    kNoClaim,    ///< well formed, and claims nothing
    kConfirmed,  ///< there is a theorem: the claim, "proved" or "refuted", was proved again
  };
  Result result = Result::kUnchecked;
  std::string checker;  ///< "taut-check 0.1.0"
  std::string message;  ///< the checker's line
};

struct ReportOptions {
  std::string document;  ///< the document's number; empty: one made from the certificate's digest
  std::string revision;  ///< empty: a line to write on
  std::string date;      ///< of the report; empty: a line to write on
};

}  // namespace taut
