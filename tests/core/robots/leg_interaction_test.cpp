#include "core/robots/leg_interaction.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "tests/testing/edge_shift.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

class EdgeInteractionThrough : public testing::TestWithParam<Camera> {};

TEST_P(EdgeInteractionThrough, RowsAreHowFarEachEdgeMovesAtItsEndsByDifferences) {
  std::mt19937_64 generator = TestGenerator();
  View view;
  view.camera = GetParam();
  const std::vector<int> legs = {0, 2, 3, 5};
  for (int n = 0; n < 5; ++n) {
    Vector6d place;
    place << UniformVector(generator, -0.03, 0.03), UniformVector(generator, -0.1, 0.1);
    const Rigid3 pose = Displaced(view.robot.home, place);
    const auto interaction = EdgeInteraction(view.robot, view.camera, view.camera_from_base, pose, legs);
    ASSERT_TRUE(interaction);
    const std::vector<EdgeEnd> ends = EdgeEnds(legs);
    ASSERT_EQ(interaction->rows(), static_cast<Eigen::Index>(ends.size()));
    for (size_t i = 0; i < ends.size(); ++i) {
      const Eigen::Vector2d point_px = EndPoint(view, ends[i], pose);
      EXPECT_NEAR(ShiftPast(view, EdgeNormal(view, ends[i], pose), point_px), 0, 1e-8);
      const auto shift = [&](const Vector6d& twist) -> Eigen::Matrix<double, 1, 1> {
        return Eigen::Matrix<double, 1, 1>(
            ShiftPast(view, EdgeNormal(view, ends[i], Displaced(pose, twist)), point_px));
      };
      const Eigen::RowVectorXd numeric = NumericJacobian(shift, Vector6d::Zero().eval(), 1e-5);
      // At the base an edge hardly moves; the scale is that of pixels by metres, some 1000.
      EXPECT_TRUE(
          AreNear(interaction->row(static_cast<Eigen::Index>(i)), numeric, 1e-6 * interaction->norm()));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Lenses, EdgeInteractionThrough,
                         testing::Values(DesktopCamera(true), DesktopFisheye()));

TEST(EdgeInteraction, IsNoneWhereALegIsBehindTheCameraOrAroundIt) {
  View view;
  EXPECT_TRUE(EdgeInteraction(view.robot, view.camera, view.camera_from_base, view.robot.home, {0}));
  const Rigid3 turned{RotationFromVector({0, 3.14159, 0}), {0, 0, 0}};
  EXPECT_FALSE(
      EdgeInteraction(view.robot, view.camera, turned * view.camera_from_base, view.robot.home, {0}));
  view.robot.legs[0].radius_m = 5;
  EXPECT_FALSE(EdgeInteraction(view.robot, view.camera, view.camera_from_base, view.robot.home, {0}));
}

TEST(EdgeInteraction, ThreeLegsDetermineThePoseAndTwoDoNot) {
  const View view;
  const auto rank = [&](const std::vector<int>& legs) {
    const auto interaction =
        EdgeInteraction(view.robot, view.camera, view.camera_from_base, view.robot.home, legs);
    return Eigen::FullPivLU<Eigen::MatrixXd>(*interaction).setThreshold(1e-9).rank();
  };
  EXPECT_EQ(rank({0, 1}), 4);
  EXPECT_EQ(rank({0, 2, 4}), 6);
}

}  // namespace
}  // namespace legible
