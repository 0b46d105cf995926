// SPDX-License-Identifier: GPL-3.0-or-later
// Case files that may have legs: paths that follow one another, each with a load and bodies of its own
// (docs/case-format.md, "query"). load_case() refuses them, so that nobody takes a leg for the whole.
#pragma once

#include <string>
#include <vector>

#include "case/case_file.h"

namespace taut {

struct CaseLeg {
  std::string name;  ///< 1 to 40 letters, digits, '-' and '_', the first a letter or a digit
  Case content;      ///< an ordinary case, whose problem is named "CASE, leg NAME"; it expects nothing
};

/// A case file's content. Where it has legs, `whole` has no query; all else of it is that of the first leg, but for
/// name and expectation.
struct CaseOfLegs {
  Case whole;
  std::vector<CaseLeg> legs;  ///< two or more; none of a case without legs
};

/// As load_case(), of cases with and without legs. @param check  of a case with legs is called with each leg
[[nodiscard]] CaseOfLegs load_case_of_legs(const std::string& path, const CaseCheck& check = {});
/// As load_case_of_legs(), from text; `name` stands for the file in messages.
[[nodiscard]] CaseOfLegs parse_case_of_legs(const std::string& text, const std::string& name,
                                            const CaseCheck& check = {});

}  // namespace taut
