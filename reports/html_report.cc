#include "reports/html_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "kinematics/decimal.h"
#include "reports/figures.h"
#include "reports/style.h"

namespace taut {

namespace {

constexpr double kDegrees = 180 / 3.14159265358979323846;
constexpr std::size_t kLongTable = 14;  ///< rows; longer tables are folded on the screen

// ---- Numbers and names, as text.

/// The same number, without exponent where it is readable.
std::string plain(const DecimalText& decimal) { return Decimal::parse(decimal).text(); }

/// Exactly the same length, in millimetres.
std::string millimetres(const DecimalText& metres) { return (Decimal::parse(metres) * Decimal::parse("1000")).text(); }

std::string plural(std::size_t count, const std::string& noun) {
  const std::string ending = noun.ends_with('x') || noun.ends_with('h') ? "es" : "s";
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : ending);
}

/// "-2.3", "-2.3 + 2π": reads back exactly.
std::string coordinate_text(double x, int half_turns) {
  std::string text = fmt::format("{}", x);
  if (half_turns != 0) {
    const int count = std::abs(half_turns);
    text += fmt::format(" {} {}π", half_turns > 0 ? "+" : "−", count == 1 ? "" : std::to_string(count));
  }
  return text;
}

/// The names of a waypoint's numbers, and their units.
std::vector<std::pair<std::string, std::string>> coordinates(const CertificateView& view) {
  std::vector<std::pair<std::string, std::string>> result;
  if (!has_poses(view.path.interpolation)) {
    const SpaceText& space = view.problem.space;
    for (std::size_t j = 0; j < space.parameters.size(); ++j)
      result.emplace_back(space.parameters[j].name, unit(space, j));
    return result;
  }
  for (const char* name : {"px", "py", "pz"}) result.emplace_back(name, "m");
  for (const char* name : {"qx", "qy", "qz", "qw"}) result.emplace_back(name, "");
  if (view.path.interpolation == Interpolation::kCableLengths) {
    for (const char* name : {"L1", "L2", "L3", "L4", "L5", "L6"}) result.emplace_back(name, "m");
  }
  return result;
}

int half_turns(const Waypoint& waypoint, std::size_t j) {
  return j < waypoint.half_turns.size() ? waypoint.half_turns[j] : 0;
}

/// "(phi, theta) = (-2.3, 1.6)"
std::string waypoint_text(const CertificateView& view, const Waypoint& waypoint) {
  std::string names;
  std::string values;
  const auto named = coordinates(view);
  for (std::size_t j = 0; j < waypoint.x.size(); ++j) {
    const char* comma = j == 0 ? "" : ", ";
    names += comma + named[j].first;
    values += comma + coordinate_text(waypoint.x[j], half_turns(waypoint, j));
  }
  return fmt::format("({}) = ({})", names, values);
}

std::string segment_text(const CertificateView& view, int k) {
  if (view.path.interpolation == Interpolation::kCubicBSpline) return fmt::format("segment {}", k);
  return fmt::format("segment {}, between waypoints {} and {}", k, k, k + 1);
}

std::string point_text(const CertificateView& view, const PathPointView& point) {
  if (!point.s)
    return fmt::format("waypoint {}, {}", point.index, waypoint_text(view, view.path.waypoints[point.index]));
  return fmt::format("s = {} of {}", *point.s, segment_text(view, point.index));
}

/// "px = 0 mm, py = …, sigma = 34°": rounded.
std::string pose_text(const Pose<double>& pose) {
  return fmt::format("p = ({:.4g}, {:.4g}, {:.4g}) mm, φ = {:.4g}°, θ = {:.4g}°, σ = {:.4g}°", pose.p_WP(0) * 1000,
                     pose.p_WP(1) * 1000, pose.p_WP(2) * 1000, pose.phi * kDegrees, pose.theta * kDegrees,
                     pose.sigma * kDegrees);
}

/// " (0.05 N to 0.5 N)" where it is the same for all six cables.
std::string common_limits(const std::array<Limits, kCables>& limits, bool length) {
  if (!std::all_of(limits.begin(), limits.end(), [&](const Limits& l) { return l == limits[0]; })) return "";
  const auto text = [&](const DecimalText& value) { return length ? millimetres(value) : plain(value); };
  return fmt::format(" ({} to {} {})", text(limits[0].lower), text(limits[0].upper), length ? "mm" : "N");
}

/// The segment that a margin of the whole path comes from.
std::string where_least(const CertificateView& view, std::string MarginsView::*margin) {
  const auto least = std::find_if(view.segments.begin(), view.segments.end(), [&](const SegmentView& segment) {
    return segment.margins.*margin == (*view.margins).*margin;
  });
  return least == view.segments.end() ? "no segment" : fmt::format("segment {}", least->from);
}

// ---- The verdict, in sentences.

std::string closest_text(const Scene& scene) {
  const Model<double>& model = scene.sampler.model();
  const std::optional<Closest> tension = closest_tension(model, scene.samples);
  const std::optional<Closest> length = closest_length(model, scene.samples);
  if (!tension || !length) return "";
  const int last = std::max(0, static_cast<int>(scene.view.path.segments()) - 1);
  const auto segment = [&](const Closest& c) { return std::min(static_cast<int>(c.position), last); };
  const auto limit = [](const Closest& c) { return c.upper ? "upper" : "lower"; };
  return fmt::format(
      "In floating-point samples of the path, cable {} comes closest to a tension limit: within {:.2g} N of its {} "
      "limit, {:.2g} % of the way between its limits, in segment {}. Cable {} comes closest to a length limit: within "
      "{:.3g} mm of its {} limit, in segment {}.",
      tension->cable + 1, tension->margin, limit(*tension), 100 * tension->fraction, segment(*tension),
      length->cable + 1, 1000 * length->margin, limit(*length), segment(*length));
}

std::vector<std::string> proved_text(const Scene& scene) {
  const CertificateView& view = scene.view;
  const RobotText& robot = view.problem.robot;
  std::vector<std::string> result = {"Proved: this motion is wrench-feasible, from its first pose to its last."};
  if (!view.path.waypoints.empty()) {
    result.push_back(
        fmt::format("At every pose on the way from {} to {}, and for every load in the given ellipsoid of wrenches, "
                    "the six cables of "
                    "\u201C{}\u201D balance the load with each tension strictly within its limits{}, each cable length "
                    "is strictly within "
                    "its limits{}, and no singular pose is met. The motion has {}; it was proved as a whole, in {} "
                    "without gaps, not "
                    "at samples.",
                    waypoint_text(view, view.path.waypoints.front()), waypoint_text(view, view.path.waypoints.back()),
                    view.problem.name, common_limits(robot.tension_N, false), common_limits(robot.length_m, true),
                    plural(view.segments.size(), "segment"), plural(view.boxes, "box")));
  }
  result.push_back(fmt::format(
      "Proved reserves along the whole motion: every tension stays at least {} N inside its limits (least "
      "in {}), every "
      "length at least {} mm (least in {}), and the load ellipsoid could grow at least {}-fold before a tension "
      "limit is reached "
      "(least in {}).",
      plain(view.margins->tension_N), where_least(view, &MarginsView::tension_N), millimetres(view.margins->length_m),
      where_least(view, &MarginsView::length_m), plain(view.margins->wrench_scale),
      where_least(view, &MarginsView::wrench_scale)));
  if (const std::string closest = closest_text(scene); !closest.empty()) result.push_back(closest);
  return result;
}

std::vector<std::string> refuted_text(const Scene& scene) {
  const WitnessView& witness = *scene.view.witness;
  std::vector<std::string> result = {"Refuted: this motion is not wrench-feasible."};
  const std::string at = point_text(scene.view, witness.at);
  const Pose<double> pose = scene.sampler.at(scene.view.path, witness.at.position).pose;
  if (witness.to) {
    result.push_back(fmt::format(
        "The determinant of the force Jacobian has opposite signs at {} and at {}. Somewhere between these two poses "
        "the motion therefore passes a singular pose, where the cables can't balance every load.",
        at, point_text(scene.view, *witness.to)));
    result.push_back(fmt::format("The first of the two poses, rounded: {}. The second: {}.", pose_text(pose),
                                 pose_text(scene.sampler.at(scene.view.path, witness.to->position).pose)));
    return result;
  }
  const bool length = witness.kind.starts_with("length");
  const bool upper = witness.kind.ends_with("max");
  const auto text = [&](const DecimalText& value) { return length ? millimetres(value) : plain(value); };
  const char* unit = length ? "mm" : "N";
  const std::string subject =
      length ? fmt::format("cable {} has a length", witness.cable)
             : fmt::format("some load in the given ellipsoid of wrenches gives cable {} a tension", witness.cable);
  result.push_back(fmt::format("At {}, {} of {} {} {}: not {} its {} limit of {} {}.", at, subject,
                               upper ? "at least" : "at most",
                               upper ? text(witness.value_lower) : text(witness.value_upper), unit,
                               upper ? "below" : "above", upper ? "upper" : "lower", text(witness.limit), unit));
  result.push_back(fmt::format("That value was proved to lie between {} and {} {}. The pose, rounded: {}.",
                               text(witness.value_lower), text(witness.value_upper), unit, pose_text(pose)));
  return result;
}

std::vector<std::string> undecided_text(const Scene& scene) {
  const UndecidedView& open = *scene.view.undecided;
  std::vector<std::string> result = {"Undecided: nothing is claimed about this motion."};
  result.push_back(
      fmt::format("It was neither proved nor refuted; that does not mean that it is unsafe. Reason: {}", open.reason));
  if (open.segment) {
    result.push_back(fmt::format(
        "What is open lies on {}{}.", segment_text(scene.view, *open.segment),
        open.box_lower.empty() ? "" : fmt::format(", from s = {} to s = {}", open.box_lower, open.box_upper)));
  }
  return result;
}

std::vector<std::string> verdict_text(const Scene& scene) {
  if (scene.view.verdict == "proved") return proved_text(scene);
  return scene.view.verdict == "refuted" ? refuted_text(scene) : undecided_text(scene);
}

// ---- Sections.

Html section(const char* id, const char* title, const Html& body) {
  return html("<section id=\"{}\"><h2>{}</h2>\n{}</section>\n", id, title, body);
}

Html tile(const std::string& value, const Html& words) {
  return html("<div class=\"tile\"><b>{}</b><span>{}</span></div>\n", value, words);
}

Html header(const Scene& scene) {
  const CertificateView& view = scene.view;
  Html sentences;
  for (const std::string& sentence : verdict_text(scene)) sentences += html("<p>{}</p>\n", sentence);
  Html tiles;
  if (view.margins) {
    tiles = html(
        "<div class=\"tiles\">\n{}{}{}{}</div>\n",
        tile(plain(view.margins->tension_N) + " N", html("tension_N: least distance of a tension from its limits")),
        tile(millimetres(view.margins->length_m) + " mm", html("length_m: least distance of a length from its limits")),
        tile("× " + plain(view.margins->wrench_scale),
             html("wrench_scale: factor by which the load ellipsoid may grow")),
        tile(fmt::format("{} / {}", view.segments.size(), view.boxes), html("segments / boxes that were proved")));
  }
  return html(
      "<header>\n<p class=\"kind\">Motion report for a cable-driven hexapod</p>\n<h1><bdi>{}</bdi></h1>\n"
      "<div class=\"verdict {}\">{}</div>\n{}</header>\n",
      view.problem.name, view.verdict, sentences, tiles);
}

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

Html formulas(const CertificateView& view) {
  if (view.verdict == "undecided") return {};
  const Html curve =
      view.path.interpolation == Interpolation::kStraight
          ? html("(1 − s) λ<sub>k</sub> + s λ<sub>k+1</sub>")
          : html(
                "((1 − s)<sup>3</sup> λ<sub>k</sub> + (3s<sup>3</sup> − 6s<sup>2</sup> + 4) λ<sub>k+1</sub> + "
                "(−3s<sup>3</sup> + 3s<sup>2</sup> + 3s + 1) λ<sub>k+2</sub> + s<sup>3</sup> λ<sub>k+3</sub>)/6");
  const Html motion =
      has_poses(view.path.interpolation) ? motion_between_poses(view.path.interpolation)
      : view.problem.space.constraints.empty()
          ? html("<p>γ<sub>k</sub>(s) <span class=\"up\">=</span> pose({}),&ensp;s ∈ [0, 1]</p>\n", curve)
          : html(
                "<p>γ<sub>k</sub>(s) <span class=\"up\">=</span> pose(ℓ<sub>k</sub>(s) + N<sub>k</sub>(s) y(s)),&ensp;"
                "ℓ<sub>k</sub>(s) = {},&ensp;s ∈ [0, 1]</p>\n"
                "<p>y(s) <span class=\"up\">the only</span> y <span class=\"up\">with</span> C(ℓ<sub>k</sub>(s) + "
                "N<sub>k</sub>(s) y) = 0, |y<sub>i</sub>| ≤ r<sub>k</sub></p>\n",
                curve);
  const Html path = html(
      "{}<p>K <span class=\"up\">=</span> {{ w : (w − w<sub>0</sub>)<sup>T</sup> E (w − w<sub>0</sub>) ≤ 1 "
      "}}</p>\n",
      motion);
  if (view.verdict == "refuted") {
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
      "<p><span class=\"up\">which is the same as</span>&ensp; f<sub>lo,i</sub> &lt; f<sub>0,i</sub> − v<sub>i</sub>, "
      "&ensp; f<sub>0,i</sub> + v<sub>i</sub> &lt; f<sub>hi,i</sub>, &ensp;<span class=\"up\">where</span>&ensp; "
      "f<sub>0</sub> = J<sup>−1</sup> w<sub>0</sub>, &ensp; B = J<sup>T</sup> E J, &ensp; v<sub>i</sub> = "
      "√(B<sup>−1</sup>)<sub>ii</sub></p></div>\n",
      path, view.segments.empty() ? 0 : view.segments.size() - 1,
      view.problem.tolerances ? html("∀ <span class=\"up\">deviations within the tolerances</span> &ensp;") : Html(),
      view.problem.tolerances ? html("<span class=\"up\">, moved by the deviation</span>") : Html());
}

Html theorem(const CertificateView& view) {
  const std::vector<Column> columns = {{html("Symbol")}, {html("Meaning")}, {html("Unit")}};
  const auto row = [](const Html& symbol, const Html& meaning, const Html& unit) {
    return std::vector<Html>{html("<i>{}</i>", symbol), meaning, unit};
  };
  const Html symbols = table(
      columns,
      {row(html("γ<sub>k</sub>(s)"), html("pose of the platform at the point s of segment k"), html("")),
       row(html("λ<sub>k</sub>"), html("waypoint k: one exact number for each parameter of the space of poses"),
           html("m, rad")),
       row(html("p, R"),
           html("position of the platform's origin; its orientation R = R<sub>z</sub>(φ) R<sub>y</sub>(θ) "
                "R<sub>z</sub>(σ − φ)"),
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
       row(html("w, w<sub>0</sub>"),
           html("wrench (force, moment about the load point) that the cables balance; its centre value"),
           html("N, N·m")),
       row(html("E, K"), html("matrix of the load ellipsoid; the set of all wrenches in it"), html("1/N², 1/(N·m)²")),
       row(html("f<sub>0,i</sub> ± v<sub>i</sub>"),
           html("least and greatest tension of cable i over all wrenches in K"), html("N")),
       row(html("f<sub>lo</sub>, f<sub>hi</sub>, d<sub>lo</sub>, d<sub>hi</sub>"),
           html("limits of tension and length; they are themselves excluded"), html("N, m"))});
  return section(
      "theorem", "What is claimed",
      html("<blockquote>{}</blockquote>\n{}{}", view.claim, formulas(view), folded(false, html("Symbols"), symbols)));
}

Html assumptions(const Problem& problem) {
  const bool held = problem.tolerances && problem.tolerances->cable_length_m;
  const Html exactness =
      problem.tolerances
          ? html(
                "<li>Anchors, load and tracking differ from the numbers below by no more than the tolerances. Limits "
                "and the "
                "load ellipsoid are exactly as below.</li>\n")
          : html(
                "<li>Anchors, limits, load and ellipsoid are exactly the numbers below. Tolerances of manufacture, "
                "measurement and control are not covered.</li>\n");
  const Html following =
      held
          ? html(
                "<li>The winches hold the lengths that the path commands, between waypoints too, within their "
                "tolerance.</li>\n")
          : html("<li>The controller follows the path as the interpolation law states, between waypoints too{}.</li>\n",
                 problem.tolerances ? ", within the tolerances" : ", exactly");
  return section(
      "assumptions", "What is assumed, and what is not covered",
      html("<p>The claim is about a mathematical model. Whoever signs this report vouches that the machine "
           "agrees with it.</p>\n<ul>\n"
           "<li>Cables are massless, straight and inextensible, and end in points: no sag, no stretch, no "
           "pulleys.</li>\n"
           "<li>The motion is quasi-static: forces of inertia are covered only as far as the load ellipsoid contains "
           "them.</li>\n"
           "{}{}"
           "<li>Waypoints are the binary64 numbers below; a typed coordinate that is no such number is moved by at "
           "most half a unit in its last place.</li>\n"
           "<li>Collisions of cables, platform and surroundings are not examined.</li>\n"
           "<li>Whether the numbers are those of a built machine is outside the proof. Where a case says that its "
           "geometry is a reconstruction, the claim is about the reconstruction.</li>\n</ul>\n",
           exactness, following));
}

/// "0.5 mm", or six of them.
Html each_cable(const std::array<DecimalText, kCables>& metres) {
  if (std::ranges::all_of(metres, [&](const DecimalText& x) { return x == metres[0]; })) {
    return html("{} mm", millimetres(metres[0]));
  }
  Html list;
  for (const DecimalText& x : metres) list += html("{}{}", list.empty() ? "" : ", ", millimetres(x));
  return list + html(" mm");
}

Html tolerances(const CertificateView& view) {
  if (!view.problem.tolerances) return {};
  const TolerancesText& t = *view.problem.tolerances;
  std::vector<std::vector<Html>> rows;
  const auto row = [&](const std::string& key, const Html& what, const Html& stated) {
    Html limit = html("–");
    for (const ToleranceLimitView& found : view.tolerance_limits) {
      if (found.tolerance == key) limit = html("{} {}", found.proved, found.unit);
    }
    rows.push_back({what, stated, limit});
  };
  row("base_anchors", html("anchors on the base, each from where it is stated"), each_cable(t.base_anchor_m));
  row("platform_anchors", html("anchors on the platform, likewise"), each_cable(t.platform_anchor_m));
  row("load_point", html("load point on the platform"), html("{} mm", millimetres(t.load_point_m)));
  Html wrench;
  for (const DecimalText& x : t.wrench) wrench += html("{}{}", wrench.empty() ? "± (" : ", ", x);
  row("load", html("wrench w<sub>0</sub>: force [N], moment [N·m]"), wrench + html(")"));
  row("position", html("tracking: position of the platform's origin"), html("{} mm", millimetres(t.position_m)));
  row("orientation", html("tracking: angle that the platform is turned by"), html("{} rad", t.orientation_rad));
  if (t.cable_length_m)
    row("cable_length", html("length of each cable, from what is commanded"), each_cable(*t.cable_length_m));
  const Html note =
      view.tolerance_limits.empty()
          ? Html()
          : html(
                "<p class=\"note\">The last column: how far each could grow alone, all others as stated, and the path "
                "still be "
                "proved, bisected; of six the largest. It was proved by {} and is no part of the claim that taut-check "
                "proves again.</p>\n",
                view.generator);
  return section("tolerances", "Tolerances",
                 html("<p>The claim covers every machine within all of these at once.</p>\n") +
                     table({{html("Tolerance")}, {html("Stated"), true}, {html("Proved up to, alone"), true}}, rows) +
                     note);
}

Html inputs(const CertificateView& view) {
  const auto digest = [](const std::string& text) { return html("<span class=\"digest\">{}</span>", text); };
  const auto row = [](const Html& what, const Html& value) { return std::vector<Html>{what, value}; };
  return section(
      "inputs", "Inputs and digests",
      table({{html("What")}, {html("Value")}},
            {row(html("case"), html("<bdi>{}</bdi>", view.problem.name)),
             row(html("made by"), html("{}", view.generator)), row(html("problem_sha256"), digest(view.problem_sha256)),
             row(html("path_sha256"), digest(view.path_sha256)),
             row(html("footer.sha256"), digest(view.footer_sha256))}) +
          html("<p class=\"note\">SHA-256 of the canonical JSON of the problem, of the path, and of the whole "
               "certificate without its footer. This report prints them; taut-check compares them.</p>\n"));
}

Html triple(const std::array<DecimalText, 3>& metres) {
  return html("({}, {}, {})", millimetres(metres[0]), millimetres(metres[1]), millimetres(metres[2]));
}

Html robot_tables(const Problem& problem) {
  std::vector<std::vector<Html>> cables;
  for (std::size_t i = 0; i < kCables; ++i) {
    const Limits& tension = problem.robot.tension_N[i];
    const Limits& length = problem.robot.length_m[i];
    cables.push_back({html("{}", i + 1), triple(problem.robot.base_anchors_m[i]),
                      triple(problem.robot.platform_anchors_m[i]),
                      html("({}, {})", plain(tension.lower), plain(tension.upper)),
                      html("({}, {})", millimetres(length.lower), millimetres(length.upper))});
  }
  return table({{html("Cable"), true},
                {html("Base anchor a [mm]")},
                {html("Platform anchor b [mm]")},
                {html("Tension limits [N]")},
                {html("Length limits [mm]")}},
               cables);
}

Html load_table(const LoadText& load) {
  constexpr std::array<const char*, 6> kNames = {"force x", "force y", "force z", "moment x", "moment y", "moment z"};
  std::vector<Column> columns = {{html("Component")}, {html("w<sub>0</sub>"), true}};
  for (int j = 1; j <= 6; ++j) columns.push_back({html("E<sub>i{}</sub>", j), true});
  std::vector<std::vector<Html>> rows;
  for (std::size_t i = 0; i < 6; ++i) {
    std::vector<Html> row = {html("{} [{}]", kNames[i], i < 3 ? "N" : "N·m"), html("{}", plain(load.wrench[i]))};
    for (std::size_t j = 0; j < 6; ++j) row.push_back(html("{}", plain(load.ellipsoid[i][j])));
    rows.push_back(std::move(row));
  }
  return html(
             "<p>Load point p<sub>m</sub> = {} mm in the platform frame. Wrenches are about that point, in the axes of "
             "the world. E in 1/N², 1/(N·N·m) and 1/(N·m)².</p>\n",
             triple(load.point_m)) +
         table(columns, rows);
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
  for (std::size_t c = 0; c < 6; ++c) {
    pose.push_back({html("<code>{}</code>", kPoseNames[c]), html("<code>{}</code>", space.pose[c]),
                    html("{}", c < 3 ? "m" : "rad")});
  }
  Html constants;
  for (const auto& [name, value] : space.constants) constants += html("<li><code>{} = {}</code></li>\n", name, value);
  Html result = table({{html("Parameter")}, {html("Unit")}, {html("Values")}, {html("Waypoints asked for")}}, rows) +
                table({{html("Pose")}, {html("Expression")}, {html("Unit")}}, pose);
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

Html robot(const Scene& scene) {
  return section(
      "robot", "Robot, load and space of poses",
      robot_figure(scene) +
          html("<p class=\"note\">Seen from the side, with the load pulling down; the dot is the load point. "
               "Numbers are cables.</p>\n") +
          robot_tables(scene.view.problem) + html("<h3>Load</h3>\n") + load_table(scene.view.problem.load) +
          html("<h3>Poses that the platform may take</h3>\n") + space_tables(scene.view.problem));
}

/// Exact parameters and rounded pose of every waypoint: side by side, or one below the other where that is too wide.
Html waypoint_table(const Scene& scene) {
  constexpr std::size_t kSideBySide = 3;  // parameters that leave room for the pose on a printed page
  const Path& path = scene.view.path;
  const bool is_spline = path.interpolation == Interpolation::kCubicBSpline;
  const Html what = html("{}", is_spline ? "Control point" : "Waypoint");
  std::vector<Column> columns = {{what, true}};
  const auto named = coordinates(scene.view);
  for (const auto& [name, unit] : named) columns.push_back({html("<code>{}</code> {}", name, in_brackets(unit)), true});
  std::vector<Column> pose_columns = {{what, true}};
  for (const char* name : {"px [mm]", "py [mm]", "pz [mm]", "φ [°]", "θ [°]", "σ [°]"}) {
    pose_columns.push_back({html("{}", name), true});
  }
  std::vector<std::vector<Html>> rows;
  std::vector<std::vector<Html>> pose_rows;
  for (std::size_t k = 0; k < path.waypoints.size(); ++k) {
    const Waypoint& waypoint = path.waypoints[k];
    rows.push_back({html("{}", k)});
    for (std::size_t j = 0; j < waypoint.x.size(); ++j) {
      rows.back().push_back(html("{}", coordinate_text(waypoint.x[j], half_turns(waypoint, j))));
    }
    const Pose<double> pose =
        is_spline ? scene.sampler.pose(waypoint) : scene.sampler.at(path, static_cast<double>(k)).pose;
    pose_rows.push_back({html("{}", k)});
    for (int c = 0; c < 3; ++c) pose_rows.back().push_back(html("{:.3f}", pose.p_WP(c) * 1000 + 0.0));
    for (const double angle : {pose.phi, pose.theta, pose.sigma}) {
      pose_rows.back().push_back(html("{:.3f}", angle * kDegrees + 0.0));
    }
  }
  if (named.size() > kSideBySide) return table(columns, rows) + table(pose_columns, pose_rows);
  columns.insert(columns.end(), pose_columns.begin() + 1, pose_columns.end());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k].insert(rows[k].end(), pose_rows[k].begin() + 1, pose_rows[k].end());
  }
  return table(columns, rows);
}

/// How the path is on the constraints, and how far that takes it from the waypoints.
Html on_constraints(const Scene& scene) {
  const std::vector<double>& tubes = scene.view.path.tubes;
  const double widest = tubes.empty() ? 0 : *std::max_element(tubes.begin(), tubes.end());
  return html(
      " All poses of the motion lie on the constraints, exactly; waypoints lie near them, and the poses shown are "
      "those "
      "on them. The motion is at most {:.3g} (m, rad; r<sub>k</sub> along each column of N) from what the waypoints "
      "alone "
      "would give.",
      widest);
}

Html path_section(const Scene& scene) {
  const std::size_t count = scene.view.path.waypoints.size();
  if (count == 0) return section("path", "Path", html("<p>The certificate contains no path.</p>\n"));
  const Html segments =
      scene.view.path.interpolation != Interpolation::kCubicBSpline
          ? html("segment k leads from waypoint k to waypoint k + 1")
          : html(
                "segment k is the piece of a spline that waypoints k to k + 3 control, passing through a waypoint only "
                "where that stands three times in a row");
  const bool constrained = !scene.view.problem.space.constraints.empty();
  return section(
      "path", "Path",
      html("<p>{}, numbered from 0; {}. Interpolation: "
           "<code>{}</code>.{} Parameters are exact: the decimals read back to the binary64 numbers of the "
           "certificate bit for bit, and a multiple of π is added where it is written. Pose coordinates are rounded, "
           "and angles are not wrapped.</p>\n",
           plural(count, "waypoint"), segments, scene.view.interpolation,
           constrained ? on_constraints(scene) : Html()) +
          pose_figure(scene) +
          folded(count > kLongTable, html("{}", plural(count, "waypoint")), waypoint_table(scene)));
}

/// What the marks on the plots along the path mean, where there are some.
Html marks_text(const CertificateView& view) {
  if (view.witness) return html(" Dashed red: {}.", view.witness->to ? "the two witness poses" : "the witness pose");
  if (view.undecided && view.undecided->segment) return html(" Amber: what was left open.");
  return {};
}

Html tensions(const Scene& scene) {
  if (scene.samples.empty()) return {};
  return section(
      "tensions", "Tensions along the path",
      html("<p>The band is f<sub>0</sub> ± v: all tensions that the loads in K can ask of a cable; the line is "
           "f<sub>0</sub>, for the centre load. Shaded red: beyond the limits. Curves are floating-point samples; the "
           "proof does not rest on them.{}</p>\n",
           marks_text(scene.view)) +
          tension_figure(scene));
}

Html lengths(const Scene& scene) {
  if (scene.samples.empty()) return {};
  return section(
      "lengths", "Cable lengths along the path",
      html("<p>Shaded red: beyond the limits. Floating-point samples again.{}</p>\n", marks_text(scene.view)) +
          length_figure(scene));
}

Html margins(const CertificateView& view) {
  if (!view.margins) return {};
  std::vector<std::vector<Html>> rows;
  rows.reserve(view.segments.size());
  const auto cell = [](const std::string& value, const std::string& least) {
    return value == least ? html("<b>{}</b>", value) : html("{}", value);
  };
  for (const SegmentView& segment : view.segments) {
    rows.push_back({html("{}", segment.from), html("{} → {}", segment.from, segment.to), html("{}", segment.boxes),
                    cell(segment.margins.tension_N, view.margins->tension_N),
                    cell(segment.margins.length_m, view.margins->length_m),
                    cell(segment.margins.wrench_scale, view.margins->wrench_scale)});
  }
  const Html all = table({{html("Segment"), true},
                          {html("Waypoints"), true},
                          {html("Boxes"), true},
                          {html("tension_N [N]"), true},
                          {html("length_m [m]"), true},
                          {html("wrench_scale [1]"), true}},
                         rows);
  return section(
      "margins", "Proved margins",
      html("<p>Lower bounds that hold at every pose of a segment, for all six cables and every load in K, as the "
           "certificate states them. <code>tension_N</code>: distance of a tension from its nearer limit. "
           "<code>length_m</code>: the same for a length. <code>wrench_scale</code>: the factor by which the "
           "semi-axes of K may grow before a tension reaches its limit; along the whole path it is at least "
           "<b>{}</b>. The least of each column is set in bold. The true margins may be larger: a bound is as sharp "
           "as the proof needed it.</p>\n",
           plain(view.margins->wrench_scale)) +
          folded(rows.size() > kLongTable, html("{}", plural(rows.size(), "segment")), all));
}

std::string violation_text(const WitnessView& end) {
  if (end.to) return "the force Jacobian becomes singular";
  return fmt::format("{} of cable {} in [{}, {}], limit {}, at {} of segment {}", end.kind, end.cable,
                     plain(end.value_lower), plain(end.value_upper), end.limit, end.at.s.value_or("0"), end.at.index);
}

Html stretches(const CertificateView& view) {
  if (view.stretches.empty()) return {};
  const auto place = [](const PathPointView& point) {
    return html("segment {}, s = {:.6g}", point.index, point.position - point.index);
  };
  std::vector<std::vector<Html>> rows;
  for (const StretchView& stretch : view.stretches) {
    rows.push_back({place(stretch.begin), place(stretch.end),
                    stretch.first ? html("{}", violation_text(*stretch.first)) : html("open: {}", stretch.reason),
                    stretch.last ? html("{}", violation_text(*stretch.last)) : Html()});
  }
  const Html all = table({{html("From")}, {html("To")}, {html("First violation")}, {html("Last violation")}}, rows);
  return section("stretches", "Where the path is not proved",
                 html("<p>{} Segment k leads from waypoint k to the next.</p>\n",
                      view.verdict == "refuted" ? "Outside of these stretches the path is proved. Each violation is "
                                                  "proved at one pose, with an enclosure of the quantity."
                                                : "These stretches were left open; nothing is claimed of them.") +
                     folded(rows.size() > kLongTable, html("{}", plural(rows.size(), "stretch")), all));
}

Html slice(const Scene& scene) {
  const Html figure = slice_figure(scene);
  if (figure.empty()) return {};
  Html stats;
  for (const auto& [key, value] : scene.view.stats)
    stats += html("{}{}: {}", stats.empty() ? Html() : html(" · "), key, value);
  return section(
      "slice", "The plane of the two parameters",
      html("<p>C is the set of wrench-feasible poses. Colours and the line det J = 0 are floating-point samples on "
           "a grid, and the atlas is where the planner looked: neither proves anything. Periodic parameters are drawn "
           "unwrapped, so that the path is "
           "one line.{}</p>\n",
           scene.view.problem.space.flip ? " (φ, θ) and (φ + π, −θ) are the same pose." : "") +
          figure + (stats.empty() ? Html() : html("<p class=\"note\">Search: {}</p>\n", stats)));
}

/// Canonical JSON is what Python writes with these arguments, as a certificate has no fractional number.
constexpr const char* kDigestCommand = R"(python3 -c '
import json, hashlib
c = json.load(open("certificate.json")); c.pop("footer"); c.pop("signature", None)
for v in (c["problem"], c["path"], c):
    text = json.dumps(v, sort_keys=True, separators=(",", ":"))
    print(hashlib.sha256(text.encode()).hexdigest())
')";

Html recheck(const CertificateView& view) {
  return section("recheck", "How to check this again",
                 html("<p>Another program, with other arithmetic, proves the certificate again from nothing but the "
                      "certificate and the case file. It should exit with {}.</p>\n<pre>taut-check certificate.json "
                      "CASE.yaml</pre>\n"
                      "<p>The printed digests can be computed without taut:</p>\n"
                      "<pre>{}</pre>\n"
                      "<p>It prints problem_sha256, path_sha256 and footer.sha256.</p>\n",
                      view.verdict == "undecided" ? "2, undecided" : "0, accepted", kDigestCommand));
}

Html signature(const CertificateView& view) {
  return html(
      "<div class=\"sign\"><div>Name</div><div>Date</div><div>Signature</div></div>\n"
      "<p class=\"note\">This report belongs to the certificate with footer.sha256 <span "
      "class=\"digest\">{}</span>.</p>\n",
      view.footer_sha256);
}

Html contents(const Scene& scene) {
  Html links;
  const auto link = [&](bool present, const char* id, const char* title) {
    if (present) links += html("<a href=\"#{}\">{}</a> ", id, title);
  };
  const bool sampled = !scene.samples.empty();
  link(true, "theorem", "Claim");
  link(scene.view.problem.tolerances.has_value(), "tolerances", "Tolerances");
  link(true, "assumptions", "Assumptions");
  link(true, "inputs", "Digests");
  link(true, "robot", "Robot");
  link(true, "path", "Path");
  link(!scene.view.stretches.empty(), "stretches", "Stretches");
  link(sampled, "tensions", "Tensions");
  link(sampled, "lengths", "Lengths");
  link(scene.view.margins.has_value(), "margins", "Margins");
  link(is_plane(scene.view.problem.space), "slice", "Plane");
  link(true, "recheck", "Check again");
  return html("<nav aria-label=\"Contents\">{}</nav>\n", links);
}

}  // namespace

std::string html_report(const nlohmann::json& certificate) {
  const Scene scene(certificate);
  const Html body = header(scene) + contents(scene) + theorem(scene.view) + tolerances(scene.view) +
                    assumptions(scene.view.problem) + inputs(scene.view) + robot(scene) + path_section(scene) +
                    stretches(scene.view) + tensions(scene) + lengths(scene) + margins(scene.view) + slice(scene) +
                    recheck(scene.view) + signature(scene.view);
  const Html title = html("{}: {}", scene.view.problem.name, scene.view.verdict);
  // An empty icon keeps browsers from asking a server for one.
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; img-src "
      "data:\">\n<link rel=\"icon\" "
      "href=\"data:,\">\n<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n{}</body>\n</html>\n",
      title.str(), kStyle, body.str());
}

std::string text_summary(const nlohmann::json& certificate) {
  std::string result;
  for (const std::string& sentence : verdict_text(Scene(certificate))) result += sentence + "\n";
  return result;
}

}  // namespace taut
