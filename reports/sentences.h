// What a certificate says, in sentences that an engineer would sign. Plain text: the page, the text and the Markdown summaries
// say the same words.
#pragma once

#include <string>
#include <vector>

#include "reports/scene.h"

namespace taut {

/// The verdict, first in one sentence, then with what was proved, or what is wrong and where.
[[nodiscard]] std::vector<std::string> verdict_text(const Scene& scene);

}  // namespace taut
