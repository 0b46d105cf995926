// SPDX-License-Identifier: GPL-3.0-or-later
// The grammar of docs/certificate-format.md, in Boost.Spirit X3. The next token decides every choice, so that an
// operation is put on the tape as soon as it is read.
#include <fmt/format.h>

#include <algorithm>
#include <boost/fusion/include/at_c.hpp>
#include <boost/spirit/home/x3.hpp>

#include "base/input_error.h"
#include "problem/tape_builder.h"

namespace taut {
namespace {

namespace x3 = boost::spirit::x3;
using x3::_attr;
using x3::_val;
using Iterator = std::string::const_iterator;

constexpr std::size_t kMaxLength = 4096;  ///< of an expression; with kMaxNesting it bounds the parser's recursion
constexpr int kMaxNesting = 200;
constexpr int kMaxExponent = 64;

/// A fault of the expression, at `where`.
struct Complaint {
  Iterator where;
  std::string expected;
};

const std::string kExponentExpected = fmt::format("an integer exponent from -{0} to {0}", kMaxExponent);

// --- Semantic actions --------------------------------------------------------------------------------------------

struct BuilderTag;

/// Sets the rule's value to make(builder); an error of the builder gets its place in the text.
template <class Context, class Make>
void set_slot(Context& context, Iterator where, Make make) {
  try {
    _val(context) = make(x3::get<BuilderTag>(context).get());
  } catch (const InputError& error) {
    const std::string message = error.what();
    throw Complaint{where, message.substr(message.rfind("expected"))};
  }
}

const auto keep = [](auto& context) { _val(context) = _attr(context); };
const auto number = [](auto& context) {
  const auto text = _attr(context);
  set_slot(context, text.begin(), [&](TapeBuilder& tape) { return tape.decimal({text.begin(), text.end()}); });
};
const auto named = [](auto& context) {
  const auto text = _attr(context);
  set_slot(context, text.begin(), [&](TapeBuilder& tape) { return tape.name({text.begin(), text.end()}); });
};
const auto power = [](auto& context) {
  const Iterator where = x3::_where(context).begin();
  set_slot(context, where, [&](TapeBuilder& tape) { return tape.power(_val(context), _attr(context)); });
};
const auto negate = [](auto& context) {
  const Iterator where = x3::_where(context).begin();
  set_slot(context, where, [&](TapeBuilder& tape) { return tape.unary(Op::kNegate, _attr(context)); });
};
const auto call = [](auto& context) {
  const auto [op, argument] = std::pair(boost::fusion::at_c<0>(_attr(context)), boost::fusion::at_c<1>(_attr(context)));
  const Iterator where = x3::_where(context).begin();
  set_slot(context, where, [&, op = op, a = argument](TapeBuilder& tape) { return tape.unary(op, a); });
};
const auto call_atan2 = [](auto& context) {
  const int y = boost::fusion::at_c<0>(_attr(context));
  const int x = boost::fusion::at_c<1>(_attr(context));
  const Iterator where = x3::_where(context).begin();
  set_slot(context, where, [&](TapeBuilder& tape) { return tape.binary(Op::kAtan2, y, x); });
};
auto binary(Op op) {
  return [op](auto& context) {
    const Iterator where = x3::_where(context).begin();
    set_slot(context, where, [&](TapeBuilder& tape) { return tape.binary(op, _val(context), _attr(context)); });
  };
}

const auto exponent_literal = [](auto& context) {
  int value = 0;
  for (const char digit : _attr(context)) {
    value = 10 * value + (digit - '0');
    if (value > kMaxExponent) throw Complaint{_attr(context).begin(), "expected " + kExponentExpected};
  }
  _val(context) = value;
};
const auto exponent_power = [](auto& context) {
  int value = 1;
  for (int i = 0; i < _attr(context); ++i) {
    value *= _val(context);
    if (value > kMaxExponent) throw Complaint{x3::_where(context).begin(), "expected " + kExponentExpected};
  }
  _val(context) = value;
};
const auto exponent_negate = [](auto& context) { _val(context) = -_attr(context); };

// --- The grammar; messages use a rule's name to say what was expected ------------------------------------------------

struct Functions : x3::symbols<Op> {
  Functions() {
    add("sqrt", Op::kSqrt)("sin", Op::kSin)("cos", Op::kCos)("tan", Op::kTan)("exp", Op::kExp)("log", Op::kLog)(
        "asin", Op::kAsin)("acos", Op::kAcos)("atan", Op::kAtan);
  }
} const functions;

const auto name_char = x3::char_("0-9A-Za-z_");
const auto digits = +x3::char_("0-9");
const auto decimal = x3::raw[x3::lexeme[(digits >> -('.' >> *x3::char_("0-9")) | '.' >> digits) >>
                                        -(x3::char_("eE") >> -x3::char_("+-") >> digits)]];
const auto identifier = x3::raw[x3::lexeme[x3::char_("A-Za-z_") >> *name_char]];
const auto function = x3::lexeme[functions >> !name_char];

const x3::rule<class Sum, int> sum = "a value";
const x3::rule<class Product, int> product = "a value";
const x3::rule<class Unary, int> signed_power = "a value";
const x3::rule<class Power, int> power_of = "a value";
const x3::rule<class Primary, int> primary = "a value";
const x3::rule<class Exponent, int> exponent = kExponentExpected.c_str();
const x3::rule<class SignedTower, int> signed_tower = kExponentExpected.c_str();
const x3::rule<class Tower, int> tower = kExponentExpected.c_str();

const auto sum_def = product[keep] >> *(('+' > product)[binary(Op::kAdd)] | ('-' > product)[binary(Op::kSubtract)]);
const auto product_def = signed_power[keep] >>
                         *(('*' > signed_power)[binary(Op::kMultiply)] | ('/' > signed_power)[binary(Op::kDivide)]);
const auto signed_power_def = ('-' > signed_power)[negate] | power_of[keep];
const auto power_of_def = primary[keep] >> -('^' > exponent)[power];
const auto function_call = (function > '(' > sum > ')')[call];
const auto atan2_call = (x3::lexeme["atan2" >> !name_char] > '(' > sum > ',' > sum > ')')[call_atan2];
const auto primary_def = decimal[number] | ('(' > sum > ')')[keep] | function_call | atan2_call | identifier[named];
const auto exponent_def = ('(' > signed_tower > ')')[keep] | signed_tower[keep];
const auto signed_tower_def = ('-' > tower)[exponent_negate] | tower[keep];
const auto tower_def = x3::raw[x3::lexeme[digits >> !x3::char_(".A-Za-z_")]][exponent_literal] >>
                       -('^' > tower)[exponent_power];

BOOST_SPIRIT_DEFINE(sum, product, signed_power, power_of, primary, exponent, signed_tower, tower)

// --- Guards against hostile text -------------------------------------------------------------------------------

void check_size(const std::string& text) {
  const auto odd = std::find_if(text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; });
  if (odd != text.end()) throw Complaint{odd, "expected printable ASCII characters"};
  if (text.size() > kMaxLength) {
    throw Complaint{text.begin() + kMaxLength, fmt::format("expected at most {} characters", kMaxLength)};
  }
  int nesting = 0;  // of parentheses
  int pending = 0;  // signs and '^' in the current run, each of which makes the parser recurse once
  for (Iterator it = text.begin(); it != text.end(); ++it) {
    if (*it == '(') ++nesting;
    if (*it == ')') --nesting;
    if (*it == '-' || *it == '^') {
      ++pending;
    } else if (*it != ' ') {
      pending = 0;
    }
    if (nesting + pending > kMaxNesting) throw Complaint{it, fmt::format("expected nesting up to {}", kMaxNesting)};
  }
}

int parse(const std::string& text, TapeBuilder& builder) {
  check_size(text);
  int slot = 0;
  Iterator it = text.begin();
  const auto grammar = x3::with<BuilderTag>(std::ref(builder))[x3::eps > sum];
  try {
    x3::phrase_parse(it, text.end(), grammar, x3::space, slot);
  } catch (const x3::expectation_failure<Iterator>& failure) {
    Iterator where = failure.where();
    while (where != text.end() && *where == ' ') ++where;
    throw Complaint{where, "expected " + failure.which()};
  }
  if (it != text.end()) throw Complaint{it, "expected an operator or the end of the expression"};
  return slot;
}

}  // namespace

int parse_expression(const ExpressionText& text, TapeBuilder& builder) {
  try {
    return parse(text, builder);
  } catch (const Complaint& complaint) {
    const std::string rest(complaint.where, text.end());
    throw InputError(fmt::format("expression '{}', column {}: got {}, {}", excerpt(text),
                                 complaint.where - text.begin() + 1,
                                 rest.empty() ? "its end" : "'" + excerpt(rest) + "'", complaint.expected));
  }
}

}  // namespace taut
