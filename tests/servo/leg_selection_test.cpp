#include "servo/leg_selection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <iostream>
#include <map>

#include "core/hidden/singularity_conditions.h"
#include "core/robots/leg_state.h"
#include "core/robots/platform_motion.h"
#include "tests/testing/random.h"
#include "tests/testing/random_robots.h"

namespace legible {
namespace {

// e_i = u_i x u_i*, by the leg's ends.
Eigen::VectorXd ErrorsAt(const ParallelRobot& robot, const std::vector<int>& legs, const Rigid3& goal,
                         const Rigid3& pose) {
  Eigen::VectorXd errors(3 * static_cast<Eigen::Index>(legs.size()));
  for (size_t k = 0; k < legs.size(); ++k) {
    const RobotLeg& leg = robot.legs[static_cast<size_t>(legs[k])];
    const auto direction = [&](const Rigid3& at) {
      return (at * leg.platform_joint_m - leg.base_joint_m).normalized().eval();
    };
    errors.segment<3>(static_cast<Eigen::Index>(3 * k)) = direction(pose).cross(direction(goal));
  }
  return errors;
}

// d(errors)/d(twist) by differences.
Eigen::MatrixXd RatesAt(const ParallelRobot& robot, const std::vector<int>& legs, const Rigid3& goal,
                        const Rigid3& pose) {
  Eigen::MatrixXd rates(3 * static_cast<Eigen::Index>(legs.size()), 6);
  for (int k = 0; k < 6; ++k) {
    const Vector6d step = 1e-6 * Vector6d::Unit(k);
    rates.col(k) = (ErrorsAt(robot, legs, goal, Displaced(pose, step)) -
                    ErrorsAt(robot, legs, goal, Displaced(pose, -step))) /
                   2e-6;
  }
  return rates;
}

// Where a servo of the hexapod's directions ends, by Euler's method.
Rigid3 EndOfServo(const ParallelRobot& robot, const std::vector<int>& legs, const Rigid3& from,
                  const Rigid3& to) {
  constexpr double kStep = 0.01;  // gain times time
  Rigid3 pose = from;
  for (int n = 0; n < 2500; ++n) {
    const Eigen::VectorXd errors = ErrorsAt(robot, legs, to, pose);
    if (errors.norm() < 1e-9) break;
    pose = Displaced(pose,
                     -kStep * RatesAt(robot, legs, to, pose).completeOrthogonalDecomposition().solve(errors));
  }
  return pose;
}

// The smallest singular value on the straight way, of the largest.
double LeastOnWay(const ParallelRobot& robot, const std::vector<int>& legs, const Rigid3& from,
                  const Rigid3& to) {
  constexpr int kSamples = 1000;
  double least = 1;
  for (int i = 0; i <= kSamples; ++i) {
    const Rigid3 pose = Displaced(from, i / static_cast<double>(kSamples) * Displacement(from, to));
    const auto values = RatesAt(robot, legs, to, pose).jacobiSvd().singularValues();
    least = std::min(least, values[5] / values[0]);
  }
  return least;
}

bool IsAt(const Rigid3& pose, const Rigid3& goal) { return Displacement(pose, goal).norm() < 1e-3; }

struct Way {
  ParallelRobot robot;
  Rigid3 from, to;
};

Way RandomHexapodWay(std::mt19937_64& generator, double displacement) {
  const GoughStewart hexapod = DesktopHexapod(generator, 0.01);
  Way way{ParallelRobotOf(hexapod), hexapod.home, {}};
  for (RobotLeg& leg : way.robot.legs) leg.joint_range.reset();
  way.from = RandomPoseNear(generator, way.robot, hexapod.home, displacement);
  way.to = RandomPoseNear(generator, way.robot, hexapod.home, displacement);
  return way;
}

// Whether the simulated servo's own way is proved free. Steps near a singularity may leap over it, and where
// such a servo ends depends on them.
bool IsFreeAlong(const Way& way, const JudgedLegSet& set) {
  std::vector<Rigid3> poses;
  for (const DirectionServoSample& sample : set.simulated->samples)
    poses.push_back(sample.base_from_platform);
  return CertifyPath(way.robot, RobotKind::kHidden, set.legs, poses).verdict == PathVerdict::kFree;
}

// What the verdict says is what an independent simulation does. One in steps may leap over a singularity, so
// of legs whose start and goal are in different aspects the way is looked at.
void ExpectVerdictHolds(const Way& way, const JudgedLegSet& set) {
  const auto arrives = [&] { return IsAt(EndOfServo(way.robot, set.legs, way.from, way.to), way.to); };
  switch (set.verdict) {
    case LegSetVerdict::kUncontrollable:
      EXPECT_LT(set.legs.size(), 3);
      break;
    case LegSetVerdict::kOtherAspect:
      EXPECT_LT(LeastOnWay(way.robot, set.legs, way.from, way.to), 1e-4);
      break;
    case LegSetVerdict::kMisled:
      EXPECT_TRUE(!arrives() || !IsFreeAlong(way, set));
      break;
    case LegSetVerdict::kPossible:
      EXPECT_EQ(set.path.verdict, PathVerdict::kFree);
      EXPECT_TRUE(arrives());
      break;
    default:
      break;
  }
}

TEST(SelectLegs, JudgesAllSetsOfAHexapodAsAnIndependentSimulationDoes) {
  std::mt19937_64 generator = TestGenerator();
  for (const double displacement : {0.03, 0.1}) {
    const Way way = RandomHexapodWay(generator, displacement);
    const LegSelection found = SelectLegs(way.robot, way.from, way.to, {});
    ASSERT_EQ(found.sets.size(), 63);
    std::map<std::string, int> verdicts;
    for (const JudgedLegSet& set : found.sets) {
      SCOPED_TRACE(testing::PrintToString(set.legs) + " " + ToString(set.verdict));
      ++verdicts[ToString(set.verdict)];
      EXPECT_EQ(set.why.empty(), set.verdict == LegSetVerdict::kPossible);
      ExpectVerdictHolds(way, set);
    }
    for (const auto& [verdict, count] : verdicts) std::cout << verdict << " " << count << "  ";
    std::cout << std::endl;
    EXPECT_EQ(verdicts["uncontrollable"], 6 + 15);
    ASSERT_TRUE(found.has_choice);
    EXPECT_EQ(found.sets[0].verdict, LegSetVerdict::kPossible);
    EXPECT_TRUE(IsAt(found.sets[0].simulated->samples.back().base_from_platform, way.to));
    EXPECT_TRUE(IsAt(EndOfServo(way.robot, found.sets[0].legs, way.from, way.to), way.to));
  }
}

TEST(SelectLegs, RanksByTheErrorAtTheGoal) {
  std::mt19937_64 generator = TestGenerator();
  const Way way = RandomHexapodWay(generator, 0.02);
  const LegSelection found = SelectLegs(way.robot, way.from, way.to, {});
  double radius_m = 0, last = 0;
  for (const RobotLeg& leg : way.robot.legs) radius_m = std::max(radius_m, leg.platform_joint_m.norm());
  for (const JudgedLegSet& set : found.sets) {
    if (set.verdict != LegSetVerdict::kPossible) break;
    const double displacement_m = set.error_at_goal->position_m + radius_m * set.error_at_goal->rotation_rad;
    EXPECT_GE(displacement_m, last);
    EXPECT_GE(set.error_on_path->position_m, set.error_at_goal->position_m);
    last = displacement_m;
  }
  EXPECT_GT(last, 0);
}

// Whether the straight way passes singularities, and both ends lie on one side of them.
bool PassesAndComesBack(const ParallelRobot& robot, const std::vector<int>& legs, const Rigid3& from,
                        const Rigid3& to) {
  constexpr int kSamples = 20;
  bool has_passed = false;
  double side = 0;
  for (int i = 0; i <= kSamples; ++i) {
    const Rigid3 pose = Displaced(from, i / static_cast<double>(kSamples) * Displacement(from, to));
    const auto measure = Type2MeasureOf(robot, RobotKind::kHidden, legs, pose);
    if (!measure) return false;
    if (i == 0) side = *measure->geometric;
    has_passed = has_passed || *measure->geometric * side < 0;
    if (i == kSamples) return has_passed && *measure->geometric * side > 0;
  }
  return false;
}

// Also where the straight way is not proved free and the simulated one is.
TEST(SelectLegs, PredictsErrorsOnTheSimulatedWay) {
  std::mt19937_64 generator = TestGenerator();
  LegSelectionOptions options;
  options.leg_sets = {{0, 1}};
  int simulated = 0;
  for (int n = 0; n < 10000; ++n) {
    const RobotAtPose random = RandomPlanarRobot(generator, {"_RRR", "_RRR"});
    const Rigid3 to = RandomPoseNear(generator, random.robot, random.pose, 0.8);
    if (!PassesAndComesBack(random.robot, options.leg_sets[0], random.pose, to)) continue;
    const JudgedLegSet set = SelectLegs(random.robot, random.pose, to, options).sets.front();
    if (!set.is_path_simulated) continue;
    EXPECT_EQ(set.verdict, LegSetVerdict::kPossible);
    double largest_m = set.error_at_goal->position_m;
    for (const DirectionServoSample& sample : set.simulated->samples) {
      const auto error = LargestErrorByConeNoise(random.robot, set.legs, sample.base_from_platform,
                                                 options.cone_half_angle_rad);
      largest_m = std::max(largest_m, error->position_m);
    }
    EXPECT_LE(set.error_on_path->position_m, 1.002 * largest_m);
    EXPECT_GE(set.error_on_path->position_m, 0.5 * largest_m);
    ++simulated;
  }
  std::cout << simulated << " ways as simulated" << std::endl;
  EXPECT_GT(simulated, 3);
}

TEST(SelectLegs, PassesOverLegsThatDoNotShow) {
  std::mt19937_64 generator = TestGenerator();
  const Way way = RandomHexapodWay(generator, 0.02);
  LegSelectionOptions options;
  options.is_visible = [](int leg, const Rigid3&) { return leg != 2; };
  int told = 0;
  const LegSelection found = SelectLegs(way.robot, way.from, way.to, options, [&](int judged, int of) {
    EXPECT_EQ(judged, ++told);
    EXPECT_EQ(of, 63);
  });
  EXPECT_EQ(told, 63);
  for (const JudgedLegSet& set : found.sets) {
    const bool has_hidden = std::find(set.legs.begin(), set.legs.end(), 2) != set.legs.end();
    EXPECT_EQ(set.verdict == LegSetVerdict::kInvisible, has_hidden && set.legs.size() >= 3);
    EXPECT_EQ(set.verdict == LegSetVerdict::kInvisible, set.why.starts_with("leg 3 does not show"));
  }
  EXPECT_TRUE(found.has_choice);
}

// All its legs take a hexapod to the goal, and some of them are too short or too long on the way.
TEST(SelectLegs, PassesOverWaysOnWhichALegLeavesItsJointRange) {
  std::mt19937_64 generator = TestGenerator();
  Way way = RandomHexapodWay(generator, 0.03);
  const std::vector<std::vector<int>> all = {{0, 1, 2, 3, 4, 5}};
  LegSelectionOptions options;
  options.leg_sets = all;
  const LegSelection free = SelectLegs(way.robot, way.from, way.to, options);
  ASSERT_TRUE(free.has_choice);
  double least = 1, largest = 0;
  for (const DirectionServoSample& sample : free.sets[0].simulated->samples) {
    const double reading = StateOf(way.robot.legs[3], sample.base_from_platform)->reading;
    least = std::min(least, reading);
    largest = std::max(largest, reading);
  }
  way.robot.legs[3].joint_range = {least - 1e-6, largest + 1e-6};
  EXPECT_TRUE(SelectLegs(way.robot, way.from, way.to, options).has_choice);
  for (const double cut : {least + 0.1 * (largest - least), largest - 0.1 * (largest - least)}) {
    way.robot.legs[3].joint_range = cut < (least + largest) / 2 ? std::array<double, 2>{cut, largest + 1}
                                                                : std::array<double, 2>{least - 1, cut};
    const LegSelection found = SelectLegs(way.robot, way.from, way.to, options);
    EXPECT_FALSE(found.has_choice);
    EXPECT_EQ(found.sets[0].verdict, LegSetVerdict::kOutOfReach);
    EXPECT_TRUE(found.sets[0].why.starts_with("leg 4 leaves its joint range on ")) << found.sets[0].why;
  }
}

// A servo leaves the straight line between its ends, and its legs have to show where it goes.
TEST(SelectLegs, TheChosenLegsShowAlongTheServosOwnWay) {
  std::mt19937_64 generator = TestGenerator();
  int chosen = 0, hidden = 0;
  for (int n = 0; n < 6; ++n) {
    const Way way = RandomHexapodWay(generator, 0.03);
    const Eigen::Vector3d along = (way.to.translation - way.from.translation).normalized();
    const auto off_line_m = [&](const Rigid3& pose) {
      return (pose.translation - way.from.translation).cross(along).norm();
    };
    LegSelectionOptions options;
    options.leg_sets = {{0, 2, 4}, {1, 3, 5}, {0, 1, 3}, {0, 1, 2, 3, 4, 5}};
    options.is_visible = [&](int leg, const Rigid3& pose) { return leg != 1 || off_line_m(pose) < 1e-4; };
    const LegSelection found = SelectLegs(way.robot, way.from, way.to, options);
    for (const JudgedLegSet& set : found.sets)
      if (set.verdict == LegSetVerdict::kInvisible) ++hidden;
    if (!found.has_choice) continue;
    ++chosen;
    const JudgedLegSet& best = found.sets.front();
    if (std::find(best.legs.begin(), best.legs.end(), 1) == best.legs.end()) continue;
    for (const DirectionServoSample& sample : best.simulated->samples)
      EXPECT_LT(off_line_m(sample.base_from_platform), 1.1e-4);
  }
  EXPECT_GT(chosen, 0);
  EXPECT_GT(hidden, 0);
}

// All three legs of a 3-RPS are needed, and proved to lead there on the straight way brought back to their
// planes.
TEST(SelectLegs, ProvesTheWayOfRpsLegs) {
  std::mt19937_64 generator = TestGenerator();
  int possible = 0;
  for (int n = 0; n < 10; ++n) {
    const RobotAtPose random = RandomSpatialRobot(generator, {"R_PS", "R_PS", "R_PS"});
    const Rigid3 to = RandomPoseNear(generator, random.robot, random.pose, 0.02);
    const LegSelection found = SelectLegs(random.robot, random.pose, to, {});
    ASSERT_EQ(found.sets.size(), 7);
    for (const JudgedLegSet& set : found.sets) {
      EXPECT_EQ(set.verdict == LegSetVerdict::kUncontrollable, set.legs.size() < 3);
      if (set.verdict != LegSetVerdict::kPossible) continue;
      ++possible;
      EXPECT_EQ(set.path.verdict, PathVerdict::kFree);
    }
  }
  std::cout << possible << " of 10 are possible\n";
  EXPECT_GE(possible, 8);
}

TEST(SelectLegs, HasNoChoiceWhereTheGoalIsOutOfReach) {
  std::mt19937_64 generator = TestGenerator();
  const RobotAtPose random = RandomTranslationRobot(generator, {"_R-{2-US}", "_R-{2-US}", "_R-{2-US}"});
  Rigid3 far = random.pose;
  far.translation.z() -= 5;
  const LegSelection found = SelectLegs(random.robot, random.pose, far, {});
  EXPECT_FALSE(found.has_choice);
  for (const JudgedLegSet& set : found.sets) EXPECT_EQ(set.verdict, LegSetVerdict::kOutOfReach);
}

}  // namespace
}  // namespace legible
