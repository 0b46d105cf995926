#include "checker/expression.h"

#include <cctype>
#include <cstdlib>

#include "checker/exact.h"

namespace taut::checker {

namespace {

constexpr std::size_t kMaxLength = 10000;  ///< characters; nobody types more
constexpr int kMaxDepth = 200;             ///< nested parentheses and signs: bounds the parser's recursion
constexpr long kMaxExponent = 1000;        ///< of "^"
constexpr long kMaxTurns = 1000;           ///< of turns(), and of the integers that it multiplies by

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }

}  // namespace

class ExpressionParser {
 public:
  using Op = Expression::Op;
  using Node = Expression::Node;

  ExpressionParser(const std::string& text, const std::vector<std::string>& parameters,
                   const std::map<std::string, mpq_class>& constants, const std::string& where, Expression& result)
      : text_(text), parameters_(parameters), constants_(constants), where_(where), result_(result) {}

  void parse() {
    if (text_.size() > kMaxLength) fail("at most 10000 characters");
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] < ' ' || text_[at_] > '~') fail("printable ASCII characters only");
    }
    at_ = 0;
    sum();
    if (peek() != '\0') fail("an operator or the end");
  }

  static const std::map<std::string, Op>& functions() {
    static const std::map<std::string, Op> kFunctions = {
        {"sqrt", Op::kSqrt}, {"sin", Op::kSin},   {"cos", Op::kCos},   {"tan", Op::kTan},   {"exp", Op::kExp},
        {"log", Op::kLog},   {"asin", Op::kAsin}, {"acos", Op::kAcos}, {"atan", Op::kAtan}, {"atan2", Op::kAtan2}};
    return kFunctions;
  }

 private:
  // Each of these reads what its name says and returns the node of its value.
  int sum() {
    int left = product();
    for (char c = peek(); c == '+' || c == '-'; c = peek()) {
      ++at_;
      const int right = product();
      left = add({c == '+' ? Op::kAdd : Op::kSubtract, 0, left, right});
    }
    return left;
  }

  int product() {
    int left = unary();
    for (char c = peek(); c == '*' || c == '/'; c = peek()) {
      ++at_;
      const int right = unary();
      left = add({c == '*' ? Op::kMultiply : Op::kDivide, 0, left, right});
    }
    return left;
  }

  int unary() {
    const Nesting nesting(*this);
    if (take('-')) return add({Op::kNegate, 0, unary()});
    const int base = atom();
    return take('^') ? add({Op::kPower, static_cast<int>(exponent()), base}) : base;
  }

  int atom() {
    const char c = peek();
    if (take('(')) return closed(sum());
    if (is_digit(c) || c == '.') return number();
    if (!is_letter(c)) fail("a number, a name or '('");
    const std::string name = take_name();
    if (name == "pi") return add({Op::kPi});
    if (const auto function = functions().find(name); function != functions().end()) {
      if (!take('(')) fail("'('");
      const int first = sum();
      if (function->second != Op::kAtan2) return closed(add({function->second, 0, first}));
      if (!take(',')) fail("','");
      const int second = sum();
      return closed(add({Op::kAtan2, 0, first, second}));
    }
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      if (parameters_[j] == name) return add({Op::kParameter, static_cast<int>(j)});
    }
    if (const auto constant = constants_.find(name); constant != constants_.end()) return add_number(constant->second);
    fail("a known name, not '" + name + "'");
  }

  int number() {
    const std::size_t begin = at_;
    auto skip_digits = [&] {
      while (at_ < text_.size() && is_digit(text_[at_])) ++at_;
    };
    skip_digits();
    if (at_ < text_.size() && text_[at_] == '.') ++at_;
    skip_digits();
    if (at_ < text_.size() && (text_[at_] == 'e' || text_[at_] == 'E')) {
      ++at_;
      if (at_ < text_.size() && (text_[at_] == '+' || text_[at_] == '-')) ++at_;
      skip_digits();
    }
    return add_number(parse_decimal(text_.substr(begin, at_ - begin), where_));
  }

  long exponent() {
    const Nesting nesting(*this);
    if (take('-')) return -exponent();
    if (take('(')) return closed(exponent());
    if (!is_digit(peek())) fail("an integer exponent");
    long base = 0;
    for (; at_ < text_.size() && is_digit(text_[at_]); ++at_) base = bounded(10 * base + (text_[at_] - '0'));
    if (!take('^')) return base;
    long result = 1;
    for (long n = exponent(); n != 0; --n) {
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
  std::string take_name() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  int add(const Node& node) {
    result_.nodes_.push_back(node);
    return static_cast<int>(result_.nodes_.size()) - 1;
  }
  int add_number(const mpq_class& value) {
    result_.numbers_.push_back(value);
    return add({Op::kNumber, static_cast<int>(result_.numbers_.size()) - 1});
  }

  [[noreturn]] void fail(const std::string& expected) const {
    throw Malformed(where_ + ": '" + text_.substr(0, 60) + "', column " + std::to_string(at_ + 1) + ": expected " +
                    expected);
  }

  struct Nesting {
    explicit Nesting(ExpressionParser& parser) : parser_(parser) {
      if (++parser_.depth_ > kMaxDepth) parser_.fail("fewer nested parentheses");
    }
    ~Nesting() { --parser_.depth_; }
    Nesting(const Nesting&) = delete;
    Nesting& operator=(const Nesting&) = delete;
    ExpressionParser& parser_;
  };

  const std::string& text_;
  const std::vector<std::string>& parameters_;
  const std::map<std::string, mpq_class>& constants_;
  const std::string& where_;
  Expression& result_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

Expression::Expression(const std::string& text, const std::vector<std::string>& parameters,
                       const std::map<std::string, mpq_class>& constants, const std::string& where) {
  ExpressionParser(text, parameters, constants, where, *this).parse();
}

Form Expression::evaluate(std::span<const Form> parameters) const {
  std::vector<Form> values;
  values.reserve(nodes_.size());
  for (const Node& node : nodes_) {
    const auto a = [&]() -> const Form& { return values[static_cast<std::size_t>(node.a)]; };
    const auto b = [&]() -> const Form& { return values[static_cast<std::size_t>(node.b)]; };
    const auto value = [&]() -> Form {
      switch (node.op) {
        case Op::kNumber: return Form(Interval(numbers_[static_cast<std::size_t>(node.n)]));
        case Op::kPi: return Form(Interval::pi());
        case Op::kParameter: return parameters[static_cast<std::size_t>(node.n)];
        case Op::kAdd: return a() + b();
        case Op::kSubtract: return a() - b();
        case Op::kMultiply: return a() * b();
        case Op::kDivide: return a() / b();
        case Op::kNegate: return -a();
        case Op::kPower: return power(a(), node.n);
        case Op::kSqrt: return sqrt(a());
        case Op::kSin: return sin(a());
        case Op::kCos: return cos(a());
        case Op::kTan: return sin(a()) / cos(a());
        case Op::kExp: return exp(a());
        case Op::kLog: return log(a());
        case Op::kAsin: return asin(a());
        case Op::kAcos: return acos(a());
        case Op::kAtan: return atan(a());
        case Op::kAtan2: return atan2(a(), b());
      }
      throw std::logic_error("an operation without a meaning");
    };
    values.push_back(value());
  }
  return values.back();
}

bool Expression::mentions(int parameter) const {
  for (const Node& node : nodes_) {
    if (node.op == Op::kParameter && node.n == parameter) return true;
  }
  return false;
}

std::optional<long> Expression::turns(int parameter) const {
  struct Known {
    std::optional<long> turns;
    std::optional<long> integer;  ///< the value itself, where it is a number that was typed, or its negative
  };
  const auto bounded = [](long k) { return std::abs(k) <= kMaxTurns ? std::optional(k) : std::nullopt; };
  const Known none;
  std::vector<Known> known;
  known.reserve(nodes_.size());
  for (const Node& node : nodes_) {
    const Known& a = node.a < 0 ? none : known[static_cast<std::size_t>(node.a)];
    const Known& b = node.b < 0 ? none : known[static_cast<std::size_t>(node.b)];
    // A function of nothing but values that do not change.
    const bool unchanged = (node.a < 0 || a.turns == 0) && (node.b < 0 || b.turns == 0);
    Known result;
    if (unchanged) result.turns = 0;
    switch (node.op) {
      case Op::kParameter: result.turns = node.n == parameter ? 1 : 0; break;
      case Op::kNumber: {
        const mpq_class& number = numbers_[static_cast<std::size_t>(node.n)];
        if (number.get_den() == 1 && abs(number) <= kMaxTurns) result.integer = number.get_num().get_si();
        break;
      }
      case Op::kNegate:
        if (a.turns) result.turns = -*a.turns;
        if (a.integer) result.integer = -*a.integer;
        break;
      case Op::kAdd:
        if (a.turns && b.turns) result.turns = bounded(*a.turns + *b.turns);
        break;
      case Op::kSubtract:
        if (a.turns && b.turns) result.turns = bounded(*a.turns - *b.turns);
        break;
      case Op::kMultiply:
        if (!unchanged && a.integer && b.turns) result.turns = bounded(*a.integer * *b.turns);
        if (!unchanged && b.integer && a.turns) result.turns = bounded(*b.integer * *a.turns);
        break;
      case Op::kPower:
        if (node.n == 0) result = {0, 1};
        if (node.n == 1) result = a;
        break;
      case Op::kSin:
      case Op::kCos:
      case Op::kTan:
        if (a.turns) result.turns = 0;
        break;
      default: break;  // as `unchanged` says
    }
    known.push_back(result);
  }
  return known.back().turns;
}

bool Expression::is_free_name(const std::string& name) {
  if (name.empty() || !is_letter(name[0]) || name == "pi" || ExpressionParser::functions().count(name) > 0)
    return false;
  for (char c : name) {
    if (!is_letter(c) && !is_digit(c)) return false;
  }
  return true;
}

}  // namespace taut::checker
