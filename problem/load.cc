// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "base/input_error.h"
#include "problem/decimal.h"
#include "problem/rational.h"

namespace taut {
namespace {

using nlohmann::json;

template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};

// --- Reading -----------------------------------------------------------------------------------------------------

template <std::size_t N>
std::array<RationalText, N> read_numbers(const JsonCursor& value) {
  std::array<RationalText, N> numbers;
  const std::vector<JsonCursor> elements = value.elements(N);
  for (std::size_t i = 0; i < N; ++i) numbers[i] = elements[i].text();
  return numbers;
}

Axes read_axes(const JsonCursor& value) {
  if (value.text() == "W") return Axes::kWorld;
  if (value.text() == "P") return Axes::kPlatform;
  value.fail("\"W\" or \"P\"");
}

/// The first of `kinds` that the object has as a key.
const char* kind_of(const JsonCursor& value, std::initializer_list<const char*> kinds) {
  for (const char* kind : kinds) {
    if (value.contains(kind)) return kind;
  }
  value.fail(fmt::format("an object with one of the keys {}", fmt::join(kinds, ", ")));
}

constexpr std::initializer_list<const char*> kSets = {"ball", "disc", "segment"};

VectorSet read_set(const JsonCursor& value) {
  const std::string kind = kind_of(value, kSets);
  const JsonCursor set = value.at(kind.c_str());
  if (kind == "ball") {
    set.expect_keys({"radius"});
    return BallOfVectors{set.at("radius").text()};
  }
  if (kind == "disc") {
    set.expect_keys({"radius", "normal"});
    return DiscOfVectors{set.at("radius").text(), read_numbers<3>(set.at("normal"))};
  }
  set.expect_keys({"direction", "range"});
  const auto [lower, upper] = read_numbers<2>(set.at("range"));
  return SegmentOfVectors{read_numbers<3>(set.at("direction")), lower, upper};
}

LoadItem read_item(const JsonCursor& value) {
  const std::string kind = kind_of(value, {"weight", "force", "moment", "load_cases"});
  value.expect_keys({"name", kind.c_str()});
  const JsonCursor what = value.at(kind.c_str());
  LoadItem item{value.at("name").text(), {}};
  if (kind == "weight") {
    const bool has_box = what.contains("inertia_box_m");
    std::vector<std::string> keys = {"mass_kg", "at_m", "at_tolerance_m"};
    if (has_box) keys.emplace_back("inertia_box_m");
    what.expect_keys(keys);
    const auto [lower, upper] = read_numbers<2>(what.at("mass_kg"));
    Weight weight{lower, upper, read_numbers<3>(what.at("at_m")), what.at("at_tolerance_m").text()};
    if (has_box) weight.inertia_box = read_numbers<3>(what.at("inertia_box_m"));
    item.what = std::move(weight);
  } else if (kind == "force") {
    what.expect_keys({kind_of(what, kSets), "axes", "at_m"});
    item.what = Force{read_set(what), read_axes(what.at("axes")), read_numbers<3>(what.at("at_m"))};
  } else if (kind == "moment") {
    what.expect_keys({kind_of(what, kSets), "axes"});
    item.what = Moment{read_set(what), read_axes(what.at("axes"))};
  } else {
    what.expect_keys({"wrenches", "axes", "at_m"});
    LoadCases cases{{}, read_axes(what.at("axes")), read_numbers<3>(what.at("at_m"))};
    for (const JsonCursor& wrench : what.at("wrenches").elements()) cases.wrenches.push_back(read_numbers<6>(wrench));
    item.what = std::move(cases);
  }
  return item;
}

// --- Writing -----------------------------------------------------------------------------------------------------

const char* axes_name(Axes axes) { return axes == Axes::kWorld ? "W" : "P"; }

/// {"ball": …}, {"disc": …} or {"segment": …}
json set_to_json(const VectorSet& set) {
  return std::visit(
      Overloaded{[](const BallOfVectors& s) -> json {
                   return {{"ball", {{"radius", s.radius}}}};
                 },
                 [](const DiscOfVectors& s) -> json {
                   return {{"disc", {{"radius", s.radius}, {"normal", s.normal}}}};
                 },
                 [](const SegmentOfVectors& s) -> json {
                   return {{"segment", {{"direction", s.direction}, {"range", json::array({s.lower, s.upper})}}}};
                 }},
      set);
}

json item_to_json(const LoadItem& item) {
  json result = {{"name", item.name}};
  std::visit(
      Overloaded{[&](const Weight& w) {
                   json& weight = result["weight"] = {{"mass_kg", json::array({w.mass_lower, w.mass_upper})},
                                                      {"at_m", w.at},
                                                      {"at_tolerance_m", w.at_tolerance}};
                   if (w.inertia_box) weight["inertia_box_m"] = *w.inertia_box;
                 },
                 [&](const Force& f) {
                   json& force = result["force"] = set_to_json(f.set);
                   force["axes"] = axes_name(f.axes);
                   force["at_m"] = f.at;
                 },
                 [&](const Moment& m) {
                   json& moment = result["moment"] = set_to_json(m.set);
                   moment["axes"] = axes_name(m.axes);
                 },
                 [&](const LoadCases& c) {
                   result["load_cases"] = {{"wrenches", c.wrenches}, {"axes", axes_name(c.axes)}, {"at_m", c.at}};
                 }},
      item.what);
  return result;
}

// --- Validating --------------------------------------------------------------------------------------------------

Rational number_at(const std::string& where, const RationalText& text) {
  try {
    return parse_rational(text);
  } catch (const InputError& error) {
    throw FieldError(where, "", error.what());
  }
}

template <std::size_t N>
std::array<Rational, N> numbers_at(const std::string& where, const std::array<RationalText, N>& texts) {
  std::array<Rational, N> numbers;
  for (std::size_t k = 0; k < N; ++k) numbers[k] = number_at(fmt::format("{}[{}]", where, k), texts[k]);
  return numbers;
}

void validate_direction(const std::string& where, const RationalVector& direction) {
  const auto v = numbers_at(where, direction);
  if (v[0] == 0 && v[1] == 0 && v[2] == 0) throw FieldError(where, "the zero vector", "expected a direction");
}

void validate_not_negative(const std::string& where, const RationalText& text) {
  if (number_at(where, text) < 0) throw FieldError(where, text, "expected a number >= 0");
}

void validate_range(const std::string& where, const RationalText& lower, const RationalText& upper) {
  if (number_at(where + "[0]", lower) > number_at(where + "[1]", upper)) {
    throw FieldError(where, fmt::format("[{}, {}]", lower, upper), "expected lower <= upper");
  }
}

void validate_set(const std::string& where, const VectorSet& set) {
  std::visit(Overloaded{[&](const BallOfVectors& s) { validate_not_negative(where + ".radius", s.radius); },
                        [&](const DiscOfVectors& s) {
                          validate_not_negative(where + ".radius", s.radius);
                          validate_direction(where + ".normal", s.normal);
                        },
                        [&](const SegmentOfVectors& s) {
                          validate_direction(where + ".direction", s.direction);
                          validate_range(where + ".range", s.lower, s.upper);
                        }},
             set);
}

void validate_box(const std::string& where, const RationalVector& sides) {
  const auto lengths = numbers_at(where, sides);
  for (std::size_t k = 0; k < 3; ++k) {
    if (lengths[k] > 0 && lengths[k] <= kGreatestInertiaBox_m) continue;
    throw FieldError(fmt::format("{}[{}]", where, k), excerpt(sides[k]),
                     fmt::format("expected a length above zero, and at most {} m", kGreatestInertiaBox_m));
  }
}

void validate_item(const std::string& where, const LoadItem& item) {
  std::visit(Overloaded{[&](const Weight& w) {
                          validate_not_negative(where + ".mass", w.mass_lower);
                          validate_range(where + ".mass", w.mass_lower, w.mass_upper);
                          numbers_at(where + ".at", w.at);
                          validate_not_negative(where + ".at_tolerance", w.at_tolerance);
                          if (w.inertia_box) validate_box(where + ".inertia.box", *w.inertia_box);
                        },
                        [&](const Force& f) {
                          validate_set(where + ".force", f.set);
                          numbers_at(where + ".at", f.at);
                        },
                        [&](const Moment& m) { validate_set(where + ".moment", m.set); },
                        [&](const LoadCases& c) {
                          if (c.wrenches.empty() || c.wrenches.size() > kMaxLoadCases) {
                            throw FieldError(where + ".wrenches", fmt::format("{} load cases", c.wrenches.size()),
                                             fmt::format("expected 1 to {}", kMaxLoadCases));
                          }
                          for (std::size_t j = 0; j < c.wrenches.size(); ++j) {
                            numbers_at(fmt::format("{}.wrenches[{}]", where, j), c.wrenches[j]);
                          }
                          numbers_at(where + ".at", c.at);
                        }},
             item.what);
}

void validate_name(const std::string& where, const std::string& name) {
  const bool is_line = std::ranges::none_of(name, [](unsigned char c) { return c < ' ' || c == 127; });
  if (name.empty() || characters(name) > kMaxItemName || !is_line || valid_utf8_prefix(name) != name.size()) {
    throw FieldError(where, "'" + excerpt(name) + "'",
                     fmt::format("expected a name of 1 to {} characters on one line", kMaxItemName));
  }
}

void validate_names(const std::vector<LoadItem>& items, const std::string& ellipsoid_name) {
  if (items.size() > kMaxLoadItems) {
    throw FieldError("load.items", fmt::format("{} items", items.size()),
                     fmt::format("expected at most {}; a box of forces counts as three, an acceleration as one or two "
                                 "for each weight",
                                 kMaxLoadItems));
  }
  std::set<std::string> seen = {ellipsoid_name};
  for (std::size_t k = 0; k < items.size(); ++k) {
    const std::string& name = items[k].name;
    const std::string where = fmt::format("load.items[{}].name", k);
    validate_name(where, name);
    if (!seen.insert(name).second) {
      throw FieldError(where, "'" + excerpt(name) + "' twice", "expected a name of its own for each item");
    }
  }
}

/// Symmetric elimination in rational arithmetic: E is positive definite exactly if every pivot is positive.
void validate_ellipsoid(const EllipsoidText& ellipsoid) {
  const std::string where = "load.ellipsoid";
  std::array<std::array<Rational, 6>, 6> e;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      e[i][j] = number_at(fmt::format("{}[{}][{}]", where, i, j), ellipsoid[i][j]);
      if (j < i && e[i][j] != e[j][i]) {
        throw FieldError(
            where,
            fmt::format("{} in row {}, column {} and {} opposite", ellipsoid[i][j], i + 1, j + 1, ellipsoid[j][i]),
            "expected a symmetric matrix");
      }
    }
  }
  for (std::size_t k = 0; k < 6; ++k) {
    if (e[k][k] <= 0) {
      throw FieldError(where, fmt::format("a leading {0} x {0} block that is not positive definite", k + 1),
                       "expected a positive definite matrix");
    }
    for (std::size_t i = k + 1; i < 6; ++i) {
      for (std::size_t j = i; j < 6; ++j) e[i][j] -= e[k][i] * e[k][j] / e[k][k];
    }
  }
}

// --- Whether there is a load at all --------------------------------------------------------------------------------

using Vector = std::array<double, 3>;

double size_of(const Vector& v) { return std::hypot(v[0], v[1], v[2]); }
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector vector_approx(const RationalVector& texts) {
  return {from_rational<double>(texts[0]), from_rational<double>(texts[1]), from_rational<double>(texts[2])};
}

/// The force in the middle of an item's set, in the axes of the set.
Vector nominal_force_approx(const LoadItem& item, const Vector& gravity) {
  const auto times = [](double k, const Vector& v) -> Vector { return {k * v[0], k * v[1], k * v[2]}; };
  return std::visit(Overloaded{[&](const Weight& w) {
                                 return times(
                                     (from_rational<double>(w.mass_lower) + from_rational<double>(w.mass_upper)) / 2,
                                     gravity);
                               },
                               [&](const Force& f) {
                                 const auto* segment = std::get_if<SegmentOfVectors>(&f.set);
                                 if (!segment) return Vector{};
                                 const double lower = from_rational<double>(segment->lower);
                                 const double upper = from_rational<double>(segment->upper);
                                 const Vector e = vector_approx(segment->direction);
                                 return times(lower <= 0 && upper >= 0 ? 0 : (lower + upper) / 2 / size_of(e), e);
                               },
                               [](const Moment&) { return Vector{}; },
                               [&](const LoadCases& c) {
                                 Vector sum{};
                                 for (const auto& wrench : c.wrenches) {
                                   for (std::size_t k = 0; k < 3; ++k) sum[k] += from_rational<double>(wrench[k]);
                                 }
                                 return times(1 / static_cast<double>(c.wrenches.size()), sum);
                               }},
                    item.what);
}

bool turns_with_platform(const LoadItem& item) {
  const auto* force = std::get_if<Force>(&item.what);
  const auto* cases = std::get_if<LoadCases>(&item.what);
  return (force && force->axes == Axes::kPlatform) || (cases && cases->axes == Axes::kPlatform);
}

/// Cables only pull: a platform on which nothing pulls hangs from none of them. It is found in floating point, as a
/// mistake; what is close is left to the proof.
void validate_there_is_a_load(const LoadText& load) {
  const Vector gravity = vector_approx(load.gravity_m_s2);
  Vector force = vector_approx({load.wrench[0], load.wrench[1], load.wrench[2]});
  double scale = size_of(force);
  for (const LoadItem& item : load.items) {
    const Vector nominal = nominal_force_approx(item, gravity);
    // Where it points depends on the pose.
    if (turns_with_platform(item) && size_of(nominal) > 0) return;
    for (std::size_t k = 0; k < 3; ++k) force[k] += nominal[k];
    scale += size_of(nominal);
  }
  constexpr double kRounding = 1e-12;
  if (size_of(force) <= kRounding * scale) {
    throw FieldError("load.items", "a load whose nominal force is zero",
                     "expected a weight or another force that keeps the cables taut");
  }
  const double size = size_of(gravity);
  const double down = size > 0 ? dot(force, gravity) / size : 0;
  if (size > 0 && down <= kRounding * scale) {
    throw FieldError(
        "load.items",
        fmt::format("a nominal force of {:.4g} N along gravity", std::abs(down) < kRounding * scale ? 0 : down),
        "expected a downward load; where gravity is given, the load has to pull along it");
  }
}

bool has_weight(const LoadText& load) {
  return std::ranges::any_of(load.items,
                             [](const LoadItem& item) { return std::holds_alternative<Weight>(item.what); });
}

void validate_items(const LoadText& load) {
  validate_names(load.items, load.ellipsoid_name);
  const auto gravity = numbers_at("load.gravity", load.gravity_m_s2);
  for (const LoadItem& item : load.items) validate_item(fmt::format("load.items[{}]", item.name), item);
  if (has_weight(load) && gravity == std::array<Rational, 3>{}) {
    throw FieldError("load.gravity", "none", "expected gravity, such as [0, 0, -9.81 m/s^2], as there are masses");
  }
  validate_there_is_a_load(load);
}

}  // namespace

void validate(const LoadText& load) {
  for (std::size_t k = 0; k < 3; ++k) static_cast<void>(decimal_at(fmt::format("load.point[{}]", k), load.point_m[k]));
  bool has_wrench = false;
  for (std::size_t i = 0; i < load.wrench.size(); ++i) {
    has_wrench |= decimal_at(fmt::format("load.wrench[{}]", i), load.wrench[i]).sign() != 0;
  }
  if (load.ellipsoid) validate_ellipsoid(*load.ellipsoid);
  if (!load.ellipsoid_name.empty()) validate_name("load.ellipsoid_name", load.ellipsoid_name);
  if (load.items.empty() && !load.ellipsoid) {
    throw FieldError("load", "neither items nor an ellipsoid",
                     "expected 'items', the list of what the load consists of");
  }
  if (has_wrench && !load.ellipsoid) {
    throw FieldError("load.wrench", "a wrench without an ellipsoid", "expected both or neither");
  }
  if (!load.items.empty()) validate_items(load);
}

json to_json(const LoadText& load) {
  json result = {{"point_m", load.point_m}};
  if (load.ellipsoid) {
    result["wrench"] = load.wrench;
    result["ellipsoid"] = *load.ellipsoid;
    if (!load.ellipsoid_name.empty()) result["ellipsoid_name"] = load.ellipsoid_name;
  }
  if (load.items.empty()) return result;
  result["gravity_m_s2"] = load.gravity_m_s2;
  json& items = result["items"] = json::array();
  for (const LoadItem& item : load.items) items.push_back(item_to_json(item));
  return result;
}

LoadText load_from_json(const JsonCursor& value) {
  const bool has_items = value.contains("items");
  const bool has_ellipsoid = !has_items || value.contains("ellipsoid") || value.contains("wrench");
  std::vector<std::string> keys = {"point_m"};
  if (has_items) keys.insert(keys.end(), {"gravity_m_s2", "items"});
  if (has_ellipsoid) keys.insert(keys.end(), {"wrench", "ellipsoid"});
  const bool has_name = has_ellipsoid && value.contains("ellipsoid_name");
  if (has_name) keys.emplace_back("ellipsoid_name");
  value.expect_keys(keys);
  LoadText load;
  load.point_m = read_numbers<3>(value.at("point_m"));
  if (has_ellipsoid) {
    load.wrench = read_numbers<6>(value.at("wrench"));
    EllipsoidText& ellipsoid = load.ellipsoid.emplace();
    const std::vector<JsonCursor> rows = value.at("ellipsoid").elements(6);
    for (std::size_t i = 0; i < 6; ++i) ellipsoid[i] = read_numbers<6>(rows[i]);
    if (has_name) load.ellipsoid_name = value.at("ellipsoid_name").text();
  }
  if (!has_items) return load;
  load.gravity_m_s2 = read_numbers<3>(value.at("gravity_m_s2"));
  for (const JsonCursor& item : value.at("items").elements()) load.items.push_back(read_item(item));
  if (load.items.empty()) value.at("items").fail("at least one item");
  return load;
}

}  // namespace taut
