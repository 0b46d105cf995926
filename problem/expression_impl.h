// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of the templates of expression.h.
#pragma once

#include <array>
#include <boost/container/static_vector.hpp>
#include <cassert>

#include "problem/expression.h"

namespace taut {

template <class S>
Evaluator<S>::Evaluator(const ExpressionTape& tape) : instructions_(tape.instructions()), outputs_(tape.outputs()) {
  constants_.reserve(tape.constants().size());
  for (const DecimalText& text : tape.constants()) {
    constants_.push_back(text == "pi" ? S(ScalarTraits<S>::pi()) : S(ScalarTraits<S>::from_decimal(text)));
  }
}

template <class S>
void Evaluator<S>::evaluate(std::span<const S> parameters, std::span<S> values) const {
  assert(values.size() == outputs_.size());
  boost::container::static_vector<S, ExpressionTape::kMaxInstructions> slots;  // on the stack, constructed one by one
  for (const Instruction& instruction : instructions_) {
    const int a = instruction.a;
    const int b = instruction.b;
    switch (instruction.op) {
      case Op::kConstant: slots.push_back(constants_[a]); break;
      case Op::kParameter: slots.push_back(parameters[a]); break;
      case Op::kAdd: slots.push_back(slots[a] + slots[b]); break;
      case Op::kSubtract: slots.push_back(slots[a] - slots[b]); break;
      case Op::kMultiply: slots.push_back(slots[a] * slots[b]); break;
      case Op::kDivide: slots.push_back(slots[a] / slots[b]); break;
      case Op::kNegate: slots.push_back(-slots[a]); break;
      case Op::kPower: slots.push_back(b == 2 ? S(sqr(slots[a])) : S(pow_int(slots[a], b))); break;
      case Op::kSqrt: slots.push_back(sqrt(slots[a])); break;
      case Op::kSin: {
        const SinCos<S> both = sincos(slots[a]);
        slots.push_back(both.sin);
        slots.push_back(both.cos);
        break;
      }
      case Op::kCos: break;  // pushed by the kSin before it
      case Op::kTan: slots.push_back(tan(slots[a])); break;
      case Op::kExp: slots.push_back(exp(slots[a])); break;
      case Op::kLog: slots.push_back(log(slots[a])); break;
      case Op::kAsin: slots.push_back(asin(slots[a])); break;
      case Op::kAcos: slots.push_back(acos(slots[a])); break;
      case Op::kAtan: slots.push_back(atan(slots[a])); break;
      case Op::kAtan2: slots.push_back(atan2(slots[a], slots[b])); break;
    }
  }
  for (std::size_t i = 0; i < outputs_.size(); ++i) values[i] = slots[outputs_[i]];
}

template <class S>
S evaluate_constant(const ExpressionText& expression) {
  if (is_plain_decimal(expression)) return S(ScalarTraits<S>::from_decimal(expression));
  std::array<S, 1> value = {S(0.0)};
  Evaluator<S>(ExpressionTape({expression}, {}, {})).evaluate({}, value);
  return value[0];
}

}  // namespace taut
