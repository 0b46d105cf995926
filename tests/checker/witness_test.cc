// SPDX-License-Identifier: GPL-3.0-or-later
// Witnesses: deviations that are too large, values that are wrong, and ways that lead elsewhere are not confirmed.
#include "checker/witness.h"

#include <gtest/gtest.h>

#include "tests/checker/loads_oracle.h"

namespace taut::checker {
namespace {

constexpr double kTubePosition = 0.002;
constexpr double kTubeTurn = 0.008;

using campaign::RigidPose;

/// A robot with tolerances that stays at one pose, and a deviation of it.
struct ReportContext {
  taut::Problem stated = testing::free_flying(testing::robot1_slice());
  Problem problem;
  Path path;
  Witness witness;

  explicit ReportContext(bool length_controlled) {
    TolerancesText within;
    within.base_anchor_m.fill("0.001");
    within.platform_anchor_m.fill("0.001");
    within.load_point_m = "0.002";
    within.wrench = {"0.1", "0", "-0.1", "0", "0.01", "0"};
    within.position_m = "0.001";
    within.orientation_rad = "0.01";
    if (length_controlled)
      within.cable_length_m = std::array<DecimalText, 6>{"0.001", "0.001", "0.001", "0.001", "0.001", "0.001"};
    stated.tolerances = within;
    problem = to_kernel(stated);
    path.law = Law::kGeodesic;
    const std::vector<double> at = {0.01, 0.02, 0.35, 0.1, 0.2, 0.3, 1};
    path.waypoints = {{at, {}, {}}, {at, {}, {}}};
    witness.kind = WitnessKind::kTensionMin;
    witness.at_box.bits = 128;
    witness.cable = 2;
    witness.deviation.emplace();
    for (std::size_t i = 0; i < 6; ++i) {
      witness.deviation->base_anchors[i] = {mpq_class(1, 65536), mpq_class(-1, 32768), mpq_class(1, 65536)};
      witness.deviation->platform_anchors[i] = {mpq_class(-1, 32768), 0, mpq_class(1, 65536)};
    }
    witness.deviation->load_point = {mpq_class(1, 1024), 0, mpq_class(-1, 1024)};
    witness.deviation->wrench = mpq_class(-3, 4);
    witness.deviation->position = {0, mpq_class(1, 2048), 0};
    witness.deviation->turn = {mpq_class(1, 512), mpq_class(1, 512), 0};
    if (!length_controlled) return;
    witness.deviation->cable_lengths.emplace();
    for (std::size_t i = 0; i < 6; ++i) (*witness.deviation->cable_lengths)[i] = mpq_class(i % 2 == 0 ? 1 : -1, 32768);
  }

  template <class S>
  static S number(const mpq_class& x) {
    return S(x.get_d());
  }  // of few bits

  template <class S>
  [[nodiscard]] campaign::Machine<S> deviant(const S& share) const {
    auto machine = campaign::make_machine<S>(stated);
    const auto within = campaign::make_tolerances<S>(stated);
    const WitnessDeviation& by = *witness.deviation;
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        machine.a[i][c] = machine.a[i][c] + share * number<S>(by.base_anchors[i][c]);
        machine.b[i][c] = machine.b[i][c] + share * number<S>(by.platform_anchors[i][c]);
      }
      machine.wrench[i] = machine.wrench[i] + number<S>(by.wrench) * within.wrench[i];
    }
    for (std::size_t c = 0; c < 3; ++c) machine.load_point[c] = machine.load_point[c] + number<S>(by.load_point[c]);
    return machine;
  }
  template <class S>
  [[nodiscard]] RigidPose<S> commanded() const {
    return campaign::mixed<S>(path.waypoints[0].x, path.waypoints[0].x, S(0.0));
  }
  /// Where lengths and anchors lead, tracking not included.
  template <class S>
  [[nodiscard]] RigidPose<S> led(const S& share, const RigidPose<S>& from) const {
    if (!witness.deviation->cable_lengths) return from;
    auto wanted = campaign::lengths(campaign::make_machine<S>(stated), commanded<S>());
    for (std::size_t i = 0; i < 6; ++i)
      wanted[i] = wanted[i] + share * number<S>((*witness.deviation->cable_lengths)[i]);
    return campaign::hold(deviant(share), from, wanted, 40).value();
  }
  [[nodiscard]] campaign::StaticsAt<BigFloat> truth() const {
    return campaign::statics(deviant(BigFloat(1.0)), deviated_pose());
  }
  [[nodiscard]] RigidPose<BigFloat> deviated_pose() const {
    RigidPose<BigFloat> pose = led(BigFloat(1.0), commanded<BigFloat>());
    const auto vector = [](const std::array<mpq_class, 3>& x) {
      return campaign::Vec<BigFloat>{number<BigFloat>(x[0]), number<BigFloat>(x[1]), number<BigFloat>(x[2])};
    };
    pose.p = pose.p + vector(witness.deviation->position);
    const auto u = vector(witness.deviation->turn);
    pose.r = multiply(campaign::rotation(campaign::Quaternion<BigFloat>{u[0], u[1], u[2], BigFloat(1.0)}), pose.r);
    return pose;
  }

  /// The way to the deviation, in so many boxes around `start`, which has these lengths.
  void lead(const std::array<double, 7>& start, int boxes) {
    const std::vector<double> x(start.begin(), start.end());
    const auto reference = campaign::mixed<double>(x, x, 0.0);
    const auto unknowns = [&](double share) {
      return in_tube(led(share, reference), reference, {kTubePosition, kTubeTurn});
    };
    WitnessDeviation& by = *witness.deviation;
    by.poses = {{mpq_class(0), start, {kTubePosition, kTubeTurn}}, {mpq_class(1), start, {kTubePosition, kTubeTurn}}};
    by.boxes.clear();
    for (int k = 0; k < boxes; ++k) {
      Box box;
      box.bits = 128;
      box.begin = mpq_class(k, boxes);
      box.end = mpq_class(k + 1, boxes);
      box.begin.canonicalize();
      box.end.canonicalize();
      const auto first = unknowns(box.begin.get_d()), last = unknowns(box.end.get_d());
      box.near.emplace();
      for (std::size_t i = 0; i < 6; ++i) {
        box.near->at.push_back((first[i] + last[i]) / 2);
        box.near->slope.push_back((last[i] - first[i]) / 2);
      }
      box.near->radius = 0.06 / boxes;
      box.near->narrowings = 4;
      by.boxes.push_back(box);
    }
  }

  [[nodiscard]] std::array<double, 7> start() const {
    std::array<double, 7> x{};
    std::ranges::copy(path.waypoints[0].x, x.begin());
    return x;
  }

  void state(const BigFloat& value, double within) {
    witness.value_lower = mpq_class(value.to_double() - within);
    witness.value_upper = mpq_class(value.to_double() + within);
  }
  void confirm() const {
    const WorkingPrecision precision(128);
    confirm_violation(Machine(problem), problem, path, witness);
  }
  [[nodiscard]] Ball quantity() const {
    const WorkingPrecision precision(128);
    return witnessed_quantity(Machine(problem), problem, path, witness);
  }
};

mpq_class middle_of(const Ball& x) {
  fmpq_t q;
  fmpq_init(q);
  arf_get_fmpq(q, arb_midref(x.get()));
  mpq_class result;
  fmpq_get_mpq(result.get_mpq_t(), q);
  fmpq_clear(q);
  return result;
}

TEST(Witness, TheQuantityIsThatOfTheMachineThatDeviates) {
  const PrecisionScope oracle(kOracleBits);
  for (const bool length_controlled : {false, true}) {
    for (const int boxes : {1, 2, 5}) {
      ReportContext scene(length_controlled);
      if (length_controlled) scene.lead(scene.start(), boxes);
      const auto truth = scene.truth();
      for (std::size_t cable = 0; cable < 6; ++cable) {
        scene.witness.cable = cable;
        const std::pair<WitnessKind, BigFloat> kinds[] = {{WitnessKind::kTensionMin, truth.tension_low[cable]},
                                                          {WitnessKind::kTensionMax, truth.tension_high[cable]},
                                                          {WitnessKind::kLengthMin, truth.length[cable]},
                                                          {WitnessKind::kLengthMax, truth.length[cable]}};
        for (const auto& [kind, value] : kinds) {
          scene.witness.kind = kind;
          const Ball seen = scene.quantity();
          EXPECT_TRUE(holds(seen, value)) << print(seen) << " is not " << testing::digits(value);
          EXPECT_LT(width(seen), 1e-3 * std::abs(value.to_double()));
          scene.state(value, 0.01 * std::abs(value.to_double()));
          EXPECT_NO_THROW(scene.confirm());
          scene.state(value + BigFloat(0.1), 1e-3);
          EXPECT_THROW(scene.confirm(), Rejected);
          scene.state(value, 1);
          scene.witness.value_lower = middle_of(seen);  // which the kernel can't tell from what is above
          EXPECT_THROW(scene.confirm(), Undefined);
        }
      }
    }
  }
}

TEST(Witness, LoadsActOnTheMachineThatDeviates) {
  const PrecisionScope oracle(kOracleBits);
  for (const bool keeps_ellipsoid : {false, true}) {
    ReportContext scene(false);
    WitnessDeviation& by = *scene.witness.deviation;
    by.load_point = {};
    by.wrench = 0;
    if (!keeps_ellipsoid) {
      scene.problem.ellipsoid.reset();
      scene.problem.wrench = ExactWrench();
    }
    scene.problem.gravity = {0, mpq_class(1, 8), -10};
    scene.problem.items = {
        {Weight{{mpq_class(1, 32), mpq_class(1, 16)}, mpq_class(1, 64)}, Axes::kWorld, {mpq_class(1, 64), 0, 0}},
        {BallOrDisc{false, mpq_class(1, 2), {}}, Axes::kPlatform, {0, mpq_class(-1, 32), 0}},
        {LineSegment{true, {1, 1, 1}, {-1, mpq_class(1, 64)}}, Axes::kPlatform, {}}};
    const auto number = [](const mpq_class& x) { return BigFloat(x.get_d()); };  // of few bits
    const ExactVector e = {0, mpq_class(1, 128), mpq_class(1, 128)};
    const ExactVector force = {mpq_class(1, 4), mpq_class(-1, 8), 0};
    scene.witness.loads = {WeightChoice{mpq_class(3, 64), e}, VectorChoice{force}, AmountChoice{mpq_class(1, 128)}};
    std::vector<OneLoad<BigFloat>> loads(3);
    loads[0].amount = number(mpq_class(3, 64));
    loads[0].vector = vector_of<BigFloat>(e);
    loads[1].vector = vector_of<BigFloat>(force);
    loads[2].amount = number(mpq_class(1, 128));
    const auto pose = scene.deviated_pose();
    const auto machine = scene.deviant(BigFloat(1.0));
    const auto y = responses(machine, pose);
    const auto of_ellipsoid = campaign::statics(machine, pose);
    const Platform<BigFloat> on = {pose.r, machine.load_point, vector_of<BigFloat>(scene.problem.gravity)};
    for (std::size_t cable = 0; cable < 6; ++cable) {
      scene.witness.cable = cable;
      for (const WitnessKind kind : {WitnessKind::kTensionMin, WitnessKind::kTensionMax}) {
        scene.witness.kind = kind;
        BigFloat tension(0.0);
        if (keeps_ellipsoid) {
          tension =
              kind == WitnessKind::kTensionMin ? of_ellipsoid.tension_low[cable] : of_ellipsoid.tension_high[cable];
        }
        for (std::size_t k = 0; k < 3; ++k) {
          tension = tension + dot_six(y[cable], wrench_of(scene.problem.items[k], loads[k], on));
        }
        const Ball seen = scene.quantity();
        EXPECT_TRUE(holds(seen, tension)) << print(seen) << " is not " << testing::digits(tension);
        EXPECT_LT(width(seen), 1e-20);
      }
    }
    std::get<AmountChoice>((*scene.witness.loads)[2]).amount = mpq_class(1, 32);
    EXPECT_THROW((void)scene.quantity(), Rejected);
  }
}

TEST(Witness, ADeviationBeyondATolerancesIsRejected) {
  const PrecisionScope oracle(kOracleBits);
  using By = WitnessDeviation;
  const std::vector<std::pair<const char*, std::function<void(By&)>>> beyond = {
      {"base anchor",
       [](By& by) {
         by.base_anchors[3] = {mpq_class(1001, 1000000), 0, 0};
       }},
      {"base anchor",
       [](By& by) {
         by.base_anchors[0] = {mpq_class(6, 10000), mpq_class(6, 10000), mpq_class(6, 10000)};
       }},
      {"platform anchor",
       [](By& by) {
         by.platform_anchors[5] = {0, mpq_class(-1001, 1000000), 0};
       }},
      {"load point",
       [](By& by) {
         by.load_point = {0, 0, mpq_class(2001, 1000000)};
       }},
      {"wrench", [](By& by) { by.wrench = mpq_class(1001, 1000); }},
      {"wrench", [](By& by) { by.wrench = mpq_class(-1001, 1000); }},
      {"position",
       [](By& by) {
         by.position = {mpq_class(-1001, 1000000), 0, 0};
       }},
      {"the orientation",
       [](By& by) {
         by.turn = {0, mpq_class(501, 100000), 0};
       }},  // 0.01002 rad
      {"the orientation", [](By& by) {
         by.turn = {100, 0, 0};
       }}};
  for (const bool length_controlled : {false, true}) {
    for (const auto& [what, alter] : beyond) {
      ReportContext scene(length_controlled);
      if (length_controlled) scene.lead(scene.start(), 1);
      alter(*scene.witness.deviation);
      scene.state(BigFloat(0.0), 1e6);
      try {
        scene.confirm();
        ADD_FAILURE() << what;
      } catch (const Rejected& why) {
        EXPECT_NE(std::string(why.what()).find(what), std::string::npos) << why.what();
      }
    }
  }
  ReportContext scene(true);
  scene.lead(scene.start(), 1);
  scene.state(BigFloat(0.0), 1e6);
  EXPECT_NO_THROW(scene.confirm());
  (*scene.witness.deviation->cable_lengths)[4] = mpq_class(1001, 1000000);
  EXPECT_THROW(scene.confirm(), Rejected);
}

TEST(Witness, ADeviationJustWithinTheTolerancesIsNotRejected) {
  ReportContext scene(false);
  scene.state(BigFloat(0.0), 1e6);
  scene.witness.deviation->base_anchors[3] = {mpq_class(1, 1000), 0, 0};
  scene.witness.deviation->platform_anchors[3] = {mpq_class(6, 10000), mpq_class(-8, 10000), 0};
  scene.witness.deviation->wrench = -1;
  scene.witness.deviation->turn = {mpq_class(4999, 1000000), 0, 0};
  EXPECT_NO_THROW(scene.confirm());
}

/// The same lengths below the plane of the base: anchors are in planes, through which everything is mirrored.
std::array<double, 7> mirrored(std::array<double, 7> x) {
  x[2] = -x[2];
  x[3] = -x[3];
  x[4] = -x[4];
  return x;
}

TEST(Witness, AWayThroughAnotherAssemblyIsNotConfirmed) {
  const PrecisionScope oracle(kOracleBits);
  ReportContext scene(true);
  // The anchors stay in their planes, so that the mirrored pose has the lengths of the deviating machine, too.
  for (std::size_t i = 0; i < 6; ++i) {
    scene.witness.deviation->base_anchors[i][2] = 0;
    scene.witness.deviation->platform_anchors[i][2] = 0;
  }
  scene.state(BigFloat(0.0), 1e6);
  scene.lead(scene.start(), 2);
  EXPECT_NO_THROW(scene.confirm());

  // A way all in the other assembly: each of its boxes is proved, but the stated machine is not there.
  ReportContext other = scene;
  other.lead(mirrored(other.start()), 2);
  {
    const WorkingPrecision precision(128);
    const Machine machine(other.problem);
    const Geometry stated = commanded_geometry(machine, other.problem, other.path, 0, dyadic_box(0, 0, 0));
    for (const Box& box : other.witness.deviation->boxes) {
      EXPECT_NO_THROW(
          (void)forward_kinematics(growing_deviation(machine, stated, *other.witness.deviation, box), *box.near))
          << "the test needs a true motion of the other assembly";
    }
  }
  EXPECT_THROW(other.confirm(), Undefined);

  // One that begins in the right assembly and ends in the other.
  ReportContext crossing = scene;
  WitnessDeviation& by = *crossing.witness.deviation;
  by.poses.back().x = mirrored(by.poses.back().x);
  EXPECT_THROW(crossing.confirm(), Undefined);
  by.poses = scene.witness.deviation->poses;
  by.poses.insert(by.poses.begin() + 1,
                  InnerPose{mpq_class(1, 2), mirrored(scene.start()), {kTubePosition, kTubeTurn}});
  by.boxes.back() = other.witness.deviation->boxes.back();
  EXPECT_THROW(crossing.confirm(), Undefined);
}

TEST(Witness, AWayThatStopsBeforeItsEndIsRejected) {
  ReportContext scene(true);
  scene.state(BigFloat(0.0), 1e6);
  scene.lead(scene.start(), 2);
  EXPECT_NO_THROW(scene.confirm());
  scene.witness.deviation->boxes.pop_back();
  EXPECT_THROW(scene.confirm(), Rejected);
  scene.witness.deviation->boxes.clear();
  EXPECT_THROW(scene.confirm(), Rejected);
}

TEST(Witness, ATubeThatDoesNotHoldTheCommandedPoseIsNotConfirmed) {
  ReportContext scene(true);
  scene.state(BigFloat(0.0), 1e6);
  scene.lead(scene.start(), 1);
  EXPECT_NO_THROW(scene.confirm());
  for (InnerPose& pose : scene.witness.deviation->poses) pose.x[0] += 1.01 * kTubePosition;
  EXPECT_THROW(scene.confirm(), Undefined);
}

}  // namespace
}  // namespace taut::checker
