// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/format/expression_parser.h"

#include <algorithm>
#include <cstdlib>

#include "checker/format/exact.h"
#include "checker/kernel/errors.h"

namespace taut::checker {
namespace {

constexpr std::size_t kMaxLength = 10000;  ///< characters
constexpr int kMaxDepth = 200;             ///< nested parentheses and signs; bounds the recursion of the parser
constexpr long kMaxExponent = 1000;        ///< of "^"
constexpr long kMaxTurns = 1000;           ///< returned by turns(), and of the integers that it multiplies by

/// Of one operand. There are tan and atan2 besides.
const std::map<std::string, Function> kFunctions = {
    {"sqrt", Function::kSqrt}, {"sin", Function::kSin},   {"cos", Function::kCos},   {"exp", Function::kExp},
    {"log", Function::kLog},   {"asin", Function::kAsin}, {"acos", Function::kAcos}, {"atan", Function::kAtan}};

bool is_function(const std::string& name) { return kFunctions.contains(name) || name == "tan" || name == "atan2"; }

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_name_character(char c) { return is_letter(c) || is_digit(c); }

class Parser {
 public:
  Parser(const std::string& text, const Names& names, const std::string& where)
      : text_(text), names_(names), where_(where) {}

  Expression parse() {
    if (text_.size() > kMaxLength) fail("at most 10000 characters");
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] < ' ' || text_[at_] > '~') fail("printable ASCII characters only");
    }
    at_ = 0;
    sum(1);
    if (peek() != '\0') fail("an operator or the end");
    return std::move(result_);
  }

 private:
  // Each of these reads the part of the grammar that it is named after and returns the node of its value.
  int sum(int depth) {
    return joined("+-", [&] { return joined("*/", [&] { return unary(depth); }); });
  }

  /// Operands with operators between them, which associate to the left.
  template <class Operand>
  int joined(std::string_view operators, const Operand& operand) {
    static const std::map<char, Op> kOps = {
        {'+', Op::kAdd}, {'-', Op::kSubtract}, {'*', Op::kMultiply}, {'/', Op::kDivide}};
    int left = operand();
    while (operators.find(peek()) != std::string_view::npos) {
      const Op op = kOps.at(text_[at_++]);
      const int right = operand();
      left = add({op, 0, left, right});
    }
    return left;
  }

  int unary(int depth) {
    require_shallow(depth);
    if (take('-')) return add({Op::kNegate, 0, unary(depth + 1)});
    const int base = atom(depth + 1);
    return take('^') ? add({Op::kPower, static_cast<int>(exponent(depth + 1)), base}) : base;
  }

  int atom(int depth) {
    const char c = peek();
    if (take('(')) return closed(sum(depth));
    if (is_digit(c) || c == '.') return number();
    if (!is_letter(c)) fail("a number, a name or '('");
    const std::string name = take_while(is_name_character);
    if (name == "pi") return add({Op::kPi});
    if (is_function(name)) return closed(function(name, depth));
    const auto parameter = std::ranges::find(names_.parameters, name);
    if (parameter != names_.parameters.end()) {
      return add({Op::kParameter, static_cast<int>(parameter - names_.parameters.begin())});
    }
    const auto constant = names_.constants.find(name);
    if (constant == names_.constants.end()) fail("a known name, not '" + name + "'");
    return add_number(constant->second);
  }

  /// Up to its closing parenthesis.
  int function(const std::string& name, int depth) {
    if (!take('(')) fail("'('");
    const int first = sum(depth);
    const auto apply = [&](Function f) { return add({Op::kApply, 0, first, -1, f}); };
    if (name == "tan") {
      const int sine = apply(Function::kSin);
      return add({Op::kDivide, 0, sine, apply(Function::kCos)});
    }
    if (name != "atan2") return apply(kFunctions.at(name));
    if (!take(',')) fail("','");
    const int second = sum(depth);
    return add({Op::kAtan2, 0, first, second});
  }

  int number() {
    std::string digits = take_while([](char c) { return is_digit(c) || c == '.'; });
    if (at_ < text_.size() && (text_[at_] == 'e' || text_[at_] == 'E')) {
      digits += text_[at_++];
      if (at_ < text_.size() && (text_[at_] == '+' || text_[at_] == '-')) digits += text_[at_++];
      digits += take_while(is_digit);
    }
    const std::optional<mpq_class> value = parse_decimal(digits);
    if (!value) fail(kDecimalForm);
    return add_number(*value);
  }

  long exponent(int depth) {
    require_shallow(depth);
    if (take('-')) return -exponent(depth + 1);
    if (take('(')) return closed(exponent(depth + 1));
    if (!is_digit(peek())) fail("an integer exponent");
    long base = 0;
    for (const char c : take_while(is_digit)) base = bounded(10 * base + (c - '0'));
    if (!take('^')) return base;
    long result = 1;
    for (long n = exponent(depth + 1); n != 0; --n) {
      if (n < 0) fail("an integer exponent");
      result = bounded(result * base);
    }
    return result;
  }

  long bounded(long n) const {
    if (n > kMaxExponent) fail("an exponent of at most 1000");
    return n;
  }

  template <class Value>
  Value closed(Value value) {
    if (!take(')')) fail("')'");
    return value;
  }

  char peek() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool take(char c) {
    const bool found = peek() == c;
    if (found) ++at_;
    return found;
  }
  template <class Predicate>
  std::string take_while(const Predicate& is_wanted) {
    const std::size_t begin = at_;
    while (at_ < text_.size() && is_wanted(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  int add(const Expression::Node& node) {
    result_.nodes.push_back(node);
    return static_cast<int>(result_.nodes.size()) - 1;
  }
  int add_number(const mpq_class& value) {
    result_.numbers.push_back(value);
    return add({Op::kNumber, static_cast<int>(result_.numbers.size()) - 1});
  }

  [[noreturn]] void fail(const std::string& expected) const {
    throw Malformed(where_ + ": '" + text_.substr(0, 60) + "', column " + std::to_string(at_ + 1) + ": expected " +
                    expected);
  }

  void require_shallow(int depth) const {
    if (depth > kMaxDepth) fail("fewer nested parentheses");
  }

  const std::string& text_;
  const Names& names_;
  const std::string& where_;
  Expression result_;
  std::size_t at_ = 0;
};

}  // namespace

Expression parse_expression(const std::string& text, const Names& names, const std::string& where) {
  return Parser(text, names, where).parse();
}

bool mentions(const Expression& expression, std::size_t parameter) {
  return std::ranges::any_of(expression.nodes, [&](const Expression::Node& node) {
    return node.op == Op::kParameter && node.n == static_cast<int>(parameter);
  });
}

std::optional<long> turns(const Expression& expression, std::size_t parameter) {
  using Count = std::optional<long>;
  struct Known {
    Count turns;
    Count integer;  ///< the value of a node that is an integer literal or its negative
  };
  const auto bounded = [](long k) { return std::abs(k) <= kMaxTurns ? Count(k) : std::nullopt; };
  const auto sum = [&](const Count& a, const Count& b) { return a && b ? bounded(*a + *b) : std::nullopt; };
  const auto product = [&](const Count& a, const Count& b) { return a && b ? bounded(*a * *b) : std::nullopt; };
  const Known none;
  std::vector<Known> known;
  for (const Expression::Node& node : expression.nodes) {
    const Known& a = node.a < 0 ? none : known[static_cast<std::size_t>(node.a)];
    const Known& b = node.b < 0 ? none : known[static_cast<std::size_t>(node.b)];
    // An operation whose operands don't change keeps its value, whatever operation it is.
    const bool is_unchanged = (node.a < 0 || a.turns == 0) && (node.b < 0 || b.turns == 0);
    Known result;
    if (is_unchanged) result.turns = 0;
    switch (node.op) {
      case Op::kParameter: result.turns = node.n == static_cast<int>(parameter) ? 1 : 0; break;
      case Op::kNumber: {
        const mpq_class& number = expression.numbers[static_cast<std::size_t>(node.n)];
        if (number.get_den() == 1 && abs(number) <= kMaxTurns) result.integer = number.get_num().get_si();
        break;
      }
      case Op::kNegate: result = {product(-1, a.turns), product(-1, a.integer)}; break;
      case Op::kAdd: result.turns = sum(a.turns, b.turns); break;
      case Op::kSubtract: result.turns = sum(a.turns, product(-1, b.turns)); break;
      case Op::kMultiply:
        if (is_unchanged) break;
        result.turns = product(a.integer, b.turns);
        if (b.integer) result.turns = product(b.integer, a.turns);
        break;
      case Op::kPower:
        if (node.n == 0) result = {0, 1};
        if (node.n == 1) result = a;
        break;
      case Op::kApply:
        if (a.turns && (node.function == Function::kSin || node.function == Function::kCos)) result.turns = 0;
        break;
      default: break;
    }
    known.push_back(result);
  }
  return known.back().turns;
}

bool is_free_name(const std::string& name) {
  return !name.empty() && is_letter(name[0]) && std::ranges::all_of(name, is_name_character) && name != "pi" &&
         !is_function(name);
}

}  // namespace taut::checker
