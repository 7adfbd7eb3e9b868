#include "core/robots/leg_geometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/algebra/ball.h"
#include "core/robots/leg_state.h"
#include "core/robots/platform_motion.h"
#include "tests/testing/derivatives.h"
#include "tests/testing/random.h"
#include "tests/testing/random_robots.h"

namespace legible {
namespace {

using Vector3Ball = leg_geometry::Vector3<RealBall>;

// Whether every number lies in its ball, but for the numbers' own error of that part of 1 or of them.
template <typename Balls, typename Numbers>
bool Encloses(const Balls& balls, const Numbers& numbers, double error = 1e-12) {
  for (Eigen::Index i = 0; i < balls.rows(); ++i)
    for (Eigen::Index j = 0; j < balls.cols(); ++j) {
      const double slack = error * (1 + std::abs(numbers(i, j)));
      if (!(LowerBound(balls(i, j)) - slack <= numbers(i, j) &&
            numbers(i, j) <= UpperBound(balls(i, j)) + slack))
        return false;
    }
  return true;
}

// Of all poses whose place and rotation matrix are off by up to the radius.
Eigen::Matrix<RealBall, 1, 6> RateInBalls(const RobotLeg& leg, const Rigid3& pose, double radius) {
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  const auto ball = [&](double x) { return RealBall(x, radius); };
  const auto placed =
      leg_geometry::Placed<RealBall>(leg, {pose.translation.unaryExpr(ball), rotation.unaryExpr(ball)});
  const auto held = leg_geometry::HeldByJoint<RealBall>(leg, placed);
  return held.line / held.power;
}

// Of a box of platform joints around one that is reached clearly.
TEST(LegGeometry, InBallsEnclosesWhatIsReachedInDoubles) {
  std::mt19937_64 generator = TestGenerator();
  int reached_boxes = 0;
  for (int n = 0; n < 200; ++n)
    for (const RobotAtPose& random : {RandomSpatialRobot(generator, {"U_PS", "_PUS", "_RUS"}),
                                      RandomPlanarRobot(generator, {"_RRR", "R_PR", "P_RR"})})
      for (const RobotLeg& leg : random.robot.legs) {
        const SeenSegment segment = SeenSegmentOf(leg.chain);
        const Eigen::Vector3d middle = random.pose * leg.platform_joint_m + leg.carried_offset_m;
        const double radius = std::pow(10, Uniform(generator, -6, -1.3));
        Vector3Ball box;
        for (int k = 0; k < 3; ++k) box[k] = RealBall(middle[k], radius);
        const auto balls = leg_geometry::Reach<RealBall>(leg, segment, box, {});
        const bool is_reached = LowerBound(balls.reach) > 0;
        reached_boxes += is_reached ? 1 : 0;
        for (int draw = 0; draw < 20; ++draw) {
          const Eigen::Vector3d c = middle + UniformVector(generator, -radius, radius);
          const auto doubles = leg_geometry::Reach<double>(leg, segment, c, {});
          EXPECT_TRUE(Encloses(Eigen::Matrix<RealBall, 1, 1>(balls.reach),
                               Eigen::Matrix<double, 1, 1>(doubles.reach)));
          if (!is_reached) continue;
          EXPECT_TRUE(Encloses(balls.start_m, doubles.start_m)) << ToText(leg.chain);
          EXPECT_TRUE(Encloses(balls.along_m, doubles.along_m)) << ToText(leg.chain);
          EXPECT_TRUE(Encloses(balls.free_direction, doubles.free_direction)) << ToText(leg.chain);
          const auto matrix =
              leg_geometry::DirectionByPlatformJoint<double>(doubles.along_m, doubles.free_direction);
          const auto in_balls =
              leg_geometry::DirectionByPlatformJoint<RealBall>(balls.along_m, balls.free_direction);
          EXPECT_TRUE(!std::isfinite(LowerBound(in_balls(0, 0))) || Encloses(in_balls, matrix));
        }
      }
  EXPECT_GT(reached_boxes, 800);
}

// Twelve planar legs and those in space, each as the legs of a robot.
std::vector<RobotAtPose> RobotsOfAllChains(std::mt19937_64& generator) {
  std::vector<RobotAtPose> robots;
  for (const char* chain :
       {"_RRR", "R_RR", "_RPR", "R_PR", "_PRR", "P_RR", "_PPR", "P_PR", "_PRP", "P_RP", "_RRP", "R_RP"})
    robots.push_back(RandomPlanarRobot(generator, {chain, chain, chain}));
  robots.push_back(RandomSpatialRobot(generator, {"U_PS", "_PUS", "_RUS"}));
  robots.push_back(RandomSpatialRobot(generator, {"R_PS", "_RPS"}));
  robots.push_back(RandomTranslationRobot(generator, {"U_PU", "_R-{2-US}", "_P-{2-US}"}));
  robots.push_back(RandomSchoenfliesRobot(generator, "_R-{2-US}"));
  return robots;
}

// The actuated joint's speed, of balls about a pose, by what the motion allows of the twist: that of the
// inverse kinematics at the pose by differences, and that of doubles at poses in the balls.
TEST(LegGeometry, HeldLineInBallsEnclosesTheReadingsRate) {
  constexpr double kTolerance = 1e-7;  // of differences
  std::mt19937_64 generator = TestGenerator();
  int enclosed = 0;
  for (int n = 0; n < 20; ++n)
    for (const RobotAtPose& random : RobotsOfAllChains(generator))
      for (const RobotLeg& leg : random.robot.legs) {
        SCOPED_TRACE(ToText(leg.chain));
        const auto basis = MotionBasis(random.robot, random.pose);
        const double radius = std::pow(10, Uniform(generator, -9, -3));
        const auto rate = RateInBalls(leg, random.pose, radius) * basis.cast<RealBall>();
        const LegState state = StateOf(leg, random.pose).value();
        const auto reading = [&](const Vector6d& twist) {
          const double by =
              StateOf(leg, Displaced(random.pose, basis * (basis.transpose() * twist)))->reading -
              state.reading;
          return Eigen::Matrix<double, 1, 1>(ReadsAngle(leg.chain) ? std::remainder(by, 2 * std::numbers::pi)
                                                                   : by);
        };
        if (!std::isfinite(LowerBound(RealBall(rate(0, 0))))) continue;
        ++enclosed;
        EXPECT_TRUE(
            Encloses(rate, NumericJacobian(reading, Vector6d::Zero().eval(), 3e-5) * basis, kTolerance));
        const Rigid3 inside = RandomPoseNear(generator, random.robot, random.pose, radius / 20);
        EXPECT_TRUE(Encloses(rate, ReadingRow(leg, StateOf(leg, inside).value(), inside) * basis, 1e-12));
      }
  EXPECT_GT(enclosed, 800);
}

TEST(LegGeometry, OfABoxBeyondReachSaysSo) {
  std::mt19937_64 generator = TestGenerator();
  for (const RobotLeg& leg : RandomSpatialRobot(generator, {"_PUS", "_RUS"}).robot.legs) {
    const Eigen::Vector3d far = leg.base_joint_m + 5 * RandomDirectionAcross(generator, leg.first_axis);
    Vector3Ball box;
    for (int k = 0; k < 3; ++k) box[k] = RealBall(far[k], 0.01);
    EXPECT_LT(UpperBound(leg_geometry::Reach<RealBall>(leg, SeenSegmentOf(leg.chain), box, {}).reach), 0);
  }
}

}  // namespace
}  // namespace legible
