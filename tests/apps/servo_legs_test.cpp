// `legible servo` by some of the legs, with images: where legs that are named mislead it, and that those
// which it chooses do not.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "apps/wording.h"
#include "core/hidden/assembly_modes.h"
#include "tests/apps/program_fixture.h"
#include "tests/testing/hexapod_servo.h"

namespace legible {
namespace {

using testing::HasSubstr;

Rigid3 PoseOf(const std::array<double, 6>& numbers) {
  const Vector6d coordinates(numbers.data());
  return {RotationFromVector(coordinates.tail<3>()), coordinates.head<3>()};
}

// Found by tests/reproduction/hexapod_misled.h, with the numbers of docs/reproduction.md.
const std::vector<int> kMisledLegs = {0, 1, 5};
HexapodWay MisledWay() {
  return {PoseOf({-0.0152, 0.0370, 0.3798, -0.0776, -0.0720, 0.7629}),
          PoseOf({-0.0113, 0.0402, 0.3666, 0.1338, -0.2654, 0.8578})};
}

// How far the run's end is from a pose.
Vector6d Off(const ServoedHexapod& servoed, const Rigid3& pose) {
  return Displacement(pose, servoed.true_end);
}

class ServoByLegs : public testing::Test {
 protected:
  ServoedHexapod Servo(const HexapodWay& way, const std::vector<std::string>& options) const {
    return ServoHexapod(folder_.path() / "servo", way, options);
  }
  // Of the watched legs at the goal, that which is nearest to the run's end.
  Rigid3 NearestMode(const ServoedHexapod& servoed, const Rigid3& goal) const {
    const auto modes = AssemblyModesOf(ParallelRobotOf(robot_), servoed.legs, goal).modes;
    return std::min_element(modes.begin(), modes.end(),
                            [&](const AssemblyMode& a, const AssemblyMode& b) {
                              return Off(servoed, a.base_from_platform).norm() <
                                     Off(servoed, b.base_from_platform).norm();
                            })
        ->base_from_platform;
  }
  std::string Log(const std::string& name) const { return Bytes(folder_.path() / "servo/log" / name); }

  const GoughStewart robot_ = ShippedHexapod().robot;
  TemporaryFolder folder_;
};

TEST_F(ServoByLegs, ThatMisleadEndsWhereItWarnedOfAndByThoseChosenAtTheGoal) {
  const HexapodWay way = MisledWay();
  for (const std::string mode : {"directions", "edges"}) {
    SCOPED_TRACE(mode);
    const ServoedHexapod misled = Servo(way, {"--mode", mode, "--legs", LegNumbers(kMisledLegs)});
    EXPECT_EQ(misled.status, "converged") << misled.said;
    const Rigid3 other = NearestMode(misled, way.to);
    EXPECT_GT(Displacement(way.to, other).tail<3>().norm(), 0.2);
    EXPECT_LT(Off(misled, other).head<3>().norm(), 3e-3);
    EXPECT_LT(Off(misled, other).tail<3>().norm(), 0.05);
    const std::vector<Eigen::Vector3d> warned_m = WarnedPositions_m(misled.said);
    EXPECT_TRUE(std::any_of(warned_m.begin(), warned_m.end(), [&](const Eigen::Vector3d& it) {
      return (it - other.translation).norm() < 1e-3;
    })) << misled.said;

    const ServoedHexapod chosen = Servo(way, {"--mode", mode, "--legs", "auto"});
    EXPECT_EQ(chosen.status, "converged") << chosen.said;
    EXPECT_TRUE(WarnedPositions_m(chosen.said).empty()) << chosen.said;
    EXPECT_LT(chosen.position_m, 1e-3);
    EXPECT_LT(chosen.rotation_rad, 3e-3);
  }
}

// Starts and goals drawn within the joint ranges.
TEST_F(ServoByLegs, ThatItChoosesEndsAtTheGoalAndInNoOtherMode) {
  std::cout << "seed " << kHexapodWaysSeed << std::endl;
  for (const HexapodWay& way : DrawHexapodWays(robot_, 10)) {
    const ServoedHexapod servoed = Servo(way, {"--legs", "auto"});
    ASSERT_EQ(servoed.exit_code, kExitSuccess) << servoed.said;
    EXPECT_LT(Displacement(NearestMode(servoed, way.to), way.to).norm(), 1e-6);
    EXPECT_LT(servoed.position_m, 1e-3);
    EXPECT_LT(servoed.rotation_rad, 3e-3);
    std::cout << fmt::format("legs {}: {:.3f} mm, {:.3f} mrad, {:.1f} s\n", LegNumbers(servoed.legs),
                             1e3 * servoed.position_m, 1e3 * servoed.rotation_rad, servoed.time_s);
  }
}

// What is looked at beforehand moves nothing and draws no noise.
TEST_F(ServoByLegs, ThatItChoosesIsTheSameRunAsByTheSameLegsNamed) {
  const HexapodWay way = DrawHexapodWays(robot_, 1).front();
  const ServoedHexapod chosen = Servo(way, {"--image-free", "--legs", "auto"});
  const std::string edges = Log("edges.csv");
  ASSERT_THAT(edges, HasSubstr("n_x"));
  const ServoedHexapod named = Servo(way, {"--image-free", "--legs", LegNumbers(chosen.legs)});
  EXPECT_EQ(Log("edges.csv"), edges);
  EXPECT_EQ(named.time_s, chosen.time_s);
  EXPECT_EQ(named.final_error, chosen.final_error);
  EXPECT_EQ(Displacement(named.true_end, chosen.true_end).norm(), 0);
}

}  // namespace
}  // namespace legible
