// What a report says that is not in the certificate: how the document is called, and what the independent checker found.
#pragma once

#include <string>

namespace taut {

/// What became of the certificate at the independent checker.
struct Recheck {
  enum class Result {
    kNotRun,
    kConfirmed,  ///< the claim, "proved" or "refuted", was proved again
    kNoClaim,    ///< well formed, and claims nothing
    kRejected,   ///< some statement could not be confirmed, or it is malformed: nothing in it may be relied on
  };
  Result result = Result::kNotRun;
  std::string checker;  ///< "taut-check 0.1.0"
  std::string message;  ///< the checker's line, or why it was not run
};

struct ReportOptions {
  std::string document;  ///< the document's number; empty: one made from the certificate's digest
  std::string revision;  ///< empty: a line to write on
  std::string date;      ///< of the report; empty: a line to write on
  Recheck recheck;
};

}  // namespace taut
