// SPDX-License-Identifier: GPL-3.0-or-later
// taut beside OMPL and FCL around bodies: time to a proved path against time to one that is sampled at 0.1 %.
//
// Scenes are cases with bodies. OMPL's RRTConnect looks for a first path; its validity check evaluates lengths and
// tensions as bench/planners.cc does, and asks FCL whether any checked pair collides. All its shapes are grown, so that
// nothing is asked but collide(), which is the fastest question: where one body of a pair is a ball, a capsule or a
// cable, it is grown by the other's radius and the clearance, which is exact; of two others, the first is a box that
// is grown (or the box around a plate), which asks for a little more than the clearance. Pairs whose boxes along the
// axes are apart are not asked. taut has all tolerances of the case to allow for, OMPL none of them.
//
// Rounds are interleaved. Times are of all of the process's threads; one run of taut is the whole of Planner and
// plan(), of OMPL setup() and solve(). RRTConnect gives up after 20 s.
//
// Usage: body_planners [--quick] [SCENE]; Markdown on stdout, of the scenes whose names contain SCENE.
#include <fcl/fcl.h>
#include <fmt/format.h>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/goals/GoalStates.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <string_view>
#include <utility>

#include "bench/parameter_space.h"
#include "bench/scenes.h"
#include "certify/path_proof.h"
#include "kinematics/bodies.h"
#include "kinematics/pose_sampler.h"
#include "planner/planner.h"

namespace taut {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;
using Point = Vector3<double>;
using Transform = fcl::Transform3d;
using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;

constexpr double kResolution = 0.001;
constexpr double kMostSeconds = 20;

/// A shape, and where it is in the axes of what carries it.
struct Placed {
  Geometry shape;
  Transform at = Transform::Identity();
};

/// Grown by so much.
Placed segment(const Point& from, const Point& to, double radius) {
  Placed result;
  const Point along = to - from;
  result.at.translation() = 0.5 * (from + to);
  result.at.linear() = Eigen::Quaterniond::FromTwoVectors(Point::UnitZ(), along).toRotationMatrix();
  result.shape = std::make_shared<fcl::Capsuled>(radius, along.norm());
  return result;
}

/// The box around points, along the first edge that they have: exact of a box whose points are in a box's order.
Placed box_around(const std::vector<Point>& points, double grown) {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  if (points.size() == 8) {
    axes.col(0) = (points[1] - points[0]).normalized();
    axes.col(1) = (points[2] - points[0]).normalized();
    axes.col(2) = axes.col(0).cross(axes.col(1));
  }
  Point low = axes.transpose() * points[0], high = low;
  for (const Point& x : points) {
    low = low.cwiseMin(axes.transpose() * x);
    high = high.cwiseMax(axes.transpose() * x);
  }
  Placed result;
  result.at.linear() = axes;
  result.at.translation() = axes * (0.5 * (low + high));
  const Point sides = high - low + Point::Constant(2 * grown);
  result.shape = std::make_shared<fcl::Boxd>(sides.cwiseMax(1e-6));
  return result;
}

Geometry mesh_of(const PlacedMesh<double>& mesh) {
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  std::vector<Point> vertices;
  std::vector<fcl::Triangle> triangles;
  for (const auto& x : mesh.mesh->mesh().vertices) vertices.push_back(mesh.place(x));
  for (const auto& t : mesh.mesh->mesh().triangles) triangles.emplace_back(t[0], t[1], t[2]);
  model->beginModel();
  model->addSubModel(vertices, triangles);
  model->endModel();
  return model;
}

bool is_thin(const ConvexBody<double>& body) { return body.mesh == nullptr && body.points.size() <= 2; }

Placed placed(const ConvexBody<double>& body, double grown) {
  if (body.mesh != nullptr) return {mesh_of(*body.mesh)};
  if (body.points.size() > 2) return box_around(body.points, grown);
  if (body.points.size() == 2) return segment(body.points[0], body.points[1], grown);
  Placed ball{std::make_shared<fcl::Sphered>(grown)};
  ball.at.translation() = body.points[0];
  return ball;
}

/// All checked pairs, as FCL's objects.
class Collisions {
 public:
  Collisions(const Problem& problem, const Model<double>& model)
      : model_(model), bodies_(make_body_model<double>(problem)) {
    for (const CheckedPair<double>& pair : bodies_.pairs) add(pair);
  }

  [[nodiscard]] bool is_clear(const Pose<double>& pose, const Matrix3<double>& r) {
    std::array<std::array<Point, 2>, kCables> ends;
    for (std::size_t i = 0; i < kCables; ++i) {
      const Point a = model_.p_WA[i], b = pose.p_WP + r * model_.p_PB[i];
      const Point along = (b - a).normalized();
      ends[i] = {Point(a + bodies_.cable_free[i][0] * along), Point(b - bodies_.cable_free[i][1] * along)};
    }
    Transform of_platform = Transform::Identity();
    of_platform.linear() = r;
    of_platform.translation() = pose.p_WP;
    for (Pair& pair : pairs_) {
      if (pair.half != nullptr) {
        if (!is_above(pair, ends, of_platform)) return false;
        continue;
      }
      move(pair.first, ends, of_platform);
      move(pair.second, ends, of_platform);
      if (!pair.first.object->getAABB().overlap(pair.second.object->getAABB())) continue;
      fcl::CollisionResultd result;
      if (fcl::collide(pair.first.object.get(), pair.second.object.get(), fcl::CollisionRequestd(), result) > 0) {
        return false;
      }
    }
    return true;
  }

 private:
  struct Item {
    std::optional<std::size_t> cable;
    bool is_of_platform = false;
    double radius = 0;  ///< of a cable, with what it is grown by
    Transform at = Transform::Identity();
    std::shared_ptr<fcl::CollisionObjectd> object;
  };
  struct Pair {
    Item first, second;
    const HalfSpace<double>* half = nullptr;  ///< then `first` has no object
    const ConvexBody<double>* body = nullptr;
    double needed = 0;
  };

  static Item item(const ConvexBody<double>& body, double grown, bool is_of_platform) {
    Item result;
    const Placed shape = placed(body, grown);
    result.is_of_platform = is_of_platform;
    result.at = shape.at;
    result.object = std::make_shared<fcl::CollisionObjectd>(shape.shape, shape.at);
    result.object->computeAABB();
    return result;
  }
  static Item cable(std::size_t i, double radius) {
    Item result;
    result.cable = i;
    result.radius = radius;
    result.object = std::make_shared<fcl::CollisionObjectd>(std::make_shared<fcl::Capsuled>(radius, 1.0));
    return result;
  }

  void add(const CheckedPair<double>& pair) {
    Pair result;
    const bool is_first_cable = pair.kind != PairClass::kPlatformObstacles;
    const double first_radius = is_first_cable ? bodies_.cable_radius[pair.first] : bodies_.platform[pair.first].radius;
    result.needed = first_radius + pair.clearance;
    if (pair.kind == PairClass::kCablesCables) {
      result.first = cable(pair.first, result.needed);
      result.second = cable(pair.second, bodies_.cable_radius[pair.second]);
      pairs_.push_back(std::move(result));
      return;
    }
    if (pair.kind != PairClass::kCablesPlatform) {
      result.half = std::get_if<HalfSpace<double>>(&bodies_.obstacles[pair.second]);
    }
    if (result.half != nullptr) {
      if (is_first_cable) result.first.cable = pair.first;
      if (!is_first_cable) result.body = &bodies_.platform[pair.first];
      pairs_.push_back(std::move(result));
      return;
    }
    const bool is_second_carried = pair.kind == PairClass::kCablesPlatform;
    const ConvexBody<double>& second = is_second_carried ? bodies_.platform[pair.second]
                                                         : std::get<ConvexBody<double>>(bodies_.obstacles[pair.second]);
    const double needed = result.needed + second.radius;
    const bool grows_second = !is_first_cable && !is_thin(bodies_.platform[pair.first]) && is_thin(second);
    result.first = is_first_cable ? cable(pair.first, needed)
                                  : item(bodies_.platform[pair.first], grows_second ? 0 : needed, true);
    result.second = item(second, grows_second ? needed : 0, is_second_carried);
    pairs_.push_back(std::move(result));
  }

  [[nodiscard]] static bool is_above(const Pair& pair, const std::array<std::array<Point, 2>, kCables>& ends,
                                     const Transform& of_platform) {
    const auto height = [&](const Point& x) {
      return (pair.half->normal.dot(x) - pair.half->offset) / pair.half->normal.norm() - pair.needed;
    };
    if (pair.first.cable) {
      const auto& of_cable = ends[*pair.first.cable];
      return height(of_cable[0]) > 0 && height(of_cable[1]) > 0;
    }
    return std::ranges::all_of(pair.body->points, [&](const Point& x) { return height(of_platform * x) > 0; });
  }

  static void move(Item& item, const std::array<std::array<Point, 2>, kCables>& ends, const Transform& of_platform) {
    if (item.cable) {
      const Placed now = segment(ends[*item.cable][0], ends[*item.cable][1], item.radius);
      *item.object = fcl::CollisionObjectd(now.shape, now.at);
    } else if (item.is_of_platform) {
      item.object->setTransform(of_platform * item.at);
    } else {
      return;
    }
    item.object->computeAABB();
  }

  const Model<double>& model_;
  BodyModel<double> bodies_;
  std::vector<Pair> pairs_;
};

struct Scene {
  std::string name;
  Case the_case;
};

struct Times {
  std::vector<double> taut, rrt;
  std::vector<double> samples;
  int rrt_failed = 0, taut_failed = 0;
};

class OmplScene {
 public:
  explicit OmplScene(const Case& the_case)
      : sampler_(the_case.problem),
        collisions_(the_case.problem, sampler_.model()),
        space_(std::make_shared<ParameterSpace>(the_case.problem.space)),
        information_(std::make_shared<ob::SpaceInformation>(space_)) {
    information_->setStateValidityChecker([this](const ob::State* state) {
      ++samples_;
      const Pose<double> pose = sampler_.pose(space_->point(state));
      return sampler_.clearance(sampler_.statics(pose)) > 0 && collisions_.is_clear(pose, sampler_.rotation(pose));
    });
    information_->setStateValidityCheckingResolution(kResolution);
    information_->setup();
    const std::vector<Waypoint> query = query_waypoints(the_case.problem);
    start_ = query.at(0).x;
    goal_ = query.at(1).x;
  }

  void run(unsigned seed, Times& into) {
    ompl::RNG::setSeed(seed);
    auto problem = std::make_shared<ob::ProblemDefinition>(information_);
    problem->setStartAndGoalStates(state(start_), state(goal_));
    og::RRTConnect planner(information_);
    planner.setProblemDefinition(problem);
    samples_ = 0;
    const double begin = bench::processor_seconds();
    planner.setup();
    const ob::PlannerStatus status = planner.solve(
        ob::PlannerTerminationCondition([&] { return bench::processor_seconds() - begin > kMostSeconds; }));
    const double seconds = bench::processor_seconds() - begin;
    if (status != ob::PlannerStatus::EXACT_SOLUTION) ++into.rrt_failed;
    into.rrt.push_back(seconds);
    into.samples.push_back(static_cast<double>(samples_));
  }

 private:
  [[nodiscard]] ob::ScopedState<> state(const std::vector<double>& q) const {
    ob::ScopedState<> result(space_);
    for (std::size_t j = 0; j < q.size(); ++j) result[static_cast<unsigned>(j)] = q[j];
    space_->enforceBounds(result.get());
    return result;
  }

  PoseSampler sampler_;
  Collisions collisions_;
  std::shared_ptr<ParameterSpace> space_;
  ob::SpaceInformationPtr information_;
  long samples_ = 0;
  std::vector<double> start_, goal_;
};

void run_taut(const Case& the_case, Times& into) {
  const double begin = bench::processor_seconds();
  Planner planner(the_case);
  const Plan plan = planner.plan({}, {});
  into.taut.push_back(bench::processor_seconds() - begin);
  if (plan.proof.verdict != Verdict::kProved) ++into.taut_failed;
}

void measure(const Scene& scene, int rounds) {
  OmplScene ompl_scene(scene.the_case);
  Case as_found = scene.the_case;
  as_found.planner.smoothing = Smoothing::kNone;
  as_found.planner.strategy = Strategy::kGreedyBestFirst;
  Times times;
  for (int round = 0; round < rounds; ++round) {
    run_taut(as_found, times);
    ompl_scene.run(static_cast<unsigned>(round + 1), times);
  }
  const double taut = bench::median(times.taut), rrt = bench::median(times.rrt);
  fmt::print("| {} | {} | {:.1f}{} | {:.1f}{} | {:.0f} | **{:.2f}** |\n", scene.name,
             scene.the_case.problem.space.parameters.size(), 1e3 * taut, times.taut_failed > 0 ? " (no path)" : "",
             1e3 * rrt, times.rrt_failed > 0 ? fmt::format(" ({} of {} without a path)", times.rrt_failed, rounds) : "",
             bench::median(times.samples), taut / rrt);
  std::fflush(stdout);
}

void run(bool is_quick, std::string_view wanted) {
  const bench::TemporaryFolder folder;
  const auto stored = [](const std::string& file) {
    return load_case(std::string(TAUT_SOURCE_DIR "/cases/") + file + ".yaml");
  };
  const std::string clearance = "{default: 3, cables-cables: 1, cables-platform: 1}";
  const std::string all = "platform-obstacles, cables-obstacles, cables-cables, cables-platform";
  const std::vector<Scene> scenes = {
      {"robot2-sphere-post", stored("bodies/robot2-sphere-post")},
      {"Robot 2, ten obstacles",
       parse_case(bench::case_with("robot2-sphere-q2-q3.yaml", clearance, all, bench::kSphere), "sphere")},
      {"hexacrane-sphere-mesh, 1280 triangles", stored("bodies/hexacrane-sphere-mesh")},
      {"portal-20t-stack", stored("cranes/portal-20t-stack")},
      {"portal-20t-between", stored("cranes/portal-20t-between")},
      {"portal-20t, heap of 131,072 triangles", load_case(bench::write_heap_case(folder.path()).string())}};
  fmt::print("| scene | n | taut, proved, ms | RRTConnect + FCL, ms | its samples | **ratio** |\n");
  fmt::print("|---|---|---|---|---|---|\n");
  for (const Scene& scene : scenes) {
    if (scene.name.find(wanted) != std::string::npos) measure(scene, is_quick ? 3 : 11);
  }
}

}  // namespace
}  // namespace taut

int main(int argc, char** argv) {
  taut::rounding_self_test();
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
  const bool is_quick = argc > 1 && std::string_view(argv[1]) == "--quick";
  const int next = is_quick ? 2 : 1;
  taut::run(is_quick, argc > next ? argv[next] : "");
}
