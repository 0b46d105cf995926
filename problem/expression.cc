// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/expression.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <optional>

#include "base/input_error.h"
#include "problem/decimal.h"
#include "problem/tape_builder.h"

namespace taut {
namespace {

bool is_unary(Op op) {
  switch (op) {
    case Op::kNegate:
    case Op::kPower:
    case Op::kSqrt:
    case Op::kSin:
    case Op::kCos:
    case Op::kTan:
    case Op::kExp:
    case Op::kLog:
    case Op::kAsin:
    case Op::kAcos:
    case Op::kAtan: return true;
    default: return false;
  }
}

bool is_leaf(Op op) { return op == Op::kConstant || op == Op::kParameter; }

}  // namespace

bool is_reserved_name(const std::string& name) {
  static constexpr std::array kReserved = {"pi",  "sqrt", "sin",  "cos",  "tan",  "exp",
                                           "log", "asin", "acos", "atan", "atan2"};
  return std::find(kReserved.begin(), kReserved.end(), name) != kReserved.end();
}

bool is_identifier(const std::string& name) {
  constexpr std::size_t kMaxLength = 64;
  const auto is_letter = [](unsigned char c) { return c < 128 && (std::isalpha(c) || c == '_'); };
  const auto is_digit = [](unsigned char c) { return c >= '0' && c <= '9'; };
  return !name.empty() && name.size() <= kMaxLength && is_letter(static_cast<unsigned char>(name[0])) &&
         std::all_of(name.begin(), name.end(), [&](unsigned char c) { return is_letter(c) || is_digit(c); });
}

bool is_plain_decimal(const ExpressionText& expression) {
  const std::size_t sign = expression.starts_with('-') ? 1 : 0;
  const auto is_digit = [](unsigned char c) { return c >= '0' && c <= '9'; };
  if (expression.size() == sign || expression.size() > Decimal::kMaxDigits) return false;
  if (!is_digit(static_cast<unsigned char>(expression[sign])) ||
      !is_digit(static_cast<unsigned char>(expression.back()))) {
    return false;
  }
  const auto begin = expression.begin() + static_cast<std::ptrdiff_t>(sign);
  return std::count(begin, expression.end(), '.') <= 1 &&
         std::all_of(begin, expression.end(), [&](unsigned char c) { return is_digit(c) || c == '.'; });
}

TapeBuilder::TapeBuilder(const std::vector<std::string>& parameters,
                         const std::map<std::string, DecimalText>& constants)
    : parameters_(parameters), constants_(constants) {
  const auto check = [](const std::string& name) {
    if (!is_identifier(name) || is_reserved_name(name)) {
      throw InputError(fmt::format(
          "name '{}': expected letters, digits and underscores, not beginning with a digit, other than pi and "
          "the functions' names",
          name));
    }
  };
  for (const std::string& name : parameters) {
    check(name);
    if (std::count(parameters.begin(), parameters.end(), name) > 1 || constants.contains(name)) {
      throw InputError(fmt::format("name '{}': expected to be given once", name));
    }
  }
  for (const auto& [name, value] : constants) check(name);
}

int TapeBuilder::slot(Op op, int a, int b) {
  const auto [found, is_new] = slots_.try_emplace({op, a, b}, static_cast<int>(instructions.size()));
  if (is_new) {
    if (instructions.size() >= ExpressionTape::kMaxInstructions) {
      throw InputError(
          fmt::format("expected at most {} distinct operations in all expressions", ExpressionTape::kMaxInstructions));
    }
    instructions.push_back({op, a, b});
  }
  return found->second;
}

int TapeBuilder::literal(const DecimalText& canonical) {
  const auto found = std::find(literals.begin(), literals.end(), canonical);
  const int index = static_cast<int>(found - literals.begin());
  if (found == literals.end()) literals.push_back(canonical);
  return slot(Op::kConstant, index);
}

int TapeBuilder::decimal(const std::string& text) { return literal(Decimal::parse(text).text()); }

int TapeBuilder::name(const std::string& name) {
  if (name == "pi") return literal(name);
  const auto parameter = std::find(parameters_.begin(), parameters_.end(), name);
  if (parameter != parameters_.end()) return slot(Op::kParameter, static_cast<int>(parameter - parameters_.begin()));
  if (const auto constant = constants_.find(name); constant != constants_.end()) return decimal(constant->second);
  std::string known;
  for (const std::string& parameter_name : parameters_) known += parameter_name + ", ";
  for (const auto& [constant_name, value] : constants_) known += constant_name + ", ";
  throw InputError(fmt::format("expected a number, one of the names {}pi, or a function", known));
}

int TapeBuilder::unary(Op op, int a) {
  if (op != Op::kSin && op != Op::kCos) return slot(op, a);
  const int sine = slot(Op::kSin, a);
  const int cosine = slot(Op::kCos, a);
  return op == Op::kSin ? sine : cosine;
}

int TapeBuilder::binary(Op op, int a, int b) {
  const bool commutes = op == Op::kAdd || op == Op::kMultiply;
  return commutes && b < a ? slot(op, b, a) : slot(op, a, b);
}

int TapeBuilder::power(int base, int exponent) {
  if (exponent == 0) return literal("1");
  if (exponent == 1) return base;
  if (exponent > 1) return slot(Op::kPower, base, exponent);
  return slot(Op::kDivide, literal("1"), power(base, -exponent));
}

ExpressionTape::ExpressionTape(const std::vector<ExpressionText>& expressions,
                               const std::vector<std::string>& parameters,
                               const std::map<std::string, DecimalText>& constants) {
  TapeBuilder builder(parameters, constants);
  for (const ExpressionText& expression : expressions) outputs_.push_back(parse_expression(expression, builder));
  instructions_ = std::move(builder.instructions);
  constants_ = std::move(builder.literals);
}

bool ExpressionTape::depends_on(int output, int parameter) const {
  std::vector<bool> depends(instructions_.size());
  for (std::size_t i = 0; i < instructions_.size(); ++i) {
    const auto [op, a, b] = instructions_[i];
    if (is_leaf(op)) {
      depends[i] = op == Op::kParameter && a == parameter;
    } else {
      depends[i] = depends[a] || (!is_unary(op) && depends[b]);
    }
  }
  return depends[outputs_[output]];
}

namespace {

/// What turns() knows about a slot.
struct Turns {
  std::optional<int> turns;    ///< as ExpressionTape::turns
  std::optional<int> integer;  ///< the value, if it is a small integer that was typed
};

constexpr int kMaxTurns = 1000;  // keeps products within int

std::optional<int> within_limit(int k) { return std::abs(k) <= kMaxTurns ? std::optional(k) : std::nullopt; }

std::optional<int> small_integer(const DecimalText& text) {
  if (text.empty() || text.size() > 3 ||
      !std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); }))
    return std::nullopt;
  return std::stoi(text);
}

}  // namespace

std::optional<int> ExpressionTape::turns(int output, int parameter) const {
  std::vector<Turns> slots;
  for (const auto [op, a, b] : instructions_) {
    Turns result;
    switch (op) {
      case Op::kConstant: result = {0, small_integer(constants_[a])}; break;
      case Op::kParameter: result.turns = a == parameter ? 1 : 0; break;
      case Op::kNegate:
        if (slots[a].turns) result.turns = -*slots[a].turns;
        if (slots[a].integer) result.integer = -*slots[a].integer;
        break;
      case Op::kAdd:
        if (slots[a].turns && slots[b].turns) result.turns = within_limit(*slots[a].turns + *slots[b].turns);
        break;
      case Op::kSubtract:
        if (slots[a].turns && slots[b].turns) result.turns = within_limit(*slots[a].turns - *slots[b].turns);
        break;
      case Op::kMultiply:
        if (slots[a].turns == 0 && slots[b].turns == 0) {
          result.turns = 0;
        } else if (slots[a].integer && slots[b].turns) {
          result.turns = within_limit(*slots[a].integer * *slots[b].turns);
        } else if (slots[b].integer && slots[a].turns) {
          result.turns = within_limit(*slots[b].integer * *slots[a].turns);
        }
        break;
      case Op::kSin:
      case Op::kCos:
      case Op::kTan:
        if (slots[a].turns) result.turns = 0;
        break;
      default:
        if (slots[a].turns == 0 && (is_unary(op) || slots[b].turns == 0)) result.turns = 0;
    }
    slots.push_back(result);
  }
  return slots[outputs_[output]].turns;
}

}  // namespace taut
