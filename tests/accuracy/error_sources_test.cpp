#include "accuracy/error_sources.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <random>

#include "accuracy/maximal_errors.h"
#include "tests/accuracy/random_hexapod.h"
#include "tests/testing/derivatives.h"
#include "tests/testing/edge_shift.h"
#include "tests/testing/matrices.h"

namespace legible {
namespace {

using Geometry = Eigen::Matrix<double, kGeometryCount, 1>;

GoughStewart Changed(GoughStewart robot, const Geometry& change) {
  for (int i = 0; i < kLegCount; ++i) {
    Leg& leg = robot.legs[static_cast<size_t>(i)];
    leg.base_joint_m += change.segment<3>(kGeometryPerLeg * i);
    leg.platform_joint_m += change.segment<3>(kGeometryPerLeg * i + 3);
    leg.joint_offset_m += change[kGeometryPerLeg * i + 6];
  }
  return robot;
}

struct Case {
  GoughStewart robot;
  Rigid3 pose;
  PlatformJacobian jacobian;
};
Case RandomCase(std::mt19937_64& generator) {
  const HexapodAtPose at = RandomHexapod(generator);
  return {at.robot, at.pose, Invert(FullInverseJacobianOf(at.robot, at.pose))};
}

Eigen::MatrixXd RandomCovariance(std::mt19937_64& generator, Eigen::Index size, double scale) {
  const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(
      size, size, [&](Eigen::Index) { return Uniform(generator, -scale, scale); });
  return root * root.transpose();
}

std::vector<std::string> Names(Eigen::Index count) {
  std::vector<std::string> names(static_cast<size_t>(count));
  for (size_t i = 0; i < names.size(); ++i) names[i] = "p" + std::to_string(i);
  return names;
}

Eigen::VectorXd NormalVector(std::mt19937_64& generator, Eigen::Index size) {
  std::normal_distribution<double> normal;
  return Eigen::VectorXd::NullaryExpr(size, [&](Eigen::Index) { return normal(generator); });
}

// --- Derivatives against differences of the forward kinematics.

TEST(PlatformJacobianByDifferences, OfTheJointReadingsAgreesToAMillionth) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 20; ++n) {
    const Case drawn = RandomCase(generator);
    const Vector6d readings_m = InverseKinematics(drawn.robot, drawn.pose);
    const auto moved = [&](const Vector6d& change_m) -> Vector6d {
      return Displacement(
          drawn.pose, ForwardKinematics(drawn.robot, readings_m + change_m, drawn.pose).base_from_platform);
    };
    const Matrix6d numeric = NumericJacobian(moved, Vector6d::Zero().eval());
    EXPECT_TRUE(AreNear(drawn.jacobian.matrix, numeric, 1e-6 * numeric.norm()));
  }
}

TEST(PlatformJacobianByDifferences, OfTheGeometryAgreesToAMillionth) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 20; ++n) {
    const Case drawn = RandomCase(generator);
    const Vector6d readings_m = InverseKinematics(drawn.robot, drawn.pose);
    const auto moved = [&](const Geometry& change) -> Vector6d {
      return Displacement(
          drawn.pose,
          ForwardKinematics(Changed(drawn.robot, change), readings_m, drawn.pose).base_from_platform);
    };
    const Eigen::Matrix<double, 6, kGeometryCount> numeric = NumericJacobian(moved, Geometry::Zero().eval());
    EXPECT_TRUE(
        AreNear(PlatformByGeometry(drawn.robot, drawn.pose, drawn.jacobian), numeric, 1e-6 * numeric.norm()));
  }
}

TEST(Geometry, NamesAreThoseOfModelFilesAndPickTheirCovariance) {
  EXPECT_EQ(GeometryNames()[0], "legs[1].base_joint_m.x");
  EXPECT_EQ(GeometryNames()[41], "legs[6].joint_offset_m");
  Eigen::Matrix3d covariance;
  covariance << 4, 1, 2, 1, 9, 3, 2, 3, 16;
  const Eigen::MatrixXd found = GeometryCovariance(
      {"legs[2].joint_offset_m", "camera.fx_px", "legs[1].platform_joint_m.y"}, covariance);
  EXPECT_EQ(found(13, 13), 4);
  EXPECT_EQ(found(4, 4), 16);
  EXPECT_EQ(found(13, 4), 2);
  EXPECT_EQ(found.sum(), 4 + 16 + 2 * 2);
}

// --- Vision.

// The pose whose edges fit edges that are shifted by `shifts_px` best, by Gauss-Newton with numeric
// derivatives: nothing of the interaction matrix or its pseudo-inverse is in here.
Vector6d FitToShiftedEdges(const View& view, const Rigid3& pose, const std::vector<int>& legs,
                           const Eigen::VectorXd& shifts_px) {
  const std::vector<EdgeEnd> ends = EdgeEnds(legs);
  std::vector<Eigen::Vector2d> points_px(ends.size());
  std::transform(ends.begin(), ends.end(), points_px.begin(),
                 [&](const EdgeEnd& end) { return EndPoint(view, end, pose); });
  const auto residuals = [&](const Vector6d& displacement) {
    Eigen::Matrix<double, 24, 1> values = Eigen::Matrix<double, 24, 1>::Zero();
    for (size_t i = 0; i < ends.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      values[row] = ShiftPast(view, EdgeNormal(view, ends[i], Displaced(pose, displacement)), points_px[i]) -
                    shifts_px[row];
    }
    return values;
  };
  Vector6d displacement = Vector6d::Zero();
  for (int step = 0; step < 4; ++step)
    displacement -=
        NumericJacobian(residuals, displacement, 1e-5).colPivHouseholderQr().solve(residuals(displacement));
  return displacement;
}

TEST(VisionSource, IsTheDerivativeOfThePoseFittedToShiftedEdgesByDifferences) {
  const View view;
  const Rigid3 pose =
      Displaced(view.robot.home, (Vector6d() << 0.01, -0.02, 0.01, 0.05, 0.03, -0.04).finished());
  for (const std::vector<int>& legs : {std::vector<int>{0, 1, 3, 4}, std::vector<int>{0, 1, 2, 3, 4, 5}}) {
    const auto source = VisionSource(view.robot, view.camera, view.camera_from_base, pose, legs, 0.5);
    ASSERT_TRUE(source);
    const Eigen::Index count = source->sensitivity.cols();
    ASSERT_EQ(count, kShiftsPerLeg * static_cast<Eigen::Index>(legs.size()));
    EXPECT_EQ(source->covariance(3, 3), 0.25);
    Eigen::MatrixXd numeric(6, count);
    constexpr double kStep_px = 2e-3;
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::VectorXd shift = kStep_px * Eigen::VectorXd::Unit(count, i);
      numeric.col(i) =
          (8 * (FitToShiftedEdges(view, pose, legs, shift) - FitToShiftedEdges(view, pose, legs, -shift)) -
           (FitToShiftedEdges(view, pose, legs, 2 * shift) -
            FitToShiftedEdges(view, pose, legs, -2 * shift))) /
          (12 * kStep_px);
    }
    EXPECT_TRUE(AreNear(source->sensitivity, numeric, 1e-6 * numeric.norm()));
  }
}

TEST(VisionSource, MoreLegsLeaveSmallerErrorsAndTwoLegsNone) {
  const SyntheticOptions scene;
  const auto position_m = [&](const std::vector<int>& legs) {
    const auto source =
        VisionSource(scene.drawing, scene.camera, scene.camera_from_base, scene.drawing.home, legs, 0.1);
    return source ? ErrorsOf(*source, 3).value_95.position_m : -1;
  };
  EXPECT_EQ(position_m({0, 1}), -1);
  EXPECT_GT(position_m({0, 2, 4}), position_m({0, 1, 2, 4}));
  EXPECT_GT(position_m({0, 1, 2, 4}), position_m({0, 1, 2, 3, 4, 5}));
}

// --- Figures.

TEST(RadiusHolding, IsTheClosedFormOnALineInAPlaneAndInAllDirections) {
  EXPECT_NEAR(RadiusHolding(0.95, Eigen::Vector3d(0, 4, 0).asDiagonal()), 2 * 1.959963984540054, 1e-5);
  EXPECT_NEAR(RadiusHolding(0.95, Eigen::Vector3d(1, 1, 0).asDiagonal()), std::sqrt(5.991464547107979), 1e-7);
  EXPECT_NEAR(RadiusHolding(0.95, Eigen::Vector3d(9, 9, 9).asDiagonal()), 3 * std::sqrt(7.814727903251179),
              1e-9);
  EXPECT_EQ(RadiusHolding(0.95, Eigen::Matrix3d::Zero()), 0);
}

TEST(RadiusHolding, HoldsItsPartOfRandomDraws) {
  std::mt19937_64 generator = TestGenerator();
  constexpr int kDraws = 100000;
  for (int n = 0; n < 5; ++n) {
    const Eigen::Matrix3d covariance = RandomCovariance(generator, 3, 1);
    const Eigen::Matrix3d root = covariance.llt().matrixL();
    const double radius = RadiusHolding(0.95, covariance);
    int inside = 0;
    for (int i = 0; i < kDraws; ++i) inside += (root * NormalVector(generator, 3)).norm() < radius;
    EXPECT_NEAR(static_cast<double>(inside) / kDraws, 0.95, 5 * std::sqrt(0.05 * 0.95 / kDraws));
  }
}

TEST(ErrorSource, BoundsOfBoundedParametersAreMerletsAndNoErrorIsLarger) {
  std::mt19937_64 generator = TestGenerator();
  const Case drawn = RandomCase(generator);
  const Eigen::VectorXd bounds = Vector6d::Constant(1e-4);
  const SourceErrors errors = ErrorsOf(BoundedSource("joints", Names(6), drawn.jacobian.matrix, bounds), 3);
  const MaximalErrors merlet = MaximalErrorsOf(drawn.jacobian, bounds);
  EXPECT_TRUE(AreNear(errors.bound.of_coordinate, merlet.of_coordinate, 1e-15));
  EXPECT_NEAR(errors.bound.position_m, merlet.position_m(), 1e-15);
  EXPECT_TRUE((errors.value_95.of_coordinate.array() <= errors.bound.of_coordinate.array()).all());
  EXPECT_LT(errors.value_95.position_m, errors.bound.position_m);
}

// 95 % values of bounded parameters take the sum of uniform errors as normal: how far that is from the truth.
TEST(ErrorSource, NinetyFivePercentValuesHoldAboutThatPartOfUniformJointErrors) {
  std::mt19937_64 generator = TestGenerator();
  constexpr int kDraws = 100000;
  for (int n = 0; n < 5; ++n) {
    const Case drawn = RandomCase(generator);
    const SourceErrors errors =
        ErrorsOf(BoundedSource("joints", Names(6), drawn.jacobian.matrix, Vector6d::Constant(1e-4)), 3);
    Eigen::VectorXd inside = Eigen::VectorXd::Zero(8);
    for (int i = 0; i < kDraws; ++i) {
      Vector6d joint_errors_m;
      joint_errors_m << UniformVector(generator, -1e-4, 1e-4), UniformVector(generator, -1e-4, 1e-4);
      const Vector6d twist = drawn.jacobian.matrix * joint_errors_m;
      for (Eigen::Index k = 0; k < 6; ++k) inside[k] += std::abs(twist[k]) < errors.value_95.of_coordinate[k];
      inside[6] += twist.head<3>().norm() < errors.value_95.position_m;
      inside[7] += twist.tail<3>().norm() < errors.value_95.rotation_rad;
    }
    EXPECT_GT(inside.minCoeff() / kDraws, 0.945);
    EXPECT_LT(inside.maxCoeff() / kDraws, 0.985);
  }
}

TEST(ErrorSource, TogetherAddsVariancesAndExactBounds) {
  std::mt19937_64 generator = TestGenerator();
  const Case drawn = RandomCase(generator);
  const Eigen::MatrixXd by_geometry = PlatformByGeometry(drawn.robot, drawn.pose, drawn.jacobian);
  const ErrorSource joints =
      BoundedSource("joints", Names(6), drawn.jacobian.matrix, Vector6d::Constant(1e-4));
  const ErrorSource geometry = NormalSource("geometry", Names(kGeometryCount), by_geometry,
                                            RandomCovariance(generator, kGeometryCount, 1e-5));
  const SourceErrors together = ErrorsTogether({joints, geometry}, 3);
  EXPECT_TRUE(
      AreNear(together.covariance, ErrorsOf(joints, 3).covariance + ErrorsOf(geometry, 3).covariance, 1e-18));
  EXPECT_NEAR(together.bound.position_m,
              ErrorsOf(joints, 3).bound.position_m + ErrorsOf(geometry, 3).bound.position_m, 1e-15);

  // Of two bounded sources: the corner of both boxes, not the sum of each worst direction.
  const ErrorSource drawing =
      BoundedSource("drawing", Names(6), by_geometry.leftCols(6), Vector6d::Constant(2e-4));
  Eigen::MatrixXd both(6, 12);
  both << 1e-4 * drawn.jacobian.matrix, 2e-4 * by_geometry.leftCols(6);
  EXPECT_NEAR(ErrorsTogether({joints, drawing}, 3).bound.position_m, MaximalErrorsOf(both, 3).position_m(),
              1e-15);
  EXPECT_LE(ErrorsTogether({joints, drawing}, 3).bound.position_m,
            ErrorsOf(joints, 3).bound.position_m + ErrorsOf(drawing, 3).bound.position_m);
}

TEST(ErrorSource, ContributionsAddUpToTheNinetyFivePercentValueMostImportantFirst) {
  std::mt19937_64 generator = TestGenerator();
  const Case drawn = RandomCase(generator);
  const Eigen::MatrixXd covariance = RandomCovariance(generator, kGeometryCount, 1e-5);
  const SourceErrors errors =
      ErrorsOf(NormalSource("geometry", Names(kGeometryCount),
                            PlatformByGeometry(drawn.robot, drawn.pose, drawn.jacobian), covariance),
               3);
  double position_m = 0, rotation_rad = 0;
  for (const Contribution& one : errors.contributions)
    position_m += one.position_m, rotation_rad += one.rotation_rad;
  EXPECT_NEAR(position_m / errors.value_95.position_m, 1, 1e-9);
  EXPECT_NEAR(rotation_rad / errors.value_95.rotation_rad, 1, 1e-9);
  EXPECT_TRUE(std::is_sorted(errors.contributions.begin(), errors.contributions.end(),
                             [](const auto& a, const auto& b) { return a.position_m > b.position_m; }));
}

// One leg whose reading is ten times worse than the others' is the one to mend.
TEST(ErrorSource, TheWorstParameterComesFirst) {
  std::mt19937_64 generator = TestGenerator();
  const Case drawn = RandomCase(generator);
  Vector6d bounds = Vector6d::Constant(1e-5);
  bounds[3] = 3e-4;
  EXPECT_EQ(ErrorsOf(BoundedSource("joints", Names(6), drawn.jacobian.matrix, bounds), 3)
                .contributions[0]
                .parameter,
            "p3");
}

TEST(ErrorSource, RefusesSizesThatDoNotFit) {
  EXPECT_THROW(BoundedSource("x", Names(3), Eigen::MatrixXd::Ones(6, 4), Eigen::VectorXd::Ones(3)),
               std::invalid_argument);
  EXPECT_THROW(ErrorsTogether({}, 3), std::invalid_argument);
}

}  // namespace
}  // namespace legible
