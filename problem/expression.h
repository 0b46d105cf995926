// SPDX-License-Identifier: GPL-3.0-or-later
// Expressions that a user writes in a case file, evaluated on any scalar.
//
// Grammar: docs/certificate-format.md. Each expression is parsed once (Boost.Spirit X3) into a tape of operations on
// numbered slots. The same tape is evaluated on doubles, intervals and multiprecision intervals, and on mean value
// forms and dual numbers, which differentiate it.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "problem/problem.h"
#include "problem/scalar.h"

namespace taut {

enum class Op : unsigned char {
  kConstant,   ///< constants[a]
  kParameter,  ///< parameters[a]
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kNegate,
  kPower,  ///< slot a to the integer power b > 1
  kSqrt,
  kSin,  ///< computes the cosine too, into the next slot: a kSin is always followed by a kCos of the same a
  kCos,  ///< already computed by the kSin before it
  kTan,
  kExp,
  kLog,
  kAsin,
  kAcos,
  kAtan,
  kAtan2,
};

struct Instruction {
  Op op;
  int a = 0;
  int b = 0;
};

/// Several expressions over the same parameters, on one tape; equal subexpressions are computed once.
class ExpressionTape {
 public:
  /// Bounds the stack that an evaluation takes; the paper's sphere needs about 30.
  static constexpr int kMaxInstructions = 256;

  /// @throws InputError naming the expression, the column, what was seen and what was expected.
  ExpressionTape(const std::vector<ExpressionText>& expressions, const std::vector<std::string>& parameters,
                 const std::map<std::string, DecimalText>& constants);

  [[nodiscard]] const std::vector<Instruction>& instructions() const { return instructions_; }
  /// Slot of each expression's value.
  [[nodiscard]] const std::vector<int>& outputs() const { return outputs_; }
  /// Decimals of the constants; "pi" stands for the number.
  [[nodiscard]] const std::vector<DecimalText>& constants() const { return constants_; }
  /// Whether output i depends on parameter j.
  [[nodiscard]] bool depends_on(int output, int parameter) const;
  /// The k for which output(parameter + 2 pi) = output(parameter) + 2 pi k for all parameters, if the form of the
  /// expression shows one: the parameter occurs only inside sin, cos and tan, or as an added integer multiple of
  /// itself.
  [[nodiscard]] std::optional<int> turns(int output, int parameter) const;

 private:
  std::vector<Instruction> instructions_;
  std::vector<int> outputs_;
  std::vector<DecimalText> constants_;
};

/// A tape with its constants made in scalar S.
template <class S>
class Evaluator {
 public:
  explicit Evaluator(const ExpressionTape& tape);
  /// Evaluates all expressions. @pre `parameters` are in the order given to the tape; values.size() is the number of
  /// outputs.
  void evaluate(std::span<const S> parameters, std::span<S> values) const;

 private:
  std::vector<Instruction> instructions_;
  std::vector<int> outputs_;
  std::vector<S> constants_;
};

/// Whether the expression is a decimal without an exponent, such as "-0.3"; that is what ScalarTraits read.
[[nodiscard]] bool is_plain_decimal(const ExpressionText& expression);

/// Value of a constant expression (no parameters) in scalar S.
template <class S>
[[nodiscard]] S evaluate_constant(const ExpressionText& expression);

}  // namespace taut

#include "problem/expression_impl.h"
