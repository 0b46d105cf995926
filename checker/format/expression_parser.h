// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the expressions of certificates by recursive descent (docs/certificate-format.md):
//
//     sum      = product { ("+" | "-") product }
//     product  = unary { ("*" | "/") unary }
//     unary    = "-" unary | atom [ "^" exponent ]
//     atom     = decimal | name | function "(" sum [ "," sum ] ")" | "(" sum ")"
//     exponent = integer [ "^" exponent ] | "-" exponent | "(" exponent ")"
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "checker/kernel/expression.h"

namespace taut::checker {

/// The names that an expression may mention besides pi and the functions. With none of them it is a constant.
struct Names {
  std::vector<std::string> parameters;
  std::map<std::string, mpq_class> constants;
};

/// @throws Malformed with `where`, the column and what was expected.
[[nodiscard]] Expression parse_expression(const std::string& text, const Names& names, const std::string& where);

[[nodiscard]] bool mentions(const Expression& expression, std::size_t parameter);

/// The integer k for which the value grows by 2 pi k when the parameter grows by 2 pi, whatever the other parameters
/// are. @returns nothing where the form of the expression does not show such a k: "Periodic parameters" in
/// docs/certificate-format.md.
[[nodiscard]] std::optional<long> turns(const Expression& expression, std::size_t parameter);

/// Whether `name` may name a parameter or a constant: an identifier that is neither `pi` nor a function.
[[nodiscard]] bool is_free_name(const std::string& name);

}  // namespace taut::checker
