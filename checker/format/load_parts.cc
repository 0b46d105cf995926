// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "checker/format/parts.h"

namespace taut::checker {
namespace {

constexpr std::size_t kMaxItems = 64;  ///< of a load, and load cases of an item: bounds the work of a box
constexpr std::size_t kMaxNameLength = 100;

auto read_into(Axes& axes) {
  static constexpr std::array<std::pair<const char*, Axes>, 2> kAxes = {{{"W", Axes::kWorld}, {"P", Axes::kPlatform}}};
  return [&axes](const Cursor& json) { axes = json.one_of<Axes>(kAxes, "W or P"); };
}

void require_not_zero(const Cursor& json, const ExactVector& x) {
  json.require(std::ranges::any_of(x, [](const mpq_class& c) { return c != 0; }), "a vector that is not 0");
}

/// Reads two ends, which may be equal.
auto ordered(Limits& limits) {
  return [&limits](const Cursor& json) {
    std::array<mpq_class, 2> ends;
    rational(ends)(json);
    json.require(ends[0] <= ends[1], "ends in order");
    limits = {ends[0], ends[1]};
  };
}

void read_radius(const Cursor& json, mpq_class& radius) {
  rational(radius)(json);
  json.require(radius >= 0, "a radius >= 0");
}

/// A force acts at a point, which is a key of its own; a moment acts at none.
void read_vectors(const Cursor& json, bool is_moment, LoadItem& item) {
  const auto read_ball = [&](const Cursor& here) {
    BallOrDisc ball{is_moment, {}, {}};
    here.object("radius", [&](const Cursor& radius) { read_radius(radius, ball.radius); });
    item.set = ball;
  };
  const auto read_disc = [&](const Cursor& here) {
    BallOrDisc disc{is_moment, {}, ExactVector()};
    here.object("normal", rational(*disc.normal), "radius",
                [&](const Cursor& radius) { read_radius(radius, disc.radius); });
    require_not_zero(here["normal"], *disc.normal);
    item.set = disc;
  };
  const auto read_line_segment = [&](const Cursor& here) {
    LineSegment segment{is_moment, {}, {}};
    here.object("direction", rational(segment.direction), "range", ordered(segment.range));
    require_not_zero(here["direction"], segment.direction);
    item.set = segment;
  };
  json.object(is_moment ? nullptr : "at_m", rational(item.at), "axes", read_into(item.axes), "ball?", read_ball,
              "disc?", read_disc, "segment?", read_line_segment);
  json.require(json.has("ball") + json.has("disc") + json.has("segment") == 1,
               "exactly one of the keys 'ball', 'disc' and 'segment'");
}

void require_name(const Cursor& json, const std::string& name) {
  const auto is_character = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };  // begins one
  const auto length = static_cast<std::size_t>(std::ranges::count_if(name, is_character));
  json.require(length > 0 && length <= kMaxNameLength, "1 to 100 characters");
}

void read_item(const Cursor& json, LoadItem& item, std::string& name) {
  const auto read_weight = [&](const Cursor& here) {
    Weight weight;
    const auto read_box = [&](const Cursor& box) {
      ExactVector& sides = weight.inertia_box.emplace();
      rational(sides)(box);
      for (std::size_t k = 0; k < sides.size(); ++k) box.at(k).require(sides[k] > 0, "a side > 0");
    };
    here.object("at_m", rational(item.at), "at_tolerance_m", rational(weight.offset), "inertia_box_m?", read_box,
                "mass_kg", ordered(weight.mass));
    here["at_tolerance_m"].require(weight.offset >= 0, "a tolerance >= 0");
    here["mass_kg"].require(weight.mass.lower >= 0, "a mass >= 0");
    item.set = weight;
  };
  const auto read_force = [&](const Cursor& here) { read_vectors(here, false, item); };
  const auto read_moment = [&](const Cursor& here) { read_vectors(here, true, item); };
  const auto read_cases = [&](const Cursor& here) {
    LoadCases cases;
    const auto read_wrenches = [&](const Cursor& wrenches) {
      wrenches.require(wrenches.size() > 0 && wrenches.size() <= kMaxItems, "1 to 64 load cases");
      cases.wrenches.resize(wrenches.size());
      rational(cases.wrenches)(wrenches);
    };
    here.object("at_m", rational(item.at), "axes", read_into(item.axes), "wrenches", read_wrenches);
    item.set = cases;
  };
  json.object("force?", read_force, "load_cases?", read_cases, "moment?", read_moment, "name", name, "weight?",
              read_weight);
  json.require(json.has("force") + json.has("load_cases") + json.has("moment") + json.has("weight") == 1,
               "exactly one of the keys 'weight', 'force', 'moment' and 'load_cases'");
  require_name(json["name"], name);
}

}  // namespace

void read_load(const Cursor& json, Problem& problem) {
  const bool has_items = json.has("items");
  const bool has_ellipsoid = !has_items || json.has("ellipsoid") || json.has("wrench");
  std::vector<std::string> names;
  const auto read_items = [&](const Cursor& items) {
    items.require(items.size() > 0 && items.size() <= kMaxItems, "1 to 64 items");
    names.resize(items.size());
    problem.items.resize(items.size());
    items.elements([&](const Cursor& here, std::size_t i) {
      read_item(here, problem.items[i], names[i]);
      const auto before = names.begin() + static_cast<std::ptrdiff_t>(i);
      here["name"].require(std::find(names.begin(), before, names[i]) == before, "a name that no other item has");
    });
  };
  const auto read_ellipsoid = [&](const Cursor& here) {
    std::array<ExactWrench, 6>& E = problem.ellipsoid.emplace();
    rational(E)(here);
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < i; ++j) here.require(E[i][j] == E[j][i], "a symmetric matrix");
    }
  };
  const auto read_name = [&](const Cursor& here) {
    require_name(here, here.text());
    here.require(std::ranges::find(names, here.text()) == names.end(), "a name that no item has");
  };
  json.object("point_m", problem.load_point, has_items ? "gravity_m_s2" : nullptr, rational(problem.gravity),
              has_items ? "items" : nullptr, read_items, has_ellipsoid ? "ellipsoid" : nullptr, read_ellipsoid,
              has_ellipsoid ? "ellipsoid_name?" : nullptr, read_name, has_ellipsoid ? "wrench" : nullptr,
              problem.wrench);
}

void require_no_inertia_box(const Cursor& json) {
  if (!json.has("items")) return;
  const Cursor items = json["items"];
  items.elements([](const Cursor& item, std::size_t) {
    if (!item.has("weight")) return;
    const Cursor weight = item["weight"];
    weight.require(!weight.has("inertia_box_m"), "no key 'inertia_box_m' in a problem without limits in time");
  });
}

void require_no_tolerance_of_load(const Cursor& tolerances, const ToleranceBounds& bounds) {
  constexpr const char* kExpected = "no tolerance of the load beside items";
  tolerances["load_point_m"].require(bounds.load_point == 0, kExpected);
  for (std::size_t i = 0; i < 6; ++i) tolerances["wrench"].require(bounds.wrench[i] == 0, kExpected);
}

std::vector<LoadChoice> read_loads(const Cursor& json, const std::vector<LoadItem>& items) {
  std::vector<LoadChoice> result;
  json.require_size(items.size());
  json.elements([&](const Cursor& here, std::size_t i) {
    LoadChoice& choice = result.emplace_back();
    const auto of_weight = [&](const Weight& /*set*/) {
      WeightChoice& x = choice.emplace<WeightChoice>();
      here.object("mass_kg", rational(x.mass), "offset_m", rational(x.offset));
    };
    const auto of_ball_or_disc = [&](const BallOrDisc& /*set*/) {
      here.object("vector", rational(choice.emplace<VectorChoice>().vector));
    };
    const auto of_line_segment = [&](const LineSegment& /*set*/) {
      here.object("amount", rational(choice.emplace<AmountChoice>().amount));
    };
    const auto of_cases = [&](const LoadCases& set) {
      const auto last = static_cast<std::int64_t>(set.wrenches.size()) - 1;
      here.object("case", integer(choice.emplace<CaseChoice>().index, 0, last));
    };
    std::visit(Overloaded{of_weight, of_ball_or_disc, of_line_segment, of_cases}, items[i].set);
  });
  return result;
}

}  // namespace taut::checker
