// Assembly modes of random hidden robots of every family, LEGIBLE_RANDOM_CASES of each.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iostream>
#include <limits>
#include <map>
#include <numbers>

#include "core/hidden/assembly_modes.h"
#include "core/robots/leg_state.h"
#include "core/robots/platform_motion.h"
#include "tests/core/hidden/exact_pose_count.h"
#include "tests/testing/random.h"
#include "tests/testing/random_robots.h"

namespace legible {
namespace {

struct Family {
  const char* name;
  int most_possible;  // by the paper's sections 4.1 and 4.2
  std::vector<int> legs;
  std::function<RobotAtPose(std::mt19937_64&)> draw;
};

std::ostream& operator<<(std::ostream& stream, const Family& family) { return stream << family.name; }

// A Schoenflies robot whose first two legs have arms in planes that are parallel exactly.
RobotAtPose InParallelPlanes(std::mt19937_64& generator) {
  for (;;) {
    RobotAtPose random = RandomSchoenfliesRobot(generator, "_R-{2-US}");
    for (RobotLeg& leg : random.robot.legs) {
      leg.first_axis = Eigen::Vector3d::UnitY();
      leg.zero_direction = Eigen::Vector3d::UnitX();
    }
    std::swap(random.robot.legs[1], random.robot.legs[2]);  // one leg of each half
    const auto reaches = [&](const RobotLeg& leg) {
      const auto state = StateOf(leg, random.pose);
      return state && std::abs(state->direction.dot(state->free_direction)) > 0.1;
    };
    if (std::all_of(random.robot.legs.begin(), random.robot.legs.end(), reaches)) return random;
  }
}

std::function<RobotAtPose(std::mt19937_64&)> Planar(const std::vector<std::string>& chains) {
  return [chains](std::mt19937_64& generator) { return RandomPlanarRobot(generator, chains); };
}
std::function<RobotAtPose(std::mt19937_64&)> Spatial(const std::string& chain) {
  return [chain](std::mt19937_64& generator) {
    return RandomSpatialRobot(generator, std::vector<std::string>(chain == "R_PS" ? 3 : 6, chain));
  };
}
std::function<RobotAtPose(std::mt19937_64&)> Schoenflies(const std::string& chain) {
  return [chain](std::mt19937_64& generator) { return RandomSchoenfliesRobot(generator, chain); };
}

RobotAtPose RailAndArm(std::mt19937_64& generator) {
  return RandomSchoenfliesRobot(generator, {"_P-{2-US}", "_R-{2-US}", "_R-{2-US}", "_P-{2-US}"});
}

std::vector<Family> Families() {
  return {
      {"RRRRR", 2, {0, 1}, Planar({"R_RR", "_RRR"})},
      {"RPRPR", 2, {0, 1}, Planar({"_RPR", "R_PR"})},
      {"PRRRP", 2, {0, 1}, Planar({"_PRR", "P_RR"})},
      {"RRRPR", 2, {0, 1}, Planar({"_RRR", "R_PR"})},
      {"3-RRR", 6, {0, 1, 2}, Planar({"_RRR", "_RRR", "R_RR"})},
      {"3-RPR", 2, {0, 1, 2}, Planar({"R_PR", "_RPR", "R_PR"})},
      {"3-PRR", 2, {0, 1, 2}, Planar({"_PRR", "_PRR", "P_RR"})},
      {"2-RRR-PRR", 6, {0, 1, 2}, Planar({"_RRR", "_PRR", "_RRR"})},
      {"RRR-2-RPR", 4, {0, 1, 2}, Planar({"R_PR", "_RRR", "R_PR"})},
      {"6-UPS, three legs", 8, {1, 3, 5}, Spatial("U_PS")},
      {"3-RPS", 8, {0, 1, 2}, Spatial("R_PS")},
      {"6-PUS, three legs", 8, {0, 1, 2}, Spatial("_PUS")},
      {"Quattro, a pair", 8, {0, 3}, Schoenflies("_R-{2-US}")},
      {"Quattro, a pair in parallel planes", 4, {0, 1}, InParallelPlanes},
      {"Quattro on rails, a pair", 2, {1, 2}, Schoenflies("_P-{2-US}")},
      {"Quattro with a rail and an arm", 4, {0, 2}, RailAndArm},
      {"Quattro with an arm and a rail", 4, {1, 3}, RailAndArm},
      {"6-RUS, three legs", 16, {0, 2, 4}, Spatial("_RUS")},
  };
}

// How far the direction of the leg at the pose is from the one wanted, in the nearer working mode, or in the
// robot's own alone.
double DirectionError(RobotLeg leg, const Rigid3& pose, const Eigen::Vector3d& wanted, bool own_mode_only) {
  double error = std::numeric_limits<double>::infinity();
  for (int i = 0; i < (own_mode_only ? 1 : 2); ++i) {
    if (const auto state = StateOf(leg, pose)) error = std::min(error, (state->direction - wanted).norm());
    leg.working_mode = -leg.working_mode;
  }
  return error;
}

void ExpectDirectionsAgree(const RobotAtPose& random, const std::vector<int>& legs,
                           const AssemblyModes& found) {
  for (const AssemblyMode& mode : found.modes) {
    EXPECT_TRUE(CanTake(random.robot, mode.base_from_platform));
    EXPECT_LT(mode.largest_direction_error, 1e-9);
    for (const int leg : legs) {
      const RobotLeg& it = random.robot.legs[static_cast<size_t>(leg)];
      EXPECT_LT(DirectionError(it, mode.base_from_platform, StateOf(it, random.pose)->direction,
                               mode.has_own_working_modes),
                1e-9);
    }
  }
}

void ExpectModesDiffer(const AssemblyModes& found) {
  for (size_t i = 0; i < found.modes.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      EXPECT_GT(Displacement(found.modes[i].base_from_platform, found.modes[j].base_from_platform).norm(),
                1e-8);
}

class RandomHiddenRobots : public testing::TestWithParam<Family> {};

TEST_P(RandomHiddenRobots, HaveAsManyAssemblyModesAsAnExactCountSays) {
  std::mt19937_64 generator = TestGenerator();
  const Family& family = GetParam();
  int complete = 0;
  std::map<int, int> histogram;
  for (int i = 0; i < LEGIBLE_RANDOM_CASES; ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    const RobotAtPose random = family.draw(generator);
    const AssemblyModes found = AssemblyModesOf(random.robot, family.legs, random.pose);
    const auto exact = ExactPoseCount(random.robot, family.legs, random.pose);
    ASSERT_FALSE(found.modes.empty());
    EXPECT_EQ(found.most_possible, family.most_possible);
    EXPECT_LT(Displacement(found.modes[0].base_from_platform, random.pose).norm(), 1e-8);
    ExpectDirectionsAgree(random, family.legs, found);
    ExpectModesDiffer(found);
    const int count = static_cast<int>(found.modes.size() + found.reversed.size());
    ++histogram[count];
    EXPECT_LE(count, family.most_possible);
    ASSERT_TRUE(exact.has_value());
    EXPECT_LE(exact->degree, family.most_possible);
    if (found.status == AssemblyModesStatus::kComplete) {
      ++complete;
      EXPECT_EQ(count, exact->count);
    } else {
      std::cout << "case " << i << ": " << found.why << ", found " << count << " of exactly " << exact->count
                << ", degree " << exact->degree << "\n";
      EXPECT_LE(count, exact->count);
    }
  }
  std::cout << family.name << ": " << complete << " of " << LEGIBLE_RANDOM_CASES << " complete; real poses:";
  for (const auto& [count, cases] : histogram) std::cout << " " << count << " in " << cases;
  std::cout << std::endl;
}

INSTANTIATE_TEST_SUITE_P(All, RandomHiddenRobots, testing::ValuesIn(Families()));

// Appendix B of the paper, with D_1 and D_2 so that its published assembly modes come out.
ParallelRobot AdeptQuattro() {
  const std::array<Eigen::Vector3d, 4> from_d_m = {
      {{-0.066, -0.048, 0}, {0.066, -0.048, 0}, {0.066, 0.048, 0}, {-0.066, 0.048, 0}}};
  ParallelRobot robot;
  robot.motion = PlatformMotion::kSchoenflies;
  robot.home.translation = {0, 0, -0.7};
  for (size_t i = 0; i < 4; ++i) {
    const double angle_rad = std::numbers::pi / 2 * (static_cast<double>(i) - 1.5);
    RobotLeg leg;
    leg.chain = ChainFromText("_R-{2-US}");
    leg.zero_direction = {std::cos(angle_rad), std::sin(angle_rad), 0};
    leg.base_joint_m = 0.275 * leg.zero_direction;
    leg.first_axis = leg.zero_direction.cross(Eigen::Vector3d::UnitZ());
    leg.arm_m = 0.38;
    leg.rod_m = 0.825;
    leg.carried_offset_m = from_d_m[i] + Eigen::Vector3d(-0.0256, i < 2 ? -0.0390 : -0.0239, 0);
    if (i >= 2) leg.platform_joint_m = {0, 0.0613, 0};
    robot.legs.push_back(leg);
  }
  return robot;
}

// Robots of regular shape have roots that are multiple, at infinity, or nearly so: what is called complete
// there has to be that, too. Returns how many were.
int CompleteAndAsCounted(const ParallelRobot& robot, const std::vector<int>& legs,
                         const std::vector<Rigid3>& poses) {
  int complete = 0;
  for (const Rigid3& pose : poses) {
    const AssemblyModes found = AssemblyModesOf(robot, legs, pose);
    const auto exact = ExactPoseCount(robot, legs, pose);
    ExpectDirectionsAgree({robot, pose}, legs, found);
    EXPECT_LT(Displacement(found.modes.at(0).base_from_platform, pose).norm(), 1e-8);
    if (found.status != AssemblyModesStatus::kComplete) continue;
    ++complete;
    EXPECT_TRUE(exact.has_value());
    EXPECT_EQ(static_cast<int>(found.modes.size() + found.reversed.size()), exact ? exact->count : -1);
  }
  return complete;
}

TEST(RegularHiddenRobots, AreCompleteWhereTheySaySo) {
  std::mt19937_64 generator = TestGenerator();
  const ParallelRobot quattro = AdeptQuattro(), hexapod = ParallelRobotOf(DesktopHexapod(generator, 0));
  std::vector<Rigid3> quattro_poses, hexapod_poses, on_axis;
  for (int i = 0; i < LEGIBLE_RANDOM_CASES / 4; ++i) {
    quattro_poses.push_back({RotationFromVector({0, 0, Uniform(generator, -0.7, 0.7)}),
                             Eigen::Vector3d(0, 0, -0.7) + UniformVector(generator, -0.1, 0.1)});
    hexapod_poses.push_back(RandomPoseNear(generator, hexapod, hexapod.home, 0.1));
    on_axis.push_back(
        {RotationFromVector({0, 0, i % 2 == 0 ? 0.0 : 0.01 * i}), {0, 0, 0.25 + 0.01 * (i % 20)}});
  }
  for (const std::vector<int>& legs : {std::vector<int>{0, 3}, {1, 2}, {0, 2}, {1, 3}})
    std::cout << "Adept Quattro, legs " << testing::PrintToString(legs) << ": "
              << CompleteAndAsCounted(quattro, legs, quattro_poses) << " of " << quattro_poses.size()
              << " complete\n";
  for (const std::vector<int>& legs : {std::vector<int>{0, 2, 4}, {0, 1, 2}})
    std::cout << "regular hexapod, legs " << testing::PrintToString(legs) << ": "
              << CompleteAndAsCounted(hexapod, legs, hexapod_poses) << " of " << hexapod_poses.size()
              << " complete, on its axis " << CompleteAndAsCounted(hexapod, legs, on_axis) << " of "
              << on_axis.size() << "\n";
}

}  // namespace
}  // namespace legible
