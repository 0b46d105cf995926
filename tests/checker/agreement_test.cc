// SPDX-License-Identifier: GPL-3.0-or-later
// Prover and checker, each held against the other: what one proves the other confirms.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "base/input_error.h"
#include "certificate/certificate_reader.h"
#include "certificate/certificate_writer.h"
#include "certificate/elaborate.h"
#include "certify/path_proof.h"
#include "checker/check.h"
#include "kinematics/constraint_functions.h"
#include "tests/checker/fixtures.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

using checker::CheckResult;
using checker::Outcome;
using nlohmann::json;

std::vector<ExpressionText> typed(const Waypoint& waypoint) {
  std::vector<ExpressionText> result;
  for (const double x : waypoint.parameters().x) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", x);
    result.push_back(text);
  }
  return result;
}

/// The query is made to fit the path, so that only the path is judged.
CheckResult check(Problem problem, const Path& path, const PathProof& proof) {
  if (!has_poses(path.interpolation)) problem.query = {typed(path.waypoints.front()), typed(path.waypoints.back())};
  return checker::check(certificate_text(elaborate(problem, path, proof)));
}

bool has_half_turns(const Path& path) {
  return std::ranges::any_of(path.waypoints, [](const Waypoint& waypoint) {
    const auto* const point = std::get_if<ParameterPoint>(&waypoint.point());
    return point != nullptr && std::ranges::any_of(point->half_turns, [](int n) { return n % 2 != 0; });
  });
}

TEST(Agreement, OnEveryPathOfTheCertificatesOfTheTests) {
  int read = 0;
  int decided = 0;
  std::set<std::string> judged;  // what they are about: many differ only in their proofs
  for (const char* folder : {"accepted", "rejected"}) {
    for (const auto& file : checker::certificates(folder)) {
      SCOPED_TRACE(file);
      // The checker can tell what the prover leaves open: towers of powers times 0, and a zero at the very end of its
      // tube.
      const std::string name = file.stem();
      if (name.starts_with("attack_tower") || name == "implied_zero_at_the_end_of_the_tube") continue;
      const json certificate = json::parse(checker::read_text(file));
      if (certificate.contains("legs")) continue;  // each is a certificate of its own
      json motion = certificate["path"];
      if (motion.is_object()) motion.erase("directions");
      if (!judged.insert(certificate["problem"].dump() + motion.dump()).second) continue;
      try {
        const Problem problem = problem_from_json(certificate["problem"]);
        const Path path = read_path(certificate["path"]);
        ++read;
        const PathProof proof = prove_path(Prover(problem, {.max_boxes = 5000, .max_multiprecision_boxes = 500}), path);
        if (std::string(folder) == "accepted") {
          EXPECT_NE(proof.verdict, Verdict::kUndecided) << proof.reason;
          EXPECT_EQ(proof.verdict == Verdict::kProved, certificate["verdict"] == "proved");
        }
        if (proof.verdict == Verdict::kUndecided || has_half_turns(path)) continue;
        ++decided;
        const CheckResult result = check(problem, path, proof);
        // Paths that lead astray from what they state, or from their query: the first never become certificates.
        const bool is_led_astray =
            std::string(folder) == "rejected" && (result.outcome == Outcome::kUndecided ||
                                                  result.message.find("next to what the path") != std::string::npos);
        const bool of_the_path = result.message.find("query waypoint") == std::string::npos;
        EXPECT_TRUE(result.outcome == Outcome::kAccepted || !of_the_path || is_led_astray) << result.message;
      } catch (const InputError&) {
        EXPECT_STREQ(folder, "rejected");
      }
    }
  }
  EXPECT_GT(decided, read / 2);
}

/// Takes away what a writer may number in another order: directions, which the checker compares by proving with them.
void erase_directions(json& certificate) {
  if (!certificate["problem"].contains("bodies")) return;
  certificate["path"].erase("directions");
  certificate.erase("path_sha256");
  for (json& segment : certificate["segments"]) {
    segment.erase("apart");
    for (json& box : segment["boxes"]) box.erase("apart");
  }
  if (certificate["witness"].contains("weights")) certificate["witness"].erase("weights");  // rationals, or dyadics
}

/// But for who wrote them.
TEST(Agreement, OnWhatCertificatesSay) {
  for (const auto& file : checker::certificates("accepted")) {
    SCOPED_TRACE(file);
    if (file.stem().string().starts_with("attack_tower")) continue;  // numbers that the prover refuses
    const std::string text = checker::read_text(file);
    if (json::parse(text).contains("legs")) continue;  // each is a certificate of its own
    json certificate = parse_certificate(text, file);
    const std::string rewritten = certificate_text(read_certificate(certificate));
    json written = json::parse(rewritten);
    if (certificate["problem"].contains("bodies")) {
      EXPECT_EQ(checker::check(rewritten).outcome, Outcome::kAccepted);
    }
    for (json* of : {&certificate, &written}) erase_directions(*of);
    for (const char* key : {"footer", "generator", "signature"}) {
      certificate.erase(key);
      written.erase(key);
    }
    EXPECT_EQ(written, certificate);
  }
}

/// t leads the pose nowhere; x is up to the constraint. So a proof is about nothing but the motion.
Problem toy(const ExpressionText& constraint) {
  Problem problem = testing::robot1_slice();
  problem.space = SpaceText{};
  problem.space.parameters = {{"t", ParameterKind::kReal, "", ""}, {"x", ParameterKind::kReal, "", ""}};
  problem.space.pose = {"0", "0", "0.35", "-2.3", "1.6", "(34)*pi/180"};
  problem.space.constraints = {constraint};
  problem.query = {{"0", "0"}, {"1", "0"}};
  return problem;
}

/// Expressions that are smooth nearly everywhere, and have poles, jumps, kinks and holes elsewhere.
ExpressionText random_expression(std::mt19937_64& random, int depth) {
  const auto pick = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  const auto number = [&] { return std::to_string(pick(7)) + "." + std::to_string(pick(100)); };
  if (depth == 0) return pick(3) == 0 ? number() : pick(2) == 0 ? "t" : "x";
  const ExpressionText a = random_expression(random, depth - 1);
  const ExpressionText b = random_expression(random, depth - 1);
  switch (pick(15)) {
    case 0: return "(" + a + ")+(" + b + ")";
    case 1: return "(" + a + ")-(" + b + ")";
    case 2:
    case 3: return "(" + a + ")*(" + b + ")";
    case 4: return "(" + a + ")/(" + b + " - " + number() + ")";
    case 5: return "atan2(" + a + " - " + number() + ", " + b + ")";
    case 6: return "sqrt(" + a + ")";
    case 7: return "(" + a + " - " + number() + ")^" + std::to_string(pick(5) - 2);
    case 8: return "tan(" + a + ")";
    case 9: return "exp(" + a + ")";
    case 10: return "asin(" + a + " - " + number() + ")";
    case 11: return "acos(" + a + " - " + number() + ")";
    case 12: return "atan(" + a + ")";
    case 13: return "log(" + a + " + " + number() + ")";
    default: return "sin(3*(" + a + "))";
  }
}

/// The zeros of y -> C at s in the tube, each told from a jump by bisection.
int zeros(const ConstraintFunctions& functions, const Segment& segment, double s) {
  constexpr int kSteps = 400;
  const auto mix = [&](auto value) { return (1 - s) * value(*segment.control[0]) + s * value(*segment.control[1]); };
  const auto g = [&](double y) {
    ConstraintFunctions::Vector lambda(2), values;
    ConstraintFunctions::Jacobian jacobian;
    for (std::size_t j = 0; j < 2; ++j) {
      lambda[static_cast<int>(j)] = mix([&](const Waypoint& w) { return w.parameters().x[j]; }) +
                                    y * mix([&](const Waypoint& w) { return w.parameters().normals[j]; });
    }
    functions.evaluate(lambda, values, jacobian);
    return values[0];
  };
  int count = 0;
  for (int k = 0; k < kSteps; ++k) {
    double low = segment.tube * (2.0 * k / kSteps - 1), high = segment.tube * (2.0 * (k + 1) / kSteps - 1);
    if (!std::isfinite(g(low)) || !std::isfinite(g(high))) return -1;
    if ((g(low) > 0) == (g(high) > 0)) continue;
    const double scale = std::abs(g(low)) + std::abs(g(high));
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (low + high);
      ((g(low) > 0) == (g(middle) > 0) ? low : high) = middle;
    }
    if (std::abs(g(low)) + std::abs(g(high)) < 1e-3 * scale + 1e-12) ++count;
  }
  return count;
}

TEST(Agreement, ThereIsOneMotionWhereEitherOfThemSaysSo) {
  std::mt19937_64 random(2);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const int trials = checker::is_sampled() ? 60 : 600;
  int proved = 0;
  int confirmed = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const double slope = std::exp(uniform(-3, 1));
    const ExpressionText constraint = std::to_string(slope) + "*x - " + std::to_string(uniform(0, 0.3)) + "*(" +
                                      random_expression(random, 1 + trial % 3) + ")";
    const Problem problem = toy(constraint);
    const ConstraintFunctions functions(problem);
    std::array<Waypoint, 2> ends;
    for (int i = 0; i < 2; ++i) {
      ends[static_cast<std::size_t>(i)] = {{static_cast<double>(i), uniform(-0.5, 0.5)},
                                           {0, 0},
                                           {uniform(-0.5, 0.5), trial % 4 == 0 ? uniform(-1, 2) : 1.0}};
    }
    Segment segment = Segment::straight(ends[0], ends[1]);
    const double deviation = functions.deviation(segment, 0.5).value_or(0.1);
    segment.tube = std::exp2(uniform(-1, 3)) * std::max(deviation, 1e-3);
    const Path path{{ends[0], ends[1]}, Interpolation::kStraight, {segment.tube}};
    const PathProof proof = prove_path(Prover(problem, {.max_boxes = 300, .max_multiprecision_boxes = 5}), path);
    ASSERT_NE(proof.verdict, Verdict::kRefuted) << constraint;
    if (proof.verdict == Verdict::kUndecided) continue;
    ++proved;
    for (int k = 0; k <= 20; ++k) EXPECT_EQ(zeros(functions, segment, k / 20.0), 1) << constraint << " at " << k / 20.0;
    // The kernel's enclosures are wider in places: then there is no certificate, but never one that is rejected.
    const CheckResult result = check(problem, path, proof);
    EXPECT_TRUE(result.outcome == Outcome::kAccepted || result.outcome == Outcome::kUndecided)
        << constraint << ": " << result.message;
    confirmed += result.outcome == Outcome::kAccepted ? 1 : 0;
  }
  EXPECT_GT(proved, trials / 8);
  EXPECT_GT(confirmed, proved * 9 / 10);
}

}  // namespace
}  // namespace taut
