// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/appendix.h"

#include <algorithm>

#include "certify/undecided.h"
#include "problem/rational.h"
#include "reports/page/table_sizes.h"
#include "reports/summary/wording.h"

namespace taut {
namespace {

Html ellipsoid_table(const LoadText& load, const DisplayUnits& units) {
  constexpr std::array<const char*, 6> kNames = {"force x", "force y", "force z", "moment x", "moment y", "moment z"};
  std::vector<Column> columns = {{html("Component")}, {html("w<sub>0</sub>"), true}};
  for (int j = 1; j <= 6; ++j) columns.push_back({html("E<sub>i{}</sub>", j), true});
  std::vector<std::vector<Html>> rows;
  for (std::size_t i = 0; i < 6; ++i) {
    std::vector<Html> row = {html("{} [{}]", kNames[i], i < 3 ? "N" : "N·m"), html("{}", plain(load.wrench[i]))};
    for (std::size_t j = 0; j < 6; ++j)
      row.push_back(html("{}", rational_text(parse_rational((*load.ellipsoid)[i][j]))));
    rows.push_back(std::move(row));
  }
  return html(
             "<p>Load point p<sub>m</sub> = {} {} in the platform frame. Wrenches are about that point, in the axes of "
             "the world. E in 1/N², 1/(N·N·m) and 1/(N·m)².</p>\n",
             triple(load.point_m, units.length), units.length.name()) +
         table(html("Centre load w<sub>0</sub> and matrix E of the set of loads, exact"), columns, rows);
}

Html space_tables(const Problem& problem) {
  const SpaceText& space = problem.space;
  std::vector<std::vector<Html>> rows;
  for (std::size_t j = 0; j < space.parameters.size(); ++j) {
    const Parameter& parameter = space.parameters[j];
    Html range = html("any real number");
    if (parameter.kind == ParameterKind::kPeriodic) range = html("an angle; values 2π apart are the same");
    if (parameter.kind == ParameterKind::kRange) {
      range = html("<code>{}</code> to <code>{}</code>", parameter.range_lower, parameter.range_upper);
    }
    Html typed;
    for (const auto& waypoint : problem.query) {
      typed += html("{}<code>{}</code>", typed.empty() ? Html() : html(", "), j < waypoint.size() ? waypoint[j] : "");
    }
    rows.push_back({html("<code>{}</code>", parameter.name), html("{}", unit(space, j)), range, typed});
  }
  std::vector<std::vector<Html>> pose;
  const std::vector<std::string> names = pose_names(space.angles.kind);
  for (std::size_t c = 0; c < names.size(); ++c) {
    pose.push_back(
        {html("<code>{}</code>", names[c]), html("<code>{}</code>", space.pose[c]), html("{}", c < 3 ? "m" : "rad")});
  }
  Html constants;
  for (const auto& [name, value] : space.constants) constants += html("<li><code>{} = {}</code></li>\n", name, value);
  Html result =
      html("<p>Angles: {}.</p>\n", rotation_formula(space.angles)) +
      table(html("Parameters of the poses"),
            {{html("Parameter")}, {html("Unit")}, {html("Values")}, {html("Waypoints asked for")}}, rows) +
      table(html("Pose as a function of the parameters"), {{html("Pose")}, {html("Expression")}, {html("Unit")}}, pose);
  if (!constants.empty()) result += html("<p>Constants, as the expressions use them:</p><ul>{}</ul>\n", constants);
  Html constraints;
  for (const ExpressionText& c : space.constraints) constraints += html("<li><code>{} = 0</code></li>\n", c);
  if (!constraints.empty()) {
    result +=
        html("<p>Constraints, which every pose of the path fulfils exactly (m, rad):</p><ul>{}</ul>\n", constraints);
  }
  if (space.flip) result += html("<p>(φ, θ) and (φ + π, −θ) are the same pose, and count as such.</p>\n");
  return result;
}

/// What a row of the path's tables is.
const char* waypoint_name(const Path& path) {
  return path.interpolation == Interpolation::kCubicBSpline ? "Control point" : "Waypoint";
}

/// Exact parameters of every `step`th waypoint and of the last, in tables that are no wider than a column on paper.
Html exact_waypoints(const ReportContext& scene, std::size_t step) {
  constexpr std::size_t kSideBySide = 3;  // numbers of seventeen digits
  const Path& path = scene.certificate.path;
  const auto named = coordinates(scene.certificate);
  Html tables;
  for (std::size_t first = 0; first < named.size();) {
    // Groups of columns that belong together: px py pz, qx qy qz qw, L1 L2 L3, L4 L5 L6; or three parameters each.
    const bool is_quaternion = has_poses(path.interpolation) && first == 3;
    const std::size_t end = std::min(named.size(), first + (is_quaternion ? 4 : kSideBySide));
    std::vector<Column> columns = {{html("{}", waypoint_name(path)), true}};
    Html names;
    for (std::size_t j = first; j < end; ++j) {
      columns.push_back({html("<code>{}</code> {}", named[j].first, in_brackets(named[j].second)), true});
      names += html("{}{}", names.empty() ? "" : ", ", named[j].first);
    }
    std::vector<std::vector<Html>> rows;
    const std::size_t last = path.waypoints.size() - 1;
    for (std::size_t k = 0; k <= last; k = k < last ? std::min(k + step, last) : last + 1) {
      const std::vector<std::string> texts = coordinate_texts(path.waypoints[k]);
      rows.push_back({html("{}", k)});
      for (std::size_t j = first; j < end; ++j) rows.back().push_back(html("{}", texts[j]));
    }
    tables += table(html("{}s, exact: {}", waypoint_name(path), names), columns, rows);
    first = end;
  }
  return tables;
}

/// With these arguments Python writes canonical JSON, because a certificate has no fractional numbers.
constexpr const char* kDigestCommand = R"(python3 -c '
import json, hashlib
c = json.load(open("certificate.json")); c.pop("footer"); c.pop("signature", None)
for v in (c["problem"], c["path"], c):
    text = json.dumps(v, sort_keys=True, separators=(",", ":"))
    print(hashlib.sha256(text.encode()).hexdigest())
')";

/// "taut 0.1.0"
std::string text(const Generator& generator) {
  const bool has_both = !generator.name.empty() && !generator.version.empty();
  return generator.name + (has_both ? " " : "") + generator.version;
}

}  // namespace

Html exact_load(const ReportContext& scene) {
  const LoadText& load = scene.certificate.problem.load;
  if (!load.ellipsoid) return {};
  return section("exact-load", "Set of loads, exact", ellipsoid_table(load, scene.illustration.units));
}

Html space(const Certificate& certificate) {
  return section("space", "Poses that the platform may take",
                 has_poses(certificate.path.interpolation)
                     ? html("<p>Any: waypoints are positions and quaternions, and nothing depends on parameters.</p>\n")
                     : space_tables(certificate.problem));
}

Html exact_path(const ReportContext& scene) {
  const std::size_t count = scene.certificate.path.waypoints.size();
  if (count == 0) return {};
  const std::size_t step = count <= kMostRows ? 1 : (count + kMostBlocks - 1) / kMostBlocks;
  return section(
      "exact-path", "Waypoints, exact",
      html("<p>The decimals read back to the binary64 numbers of the certificate bit for bit, and a multiple of π is "
           "added where it is written.{}</p>\n",
           step == 1 ? "" : fmt::format(" Every {}th of them is shown; the certificate and path.csv have all.", step)) +
          folded(count > kLongTable, html("{}", plural(count, "waypoint")), exact_waypoints(scene, step)));
}

Html exact_stretches(const ReportContext& scene) {
  const std::vector<Stretch>& stretches = scene.certificate.stretches;
  if (stretches.empty()) return {};
  const auto text = [&](const PathPoint& point) {
    return point.on_segment ? html("{}, {}", point.index, point.s.text()) : html("waypoint {}", point.index);
  };
  std::vector<std::vector<Html>> rows;
  for (std::size_t k = 0; k < std::min(stretches.size(), kMostRows); ++k) {
    const Stretch& stretch = stretches[k];
    const auto reason = undecided_reason(stretch.reason);
    const auto witness = [&](const auto& of) {
      return stretch.violations ? text(of(*stretch.violations).violation.at) : html("{}", reason ? code(*reason) : "–");
    };
    rows.push_back({html("{}", k + 1), text(stretch.begin),
                    witness([](const auto& pair) -> const auto& { return pair.first; }),
                    witness([](const auto& pair) -> const auto& { return pair.second; }), text(stretch.end)});
  }
  const Html all = table(
      html("Stretches that are not proved, exact: segment, s; of open ones the code of the reason"),
      {{html("Stretch"), true}, {html("From")}, {html("First witness")}, {html("Last witness")}, {html("To")}}, rows);
  return section("exact-stretches", "Ends of the stretches, exact",
                 folded(rows.size() > kLongTable, html("{}", plural(stretches.size(), "stretch")), all));
}

Html inputs(const Certificate& certificate) {
  const auto digest = [](const std::string& text) { return html("<span class=\"digest\">{}</span>", text); };
  const auto row = [](const Html& what, const Html& value) { return std::vector<Html>{what, value}; };
  return section(
      "inputs", "Inputs and digests",
      table(html("Inputs and digests"), {{html("What")}, {html("Value")}},
            {row(html("name of the case (not checked)"), html("<bdi>{}</bdi>", certificate.problem.name)),
             row(html("made by (not checked)"), html("<bdi>{}</bdi>", text(certificate.generator))),
             row(html("problem_sha256"), digest(certificate.problem_sha256)),
             row(html("path_sha256"), digest(certificate.path_sha256)),
             row(html("footer.sha256"), digest(certificate.footer_sha256))}) +
          html("<p class=\"note\">SHA-256 of the canonical JSON of the problem, of the path, and of the whole "
               "certificate without its footer. taut-check compares them with what the certificate contains.</p>\n"));
}

Html recheck(const ReportContext& scene) {
  const bool is_claim = scene.verdict == "proved" || scene.verdict == "refuted";
  // Accepted is also a refutation: what is expected is said.
  const std::string command = is_claim ? " --path PATH --expect " + scene.verdict : "";
  return section("recheck", "How to check this again",
                 html("<p>Another program, with other arithmetic, proves the certificate again from nothing but the "
                      "certificate, the case file and the path file. It should exit with {}.</p>\n<pre>taut-check "
                      "certificate.json CASE.yaml{}</pre>\n"
                      "<p>This computes problem_sha256, path_sha256 and footer.sha256 without taut:</p>\n"
                      "<pre>{}</pre>\n",
                      is_claim ? "0, accepted, if the claim is true" : "2, undecided", command, kDigestCommand));
}

}  // namespace taut
