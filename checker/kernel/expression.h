// SPDX-License-Identifier: GPL-3.0-or-later
// Expressions of the certificate's grammar, as flat trees, evaluated on enclosing scalars (forms or jets).
#pragma once

#include <gmpxx.h>

#include <span>
#include <stdexcept>
#include <vector>

#include "checker/kernel/ball.h"

namespace taut::checker {

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
  kAtan2,
};

/// Operands stand before the operations that use them; the last node is the value of the whole.
struct Expression {
  struct Node {
    Op op = Op::kNumber;
    int n = 0;   ///< index of a number or parameter, or the exponent of kPower
    int a = -1;  ///< index of the first operand
    int b = -1;  ///< index of the second operand
  };
  std::vector<Node> nodes;
  std::vector<mpq_class> numbers;

  /// Encloses the value at `parameters`. @throws Undefined where the value may be undefined or, unless all operands
  /// are constant, not differentiable.
  template <class T>
  [[nodiscard]] T evaluate(std::span<const T> parameters) const;
};

template <class T>
T Expression::evaluate(std::span<const T> parameters) const {
  std::vector<T> values;
  values.reserve(nodes.size());
  for (const Node& node : nodes) {
    const auto a = [&]() -> const T& { return values[static_cast<std::size_t>(node.a)]; };
    const auto b = [&]() -> const T& { return values[static_cast<std::size_t>(node.b)]; };
    const auto value = [&]() -> T {
      switch (node.op) {
        case Op::kNumber: return T(Ball(numbers[static_cast<std::size_t>(node.n)]));
        case Op::kPi: return T(Ball::pi());
        case Op::kParameter: return parameters[static_cast<std::size_t>(node.n)];
        case Op::kAdd: return a() + b();
        case Op::kSubtract: return a() - b();
        case Op::kMultiply: return a() * b();
        case Op::kDivide: return a() / b();
        case Op::kNegate: return -a();
        case Op::kPower: return power(a(), node.n);
        case Op::kSqrt: return apply(Function::kSqrt, a());
        case Op::kSin: return apply(Function::kSin, a());
        case Op::kCos: return apply(Function::kCos, a());
        case Op::kTan: return apply(Function::kSin, a()) / apply(Function::kCos, a());
        case Op::kExp: return apply(Function::kExp, a());
        case Op::kLog: return apply(Function::kLog, a());
        case Op::kAsin: return apply(Function::kAsin, a());
        case Op::kAcos: return apply(Function::kAcos, a());
        case Op::kAtan: return apply(Function::kAtan, a());
        case Op::kAtan2: return atan2(a(), b());
      }
      throw std::logic_error("an operation without a meaning");
    };
    values.push_back(value());
  }
  return values.back();
}

}  // namespace taut::checker
