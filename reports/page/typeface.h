// SPDX-License-Identifier: GPL-3.0-or-later
// The typeface that the report's page is set in, so that it looks the same everywhere, on paper too: the letters that
// reports need of Inter, and of Noto Sans Math the few signs that Inter lacks.
#pragma once

#include <string_view>

namespace taut {

/// The style sheet's `@font-face` rules, with the fonts in them. They begin with the fonts' licence.
[[nodiscard]] std::string_view page_typeface();

}  // namespace taut
