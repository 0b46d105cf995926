// SPDX-License-Identifier: GPL-3.0-or-later
// Builds the tape for the parser of expressions: each distinct operation gets one instruction. Internal.
#pragma once

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "problem/expression.h"

namespace taut {

class TapeBuilder {
 public:
  TapeBuilder(const std::vector<std::string>& parameters, const std::map<std::string, DecimalText>& constants);

  // Each returns the slot of its value; equal operations share one slot.
  // @throws InputError ("expected …", no position) for a tape that grows too long, a bad decimal, or an unknown name.
  int decimal(const std::string& text);
  int name(const std::string& name);
  int unary(Op op, int a);
  int binary(Op op, int a, int b);
  int power(int base, int exponent);

  std::vector<Instruction> instructions;
  std::vector<DecimalText> literals;

 private:
  int slot(Op op, int a, int b = 0);
  int literal(const DecimalText& canonical);

  const std::vector<std::string>& parameters_;
  const std::map<std::string, DecimalText>& constants_;
  std::map<std::tuple<Op, int, int>, int> slots_;
};

/// Appends `text` to the tape and returns the slot of its value. @throws InputError with the column, the text seen
/// there and what was expected.
int parse_expression(const ExpressionText& text, TapeBuilder& builder);

/// "pi" and the functions' names, which no parameter or constant may take.
[[nodiscard]] bool is_reserved_name(const std::string& name);
/// A letter or underscore, then letters, digits and underscores.
[[nodiscard]] bool is_identifier(const std::string& name);

}  // namespace taut
