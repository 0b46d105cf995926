// SPDX-License-Identifier: GPL-3.0-or-later
#include "case/fields.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <string_view>

#include "base/nearest.h"
#include "base/sanitize.h"
#include "problem/expression.h"

namespace taut::case_fields {

bool is_list_of_scalars(const YAML::Node& node) {
  return node.IsSequence() && node.size() <= 6 &&
         std::all_of(node.begin(), node.end(), [](const YAML::Node& item) { return item.IsScalar(); });
}

std::string describe(const YAML::Node& node) {
  if (node.IsScalar()) return "'" + excerpt(node.Scalar()) + "'";
  if (node.IsMap()) return "a map";
  if (is_list_of_scalars(node)) {
    std::string items;
    for (const YAML::Node& item : node) items += (items.empty() ? "" : ", ") + excerpt(item.Scalar());
    return "[" + items + "]";
  }
  return node.IsSequence() ? fmt::format("a list of {}", node.size()) : "nothing";
}

void Places::remember(const std::string& path, const YAML::Node& node) {
  nodes_.erase(path);  // assignment of YAML nodes would alter the tree
  nodes_.emplace(path, node);
}

std::string Places::text(const YAML::Mark& mark, const std::string& path, const std::string& message) const {
  const std::string place = mark.is_null() ? file_ : fmt::format("{}:{}:{}", file_, mark.line + 1, mark.column + 1);
  return path.empty() ? fmt::format("{}: {}", place, message) : fmt::format("{}: {}: {}", place, path, message);
}

void Places::fail(const YAML::Mark& mark, const std::string& path, const std::string& message) const {
  throw InputError(text(mark, path, message),
                   {file_, mark.is_null() ? 0 : static_cast<std::size_t>(mark.line) + 1, path});
}

void Places::fail(const FieldError& error) const {
  std::string path = error.field();
  if (path.starts_with("space.")) {
    const std::string on_surface = "space.surface" + path.substr(std::string("space").size());
    if (nodes_.contains(on_surface)) path = on_surface;
  }
  const std::string constraints = "space.constraints";
  if (path.starts_with(constraints)) path.replace(0, constraints.size(), "space.implicit");
  std::string known = path;
  while (!known.empty() && !nodes_.contains(known)) {
    known.erase(std::min(known.find_last_of(".["), known.size() - 1));
  }
  const auto node = nodes_.find(known);
  std::string seen = error.seen();
  if (!seen.empty() && known == path && (node->second.IsScalar() || is_list_of_scalars(node->second))) {
    seen = describe(node->second);
  }
  fail(node == nodes_.end() ? YAML::Mark::null_mark() : node->second.Mark(), path,
       seen.empty() ? error.expected() : fmt::format("got {}, {}", seen, error.expected()));
}

Field::Field(Places& places, const YAML::Node& node, std::string path)
    : places_(&places), node_(node), path_(std::move(path)) {
  places_->remember(path_, node_);
}

void Field::fail(const std::string& expected) const {
  complain(fmt::format("got {}, expected {}", describe(node_), expected));
}

std::string Field::text(const std::string& expected) const {
  if (!node_.IsScalar() || node_.Scalar().empty()) fail(expected);
  return node_.Scalar();
}

std::vector<Field> Field::list(const std::string& expected) const {
  if (!node_.IsSequence()) fail(expected);
  std::vector<Field> items;
  for (const YAML::Node& item : node_) items.emplace_back(*places_, item, fmt::format("{}[{}]", path_, items.size()));
  return items;
}

std::vector<Field> Field::list(std::size_t size, const std::string& expected) const {
  if (!node_.IsSequence() || node_.size() != size) fail(expected);
  return list(expected);
}

std::string join(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, ", ")); }

Map Field::open_map(const std::string& expected) const {
  if (!node_.IsMap()) fail(expected);
  std::vector<std::pair<std::string, Field>> entries;
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    if (!entry.first.IsScalar()) places_->fail(entry.first.Mark(), path_, "got a compound key, expected a word");
    const std::string& key = entry.first.Scalar();
    if (!seen.insert(key).second) {
      places_->fail(entry.first.Mark(), path_, fmt::format("got '{}' twice, expected each key once", excerpt(key)));
    }
    entries.emplace_back(key, Field(*places_, entry.second, path_.empty() ? key : path_ + "." + key));
  }
  return {*this, std::move(entries)};
}

Map Field::map(const std::vector<std::string>& keys) const {
  return map(keys, [](const std::string&) { return std::string(); });
}

Map Field::map(const std::vector<std::string>& keys,
               const std::function<std::string(const std::string& key)>& hint_for) const {
  Map result = open_map("a map with the keys " + join(keys));
  for (const auto& entry : node_) {
    const std::string& key = entry.first.Scalar();
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    const std::string shown = excerpt(key);
    const std::optional<std::string> nearest = nearest_word(shown, keys);
    std::string hint = hint_for(key);
    if (hint.empty() && nearest) hint = fmt::format("did you mean '{}'? ", *nearest);
    places_->fail(entry.first.Mark(), path_,
                  fmt::format("got the unknown key '{}', {}expected {}", shown, hint, join(keys)));
  }
  return result;
}

Decimal read_decimal(const Field& field) {
  const std::string text = field.text("a decimal number such as 0.05 or 1e-4");
  return in_field(field, [&] { return Decimal::parse(text); });
}

Unit read_unit(const Field& field, Dimension dimension, const std::string& what) {
  const std::string expected = what + unit_names(dimension);
  const auto unit = find_unit(field.text(expected));
  if (!unit || unit->dimension != dimension) field.fail(expected);
  return *unit;
}

namespace {

/// The field's text without its unit, and the unit, which is `bare` if the text has none.
std::pair<std::string, Unit> read_with_unit(const Field& field, const Unit& bare, const std::string& expected) {
  auto [value, unit] = split_unit(field.text(expected));
  if (unit && unit->dimension != bare.dimension) field.fail(expected);
  return {value, unit.value_or(bare)};
}

}  // namespace

namespace {

/// Refuses what no machine has, and what can't be squared or said in another unit in binary64.
void check_magnitude(const Field& field, const Rational& in_si, Dimension dimension) {
  static const Rational kMost = Rational(pow(boost::multiprecision::cpp_int(10), 100));
  const Rational size = abs(in_si);
  if (size == 0 || (size * kMost >= 1 && size <= kMost)) return;
  field.fail(fmt::format("zero or a magnitude between 1e-100 and 1e100 {}", si_unit(dimension).name));
}

}  // namespace

DecimalText read_quantity(const Field& field, const Unit& bare) {
  const std::string expected = fmt::format("a {}: a decimal number, bare ({}) or with one of the units {}",
                                           dimension_name(bare.dimension), bare.name, unit_names(bare.dimension));
  const auto [value, unit] = read_with_unit(field, bare, expected);
  if (value.find(' ') != std::string::npos) field.fail(expected);  // an unknown unit, or more than one number
  const DecimalText in_si = in_field(field, [&, v = value, u = unit] { return decimal_to_si(v, u); });
  if (bare.dimension != Dimension::kAngle) check_magnitude(field, Decimal::parse(in_si).rational(), bare.dimension);
  return in_si;
}

namespace {

/// A word in `value` is no exact number: an unknown unit, a function, pi.
Rational exact_value(const Field& field, const std::string& value, const std::string& expected) {
  const auto is_of_a_word = [](unsigned char c) { return std::isalpha(c) && c != 'e' && c != 'E'; };
  if (std::ranges::any_of(value, is_of_a_word)) field.fail(expected);
  return in_field(field, [&] { return evaluate_exactly(value); });
}

}  // namespace

Rational read_number(const Field& field, const std::string& expected) {
  return exact_value(field, field.text(expected), expected);
}

Rational read_rational(const Field& field, const Unit& bare) {
  const std::string expected =
      fmt::format("{} {}: a number or an expression such as 1/6^2, bare ({}) or with one of the units {}",
                  bare.dimension == Dimension::kArea || bare.dimension == Dimension::kAcceleration ? "an" : "a",
                  dimension_name(bare.dimension), bare.name, unit_names(bare.dimension));
  const auto [value, unit] = read_with_unit(field, bare, expected);
  const Rational in_si = exact_value(field, value, expected) * unit.factor.rational() / unit.divisor;
  check_magnitude(field, in_si, bare.dimension);
  return in_si;
}

std::optional<Rational> read_percentage(const Field& field) {
  if (!field.node().IsScalar() || !field.node().Scalar().ends_with('%')) return std::nullopt;
  const std::string& text = field.node().Scalar();
  return exact_value(field, text.substr(0, text.size() - 1), "a percentage such as 2 %") / 100;
}

RationalText text_of(const Field& field, const Rational& value) {
  return in_field(field, [&] { return rational_text(value); });
}

bool is_decimal(const std::string& text) {
  try {
    static_cast<void>(Decimal::parse(text));
    return true;
  } catch (const InputError&) {
    return false;
  }
}

ExpressionText read_expression(const Field& field, const Unit& bare, const Names& names) {
  const std::string expected =
      fmt::format("a number or {}expression, bare ({}) or with one of the units {}",
                  names.parameters.empty() ? "constant " : "", bare.name, unit_names(bare.dimension));
  const auto [value, unit] = read_with_unit(field, bare, expected);
  return in_field(field, [&, v = value, u = unit]() -> ExpressionText {
    if (is_decimal(v)) return decimal_to_si(v, u);
    static_cast<void>(
        ExpressionTape({v}, names.parameters, names.constants));  // its complaints are about what was typed
    return expression_to_si(v, u);
  });
}

}  // namespace taut::case_fields
