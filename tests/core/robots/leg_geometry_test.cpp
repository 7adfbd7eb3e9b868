#include "core/robots/leg_geometry.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/algebra/ball.h"
#include "tests/testing/random.h"
#include "tests/testing/random_robots.h"

namespace legible {
namespace {

using Vector3Ball = leg_geometry::Vector3<RealBall>;

// Whether every number lies in its ball, but for the doubles' own rounding.
template <typename Balls, typename Numbers>
bool Encloses(const Balls& balls, const Numbers& numbers) {
  constexpr double kRounding = 1e-12;
  for (Eigen::Index i = 0; i < balls.rows(); ++i)
    for (Eigen::Index j = 0; j < balls.cols(); ++j) {
      const double slack = kRounding * (1 + std::abs(numbers(i, j)));
      if (!(LowerBound(balls(i, j)) - slack <= numbers(i, j) &&
            numbers(i, j) <= UpperBound(balls(i, j)) + slack))
        return false;
    }
  return true;
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
        const auto balls = leg_geometry::Reach<RealBall>(leg, segment, box);
        const bool is_reached = LowerBound(balls.reach) > 0;
        reached_boxes += is_reached ? 1 : 0;
        for (int draw = 0; draw < 20; ++draw) {
          const Eigen::Vector3d c = middle + UniformVector(generator, -radius, radius);
          const auto doubles = leg_geometry::Reach<double>(leg, segment, c);
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

TEST(LegGeometry, OfABoxBeyondReachSaysSo) {
  std::mt19937_64 generator = TestGenerator();
  for (const RobotLeg& leg : RandomSpatialRobot(generator, {"_PUS", "_RUS"}).robot.legs) {
    const Eigen::Vector3d far = leg.base_joint_m + 5 * RandomDirectionAcross(generator, leg.first_axis);
    Vector3Ball box;
    for (int k = 0; k < 3; ++k) box[k] = RealBall(far[k], 0.01);
    EXPECT_LT(UpperBound(leg_geometry::Reach<RealBall>(leg, SeenSegmentOf(leg.chain), box).reach), 0);
  }
}

}  // namespace
}  // namespace legible
