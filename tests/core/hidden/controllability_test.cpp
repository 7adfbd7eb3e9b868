#include "core/hidden/controllability.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/robots/platform_motion.h"
#include "tests/testing/derivatives.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"
#include "tests/testing/random_robots.h"

namespace legible {
namespace {

using Status = ControllabilityStatus;

Controllability By(const RobotAtPose& random, SeenFeature feature, const std::vector<int>& legs) {
  return ControllabilityOf(random.robot, legs, random.pose, feature);
}
Controllability By(const RobotAtPose& random, SeenFeature feature) {
  return By(random, feature, AllLegs(random.robot));
}

// Random again until all legs reach with the same rail.
RobotAtPose WithRail(const std::function<RobotAtPose()>& draw, const Eigen::Vector3d& rail) {
  for (;;) {
    RobotAtPose random = draw();
    for (RobotLeg& leg : random.robot.legs) leg.first_axis = rail;
    bool reaches = true;
    for (const RobotLeg& leg : random.robot.legs) {
      const auto state = StateOf(leg, random.pose);
      reaches = reaches && state && std::abs(state->direction.dot(state->free_direction)) > 0.1;
    }
    if (reaches) return random;
  }
}

// d(features)/dt by differences: of each leg u, and where across u the foot of the perpendicular from a fixed
// point, the leg's start at the pose, is on the line.
TEST(SeenFeatures, MoveAsByDifferences) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 20; ++n)
    for (const RobotAtPose& random :
         {RandomPlanarRobot(generator, {"_RRR", "P_RR", "R_PR"}),
          RandomPlanarRobot(generator, {"_PPR", "_PRP", "R_RP"}),
          RandomSpatialRobot(generator, {"U_PS", "_PUS", "_RUS", "U_PS", "U_PS", "U_PS"}),
          RandomSchoenfliesRobot(generator, "_R-{2-US}"),
          RandomTranslationRobot(generator, {"_P-{2-US}", "_RUU", "U_PU"})})
      for (int i = 0; i < static_cast<int>(random.robot.legs.size()); ++i) {
        const RobotLeg& leg = random.robot.legs[static_cast<size_t>(i)];
        const auto basis = MotionBasis(random.robot, random.pose);
        const Eigen::Vector3d fixed_m = StateOf(leg, random.pose)->start_m;
        const auto features = [&](const Vector6d& twist) -> Vector6d {
          const auto state =
              StateOf(leg, Displaced(random.pose, basis * (basis.transpose() * twist))).value();
          Vector6d values;
          const Eigen::Vector3d from_fixed = state.start_m - fixed_m;
          values << state.direction, from_fixed - state.direction * state.direction.dot(from_fixed);
          return values;
        };
        const Eigen::MatrixXd found =
            *FeatureInteraction(random.robot, {i}, random.pose, SeenFeature::kLines) * basis *
            basis.transpose();
        EXPECT_TRUE(AreNear(found, NumericJacobian(features, Vector6d::Zero().eval(), 3e-5), 1e-7))
            << ToText(leg.chain);
      }
}

// Section 4.1.2: the twelve planar robots that can be controlled.
TEST(Controllability, OfTheTwelvePlanarRobotsIsGiven) {
  std::mt19937_64 generator = TestGenerator();
  for (const char* chain : {"_RRR", "R_RR", "_RPR", "R_PR", "_PRR", "P_RR"}) {
    EXPECT_EQ(By(RandomPlanarRobot(generator, {chain, chain}), SeenFeature::kDirections).status,
              Status::kControllable);
    EXPECT_EQ(By(RandomPlanarRobot(generator, {chain, chain, chain}), SeenFeature::kDirections).status,
              Status::kControllable);
  }
}

// Table 1: PPR legs show nothing, PRP and RRP legs the platform's orientation alone.
TEST(Controllability, OfLegsThatEndInARailIsNotGivenByDirections) {
  std::mt19937_64 generator = TestGenerator();
  for (const char* chain : {"_PPR", "P_PR", "_PRP", "P_RP", "_RRP", "R_RP"}) {
    const Controllability found =
        By(RandomPlanarRobot(generator, {chain, chain, chain}), SeenFeature::kDirections);
    const bool shows_nothing = chain[1] == 'P' && std::string(chain).ends_with("PR");
    EXPECT_EQ(found.status, Status::kUncontrollable) << chain;
    EXPECT_EQ(found.freedoms, 3);
    EXPECT_EQ(found.seen_freedoms, shows_nothing || std::string(chain) == "P_PR" ? 0 : 1) << chain;
    EXPECT_THAT(found.why, testing::HasSubstr(found.seen_freedoms == 0 ? "constant" : "orientation"))
        << chain;
  }
}

// The line of a PPR leg's rod shifts with one coordinate of C, so three tell the pose. A PRP or RRP leg's
// line is fixed in the platform: three, not parallel in it, tell the pose even where two would.
TEST(Controllability, OfLegsThatEndInARailIsGivenByLines) {
  std::mt19937_64 generator = TestGenerator();
  for (const char* chain : {"_PPR", "P_PR", "_PRP", "P_RP", "_RRP", "R_RP"})
    EXPECT_EQ(By(RandomPlanarRobot(generator, {chain, chain, chain}), SeenFeature::kLines).status,
              Status::kControllable)
        << chain;
  for (const char* chain : {"_PRP", "P_RP", "_RRP", "R_RP"}) {
    const RobotAtPose random = RandomPlanarRobot(generator, {chain, chain, chain});
    EXPECT_EQ(By(random, SeenFeature::kLines, {0, 1}).status, Status::kControllable) << chain;
    EXPECT_EQ(By(random, SeenFeature::kLines, {0}).seen_freedoms, 2) << chain;
  }
  for (const char* chain : {"_PPR", "P_PR"}) {
    const RobotAtPose random = RandomPlanarRobot(generator, {chain, chain, chain});
    EXPECT_EQ(By(random, SeenFeature::kLines, {0, 1}).status, Status::kUncontrollable) << chain;
  }
}

// Section 4.3: along the rails the robot translates with all directions unchanged. Its lines move along with
// it, unless they run along the rails themselves, which they do not.
TEST(Controllability, OnParallelRailsIsGivenByLinesAndNotByDirections) {
  std::mt19937_64 generator = TestGenerator();
  const auto expect = [](const RobotAtPose& random, const Eigen::Vector3d& rail) {
    const Controllability by_directions = By(random, SeenFeature::kDirections);
    EXPECT_EQ(by_directions.status, Status::kUncontrollable) << random.robot.name;
    EXPECT_THAT(by_directions.why, testing::HasSubstr("rails of the P joints are parallel"));
    ASSERT_EQ(by_directions.unseen_twists.cols(), 1);
    EXPECT_LT(by_directions.unseen_twists.col(0).head<3>().cross(rail).norm(), 1e-9);
    EXPECT_LT(by_directions.unseen_twists.col(0).tail<3>().norm(), 1e-9);
    EXPECT_EQ(By(random, SeenFeature::kLines).status, Status::kControllable) << random.robot.name;
  };
  for (int n = 0; n < 20; ++n) {
    const Eigen::Vector3d in_plane = RandomDirectionAcross(generator, Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d rail = RandomDirection(generator);
    expect(WithRail([&] { return RandomPlanarRobot(generator, {"_PRR", "_PRR"}); }, in_plane), in_plane);
    expect(WithRail(
               [&] {
                 return RandomPlanarRobot(generator, {"_PRR", "_PRR", "_PRR"});
               },
               in_plane),
           in_plane);
    expect(WithRail(
               [&] {
                 return RandomTranslationRobot(generator, {"_P-{2-US}", "_P-{2-US}", "_P-{2-US}"});
               },
               rail),
           rail);
    expect(WithRail([&] { return RandomSchoenfliesRobot(generator, "_P-{2-US}"); }, rail), rail);
  }
}

// Section 4.2: three legs of a hexapod, two of a Delta or of a Quattro suffice.
TEST(Controllability, NeedsAsManyLegsAsTheDirectionsCoordinatesSay) {
  std::mt19937_64 generator = TestGenerator();
  const RobotAtPose hexapod = RandomSpatialRobot(generator, std::vector<std::string>(6, "U_PS"));
  EXPECT_EQ(By(hexapod, SeenFeature::kDirections, {0, 2, 4}).status, Status::kControllable);
  const Controllability two = By(hexapod, SeenFeature::kDirections, {0, 2});
  EXPECT_EQ(two.status, Status::kUncontrollable);
  EXPECT_THAT(two.why, testing::HasSubstr("4 coordinates for the platform's 6 freedoms"));
  const RobotAtPose delta = RandomTranslationRobot(generator, {"_R-{2-US}", "_R-{2-US}", "_R-{2-US}"});
  EXPECT_EQ(By(delta, SeenFeature::kDirections, {0, 1}).status, Status::kControllable);
  EXPECT_EQ(By(delta, SeenFeature::kDirections, {0}).status, Status::kUncontrollable);
  const RobotAtPose rps = RandomSpatialRobot(generator, {"R_PS", "R_PS", "R_PS"});
  EXPECT_EQ(By(rps, SeenFeature::kDirections).status, Status::kControllable);
  EXPECT_EQ(By(rps, SeenFeature::kDirections, {0, 1}).status, Status::kUncontrollable);
}

TEST(Controllability, OfAQuattroNeedsALegOfEachHalf) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 20; ++n) {
    const RobotAtPose quattro = RandomSchoenfliesRobot(generator, "_R-{2-US}");
    for (const std::vector<int>& legs : {std::vector<int>{0, 1}, {2, 3}}) {
      const Controllability found = By(quattro, SeenFeature::kDirections, legs);
      EXPECT_EQ(found.status, Status::kUncontrollable);
      EXPECT_EQ(found.unseen_twists.cols(), 1);  // the other half turns about it
      EXPECT_GT(std::abs(found.unseen_twists(5, 0)), 0.1);
    }
    for (const std::vector<int>& legs : {std::vector<int>{0, 2}, {1, 3}, {0, 3}, {0, 1, 2}})
      EXPECT_EQ(By(quattro, SeenFeature::kDirections, legs).status, Status::kControllable);
  }
}

// Legs of which one is a copy of another, moved so that both vertex spaces have one tangent: the pose is
// singular, others are not.
TEST(Controllability, TellsASingularPoseFromARobotThatCannotBeControlled) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 20; ++n) {
    RobotAtPose five_bar = RandomPlanarRobot(generator, {"_RRR", "_RRR"});
    const LegState first = StateOf(five_bar.robot.legs[0], five_bar.pose).value();
    // The second arm, longer, in line with the first, and another rod.
    RobotLeg& second = five_bar.robot.legs[1];
    const Eigen::Vector3d along = first.start_m - five_bar.robot.legs[0].base_joint_m;
    const Eigen::Vector3d rod = 0.7 * RandomDirectionAcross(generator, Eigen::Vector3d::UnitZ());
    second.arm_m = 1.3 * along.norm();
    second.rod_m = 0.7;
    const Eigen::Vector3d c = five_bar.pose * second.platform_joint_m + second.carried_offset_m;
    second.base_joint_m = c - rod - 1.3 * along;
    second.first_axis = Eigen::Vector3d::UnitZ();
    second.working_mode = Eigen::Vector3d::UnitZ().dot((along + rod).cross(along)) > 0 ? 1 : -1;
    EXPECT_EQ(By(five_bar, SeenFeature::kDirections).status, Status::kSingularPose);
  }
}

// A five-bar with equal arms and rods that is stretched but for the angle, both arms parallel: hardly a pose
// around is reached.
ParallelRobot NearlyStretched(double angle_rad) {
  ParallelRobot robot;
  robot.motion = PlatformMotion::kPlanarPoint;
  for (const int side : {-1, 1}) {
    RobotLeg leg;
    leg.chain = ChainFromText("_RRR");
    leg.base_joint_m = {2 * side * std::cos(angle_rad), 0, 0};
    leg.arm_m = leg.rod_m = 1;
    robot.legs.push_back(leg);
  }
  return robot;
}

TEST(Controllability, OfASingularPoseIsToldByPosesAsNearAsAreReached) {
  const Controllability found =
      ControllabilityOf(NearlyStretched(0.01), {0, 1}, {}, SeenFeature::kDirections);
  EXPECT_EQ(found.status, Status::kSingularPose);
  EXPECT_EQ(found.unseen_twists.cols(), 1);
  EXPECT_EQ(found.fewest_unseen_around, 0);
  EXPECT_THAT(found.why, testing::HasSubstr("not elsewhere"));
}

TEST(Controllability, IsNotDeniedWhereNoPoseAroundIsReached) {
  const Controllability found =
      ControllabilityOf(NearlyStretched(1e-4), {0, 1}, {}, SeenFeature::kDirections);
  EXPECT_EQ(found.status, Status::kSingularPose);
  EXPECT_FALSE(found.fewest_unseen_around.has_value());
  EXPECT_THAT(found.why, testing::HasSubstr("not known"));
}

TEST(Controllability, TellsHowManyMotionsAreUnseenAround) {
  std::mt19937_64 generator = TestGenerator();
  const RobotAtPose hexapod = RandomSpatialRobot(generator, std::vector<std::string>(6, "U_PS"));
  const Controllability found = By(hexapod, SeenFeature::kDirections, {0, 2});
  EXPECT_EQ(found.unseen_twists.cols(), 2);
  EXPECT_EQ(found.fewest_unseen_around, 2);
  EXPECT_FALSE(By(hexapod, SeenFeature::kDirections).fewest_unseen_around.has_value());
}

TEST(Controllability, IsUnreachableWhereALegIs) {
  std::mt19937_64 generator = TestGenerator();
  RobotAtPose random = RandomTranslationRobot(generator, {"_R-{2-US}", "_R-{2-US}", "_R-{2-US}"});
  random.pose.translation.z() -= 5;
  EXPECT_EQ(By(random, SeenFeature::kDirections).status, Status::kUnreachable);
}

}  // namespace
}  // namespace legible
