// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/no_path_content.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/json_cursor.h"
#include "certify/path_proof.h"
#include "kinematics/pose_conversion.h"
#include "problem/expression.h"
#include "reports/summary/bodies_statement.h"
#include "reports/summary/summary.h"
#include "reports/summary/wording.h"

namespace taut {
namespace {

using nlohmann::json;

std::size_t start_of(const checker::CheckResult& checked) {
  return checked.certificate->at("waypoints").at(0).get<std::size_t>();
}

/// Start and goal as the path of a plan that was not found, which claims nothing.
ReportContext scene_of(const checker::CheckResult& checked) {
  const json& stated = *checked.certificate;
  const std::size_t from = start_of(checked);
  Certificate certificate;
  certificate.problem = problem_from_json(stated.at("problem"));
  const std::vector<Waypoint> query = query_waypoints(certificate.problem);
  certificate.path.waypoints = {query.at(from), query.at(from + 1)};
  certificate.undecided = OpenPart{"no path", std::nullopt};
  certificate.illustration = stated.at("illustration");
  const JsonCursor generator(stated.at("generator"), "generator");
  const auto text = [&](const char* key) { return generator.contains(key) ? generator.at(key).text() : std::string(); };
  certificate.generator = {text("name"), text("version")};
  certificate.problem_sha256 = stated.at("problem_sha256").get<std::string>();
  certificate.footer_sha256 = stated.at("footer").at("sha256").get<std::string>();
  return {std::move(certificate),
          {Recheck::Result::kNoClaim, fmt::format("taut-check {}", TAUT_VERSION), checked.message, checked.sha256}};
}

/// "phi = -1.8413 rad, theta = 1.3422 rad"
std::string coordinates_text(const NoPathContent& content, std::size_t n) {
  std::string text;
  const std::vector<double>& x = content.scene.certificate.path.waypoints.at(n).parameters().x;
  for (std::size_t j = 0; j < x.size(); ++j) {
    const ShownAxis& axis = content.axes[j];
    text += fmt::format("{}{} = {}", j == 0 ? "" : ", ", axis.name, value_text(axis, axis.per_si * x[j]));
  }
  return text;
}

std::string move_text(const NoPathContent& content) {
  return fmt::format("From waypoint {} of the query, {}, to waypoint {}, {}. Rounded.", content.from,
                     coordinates_text(content, 0), content.from + 1, coordinates_text(content, 1));
}

/// "px = 0 mm, sigma = 0.5934 rad": what of the pose no coordinate changes; empty if nothing is fixed.
std::string fixed_text(const NoPathContent& content) {
  const SpaceText& space = content.scene.certificate.problem.space;
  const DisplayUnits& units = content.scene.illustration.units;
  std::vector<std::string> names;
  for (const Parameter& parameter : space.parameters) names.push_back(parameter.name);
  const ExpressionTape tape({space.pose.begin(), space.pose.end()}, names, space.constants);
  const Pose<double> pose = content.scene.sampler.pose(content.scene.certificate.path.waypoints[0]);
  const std::vector<std::string> all = pose_names(space.angles.kind);
  std::string text;
  for (std::size_t c = 0; c < all.size(); ++c) {
    bool is_fixed = true;
    for (std::size_t j = 0; j < names.size(); ++j) {
      is_fixed = is_fixed && !tape.depends_on(static_cast<int>(c), static_cast<int>(j));
    }
    if (!is_fixed) continue;
    const std::string value =
        c < 3 ? fmt::format("{:.5g} {}", units.length.approx(pose.p_WP(static_cast<Eigen::Index>(c))) + 0.0,
                            units.length.name())
              : units.angle(pose.angles.at(c - 3));
    text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", all[c], value);
  }
  return text;
}

std::string space_text(const NoPathContent& content) {
  std::string text;
  for (std::size_t k = 0; k < content.axes.size(); ++k) {
    const ShownAxis& axis = content.axes[k];
    text += (k == 0 ? "" : "; ") + axis.name;
    switch (content.space.axes[k].kind) {
      case MapAxis::Kind::kTurn: text += ", all of a turn"; break;
      case MapAxis::Kind::kTilt: text += ", every tilt"; break;
      case MapAxis::Kind::kRange:
        text += fmt::format(" from {} to {}, whose ends are walls", value_text(axis, axis.lower),
                            value_text(axis, axis.upper));
    }
  }
  const std::string fixed = fixed_text(content);
  return fmt::format("Free: {}. {}Rounded.", text, fixed.empty() ? "" : "Fixed: " + fixed + ". ");
}

std::string headline_of(const NoPathContent& content) {
  if (!content.is_proved()) {
    return "The certificate was not checked: " + content.checked.message + ". Nothing is claimed.";
  }
  return fmt::format(
      "No motion of the coordinates within their ranges leads from waypoint {} of the query to waypoint {} with every "
      "pose of it feasible. {} without a feasible pose part{} them.",
      content.from, content.from + 1, plural(content.checked.theorem->counts().boxes, "cell"),
      content.checked.theorem->counts().boxes == 1 ? "s" : "");
}

std::vector<Statement> statements_of(const NoPathContent& content) {
  const Problem& problem = content.scene.certificate.problem;
  const DisplayUnits& units = content.scene.illustration.units;
  std::vector<Statement> result = {{"move", "Move", move_text(content)},
                                   {"space", "Space", space_text(content)},
                                   {"limits", "Limits", limits_text(problem.robot, units)}};
  if (problem.bodies) {
    const BodiesStatement bodies = bodies_statement(*problem.bodies);
    std::string text = bodies.checked;
    for (const auto& [name, words] : bodies.bodies) text += fmt::format(" {}: {}.", name, words);
    result.push_back({"clearance", "Clearance", text});
  }
  if (problem.tolerances) {
    result.push_back({"tolerances", "Tolerances",
                      "The machine is taken exactly as stated. So no path is feasible for every machine within the "
                      "tolerances; but some machine within them may have one. " +
                          tolerances_text(problem.tolerances, units)});
  } else {
    result.push_back({"tolerances", "Tolerances", "None. The verdict is about the machine exactly as stated."});
  }
  result.push_back({"recheck", "Re-check", content.scene.recheck.checker + ": " + content.checked.message + "."});
  return result;
}

/// What a verdict on all motions assumes of the machine: nothing about a controller, or how waypoints are stored.
std::vector<ScopeItem> assumed_of(Problem problem) {
  problem.tolerances.reset();
  std::vector<ScopeItem> items = taut::assumed(problem, Interpolation::kStraight);
  std::erase_if(items, [](const ScopeItem& item) {
    const std::string_view key = item.key;
    return key == "control" || key == "waypoints";
  });
  return items;
}

std::vector<ScopeItem> not_covered_of(const Problem& problem) {
  const auto item = [](const char* key, const std::string& brief, const std::string& text) {
    return ScopeItem{key, brief, text, ""};
  };
  std::vector<ScopeItem> result = {
      item("space", "ways outside of this space or these ranges",
           "Ways that change what is fixed here, or leave the ranges: such a way may exist."),
      item("load", "ways for a lighter load or a smaller set of loads",
           "Ways for a lighter load or a smaller set of loads: the verdict is about every load that is stated.")};
  if (problem.tolerances) {
    result.push_back(item("machine", "ways for some machine within the tolerances",
                          "Ways for some machine within the tolerances that differs from the stated numbers."));
  }
  result.push_back(item("dynamics", "swings through poses that can't be held",
                        "Fast motions that pass through poses which the cables can't hold at rest."));
  result.push_back(item("numbers", "whether the stated numbers are those of the machine (or of a reconstruction)",
                        "Whether the stated numbers are those of the machine that is used. Where a case says that its "
                        "geometry is a reconstruction, the verdict is about the reconstruction."));
  return result;
}

}  // namespace

NoPathContent::NoPathContent(const checker::CheckResult& checked_result, const ReportOptions& options)
    : checked(checked_result),
      scene(scene_of(checked_result)),
      from(start_of(checked_result)),
      space(make_map_space(scene.certificate.problem.space)),
      axes(shown_axes(scene.certificate.problem.space, space, scene.illustration.units)),
      fields(scene.illustration.document_fields),
      document(document_of(scene, options)),
      revision(options.revision),
      date(options.date),
      title(title_of(scene)),
      word(is_proved() ? "NO PATH EXISTS" : "UNCHECKED"),
      headline(headline_of(*this)),
      load(load_statement(scene.certificate.problem.load)),
      statements(statements_of(*this)),
      assumed(assumed_of(scene.certificate.problem)),
      not_covered(not_covered_of(scene.certificate.problem)) {}

}  // namespace taut
