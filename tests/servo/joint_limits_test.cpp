#include "servo/joint_limits.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

#include "core/rig/drives.h"
#include "servo/servo_step.h"
#include "tests/servo/servo_scene.h"
#include "tests/testing/matrices.h"

namespace legible {
namespace {

struct Problem {
  SpeedBounds bounds;
  Matrix6d metric;
  Vector6d wanted;
};

// Bounds that hold 0, some of them at 0, some joints held altogether.
Problem RandomProblem(std::mt19937_64& generator) {
  Problem problem;
  for (int i = 0; i < 6; ++i) {
    problem.bounds.lowest[i] = Uniform(generator, 0, 1) < 0.3 ? 0 : -Uniform(generator, 0, 1);
    problem.bounds.highest[i] = Uniform(generator, 0, 1) < 0.3 ? 0 : Uniform(generator, 0, 1);
    problem.wanted[i] = Uniform(generator, -2, 2);
    for (int j = 0; j < 6; ++j) problem.metric(i, j) = Uniform(generator, -1, 1);
  }
  problem.metric += 0.5 * Matrix6d::Identity();
  return problem;
}

// Best speeds of the joints with a 0 in `held`, the others at their lowest (1) or highest (2).
Vector6d BestOf(const Problem& problem, const std::array<int, 6>& held) {
  const Matrix6d hessian = problem.metric.transpose() * problem.metric;
  std::vector<int> free;
  Vector6d speeds = Vector6d::Zero();
  for (int i = 0; i < 6; ++i) {
    const auto at = held[static_cast<size_t>(i)];
    if (at == 0) free.push_back(i);
    if (at == 1) speeds[i] = problem.bounds.lowest[i];
    if (at == 2) speeds[i] = problem.bounds.highest[i];
  }
  if (free.empty()) return speeds;
  const Eigen::VectorXd right = (hessian * (problem.wanted - speeds))(free);
  speeds(free) += Eigen::MatrixXd(hessian(free, free)).fullPivLu().solve(right);
  return speeds;
}

bool IsWithin(const SpeedBounds& bounds, const Vector6d& speeds) {
  return (speeds.array() >= bounds.lowest.array()).all() && (speeds.array() <= bounds.highest.array()).all();
}

// Over all 3^6 ways to hold joints at bounds.
Vector6d ByBruteForce(const Problem& problem) {
  Vector6d best = Vector6d::Zero();
  double least = 1e300;
  for (int way = 0; way < 729; ++way) {
    std::array<int, 6> held;
    int rest = way;
    for (int& at : held) {
      at = rest % 3;
      rest /= 3;
    }
    const Vector6d speeds = BestOf(problem, held);
    const double cost = (problem.metric * (speeds - problem.wanted)).norm();
    if (!IsWithin(problem.bounds, speeds) || cost >= least) continue;
    least = cost;
    best = speeds;
  }
  return best;
}

TEST(NearestWithin, IsTheBestOfAllWaysToHoldJointsAtTheirBounds) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 300; ++n) {
    const Problem problem = RandomProblem(generator);
    const Vector6d found = NearestWithin(problem.bounds, problem.metric, problem.wanted);
    EXPECT_TRUE(AreNear(found, ByBruteForce(problem), 1e-9));
  }
}

TEST(NearestWithin, MeetsTheConditionsOfAnOptimum) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 2000; ++n) {
    Problem problem = RandomProblem(generator);
    // Metrics of servos are far from round.
    for (int i = 0; i < 6; ++i) problem.metric.row(i) *= std::pow(10, Uniform(generator, -3, 3));
    const Vector6d found = NearestWithin(problem.bounds, problem.metric, problem.wanted);
    EXPECT_TRUE(IsWithin(problem.bounds, found));
    const Matrix6d hessian = problem.metric.transpose() * problem.metric;
    const Vector6d pull = hessian * (problem.wanted - found);
    const double nothing = 1e-8 * hessian.norm();
    for (int i = 0; i < 6; ++i) {
      if (found[i] > problem.bounds.lowest[i]) {
        EXPECT_GE(pull[i], -nothing);
      }
      if (found[i] < problem.bounds.highest[i]) {
        EXPECT_LE(pull[i], nothing);
      }
    }
  }
}

TEST(NearestWithin, LeavesWhatIsWithinAlone) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 100; ++n) {
    Problem problem = RandomProblem(generator);
    problem.wanted = problem.wanted.cwiseMax(problem.bounds.lowest).cwiseMin(problem.bounds.highest);
    EXPECT_TRUE(AreNear(NearestWithin(problem.bounds, problem.metric, problem.wanted), problem.wanted, 1e-9));
  }
}

TEST(BoundsByRange, KeepZeroAndLeadNoFartherThanTheMargin) {
  std::mt19937_64 generator = TestGenerator();
  const GoughStewart robot = DesktopHexapod(generator, 0);
  JointLimitOptions options;
  for (int n = 0; n < 500; ++n) {
    options.range_margin_m = Uniform(generator, 0, 2e-3);
    options.look_ahead_s = Uniform(generator, 0.05, 1);
    Vector6d readings_m, way_m;
    for (int i = 0; i < 6; ++i) {
      const auto [shortest_m, longest_m] = robot.legs[static_cast<size_t>(i)].joint_range_m;
      readings_m[i] = Uniform(generator, shortest_m - 2e-3, longest_m + 2e-3);
      way_m[i] = Uniform(generator, -0.02, 0.02);
    }
    const SpeedBounds bounds = BoundsByRange(robot, readings_m, way_m, options);
    for (int i = 0; i < 6; ++i) {
      const auto [shortest_m, longest_m] = robot.legs[static_cast<size_t>(i)].joint_range_m;
      EXPECT_LE(bounds.lowest[i], 0);
      EXPECT_GE(bounds.highest[i], 0);
      // Wherever it is between its reading and where it was commanded to.
      for (const double share : {0.0, 0.5, 1.0}) {
        const double now_m = readings_m[i] + share * way_m[i];
        const double lowest_m = now_m + options.look_ahead_s * bounds.lowest[i];
        const double highest_m = now_m + options.look_ahead_s * bounds.highest[i];
        if (bounds.lowest[i] < 0) {
          EXPECT_GE(lowest_m, shortest_m + options.range_margin_m - 1e-12);
        }
        if (bounds.highest[i] > 0) {
          EXPECT_LE(highest_m, longest_m - options.range_margin_m + 1e-12);
        }
      }
    }
  }
}

// How near all joints come to the ends of their ranges if they are driven at their bounds: first long in one
// direction each, then to and fro.
double ClosestToAnEnd(const DriveOptions& drive, const JointLimitOptions& limits, double period_s,
                      std::mt19937_64& generator) {
  const GoughStewart robot = DesktopHexapod(generator, 0);
  const double straight_s = 3 + 12 * limits.look_ahead_s;
  Vector6d start_m;
  start_m << UniformVector(generator, 0.35, 0.48), UniformVector(generator, 0.35, 0.48);
  Drives drives(drive, robot, start_m, 1);
  double closest_m = 1;
  Vector6d towards = (start_m.array() > 0.4).select(Vector6d::Ones(), -Vector6d::Ones());
  for (double time_s = 0; time_s < 2 * straight_s; time_s += period_s) {
    for (double& side : towards)
      if (time_s > straight_s && Uniform(generator, 0, 1) < 0.02) side = -side;
    const SpeedBounds bounds = BoundsByRange(robot, drives.joint_readings_m(), Vector6d::Zero(), limits);
    drives.Command((towards.array() > 0).select(bounds.highest, bounds.lowest).cwiseMax(-0.1).cwiseMin(0.1));
    drives.Advance(period_s);
    const Vector6d readings_m = drives.joint_readings_m();
    for (int i = 0; i < 6; ++i) {
      const auto [shortest_m, longest_m] = robot.legs[static_cast<size_t>(i)].joint_range_m;
      closest_m = std::min({closest_m, readings_m[i] - shortest_m, longest_m - readings_m[i]});
    }
  }
  return closest_m;
}

TEST(BoundsByRange, LetNoJointWithALagPassItsMarginHoweverItIsDrivenWithinThem) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 60; ++n) {
    DriveOptions drive;
    drive.lag_s = n % 5 == 0 ? 0 : Uniform(generator, 0.002, 0.1);
    drive.speed_limit_m_per_s = 0.1;
    const double period_s = Uniform(generator, 0.005, 0.06);
    JointLimitOptions limits;
    limits.look_ahead_s = 4 * (drive.lag_s + period_s);
    const double closest_m = ClosestToAnEnd(drive, limits, period_s, generator);
    EXPECT_GE(closest_m, limits.range_margin_m - 1e-12) << "lag " << drive.lag_s << " period " << period_s;
    EXPECT_LT(closest_m, limits.range_margin_m + 1e-4);  // it got there
  }
}

ServoStepOptions JointStep() {
  ServoStepOptions options;
  options.law.mode = ControlMode::kJoints;
  options.gain = AdaptiveGain::Constant(5);
  return options;
}

// All joints to go by way_m.
ServoStep StepBy(ServoScene scene, const Vector6d& way_m, const ServoStepOptions& options,
                 const std::array<double, 2>& range_m) {
  for (Leg& leg : scene.model.robot.legs) leg.joint_range_m = range_m;
  const Vector6d readings_m = InverseKinematics(scene.model.robot, scene.pose);
  ServoGoal goal;
  goal.joint_readings_m = readings_m + way_m;
  return EvaluateStep(scene.model, goal, {{}, readings_m, Vector6d::Zero(), scene.pose}, options);
}

TEST(ServoStep, SlowsAllJointsByOneFactorSoThatTheFastestKeepsItsLimit) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 100; ++n) {
    Vector6d way_m;
    way_m << UniformVector(generator, -0.05, 0.05), UniformVector(generator, -0.05, 0.05);
    const ServoStep step = StepBy(RandomScene(generator), way_m, JointStep(), {-10, 10});
    int fastest = 0;
    const double wanted = 5 * way_m.cwiseAbs().maxCoeff(&fastest);
    if (wanted <= 0.05) continue;
    EXPECT_TRUE(AreNear(step.joint_speeds_m_per_s, 0.05 / wanted * 5 * way_m, 1e-14));
    EXPECT_LE(step.joint_speeds_m_per_s.cwiseAbs().maxCoeff(), 0.05);
    EXPECT_EQ(step.fastest_leg, fastest);
    EXPECT_NEAR(step.speed_factor, 0.05 / wanted, 1e-14);
    EXPECT_NE(
        DescribeLimits(step).find("so that leg " + std::to_string(fastest + 1) + " keeps its speed limit"),
        std::string::npos);
  }
}

// The end of a range is farther than the speed limit leads.
TEST(ServoStep, IsNotTurnedAsideByARangeThatItsSpeedLimitKeeps) {
  std::mt19937_64 generator = TestGenerator();
  const ServoScene scene = RandomScene(generator);
  const Vector6d readings_m = InverseKinematics(scene.model.robot, scene.pose);
  Vector6d way_m;
  way_m << 0.5, 0.02, -0.03, 0.01, 0.04, -0.02;
  ServoStepOptions options = JointStep();
  options.gain = AdaptiveGain::Constant(1);
  ASSERT_GT(way_m[0], 0.02 / options.limits.look_ahead_s);
  const std::array<double, 2> range_m = {readings_m.minCoeff() - 0.1, readings_m.maxCoeff() + 0.02};
  const ServoStep step = StepBy(scene, way_m, options, range_m);
  EXPECT_TRUE(AreNear(step.joint_speeds_m_per_s, 0.05 / 0.5 * way_m, 1e-12));
  EXPECT_FALSE(step.at_longest.any());
  // At the end it is held.
  const std::array<double, 2> near_m = {readings_m.minCoeff() - 0.1, readings_m[0] + 5e-4};
  const ServoStep held = StepBy(scene, way_m, options, near_m);
  EXPECT_EQ(held.joint_speeds_m_per_s[0], 0);
  EXPECT_TRUE(held.at_longest[0]);
}

TEST(ServoStep, HoldsAJointAtTheEndOfItsRangeAndSaysWhich) {
  std::mt19937_64 generator = TestGenerator();
  const ServoScene scene = RandomScene(generator);
  const double longest_m = InverseKinematics(scene.model.robot, scene.pose).maxCoeff();
  int leg = 0;
  InverseKinematics(scene.model.robot, scene.pose).maxCoeff(&leg);
  const ServoStep step = StepBy(scene, Vector6d::Constant(1e-3), JointStep(), {0.1, longest_m + 4e-4});
  EXPECT_EQ(step.joint_speeds_m_per_s[leg], 0);
  EXPECT_TRUE(step.at_longest[static_cast<size_t>(leg)]);
  EXPECT_FALSE(step.at_shortest.any());
  EXPECT_EQ(DescribeLimits(step), LegList(step.at_longest) + " held back at the longest");
  const ServoStep free = StepBy(scene, Vector6d::Constant(1e-3), JointStep(), {0.1, longest_m + 0.1});
  EXPECT_EQ(DescribeLimits(free), "");
}

// Smallest over largest singular value of the inverse Jacobian, rotations by the platform's radius.
double RobotConditioning(const ServoModel& model, const Rigid3& pose) {
  Vector6d scale = Vector6d::Ones();
  scale.tail<3>().setConstant(1 / model.platform_radius_m);
  const Eigen::MatrixXd jacobian = InverseJacobian(model.robot, pose) * scale.asDiagonal();
  const Eigen::VectorXd values = Eigen::BDCSVD<Eigen::MatrixXd>(jacobian).singularValues();
  return values[5] / values[0];
}

TEST(ServoStep, SlowsDownTowardsASingularityButNotOnTheWayOut) {
  std::mt19937_64 generator = TestGenerator();
  int ways_in = 0, ways_out = 0;
  for (int n = 0; n < 20; ++n) {
    const ServoScene scene = RandomScene(generator);
    const Vector6d readings_m = InverseKinematics(scene.model.robot, scene.pose);
    const Vector6d way = UniformVector(generator, -1e-3, 1e-3).replicate<2, 1>();
    ServoStepOptions options = JointStep();
    const ServoStep free = StepBy(scene, way, options, {-10, 10});
    EXPECT_EQ(free.singularity_factor, 1);
    EXPECT_NEAR(free.law.robot_conditioning, RobotConditioning(scene.model, scene.pose), 1e-12);
    // The robot's conditioning lies at twice the least, halfway between 1 and 3 times.
    options.law.least_robot_conditioning = free.law.robot_conditioning / 2;
    const ServoStep near = StepBy(scene, way, options, {-10, 10});
    const Rigid3 ahead =
        ForwardKinematics(scene.model.robot, readings_m + 0.1 * way, scene.pose).base_from_platform;
    if (RobotConditioning(scene.model, ahead) > free.law.robot_conditioning) {
      EXPECT_EQ(near.singularity_factor, 1);
      EXPECT_EQ(near.joint_speeds_m_per_s, free.joint_speeds_m_per_s);
      ++ways_out;
      continue;
    }
    ++ways_in;
    EXPECT_NEAR(near.singularity_factor, 0.5, 1e-12);
    EXPECT_EQ(near.slowed_by, SlowedBy::kRobotSingularity);
    EXPECT_TRUE(AreNear(near.joint_speeds_m_per_s, 0.5 * free.joint_speeds_m_per_s, 1e-15));
    EXPECT_NE(DescribeLimits(near).find("slowed to 50 % near a singularity of the robot"), std::string::npos);
  }
  EXPECT_GE(ways_in, 3);
  EXPECT_GE(ways_out, 3);
}

// A joint that its range holds turns the motion: what counts is where the speeds lead that are sent.
TEST(ServoStep, SlowsTheSpeedsThatARangeHasTurnedTowardsASingularity) {
  std::mt19937_64 generator = TestGenerator();
  int turned = 0;
  for (int n = 0; n < 200; ++n) {
    const ServoScene scene = RandomScene(generator);
    const Vector6d readings_m = InverseKinematics(scene.model.robot, scene.pose);
    const Vector6d way = UniformVector(generator, -1e-3, 1e-3).replicate<2, 1>();
    const std::array<double, 2> range_m = {readings_m.minCoeff() - 0.1, readings_m.maxCoeff()};
    ServoStepOptions options = JointStep();
    const auto leads_in = [&](const ServoStep& step) {
      const Vector6d ahead_m = readings_m + 1e-3 * step.joint_speeds_m_per_s;
      const Rigid3 ahead = ForwardKinematics(scene.model.robot, ahead_m, scene.pose).base_from_platform;
      return RobotConditioning(scene.model, ahead) < step.law.robot_conditioning;
    };
    const ServoStep free = StepBy(scene, way, options, {-10, 10}),
                    held = StepBy(scene, way, options, range_m);
    options.law.least_robot_conditioning = free.law.robot_conditioning / 2;
    const ServoStep slowed = StepBy(scene, way, options, range_m);
    if (held.joint_speeds_m_per_s.norm() < 1e-6 || leads_in(free) == leads_in(held)) continue;
    ++turned;
    EXPECT_EQ(slowed.singularity_factor < 1, leads_in(held));
  }
  EXPECT_GE(turned, 3);
}

TEST(ServoStep, RefusesOptionsOutOfRange) {
  EXPECT_NO_THROW(JointStep().Check());
  ServoStepOptions options = JointStep();
  options.slow_conditioning = 1;
  EXPECT_THROW(options.Check(), std::invalid_argument);
  options = JointStep();
  options.limits.look_ahead_s = 0.99 * Rig::kCommandHolds_s;
  EXPECT_THROW(options.Check(), std::invalid_argument);
  options = JointStep();
  options.limits.speed_limit_m_per_s = -1;
  EXPECT_THROW(options.Check(), std::invalid_argument);
}

TEST(LegList, CountsFromOne) {
  EXPECT_EQ(LegList(0b000010), "leg 2");
  EXPECT_EQ(LegList(0b001001), "legs 1 and 4");
  EXPECT_EQ(LegList(0b010011), "legs 1, 2 and 5");
}

}  // namespace
}  // namespace legible
