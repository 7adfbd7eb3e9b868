#include "accuracy/platform_jacobian.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "accuracy/maximal_errors.h"
#include "core/robots/gough_stewart.h"
#include "core/robots/planar_2r.h"
#include "core/robots/three_upu.h"
#include "tests/accuracy/merlet_robot.h"
#include "tests/accuracy/upu_robots.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

// A regular hexapod turned by the given angle about the vertical: singular at a quarter turn (Fichter 1986).
Rigid3 Turned(double angle_rad) { return {RotationFromVector({0, 0, angle_rad}), {0, 0, 0.53}}; }

TEST(PlatformJacobian, IsTheInverseOfTheInverseJacobian) {
  std::mt19937_64 generator = TestGenerator();
  const GoughStewart robot = DesktopHexapod(generator, 0.005);
  const PlatformJacobian jacobian = Invert(FullInverseJacobianOf(robot, robot.home));
  EXPECT_EQ(jacobian.status, PoseStatus::kRegular);
  EXPECT_TRUE(AreNear(InverseJacobian(robot, robot.home) * jacobian.matrix, Matrix6d::Identity(), 1e-12));
  EXPECT_TRUE(jacobian.free_motions.empty());
}

TEST(PlatformJacobian, OfFichtersQuarterTurnIsSingularAndNamesTheMotionThatIsFree) {
  const PlatformJacobian jacobian =
      Invert(FullInverseJacobianOf(MerletRobot(), Turned(std::numbers::pi / 2)));
  EXPECT_EQ(jacobian.status, PoseStatus::kSingular);
  EXPECT_EQ(jacobian.matrix.size(), 0);
  ASSERT_EQ(jacobian.free_motions.size(), 1u);
  // The free motion stretches no leg.
  const Vector6d leg_speeds =
      InverseJacobian(MerletRobot(), Turned(std::numbers::pi / 2)) * jacobian.free_motions[0];
  EXPECT_LT(leg_speeds.norm(), 1e-9);
  EXPECT_NEAR(jacobian.free_motions[0].tail<3>().norm(), 1, 1e-12);
}

TEST(PlatformJacobian, BesideASingularityIsNearSingularAndItsErrorsAreFinite) {
  const PlatformJacobian jacobian =
      Invert(FullInverseJacobianOf(MerletRobot(), Turned(std::numbers::pi / 2 - 1e-4)));
  EXPECT_EQ(jacobian.status, PoseStatus::kNearSingular);
  EXPECT_TRUE(MaximalErrorsOf(jacobian, Vector6d::Constant(1e-4)).of_coordinate.allFinite());
}

TEST(PlatformJacobian, StatusDoesNotDependOnTheUnitOfLength) {
  for (const double angle_rad : {0.0, 1.5, std::numbers::pi / 2 - 1e-4, std::numbers::pi / 2}) {
    const FullInverseJacobian metres = FullInverseJacobianOf(MerletRobot(), Turned(angle_rad));
    FullInverseJacobian microns = metres;
    microns.matrix.rightCols(3) *= 1e6;
    EXPECT_EQ(Invert(microns).status, Invert(metres).status);
    EXPECT_NEAR(Invert(microns).balanced_ratio, Invert(metres).balanced_ratio, 1e-12);
  }
}

TEST(PlatformJacobian, RefusesWhatIsNoInverseJacobian) {
  EXPECT_THROW(Invert({}), std::invalid_argument);
  EXPECT_THROW(Invert({Eigen::MatrixXd::Zero(5, 6), 5, 3}), std::invalid_argument);
  EXPECT_THROW(Invert({Matrix6d::Constant(std::nan("")), 6, 3}), std::invalid_argument);
}

// --- The 3-UPU.

TEST(ThreeUpu, SeoulsIsSingularAtHomeAndMayTurnAboutEveryHorizontalAxis) {
  const ThreeUpu robot = SeoulUpu();
  const PlatformJacobian jacobian = Invert(FullInverseJacobianOf(robot, robot.home.translation));
  EXPECT_EQ(jacobian.status, PoseStatus::kSingular);
  ASSERT_EQ(jacobian.free_motions.size(), 2u);
  for (const Eigen::VectorXd& motion : jacobian.free_motions) {
    EXPECT_NEAR(motion.tail<3>().norm(), 1, 1e-12);
    EXPECT_NEAR(motion[5], 0, 1e-9);  // no turn about the vertical
  }
}

TEST(ThreeUpu, TsaisHasFiniteErrorsAlsoInRotation) {
  const ThreeUpu robot = TsaiUpu();
  const PlatformJacobian jacobian = Invert(FullInverseJacobianOf(robot, robot.home.translation));
  EXPECT_EQ(jacobian.status, PoseStatus::kRegular);
  ASSERT_EQ(jacobian.matrix.cols(), 3);
  const MaximalErrors errors = MaximalErrorsOf(jacobian, Eigen::Vector3d::Constant(1e-4));
  EXPECT_GT(errors.position_m(), 0);
  // Leg errors alone turn nothing: rotation comes from the constraints only.
  EXPECT_LT(errors.rotation_rad(), 1e-15);
}

// --- The planar 2R.

TEST(Planar2R, ErrorsAreTheRowSumsOfItsJacobian) {
  const Planar2R robot{0.4, 0.3};
  const Eigen::Vector2d angles(0.3, 1.1), bounds(1e-3, 2e-3);
  const auto inverse = FullInverseJacobianOf(robot, angles);
  ASSERT_TRUE(inverse);
  const MaximalErrors errors = MaximalErrorsOf(Invert(*inverse), bounds);
  EXPECT_TRUE(AreNear(errors.of_coordinate, Jacobian(robot, angles).cwiseAbs() * bounds, 1e-15));
  EXPECT_EQ(errors.rotation_rad(), 0);
}

TEST(Planar2R, HasNoInverseJacobianWhereItIsStretchedOrFolded) {
  EXPECT_FALSE(FullInverseJacobianOf(Planar2R{}, {0.2, 0}));
  EXPECT_FALSE(FullInverseJacobianOf(Planar2R{}, {0.2, std::numbers::pi}));
}

}  // namespace
}  // namespace legible
