#include "core/robots/leg_interaction.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "core/geometry/cylinder_outline.h"
#include "datasets/synthetic_session.h"
#include "tests/testing/derivatives.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

struct View {
  GoughStewart robot = DesktopHexapod();
  Camera camera = DesktopCamera(true);
  Rigid3 camera_from_base = SyntheticOptions().camera_from_base;
};

// Undistorted line of a leg's edge at a pose.
Eigen::Vector3d EdgeNormal(const View& view, int leg, int edge, const Rigid3& pose) {
  const Leg& one = view.robot.legs[static_cast<size_t>(leg)];
  const auto axis = LineThrough<double>(view.camera_from_base * one.base_joint_m,
                                        view.camera_from_base * (pose * one.platform_joint_m));
  return CylinderOutline(axis, one.radius_m)[static_cast<size_t>(edge)];
}

// Signed n.(x, 1) of an image point about an edge, over its gradient in pixels by differences: the distance
// in first order, exact where it is 0.
double DistancePx(const View& view, const Eigen::Vector3d& normal, const Eigen::Vector2d& point_px) {
  const auto level = [&](const Eigen::Vector2d& pixel) -> Eigen::Matrix<double, 1, 1> {
    return Eigen::Matrix<double, 1, 1>(normal.dot(Unproject(view.camera, pixel)->homogeneous()));
  };
  return level(point_px)[0] / NumericJacobian(level, point_px, 0.05).norm();
}

TEST(EdgeInteraction, RowsAreHowFarEachEdgeMovesAtItsEndsByDifferences) {
  std::mt19937_64 generator = TestGenerator();
  const View view;
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
      const auto [leg, edge, is_at_platform] = ends[i];
      const Leg& one = view.robot.legs[static_cast<size_t>(leg)];
      const Eigen::Vector3d joint =
          view.camera_from_base * (is_at_platform ? pose * one.platform_joint_m : one.base_joint_m);
      const Eigen::Vector2d point_px =
          Project(view.camera, joint + one.radius_m * EdgeNormal(view, leg, edge, pose));
      EXPECT_NEAR(DistancePx(view, EdgeNormal(view, leg, edge, pose), point_px), 0, 1e-8);
      const auto shift = [&](const Vector6d& twist) -> Eigen::Matrix<double, 1, 1> {
        return Eigen::Matrix<double, 1, 1>(
            -DistancePx(view, EdgeNormal(view, leg, edge, Displaced(pose, twist)), point_px));
      };
      const Eigen::RowVectorXd numeric = NumericJacobian(shift, Vector6d::Zero().eval(), 1e-5);
      EXPECT_TRUE(
          AreNear(interaction->row(static_cast<Eigen::Index>(i)), numeric, 1e-6 * numeric.norm() + 1e-4))
          << "leg " << leg << " edge " << edge << " platform " << is_at_platform;
    }
  }
}

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
