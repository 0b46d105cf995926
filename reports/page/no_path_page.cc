// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/no_path_page.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/sanitize.h"
#include "map/topology.h"
#include "problem/expression.h"
#include "reports/page/first_page_style.h"
#include "reports/page/markup.h"
#include "reports/page/style.h"
#include "reports/summary/load_statement.h"
#include "reports/summary/wording.h"

namespace taut {
namespace {

using nlohmann::json;

std::string rounded(const ExpressionText& constant) {
  return with_minus_signs(fmt::format("{:.6g}", evaluate_constant<double>(constant)));
}

/// The certificate, and what is said of it. Words about the verdict are there only where there is a theorem.
struct Content {
  explicit Content(const checker::CheckResult& checked_result)
      : checked(checked_result),
        certificate(*checked_result.certificate),
        problem(problem_from_json(certificate.at("problem"))),
        from(certificate.at("waypoints").at(0).get<std::size_t>()) {}

  [[nodiscard]] bool is_proved() const { return checked.theorem.has_value(); }
  [[nodiscard]] std::string word() const { return is_proved() ? "NO PATH EXISTS" : "UNCHECKED"; }
  [[nodiscard]] std::string headline() const {
    if (!is_proved()) return "The certificate was not checked: " + checked.message + ". Nothing is claimed.";
    return fmt::format(
        "No motion leads from waypoint {} of the query to waypoint {} with every pose of it feasible. "
        "{} cells without a feasible pose part them.",
        from, from + 1, checked.theorem->counts().boxes);
  }
  /// "phi = -2.3, theta = 1.6": SI, rounded.
  [[nodiscard]] std::string waypoint(std::size_t n) const {
    std::string text;
    const auto& coordinates = problem.query.at(n);
    for (std::size_t j = 0; j < coordinates.size(); ++j) {
      text += (j == 0 ? "" : ", ") + problem.space.parameters[j].name + " = " + rounded(coordinates[j]);
    }
    return text;
  }
  /// "x from 0 to 1": SI, likewise.
  [[nodiscard]] std::vector<std::string> space() const {
    std::vector<std::string> lines;
    for (const Parameter& parameter : problem.space.parameters) {
      lines.push_back(parameter.kind == ParameterKind::kRange
                          ? fmt::format("{} from {} to {}; the ends are walls", parameter.name,
                                        rounded(parameter.range_lower), rounded(parameter.range_upper))
                          : parameter.name + ": every value");
    }
    return lines;
  }

  const checker::CheckResult& checked;
  const json& certificate;
  Problem problem;
  std::size_t from;
};

// ---- Picture --------------------------------------------------------------------------------------------------------

constexpr double kWidth = 680, kHeight = 420;

Html rectangle(const MapBox& box, const char* fill) {
  return html("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\"/>\n",
              kWidth * box.lower[0], kHeight * (1 - box.upper[1]), kWidth * (box.upper[0] - box.lower[0]),
              kHeight * (box.upper[1] - box.lower[1]), fill);
}

/// Reads the part of a tree that begins at `node`. @returns what comes behind it
std::size_t draw(const std::string& tree, std::size_t node, const MapBox& box, Html& cells) {
  const char what = tree.at(node++);
  if (what >= '0' && what <= '2') {
    const auto axis = static_cast<std::size_t>(what - '0');
    const double mid = 0.5 * (box.lower.at(axis) + box.upper.at(axis));
    MapBox lower = box, upper = box;
    lower.upper.at(axis) = upper.lower.at(axis) = mid;
    return draw(tree, draw(tree, node, lower, cells), upper, cells);
  }
  if (what != '.') cells += rectangle(box, what <= 'L' ? "#d98200" : "#2f6fb5");
  return node;
}

/// @param is_below  whether the name is below on the left, else above on the right: the two may be close
Html mark(const MapSpace& space, const std::vector<ExpressionText>& waypoint, const std::string& name, bool is_below) {
  const MapBox at = place_of(space, waypoint).front();
  const double x = kWidth * 0.5 * (at.lower[0] + at.upper[0]), y = kHeight * (1 - 0.5 * (at.lower[1] + at.upper[1]));
  return html(
      "<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"5\" fill=\"#a61b14\" stroke=\"#fff\"/><text x=\"{:.2f}\" "
      "y=\"{:.2f}\" text-anchor=\"{}\" fill=\"currentColor\">{}</text>\n",
      x, y, is_below ? std::max(x - 8, 40.0) : std::min(x + 8, kWidth - 40),
      is_below ? std::min(y + 18, kHeight - 4) : std::max(y - 8, 14.0), is_below ? "end" : "start", name);
}

/// "phi from −3.14159 to 3.14159"
std::string extent(const MapAxis& axis) {
  return fmt::format("{} from {} to {}", axis.name, rounded(axis.lower), rounded(axis.upper));
}

Html picture(const Content& content) {
  constexpr std::size_t kMostNodes = 60'000;
  const auto& tree = content.certificate.at("map").at("tree").get_ref<const std::string&>();
  const MapSpace space = make_map_space(content.problem.space);
  if (space.size() != 2 || tree.size() > kMostNodes) return {};
  Html cells;
  draw(tree, 0, MapBox(), cells);
  const Html marks = mark(space, content.problem.query[content.from], "start", true) +
                     mark(space, content.problem.query[content.from + 1], "goal", false);
  return html(
      "<figure><svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"Cells without a feasible pose\">\n<rect x=\"0\" "
      "y=\"0\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"currentColor\"/>\n{}{}</svg>\n<figcaption>Cells that "
      "are proved to hold no feasible pose: blue, tensions can't balance the load; orange, a cable's length is beyond "
      "its limit. {}, from left to right; {}, upward. What is blank did not have to be decided. Rounded for the "
      "picture.</figcaption></figure>\n",
      kWidth, kHeight, kWidth, kHeight, cells, marks, extent(space.axes[0]), extent(space.axes[1]));
}

/// Text that can't contain Markdown's markup, or HTML's.
std::string markdown(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const bool is_mark = std::string_view("\\`*_{}[]()#+-.!|<>&~").find(c) != std::string_view::npos;
    result += is_mark ? std::string("\\") + c : std::string(1, c);
  }
  return result;
}

std::string joined(const std::vector<std::string>& lines, const char* between) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : between) + line;
  return text;
}

/// "Every tension above 0.05 N and below 0.5 N; …": exactly.
std::string limits_text(const RobotText& robot) {
  const auto text = [](const char* what, const std::array<Limits, kCables>& limits, const char* unit) {
    const bool is_one = std::ranges::all_of(
        limits, [&](const Limits& x) { return x.lower == limits[0].lower && x.upper == limits[0].upper; });
    if (!is_one) return fmt::format("the limits of each cable's {} are below", what);
    return fmt::format("every {} above {} {} and below {} {}", what, limits[0].lower, unit, limits[0].upper, unit);
  };
  return text("tension", robot.tension_N, "N") + "; " + text("length", robot.length_m, "m");
}

constexpr const char* kNotSaid =
    "Whether there is a way outside of this space or these ranges, for a lighter load, or for some other machine "
    "within "
    "the tolerances; and whether the numbers are those of the machine.";

/// What there is to say, each under its title.
std::vector<std::pair<std::string, std::string>> rows(const Content& content) {
  const json& certificate = content.certificate;
  std::vector<std::pair<std::string, std::string>> result = {
      {"Case", content.problem.name},
      {"From", fmt::format("waypoint {}: {}", content.from, content.waypoint(content.from))},
      {"To", fmt::format("waypoint {}: {}", content.from + 1, content.waypoint(content.from + 1))},
      {"Space", joined(content.space(), "; ")},
      {"Numbers", "of waypoints and space in metres and radians, rounded; below they are exact"}};
  const LoadStatement load = load_statement(content.problem.load);
  result.emplace_back("Load", with_minus_signs(joined(lines(load), " ")));
  result.emplace_back("Limits", limits_text(content.problem.robot));
  result.emplace_back("Not said", kNotSaid);
  result.emplace_back("Certificate", "SHA-256 " + content.checked.sha256);
  if (content.is_proved()) result.emplace_back("Claim", certificate.at("claim").get<std::string>());
  result.emplace_back("Checked", content.checked.message);
  return result;
}

}  // namespace

bool is_about_no_path(const checker::CheckResult& checked) {
  return checked.certificate && checked.certificate->is_object() &&
         checked.certificate->value("format", json()) == "taut-no-path-certificate";
}

std::string no_path_page(const checker::CheckResult& checked, const ReportOptions& options) {
  const Content content(checked);
  Html table;
  for (const auto& [title, text] : rows(content)) {
    table += html("<div><dt>{}</dt><dd><bdi>{}</bdi></dd></div>\n", title, text);
  }
  const Html number = options.document.empty() ? Html() : html("<p>Document {}</p>\n", options.document);
  const Html revision = options.revision.empty() ? Html() : html("<p>Revision {}</p>\n", options.revision);
  const Html date = options.date.empty() ? Html() : html("<p>{}</p>\n", options.date);
  const Html body = html(
      "<div class=\"masthead\"><p>Proof report for a cable-driven "
      "hexapod</p></div>\n<h1><bdi>{}</bdi></h1>\n{}{}{}<div "
      "class=\"band {}\"><p class=\"word\">{}</p><p class=\"headline\">{}</p></div>\n<dl class=\"scope\">\n{}</dl>\n{}"
      "<h2>Machine, load and space, exact</h2>\n<details><summary>as the certificate states "
      "them</summary>\n<pre>{}</pre></details>\n<h2>Check again</h2>\n<p><code>taut-check "
      "certificate.json CASE --expect 'no path'</code></p>\n",
      content.problem.name, number, revision, date, content.is_proved() ? "refuted" : "unchecked", content.word(),
      content.headline(), table, content.is_proved() ? picture(content) : Html(),
      content.certificate.at("problem").dump(1));
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<meta http-equiv=\"Content-Security-Policy\" "
      "content=\"default-src 'none'; style-src 'unsafe-inline'; img-src data:\">\n<link rel=\"icon\" "
      "href=\"data:,\">\n<title>{}</title>\n<style>{}{}</style>\n</head>\n<body>\n<main>\n{}</main>\n</body>\n</"
      "html>\n",
      html("Motion report: {}", content.word()).str(), kStyle, kFirstPageStyle, body.str());
}

std::string no_path_text(const checker::CheckResult& checked, bool is_markdown) {
  const Content content(checked);
  const auto plain = [&](const std::string& text) { return is_markdown ? markdown(sanitize(text)) : sanitize(text); };
  std::string result = fmt::format("{}{}: {}{}\n", is_markdown ? "# " : "", content.word(), plain(content.headline()),
                                   is_markdown ? "\n" : "");
  for (const auto& [title, text] : rows(content)) {
    result += fmt::format("{}{}: {}\n", is_markdown ? "- " : "", title, plain(text));
  }
  return result;
}

json no_path_json(const checker::CheckResult& checked) {
  const Content content(checked);
  json result = {{"verdict", content.is_proved() ? "no path" : "unchecked"},
                 {"headline", content.headline()},
                 {"case", content.problem.name},
                 {"waypoints", {content.from, content.from + 1}},
                 {"claim", content.is_proved() ? content.certificate.at("claim") : json()},
                 {"cells", content.is_proved() ? json(checked.theorem->counts().boxes) : json()},
                 {"certificate_sha256", checked.sha256},
                 {"message", checked.message}};
  return result;
}

}  // namespace taut
