// SPDX-License-Identifier: GPL-3.0-or-later
// The content of a report that is not in the certificate: the document's name, and the independent checker's result.
#pragma once

#include <string>

namespace taut {

/// The independent checker's result. There is no report of a certificate that it rejects.
struct Recheck {
  enum class Result {
    kUnchecked,  ///< the check did not end within the budget: nothing is known about the certificate's claims
    kNoClaim,    ///< the certificate is well formed and claims nothing
    kConfirmed,  ///< there is a theorem: the claim, "proved" or "refuted", was proved again
  };
  Result result = Result::kUnchecked;
  std::string checker;   ///< "taut-check 0.1.0"
  std::string message;   ///< the checker's line
  std::string sha256{};  ///< of the certificate's bytes, as sha256sum prints it; empty where they are not known
};

struct ReportOptions {
  std::string document;  ///< the document's number; empty: the case's, else one made from the certificate's digest
  std::string revision;  ///< empty: a line to write on
  std::string date;      ///< of the report; empty: a line to write on
};

}  // namespace taut
