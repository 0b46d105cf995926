// Expressions of the certificate's grammar (docs/certificate-format.md), read by recursive descent and evaluated on Forms.
//
//     sum     = product { ("+" | "-") product }
//     product = unary { ("*" | "/") unary }
//     unary   = "-" unary | power
//     power   = atom [ "^" exponent ]              exponent = integer [ "^" exponent ] | "-" exponent | "(" exponent ")"
//     atom    = decimal | name | function "(" sum [ "," sum ] ")" | "(" sum ")"
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "checker/form.h"

namespace taut::checker {

class Expression {
 public:
  Expression() = default;
  /// @throws Malformed with `where`, the column and what was expected.
  Expression(const std::string& text, const std::vector<std::string>& parameters,
             const std::map<std::string, mpq_class>& constants, const std::string& where);

  /// An enclosure over u in [-1, 1], with u's functions `parameters`, at the working precision.
  /// @throws Undefined where it may be undefined or not differentiable.
  [[nodiscard]] Form evaluate(std::span<const Form> parameters) const;

  [[nodiscard]] bool mentions(int parameter) const;

  /// The integer k for which the value grows by 2 pi k when the parameter grows by 2 pi, whatever the others are, where
  /// the form of the expression shows one: "Periodic parameters" in docs/certificate-format.md.
  [[nodiscard]] std::optional<long> turns(int parameter) const;

  /// Whether `name` may name a parameter or constant: an identifier, and neither `pi` nor a function.
  [[nodiscard]] static bool is_free_name(const std::string& name);

 private:
  friend class ExpressionParser;
  enum class Op {
    kNumber,
    kPi,
    kParameter,
    kAdd,
    kSubtract,
    kMultiply,
    kDivide,
    kNegate,
    kPower,
    kSqrt,
    kSin,
    kCos,
    kTan,
    kExp,
    kLog,
    kAsin,
    kAcos,
    kAtan,
    kAtan2
  };
  /// a and b are earlier nodes; n is an exponent, or the index of a number or parameter.
  struct Node {
    Op op;
    int n = 0;
    int a = -1;
    int b = -1;
  };
  std::vector<Node> nodes_;  ///< operands before operations; the last one is the value
  std::vector<mpq_class> numbers_;
};

}  // namespace taut::checker
