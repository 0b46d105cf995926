// SPDX-License-Identifier: GPL-3.0-or-later
// The fields of a case file: nodes of YAML that know their place, and the numbers in them. Internal to case/.
#pragma once

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/input_error.h"
#include "problem/decimal.h"
#include "problem/problem.h"
#include "problem/rational.h"
#include "problem/units.h"

namespace taut::case_fields {

/// Whether the node is a list of up to six scalars.
[[nodiscard]] bool is_list_of_scalars(const YAML::Node& node);
/// The node as messages quote it: "'34 deg'", "[1, 2]", "a map".
[[nodiscard]] std::string describe(const YAML::Node& node);
[[nodiscard]] std::string join(const std::vector<std::string>& words);

/// The file's name and the places of its fields.
class Places {
 public:
  explicit Places(std::string file) : file_(std::move(file)) {}

  void remember(const std::string& path, const YAML::Node& node);

  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& path, const std::string& message) const;
  /// Reports the error at the place of the problem's field, or of the closest field around it.
  [[noreturn]] void fail(const FieldError& error) const;
  /// "crane.yaml:12:5: load.mass: …"
  [[nodiscard]] std::string text(const YAML::Mark& mark, const std::string& path, const std::string& message) const;

 private:
  std::string file_;
  std::map<std::string, YAML::Node> nodes_;
};

class Map;

class Field {
 public:
  Field(Places& places, const YAML::Node& node, std::string path);

  [[nodiscard]] const YAML::Node& node() const { return node_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  /// The same field under another path, which messages name instead.
  [[nodiscard]] Field renamed(const std::string& path) const { return {*places_, node_, path}; }

  [[noreturn]] void fail(const std::string& expected) const;
  [[noreturn]] void complain(const std::string& message) const { places_->fail(node_.Mark(), path_, message); }
  /// A message that names the field's place.
  [[nodiscard]] std::string remark(const std::string& message) const {
    return places_->text(node_.Mark(), path_, message);
  }
  /// Makes the field known under another path of the problem, too.
  void remember_as(const std::string& path) const { places_->remember(path, node_); }

  [[nodiscard]] std::string text(const std::string& expected) const;
  [[nodiscard]] std::vector<Field> list(const std::string& expected) const;
  [[nodiscard]] std::vector<Field> list(std::size_t size, const std::string& expected) const;

  /// A map with any keys.
  [[nodiscard]] Map open_map(const std::string& expected) const;
  /// A map that has no other keys than `keys`.
  [[nodiscard]] Map map(const std::vector<std::string>& keys) const;
  /// Likewise; `hint` may say what an unknown key means, in a text that ends with a space.
  [[nodiscard]] Map map(const std::vector<std::string>& keys,
                        const std::function<std::string(const std::string& key)>& hint) const;

 private:
  Places* places_;
  YAML::Node node_;
  std::string path_;
};

class Map {
 public:
  Map(Field field, std::vector<std::pair<std::string, Field>> entries)
      : field_(std::move(field)), entries_(std::move(entries)) {}

  [[nodiscard]] const Field& field() const { return field_; }
  [[nodiscard]] const std::vector<std::pair<std::string, Field>>& entries() const& { return entries_; }
  void entries() && = delete;  // would dangle

  [[nodiscard]] std::optional<Field> find(const std::string& key) const {
    for (const auto& [name, field] : entries_) {
      if (name == key) return field;
    }
    return std::nullopt;
  }
  [[nodiscard]] Field at(const std::string& key) const {
    if (const auto field = find(key)) return *field;
    field_.complain(fmt::format("got no '{0}', expected the key '{0}'", key));
  }

 private:
  Field field_;
  std::vector<std::pair<std::string, Field>> entries_;
};

/// Calls `read`; an InputError ("got …, expected …") that it throws is reported at the field.
template <class Read>
auto in_field(const Field& field, Read read) {
  try {
    return read();
  } catch (const InputError& error) {
    const std::string message = error.what();
    field.complain(message.starts_with("got ")
                       ? fmt::format("got {}{}", describe(field.node()), message.substr(message.rfind(", expected")))
                       : message);
  }
}

[[nodiscard]] Decimal read_decimal(const Field& field);

/// The value that the field names.
template <class T>
T read_choice(const Field& field, const std::vector<std::pair<std::string, T>>& choices) {
  std::vector<std::string> names;
  for (const auto& [name, value] : choices) names.push_back(name);
  const std::string expected = "one of " + join(names);
  const std::string text = field.text(expected);
  for (const auto& [name, value] : choices) {
    if (name == text) return value;
  }
  field.fail(expected);
}

/// The unit of this dimension that the field names. @param what  begins what is expected, before the names of units
[[nodiscard]] Unit read_unit(const Field& field, Dimension dimension, const std::string& what);

/// The units of bare numbers.
class Units {
 public:
  Units() = default;
  explicit Units(const Map& map) {
    for (std::size_t i = 0; i < units_.size(); ++i) {
      const auto dimension = static_cast<Dimension>(i);
      const auto field = map.find(dimension_name(dimension));
      if (!field) continue;
      units_[i] = read_unit(*field, dimension, "one of ");
    }
  }
  [[nodiscard]] const Unit& operator[](Dimension dimension) const {
    return units_[static_cast<std::size_t>(dimension)];
  }
  [[nodiscard]] CaseUnits all() const {
    return {(*this)[Dimension::kLength], (*this)[Dimension::kForce], (*this)[Dimension::kMoment],
            (*this)[Dimension::kMass], (*this)[Dimension::kAngle]};
  }

 private:
  std::array<Unit, kDimensionsOfUnits> units_ = {si_unit(Dimension::kLength), si_unit(Dimension::kForce),
                                                 si_unit(Dimension::kMoment), si_unit(Dimension::kMass),
                                                 si_unit(Dimension::kAngle),  si_unit(Dimension::kTime)};
};

/// A decimal in SI, such as "350 mm" → "0.35".
[[nodiscard]] DecimalText read_quantity(const Field& field, const Unit& bare);

/// The exact value of a number or an expression such as 1/6^2.
[[nodiscard]] Rational read_number(const Field& field, const std::string& expected = "a number, such as 0.05 or 1/6^2");
/// Likewise of a quantity, bare or with a unit, in SI. @pre `bare` is no angle
[[nodiscard]] Rational read_rational(const Field& field, const Unit& bare);
/// "2 %" is 1/50; nothing for a field that does not end in %.
[[nodiscard]] std::optional<Rational> read_percentage(const Field& field);
/// The canonical text. @throws InputError at the field for a number with too many digits
[[nodiscard]] RationalText text_of(const Field& field, const Rational& value);

[[nodiscard]] bool is_decimal(const std::string& text);

/// The names that an expression may mention.
struct Names {
  std::vector<std::string> parameters;
  std::map<std::string, DecimalText> constants;
};

/// An expression in SI: "zs - rs*sin(alpha2)" → "(zs - rs*sin(alpha2))*0.001".
[[nodiscard]] ExpressionText read_expression(const Field& field, const Unit& bare, const Names& names);

}  // namespace taut::case_fields
