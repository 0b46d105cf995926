// SPDX-License-Identifier: GPL-3.0-or-later
// The monitor against simulated machines: those within the tolerances raise no alarm, others do.
#include "app/monitor.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "base/input_error.h"
#include "case/case_file.h"
#include "kinematics/geometry.h"
#include "kinematics/move_sampler.h"

namespace taut {
namespace {

using Vector = Vector3<double>;

constexpr GaugeErrors kGauges{.length_m = 2e-3, .tension_N = 300, .position_m = 1e-3, .orientation_rad = 1e-3};

Waypoint at(double x, double y, double z, double sigma) { return {{x, y, z, 0, 0, sigma}, std::vector<int>(6, 0)}; }

/// The 20 t crane, along straight lines.
Problem crane() {
  Problem problem = load_case(TAUT_SOURCE_DIR "/cases/cranes/portal-20t.yaml").problem;
  problem.bodies.reset();
  problem.space = coordinate_space();
  return problem;
}

/// Robot 1's load is an ellipsoid, and nothing of it is uncertain but that.
Problem robot1() { return load_case(TAUT_SOURCE_DIR "/cases/robot1-slice-qs-qg.yaml").problem; }

ProvedPath proved(const Problem& problem, const Path& path) {
  const PathProof proof = prove_path(Prover(problem), path);
  EXPECT_EQ(proof.verdict, Verdict::kProved);
  ProvedPath result{problem, path, {}, {}};
  for (const SegmentProof& segment : proof.segments) {
    result.boxes.push_back(segment.boxes);
    result.margins.push_back(margins_below(segment.tension_N, segment.length_m, segment.wrench_scale));
  }
  return result;
}

Path crane_path() {
  Path path;
  path.waypoints = {at(-2, 0, 6, -0.05), at(0, 0.4, 6.3, 0), at(2, 0, 6, 0.05)};
  return path;
}

/// At rest at each waypoint, and as long between two of them.
Path move_along(Path path, double step_s) {
  path.timing = TimeLaw{step_s, {}};
  for (std::size_t k = 0; k < path.waypoints.size(); ++k) {
    for (int n = 0; n < 3; ++n) path.timing->controls.push_back(static_cast<double>(k));
  }
  return path;
}

Problem moving_crane() {
  Problem problem = crane();
  problem.time.emplace();
  problem.time->load_speed_m_s = "2";
  for (TimeText::Limit& limit : problem.time->winch_speed_m_s) limit = "0.75";
  return problem;
}

const ProvedPath& proved_path_of_crane() {
  static const ProvedPath path = proved(crane(), crane_path());
  return path;
}
const ProvedPath& proved_move_of_crane() {
  static const ProvedPath move = proved(moving_crane(), move_along(crane_path(), 2));
  return move;
}

/// A machine as somebody might have built and loaded it. Deviations are shares of the tolerances, 1 the most.
class Machine {
 public:
  explicit Machine(const ProvedPath& proved, unsigned seed = 1)
      : problem_(proved.problem), path_(proved.path), random_(seed), stated_(make_model<double>(proved.problem)) {
    real_ = stated_;
    if (problem_.time) moves_.emplace(problem_);
    tolerances_ = tolerance_numbers(problem_);
    for (const LoadItem& item : problem_.load.items) {
      if (const auto* weight = std::get_if<Weight>(&item.what)) {
        masses_[item.name] =
            from_rational<double>(weight->mass_lower) * 0.5 + from_rational<double>(weight->mass_upper) * 0.5;
        offsets_[item.name] = Vector::Zero();
      }
    }
  }

  void deviate(double share) {
    share_ = share;
    for (std::size_t i = 0; i < kCables; ++i) {
      real_.p_WA[i] = stated_.p_WA[i] + some(tolerances_.base_anchor[i] * share);
      real_.p_PB[i] = stated_.p_PB[i] + some(tolerances_.platform_anchor[i] * share);
      real_.p_MB[i] = real_.p_PB[i] - stated_.p_PM;
    }
    for (const LoadItem& item : problem_.load.items) {
      const auto* weight = std::get_if<Weight>(&item.what);
      if (weight == nullptr) continue;
      const double half = 0.5 * (from_rational<double>(weight->mass_upper) - from_rational<double>(weight->mass_lower));
      masses_[item.name] += uniform(-half, half) * share;
      offsets_[item.name] = some(from_rational<double>(weight->at_tolerance) * share);
    }
  }
  void load_more(const std::string& item, double mass) { masses_.at(item) += mass; }
  void blow(double wind_N) { wind_N_ = wind_N; }

  /// What gauges say where it is commanded to be at a place, of a move at a time.
  [[nodiscard]] MeasuredRow at_place(double s) { return measured(s, std::nullopt); }
  [[nodiscard]] MeasuredRow at_time(double t) { return measured(taut::at_time(*path_.timing, t).s, t); }
  void read_with(const GaugeErrors& errors) { errors_ = errors; }

  double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }
  /// In any direction, of that length.
  Vector some(double length) {
    Vector v(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    return v * (length / v.norm());
  }

 private:
  MeasuredRow measured(double s, std::optional<double> t) {
    const auto k = std::min(static_cast<std::size_t>(s), path_.segments() - 1);
    RigidPose pose = PoseSampler(problem_).rigid_pose(path_.segment(k), s - static_cast<double>(k));
    pose.p += some(tolerances_.position * share_);
    const Vector axis = some(1);
    pose.q = Eigen::AngleAxisd(tolerances_.orientation * share_, axis) * pose.q;

    const Matrix3<double> r_WP = pose.q.toRotationMatrix();
    const CableGeometry<double> geometry = cable_geometry(real_, pose.p, r_WP);
    Vector6<double> wrench = Vector6<double>::Zero();
    const auto add = [&](const Vector& force, const RationalVector& point, const Vector& offset) {
      Vector lever;
      for (int n = 0; n < 3; ++n) lever(n) = from_rational<double>(point[static_cast<std::size_t>(n)]);
      const Vector moment = (r_WP * (lever - stated_.p_PM) + offset).cross(force);
      wrench.head<3>() += force;
      wrench.tail<3>() += moment;
    };
    Vector gravity;
    for (int n = 0; n < 3; ++n) {
      gravity(n) = from_rational<double>(problem_.load.gravity_m_s2[static_cast<std::size_t>(n)]);
    }
    LoadText real_load = problem_.load;
    for (LoadItem& item : real_load.items) {
      if (auto* weight = std::get_if<Weight>(&item.what)) {
        add(masses_.at(item.name) * gravity, weight->at, offsets_.at(item.name));
        weight->mass_lower = weight->mass_upper = fmt::format("{:.9f}", masses_.at(item.name));
      } else if (const auto* force = std::get_if<Force>(&item.what)) {
        const double angle = uniform(0, 6.3);
        add(wind_N_ * Vector(std::cos(angle), std::sin(angle), 0), force->at, Vector::Zero());
      }
    }
    if (t) {
      const Rates<double> rates = moves_->at_time(path_, *t).rates;
      wrench -= inertial_wrench(make_moving_bodies<double>(real_load), r_WP, rates);
    }
    const Vector6<double> density = geometry.force_density.partialPivLu().solve(wrench);
    MeasuredRow row;
    row.time_s = t;
    row.pose = pose;
    row.pose->p += some(errors_.position_m);
    row.pose->q = Eigen::AngleAxisd(uniform(-1, 1) * errors_.orientation_rad, some(1)) * row.pose->q;
    for (std::size_t i = 0; i < kCables; ++i) {
      const double length = geometry.p_AB_W[i].norm();
      row.length_m[i] = length + uniform(-1, 1) * errors_.length_m;
      row.tension_N[i] = length * density(static_cast<int>(i)) + uniform(-1, 1) * errors_.tension_N;
    }
    return row;
  }

  Problem problem_;
  Path path_;
  std::mt19937 random_;
  Model<double> stated_, real_;
  std::optional<MoveSampler> moves_;
  ToleranceNumbers tolerances_;
  std::map<std::string, double> masses_;
  std::map<std::string, Vector> offsets_;
  double share_ = 0, wind_N_ = 0;
  GaugeErrors errors_;
};

MeasuredRow lengths_only(MeasuredRow row) {
  row.pose.reset();
  return row;
}
MeasuredRow pose_only(MeasuredRow row) {
  row.length_m.fill(std::nullopt);
  return row;
}

std::string words(const RowVerdict& verdict) {
  std::string text;
  for (const Alarm& alarm : verdict.alarms) {
    text += fmt::format("{} of cable {}: {} in {} to {}; ", name(alarm.kind), alarm.cable + 1, alarm.measured,
                        alarm.lower, alarm.upper);
  }
  return text;
}

bool has(const RowVerdict& verdict, AlarmKind kind, int cable = -1) {
  return std::ranges::any_of(
      verdict.alarms, [&](const Alarm& alarm) { return alarm.kind == kind && (cable < 0 || alarm.cable == cable); });
}

TEST(PlaceTable, FindsThePlaceOfEachPoseAndOfItsLengths) {
  const ProvedPath& path = proved_path_of_crane();
  const PoseSampler sampler(path.problem);
  const PlaceTable table(sampler, path.path, {{0, 0.75, {}}, {0.75, 1, {}}, {1, 2, {}}}, {});
  for (int k = 0; k <= 1000; ++k) {
    const double s = k * 0.002;
    const auto segment = static_cast<std::size_t>(std::min(s, 1.0));
    const RigidPose pose = sampler.rigid_pose(path.path.segment(segment), s - static_cast<double>(segment));
    PlaceTarget target;
    const std::array<double, kCables> lengths = cable_lengths(sampler.model(), pose);
    std::ranges::copy(lengths, target.length.begin());
    target.mask = 0x3f | PlaceTarget::bit(PlaceTarget::kPosition) | PlaceTarget::bit(PlaceTarget::kTurn);
    target.position = pose.p;
    target.turn = pose.q.coeffs();
    const std::vector<PlaceInterval> places = table.places(target, target.mask, 0, table.cells());
    ASSERT_EQ(places.size(), 1u) << s;
    EXPECT_LE(places[0].lower, s);
    EXPECT_GE(places[0].upper, s);
    EXPECT_LT(places[0].upper - places[0].lower, 1e-5);
    EXPECT_NEAR(table.best_fit(target, target.mask, 0, table.cells()).s, s, 1e-5);
  }
}

TEST(Monitor, RowsOfThePathItselfAreGood) {
  for (const ProvedPath* path : {&proved_path_of_crane(), &proved_move_of_crane()}) {
    Monitor monitor(*path, {});
    Machine machine(*path);
    for (int k = 0; k <= 200; ++k) {
      const bool is_move = monitor.is_move();
      const double share = k / 200.0;
      const MeasuredRow row =
          is_move ? machine.at_time(share * path->path.timing->duration_s()) : machine.at_place(2 * share);
      const RowVerdict verdict = monitor.judge(row);
      EXPECT_TRUE(verdict.is_good()) << share << ": " << words(verdict);
      ASSERT_TRUE(verdict.place);
      if (is_move) {
        ASSERT_TRUE(verdict.lead_s);
      } else {
        EXPECT_NEAR(*verdict.place, 2 * share, 0.03);
      }
    }
  }
}

/// Any machine, load, tracking error and gauges within what is stated.
TEST(Monitor, RaisesNoAlarmWithinTheTolerances) {
  for (const ProvedPath* path : {&proved_path_of_crane(), &proved_move_of_crane()}) {
    for (unsigned seed = 1; seed <= 12; ++seed) {
      Monitor monitor(*path, kGauges);
      Machine machine(*path, seed);
      machine.deviate(0.999);
      machine.blow(5999);
      machine.read_with(kGauges);
      const double late = machine.uniform(-5, 5);
      for (int k = 0; k <= 150; ++k) {
        const double share = k / 150.0;
        MeasuredRow row =
            path->path.timing ? machine.at_time(share * path->path.timing->duration_s()) : machine.at_place(2 * share);
        if (row.time_s) *row.time_s += late;
        if (seed % 3 == 1) row = lengths_only(row);
        if (seed % 3 == 2) row = pose_only(row);
        const RowVerdict verdict = monitor.judge(row);
        ASSERT_TRUE(verdict.is_good()) << "seed " << seed << " at " << share << ": " << words(verdict);
        EXPECT_LE(verdict.shares.place, 1);
        EXPECT_LE(verdict.shares.tension, 1);
        EXPECT_LE(verdict.shares.load, 1);
      }
    }
  }
}

TEST(Monitor, NamesTheCableWhoseLengthIsOff) {
  for (std::size_t cable = 0; cable < kCables; ++cable) {
    Monitor monitor(proved_path_of_crane(), kGauges);
    Machine machine(proved_path_of_crane());
    EXPECT_TRUE(monitor.judge(lengths_only(machine.at_place(0.7))).is_good());
    MeasuredRow row = lengths_only(machine.at_place(0.71));
    *row.length_m[cable] += 0.4;
    const RowVerdict verdict = monitor.judge(row);
    ASSERT_EQ(verdict.alarms.size(), 1u) << words(verdict);
    EXPECT_EQ(verdict.alarms[0].kind, AlarmKind::kLength);
    EXPECT_EQ(verdict.alarms[0].cable, static_cast<int>(cable));
    EXPECT_TRUE(verdict.alarms[0].is_alone);
    EXPECT_NEAR(*verdict.place, 0.71, 0.05);
    EXPECT_TRUE(monitor.judge(lengths_only(machine.at_place(0.72))).is_good()) << "it goes on";
  }
}

TEST(Monitor, SaysHowFarAPoseIsOff) {
  Machine machine(proved_path_of_crane());
  Monitor monitor(proved_path_of_crane(), {});
  MeasuredRow row = pose_only(machine.at_place(1.3));
  row.pose->p(2) += 0.049;
  EXPECT_TRUE(monitor.judge(row).is_good());
  row.pose->p(2) += 0.002;
  RowVerdict verdict = monitor.judge(row);
  ASSERT_EQ(verdict.alarms.size(), 1u);
  EXPECT_EQ(verdict.alarms[0].kind, AlarmKind::kPosition);
  EXPECT_NEAR(verdict.alarms[0].measured, 0.051, 1e-3);
  EXPECT_NEAR(verdict.alarms[0].upper, 0.05, 1e-12);

  row = pose_only(machine.at_place(1.3));
  row.pose->q = Eigen::AngleAxisd(0.01, Vector(1, 0, 0)) * row.pose->q;
  verdict = monitor.judge(row);
  ASSERT_EQ(verdict.alarms.size(), 1u);
  EXPECT_EQ(verdict.alarms[0].kind, AlarmKind::kOrientation);
  EXPECT_NEAR(verdict.alarms[0].measured, 0.01, 1e-3);
}

TEST(Monitor, SeesAWrongPayload) {
  for (const ProvedPath* path : {&proved_path_of_crane(), &proved_move_of_crane()}) {
    for (const double more : {4000.0, -4000.0}) {
      Monitor monitor(*path, kGauges);
      Machine machine(*path);
      machine.load_more("payload", more);
      const RowVerdict verdict =
          monitor.judge(lengths_only(path->path.timing ? machine.at_time(5) : machine.at_place(0.6)));
      const auto alarm = std::ranges::find(verdict.alarms, AlarmKind::kLoad, &Alarm::kind);
      ASSERT_NE(alarm, verdict.alarms.end()) << words(verdict);
      ASSERT_TRUE(alarm->guess);
      EXPECT_EQ(alarm->guess->kind, LoadGuess::Kind::kMass);
      EXPECT_EQ(alarm->guess->item, "payload") << "of which less is known than of the platform";
      EXPECT_NEAR(alarm->guess->amount, more, 400);
      EXPECT_GT(verdict.shares.load, 1);
    }
  }
}

/// With a measured pose it is not the tracking error that hides a mass.
TEST(Monitor, SeesLessOfAPayloadWithAMeasuredPose) {
  Machine machine(proved_path_of_crane());
  machine.load_more("payload", 1500);
  Monitor with_pose(proved_path_of_crane(), kGauges);
  const RowVerdict seen = with_pose.judge(machine.at_place(0.6));
  Monitor without(proved_path_of_crane(), kGauges);
  const RowVerdict less = without.judge(lengths_only(machine.at_place(0.6)));
  EXPECT_GT(seen.shares.load, 1.2 * less.shares.load);
}

TEST(Monitor, NamesTheCableWhoseTensionIsOff) {
  Monitor monitor(proved_path_of_crane(), kGauges);
  Machine machine(proved_path_of_crane());
  MeasuredRow row = lengths_only(machine.at_place(1));
  row.tension_N[0].reset();  // five gauges are enough
  EXPECT_TRUE(monitor.judge(row).is_good());
  row.tension_N[4] = 1500;
  const RowVerdict verdict = monitor.judge(row);
  ASSERT_EQ(verdict.alarms.size(), 1u);
  EXPECT_TRUE(has(verdict, AlarmKind::kTension, 4));
  EXPECT_LT(verdict.shares.load, 0) << "which needs six";
}

/// Runs a move at some speed, and counts rows with an alarm of a kind.
std::map<AlarmKind, int> run_at(double speed, double* last_lead = nullptr) {
  Monitor monitor(proved_move_of_crane(), kGauges);
  Machine machine(proved_move_of_crane());
  std::map<AlarmKind, int> count;
  const double end = proved_move_of_crane().path.timing->duration_s();
  for (int k = 0; k <= 300; ++k) {
    const double law_s = end * k / 300.0;
    MeasuredRow row = lengths_only(machine.at_time(law_s));
    row.time_s = law_s / speed;
    row.tension_N.fill(std::nullopt);
    const RowVerdict verdict = monitor.judge(row);
    for (const Alarm& alarm : verdict.alarms) ++count[alarm.kind];
    if (last_lead != nullptr && verdict.lead_s) *last_lead = *verdict.lead_s;
  }
  return count;
}

TEST(Monitor, SeesAMoveThatRunsAheadOfItsLaw) {
  EXPECT_TRUE(run_at(1).empty());
  const std::map<AlarmKind, int> ahead = run_at(1.25);
  EXPECT_GE(ahead.at(AlarmKind::kAhead), 1);
  EXPECT_EQ(ahead.size(), 1u) << "winches may run faster than this law has them run";
  const std::map<AlarmKind, int> fast = run_at(3);
  EXPECT_GE(fast.at(AlarmKind::kAhead), 1);
  EXPECT_GE(fast.at(AlarmKind::kWinchSpeed), 1);
}

TEST(Monitor, ReportsALag) {
  double lead = 0;
  EXPECT_TRUE(run_at(0.5, &lead).empty());
  const double duration = proved_move_of_crane().path.timing->duration_s();
  EXPECT_LT(lead, -0.5 * duration);
}

TEST(Monitor, SeesAMoveThatRunsBackwards) {
  Monitor monitor(proved_move_of_crane(), kGauges);
  Machine machine(proved_move_of_crane());
  EXPECT_TRUE(monitor.judge(lengths_only(machine.at_time(8))).is_good());
  MeasuredRow row = lengths_only(machine.at_time(5));
  row.tension_N.fill(std::nullopt);
  row.time_s = 11;
  const RowVerdict verdict = monitor.judge(row);
  EXPECT_TRUE(has(verdict, AlarmKind::kBackwards)) << words(verdict);
}

/// Each pose but the turning point is passed twice, and only time tells when.
TEST(Monitor, KnowsWhichWayOfAMoveToAndFroItIsOn) {
  Path path = crane_path();
  path.waypoints[2] = path.waypoints[0];
  const ProvedPath to_and_fro = proved(moving_crane(), move_along(path, 2));
  Monitor monitor(to_and_fro, kGauges);
  Machine machine(to_and_fro);
  for (int k = 0; k <= 200; ++k) {
    const double t = to_and_fro.path.timing->duration_s() * k / 200.0;
    const RowVerdict verdict = monitor.judge(machine.at_time(t));
    ASSERT_TRUE(verdict.is_good()) << t << ": " << words(verdict);
    EXPECT_NEAR(*verdict.place, at_time(*to_and_fro.path.timing, t).s, 0.1) << t;
  }
}

TEST(Monitor, KnowsLengthControlledMachines) {
  Problem problem = crane();
  problem.tolerances->position_m = "0";
  problem.tolerances->orientation_rad = "0";
  problem.tolerances->base_anchor_m.fill("0.001");
  problem.tolerances->platform_anchor_m.fill("0.001");
  problem.tolerances->cable_length_m.emplace().fill("0.001");
  const ProvedPath path = proved(problem, crane_path());
  Monitor monitor(path, {});
  EXPECT_TRUE(monitor.is_length_controlled());
  Machine machine(path);
  for (int k = 0; k <= 100; ++k) {
    const MeasuredRow row = machine.at_place(k * 0.02);
    EXPECT_TRUE(monitor.judge(row).is_good());
    EXPECT_LT(monitor.judge(lengths_only(row)).shares.load, 0) << "nothing says where it is";
  }
  MeasuredRow row = machine.at_place(1);
  *row.length_m[2] += 0.02;
  EXPECT_TRUE(has(monitor.judge(lengths_only(row)), AlarmKind::kLength));
  row = pose_only(machine.at_place(1));
  row.pose->p(2) += 0.1;
  EXPECT_TRUE(has(monitor.judge(row), AlarmKind::kLength));
}

TEST(Monitor, KnowsWhereLengthsThatRunStraightLead) {
  Problem problem = moving_crane();
  problem.tolerances.emplace();
  problem.time->winch_acceleration_m_s2.fill("0.5");
  problem.time->rows = RowsText{"0.2", {"0.003", "0.003", "0.003", "0.003", "0.003", "0.003"}};
  ProvedPath proved_path = proved(problem, move_along(crane_path(), 4));
  const GaugeErrors fine{.length_m = 1e-5, .position_m = 1e-5, .orientation_rad = 1e-6};
  Monitor monitor(proved_path, fine);
  proved_path.problem.time->rows.reset();
  Monitor other(proved_path, fine);
  EXPECT_FALSE(monitor.is_length_controlled());
  const PoseSampler sampler(problem);
  std::mt19937 random(3);
  int alarms = 0;
  for (int k = 0; k <= 100; ++k) {
    const RigidPose pose = sampler.rigid_pose(proved_path.path.segment(k / 51), (k % 51) * 0.02);
    std::array<double, kCables> lengths = cable_lengths(sampler.model(), pose);
    for (double& length : lengths) length += random() % 2 == 0 ? 0.002999 : -0.002999;
    MeasuredRow row;
    row.pose = pose_of_lengths(sampler.model(), lengths, pose);
    ASSERT_TRUE(row.pose);
    EXPECT_TRUE(monitor.judge(row).is_good()) << k << ": " << words(monitor.judge(row));
    if (!other.judge(row).is_good()) ++alarms;
    for (std::size_t i = 0; i < kCables; ++i) row.length_m[i] = lengths[i];
    EXPECT_TRUE(monitor.judge(lengths_only(row)).is_good()) << k << ": " << words(monitor.judge(row));
  }
  EXPECT_GT(alarms, 90);
}

/// Loads within the ellipsoid, a path of two angles, no tolerances at all.
TEST(Monitor, HoldsTensionsToAnEllipsoid) {
  Path path;
  path.waypoints = {{{-2.3, 1.6}, {0, 0}}, {{-2.3, 1.5}, {0, 0}}};
  const ProvedPath slice = proved(robot1(), path);
  Monitor monitor(slice, {});
  const PoseSampler sampler(slice.problem);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (const double size : {0.99, 1.5}) {
    int alarms = 0;
    for (int k = 0; k <= 100; ++k) {
      const RigidPose pose = sampler.rigid_pose(slice.path.segment(0), k * 0.01);
      Vector6<double> z;
      for (double& x : z) x = normal(random);
      const Vector6<double> wrench = sampler.model().wrench + size * sampler.model().ellipsoid_root * (z / z.norm());
      const CableGeometry<double> geometry =
          cable_geometry(sampler.model(), pose.p, Matrix3<double>(pose.q.toRotationMatrix()));
      const Vector6<double> density = geometry.force_density.partialPivLu().solve(wrench);
      MeasuredRow row;
      row.pose = pose;
      for (std::size_t i = 0; i < kCables; ++i) {
        row.tension_N[i] = geometry.p_AB_W[i].norm() * density(static_cast<int>(i));
      }
      const RowVerdict verdict = monitor.judge(row);
      if (size < 1) {
        EXPECT_TRUE(verdict.is_good()) << words(verdict);
      }
      alarms += has(verdict, AlarmKind::kLoad) ? 1 : 0;
    }
    EXPECT_EQ(alarms, size < 1 ? 0 : 101);
  }
}

TEST(ProvedPath, RefusesWhatIsNotProved) {
  Certificate certificate;
  certificate.verdict = Verdict::kRefuted;
  EXPECT_THROW(static_cast<void>(proved_path(certificate)), InputError);
}

}  // namespace
}  // namespace taut
