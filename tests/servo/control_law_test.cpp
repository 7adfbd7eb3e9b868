#include "servo/control_law.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "servo/interaction.h"
#include "servo/servo_step.h"
#include "tests/servo/law_task.h"
#include "tests/testing/matrices.h"

namespace legible {
namespace {

Eigen::Vector3d PixelLine(const ServoModel& model, const Eigen::Vector3d& normal) {
  return (model.k.inverse().transpose() * normal).normalized();
}

// Interaction matrix of an edge in the pixel frame as the paper prints it: eq. 18, 20, 27, 36.
Eigen::Matrix<double, 3, 6> PrintedInteraction(const ServoModel& model, const Eigen::Vector3d& a,
                                               const Eigen::Vector3d& u, double q, const Eigen::Vector3d& n) {
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  Eigen::Matrix<double, 3, 6> m;
  m << one, -Skew(a + q * u);
  m = -1 / q * (one - u * u.transpose()) * m;
  const Eigen::Matrix3d h_j_u = (a.dot(u) / a.dot(u.cross(n)) * u.cross(n) - u) * n.transpose();
  const Eigen::Vector3d p_n = PixelLine(model, n);
  const Eigen::Matrix3d p_j_c =
      (model.k.transpose() * p_n).norm() * (one - p_n * p_n.transpose()) * model.k.inverse().transpose();
  return p_j_c * h_j_u * m;
}

// Edge normals of a leg by its number; zero where it is not seen.
using NormalsByLeg = std::array<std::array<Eigen::Vector3d, 2>, kLegCount>;
NormalsByLeg Normals(const SeenEdges& seen) {
  NormalsByLeg normals;
  for (auto& of_leg : normals) of_leg = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (const SeenEdge& edge : seen.edges)
    normals[static_cast<size_t>(edge.leg)][static_cast<size_t>(edge.edge)] = edge.normal;
  return normals;
}

// Eq. 37 to 41 with gain 1 and the pseudo-inverse that eq. 40 lost; both edges of each leg that is seen.
Vector6d ByThePaper(const LawTask& task, const SeenEdges& seen) {
  const ServoModel& model = task.scene.model;
  const NormalsByLeg normals = Normals(seen);
  Eigen::MatrixXd interaction(0, 6), error(0, 1), jacobian(6, 6);
  const Vector6d length_m = LegLengths(model.robot, InverseKinematics(model.robot, task.scene.pose));
  for (int leg = 0; leg < kLegCount; ++leg) {
    const auto& n = normals[static_cast<size_t>(leg)];
    const Eigen::Vector3d a = model.base_joint_in_camera_m[static_cast<size_t>(leg)];
    const bool is_seen = n[0].norm() > 0;
    const Eigen::Vector3d u = is_seen ? n[0].cross(n[1]).normalized()
                                      : (PlatformJointInCamera(model, task.scene.pose, leg) - a).normalized();
    jacobian.row(leg) << -u.transpose(), -a.cross(u).transpose();
    for (size_t edge = 0; is_seen && edge < 2; ++edge) {
      const Eigen::Vector3d goal = PixelLine(model, task.goal.edges[static_cast<size_t>(leg)][edge]->normal);
      interaction.conservativeResize(interaction.rows() + 3, 6);
      error.conservativeResize(error.rows() + 3, 1);
      interaction.bottomRows<3>() = -Skew(goal) * PrintedInteraction(model, a, u, length_m[leg], n[edge]);
      error.bottomRows<3>() = PixelLine(model, n[edge]).cross(goal);
    }
  }
  const Vector6d twist = -Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(interaction).solve(error);
  return jacobian * twist;
}

ServoStepOptions Unlimited(const ControlLawOptions& law, double gain_per_s) {
  ServoStepOptions options;
  options.law = law;
  options.gain = AdaptiveGain::Constant(gain_per_s);
  options.limits.speed_limit_m_per_s = 1e6;
  options.limits.look_ahead_s = 1e-9;
  options.slow_conditioning = 1 + 1e-9;
  return options;
}

TEST(EdgeLaw, GivesTheJointSpeedsOfThePapersEquationsWrittenOut) {
  std::mt19937_64 generator = TestGenerator();
  int counted = 0;
  for (int n = 0; n < 60; ++n) {
    const LawTask task = RandomTask(generator, 0.03);
    SeenEdges seen = EdgesAt(task.scene.model, task.scene.pose);
    GiveCovariances(seen, 1e-3, generator);
    seen = Moved(seen, generator);  // the equations hold for edges that fit no pose too
    const int hidden = n % 4 == 0 ? -1 : n % kLegCount;
    seen = Only(seen, [&](int leg, int) { return leg != hidden && (n % 4 != 2 || leg != (hidden + 2) % 6); });
    const ServoStep step =
        EvaluateStep(task.scene.model, task.goal, task.Input(seen), Unlimited(Law(ControlMode::kEdges), 1.7));
    if (step.law.status == LawStatus::kIllConditionedEdges) continue;
    ASSERT_EQ(step.law.status, LawStatus::kOk);
    ++counted;
    const Vector6d expected = 1.7 * ByThePaper(task, seen);
    EXPECT_TRUE(AreNear(step.joint_speeds_m_per_s, expected, 1e-9 * expected.norm()));
    EXPECT_EQ(step.law.edges, static_cast<int>(seen.edges.size()));
    EXPECT_EQ(step.law.legs, step.law.edges / 2);
    EXPECT_EQ(step.law.rank, 6);
  }
  EXPECT_GE(counted, 40);
}

// What each law makes of a way to the goal of eps metres, off the joints' true way by a share of it.
struct Mode {
  const char* name;
  ControlLawOptions law;
};
std::vector<Mode> AllModes() {
  Mode pose_of_edges{"pose by edges", Law(ControlMode::kPose)};
  pose_of_edges.law.pose_source = PoseSource::kEdges;
  return {{"edges", Law(ControlMode::kEdges)},
          {"edges, weighted", Law(ControlMode::kEdges, true)},
          {"edges, directions of the model", Law(ControlMode::kEdges, true, DirectionSource::kModel)},
          {"directions", Law(ControlMode::kDirections)},
          {"directions, weighted", Law(ControlMode::kDirections, true, DirectionSource::kModel)},
          {"pose by readings", Law(ControlMode::kPose)},
          pose_of_edges,
          {"joints", Law(ControlMode::kJoints)}};
}

// Sightings without noise that are said to have some.
SeenEdges WithCovariances(const LawTask& task, std::mt19937_64& generator) {
  SeenEdges seen = EdgesAt(task.scene.model, task.scene.pose);
  GiveCovariances(seen, 1e-4, generator);
  return seen;
}

double ShareOff(const ControlLawOptions& law, const LawTask& task, std::mt19937_64& generator) {
  const LawInput input = task.Input(WithCovariances(task, generator));
  const LawResult result = EvaluateLaw(task.scene.model, task.goal, input, law);
  EXPECT_EQ(result.status, LawStatus::kOk);
  const Vector6d true_way_m = *task.goal.joint_readings_m - input.joint_readings_m;
  return (result.to_go_m - true_way_m).norm() / true_way_m.norm();
}

TEST(ControlLaw, GoesTheJointsTrueWayToFirstOrder) {
  std::mt19937_64 generator = TestGenerator();
  for (const Mode& mode : AllModes()) {
    SCOPED_TRACE(mode.name);
    for (int n = 0; n < 10; ++n) {
      const ServoScene scene = RandomScene(generator);
      Vector6d direction;
      direction << UniformVector(generator, -1, 1), UniformVector(generator, -3, 3);
      const auto off = [&](double eps_m) {
        const LawTask task{scene, GoalAtPose(scene.model, Displaced(scene.pose, eps_m * direction))};
        return ShareOff(mode.law, task, generator);
      };
      EXPECT_LT(off(1e-3), 0.1);
      EXPECT_LT(off(1e-5), 1e-3);
    }
  }
}

TEST(ControlLaw, WantsNothingAtTheGoal) {
  std::mt19937_64 generator = TestGenerator();
  for (const Mode& mode : AllModes()) {
    SCOPED_TRACE(mode.name);
    for (int n = 0; n < 10; ++n) {
      const ServoScene scene = RandomScene(generator);
      const LawTask task{scene, GoalAtPose(scene.model, scene.pose)};
      const LawResult result =
          EvaluateLaw(scene.model, task.goal, task.Input(WithCovariances(task, generator)), mode.law);
      ASSERT_EQ(result.status, LawStatus::kOk);
      EXPECT_TRUE(AreNear(result.to_go_m, Vector6d::Zero(), 1e-11));
      EXPECT_NEAR(result.error, 0, 1e-9);
      EXPECT_NEAR(result.edge_error_px, 0, 1e-9);
      EXPECT_NEAR(result.direction_error_rad, 0, 1e-12);
    }
  }
}

// Twist of least sum of squares, each error in the metric of its own covariance: minus the way that it asks
// for. Normal equations over the plane across each goal's line.
Vector6d WeightedTwist(const LawTask& task, const SeenEdges& seen) {
  const ServoModel& model = task.scene.model;
  const NormalsByLeg normals = Normals(seen);
  Matrix6d information = Matrix6d::Zero();
  Vector6d moment = Vector6d::Zero();
  const Vector6d length_m = LegLengths(model.robot, InverseKinematics(model.robot, task.scene.pose));
  for (const SeenEdge& edge : seen.edges) {
    const auto leg = static_cast<size_t>(edge.leg);
    const Eigen::Vector3d goal =
        PixelLine(model, task.goal.edges[leg][static_cast<size_t>(edge.edge)]->normal);
    const Eigen::Vector3d line = PixelLine(model, edge.normal);
    const Eigen::Matrix3d by_normal = -Skew(goal) * (model.k.transpose() * line).norm() *
                                      (Eigen::Matrix3d::Identity() - line * line.transpose()) *
                                      model.k.inverse().transpose();
    const Eigen::Matrix3d covariance = by_normal * edge.normal_covariance * by_normal.transpose();
    const Eigen::Matrix3d weight = Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix3d>()
                                       .setThreshold(1e-9)
                                       .compute(covariance)
                                       .pseudoInverse();
    const Eigen::Vector3d u = normals[leg][0].cross(normals[leg][1]).normalized();
    const Eigen::Matrix<double, 3, 6> derivative =
        -Skew(goal) *
        PrintedInteraction(model, model.base_joint_in_camera_m[leg], u, length_m[edge.leg], edge.normal);
    information += derivative.transpose() * weight * derivative;
    moment += derivative.transpose() * weight * line.cross(goal);
  }
  return information.fullPivHouseholderQr().solve(moment);
}

TEST(EdgeLaw, WeightsEachEdgeByItsCovariance) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 30; ++n) {
    const LawTask task = RandomTask(generator, 0.02);
    SeenEdges seen = EdgesAt(task.scene.model, task.scene.pose);
    GiveCovariances(seen, 1e-3, generator);
    seen = Moved(seen, generator);
    GiveCovariances(seen, 0.05, generator);  // beside which the law's least sigma is nothing
    const LawResult result =
        EvaluateLaw(task.scene.model, task.goal, task.Input(seen), Law(ControlMode::kEdges, true));
    ASSERT_EQ(result.status, LawStatus::kOk);
    LegDirections directions;
    const NormalsByLeg normals = Normals(seen);
    for (size_t leg = 0; leg < kLegCount; ++leg)
      directions.col(static_cast<Eigen::Index>(leg)) = normals[leg][0].cross(normals[leg][1]).normalized();
    const Vector6d expected =
        -CameraInverseJacobian(task.scene.model, directions) * WeightedTwist(task, seen);
    EXPECT_TRUE(AreNear(result.to_go_m, expected, 1e-7 * expected.norm()));
    // Not what edges that count alike ask for.
    EXPECT_GT((result.to_go_m - ByThePaper(task, seen)).norm(), 1e-4 * expected.norm());
  }
}

// Of edges that are among the least there can be.
void ExpectTrueWay(std::mt19937_64& generator, const std::function<bool(int, int)>& keep) {
  int counted = 0;
  for (int n = 0; n < 20; ++n) {
    const LawTask task = RandomTask(generator, 1e-6);
    const LawInput input = task.Input(Only(EdgesAt(task.scene.model, task.scene.pose), keep));
    ControlLawOptions law = Law(ControlMode::kEdges);
    law.least_conditioning = 1e-5;
    const LawResult result = EvaluateLaw(task.scene.model, task.goal, input, law);
    if (result.status == LawStatus::kIllConditionedEdges) continue;
    ASSERT_EQ(result.status, LawStatus::kOk);
    ++counted;
    EXPECT_EQ(result.edges, 6);
    const Vector6d true_way_m = *task.goal.joint_readings_m - input.joint_readings_m;
    EXPECT_TRUE(AreNear(result.to_go_m, true_way_m, 0.01 * true_way_m.norm()));
  }
  EXPECT_GE(counted, 10);
}

TEST(EdgeLaw, SixEdgesAreEnough) {
  std::mt19937_64 generator = TestGenerator();
  ExpectTrueWay(generator, [](int leg, int) { return leg % 2 == 0; });
  ExpectTrueWay(generator, [](int leg, int edge) { return edge == leg % 2; });
  ExpectTrueWay(generator, [](int leg, int edge) { return leg < 2 || (leg < 4 && edge == 0); });
}

TEST(EdgeLaw, FiveEdgesAreTooFew) {
  std::mt19937_64 generator = TestGenerator();
  const LawTask task = RandomTask(generator, 0.01);
  const SeenEdges five = Only(EdgesAt(task.scene.model, task.scene.pose),
                              [](int leg, int edge) { return leg > 0 && edge == 0; });
  const LawResult result =
      EvaluateLaw(task.scene.model, task.goal, task.Input(five), Law(ControlMode::kEdges));
  EXPECT_EQ(result.status, LawStatus::kTooFewEdges);
  EXPECT_EQ(result.edges, 5);
  // A direction takes both edges of its leg.
  const LawResult directions =
      EvaluateLaw(task.scene.model, task.goal, task.Input(five), Law(ControlMode::kDirections));
  EXPECT_EQ(directions.edges, 0);
  EXPECT_EQ(directions.status, LawStatus::kTooFewEdges);
}

TEST(ControlLaw, LooksOnlyAtTheLegsThatItIsToldTo) {
  std::mt19937_64 generator = TestGenerator();
  for (const ControlMode mode : {ControlMode::kEdges, ControlMode::kDirections, ControlMode::kPose}) {
    const LawTask task = RandomTask(generator, 0.02);
    ControlLawOptions some = Law(mode), all = Law(mode);
    some.pose_source = all.pose_source = PoseSource::kEdges;
    some.legs = 0b110101;
    const SeenEdges seen = EdgesAt(task.scene.model, task.scene.pose);
    const auto is_looked_at = [&](int leg, int) { return some.legs[static_cast<size_t>(leg)]; };
    const LawResult told = EvaluateLaw(task.scene.model, task.goal, task.Input(seen), some);
    const LawResult shown =
        EvaluateLaw(task.scene.model, task.goal, task.Input(Only(seen, is_looked_at)), all);
    EXPECT_EQ(told.to_go_m, shown.to_go_m);
    EXPECT_EQ(told.edges, 8);
    EXPECT_EQ(told.legs, 4);
  }
}

TEST(ControlLaw, IsTheSameBitForBitForTheSameInput) {
  std::mt19937_64 generator = TestGenerator();
  for (const Mode& mode : AllModes()) {
    const LawTask task = RandomTask(generator, 0.02);
    const LawInput input = task.Input(WithCovariances(task, generator));
    const ServoStepOptions options = Unlimited(mode.law, 2);
    const ServoStep once = EvaluateStep(task.scene.model, task.goal, input, options);
    const ServoStep again = EvaluateStep(task.scene.model, task.goal, input, options);
    EXPECT_EQ(once.joint_speeds_m_per_s, again.joint_speeds_m_per_s) << mode.name;
    EXPECT_EQ(once.law.error, again.law.error) << mode.name;
  }
}

LawResult StatusOf(const LawTask& task, const LawInput& input, const ControlLawOptions& law) {
  LawResult result = EvaluateLaw(task.scene.model, task.goal, input, law);
  EXPECT_NE(result.status, LawStatus::kOk);
  EXPECT_EQ(result.to_go_m, Vector6d::Zero());
  const ServoStep step = EvaluateStep(task.scene.model, task.goal, input, Unlimited(law, 1));
  EXPECT_EQ(step.joint_speeds_m_per_s, Vector6d::Zero());
  EXPECT_NE(WhyNoSpeeds(step, law), "");
  return result;
}

TEST(ControlLaw, NeedsThreeLegs) {
  std::mt19937_64 generator = TestGenerator();
  const LawTask task = RandomTask(generator, 0.01);
  const SeenEdges two_legs =
      Only(EdgesAt(task.scene.model, task.scene.pose), [](int leg, int) { return leg == 1 || leg == 4; });
  for (const ControlMode mode : {ControlMode::kEdges, ControlMode::kDirections, ControlMode::kPose}) {
    ControlLawOptions law = Law(mode);
    law.pose_source = PoseSource::kEdges;
    const LawResult result = StatusOf(task, task.Input(two_legs), law);
    EXPECT_EQ(result.status, LawStatus::kTooFewEdges);
    EXPECT_EQ(result.legs, 2);
    EXPECT_EQ(result.edges, 4);
    const ServoStep step = EvaluateStep(task.scene.model, task.goal, task.Input(two_legs), Unlimited(law, 1));
    EXPECT_EQ(
        WhyNoSpeeds(step, law),
        "too few edges are seen: 4 of 2 legs, where six edges of three legs are needed; legs 1, 3, 4 and "
        "6 are not seen");
    EXPECT_EQ(StatusOf(task, task.Input({}), law).status, LawStatus::kTooFewEdges);
  }
}

// Legs 1, 3 and 5 parallel: the platform can move along them without any of them turning. The others keep the
// robot itself regular.
ServoScene SceneWithParallelLegs(std::mt19937_64& generator) {
  ServoScene scene = RandomScene(generator);
  GoughStewart robot = scene.model.robot;
  for (size_t i = 0; i < kLegCount; i += 2)
    robot.legs[i].base_joint_m = scene.pose * robot.legs[i].platform_joint_m - Eigen::Vector3d(0, 0, 0.32);
  scene.model = MakeServoModel(robot, scene.model.camera, scene.model.camera_from_base);
  return scene;
}

TEST(ControlLaw, SeesThatParallelLegsLeaveAMotionOpen) {
  std::mt19937_64 generator = TestGenerator();
  const ServoScene scene = SceneWithParallelLegs(generator);
  const LawTask task{scene, GoalAtPose(scene.model, scene.pose)};
  for (const ControlMode mode : {ControlMode::kEdges, ControlMode::kDirections}) {
    ControlLawOptions law = Law(mode);
    EXPECT_EQ(EvaluateLaw(scene.model, task.goal, task.Input(), law).status, LawStatus::kOk);
    law.legs = 0b010101;
    const LawResult result = StatusOf(task, task.Input(), law);
    EXPECT_EQ(result.status, LawStatus::kIllConditionedEdges);
    EXPECT_LT(result.Conditioning(), 1e-10);
  }
}

TEST(ControlLaw, DoesNotMoveOnEdgesThatAreNoNumbers) {
  std::mt19937_64 generator = TestGenerator();
  const LawTask task = RandomTask(generator, 0.01);
  LawInput input = task.Input();
  input.seen.edges[5].normal.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(StatusOf(task, input, Law(ControlMode::kEdges)).status, LawStatus::kIllConditionedEdges);
  EXPECT_EQ(StatusOf(task, input, Law(ControlMode::kDirections)).status, LawStatus::kIllConditionedEdges);
  ControlLawOptions pose = Law(ControlMode::kPose);
  pose.pose_source = PoseSource::kEdges;
  EXPECT_EQ(StatusOf(task, input, pose).status, LawStatus::kNoPoseFromEdges);
}

// Fichter 1986: a platform whose joints are a regular polygon's turned by a quarter about its axis, from
// where they lie as the base's do, is singular.
TEST(ControlLaw, SeesASingularRobotInEveryMode) {
  std::mt19937_64 generator = TestGenerator();
  GoughStewart robot = DesktopHexapod(generator, 0);
  for (Leg& leg : robot.legs) leg.joint_range_m = {0.1, 1};
  const ServoModel model = MakeServoModel(robot, DesktopCamera(false), LookAt({1, 0, 0.3}, {0, 0, 0.15}));
  for (const double turn_rad : {std::numbers::pi / 2, std::numbers::pi / 2 - 0.002}) {
    const Rigid3 pose{RotationFromVector({0, 0, turn_rad}), {0, 0, 0.32}};
    const LawTask task{{model, pose}, GoalAtPose(model, pose)};
    for (const Mode& mode : AllModes())
      EXPECT_EQ(StatusOf(task, task.Input(), mode.law).status, LawStatus::kRobotSingular) << mode.name;
  }
}

TEST(ControlLaw, RefusesReadingsThatAreNoNumbersOrBelongToNoPose) {
  std::mt19937_64 generator = TestGenerator();
  const LawTask task = RandomTask(generator, 0.01);
  for (const Mode& mode : AllModes()) {
    LawInput input = task.Input();
    input.joint_readings_m[3] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(StatusOf(task, input, mode.law).status, LawStatus::kBadReadings) << mode.name;
    input = task.Input();
    input.joint_readings_m[3] += 5;
    EXPECT_EQ(StatusOf(task, input, mode.law).status, LawStatus::kNoPose) << mode.name;
  }
}

TEST(ControlLaw, RefusesOptionsOutOfRange) {
  ControlLawOptions law;
  EXPECT_NO_THROW(law.Check());
  law.legs.reset();
  EXPECT_THROW(law.Check(), std::invalid_argument);
  law = {};
  law.least_conditioning = 1;
  EXPECT_THROW(law.Check(), std::invalid_argument);
  law = {};
  law.inverse.damping = -1;
  EXPECT_THROW(law.Check(), std::invalid_argument);
}

TEST(ServoGoal, ShownByItsEdgesIsThatOfThePose) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 20; ++n) {
    const ServoScene scene = RandomScene(generator);
    const ServoGoal by_pose = GoalAtPose(scene.model, scene.pose);
    const ServoGoal shown =
        GoalFromEdges(scene.model, EdgesAt(scene.model, scene.pose), Nearby(scene.pose, 0.03, generator));
    ASSERT_TRUE(shown.base_from_platform && shown.joint_readings_m);
    EXPECT_TRUE(AreNear(Displacement(scene.pose, *shown.base_from_platform), Vector6d::Zero(), 1e-10));
    EXPECT_TRUE(AreNear(*shown.joint_readings_m, *by_pose.joint_readings_m, 1e-10));
    for (size_t leg = 0; leg < kLegCount; ++leg) {
      EXPECT_TRUE(AreNear(*shown.directions[leg], *by_pose.directions[leg], 1e-12));
      for (size_t edge = 0; edge < 2; ++edge) {
        EXPECT_TRUE(AreNear(shown.edges[leg][edge]->normal, by_pose.edges[leg][edge]->normal, 1e-14));
        for (size_t end = 0; end < 2; ++end)
          EXPECT_TRUE(AreNear(shown.edges[leg][edge]->ends[end], by_pose.edges[leg][edge]->ends[end], 1e-14));
      }
    }
  }
}

TEST(ServoGoal, OfTwoLegsHasNoPoseAndSaysSo) {
  std::mt19937_64 generator = TestGenerator();
  const ServoScene scene = RandomScene(generator);
  const ServoGoal goal = GoalFromEdges(
      scene.model, Only(EdgesAt(scene.model, scene.pose), [](int leg, int) { return leg < 2; }), scene.pose);
  EXPECT_FALSE(goal.base_from_platform || goal.joint_readings_m);
  for (const Mode& mode : AllModes()) EXPECT_THROW(DemandGoal(goal, mode.law), std::invalid_argument);
  for (const Mode& mode : AllModes())
    EXPECT_NO_THROW(DemandGoal(GoalAtPose(scene.model, scene.pose), mode.law));
}

TEST(ServoGoal, LacksEdgesOfALegAroundTheCamera) {
  std::mt19937_64 generator = TestGenerator();
  ServoScene scene = RandomScene(generator);
  scene.model.robot.legs[2].radius_m = 5;
  const ServoGoal goal = GoalAtPose(scene.model, scene.pose);
  EXPECT_FALSE(goal.edges[2][0] || goal.edges[2][1]);
  EXPECT_TRUE(goal.directions[2]);
}

}  // namespace
}  // namespace legible
