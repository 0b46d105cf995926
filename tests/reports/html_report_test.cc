// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/html_report.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/evp.h>
#include <openssl/sha.h>

#include <array>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/input_error.h"
#include "tests/reports/sample_certificates.h"

namespace taut {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Whether each element is closed in the order it was opened; the first mistake in words. Quotes attributes as the
/// report does, always.
std::string imbalance(const std::string& page) {
  static const std::set<std::string> kVoid = {"meta", "link", "!DOCTYPE"};
  std::vector<std::string> open;
  for (std::size_t i = page.find('<'); i != std::string::npos; i = page.find('<', i)) {
    std::size_t end = i;
    bool quoted = false;
    while (end < page.size() && (quoted || page[end] != '>')) quoted ^= page[end++] == '"';
    const std::string tag = page.substr(i + 1, end - i - 1);
    const std::string name = tag.substr(0, tag.find_first_of(" /", 1));
    if (tag.front() == '/') {
      if (open.empty() || open.back() != tag.substr(1)) {
        return "</" + tag.substr(1) + "> closes " + (open.empty() ? "nothing" : open.back());
      }
      open.pop_back();
    } else if (tag.back() != '/' && !kVoid.contains(name)) {
      open.push_back(name);
    }
    i = end;
  }
  return open.empty() ? "" : open.back() + " is never closed";
}

/// What stands in tags, without the words and attribute values between them: where markup would do harm.
std::string tags_only(const std::string& page) {
  std::string result;
  bool inside = false;
  bool quoted = false;
  for (const char c : page) {
    if (!inside && c == '<') inside = true;
    if (inside && c == '"') quoted = !quoted;
    if (inside && !quoted) result += c;
    if (inside && !quoted && c == '>') inside = false;
  }
  return result;
}

/// The page without what stands in its script elements; there have to be two, the data and the script.
std::string report(const nlohmann::json& certificate, const ReportOptions& options = {}) {
  std::string page = html_report(sample::scene(certificate), options);
  std::size_t scripts = 0;
  for (std::size_t begin = page.find("<script"); begin != std::string::npos; begin = page.find("<script", begin + 1)) {
    ++scripts;
    const std::size_t inside = page.find('>', begin) + 1;
    page.erase(inside, page.find("</script>", inside) - inside);
  }
  if (scripts != 2) throw std::logic_error(fmt::format("{} script elements", scripts));
  return page;
}

/// {what it is, the page}
const std::vector<std::pair<std::string, std::string>>& pages() {
  static const std::vector<std::pair<std::string, std::string>> kPages = {
      {"proved", report(sample::proved())},     {"refuted", report(sample::refuted())},
      {"singular", report(sample::singular())}, {"undecided", report(sample::undecided())},
      {"no path", report(sample::no_path())},   {"hostile", report(sample::hostile())}};
  return kPages;
}

const std::string& page_of(const std::string& name) {
  for (const auto& [candidate, page] : pages()) {
    if (candidate == name) return page;
  }
  throw std::out_of_range(name);
}

ReportOptions named(const std::string& document, const std::string& revision, const std::string& date) {
  return {document, revision, date};
}

TEST(HtmlReport, SaysWhatWasProvedAndHowClose) {
  const std::string& page = page_of("proved");
  EXPECT_THAT(
      page,
      HasSubstr("Everywhere on this move, for every load in the stated set, no cable goes slack, none exceeds its"));
  EXPECT_THAT(
      page, HasSubstr("Every tension above 0.05 N and below 0.5 N; every cable length above 100 mm and below 550 mm."));
  EXPECT_THAT(page, HasSubstr("2 segments"));
  EXPECT_THAT(page, HasSubstr("3 boxes in 2 segments"));
  EXPECT_THAT(page, HasSubstr("<dd class=\"value\">Cable 3: +103 %</dd>"));
  EXPECT_THAT(page, HasSubstr("<dd class=\"value\">Cable 5: 10.6 mm</dd>"));
  EXPECT_THAT(page, HasSubstr("<dd class=\"value\">× 2.71</dd>"));
}

TEST(HtmlReport, OpensWithASheetToSign) {
  for (const auto& [name, page] : pages()) {
    for (const char* text :
         {"<span>Prepared</span>", "<span>Checked</span>", "<b>By signing</b>", "<dt>Move</dt>", "<dt>Load</dt>",
          "<dt>Limits</dt>", "<dt>Tolerances</dt>", "class=\"uncovered\"", "Collisions: <b>not checked</b>"}) {
      EXPECT_THAT(page, HasSubstr(text)) << name;
    }
  }
  EXPECT_THAT(page_of("proved"), HasSubstr("<bdi>TAUT-CCCC-CCCC-CCCC</bdi>"));
  EXPECT_THAT(page_of("proved"),
              HasSubstr("a force of 1 N along +z and no moment about the load point (30, 14, -21) mm"));
  EXPECT_THAT(page_of("proved"),
              HasSubstr("each component of the force by up to 0.01 N, each component of the moment by up to 0.001 N·m; "
                        "each alone up to this, together only inside the ellipsoid"));
}

TEST(HtmlReport, PrintsWhatItIsToldOfTheDocument) {
  const std::string page = report(sample::proved(), named("LP-17/4", "B", "2024-02-29"));
  EXPECT_THAT(page, HasSubstr("<dd><bdi>LP-17/4</bdi></dd>"));
  EXPECT_THAT(page, HasSubstr("<dd><bdi>B</bdi></dd>"));
  EXPECT_THAT(page, HasSubstr("<dd><bdi>2024-02-29</bdi></dd>"));
  EXPECT_THAT(page, HasSubstr("@top-left { content: \"Robot1 slice\"; }"));
  EXPECT_THAT(page, HasSubstr("@top-right { content: \"PROVED · LP-17/4 · revision B\"; }"));
  EXPECT_THAT(page, HasSubstr("@bottom-left { content: \"2024-02-29\"; }"));
  for (const std::string& bad : {std::string("\"; } body { display: none"), std::string("a\\b"), std::string("a\nb"),
                                 std::string(41, 'x'), std::string(sample::kAttack)}) {
    EXPECT_THROW((void)report(sample::proved(), named(bad, "", "")), InputError) << bad;
    EXPECT_THROW((void)report(sample::proved(), named("", bad, "")), InputError) << bad;
    EXPECT_THROW((void)report(sample::proved(), named("", "", bad)), InputError) << bad;
  }
}

TEST(HtmlReport, HeadsPrintedPagesWithTheVerdict) {
  for (const auto& [name, word] : std::vector<std::pair<std::string, std::string>>{{"proved", "PROVED"},
                                                                                   {"refuted", "DO NOT RUN"},
                                                                                   {"undecided", "NO DECISION"},
                                                                                   {"no path", "NO PATH FOUND"}}) {
    EXPECT_THAT(page_of(name), HasSubstr(fmt::format("content: \"{} · TAUT-CCCC-CCCC-CCCC\"", word))) << name;
  }
  EXPECT_THAT(html_report(sample::unchecked(sample::proved())), HasSubstr("content: \"UNCHECKED · TAUT-"));
  // The case's name may hold anything; here it tries to end the string, the rule and the style sheet.
  nlohmann::json certificate = sample::proved();
  certificate["problem"]["name"] = "a\"; } </style>\\\n& é";
  EXPECT_THAT(report(certificate),
              HasSubstr("@top-left { content: \"A\\22 ; } \\3c /style\\3e \\5c \\5c x0a\\26  é\"; }"));
}

TEST(HtmlReport, BringsItsTypeface) {
  const std::string& page = page_of("proved");
  EXPECT_THAT(page, HasSubstr("font-src data:; "));
  EXPECT_THAT(page,
              HasSubstr("@font-face { font-family: \"Inter\"; font-weight: 400 700; src: url(data:font/woff2;base64,"));
  EXPECT_THAT(page, HasSubstr("The Inter Project Authors"));
  EXPECT_THAT(page, HasSubstr("SIL OPEN FONT LICENSE Version 1.1"));
}

TEST(HtmlReport, SaysFirstWhatIsReadFirst) {
  nlohmann::json certificate = sample::proved();
  certificate["illustration"]["units"] = {{"length", "mm"}};
  const std::string page = report(certificate);
  std::size_t last = 0;
  for (const char* id : {"move", "pose", "tensions", "lengths", "plane", "robot", "assumptions", "path", "theorem",
                         "margins", "exact-load", "space", "exact-path", "exact-margins", "inputs", "recheck"}) {
    const std::size_t at = page.find(fmt::format("<section id=\"{}\">", id));
    ASSERT_NE(at, std::string::npos) << id;
    EXPECT_LT(last, at) << id;
    last = at;
  }
  const std::size_t appendix = page.find("<div class=\"appendix\" id=\"appendix\">");
  EXPECT_LT(page.find("<section id=\"margins\">"), appendix);
  EXPECT_LT(appendix, page.find("<section id=\"exact-load\">"));
  // All digits are in the appendix alone.
  for (const char* exact : {"4.25e-02", "2.71e+00", "10000</td>"}) EXPECT_LT(appendix, page.find(exact)) << exact;
  // Before it they are in the case's units: 1.061e-02 m.
  EXPECT_THAT(page.substr(0, appendix), HasSubstr("<td class=\"n\"><b>0.0425</b></td><td class=\"n\">12.3</td>"));
}

TEST(HtmlReport, SaysWhatTheCheckerFound) {
  EXPECT_THAT(page_of("proved"), HasSubstr("taut-check 9.9, an independent program with other arithmetic, accepted"));
  EXPECT_THAT(page_of("proved"), HasSubstr("so &lt;it&gt; is"));
  EXPECT_THAT(page_of("proved"), Not(HasSubstr("UNCHECKED")));
  EXPECT_THAT(page_of("undecided"), HasSubstr("it claims nothing"));
}

TEST(HtmlReport, RepeatsNothingOfAnUncheckedCertificate) {
  const std::string page = html_report(sample::unchecked(sample::proved()));
  EXPECT_THAT(page, AllOf(HasSubstr("<div class=\"band unchecked\">"), HasSubstr("UNCHECKED</p>")));
  EXPECT_THAT(page, HasSubstr("taut-check 9.9: so &lt;it&gt; is."));
  EXPECT_THAT(page, HasSubstr("<title>Motion report: unchecked</title>"));
  for (const char* claim : {"PROVED", "× 2.71", "4.25e-02", "5.11e-02", "word by word"}) {
    EXPECT_THAT(page, Not(HasSubstr(claim)));
  }
  for (const char* id : {"margins", "margins-along", "theorem", "stretches", "tolerances", "tolerances-used",
                         "exact-margins", "exact-stretches"}) {
    EXPECT_THAT(page, Not(HasSubstr(fmt::format("<section id=\"{}\">", id))));
  }
}

TEST(HtmlReport, MarksFreeTextAsNotChecked) {
  nlohmann::json certificate = sample::proved();
  certificate["generator"] = {{"name", "Approved by"}, {"version", "nobody"}};
  certificate["illustration"]["stats"] = {{"certified", "by nobody"}};
  const std::string page = report(certificate);
  EXPECT_THAT(
      page, HasSubstr("<h1><bdi>Robot1 slice</bdi></h1>\n<p class=\"note unverified\">Title and names are text of the "
                      "case, which nothing checks.</p>"));
  EXPECT_THAT(page, HasSubstr("made by (not checked)</td><td><bdi>Approved by nobody</bdi>"));
  EXPECT_THAT(page, HasSubstr("as the program that wrote the certificate says (not checked): certified: by nobody"));
  const std::string first_page = page.substr(0, page.find("</header>"));
  EXPECT_THAT(first_page, Not(HasSubstr("by nobody")));
}

TEST(HtmlReport, PrintsClaimAndDigestsAsTheCertificateStatesThem) {
  const std::string& page = page_of("proved");
  EXPECT_THAT(page, HasSubstr("The claim of this certificate, word by word: f_lo,i &lt; f_i &lt; f_hi,i."));
  EXPECT_THAT(page, HasSubstr(sample::kProblemDigest));
  EXPECT_THAT(page, HasSubstr(sample::kPathDigest));
  EXPECT_THAT(page, HasSubstr(sample::kFooterDigest));
  EXPECT_THAT(page, HasSubstr("taut 0.1.0"));
}

TEST(HtmlReport, StatesTheSetOfLoadsThatIsMeant) {
  EXPECT_THAT(page_of("proved"), AllOf(HasSubstr("E (w − w<sub>0</sub>) ≤ 1"), HasSubstr("v<sub>i</sub> = √(B")));
  nlohmann::json certificate = sample::proved();
  auto& load = certificate["problem"]["load"];
  load["items"] = nlohmann::json::parse(R"([
      {"name": "block", "weight": {"mass_kg": ["0.1", "0.1"], "at_m": ["0", "0", "0"], "at_tolerance_m": "0"}},
      {"name": "push", "force": {"ball": {"radius": "0.01"}, "axes": "W", "at_m": ["0", "0", "0"]}}])");
  load["gravity_m_s2"] = {"0", "0", "9.81"};
  load["wrench"] = {"0", "0", "0", "0", "0", "0"};
  const std::string with_ellipsoid = html_report(sample::scene(certificate), {});
  EXPECT_THAT(with_ellipsoid,
              AllOf(HasSubstr("K<sub>1</sub> + … + K<sub>2</sub>"), HasSubstr("E (w − w<sub>0</sub>)"),
                    HasSubstr("<sub>w ∈ K</sub> (J<sup>−1</sup> w)<sub>i</sub>"), Not(HasSubstr("v<sub>i</sub>"))));
  load.erase("ellipsoid");
  load.erase("wrench");
  EXPECT_THAT(html_report(sample::scene(certificate), {}),
              AllOf(HasSubstr("K<sub>1</sub> + … + K<sub>2</sub>"), Not(HasSubstr("w<sub>0</sub>"))));
}

TEST(HtmlReport, PrintsExactNumbersOfRobotAndPath) {
  const std::string& page = page_of("proved");
  EXPECT_THAT(page, HasSubstr("(-190.5256, -110, 0)"));
  EXPECT_THAT(page, HasSubstr("<td class=\"n\">-2.3</td><td class=\"n\">1.6</td>"));
  EXPECT_THAT(page, HasSubstr(" − 2π</td>")) << "half turns are written out";
  EXPECT_THAT(page, HasSubstr("sigma0*pi/180"));
  EXPECT_THAT(page, HasSubstr("<td class=\"n\"><b>4.25e-02</b></td>")) << "margins stay the certificate's strings";
}

TEST(HtmlReport, SaysThatAWitnessDeviates) {
  nlohmann::json certificate = sample::refuted();
  EXPECT_THAT(report(certificate), Not(HasSubstr("deviates")));
  const std::vector<std::string> none(3, "0");
  const std::vector<std::vector<std::string>> no_anchors(6, none);
  certificate["witness"]["deviation"] = {{"base_anchors_m", no_anchors}, {"platform_anchors_m", no_anchors},
                                         {"load_point_m", none},         {"wrench", "0"},
                                         {"position_m", none},           {"turn", none}};
  EXPECT_THAT(report(certificate),
              HasSubstr("the tension of cable 3, on a machine that deviates within the tolerances, "
                        "reaches at least 0.812 N"));
  EXPECT_THAT(report(certificate), Not(HasSubstr("the lengths of its cables lead")));
  certificate["witness"]["deviation"]["cable_lengths_m"] = {"0", "0", "0", "0", "0", "0.001"};
  certificate["witness"]["deviation"]["way"] = nullptr;
  EXPECT_THAT(report(certificate),
              HasSubstr("it deviates within the tolerances, as the certificate says, and it is at the "
                        "pose to which that and the lengths of its cables lead from this one."));
}

TEST(HtmlReport, ClaimsNothingOfThePathWhereBoxesAreMissing) {
  nlohmann::json certificate = sample::proved();
  certificate["segments"][0]["boxes"].erase(0);
  const std::string page = report(certificate);
  EXPECT_THAT(page, HasSubstr("Cables over those parts of the move that are proved"));
  EXPECT_THAT(page, Not(HasSubstr("class=\"tiles\"")));
}

TEST(HtmlReport, SaysWhereARefutedMotionFails) {
  const std::string& page = page_of("refuted");
  EXPECT_THAT(
      page,
      HasSubstr("Refuted: on this move the tension of cable 3 reaches at least 0.812 N, not below its upper limit of "
                "0.5 N, under a load of the stated set."));
  EXPECT_THAT(page, HasSubstr("beyond the limit by at least 0.312 N, 62 % of it."));
  EXPECT_THAT(page, HasSubstr("of turning (segment 1). The pose there, rounded: p = (0, 0, 350) mm"));
  EXPECT_THAT(page, HasSubstr("in floating-point samples: not proved")) << "no box is proved";
  EXPECT_THAT(page, Not(HasSubstr("PROVED")));
  EXPECT_THAT(page, HasSubstr("<b><bdi>Cable 3</bdi></b> above its top tension</td>"
                              "<td>at least 0.812 N; limit 0.5 N</td>"));
  EXPECT_THAT(page, Not(HasSubstr("id=\"margins\"")));
}

TEST(HtmlReport, ListsTheStretchesOfAnAudit) {
  nlohmann::json certificate = sample::refuted();
  const nlohmann::json witness = certificate["witness"];
  certificate["stretches"] = {{{"outer", {{{"segment", 0}, {"s", "1/4"}}, {{"segment", 0}, {"s", "1"}}}},
                               {"inner", {witness, witness}},
                               {"reason", nullptr}},
                              {{"outer", {{{"segment", 1}, {"s", "0"}}, {{"segment", 1}, {"s", "1/2"}}}},
                               {"inner", nullptr},
                               {"reason", "nobody knows"}}};
  const std::string without_boxes = report(certificate);
  EXPECT_THAT(without_boxes, HasSubstr("No part of the path is proved"));
  EXPECT_THAT(without_boxes, Not(HasSubstr("Outside of these stretches")));
  certificate["segments"] = sample::proved()["segments"];
  certificate["segments"][0]["boxes"] = nlohmann::json::parse(R"([{"bits": 64, "s": ["0", "1/4"]}])");
  certificate["segments"][1]["boxes"] = nlohmann::json::parse(R"([{"bits": 64, "s": ["1/2", "1"]}])");
  const std::string page = report(certificate);
  EXPECT_THAT(page, HasSubstr("<td>0, 1/4</td><td>1, 3/8</td><td>1, 3/8</td><td>0, 1</td>")) << "exact, segment and s";
  EXPECT_THAT(page,
              HasSubstr("In all, 1 stretch of the path has proved violations, and 1 stretch could not be decided"));
  EXPECT_THAT(page, HasSubstr("Outside of these stretches the path is proved"));
  EXPECT_THAT(page, HasSubstr("open: nobody knows"));
  EXPECT_EQ(imbalance(page), "");
}

TEST(HtmlReport, SaysBetweenWhichPosesASingularOneLies) {
  const std::string& page = page_of("singular");
  EXPECT_THAT(page, HasSubstr("Refuted: on this move the platform passes a singular pose"));
  EXPECT_THAT(page,
              HasSubstr("opposite signs: at the start of the move (segment 0), p = (0, 0, 350) mm, φ = −131.78°"));
}

TEST(HtmlReport, RefutesByALengthInMillimetres) {
  nlohmann::json certificate = sample::refuted();
  certificate["witness"]["kind"] = "length_min";
  certificate["witness"]["value"] = {"0.0991", "0.0992"};
  certificate["witness"]["limit"] = "0.1";
  EXPECT_THAT(report(certificate),
              HasSubstr("the length of cable 3 falls to at most 99.2 mm, not above its lower limit of 100 mm."));
}

TEST(HtmlReport, SaysWhatIsOpen) {
  const std::string& page = page_of("undecided");
  EXPECT_THAT(page, HasSubstr("Undecided: this move was neither proved nor refuted, so nothing is claimed about it."));
  EXPECT_THAT(page, HasSubstr("What is open: the determinant may vanish"));
  EXPECT_THAT(page, HasSubstr("segment 1, between waypoints 1 and 2, from s = 1/4 to s = 3/8."));
  EXPECT_THAT(page, HasSubstr("What is open begins after "));
  EXPECT_THAT(page_of("no path"), HasSubstr("What is open: no path was found"));
}

TEST(HtmlReport, IsBalancedMarkup) {
  for (const auto& [name, page] : pages()) EXPECT_EQ(imbalance(page), "") << name;
  EXPECT_NE(imbalance("<p><b></p></b>"), "");
  EXPECT_NE(imbalance("<p>"), "");
}

TEST(HtmlReport, NeedsNoNetwork) {
  for (const auto& [name, page] : pages()) {
    const std::size_t licence = page.find("/*!");
    const std::string rest = page.substr(0, licence) + page.substr(page.find("*/", licence));
    EXPECT_THAT(rest, Not(HasSubstr("http://"))) << name;
    EXPECT_THAT(rest, Not(HasSubstr("https://"))) << name;
    EXPECT_THAT(rest, Not(HasSubstr("@import"))) << name;
    for (std::size_t at = rest.find("url("); at != std::string::npos; at = rest.find("url(", at + 1)) {
      EXPECT_EQ(rest.substr(at, 26), "url(data:font/woff2;base64") << name;
    }
    EXPECT_THAT(tags_only(page), Not(HasSubstr("src="))) << name;
  }
}

TEST(HtmlReport, EscapesEveryStringOfTheCertificate) {
  const std::string& page = page_of("hostile");
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_THAT(page, Not(HasSubstr(sample::kAttack)));
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;alert(1)&lt;/script&gt;")) << "it is shown, not dropped";
  nlohmann::json undecided = sample::undecided();
  undecided["undecided"]["reason"] = sample::kAttack;
  EXPECT_THAT(report(undecided), Not(HasSubstr("<img")));
}

TEST(HtmlReport, AllowsItsOwnScriptAndNoOther) {
  const std::string page = html_report(sample::scene(sample::hostile()));
  const std::size_t begin = page.rfind("<script>") + std::string("<script>").size();
  const std::string script = page.substr(begin, page.rfind("</script>") - begin);
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
  SHA256(reinterpret_cast<const unsigned char*>(script.data()), script.size(), digest.data());
  std::array<unsigned char, 64> base64{};
  EVP_EncodeBlock(base64.data(), digest.data(), digest.size());
  EXPECT_THAT(report(sample::hostile()),
              HasSubstr(fmt::format("script-src 'sha256-{}';", reinterpret_cast<const char*>(base64.data()))));
}

TEST(HtmlReport, RejectsAMalformedCertificate) {
  const auto without = [](const char* key) {
    nlohmann::json certificate = sample::proved();
    certificate.erase(key);
    return certificate;
  };
  for (const char* key : {"verdict", "claim", "problem", "path", "segments", "margins", "footer", "format"}) {
    EXPECT_THROW((void)report(without(key)), InputError) << key;
  }
  nlohmann::json certificate = sample::proved();
  certificate["path"]["waypoints"][0]["x"][0] = "nan";
  EXPECT_THROW((void)report(certificate), InputError);
  certificate = sample::proved();
  certificate["path"]["waypoints"][0]["x"].push_back("0");
  EXPECT_THROW((void)report(certificate), InputError);
  certificate = sample::refuted();
  certificate["witness"]["at"]["segment"] = 2;
  EXPECT_THROW((void)report(certificate), InputError);
  certificate = sample::refuted();
  certificate["witness"]["cable"] = 7;
  EXPECT_THROW((void)report(certificate), InputError);
  certificate = sample::proved();
  certificate["margins"]["tension_N"] = "much";
  EXPECT_THROW((void)report(certificate), InputError);
  EXPECT_THROW((void)report(nlohmann::json::array()), InputError);
}

TEST(HtmlReport, DoesWithoutAnIllustration) {
  nlohmann::json certificate = sample::proved();
  certificate.erase("illustration");
  EXPECT_THAT(report(certificate), HasSubstr("id=\"plane\""));
  certificate["illustration"] = nlohmann::json::object();
  EXPECT_THAT(report(certificate), HasSubstr("id=\"plane\""));
  certificate["illustration"] = {{"charts", {{{"c", {"1", "2", "3"}}, {"p", nlohmann::json::array()}}}}};
  EXPECT_NO_THROW((void)report(certificate));
}

TEST(HtmlReport, StaysSmallForLongPathsAndLargeAtlases) {
  nlohmann::json certificate = sample::proved();
  const nlohmann::json waypoint = certificate["path"]["waypoints"][0];
  const nlohmann::json segment = certificate["segments"][0];
  for (int k = 2; k < 50; ++k) {
    certificate["path"]["waypoints"].push_back(waypoint);
    certificate["segments"].push_back(segment);
    certificate["segments"].back()["from"] = k;
    certificate["segments"].back()["to"] = k + 1;
  }
  const nlohmann::json chart = certificate["illustration"]["charts"][0];
  for (int k = 0; k < 500; ++k) certificate["illustration"]["charts"].push_back(chart);
  EXPECT_LT(html_report(sample::scene(certificate)).size(), 2'000'000u);
}

TEST(HtmlReport, SurvivesAbsurdNumbers) {
  nlohmann::json certificate = sample::proved();
  certificate["path"]["waypoints"][1]["x"] = {"0x1p+1023", "-0x1p+1023"};
  certificate["illustration"]["charts"][0]["c"] = {"1e300", "-1e300"};
  certificate["path"]["waypoints"][2]["half_turns"] = {1000000, 0};
  const std::string page = report(certificate);
  EXPECT_EQ(imbalance(page), "");
  EXPECT_LT(page.size(), 1'000'000u);
}

TEST(HtmlReport, ShowsLongPathsInBlocks) {
  nlohmann::json certificate = sample::proved();
  const nlohmann::json waypoint = certificate["path"]["waypoints"][1];
  const nlohmann::json segment = certificate["segments"][1];
  for (int k = 3; k <= 1000; ++k) {
    certificate["path"]["waypoints"].push_back(waypoint);
    certificate["segments"].push_back(segment);
    certificate["segments"].back()["from"] = k - 1;
    certificate["segments"].back()["to"] = k;
  }
  certificate["segments"][777]["margins"]["wrench_scale"] = "1.01e+00";
  certificate["margins"]["wrench_scale"] = "1.01e+00";
  const std::string page = report(certificate);
  EXPECT_THAT(page, HasSubstr("The certificate has all 1000 segments."));
  EXPECT_THAT(page, HasSubstr("775 – 799</td>"));
  EXPECT_THAT(page, HasSubstr("<td class=\"n\">777</td>")) << "among those with the least";
  EXPECT_THAT(page, Not(HasSubstr("<td class=\"n\">771</td>")));
  EXPECT_THAT(page, HasSubstr("Every 26th of them is shown"));
  EXPECT_THAT(page, HasSubstr("Every 11th of them is shown; the certificate and path.csv have all."));
  EXPECT_LT(page.size(), 1'500'000u);
  EXPECT_EQ(imbalance(page), "");
}

TEST(HtmlReport, DrawsNoPlaneForThreeParameters) {
  nlohmann::json certificate = sample::proved();
  certificate["problem"]["space"]["parameters"].push_back(
      {{"name", "z"}, {"kind", "range"}, {"range", {"0.3", "0.4"}}});
  certificate["problem"]["space"]["pose"]["pz"] = "z";
  for (auto& waypoint : certificate["problem"]["query"]["waypoints"]) waypoint.push_back("0.35");
  for (auto& waypoint : certificate["path"]["waypoints"]) {
    waypoint["x"].push_back("0x1.6666666666666p-2");
    waypoint["half_turns"].push_back(0);
  }
  const std::string page = report(certificate);
  EXPECT_THAT(page, Not(HasSubstr("id=\"plane\"")));
  EXPECT_THAT(page, HasSubstr("<code>z</code> [m]"));
  EXPECT_EQ(imbalance(page), "");
}

}  // namespace
}  // namespace taut
