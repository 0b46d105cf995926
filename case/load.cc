// SPDX-License-Identifier: GPL-3.0-or-later
#include "case/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/sanitize.h"
#include "case/around_items.h"
#include "problem/load.h"

namespace taut::case_fields {
namespace {

const std::vector<std::string> kLoadKeys = {"name", "point", "wrench", "mass", "gravity", "ellipsoid", "items"};

using RationalPoint = std::array<Rational, 3>;

RationalVector texts_of(const Field& field, const RationalPoint& values) {
  return {text_of(field, values[0]), text_of(field, values[1]), text_of(field, values[2])};
}

/// A wrench's unit: forces first, then moments.
const Unit& wrench_unit(const Units& units, std::size_t i) {
  return units[i < 3 ? Dimension::kForce : Dimension::kMoment];
}

RationalVector read_point(const Field& field, const Units& units) {
  const std::vector<Field> coordinates = field.list(3, "a point: a list of three lengths");
  RationalVector point;
  for (std::size_t k = 0; k < 3; ++k) {
    point[k] = text_of(coordinates[k], read_rational(coordinates[k], units[Dimension::kLength]));
  }
  return point;
}

RationalVector read_gravity(const Field& field) {
  const std::vector<Field> entries = field.list(3, "a list of three accelerations in m/s^2");
  RationalVector gravity;
  for (std::size_t k = 0; k < 3; ++k) {
    gravity[k] = text_of(entries[k], read_rational(entries[k], si_unit(Dimension::kAcceleration)));
  }
  return gravity;
}

std::array<RationalText, 6> read_rational_wrench(const Field& field, const Units& units) {
  const std::vector<Field> entries = field.list(6, "a list of three forces and three moments");
  std::array<RationalText, 6> wrench;
  for (std::size_t i = 0; i < 6; ++i) {
    wrench[i] = text_of(entries[i], read_rational(entries[i], wrench_unit(units, i)));
  }
  return wrench;
}

// --- The ellipsoid -----------------------------------------------------------------------------------------------

/// E, and what is needed to tell whether semi-axes were meant.
struct Ellipsoid {
  EllipsoidText matrix;
  std::optional<Field> diagonal;
  std::array<Rational, 6> typed;  ///< of the diagonal, in the case's units
};

constexpr const char* kAroundItems = "around_items";

bool says_around_items(const Field& ellipsoid) {
  return ellipsoid.node().IsScalar() && ellipsoid.node().Scalar() == kAroundItems;
}

Ellipsoid read_ellipsoid(const Field& field, const Units& units) {
  if (says_around_items(field)) {
    field.complain(fmt::format("got '{0}' without 'items', expected items, or E itself", kAroundItems));
  }
  const Map map = field.map({"semi_axes", "diagonal", "matrix"});
  if (map.entries().size() != 1) {
    field.complain(
        fmt::format("got {} keys, expected one of 'semi_axes', 'diagonal' and 'matrix'", map.entries().size()));
  }
  const auto to_si = [&](const Field& entry, const Rational& value, std::size_t i, std::size_t j) {
    return text_of(entry, value / wrench_unit(units, i).factor.rational() / wrench_unit(units, j).factor.rational());
  };
  Ellipsoid result;
  for (auto& row : result.matrix) row.fill("0");
  if (const auto axes = map.find("semi_axes")) {
    const std::vector<Field> entries = axes->list(6, "a list of three forces and three moments");
    for (std::size_t i = 0; i < 6; ++i) {
      const Rational axis = read_rational(entries[i], wrench_unit(units, i));
      if (axis <= 0) entries[i].fail(fmt::format("a {} above zero", dimension_name(wrench_unit(units, i).dimension)));
      result.matrix[i][i] = text_of(entries[i], 1 / (axis * axis));
    }
  } else if ((result.diagonal = map.find("diagonal"))) {
    const std::vector<Field> entries = result.diagonal->list(6, "a list of six numbers");
    for (std::size_t i = 0; i < 6; ++i) {
      result.typed[i] = read_number(entries[i]);
      result.matrix[i][i] = to_si(entries[i], result.typed[i], i, i);
    }
  } else {
    const std::vector<Field> rows = map.at("matrix").list(6, "a list of six rows");
    for (std::size_t i = 0; i < 6; ++i) {
      const std::vector<Field> entries = rows[i].list(6, "a row of six numbers");
      for (std::size_t j = 0; j < 6; ++j) result.matrix[i][j] = to_si(entries[j], read_number(entries[j]), i, j);
    }
  }
  return result;
}

/// The size of the force in the middle of the load, without items that are no weights [N].
double nominal_force_approx(const LoadText& load) {
  std::array<double, 3> force{};
  for (std::size_t k = 0; k < 3; ++k) force[k] = from_rational<double>(load.wrench[k]);
  for (const LoadItem& item : load.items) {
    const auto* weight = std::get_if<Weight>(&item.what);
    if (!weight) continue;
    const double mass = (from_rational<double>(weight->mass_lower) + from_rational<double>(weight->mass_upper)) / 2;
    for (std::size_t k = 0; k < 3; ++k) force[k] += mass * from_rational<double>(load.gravity_m_s2[k]);
  }
  return std::hypot(force[0], force[1], force[2]);
}

/// Warns of a diagonal of E that looks like semi-axes: its forces are numbers that a deviation of this load could have,
/// yet what they allow for is much less than the load and less than the numbers say.
void warn_of_semi_axes(const Ellipsoid& ellipsoid, const LoadText& load, const Units& units,
                       std::vector<std::string>& warnings) {
  if (!ellipsoid.diagonal) return;
  constexpr double kTooSmall = 0.05, kPlausible = 2;  // of the load's force
  const double nominal =
      nominal_force_approx(load) / ScalarTraits<double>::from_decimal(units[Dimension::kForce].factor.text());
  bool is_less = false;
  std::array<double, 6> axes{};
  for (std::size_t i = 0; i < 6; ++i) {
    const auto typed = ellipsoid.typed[i].convert_to<double>();
    if (!(typed > 0)) return;  // refused later
    axes[i] = 1 / std::sqrt(typed);
    if (i >= 3) continue;
    if (typed < 1 || typed > kPlausible * nominal || axes[i] > kTooSmall * nominal) return;
    is_less |= axes[i] <= typed / 2;
  }
  if (!is_less) return;
  std::string as_typed;
  for (const YAML::Node& entry : ellipsoid.diagonal->node())
    as_typed += (as_typed.empty() ? "" : ", ") + entry.Scalar();
  warnings.push_back(ellipsoid.diagonal->remark(fmt::format(
      "these numbers look like semi-axes, but each is 1 over the square of one: the force may deviate by only {:.3g}, "
      "{:.3g} and {:.3g} {}, the moment by {:.3g}, {:.3g} and {:.3g} {}. If {} were meant, write semi_axes: [{}]",
      axes[0], axes[1], axes[2], units[Dimension::kForce].name, axes[3], axes[4], axes[5],
      units[Dimension::kMoment].name, excerpt(as_typed), excerpt(as_typed))));
}

// --- Items -------------------------------------------------------------------------------------------------------

/// What an item of each kind may say besides its name and its kind.
const std::vector<std::pair<std::string, std::vector<std::string>>> kKinds = {
    {"mass", {"mass_tolerance", "at", "at_tolerance", "inertia"}},
    {"force", {"direction", "axes", "at", "at_tolerance"}},
    {"force_box", {"axes", "at", "at_tolerance"}},
    {"moment", {"direction", "axes"}},
    {"moment_box", {"axes"}},
    {"wind", {"at", "at_tolerance"}},
    {"acceleration", {}},
    {"wrenches", {"axes", "at"}},
    {"wrench", {"axes", "at", "ellipsoid"}},
};

/// Reads the items of a load, one after the other.
class ItemReader {
 public:
  ItemReader(const Units& units, bool in_time, LoadText& load, std::vector<std::string>& warnings)
      : units_(units), in_time_(in_time), load_(load), warnings_(warnings) {}

  void read(const Field& list);
  /// That of an item with an ellipsoid, if there is one.
  [[nodiscard]] const std::optional<Ellipsoid>& ellipsoid() const { return ellipsoid_; }

 private:
  void read_item(const Field& field);
  void read_mass(const Map& item);
  void read_force(const Map& item);
  void read_moment(const Map& item);
  void read_box(const Map& item, bool is_force);
  void read_wind(const Map& item);
  void read_wrenches(const Map& item);
  void read_wrench(const Map& item);
  void accelerate(const Map& item);

  [[nodiscard]] VectorSet read_set(const Map& item, const Field& amount, const Unit& unit) const;
  [[nodiscard]] Axes read_axes(const Map& item) const;
  [[nodiscard]] RationalVector read_at(const Map& item) const;
  [[nodiscard]] Rational read_at_tolerance(const Map& item) const;
  /// @param mass  the nominal one
  [[nodiscard]] RationalVector read_inertia(const Field& field, const Rational& mass) const;
  [[nodiscard]] RationalVector read_moments(const Field& field, const Rational& mass) const;
  [[nodiscard]] DiscOfVectors horizontal(RationalText radius) const;
  /// What a force up to `magnitude` adds where its point is known to a tolerance only: a moment in any direction.
  void add_moment_of_tolerance(const Map& item, const VectorSet& moments_at_one_metre, Axes axes);
  void add(const Field& item, const std::string& name, decltype(LoadItem::what) what);

  const Units& units_;
  const bool in_time_;
  LoadText& load_;
  std::vector<std::string>& warnings_;
  std::optional<Ellipsoid> ellipsoid_;
  std::vector<Map> accelerations_;
  std::set<std::string> names_;
  std::string name_;  ///< of the item that is read
};

void ItemReader::read(const Field& list) {
  const std::string expected = "a list of items such as {name: payload, mass: 12 t, at: [0, 0, -1.2]}";
  const std::vector<Field> items = list.list(expected);
  if (items.empty()) list.fail(expected);
  for (const Field& item : items) read_item(item);
  for (const Map& item : accelerations_) accelerate(item);
}

void ItemReader::read_item(const Field& field) {
  const Field name = field.open_map("a map with a name").at("name");
  name_ = name.text("a name");
  const bool is_line = std::ranges::none_of(name_, [](unsigned char c) { return c < ' ' || c == 127; });
  if (characters(name_) > kMaxItemName || !is_line) {
    name.fail(fmt::format("a name of 1 to {} characters on one line", kMaxItemName));
  }
  if (!names_.insert(name_).second) {
    name.complain(fmt::format("got '{}' twice, expected a name of its own for each item", excerpt(name_)));
  }
  std::vector<std::string> all = {"name"};
  for (const auto& [kind, others] : kKinds) all.push_back(kind);
  const std::vector<std::string> kinds(all.begin() + 1, all.end());
  for (const auto& [kind, others] : kKinds) {
    for (const std::string& key : others) {
      if (std::ranges::find(all, key) == all.end()) all.push_back(key);
    }
  }
  const Map item = field.renamed(fmt::format("load.items[{}]", excerpt(name_))).map(all);
  std::vector<std::string> found;
  for (const std::string& kind : kinds) {
    if (item.find(kind)) found.push_back(kind);
  }
  if (found.size() != 1) {
    item.field().complain(fmt::format("got {} in one item, expected exactly one of {}",
                                      found.empty() ? "no load" : join(found), join(kinds)));
  }
  const auto kind = std::ranges::find(kKinds, found[0], &std::pair<std::string, std::vector<std::string>>::first);
  for (const auto& [key, value] : item.entries()) {
    if (key == "name" || key == kind->first || std::ranges::find(kind->second, key) != kind->second.end()) continue;
    value.complain(fmt::format("got '{}' beside '{}', expected nothing there but {}", key, kind->first,
                               kind->second.empty() ? "the name" : join(kind->second)));
  }
  if (found[0] == "mass") return read_mass(item);
  if (found[0] == "force") return read_force(item);
  if (found[0] == "force_box") return read_box(item, true);
  if (found[0] == "moment") return read_moment(item);
  if (found[0] == "moment_box") return read_box(item, false);
  if (found[0] == "wind") return read_wind(item);
  if (found[0] == "wrenches") return read_wrenches(item);
  if (found[0] == "wrench") return read_wrench(item);
  accelerations_.push_back(item);
}

void ItemReader::add(const Field& item, const std::string& name, decltype(LoadItem::what) what) {
  if (name != name_ && !names_.insert(name).second) {
    item.complain(
        fmt::format("got another item '{}', expected that name to be free: this item adds it", excerpt(name)));
  }
  item.remember_as(fmt::format("load.items[{}]", name));
  load_.items.push_back({name, std::move(what)});
}

void ItemReader::read_mass(const Map& item) {
  const Unit& unit = units_[Dimension::kMass];
  const Field mass = item.at("mass");
  const auto tolerance = item.find("mass_tolerance");
  Rational lower, upper;
  if (mass.node().IsSequence()) {
    const std::vector<Field> ends = mass.list(2, "a mass or a range [lower, upper] of masses");
    lower = read_rational(ends[0], unit);
    upper = read_rational(ends[1], unit);
    if (lower < 0 || lower > upper || upper == 0) mass.fail("0 <= lower <= upper and a mass above zero");
    if (tolerance) tolerance->complain("got a tolerance of a range of masses, expected one or the other");
  } else {
    const Rational nominal = read_rational(mass, unit);
    if (nominal <= 0) mass.fail("a mass above zero");
    Rational deviation = 0;
    if (tolerance) {
      const auto share = read_percentage(*tolerance);
      deviation = share ? Rational(*share * nominal) : read_rational(*tolerance, unit);
      if (deviation < 0 || deviation > nominal) {
        tolerance->fail(fmt::format("a tolerance from 0 to the mass itself, which is {}", describe(mass.node())));
      }
    }
    lower = nominal - deviation;
    upper = nominal + deviation;
  }
  const Rational at_tolerance = read_at_tolerance(item);
  Weight weight{text_of(mass, lower), text_of(mass, upper), read_at(item), text_of(item.field(), at_tolerance)};
  if (const auto inertia = item.find("inertia")) {
    const RationalVector box = read_inertia(*inertia, (lower + upper) / 2);
    if (in_time_) {
      weight.inertia_box = box;
    } else {
      warnings_.push_back(
          inertia->remark("is not used without 'time': what is proved holds for motion so slow that forces of inertia "
                          "are within the other items, such as an acceleration"));
    }
  }
  add(item.field(), name_, std::move(weight));
}

/// The sides of the evenly filled box of this mass that has these moments of inertia: I_x = m/12 (y² + z²) and so on.
RationalVector ItemReader::read_moments(const Field& field, const Rational& mass) const {
  const Unit unit = si_unit(Dimension::kInertia);
  const std::vector<Field> entries = field.list(3, "three moments of inertia, about the axes of P");
  const bool is_clear = units_[Dimension::kMass].name == "kg" && units_[Dimension::kLength].name == "m";
  std::array<Rational, 3> moments;
  for (std::size_t k = 0; k < 3; ++k) {
    const bool is_bare = entries[k].node().IsScalar() && !split_unit(entries[k].node().Scalar()).second;
    if (is_bare && !is_clear) {
      entries[k].fail(
          fmt::format("a moment of inertia with its unit, one of {}, as 'units' has other masses or lengths",
                      unit_names(Dimension::kInertia)));
    }
    moments[k] = read_rational(entries[k], unit);
    if (moments[k] <= 0) entries[k].fail("a moment of inertia above zero");
  }
  RationalVector box;
  for (std::size_t k = 0; k < 3; ++k) {
    const Rational square = moments[(k + 1) % 3] + moments[(k + 2) % 3] - moments[k];
    if (square <= 0) {
      entries[k].fail("a moment of inertia below the sum of the other two, as every body with some extent has");
    }
    box[k] = text_of(entries[k], root_above(6 * square / mass));
  }
  return box;
}

RationalVector ItemReader::read_inertia(const Field& field, const Rational& mass) const {
  const Map map = field.map({"box", "moments"});
  const auto moments = map.find("moments");
  if (moments && map.find("box")) moments->complain("got it beside 'box', expected one of them");
  if (moments) return read_moments(*moments, mass);
  const std::vector<Field> sides = map.at("box").list(3, "the three lengths of a box");
  RationalVector box;
  for (std::size_t k = 0; k < 3; ++k) {
    const Rational side = read_rational(sides[k], units_[Dimension::kLength]);
    if (side <= 0) sides[k].fail("a length above zero");
    box[k] = text_of(sides[k], side);
  }
  return box;
}

VectorSet ItemReader::read_set(const Map& item, const Field& amount, const Unit& unit) const {
  const std::string what = dimension_name(unit.dimension);
  const std::string expected = "'any', 'horizontal', or a vector of three numbers";
  const Field direction = item.at("direction");
  const bool is_range = amount.node().IsSequence();
  Rational lower = 0, upper;
  if (is_range) {
    const std::vector<Field> ends = amount.list(2, fmt::format("a {} or a range [lower, upper] of them", what));
    lower = read_rational(ends[0], unit);
    upper = read_rational(ends[1], unit);
    if (lower > upper) amount.fail("lower <= upper");
  } else {
    upper = read_rational(amount, unit);
    if (upper <= 0) amount.fail(fmt::format("a {} above zero; its direction says which way it points", what));
  }
  if (direction.node().IsSequence()) {
    const std::vector<Field> entries = direction.list(3, expected);
    const RationalPoint e = {read_number(entries[0]), read_number(entries[1]), read_number(entries[2])};
    if (e == RationalPoint{}) direction.fail("a direction other than zero");
    return SegmentOfVectors{texts_of(direction, e), text_of(amount, lower), text_of(amount, upper)};
  }
  const std::string word = direction.text(expected);
  if (word != "any" && word != "horizontal") direction.fail(expected);
  if (is_range) direction.fail(fmt::format("a vector, as the {} is a range", what));
  if (word == "any") return BallOfVectors{text_of(amount, upper)};
  if (read_axes(item) == Axes::kPlatform) direction.fail("'any' or a vector where axes are P: the platform tilts");
  return horizontal(text_of(amount, upper));
}

DiscOfVectors ItemReader::horizontal(RationalText radius) const {
  const bool has_gravity = load_.gravity_m_s2 != RationalVector{"0", "0", "0"};
  return {std::move(radius), has_gravity ? load_.gravity_m_s2 : RationalVector{"0", "0", "1"}};
}

Axes ItemReader::read_axes(const Map& item) const {
  const auto axes = item.find("axes");
  return axes ? read_choice<Axes>(*axes, {{"W", Axes::kWorld}, {"P", Axes::kPlatform}}) : Axes::kWorld;
}

RationalVector ItemReader::read_at(const Map& item) const {
  if (const auto at = item.find("at")) return read_point(*at, units_);
  return load_.point_m;
}

Rational ItemReader::read_at_tolerance(const Map& item) const {
  const auto field = item.find("at_tolerance");
  const Rational tolerance = field ? read_rational(*field, units_[Dimension::kLength]) : Rational(0);
  if (tolerance < 0) field->fail("a tolerance >= 0");
  return tolerance;
}

/// The set with every vector so many times as long. @pre factor >= 0, and the set is a ball or a disc
VectorSet scaled(VectorSet set, const Field& field, const Rational& factor) {
  auto* disc = std::get_if<DiscOfVectors>(&set);
  RationalText& radius = disc ? disc->radius : std::get<BallOfVectors>(set).radius;
  radius = text_of(field, parse_rational(radius) * factor);
  return set;
}

/// The moments of the forces in the set at levers of up to 1 m in any direction, or slightly more of them: all are at
/// right angles to their force, and so for forces along one direction in one plane.
VectorSet moments_at_one_metre(const Field& field, const VectorSet& forces) {
  const RationalText radius = text_of(field, greatest(forces));
  if (const auto* segment = std::get_if<SegmentOfVectors>(&forces)) return DiscOfVectors{radius, segment->direction};
  return BallOfVectors{radius};
}

void ItemReader::add_moment_of_tolerance(const Map& item, const VectorSet& moments_at_one_metre, Axes axes) {
  const Rational tolerance = read_at_tolerance(item);
  if (tolerance == 0) return;
  add(item.field(), name_ + ", moment", Moment{scaled(moments_at_one_metre, item.field(), tolerance), axes});
}

void ItemReader::read_force(const Map& item) {
  const VectorSet set = read_set(item, item.at("force"), units_[Dimension::kForce]);
  add(item.field(), name_, Force{set, read_axes(item), read_at(item)});
  add_moment_of_tolerance(item, moments_at_one_metre(item.field(), set), read_axes(item));
}

void ItemReader::read_moment(const Map& item) {
  add(item.field(), name_, Moment{read_set(item, item.at("moment"), units_[Dimension::kMoment]), read_axes(item)});
}

void ItemReader::read_box(const Map& item, bool is_force) {
  constexpr std::array<const char*, 3> kNames = {"x", "y", "z"};
  const Unit& unit = units_[is_force ? Dimension::kForce : Dimension::kMoment];
  const Field box = item.at(is_force ? "force_box" : "moment_box");
  const std::string expected = fmt::format("three ranges [lower, upper] of a {}", dimension_name(unit.dimension));
  const std::vector<Field> ranges = box.list(3, expected);
  Rational square = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::vector<Field> ends = ranges[k].list(2, expected);
    const Rational lower = read_rational(ends[0], unit), upper = read_rational(ends[1], unit);
    if (lower > upper) ranges[k].fail("lower <= upper");
    if (lower == 0 && upper == 0) continue;
    RationalVector axis = {"0", "0", "0"};
    axis[k] = "1";
    const SegmentOfVectors set = {axis, text_of(ends[0], lower), text_of(ends[1], upper)};
    const std::string name = fmt::format("{} {}", name_, kNames[k]);
    if (is_force) {
      add(item.field(), name, Force{set, read_axes(item), read_at(item)});
    } else {
      add(item.field(), name, Moment{set, read_axes(item)});
    }
    const Rational size = greatest(set);
    square += size * size;
  }
  if (square == 0) box.fail("a box that contains more than zero");
  if (!is_force) return;
  add_moment_of_tolerance(item, BallOfVectors{text_of(item.field(), root_above(square))}, Axes::kWorld);
}

void ItemReader::read_wind(const Map& item) {
  const Map wind = item.at("wind").map({"drag_area", "speed", "air_density"});
  const auto read_positive = [](const Field& field, Dimension dimension) {
    const Rational value = read_rational(field, si_unit(dimension));
    if (value <= 0)
      field.fail(
          fmt::format("{} {} above zero", dimension == Dimension::kArea ? "an" : "a", dimension_name(dimension)));
    return value;
  };
  const Rational area = read_positive(wind.at("drag_area"), Dimension::kArea);
  const Rational speed = read_positive(wind.at("speed"), Dimension::kSpeed);
  const auto typed = wind.find("air_density");
  const Rational density = typed ? read_positive(*typed, Dimension::kDensity) : Rational(5, 4);
  const Rational force = density * area * speed * speed / 2;
  add(item.field(), name_, Force{horizontal(text_of(item.at("wind"), force)), Axes::kWorld, read_at(item)});
  add_moment_of_tolerance(item, BallOfVectors{text_of(item.field(), force)}, Axes::kWorld);
}

void ItemReader::read_wrenches(const Map& item) {
  const std::string expected =
      fmt::format("a list of 1 to {} wrenches: three forces and three moments each", kMaxLoadCases);
  LoadCases cases{{}, read_axes(item), read_at(item)};
  const std::vector<Field> wrenches = item.at("wrenches").list(expected);
  if (wrenches.empty() || wrenches.size() > kMaxLoadCases) item.at("wrenches").fail(expected);
  for (const Field& wrench : wrenches) cases.wrenches.push_back(read_rational_wrench(wrench, units_));
  add(item.field(), name_, std::move(cases));
}

void ItemReader::read_wrench(const Map& item) {
  const std::array<RationalText, 6> wrench = read_rational_wrench(item.at("wrench"), units_);
  const auto ellipsoid = item.find("ellipsoid");
  if (!ellipsoid) return add(item.field(), name_, LoadCases{{wrench}, read_axes(item), read_at(item)});
  if (item.find("axes") || item.find("at")) {
    ellipsoid->complain("got an ellipsoid with 'axes' or 'at', expected neither: it is in W, about load.point");
  }
  if (load_.ellipsoid) ellipsoid->complain("got a second ellipsoid, expected one at most in a load");
  for (const RationalText& number : wrench) {
    if (number.find('/') != std::string::npos) item.at("wrench").fail("decimal numbers beside an ellipsoid");
  }
  ellipsoid_ = read_ellipsoid(*ellipsoid, units_);
  load_.ellipsoid = ellipsoid_->matrix;
  load_.ellipsoid_name = name_;
  load_.wrench = wrench;
  for (std::size_t i = 0; i < 6; ++i) item.at("wrench").remember_as(fmt::format("load.wrench[{}]", i));
  ellipsoid->remember_as("load.ellipsoid");
}

void ItemReader::accelerate(const Map& item) {
  const Field field = item.at("acceleration");
  const Rational acceleration = read_rational(field, si_unit(Dimension::kAcceleration));
  if (acceleration <= 0) field.fail("an acceleration above zero");
  std::vector<LoadItem> weights;
  std::ranges::copy_if(load_.items, std::back_inserter(weights),
                       [](const LoadItem& other) { return std::holds_alternative<Weight>(other.what); });
  if (weights.empty()) field.complain("got an acceleration, but no item with a mass, expected one");
  const bool has_wrench = load_.ellipsoid || std::ranges::any_of(load_.items, [](const LoadItem& other) {
                            return std::holds_alternative<LoadCases>(other.what);
                          });
  if (has_wrench) {
    warnings_.push_back(
        field.remark("accelerates the items with a mass; what is stated as a wrench has none, and is not accelerated"));
  }
  name_ = item.at("name").node().Scalar();
  for (const LoadItem& payload : weights) {
    const Weight& weight = std::get<Weight>(payload.what);
    const Rational force = parse_rational(weight.mass_upper) * acceleration;
    const Rational moment = force * parse_rational(weight.at_tolerance);
    const std::string name = fmt::format("{} of {}", name_, payload.name);
    add(item.field(), name, Force{BallOfVectors{text_of(field, force)}, Axes::kWorld, weight.at});
    if (moment == 0) continue;
    add(item.field(), name + ", moment", Moment{BallOfVectors{text_of(field, moment)}, Axes::kWorld});
  }
}

// --- A load without items ----------------------------------------------------------------------------------------

std::array<DecimalText, 6> read_wrench(const Field& field, const Units& units) {
  std::array<DecimalText, 6> wrench;
  const std::vector<Field> entries = field.list(6, "a list of three forces and three moments");
  for (std::size_t i = 0; i < 6; ++i) wrench[i] = read_quantity(entries[i], wrench_unit(units, i));
  return wrench;
}

/// An acceleration in m/s², as a decimal.
Decimal read_acceleration(const Field& field) {
  return Decimal::parse(read_quantity(field, si_unit(Dimension::kAcceleration)));
}

/// Under no force and no moment every tension is 0, which no limit allows.
void require_a_load(const std::array<DecimalText, 6>& wrench, const Field& field) {
  const bool is_zero = std::ranges::all_of(wrench, [](const DecimalText& x) { return Decimal::parse(x).sign() == 0; });
  if (is_zero) field.fail("a load that keeps the cables taut: a force or a moment other than zero");
}

std::array<DecimalText, 6> read_mass_or_wrench(const Map& load, const Units& units) {
  const auto typed = load.find("wrench");
  const auto mass_field = load.find("mass");
  if (typed.has_value() == mass_field.has_value()) {
    load.field().complain(
        fmt::format("got {} of 'wrench' and 'mass', expected one of them, or 'items'", typed ? "both" : "neither"));
  }
  if (typed) {
    if (const auto gravity = load.find("gravity")) gravity->fail("'gravity' only together with 'mass' or 'items'");
    const std::array<DecimalText, 6> wrench = read_wrench(*typed, units);
    require_a_load(wrench, *typed);
    return wrench;
  }
  std::array<DecimalText, 6> wrench{"0", "0", "0", "0", "0", "0"};
  const Decimal mass = Decimal::parse(read_quantity(*mass_field, units[Dimension::kMass]));
  if (mass.sign() <= 0) mass_field->fail("a mass above zero");
  const std::vector<Field> gravity = load.at("gravity").list(3, "a list of three accelerations in m/s^2");
  for (std::size_t k = 0; k < 3; ++k) {
    wrench[k] = in_field(gravity[k], [&] { return (mass * read_acceleration(gravity[k])).text(); });
  }
  require_a_load(wrench, load.at("gravity"));
  return wrench;
}

/// Reads a load with items, and perhaps an ellipsoid beside them. Returns that ellipsoid.
std::optional<Ellipsoid> read_items(const Map& map, const Field& items, const Units& units, bool in_time,
                                    LoadText& load, std::vector<std::string>& warnings) {
  if (const auto mass = map.find("mass")) mass->complain("got a mass beside 'items', expected it as one of the items");
  if (const auto gravity = map.find("gravity")) load.gravity_m_s2 = read_gravity(*gravity);
  const auto wrench = map.find("wrench"), field = map.find("ellipsoid");
  if (wrench && !field) {
    wrench->complain(
        "got a wrench beside 'items' without an ellipsoid, expected it as an item: {name: …, wrench: […]}");
  }
  const bool around_items = field && says_around_items(*field);
  std::optional<Ellipsoid> ellipsoid;
  if (around_items) {
    if (wrench) wrench->complain("got a wrench beside 'ellipsoid: around_items', expected it as one of the items");
  } else if (field) {
    ellipsoid = read_ellipsoid(*field, units);
    load.ellipsoid = ellipsoid->matrix;
    if (wrench) load.wrench = read_wrench(*wrench, units);
  }
  ItemReader reader(units, in_time, load, warnings);
  reader.read(items);
  if (around_items && reader.ellipsoid()) {
    field->complain("got 'around_items' and an item that is an ellipsoid, expected one or the other");
  }
  return reader.ellipsoid() ? reader.ellipsoid() : ellipsoid;
}

}  // namespace

LoadText read_load(const Field& field, const Units& units, bool in_time, std::vector<std::string>& warnings) {
  const Map map = field.map(kLoadKeys);
  LoadText load;
  load.point_m.fill("0");
  if (const auto point = map.find("point")) {
    const std::vector<Field> coordinates = point->list(3, "a point: a list of three lengths");
    for (std::size_t k = 0; k < 3; ++k) load.point_m[k] = read_quantity(coordinates[k], units[Dimension::kLength]);
  }
  std::optional<Ellipsoid> ellipsoid;
  if (const auto items = map.find("items")) {
    ellipsoid = read_items(map, *items, units, in_time, load, warnings);
  } else {
    load.wrench = read_mass_or_wrench(map, units);
    ellipsoid = read_ellipsoid(map.at("ellipsoid"), units);
    load.ellipsoid = ellipsoid->matrix;
  }
  if (ellipsoid) warn_of_semi_axes(*ellipsoid, load, units, warnings);
  return load;
}

bool is_around_items(const Field& load) {
  const auto ellipsoid = load.map(kLoadKeys).find("ellipsoid");
  return ellipsoid && says_around_items(*ellipsoid);
}

void read_load_tolerance(const Map& tolerances, const Field& load, const Units& units, TolerancesText& result) {
  const auto mass = tolerances.find("mass");
  const auto wrench = tolerances.find("wrench");
  const Map stated = load.map(kLoadKeys);
  if (stated.find("items")) {
    const auto point = tolerances.find("load_point");
    for (const auto& field : {mass, wrench, point}) {
      if (!field) continue;
      field->complain(
          "got a tolerance of a load that has items, expected it there: 'mass_tolerance' or 'at_tolerance'");
    }
  }
  if (mass && wrench) tolerances.field().complain("got both of 'mass' and 'wrench', expected one of them");
  if (wrench) result.wrench = read_wrench(*wrench, units);
  if (!mass) return;
  const auto gravity = stated.find("gravity");
  if (!gravity) mass->fail("a tolerance of the mass only where 'load' has 'mass' and 'gravity'; else use 'wrench'");
  const Decimal amount = Decimal::parse(read_quantity(*mass, units[Dimension::kMass]));
  if (amount.sign() < 0) mass->fail("a tolerance >= 0");
  const std::vector<Field> acceleration = gravity->list(3, "a list of three accelerations in m/s^2");
  for (std::size_t k = 0; k < 3; ++k) {
    result.wrench[k] = in_field(acceleration[k], [&] { return (amount * read_acceleration(acceleration[k])).text(); });
  }
}

}  // namespace taut::case_fields
