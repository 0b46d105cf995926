// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/load_statement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/sanitize.h"
#include "case/case_file.h"
#include "certify/arithmetic/mp_interval.h"
#include "kinematics/model.h"
#include "problem/decimal.h"
#include "problem/rational.h"
#include "reports/summary/numbers.h"
#include "reports/summary/time_statement.h"
#include "reports/summary/wording.h"

namespace taut {
namespace {

constexpr double kStandardGravity = 9.80665;  ///< [m/s²]
constexpr mpfr_prec_t kBits = 256;            // E may be so close to singular that fewer can't tell that it has a root

// --- Numbers and units -------------------------------------------------------------------------------------------

/// The number in a unit of 10^power, with `digits` digits, rounded in the direction unless that changes it by less than
/// rounding errors.
std::string number_text(double x, int power, Rounding rounding, int digits = 4) {
  if (x == 0) return "0";
  const std::string nearest = fmt::format("{:.{}g}", x, digits);
  constexpr double kRounding = 1e-12;
  const bool is_near = std::abs(ScalarTraits<double>::from_decimal(nearest) - x) <= kRounding * std::abs(x);
  const std::string text = is_near                       ? nearest
                           : rounding == Rounding::kDown ? rounded_down(x, digits)
                                                         : rounded_up(x, digits);
  return (Decimal::parse(text) * Decimal::parse(fmt::format("1e{}", -power))).text();
}

/// The number in a unit of 10^power, exactly: a decimal, or a fraction such as 1000/3.
std::string exact_text(const Rational& x, int power) {
  Rational in_unit = x;
  for (int k = 0; k < std::abs(power); ++k) in_unit = power > 0 ? Rational(in_unit / 10) : Rational(in_unit * 10);
  return rational_text(in_unit);
}

/// Whether the exact number is one that people would write down.
bool is_short(const Rational& x) {
  const RationalText exact = rational_text(x);
  constexpr std::size_t kShort = 8;
  return exact.find('/') == std::string::npos && Decimal::parse(exact).text().size() <= kShort;
}

/// Exactly, if that is short, else rounded in the direction to so many digits.
std::string number_text(const Rational& x, int power, Rounding rounding, int digits = 4) {
  if (is_short(x)) return exact_text(x, power);
  const auto nearest = x.convert_to<double>();
  const bool down = rounding == Rounding::kDown;
  for (const std::string& text :
       {fmt::format("{:.{}g}", nearest, digits), down ? rounded_down(nearest, digits) : rounded_up(nearest, digits)}) {
    const Rational value = parse_rational(text);
    if (down ? value <= x : value >= x) return exact_text(value, power);
  }
  return exact_text(x, power);
}

/// A unit of people for a size in SI.
struct PeoplesUnit {
  const char* name;
  int power;  ///< of ten, in SI units
};

PeoplesUnit unit_of_mass(double kg) {
  if (kg >= 1000) return {"t", 3};
  return kg >= 1 ? PeoplesUnit{"kg", 0} : PeoplesUnit{"g", -3};
}
PeoplesUnit unit_of_force(double newtons) { return newtons >= 1000 ? PeoplesUnit{"kN", 3} : PeoplesUnit{"N", 0}; }
PeoplesUnit unit_of_moment(double x) { return x >= 1000 ? PeoplesUnit{"kN·m", 3} : PeoplesUnit{"N·m", 0}; }
PeoplesUnit unit_of_length(double metres) { return metres >= 1 ? PeoplesUnit{"m", 0} : PeoplesUnit{"mm", -3}; }

std::string joined(const std::string& from, const std::string& to, const PeoplesUnit& unit) {
  if (from == to) return fmt::format("{} {}", from, unit.name);
  if (from == "-" + to) return fmt::format("± {} {}", to, unit.name);
  return fmt::format("{} to {} {}", from, to, unit.name);
}

/// "11.76 to 12.24 t", "± 6 kN": no more than the range holds, with as many digits as that takes. "8 t": a single
/// number is exact.
std::string range_text(const Rational& lower, const Rational& upper, const PeoplesUnit& unit) {
  if (lower == upper) return fmt::format("{} {}", exact_text(lower, unit.power), unit.name);
  for (const int digits : {4, 6, 9, 12}) {
    const std::string from = number_text(lower, unit.power, Rounding::kUp, digits);
    const std::string to = number_text(upper, unit.power, Rounding::kDown, digits);
    if (parse_rational(from) < parse_rational(to)) return joined(from, to, unit);
  }
  return joined(exact_text(lower, unit.power), exact_text(upper, unit.power), unit);
}

/// An enclosed range, likewise: to a relative 1e-12. One that is narrower than that is a number.
std::string range_text(const StatedRange& range, const PeoplesUnit& unit) {
  constexpr double kNothing = 1e-12;
  const double size = std::max(std::abs(range.lower), std::abs(range.upper));
  if (range.upper - range.lower <= kNothing * size) {
    return fmt::format("{} {}", number_text(0.5 * (range.lower + range.upper), unit.power, Rounding::kDown), unit.name);
  }
  const auto end = [&](double x, Rounding rounding, int digits) {  // 0 but for the enclosure's width is 0
    return std::abs(x) <= kNothing * size ? "0" : number_text(x, unit.power, rounding, digits);
  };
  std::string from, to;
  for (const int digits : {4, 6, 9, 12}) {
    from = end(range.lower, Rounding::kUp, digits);
    to = end(range.upper, Rounding::kDown, digits);
    if (parse_rational(from) < parse_rational(to)) break;
  }
  return joined(from, to, unit);
}

double approx(const RationalText& text) { return from_rational<double>(text); }

std::string point_text(const RationalVector& point) {
  double size = 0;
  for (const RationalText& x : point) size = std::max(size, std::abs(approx(x)));
  const PeoplesUnit unit = size == 0 ? PeoplesUnit{"m", 0} : unit_of_length(size);
  const auto text = [&](const RationalText& x) { return exact_text(parse_rational(x), unit.power); };
  return fmt::format("({}, {}, {}) {}", text(point[0]), text(point[1]), text(point[2]), unit.name);
}

/// "along x", "along (1, 2, 0)"
std::string direction_text(const RationalVector& direction) {
  constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
  std::array<Rational, 3> e;
  std::transform(direction.begin(), direction.end(), e.begin(),
                 [](const RationalText& x) { return parse_rational(x); });
  for (std::size_t k = 0; k < 3; ++k) {
    if (e[k] != 0 && e[(k + 1) % 3] == 0 && e[(k + 2) % 3] == 0) {
      return fmt::format("along {}{}", e[k] < 0 ? "−" : "", kAxes[k]);
    }
  }
  return fmt::format("along ({:.4g}, {:.4g}, {:.4g})", approx(direction[0]), approx(direction[1]),
                     approx(direction[2]));
}

// --- Items in words ----------------------------------------------------------------------------------------------

/// Whether v is a multiple of what is vertical: of gravity, or of z where there is none.
bool is_vertical(const RationalVector& v, const RationalVector& gravity) {
  const bool has_gravity = std::ranges::any_of(gravity, [](const RationalText& x) { return parse_rational(x) != 0; });
  const RationalVector up = has_gravity ? gravity : RationalVector{"0", "0", "1"};
  std::array<Rational, 3> a, b;
  for (std::size_t k = 0; k < 3; ++k) {
    a[k] = parse_rational(v[k]);
    b[k] = parse_rational(up[k]);
  }
  return a[1] * b[2] == a[2] * b[1] && a[2] * b[0] == a[0] * b[2] && a[0] * b[1] == a[1] * b[0];
}

std::string set_text(const VectorSet& set, Axes axes, const RationalVector& gravity, bool is_force) {
  const auto unit = [&](double size) { return is_force ? unit_of_force(size) : unit_of_moment(size); };
  const char* what = is_force ? "a force" : "a moment";
  const char* frame = axes == Axes::kPlatform ? " of the platform" : "";
  if (const auto* segment = std::get_if<SegmentOfVectors>(&set)) {
    const PeoplesUnit shown = unit(std::max(std::abs(approx(segment->lower)), std::abs(approx(segment->upper))));
    return fmt::format("{} of {} {}{}", what,
                       range_text(parse_rational(segment->lower), parse_rational(segment->upper), shown),
                       direction_text(segment->direction), frame);
  }
  const auto* disc = std::get_if<DiscOfVectors>(&set);
  const RationalText& radius = disc ? disc->radius : std::get<BallOfVectors>(set).radius;
  const PeoplesUnit shown = unit(approx(radius));
  std::string where = "in any direction";
  if (disc) {
    where = axes == Axes::kWorld && is_vertical(disc->normal, gravity)
                ? "in any horizontal direction"
                : fmt::format("in any direction at right angles to the one {}{}", direction_text(disc->normal), frame);
  }
  return fmt::format("{} of up to {} {} {}", what, number_text(parse_rational(radius), shown.power, Rounding::kDown),
                     shown.name, where);
}

std::string weight_text(const Weight& weight) {
  const PeoplesUnit unit = unit_of_mass(approx(weight.mass_upper));
  std::string text = range_text(parse_rational(weight.mass_lower), parse_rational(weight.mass_upper), unit);
  if (parse_rational(weight.at_tolerance) == 0) {
    return text + fmt::format(", centre of gravity at {}", point_text(weight.at));
  }
  const PeoplesUnit length = unit_of_length(approx(weight.at_tolerance));
  return text + fmt::format(", centre of gravity within {} {} of {}",
                            number_text(parse_rational(weight.at_tolerance), length.power, Rounding::kDown),
                            length.name, point_text(weight.at));
}

/// "force (0, 0, -5) kN, moment (0, 0, 1) kN·m": every number exactly.
std::string exact_wrench_text(const std::array<RationalText, 6>& wrench) {
  const auto vector = [&](std::size_t first) -> std::string {
    double size = 0;
    for (std::size_t k = first; k < first + 3; ++k) size = std::max(size, std::abs(approx(wrench[k])));
    if (size == 0) return first == 0 ? "no force" : "no moment";
    const PeoplesUnit unit = first == 0 ? unit_of_force(size) : unit_of_moment(size);
    const auto text = [&](std::size_t k) { return exact_text(parse_rational(wrench[first + k]), unit.power); };
    return fmt::format("{} ({}, {}, {}) {}", first == 0 ? "force" : "moment", text(0), text(1), text(2), unit.name);
  };
  return vector(0) + ", " + vector(3);
}

std::string item_text(const LoadItem& item, const RationalVector& gravity) {
  if (const auto* weight = std::get_if<Weight>(&item.what)) return weight_text(*weight);
  if (const auto* force = std::get_if<Force>(&item.what)) {
    return fmt::format("{}, at {}", set_text(force->set, force->axes, gravity, true), point_text(force->at));
  }
  if (const auto* moment = std::get_if<Moment>(&item.what)) {
    return set_text(moment->set, moment->axes, gravity, false);
  }
  const auto& cases = std::get<LoadCases>(item.what);
  const std::string about = fmt::format("about {}{}", point_text(cases.at),
                                        cases.axes == Axes::kPlatform ? ", in the axes of the platform" : "");
  if (cases.wrenches.size() == 1) return fmt::format("{} {}", exact_wrench_text(cases.wrenches[0]), about);
  std::vector<std::string> each;
  for (const auto& wrench : cases.wrenches) {
    each.push_back(fmt::format("{}: {}", each.size() + 1, exact_wrench_text(wrench)));
  }
  return fmt::format("{} load cases {}, and all between them: {}", cases.wrenches.size(), about, fmt::join(each, "; "));
}

Axes axes_of(const LoadItem& item) {
  if (const auto* force = std::get_if<Force>(&item.what)) return force->axes;
  if (const auto* moment = std::get_if<Moment>(&item.what)) return moment->axes;
  const auto* cases = std::get_if<LoadCases>(&item.what);
  return cases ? cases->axes : Axes::kWorld;
}

// --- The whole ---------------------------------------------------------------------------------------------------

/// All weights together.
struct MassRange {
  Rational lower = 0, upper = 0;
};

/// Sets mass_kg and centre_of_gravity_m, if there are weights.
MassRange add_masses(const LoadText& load, LoadStatement& result) {
  Rational lower = 0, upper = 0, doubled = 0;
  std::array<Rational, 3> moment{};
  bool is_any = false;
  for (const LoadItem& item : load.items) {
    const auto* weight = std::get_if<Weight>(&item.what);
    if (!weight) continue;
    is_any = true;
    lower += parse_rational(weight->mass_lower);
    upper += parse_rational(weight->mass_upper);
    const Rational both = parse_rational(weight->mass_lower) + parse_rational(weight->mass_upper);
    doubled += both;
    for (std::size_t k = 0; k < 3; ++k) moment[k] += both * parse_rational(weight->at[k]);
  }
  if (!is_any) return {};
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  StatedRange mass{lower.convert_to<double>(), upper.convert_to<double>()};
  if (Rational(mass.lower) > lower) mass.lower = std::nextafter(mass.lower, -kInfinity);
  if (Rational(mass.upper) < upper) mass.upper = std::nextafter(mass.upper, kInfinity);
  result.mass_kg = mass;
  if (doubled != 0) {
    std::array<double, 3>& centre = result.centre_of_gravity_m.emplace();
    for (std::size_t k = 0; k < 3; ++k) centre[k] = Rational(moment[k] / doubled).convert_to<double>();
  }
  return {lower, upper};
}

/// Sets nominal and extremes: support functions in the directions of the axes, in multiprecision intervals.
void add_wrenches(const LoadText& load, LoadStatement& result) {
  const PrecisionScope precision(kBits);
  Model<MpInterval> ellipsoid;
  set_ellipsoid(load, ellipsoid);
  const LoadModel<MpInterval> model = make_load_model<MpInterval>(load);
  Matrix3<MpInterval> level;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) level(i, j) = MpInterval(i == j ? 1.0 : 0.0);
  }
  const LoadsAtPose<MpInterval> at = loads_at(model, level);
  for (int k = 0; k < 6; ++k) {
    Vector6<MpInterval> y;
    for (int j = 0; j < 6; ++j) y(j) = MpInterval(j == k ? 1.0 : 0.0);
    const auto n = static_cast<std::size_t>(k);
    const MpInterval nominal = at.nominal(k) + ScalarTraits<MpInterval>::from_decimal(load.wrench[n]);
    DensityRange<MpInterval> range = density_range(model, at, y);
    MpInterval square(0.0);
    for (int j = 0; j < 6; ++j) square = square + sqr(ellipsoid.ellipsoid_root(k, j));
    if (load.ellipsoid) {
      range.below = range.below + sqrt(square);
      range.above = range.above + sqrt(square);
    }
    result.extremes[n] = {lower_bound(MpInterval(nominal - range.below)),
                          upper_bound(MpInterval(nominal + range.above))};
    result.nominal[n] = 0.5 * (lower_bound(nominal) + upper_bound(nominal));
  }
}

/// "a force of 196.2 kN along −z", "no moment"
std::string vector_text(const std::array<double, 6>& wrench, std::size_t first) {
  constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
  const char* what = first == 0 ? "force" : "moment";
  double size = 0;
  for (std::size_t k = 0; k < 3; ++k) size = std::max(size, std::abs(wrench[first + k]));
  if (size == 0) return fmt::format("no {}", what);
  const PeoplesUnit unit = first == 0 ? unit_of_force(size) : unit_of_moment(size);
  const double factor = std::pow(10.0, unit.power);
  std::array<double, 3> v{};
  for (std::size_t k = 0; k < 3; ++k) v[k] = wrench[first + k] / factor;
  for (std::size_t k = 0; k < 3; ++k) {
    if (v[(k + 1) % 3] != 0 || v[(k + 2) % 3] != 0) continue;
    return fmt::format("a {} of {:.6g} {} along {}{}", what, std::abs(v[k]), unit.name, v[k] < 0 ? "−" : "+", kAxes[k]);
  }
  return fmt::format("a {} of ({:.6g}, {:.6g}, {:.6g}) {}", what, v[0] + 0.0, v[1] + 0.0, v[2] + 0.0, unit.name);
}

std::string total_text(const LoadText& load, const MassRange& mass, const LoadStatement& s) {
  const std::string nominal = fmt::format("{} and {} about the load point {}", vector_text(s.nominal, 0),
                                          vector_text(s.nominal, 3), point_text(load.point_m));
  if (!s.mass_kg) {
    const double force = std::hypot(s.nominal[0], s.nominal[1], s.nominal[2]);
    const PeoplesUnit unit = unit_of_mass(force / kStandardGravity);
    const std::string weight = force > 0 && load.items.empty()
                                   ? fmt::format("; that is about the weight of {:.3g} {} under standard gravity",
                                                 force / kStandardGravity / std::pow(10.0, unit.power), unit.name)
                                   : "";
    return fmt::format("Nominally {} of the platform, in the axes of the base{}.", nominal, weight);
  }
  std::string centre;
  if (s.centre_of_gravity_m) {
    const std::array<double, 3>& c = *s.centre_of_gravity_m;
    const double size = std::max({std::abs(c[0]), std::abs(c[1]), std::abs(c[2])});
    const PeoplesUnit unit = size == 0 ? PeoplesUnit{"m", 0} : unit_of_length(size);
    const double factor = std::pow(10.0, unit.power);
    centre = fmt::format(", nominally with the centre of gravity at ({:.4g}, {:.4g}, {:.4g}) {} of the platform",
                         c[0] / factor, c[1] / factor, c[2] / factor, unit.name);
  }
  return fmt::format("In all {}{}: {}.", range_text(mass.lower, mass.upper, unit_of_mass(s.mass_kg->upper)), centre,
                     nominal);
}

std::string spread_text(const LoadStatement& s) {
  constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
  const auto group = [&](std::size_t first) {
    double size = 0;
    for (std::size_t k = first; k < first + 3; ++k) {
      size = std::max({size, std::abs(s.extremes[k].lower), std::abs(s.extremes[k].upper)});
    }
    const PeoplesUnit unit = first == 0 ? unit_of_force(size) : unit_of_moment(size);
    std::string text = first == 0 ? "force" : "moment";
    for (std::size_t k = 0; k < 3; ++k) {
      const StatedRange& range = s.extremes[first + k];
      text += fmt::format("{} {} {}", k == 0 ? "" : ",", kAxes[k], range_text(range, unit));
    }
    return text;
  };
  return fmt::format(
      "Extremes of each component while the platform's axes are parallel to the base's: {}; {}. Not "
      "every combination of them is covered.",
      group(0), group(3));
}

/// The largest distance of each component from w0, which are the semi-axes if E is diagonal.
std::string ellipsoid_text(const LoadStatement& alone, bool is_diagonal) {
  const auto group = [&](std::size_t first, const char* what) {
    std::array<double, 3> s{};
    for (std::size_t k = 0; k < 3; ++k) s[k] = (alone.extremes[first + k].upper - alone.extremes[first + k].lower) / 2;
    const double size = *std::ranges::max_element(s);
    const PeoplesUnit unit = first == 0 ? unit_of_force(size) : unit_of_moment(size);
    const double factor = std::pow(10.0, unit.power);
    const auto text = [&](double x) { return fmt::format("{:.4g}", x / factor); };
    if (text(s[0]) == text(s[1]) && text(s[1]) == text(s[2])) {
      return fmt::format("each component of the {} by up to {} {}", what, text(s[0]), unit.name);
    }
    return fmt::format("the components of the {} by up to ({}, {}, {}) {}", what, text(s[0]), text(s[1]), text(s[2]),
                       unit.name);
  };
  return fmt::format("{}, {}; each alone up to this, together only inside the ellipsoid with these {}",
                     group(0, "force"), group(3, "moment"),
                     is_diagonal ? "semi-axes" : "extents, whose axes are oblique");
}

}  // namespace

std::string quoted_name(const std::string& name) {
  std::string result = "'";
  for (const char c : sanitize(name)) {
    if (c == '\'') {
      result += "’";
    } else {
      result += c;
    }
  }
  return result + "'";
}

std::string brief_load(const LoadText& load) {
  LoadStatement statement;
  const MassRange mass = add_masses(load, statement);
  if (statement.mass_kg) return range_text(mass.lower, mass.upper, unit_of_mass(statement.mass_kg->upper));
  add_wrenches(load, statement);
  const double force = std::hypot(statement.nominal[0], statement.nominal[1], statement.nominal[2]);
  if (!(force > 0)) return "no force";
  const PeoplesUnit unit = unit_of_force(force);
  const double kg = force / kStandardGravity;
  const PeoplesUnit of_mass = unit_of_mass(kg);
  return fmt::format("{:.3g} {} ({:.3g} {})", force / std::pow(10.0, unit.power), unit.name,
                     kg / std::pow(10.0, of_mass.power), of_mass.name);
}

LoadStatement load_statement(const LoadText& load) {
  LoadStatement result;
  const MassRange mass = add_masses(load, result);
  add_wrenches(load, result);
  result.total = total_text(load, mass, result);
  result.spread = spread_text(result);
  for (const LoadItem& item : load.items) result.items.emplace_back(item.name, item_text(item, load.gravity_m_s2));
  if (load.ellipsoid) {
    LoadText without_items = load;
    without_items.items.clear();
    LoadStatement alone;
    add_wrenches(without_items, alone);
    const bool is_around_zero = std::ranges::all_of(alone.nominal, [](double x) { return x == 0; });
    const std::string centre = load.items.empty() ? "the nominal load"
                               : is_around_zero
                                   ? "zero"
                                   : vector_text(alone.nominal, 0) + " and " + vector_text(alone.nominal, 3);
    result.items.emplace_back(
        load.ellipsoid_name.empty() ? "ellipsoid" : load.ellipsoid_name,
        fmt::format("differs from {} in {}", centre, ellipsoid_text(alone, has_diagonal_ellipsoid(load))));
  }
  return result;
}

LoadStatement load_statement(const Problem& problem) {
  LoadStatement result = load_statement(problem.load);
  if (problem.time && result.mass_kg) result.inertia = inertia_text(problem.load);
  return result;
}

LoadStatement load_statement(const Case& the_case) {
  LoadStatement result = load_statement(the_case.problem);
  if (the_case.items_in_ellipsoid) {
    LoadText items = *the_case.items_in_ellipsoid;
    items.point_m = the_case.problem.load.point_m;
    result.around_items = std::make_shared<const LoadStatement>(load_statement(items));
  }
  return result;
}

namespace {

constexpr const char* kInsteadOfItems =
    "In place of these items, the load is one ellipsoid, the smallest that was found to contain every sum of them in "
    "every orientation of the platform. It contains other loads besides, and what is proved or refuted is about all "
    "of it.";

void add_lines(const LoadStatement& statement, bool with_items, std::vector<std::string>& result) {
  if (statement.around_items) {
    add_lines(*statement.around_items, with_items, result);
    result.emplace_back(kInsteadOfItems);
  }
  result.push_back(statement.total);
  result.push_back(statement.spread);
  if (!statement.inertia.empty()) result.push_back(statement.inertia);
  if (!with_items) return;
  for (const auto& [name, words] : statement.items) result.push_back(fmt::format("{}: {}.", quoted_name(name), words));
}

}  // namespace

std::vector<std::string> lines(const LoadStatement& statement) {
  std::vector<std::string> result;
  add_lines(statement, true, result);
  return result;
}

std::vector<std::string> brief_lines(const LoadStatement& statement) {
  std::vector<std::string> result;
  add_lines(statement, false, result);
  return result;
}

nlohmann::json to_json(const LoadStatement& statement) {
  using nlohmann::json;
  const auto pair = [](const StatedRange& range) { return json::array({range.lower, range.upper}); };
  json extremes = json::array();
  for (const StatedRange& range : statement.extremes) extremes.push_back(pair(range));
  json items = json::array();
  for (const auto& [name, words] : statement.items) items.push_back({{"name", name}, {"text", words}});
  return {{"mass_kg", statement.mass_kg ? pair(*statement.mass_kg) : json()},
          {"centre_of_gravity_m", statement.centre_of_gravity_m ? json(*statement.centre_of_gravity_m) : json()},
          {"nominal_wrench", statement.nominal},
          {"extreme_wrenches", std::move(extremes)},
          {"items", std::move(items)},
          {"around_items", statement.around_items ? to_json(*statement.around_items) : json()},
          {"text", lines(statement)}};
}

std::string witness_load_text(const LoadText& load, const nlohmann::json& choices) {
  const auto text = [](const nlohmann::json& x) { return x.get<std::string>(); };
  const auto vector = [&](const nlohmann::json& list, const char* name, double factor) {
    std::array<double, 3> v{};
    for (std::size_t k = 0; k < 3; ++k) v[k] = approx(text(list.at(k))) / factor + 0.0;
    return fmt::format("({:.4g}, {:.4g}, {:.4g}) {}", v[0], v[1], v[2], name);
  };
  const auto largest = [&](const nlohmann::json& list) {
    double size = 0;
    for (const nlohmann::json& x : list) size = std::max(size, std::abs(approx(text(x))));
    return size;
  };
  const auto power = [](const PeoplesUnit& unit) { return std::pow(10.0, unit.power); };
  std::vector<std::string> words;
  for (std::size_t n = 0; n < load.items.size(); ++n) {
    const LoadItem& item = load.items[n];
    const nlohmann::json& choice = choices.at(n);
    const std::string name = quoted_name(item.name);
    const char* const frame = axes_of(item) == Axes::kPlatform ? " in the axes of the platform" : "";
    const bool is_moment = std::holds_alternative<Moment>(item.what);
    const auto unit = [&](double size) { return is_moment ? unit_of_moment(size) : unit_of_force(size); };
    if (choice.contains("mass_kg")) {
      const double mass = approx(text(choice.at("mass_kg")));
      const PeoplesUnit of_mass = unit_of_mass(mass);
      std::string weight = fmt::format("{} {:.4g} {}", name, mass / power(of_mass), of_mass.name);
      if (const double off = largest(choice.at("offset_m")); off > 0) {
        const PeoplesUnit length = unit_of_length(off);
        weight += ", its centre of gravity off by " + vector(choice.at("offset_m"), length.name, power(length));
      }
      words.push_back(std::move(weight));
    } else if (choice.contains("vector")) {
      const PeoplesUnit shown = unit(largest(choice.at("vector")));
      words.push_back(fmt::format("{} {}{}", name, vector(choice.at("vector"), shown.name, power(shown)), frame));
    } else if (choice.contains("amount")) {
      const double amount = approx(text(choice.at("amount")));
      const PeoplesUnit shown = unit(std::abs(amount));
      words.push_back(fmt::format("{} {:.4g} {}", name, amount / power(shown) + 0.0, shown.name));
    } else {
      words.push_back(fmt::format("{} case {}", name, choice.at("case").get<std::size_t>() + 1));
    }
  }
  if (load.ellipsoid) words.emplace_back("and of the ellipsoid the wrench that is worst for this cable");
  return fmt::format("{}", fmt::join(words, "; "));
}

std::string load_text(const LoadText& load) { return fmt::format("{}", fmt::join(lines(load_statement(load)), " ")); }

}  // namespace taut
