// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/sections.h"

#include <algorithm>

#include "certify/undecided.h"
#include "problem/rational.h"
#include "reports/summary/headroom_summary.h"
#include "reports/summary/load_statement.h"
#include "reports/summary/scope.h"
#include "reports/summary/sentences.h"
#include "reports/summary/wording.h"

namespace taut {

namespace {

constexpr std::size_t kLongTable = 14;   ///< rows; longer tables are folded on the screen
constexpr std::size_t kMostRows = 300;   ///< of what is listed in full; longer lists are shown in blocks,
constexpr std::size_t kBlocks = 100;     ///< so many at most
constexpr std::size_t kLeastShown = 50;  ///< segments with the least margins
constexpr double kDegrees = 180 / 3.14159265358979323846;

/// γ of segment k, where the path runs between poses.
Html motion_between_poses(Interpolation law) {
  if (law == Interpolation::kGeodesic) {
    return html(
        "<p>p(s) <span class=\"up\">=</span> (1 − s) p<sub>k</sub> + s p<sub>k+1</sub>,&ensp;R(s) <span "
        "class=\"up\">=</span> R<sub>k</sub> exp(s log(R<sub>k</sub><sup>T</sup> R<sub>k+1</sub>)),&ensp;s ∈ [0, "
        "1]</p>\n");
  }
  return html(
      "<p>(p, R)(s) <span class=\"up\">the only pose in its tube with</span> |p + R b<sub>i</sub> − a<sub>i</sub>| = "
      "(1 − s) L<sub>k,i</sub> + s L<sub>k+1,i</sub>,&ensp;s ∈ [0, 1]</p>\n");
}

Html formulas(const Certificate& certificate) {
  if (certificate.verdict == Verdict::kUndecided) return {};
  const Html curve =
      certificate.path.interpolation == Interpolation::kStraight
          ? html("(1 − s) λ<sub>k</sub> + s λ<sub>k+1</sub>")
          : html(
                "((1 − s)<sup>3</sup> λ<sub>k</sub> + (3s<sup>3</sup> − 6s<sup>2</sup> + 4) λ<sub>k+1</sub> + "
                "(−3s<sup>3</sup> + 3s<sup>2</sup> + 3s + 1) λ<sub>k+2</sub> + s<sup>3</sup> λ<sub>k+3</sub>)/6");
  const Html motion =
      has_poses(certificate.path.interpolation) ? motion_between_poses(certificate.path.interpolation)
      : certificate.problem.space.constraints.empty()
          ? html("<p>γ<sub>k</sub>(s) <span class=\"up\">=</span> pose({}),&ensp;s ∈ [0, 1]</p>\n", curve)
          : html(
                "<p>γ<sub>k</sub>(s) <span class=\"up\">=</span> pose(ℓ<sub>k</sub>(s) + N<sub>k</sub>(s) y(s)),&ensp;"
                "ℓ<sub>k</sub>(s) = {},&ensp;s ∈ [0, 1]</p>\n"
                "<p>y(s) <span class=\"up\">the only</span> y <span class=\"up\">with</span> C(ℓ<sub>k</sub>(s) + "
                "N<sub>k</sub>(s) y) = 0, |y<sub>i</sub>| ≤ r<sub>k</sub></p>\n",
                curve);
  const LoadText& load = certificate.problem.load;
  const Html ellipsoid = html("{{ w : (w − w<sub>0</sub>)<sup>T</sup> E (w − w<sub>0</sub>) ≤ 1 }}");
  const Html items = html(
      "K<sub>1</sub> + … + K<sub>{}</sub>, <span class=\"up\">the items of the load, in the axes of the world about "
      "the load point</span>",
      load.items.size());
  const Html set = load.items.empty() ? ellipsoid : load.ellipsoid ? items + html(" + ") + ellipsoid : items;
  const Html path = html("{}<p>K <span class=\"up\">=</span> {}</p>\n", motion, set);
  if (certificate.verdict == Verdict::kRefuted) {
    return html(
        "<div class=\"formulas\">{}"
        "<p>∃ k, s ∈ [0, 1], i, w ∈ K :&ensp; det J(γ<sub>k</sub>(s)) = 0 &ensp;<span class=\"up\">or</span>&ensp; "
        "f<sub>i</sub> ∉ (f<sub>lo,i</sub>, f<sub>hi,i</sub>) <span class=\"up\">with</span> J f = w "
        "&ensp;<span class=\"up\">or</span>&ensp; d<sub>i</sub> ∉ (d<sub>lo,i</sub>, d<sub>hi,i</sub>)</p></div>\n",
        path);
  }
  return html(
      "<div class=\"formulas\">{}"
      "<p>∀ k ∈ {{0, …, {}}} &ensp;∀ s ∈ [0, 1] &ensp;{}∀ w ∈ K &ensp;∀ i ∈ {{1, …, 6}}, "
      "<span class=\"up\">at the pose</span> γ<sub>k</sub>(s){}:</p>\n"
      "<p>&emsp;det J ≠ 0, &emsp; J f = w ⟹ f<sub>lo,i</sub> &lt; f<sub>i</sub> &lt; f<sub>hi,i</sub>, &emsp; "
      "d<sub>lo,i</sub> &lt; d<sub>i</sub> &lt; d<sub>hi,i</sub></p>\n"
      "<p><span class=\"up\">which is the same as</span>&ensp; {}</p></div>\n",
      path, certificate.segments.empty() ? 0 : certificate.segments.size() - 1,
      certificate.problem.tolerances ? html("∀ <span class=\"up\">deviations within the tolerances</span> &ensp;")
                                     : Html(),
      certificate.problem.tolerances ? html("<span class=\"up\">, moved by the deviation</span>") : Html(),
      load.items.empty()
          ? html("f<sub>lo,i</sub> &lt; f<sub>0,i</sub> − v<sub>i</sub>, &ensp; f<sub>0,i</sub> + v<sub>i</sub> &lt; "
                 "f<sub>hi,i</sub>, &ensp;<span class=\"up\">where</span>&ensp; f<sub>0</sub> = J<sup>−1</sup> "
                 "w<sub>0</sub>, &ensp; B = J<sup>T</sup> E J, &ensp; v<sub>i</sub> = √(B<sup>−1</sup>)<sub>ii</sub>")
          : html("f<sub>lo,i</sub> &lt; <span class=\"up\">min</span><sub>w ∈ K</sub> (J<sup>−1</sup> w)<sub>i</sub>, "
                 "&ensp; <span class=\"up\">max</span><sub>w ∈ K</sub> (J<sup>−1</sup> w)<sub>i</sub> &lt; "
                 "f<sub>hi,i</sub>"));
}

/// "0.5 mm", or six of them.
Html each_cable(const std::array<DecimalText, kCables>& metres, const DisplayUnit& unit) {
  if (std::ranges::all_of(metres, [&](const DecimalText& x) { return x == metres[0]; })) {
    return html("{} {}", unit.exact(metres[0]), unit.name());
  }
  Html list;
  for (const DecimalText& x : metres) list += html("{}{}", list.empty() ? "" : ", ", unit.exact(x));
  return list + html(" {}", unit.name());
}

Html triple(const std::array<DecimalText, 3>& metres, const DisplayUnit& unit) {
  return html("({}, {}, {})", unit.exact(metres[0]), unit.exact(metres[1]), unit.exact(metres[2]));
}

Html robot_tables(const Problem& problem, const DisplayUnits& units) {
  std::vector<std::vector<Html>> cables;
  for (std::size_t i = 0; i < kCables; ++i) {
    const Limits& tension = problem.robot.tension_N[i];
    const Limits& length = problem.robot.length_m[i];
    cables.push_back({html("{}", i + 1), triple(problem.robot.base_anchors_m[i], units.length),
                      triple(problem.robot.platform_anchors_m[i], units.length),
                      html("({}, {})", units.force.exact(tension.lower), units.force.exact(tension.upper)),
                      html("({}, {})", units.length.exact(length.lower), units.length.exact(length.upper))});
  }
  return table(html("Cables: anchors and limits, exact"),
               {{html("Cable"), true},
                {html("Base anchor a [{}]", units.length.name())},
                {html("Platform anchor b [{}]", units.length.name())},
                {html("Tension limits [{}]", units.force.name())},
                {html("Length limits [{}]", units.length.name())}},
               cables);
}

/// The items in words.
Html items_table(const LoadText& load) {
  const LoadStatement statement = load_statement(load);
  std::vector<std::vector<Html>> rows;
  for (const auto& [name, words] : statement.items) rows.push_back({html("<bdi>{}</bdi>", name), html("{}", words)});
  return html("<p>{} {}</p>\n", statement.total, statement.spread) +
         table(html("What the load consists of; K is the sum. Ranges with many digits are rounded inward"),
               {{html("Item")}, {html("What it is")}}, rows);
}

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

Html load_table(const LoadText& load, const DisplayUnits& units) {
  return items_table(load) + (load.ellipsoid ? ellipsoid_table(load, units) : Html());
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

/// Exact parameters and rounded pose of every `step`th waypoint and of the last, side by side, or one below the other
/// if that is too wide.
Html waypoint_table(const ReportContext& scene, std::size_t step) {
  constexpr std::size_t kSideBySide = 3;  // parameters that leave room for the pose on a printed page
  const Path& path = scene.certificate.path;
  const bool is_spline = path.interpolation == Interpolation::kCubicBSpline;
  const Html what = html("{}", is_spline ? "Control point" : "Waypoint");
  std::vector<Column> columns = {{what, true}};
  const auto named = coordinates(scene.certificate);
  for (const auto& [name, unit] : named) columns.push_back({html("<code>{}</code> {}", name, in_brackets(unit)), true});
  std::vector<Column> pose_columns = {{what, true}};
  const DisplayUnit& length = scene.illustration.units.length;
  for (const char* name : {"px", "py", "pz"}) pose_columns.push_back({html("{} [{}]", name, length.name()), true});
  const std::vector<std::string> angles = angle_symbols(scene.certificate.problem.space.angles.kind);
  for (const std::string& symbol : angles) pose_columns.push_back({html("{} [°]", symbol), true});
  std::vector<std::vector<Html>> rows;
  std::vector<std::vector<Html>> pose_rows;
  const std::size_t last = path.waypoints.size() - 1;
  for (std::size_t k = 0; k <= last; k = k < last ? std::min(k + step, last) : last + 1) {
    const Waypoint& waypoint = path.waypoints[k];
    rows.push_back({html("{}", k)});
    for (std::size_t j = 0; j < waypoint.x.size(); ++j) {
      rows.back().push_back(html("{}", coordinate_text(waypoint.x[j], half_turns(waypoint, j))));
    }
    const Pose<double> pose =
        is_spline ? scene.sampler.pose(waypoint) : scene.sampler.at(path, static_cast<double>(k)).pose;
    pose_rows.push_back({html("{}", k)});
    for (int c = 0; c < 3; ++c) pose_rows.back().push_back(html("{}", length.fixed(pose.p_WP(c), 6)));
    for (std::size_t c = 0; c < angles.size(); ++c) {
      pose_rows.back().push_back(html("{:.3f}", pose.angles[c] * kDegrees + 0.0));
    }
  }
  if (named.size() > kSideBySide) {
    // Groups of columns that fit on a page: px py pz, qx qy qz qw, L1 L2 L3, L4 L5 L6; or three parameters each.
    Html tables;
    for (std::size_t first = 1; first < columns.size();) {
      const bool is_quaternion = has_poses(path.interpolation) && first == 4;
      const std::size_t end = std::min(columns.size(), first + (is_quaternion ? 4 : kSideBySide));
      const auto part = [&](const auto& row) {
        auto cells = std::vector(row.begin() + static_cast<std::ptrdiff_t>(first),
                                 row.begin() + static_cast<std::ptrdiff_t>(end));
        cells.insert(cells.begin(), row.front());
        return cells;
      };
      std::vector<std::vector<Html>> part_rows;
      for (const std::vector<Html>& row : rows) part_rows.push_back(part(row));
      tables += table(html("{}s: exact numbers", what), part(columns), part_rows);
      first = end;
    }
    return tables + table(html("{}s: rounded poses", what), pose_columns, pose_rows);
  }
  columns.insert(columns.end(), pose_columns.begin() + 1, pose_columns.end());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k].insert(rows[k].end(), pose_rows[k].begin() + 1, pose_rows[k].end());
  }
  return table(html("{}s: exact parameters and rounded poses", what), columns, rows);
}

/// How the path follows the constraints, and how far that takes it from the waypoints.
Html on_constraints(const ReportContext& scene) {
  const std::vector<double>& tubes = scene.certificate.path.tubes;
  const double widest = tubes.empty() ? 0 : *std::max_element(tubes.begin(), tubes.end());
  return html(
      " All poses of the motion lie on the constraints, exactly; waypoints lie near them, and the poses shown are "
      "those "
      "on them. The motion is at most {:.3g} (m, rad; r<sub>k</sub> along each column of N) from what the waypoints "
      "alone "
      "would give.",
      widest);
}

/// The printed row of a segment, or of several consecutive ones.
struct MarginRow {
  std::size_t first = 0, last = 0;  ///< segments
  std::size_t boxes = 0;
  int depth = 0;                     ///< of the narrowest box: it is 2^-depth wide
  const Margins* tension = nullptr;  ///< of the segment with the least; null where none is proved
  const Margins* length = nullptr;
  const Margins* scale = nullptr;
};

double approximate(const std::string& margin) { return ScalarTraits<double>::from_decimal(margin); }

MarginRow margin_row(const ReportContext& scene, std::size_t first, std::size_t last) {
  MarginRow row{first, last};
  for (std::size_t k = first; k <= last; ++k) {
    const CertificateSegment& segment = scene.certificate.segments[k];
    row.boxes += segment.boxes.size();
    for (const DyadicBox& box : scene.boxes[k]) row.depth = std::max(row.depth, box.depth);
    if (!segment.margins) continue;
    const Margins& margins = *segment.margins;
    const auto keep_least = [&](const Margins*& least, DecimalText Margins::*margin) {
      if (least == nullptr || approximate(margins.*margin) < approximate(least->*margin)) least = &margins;
    };
    keep_least(row.tension, &Margins::tension_N);
    keep_least(row.length, &Margins::length_m);
    keep_least(row.scale, &Margins::wrench_scale);
  }
  return row;
}

Html margin_table(const Certificate& certificate, const std::string& caption, const std::vector<MarginRow>& rows) {
  const auto cell = [&](const Margins* least, DecimalText Margins::*margin) {
    if (least == nullptr) return html("–");
    const std::string& value = least->*margin;
    return certificate.margins && value == (*certificate.margins).*margin ? html("<b>{}</b>", value)
                                                                          : html("{}", value);
  };
  std::vector<std::vector<Html>> cells;
  cells.reserve(rows.size());
  for (const MarginRow& row : rows) {
    cells.push_back({row.first == row.last ? html("{}", row.first) : html("{} – {}", row.first, row.last),
                     html("{} → {}", row.first, row.last + control_points(certificate.path.interpolation) - 1),
                     html("{}", row.boxes),
                     row.boxes == 0   ? html("–")
                     : row.depth == 0 ? html("1")
                                      : html("2<sup>−{}</sup>", row.depth),
                     cell(row.tension, &Margins::tension_N), cell(row.length, &Margins::length_m),
                     cell(row.scale, &Margins::wrench_scale)});
  }
  return table(html("{}", caption),
               {{html("Segment"), true},
                {html("Waypoints"), true},
                {html("Boxes"), true},
                {html("Narrowest"), true},
                {html("tension_N [N]"), true},
                {html("length_m [m]"), true},
                {html("wrench_scale [1]"), true}},
               cells);
}

/// The segments with the least margins: of each kind those that come first, in order along the path.
std::vector<MarginRow> least_segments(const ReportContext& scene) {
  const Certificate& certificate = scene.certificate;
  std::vector<std::size_t> all;
  for (std::size_t k = 0; k < certificate.segments.size(); ++k) {
    if (certificate.segments[k].margins) all.push_back(k);
  }
  std::vector<double> scale(certificate.segments.size());
  for (const std::size_t k : all) scale[k] = approximate(certificate.segments[k].margins->wrench_scale);
  const std::size_t count = std::min(kLeastShown, all.size());
  std::ranges::partial_sort(all, all.begin() + static_cast<std::ptrdiff_t>(count), {},
                            [&](std::size_t k) { return scale[k]; });
  all.resize(count);
  std::ranges::sort(all);
  std::vector<MarginRow> rows;
  for (const std::size_t k : all) rows.push_back(margin_row(scene, k, k));
  return rows;
}

/// With these arguments Python writes canonical JSON, because a certificate has no fractional numbers.
constexpr const char* kDigestCommand = R"(python3 -c '
import json, hashlib
c = json.load(open("certificate.json")); c.pop("footer"); c.pop("signature", None)
for v in (c["problem"], c["path"], c):
    text = json.dumps(v, sort_keys=True, separators=(",", ":"))
    print(hashlib.sha256(text.encode()).hexdigest())
')";

}  // namespace

Html theorem(const Certificate& certificate) {
  const std::vector<Column> columns = {{html("Symbol")}, {html("Meaning")}, {html("Unit")}};
  const auto row = [](const Html& symbol, const Html& meaning, const Html& unit) {
    return std::vector<Html>{html("<i>{}</i>", symbol), meaning, unit};
  };
  std::vector<std::vector<Html>> rows = {
      row(html("γ<sub>k</sub>(s)"), html("pose of the platform at the point s of segment k"), html("")),
      row(html("λ<sub>k</sub>"), html("waypoint k: one exact number for each parameter of the space of poses"),
          html("m, rad")),
      row(html("p, R"),
          html("position of the platform's origin; its orientation by {}",
               rotation_formula(certificate.problem.space.angles)),
          html("m, rad")),
      row(html("a<sub>i</sub>, b<sub>i</sub>"),
          html("anchors of cable i on the base (world axes) and on the platform (platform axes)"), html("m")),
      row(html("d<sub>i</sub>"), html("length of cable i, |p + R b<sub>i</sub> − a<sub>i</sub>|"), html("m")),
      row(html("u<sub>i</sub>"), html("direction of cable i, from base to platform"), html("1")),
      row(html("J"),
          html("force Jacobian: column i is (u<sub>i</sub> ; (R (b<sub>i</sub> − p<sub>m</sub>)) × u<sub>i</sub>), "
               "about the load point"),
          html("1, m")),
      row(html("f<sub>i</sub>"), html("tension of cable i"), html("N")),
      row(html("w"), html("wrench (force, moment about the load point) that the cables balance"), html("N, N·m")),
      row(html("K"), html("the set of all wrenches of the load"), html("N, N·m")),
      row(html("f<sub>lo</sub>, f<sub>hi</sub>, d<sub>lo</sub>, d<sub>hi</sub>"),
          html("limits of tension and length; they are themselves excluded"), html("N, m"))};
  const LoadText& load = certificate.problem.load;
  if (load.ellipsoid) {
    rows.push_back(
        row(html("w<sub>0</sub>, E"), html("centre and matrix of the load ellipsoid"), html("N, N·m; 1/N², 1/(N·m)²")));
  }
  if (load.items.empty()) {
    rows.push_back(row(html("f<sub>0,i</sub> ± v<sub>i</sub>"),
                       html("least and greatest tension of cable i over all wrenches in K"), html("N")));
  }
  const Html symbols = table(html("Symbols of the claim"), columns, rows);
  return section("theorem", "What is claimed",
                 html("<blockquote>{}</blockquote>\n{}{}", certificate.claim, formulas(certificate),
                      folded(false, html("Symbols"), symbols)));
}

Html assumptions(const Certificate& certificate) {
  const auto list = [](const std::vector<ScopeItem>& items) {
    Html rows;
    for (const ScopeItem& item : items) rows += html("<li>{}</li>\n", item.text);
    return html("<ul>\n{}</ul>\n", rows);
  };
  return section(
      "assumptions", "What is assumed, and what is not covered",
      html("<p>The claim is about a mathematical model. Whoever signs this report vouches that the machine "
           "agrees with it.</p>\n<h3>Assumed</h3>\n{}<h3>Not covered</h3>\n{}",
           list(assumed(certificate.problem, certificate.path.interpolation)), list(not_covered(certificate.problem))));
}

Html headroom(const ReportContext& scene) {
  if (!scene.illustration.headroom) return {};
  const std::vector<std::string> sentences =
      headroom_sentences(*scene.illustration.headroom, scene.certificate.problem, scene.illustration.units);
  if (sentences.empty()) return {};
  Html body;
  for (const std::string& sentence : sentences) body += html("<p>{}</p>\n", sentence);
  return section("headroom", scene.verdict == "proved" ? "How far the proof reaches" : "What stands in the way",
                 body + html("<p class=\"note\">The program that wrote the certificate proved these shares, and found "
                             "the place in floating point. They are no part of the claim, and nothing has checked "
                             "them.</p>\n"));
}

Html tolerances(const ReportContext& scene) {
  if (!scene.certificate.problem.tolerances) return {};
  const TolerancesText& t = *scene.certificate.problem.tolerances;
  const std::optional<Headroom>& headroom = scene.illustration.headroom;
  const DisplayUnit& length = scene.illustration.units.length;
  std::vector<std::vector<Html>> rows;
  const auto row = [&](const std::string& key, const Html& what, const Html& stated) {
    Html limit = html("–");
    for (const ProvableShare& found : headroom ? headroom->shares : std::vector<ProvableShare>()) {
      if (key == name(found.of.kind) && found.share != "0")
        limit = html("{} {}", rounded_down(found.proved, 3), unit(found.of.kind));
    }
    rows.push_back({what, stated, limit});
  };
  row("base_anchors", html("anchors on the base, each from where it is stated"), each_cable(t.base_anchor_m, length));
  row("platform_anchors", html("anchors on the platform, likewise"), each_cable(t.platform_anchor_m, length));
  row("load_point", html("load point on the platform"), html("{} {}", length.exact(t.load_point_m), length.name()));
  Html wrench;
  for (const DecimalText& x : t.wrench) wrench += html("{}{}", wrench.empty() ? "± (" : ", ", x);
  row("load", html("wrench w<sub>0</sub>: force [N], moment [N·m]"), wrench + html(")"));
  row("position", html("tracking: position of the platform's origin"),
      html("{} {}", length.exact(t.position_m), length.name()));
  row("orientation", html("tracking: angle that the platform is turned by"), html("{}", angle_text(t.orientation_rad)));
  if (t.cable_length_m)
    row("cable_length", html("length of each cable, from what is commanded"), each_cable(*t.cable_length_m, length));
  const Html note =
      !headroom
          ? Html()
          : html(
                "<p class=\"note\">The last column: the size of each alone at which the path is provable, all others "
                "as "
                "stated, bisected; of six the largest. The program that wrote the certificate says so; it is no part "
                "of "
                "the claim, and nothing has checked it.</p>\n");
  return section(
      "tolerances", "Tolerances",
      html("<p>The claim covers every machine within all of these at once.</p>\n") +
          table(html("Tolerances"),
                {{html("Tolerance")}, {html("Stated"), true}, {html("Up to, alone (not checked)"), true}}, rows) +
          note);
}

namespace {

/// "taut 0.1.0"
std::string text(const Generator& generator) {
  const bool has_both = !generator.name.empty() && !generator.version.empty();
  return generator.name + (has_both ? " " : "") + generator.version;
}

}  // namespace

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

Html robot(const ReportContext& scene) {
  return section("robot", "Robot, load and space of poses",
                 robot_tables(scene.certificate.problem, scene.illustration.units) + html("<h3>Load</h3>\n") +
                     load_table(scene.certificate.problem.load, scene.illustration.units) +
                     html("<h3>Poses that the platform may take</h3>\n") + space_tables(scene.certificate.problem));
}

Html path_section(const ReportContext& scene) {
  const std::size_t count = scene.certificate.path.waypoints.size();
  if (count == 0) return section("path", "Path", html("<p>The certificate contains no path.</p>\n"));
  const Html segments =
      scene.certificate.path.interpolation != Interpolation::kCubicBSpline
          ? html("segment k leads from waypoint k to waypoint k + 1")
          : html(
                "segment k is the piece of a spline that waypoints k to k + 3 control, passing through a waypoint only "
                "where that stands three times in a row");
  const std::size_t step = count <= kMostRows ? 1 : (count + kBlocks - 1) / kBlocks;
  const bool constrained = !scene.certificate.problem.space.constraints.empty();
  return section(
      "path", "Path",
      html("<p>{}, numbered from 0; {}. Interpolation: "
           "<code>{}</code>.{} Parameters are exact: the decimals read back to the binary64 numbers of the "
           "certificate bit for bit, and a multiple of π is added where it is written. Pose coordinates are rounded, "
           "and angles are not wrapped.</p>\n",
           plural(count, "waypoint"), segments, interpolation_name(scene.certificate.path.interpolation),
           constrained ? on_constraints(scene) : Html()) +
          (step == 1 ? Html()
                     : html("<p>Every {}th of them is shown; the certificate and path.csv have all.</p>\n", step)) +
          folded(count > kLongTable, html("{}", plural(count, "waypoint")), waypoint_table(scene, step)));
}

Html margins(const ReportContext& scene) {
  const Certificate& certificate = scene.certificate;
  const std::size_t count = certificate.segments.size();
  if (count_boxes(certificate) == 0) return {};
  const std::size_t step = count <= kMostRows ? 1 : (count + kBlocks - 1) / kBlocks;
  std::vector<MarginRow> rows;
  for (std::size_t k = 0; k < count; k += step) rows.push_back(margin_row(scene, k, std::min(k + step, count) - 1));
  Html tables;
  if (step == 1) {
    tables = folded(count > kLongTable, html("{}", plural(count, "segment")),
                    margin_table(certificate, "Proved margins of each segment", rows));
  } else {
    tables =
        html("<p>The certificate has all {}. Here are blocks of them, and those with the least wrench_scale.</p>\n",
             plural(count, "segment")) +
        folded(true, html("{}", plural(rows.size(), "block")),
               margin_table(certificate,
                            fmt::format("The least proved margins of blocks of {}", plural(step, "segment")), rows)) +
        folded(true, html("The segments with the least wrench_scale"),
               margin_table(certificate, "Proved margins of the segments with the least wrench_scale",
                            least_segments(scene)));
  }
  const Html whole = certificate.margins ? html("; along the whole path it is at least <b>{}</b>",
                                                plain(certificate.margins->wrench_scale))
                                         : Html();
  return section(
      "margins", "Proved margins",
      html("<p>Lower bounds that hold at every pose of a segment, for all six cables and every load in K, as the "
           "certificate states them{}. <code>tension_N</code>: distance of a tension from its nearer limit. "
           "<code>length_m</code>: the same for a length. <code>wrench_scale</code>: the factor by which the "
           "semi-axes of K may grow before a tension reaches its limit{}. {}The true margins may be larger: a bound is "
           "as sharp "
           "as the proof needed it. Boxes are the intervals of s, from 0 to 1 along a segment, that were proved at one "
           "go.</p>\n",
           certificate.margins ? "" : ", for those parts of the path that it proves", whole,
           certificate.margins ? "The least of each column is set in bold. " : "") +
          tables);
}

Html stretches(const ReportContext& scene) {
  const Certificate& certificate = scene.certificate;
  if (certificate.stretches.empty()) return {};
  const auto place = [&](const PathPoint& point) {
    return html("{}, s = {:.6g}", place_text(scene, position(point)), position(point) - point.index);
  };
  const auto violation = [&](const PathWitness& end) {
    return html("{}, {}, s = {}", violation_text(end, certificate.problem.robot, scene.illustration.units),
                place_text(scene, position(end.at)), end.at.s.text());
  };
  const std::size_t shown = std::min(certificate.stretches.size(), kMostRows);
  std::vector<std::vector<Html>> rows;
  for (std::size_t k = 0; k < shown; ++k) {
    const Stretch& stretch = certificate.stretches[k];
    rows.push_back({html("{}", k + 1), place(stretch.begin), place(stretch.end),
                    stretch.violations ? violation(stretch.violations->first.violation)
                                       : html("open: {}", with_code(stretch.reason)),
                    stretch.violations ? violation(stretch.violations->second.violation) : Html()});
  }
  const Html all = table(
      html("Stretches that are not proved"),
      {{html(""), true}, {html("From")}, {html("To")}, {html("First violation")}, {html("Last violation")}}, rows);
  const Html rest =
      certificate.stretches.size() > shown
          ? html("<p>These are the first {}; the certificate has all {}.</p>\n", shown, certificate.stretches.size())
          : Html();
  return section(
      "stretches", "Where the path is not proved",
      html("<p>{} Segment k leads from waypoint k to the next.</p>\n",
           certificate.verdict == Verdict::kRefuted
               ? "Outside of these stretches the path is proved. Each violation is "
                 "proved at one pose, with an enclosure of the quantity."
               : "These stretches were left open; nothing is claimed of them.") +
          folded(rows.size() > kLongTable, html("{}", plural(certificate.stretches.size(), "stretch")), all) + rest);
}

Html recheck(const ReportContext& scene) {
  return section(
      "recheck", "How to check this again",
      html("<p>Another program, with other arithmetic, proves the certificate again from nothing but the "
           "certificate, the case file and the path file. It should exit with {}.</p>\n<pre>taut-check "
           "certificate.json CASE.yaml --path path.csv</pre>\n"
           "<p>The printed digests can be computed without taut:</p>\n"
           "<pre>{}</pre>\n"
           "<p>It prints problem_sha256, path_sha256 and footer.sha256.</p>\n",
           scene.verdict == "undecided" ? "2, undecided" : "0, accepted, if the claim is true", kDigestCommand));
}

}  // namespace taut
