// SPDX-License-Identifier: GPL-3.0-or-later
// Expressions of the certificate's grammar, as flat trees, evaluated on enclosing scalars (forms or jets).
#pragma once

#include <gmpxx.h>

#include <span>
#include <vector>

#include "checker/kernel/mean_value_form.h"

namespace taut::checker {

/// kApply applies a Function of one operand.
enum class Op { kNumber, kPi, kParameter, kAdd, kSubtract, kMultiply, kDivide, kNegate, kPower, kApply, kAtan2 };

/// Operands stand before the operations that use them; the last node is the value of the whole.
struct Expression {
  struct Node {
    Op op = Op::kNumber;
    int n = 0;   ///< index of a number or parameter, or the exponent of kPower
    int a = -1;  ///< index of the first operand
    int b = -1;  ///< index of the second operand
    Function function = Function::kSqrt;
    bool operator==(const Node&) const = default;
  };
  std::vector<Node> nodes;
  std::vector<mpq_class> numbers;
  bool operator==(const Expression&) const = default;  ///< of the form: the same operations on the same numbers

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
    switch (node.op) {
      case Op::kNumber: values.emplace_back(Ball(numbers[static_cast<std::size_t>(node.n)])); break;
      case Op::kPi: values.emplace_back(Ball::pi()); break;
      case Op::kParameter: values.push_back(parameters[static_cast<std::size_t>(node.n)]); break;
      case Op::kAdd: values.push_back(a() + b()); break;
      case Op::kSubtract: values.push_back(a() - b()); break;
      case Op::kMultiply: values.push_back(a() * b()); break;
      case Op::kDivide: values.push_back(a() / b()); break;
      case Op::kNegate: values.push_back(-a()); break;
      case Op::kPower: values.push_back(power(a(), node.n)); break;
      case Op::kApply: values.push_back(apply(node.function, a())); break;
      case Op::kAtan2: values.push_back(atan2(a(), b())); break;
    }
  }
  return values.back();
}

}  // namespace taut::checker
