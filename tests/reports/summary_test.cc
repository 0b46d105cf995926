// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "reports/summary/wording.h"
#include "tests/reports/sample_certificates.h"

namespace taut {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

Summary summary_of(const nlohmann::json& certificate, const ReportOptions& options = {}) {
  return {sample::scene(certificate), options};
}

TEST(Wording, WritesMinusSignsBeforeNumbersOnly) {
  EXPECT_EQ(with_minus_signs("-1 of (-2, -0.5) [-3]"), "−1 of (−2, −0.5) [−3]");
  for (const char* kept :
       {"2026-11-23", "lines 5-6", "1e-09", "robot1-2.csv", "taut-check --path", "- item", "-", ""}) {
    EXPECT_EQ(with_minus_signs(kept), kept);
  }
}

TEST(Summary, SaysTheSameAsTextMarkdownAndJson) {
  for (const nlohmann::json& certificate :
       {sample::proved(), sample::refuted(), sample::singular(), sample::undecided(), sample::no_path()}) {
    const Summary summary = summary_of(certificate, {"LP-17", "C", "2024-02-29"});
    const std::string text = to_text(summary);
    const nlohmann::json json = to_json(summary);
    EXPECT_THAT(text, StartsWith(verdict_in_full(summary) + ": " + summary.headline + "\n"));
    EXPECT_THAT(text, HasSubstr("\nLP-17, revision C, 2024-02-29: Robot1 slice (as the case says, not checked)\n"));
    EXPECT_THAT(text, HasSubstr(summary.word + ": " + summary.headline + "\n"));
    EXPECT_EQ(json["word"], summary.word);
    EXPECT_EQ(json["headline"], summary.headline);
    ASSERT_EQ(json["key_numbers"].size(), summary.key_numbers.size());
    for (const KeyNumber& number : summary.key_numbers) {
      EXPECT_THAT(text, HasSubstr(number.title + ": " + number.value + " (" + number.detail + ")"));
    }
    EXPECT_EQ(json["verdict"], certificate["verdict"]);
    EXPECT_EQ(json["document"], "LP-17");
    for (const Statement& statement : summary.statements) {
      EXPECT_THAT(text, HasSubstr(statement.text));
      EXPECT_EQ(json["statements"][statement.key], statement.text);
    }
    EXPECT_THAT(to_markdown(summary),
                HasSubstr("| Not covered | Collisions of cables, platform, load and surroundings."));
  }
}

TEST(Summary, ShowsWhatTheCaseStatesForTheHeadOfADocument) {
  nlohmann::json certificate = sample::proved();
  certificate["illustration"]["document_fields"] = {{"title", "Turn in place"}, {"machine", "Portal 2"},
                                                    {"site", "Hall B"},         {"load_name", "container"},
                                                    {"document", "LP-3"},       {"prepared_by", "A. Niemi"}};
  const Summary summary = summary_of(certificate);
  EXPECT_EQ(summary.title, "Turn in place");
  const nlohmann::json json = to_json(summary);
  EXPECT_EQ(json["title"], "Turn in place");
  EXPECT_EQ(json["machine"], "Portal 2");
  EXPECT_EQ(json["site"], "Hall B");
  EXPECT_EQ(json["load_name"], "container");
  EXPECT_EQ(json["prepared_by"], "A. Niemi");
  EXPECT_EQ(json["document"], "LP-3");
  EXPECT_EQ(to_json(summary_of(certificate, {"LP-17", "", ""}))["document"], "LP-17") << "what is asked for wins";
}

TEST(Summary, MakesATitleOfTheNameWhereTheCaseStatesNone) {
  const nlohmann::json json = to_json(summary_of(sample::proved()));
  EXPECT_EQ(json["title"], "Robot1 slice");
  EXPECT_EQ(json["machine"], nullptr);
  EXPECT_THAT(json["document"].get<std::string>(), StartsWith("TAUT-"));
  EXPECT_EQ(title_from_name("portal_20t-gust"), "Portal 20t gust");
  EXPECT_EQ(title_from_name("lift no-2 b_3"), "Lift no-2 b_3") << "that is no slug";
  EXPECT_EQ(title_from_name(""), "");
}

TEST(Summary, TakesNoFieldThatACaseCouldNotState) {
  for (const nlohmann::json& fields :
       {nlohmann::json(7), nlohmann::json{{"title", 7}, {"document", nullptr}},
        nlohmann::json{{"title", "a\u202Eb"}, {"document", "\";}"}}, nlohmann::json{{"title", std::string(121, 'x')}},
        nlohmann::json{{"title", "a\nb"}, {"document", std::string(41, 'x')}}}) {
    nlohmann::json certificate = sample::proved();
    certificate["illustration"]["document_fields"] = fields;
    const Summary summary = summary_of(certificate);
    EXPECT_EQ(summary.title, "Robot1 slice") << fields;
    EXPECT_THAT(summary.document, StartsWith("TAUT-")) << fields;
  }
}

TEST(Summary, RoundsProvedRangesOutward) {
  const nlohmann::json json = to_json(summary_of(sample::proved()));
  EXPECT_EQ(json["cables_source"], "proved");
  const nlohmann::json& tension = json["cables"][2]["tension_N"];
  EXPECT_THAT(to_text(summary_of(sample::proved())), HasSubstr("      3              0.101       0.12 "));
  EXPECT_GE(tension["least"], 0.1016);
  EXPECT_LE(tension["greatest"], 0.12);
  EXPECT_EQ(tension["upper_limit"], 0.5);
}

TEST(Summary, NamesCodesOfReasonsOnlyWhereTheProofIs) {
  nlohmann::json certificate = sample::undecided();
  certificate["undecided"]["reason"] = "the force Jacobian is singular or nearly so";
  const Summary summary = summary_of(certificate);
  for (const std::string& sentence : summary.details) EXPECT_THAT(sentence, Not(HasSubstr("[U")));
  const auto proof = std::ranges::find(summary.statements, std::string_view("proof"), &Statement::key);
  EXPECT_THAT(proof->text, HasSubstr("taut explain U5"));
}

TEST(Summary, SaysTheLimitsOfEachCableWithoutATable) {
  nlohmann::json certificate = sample::proved();
  certificate["problem"]["robot"]["tension_N"][3][1] = "50";
  const std::string text = to_text(summary_of(certificate));
  EXPECT_THAT(text, HasSubstr("Every tension above 0.05 N and below 0.5 N (cables 1, 2, 3, 5 and 6), above 0.05 N and "
                              "below 50 N (cable 4); every cable length above 100 mm and below 550 mm."));
  EXPECT_THAT(text, Not(HasSubstr("table")));
}

TEST(Summary, RepeatsNothingOfAnUncheckedCertificate) {
  for (const nlohmann::json& certificate :
       {sample::proved(), sample::refuted(), sample::singular(), sample::undecided()}) {
    const Summary summary(sample::unchecked(certificate), {});
    EXPECT_EQ(summary.verdict, "unchecked");
    EXPECT_THAT(to_text(summary), HasSubstr("UNCHECKED: Whether this certificate is right is not known"));
    EXPECT_THAT(to_text(summary), HasSubstr("so <it> is"));
    for (const char* claim :
         {"PROVED", "Refuted:", "Undecided:", "× 2.71", "0.0425", "0.8123", "the determinant may"}) {
      EXPECT_THAT(to_text(summary), Not(HasSubstr(claim)));
    }
    EXPECT_NE(to_json(summary)["cables_source"], "proved");
    EXPECT_EQ(to_json(summary)["recheck"]["result"], "unchecked");
  }
}

TEST(Summary, MakesNoMarkupOfWhatACertificateSays) {
  nlohmann::json certificate = sample::undecided();
  certificate["problem"]["name"] = "a\n# b [x](http://c) <img src=x> | **d** `e` www.f.g";
  certificate["undecided"]["reason"] = sample::kAttack;
  const std::string markdown = to_markdown(summary_of(certificate));
  EXPECT_THAT(markdown, StartsWith("## A"));
  EXPECT_THAT(markdown, HasSubstr(R"(\# b \[x\](http&#58;//c) &#60;img src=x&#62; \| \*\*d\*\* \`e\` &#119;ww.f.g)"));
  EXPECT_THAT(markdown, Not(HasSubstr("<script")));
  EXPECT_THAT(markdown, Not(HasSubstr("\n# b")));
  EXPECT_THAT(to_text(summary_of(certificate)), Not(HasSubstr("\n# b"))) << "names have no lines of their own";
}

TEST(DocumentNumber, IsMadeFromADigestOnly) {
  EXPECT_EQ(document_number("0123456789ab" + std::string(52, 'c')), "TAUT-0123-4567-89AB");
  EXPECT_EQ(document_number(std::string(63, 'a')), "");
  EXPECT_EQ(document_number(std::string(64, 'g')), "");
  EXPECT_EQ(document_number(sample::kAttack), "");
}

}  // namespace
}  // namespace taut
