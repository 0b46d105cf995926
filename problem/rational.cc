// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/rational.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "base/input_error.h"
#include "problem/decimal.h"
#include "problem/expression.h"

namespace taut {
namespace {

using boost::multiprecision::cpp_int;

bool is_integer(std::string_view digits) {
  return !digits.empty() && digits.size() <= kMaxFractionDigits &&
         std::ranges::all_of(digits, [](unsigned char c) { return std::isdigit(c); });
}

/// @pre is_integer(digits). cpp_int reads a leading zero as the mark of an octal number.
cpp_int integer(std::string_view digits) {
  digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size() - 1));
  return cpp_int(std::string(digits));
}

/// The larger number of bits of numerator and denominator.
std::size_t size_of(const Rational& x) {
  const auto bits = [](const cpp_int& n) { return n == 0 ? 1 : msb(abs(n)) + 1; };
  return std::max(bits(numerator(x)), bits(denominator(x)));
}

constexpr std::size_t kMaxBits = 1 << 13;  // about 2500 digits

/// One step of an exact evaluation. @throws InputError for a step that has no exact result.
Rational perform(const Instruction& step, const std::vector<Rational>& slots, const std::vector<DecimalText>& constants,
                 const ExpressionText& expression) {
  const auto slot = [&](int i) -> const Rational& { return slots[static_cast<std::size_t>(i)]; };
  switch (step.op) {
    case Op::kConstant: {
      const DecimalText& text = constants[static_cast<std::size_t>(step.a)];
      if (text != "pi") return Decimal::parse(text).rational();
      break;
    }
    case Op::kAdd: return slot(step.a) + slot(step.b);
    case Op::kSubtract: return slot(step.a) - slot(step.b);
    case Op::kMultiply: return slot(step.a) * slot(step.b);
    case Op::kDivide:
      if (slot(step.b) == 0) fail_to_read(expression, "no division by zero");
      return slot(step.a) / slot(step.b);
    case Op::kNegate: return -slot(step.a);
    case Op::kPower: {
      const Rational& base = slot(step.a);
      const auto exponent = static_cast<unsigned>(step.b);
      if (size_of(base) * exponent > kMaxBits) fail_to_read(expression, "numbers of fewer digits");
      return {pow(cpp_int(numerator(base)), exponent), pow(cpp_int(denominator(base)), exponent)};
    }
    default: break;
  }
  fail_to_read(expression, "a number, or decimals with + - * / ^ and parentheses: the value has to be exact");
}

}  // namespace

Rational parse_rational(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return Decimal::parse(text).rational();
  const bool negative = text.starts_with('-');
  const std::string_view above = text.substr(negative ? 1 : 0, slash - (negative ? 1 : 0));
  const std::string_view below = text.substr(slash + 1);
  if (!is_integer(above) || !is_integer(below) || integer(below) == 0) {
    fail_to_read(text, "a decimal number such as 0.05, or a fraction such as 1/36");
  }
  const Rational magnitude(integer(above), integer(below));
  return negative ? Rational(-magnitude) : magnitude;
}

RationalText rational_text(const Rational& value) {
  // A fraction is a finite decimal if its denominator divides a power of ten.
  cpp_int rest = denominator(value);
  const auto twos = static_cast<unsigned>(lsb(rest));
  rest >>= twos;
  unsigned fives = 0;
  for (; rest % 5 == 0; rest /= 5) ++fives;
  if (rest == 1) {
    const unsigned places = std::max(twos, fives);
    const cpp_int digits = numerator(value) * pow(cpp_int(2), places - twos) * pow(cpp_int(5), places - fives);
    return Decimal::parse(fmt::format("{}e-{}", digits.str(), places)).text();
  }
  const std::string above = cpp_int(abs(numerator(value))).str();
  const std::string below = cpp_int(denominator(value)).str();
  if (std::max(above.size(), below.size()) > kMaxFractionDigits) {
    fail_to_read(above + "/" + below,
                 fmt::format("a fraction with at most {} digits above and below the line", kMaxFractionDigits));
  }
  return (value < 0 ? "-" : "") + above + "/" + below;
}

Rational evaluate_exactly(const ExpressionText& expression) {
  const ExpressionTape tape({expression}, {}, {});
  std::vector<Rational> slots;
  for (const Instruction& step : tape.instructions()) {
    slots.push_back(perform(step, slots, tape.constants(), expression));
    if (size_of(slots.back()) > kMaxBits) fail_to_read(expression, "numbers of fewer digits");
  }
  return slots[static_cast<std::size_t>(tape.outputs()[0])];
}

Rational root_above(const Rational& x) {
  if (x == 0) return 0;
  // With n >= 10^26 the root is at least 10^13, of which the next integer is less than 1e-12 off.
  constexpr int kDigits = 28;
  const auto digits = [](const cpp_int& n) { return static_cast<int>(n.str().size()); };
  const int places = (kDigits - digits(numerator(x)) + digits(denominator(x))) / 2;  // may be negative
  const auto ten_to_the = [](int n) -> cpp_int { return pow(cpp_int(10), static_cast<unsigned>(n)); };
  const Rational scale = places >= 0 ? Rational(ten_to_the(places)) : Rational(1) / ten_to_the(-places);
  const Rational scaled = x * scale * scale;
  const cpp_int n = numerator(scaled) / denominator(scaled) + 1;
  return Rational(cpp_int(sqrt(n) + 1)) / scale;
}

}  // namespace taut
