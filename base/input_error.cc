// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/input_error.h"

#include <fmt/format.h>

namespace taut {

FieldError::FieldError(std::string field, std::string seen, std::string expected)
    : InputError(fmt::format("{}: {}{}", field, seen.empty() ? "" : "got " + seen + ", ", expected), {"", 0, field}),
      field_(std::move(field)),
      seen_(std::move(seen)),
      expected_(std::move(expected)) {}

}  // namespace taut
