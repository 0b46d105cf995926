// SPDX-License-Identifier: GPL-3.0-or-later
// Exact numbers as text: what all parts of a problem are made of.
#pragma once

#include <string>

namespace taut {

inline constexpr int kCables = 6;

/// A decimal literal such as "-0.0210" or "1e-4": exactly that rational number.
using DecimalText = std::string;
/// An expression in the grammar of docs/certificate-format.md.
using ExpressionText = std::string;

}  // namespace taut
