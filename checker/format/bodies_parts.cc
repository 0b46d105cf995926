// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "checker/format/expression_parser.h"
#include "checker/format/parts.h"

namespace taut::checker {
namespace {

constexpr std::size_t kMaxBodies = 64;        ///< of the platform, and as many obstacles
constexpr std::size_t kMaxHullPoints = 1000;  ///< bounds the work of a box, as kMaxBodies does
constexpr std::size_t kMaxBodyName = 120;     ///< characters
constexpr std::size_t kMaxContacts = 64;
constexpr std::size_t kMaxDirections = 10'000'000;
constexpr int kMaxComponent = 32767;   ///< of a direction
constexpr std::size_t kMaxList = 256;  ///< directions of a pair with a mesh

/// "cable 3" of i = 2.
std::string cable_name(std::size_t i) { return "cable " + std::to_string(i + 1); }

void require_not_negative(const Cursor& json, const mpq_class& x) { json.require(x >= 0, "a decimal >= 0"); }

/// Reads a decimal >= 0.
auto not_negative(mpq_class& x) {
  return [&x](const Cursor& json) {
    read(json, x);
    require_not_negative(json, x);
  };
}

void read_name(const Cursor& json, std::string& name, const std::vector<std::string>& others) {
  read(json, name);
  const auto is_character = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };  // begins one
  const auto length = static_cast<std::size_t>(std::ranges::count_if(name, is_character));
  json.require(length > 0 && length <= kMaxBodyName, "1 to 120 characters");
  json.require(std::ranges::find(others, name) == others.end(), "a name that neither a cable nor another body has");
}

void read_hull(const Cursor& json, RigidBody& body) {
  HullShape hull;
  const auto read_points = [&](const Cursor& points) {
    points.require(points.size() > 0 && points.size() <= kMaxHullPoints, "1 to 1000 points");
    read(points, hull.points);
  };
  json.object("points_m", read_points, "radius_m", not_negative(hull.radius));
  body.shape = std::move(hull);
}

void read_half_space(const Cursor& json, RigidBody& body) {
  HalfSpaceShape half_space;
  json.object("normal", half_space.normal);
  const bool is_zero = std::ranges::all_of(half_space.normal, [](const mpq_class& x) { return x == 0; });
  json["normal"].require(!is_zero, "a vector that is not 0");
  body.shape = std::move(half_space);
}

void read_mesh(const Cursor& json, RigidBody& body) {
  constexpr std::size_t kMaxName = 1000;  // bytes
  MeshShape mesh;
  const auto is_hex = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  json.object("file", mesh.file, "sha256", mesh.sha256, "unit_m", mesh.unit);
  json["sha256"].require(mesh.sha256.size() == 64 && std::ranges::all_of(mesh.sha256, is_hex), "64 hex digits");
  json["file"].require(!mesh.file.empty() && mesh.file.size() <= kMaxName, "a name of 1 to 1000 bytes");
  json["unit_m"].require(mesh.unit > 0, "a decimal > 0");
  body.shape = std::move(mesh);
}

/// What is said of a body beside what it is.
struct BodyLabel {
  std::string name;
  std::optional<mpq_class> clearance;
};

/// @param names  that are taken
void read_body(const Cursor& json, bool is_obstacle, const std::vector<std::string>& names, RigidBody& body,
               BodyLabel& label) {
  const auto read_rotation = [&](const Cursor& rotation) {
    json.require(!json.has("half_space"), "no key 'rotation_rad' of a half-space");
    rotation.require_size(3);
    rotation.elements(
        [&](const Cursor& here, std::size_t k) { body.rotation[k] = parse_expression(here.text(), {}, here.where()); });
  };
  for (Expression& angle : body.rotation) angle = parse_expression("0", {}, json.where());
  json.object(
      "name", [&](const Cursor& name) { read_name(name, label.name, names); }, "at_m", body.at, "clearance_m?",
      [&](const Cursor& clearance) { not_negative(label.clearance.emplace())(clearance); }, "rotation_rad?",
      read_rotation, "hull?", [&](const Cursor& hull) { read_hull(hull, body); }, "half_space?",
      [&](const Cursor& half_space) {
        half_space.require(is_obstacle, "no half-space but as an obstacle");
        read_half_space(half_space, body);
      },
      "mesh?", [&](const Cursor& mesh) { read_mesh(mesh, body); });
  json.require(json.has("hull") + json.has("half_space") + json.has("mesh") == 1,
               "exactly one of the keys 'hull', 'half_space' and 'mesh'");
}

void read_cables(const Cursor& json, std::array<CableBody, kCables>& cables) {
  const auto read_diameters = [&](const Cursor& diameters) {
    diameters.require_size(kCables);
    diameters.elements([&](const Cursor& here, std::size_t i) { not_negative(cables[i].diameter)(here); });
  };
  const auto read_free_ends = [&](const Cursor& free_ends) {
    free_ends.require_size(kCables);
    free_ends.elements([&](const Cursor& ends, std::size_t i) {
      ends.require_size(2);
      ends.elements([&](const Cursor& here, std::size_t k) { not_negative(cables[i].free_ends[k])(here); });
    });
  };
  json.object("diameter_m", read_diameters, "free_ends_m", read_free_ends);
}

class BodiesReader {
 public:
  explicit BodiesReader(Bodies& into) : bodies_(into) {
    for (std::size_t i = 0; i < kCables; ++i) names_.push_back(cable_name(i));
  }

  void read(const Cursor& json) {
    const auto list = [this](bool is_obstacle, std::vector<RigidBody>& bodies, std::vector<BodyLabel>& labels) {
      return [this, is_obstacle, &bodies, &labels](const Cursor& list_json) {
        list_json.require(list_json.size() <= kMaxBodies, "at most 64 bodies");
        list_json.elements([&](const Cursor& here, std::size_t) {
          read_body(here, is_obstacle, names_, bodies.emplace_back(), labels.emplace_back());
          names_.push_back(labels.back().name);
        });
      };
    };
    const auto read_classes = [&](const Cursor& classes) {
      const auto into = [&](std::size_t k) {
        return [this, k](const Cursor& here) {
          not_negative(classes_[k].emplace())(here);
          bodies_.checks[k] = true;
        };
      };
      classes.object("platform-obstacles?", into(0), "cables-obstacles?", into(1), "cables-cables?", into(2),
                     "cables-platform?", into(3));
    };
    json.object(
        "platform", list(false, bodies_.platform, platform_), "obstacles", list(true, bodies_.obstacles, obstacles_),
        "cables", [&](const Cursor& cables) { read_cables(cables, bodies_.cables); }, "clearance_m", read_classes,
        "pair_clearances_m?", [&](const Cursor& pairs) { read_pair_clearances(pairs); }, "contacts?",
        [&](const Cursor& contacts) { read_contacts(contacts); }, "exit_cones?",
        [&](const Cursor& cones) { read_exit_cones(cones); });
    make_pairs();
    const auto require_used = [&](const char* key, const auto& stated, const char* expected) {
      if (stated.empty()) return;
      const Cursor entries = json[key];
      for (std::size_t k = 0; k < stated.size(); ++k) entries.at(k).require(stated[k].is_used, expected);
    };
    require_used("pair_clearances_m", own_, "two bodies that are a checked pair");
    require_used("contacts", contacts_, "a body of the platform and an obstacle, no meshes, that are a checked pair");
  }

 private:
  struct OwnClearance {
    std::array<std::string, 2> names;  ///< in order
    mpq_class clearance;
    bool is_used = false;
  };

  void read_pair_clearances(const Cursor& json) {
    json.require(json.size() > 0, "pairs, or no such key");
    json.elements([&](const Cursor& here, std::size_t) {
      OwnClearance own;
      here.object("pair", own.names, "clearance_m", not_negative(own.clearance));
      std::ranges::sort(own.names);
      const bool is_taken = std::ranges::find(own_, own.names, &OwnClearance::names) != own_.end();
      here["pair"].require(!is_taken, "a pair that is not stated before");
      own_.push_back(std::move(own));
    });
  }

  struct Contact {
    std::array<std::string, 2> names;  ///< in order
    ContactZone zone;
    bool is_used = false;
  };

  void read_contacts(const Cursor& json) {
    json.require(json.size() > 0 && json.size() <= kMaxContacts, "1 to 64 contacts, or no such key");
    const auto positive = [](mpq_class& x) {
      return [&x](const Cursor& here) {
        taut::checker::read(here, x);
        here.require(x > 0, "a decimal > 0");
      };
    };
    json.elements([&](const Cursor& here, std::size_t) {
      Contact contact;
      here.object("pair", contact.names, "at_m", contact.zone.at, "within_m", positive(contact.zone.within), "depth_m",
                  positive(contact.zone.depth));
      std::ranges::sort(contact.names);
      contacts_.push_back(std::move(contact));
    });
  }

  void read_exit_cones(const Cursor& json) {
    static constexpr std::array<std::pair<const char*, Axes>, 2> kEnds = {
        {{"base", Axes::kWorld}, {"platform", Axes::kPlatform}}};
    json.require(json.size() > 0, "exit cones, or no such key");
    json.elements([&](const Cursor& here, std::size_t) {
      ExitCone cone;
      here.object(
          "cable", integer(cone.cable, 1, kCables), "end",
          [&](const Cursor& end) { cone.end = end.one_of<Axes>(kEnds, "base or platform"); }, "axis", cone.axis,
          "half_angle_rad",
          [&](const Cursor& angle) { cone.half_angle = parse_expression(angle.text(), {}, angle.where()); });
      --cone.cable;
      const bool is_zero = std::ranges::all_of(cone.axis, [](const mpq_class& x) { return x == 0; });
      here["axis"].require(!is_zero, "a vector that is not 0");
      const bool is_taken = std::ranges::any_of(bodies_.exit_cones, [&](const ExitCone& other) {
        return other.cable == cone.cable && other.end == cone.end;
      });
      here.require(!is_taken, "one exit cone of a cable's end");
      bodies_.exit_cones.push_back(std::move(cone));
    });
  }

  /// Class by class, the first body in the outer loop.
  void make_pairs() {
    static const BodyLabel kNone;
    std::vector<BodyLabel> cables;
    for (std::size_t i = 0; i < kCables; ++i) cables.push_back({cable_name(i), std::nullopt});
    const auto add_all = [&](PairKind kind, const std::vector<BodyLabel>& first, const std::vector<BodyLabel>& second) {
      for (std::size_t i = 0; i < first.size(); ++i) {
        for (std::size_t j = kind == PairKind::kCableCable ? i + 1 : 0; j < second.size(); ++j) {
          add(kind, i, first[i], j, second[j]);
        }
      }
    };
    add_all(PairKind::kPlatformObstacle, platform_, obstacles_);
    add_all(PairKind::kCableObstacle, cables, obstacles_);
    add_all(PairKind::kCableCable, cables, cables);
    add_all(PairKind::kCablePlatform, cables, platform_);
    for (std::size_t k = 0; k < bodies_.exit_cones.size(); ++k) {
      const ExitCone& cone = bodies_.exit_cones[k];
      bodies_.pairs.push_back(
          {PairKind::kExitCone, cone.cable, k, 0,
           cable_name(cone.cable) + " / exit cone at the " + (cone.end == Axes::kWorld ? "base" : "platform")});
    }
  }

  void add(PairKind kind, std::size_t i, const BodyLabel& first, std::size_t j, const BodyLabel& second) {
    const std::optional<mpq_class>& of_class = classes_[static_cast<std::size_t>(kind)];
    if (!of_class) return;
    mpq_class clearance = *of_class;
    if (first.clearance || second.clearance) {
      clearance = std::max(first.clearance.value_or(mpq_class(0)), second.clearance.value_or(mpq_class(0)));
    }
    std::array<std::string, 2> names = {first.name, second.name};
    std::ranges::sort(names);
    const auto own = std::ranges::find(own_, names, &OwnClearance::names);
    if (own != own_.end()) {
      own->is_used = true;
      clearance = own->clearance;
    }
    CheckedPair pair{kind, i, j, clearance, first.name + " / " + second.name};
    for (Contact& contact : contacts_) {
      if (contact.names != names || kind != PairKind::kPlatformObstacle || bodies_.has_mesh(pair)) continue;
      contact.is_used = true;
      pair.zones.push_back(contact.zone);
    }
    bodies_.pairs.push_back(std::move(pair));
  }

  Bodies& bodies_;
  std::vector<std::string> names_;  ///< that are taken
  std::vector<BodyLabel> platform_, obstacles_;
  std::array<std::optional<mpq_class>, 4> classes_;  ///< by PairKind
  std::vector<OwnClearance> own_;
  std::vector<Contact> contacts_;
};

std::size_t points_of(const RigidBody& body) {
  if (std::holds_alternative<MeshShape>(body.shape)) return 3;
  const auto* const hull = std::get_if<HullShape>(&body.shape);
  return hull == nullptr ? 0 : hull->points.size();
}

/// How many weights name a point of either body.
std::array<std::size_t, 2> weights_of(const Bodies& bodies, const CheckedPair& pair) {
  switch (pair.kind) {
    case PairKind::kPlatformObstacle:
      return {points_of(bodies.platform[pair.first]), points_of(bodies.obstacles[pair.second])};
    case PairKind::kCableObstacle: return {2, points_of(bodies.obstacles[pair.second])};
    case PairKind::kCableCable: return {2, 2};
    case PairKind::kCablePlatform: return {2, points_of(bodies.platform[pair.second])};
    case PairKind::kExitCone: return {0, 0};
  }
  throw std::logic_error("a pair of no known kind");
}

}  // namespace

void read(const Cursor& json, Bodies& bodies) { BodiesReader(bodies).read(json); }

void append_direction(const Cursor& json, Path& path) {
  static constexpr std::array<std::pair<const char*, Axes>, 2> kAxes = {{{"W", Axes::kWorld}, {"P", Axes::kPlatform}}};
  json.require(path.directions.size() < kMaxDirections, "at most 10000000 directions");
  json.require_size(4);
  Direction direction;
  direction.axes = json.at(0).one_of<Axes>(kAxes, "W or P");
  for (std::size_t c = 0; c < 3; ++c) {
    direction.u[c] = static_cast<int>(json.at(c + 1).integer(-kMaxComponent, kMaxComponent));
  }
  json.require(direction.u != std::array<int, 3>{}, "a vector that is not 0");
  path.directions.push_back(direction);
}

std::vector<std::size_t> read_apart(const Cursor& json, std::size_t pair, const Problem& problem, const Path& path) {
  const Bodies& bodies = problem.bodies.value();
  const CheckedPair& of = bodies.pairs.at(pair);
  const bool is_cone = of.kind == PairKind::kExitCone;
  if (is_cone || bodies.is_against_half_space(of)) {
    json.require(json.is_null(), is_cone ? "null of an exit cone" : "null, as one body is a half-space");
    return {};
  }
  std::vector<std::size_t> result;
  const bool has_mesh = bodies.has_mesh(of);
  const auto add = [&](const Cursor& here) {
    const auto index = static_cast<std::size_t>(here.integer(0, static_cast<std::int64_t>(path.directions.size()) - 1));
    const Axes axes = path.directions[index].axes;
    const bool may_be_either = of.kind == PairKind::kCableCable || of.kind == PairKind::kPlatformObstacle;
    if (!may_be_either || has_mesh) {
      const bool is_of_platform = of.kind == PairKind::kCablePlatform;
      here.require(axes == (is_of_platform ? Axes::kPlatform : Axes::kWorld),
                   is_of_platform ? "a direction in the axes of P" : "a direction in the axes of W");
    }
    result.push_back(index);
  };
  if (!json.json().is_array()) {
    add(json);
    return result;
  }
  json.require(has_mesh, "one index, as neither body is a mesh");
  json.require(json.size() >= 2 && json.size() <= kMaxList, "one index, or a list of 2 to 256");
  json.elements([&](const Cursor& here, std::size_t) { add(here); });
  return result;
}

std::size_t read_contact_inside(const Cursor& json, std::size_t pair, const Problem& problem) {
  static constexpr std::array<std::pair<const char*, std::size_t>, 2> kSides = {{{"first", 0}, {"second", 1}}};
  const std::size_t solid = json.one_of<std::size_t>(kSides, "first or second");
  const Bodies& bodies = problem.bodies.value();
  const CheckedPair& of = bodies.pairs.at(pair);
  json.require(bodies.mesh(of, solid == 0) != nullptr, "a body that is a mesh");
  json.require(!bodies.is_against_half_space(of), "no half-space");
  return solid;
}

ContactElements read_contact_elements(const Cursor& json, std::size_t pair, const std::optional<std::size_t>& inside,
                                      const Problem& problem) {
  const Bodies& bodies = problem.bodies.value();
  ContactElements result;
  json.require_size(2);
  json.elements([&](const Cursor& here, std::size_t side) {
    const bool is_mesh = side != inside && bodies.mesh(bodies.pairs.at(pair), side == 0) != nullptr;
    here.require(is_mesh != here.is_null(),
                 is_mesh ? "the index of an element" : "null, as this body is no mesh or has the other's point inside");
    if (is_mesh) result[side] = static_cast<std::size_t>(here.integer(0, std::int64_t{1} << 32U));
  });
  return result;
}

ContactWeights read_contact_weights(const Cursor& json, std::size_t pair, const std::optional<std::size_t>& inside,
                                    const Problem& problem) {
  const Bodies& bodies = problem.bodies.value();
  std::array<std::size_t, 2> sizes = weights_of(bodies, bodies.pairs.at(pair));
  if (inside) sizes.at(*inside) = 0;
  ContactWeights result;
  json.require_size(2);
  json.elements([&](const Cursor& here, std::size_t side) {
    result[side].resize(sizes[side]);
    rational(result[side])(here);
    mpq_class sum = 0;
    here.elements([&](const Cursor& weight, std::size_t k) {
      weight.require(result[side][k] >= 0, "a weight >= 0");
      sum += result[side][k];
    });
    here.require(sizes[side] == 0 || sum == 1, "weights whose sum is 1");
  });
  return result;
}

}  // namespace taut::checker
