#include "calib/tag_model.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "core/geometry/camera.h"
#include "datasets/synthetic_session.h"
#include "tests/testing/derivatives.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

using Rows = Eigen::Matrix<double, kTagRows, 1>;

Vector6d RandomDisplacement(std::mt19937_64& generator, double size) {
  Vector6d displacement;
  displacement << UniformVector(generator, -size, size), UniformVector(generator, -size, size);
  return displacement;
}

// One tag in front of a lens with distortion, away from where its model puts it.
class OneTag : public testing::TestWithParam<TagCarrier> {
 protected:
  OneTag() : generator_(TestGenerator()) {
    const Eigen::Quaterniond turn = UniformRotation(generator_);
    platform_ = {turn, {0.05, -0.02, 0.8}};
    const Eigen::Vector3d offset = UniformVector(generator_, -0.1, 0.1);
    placement_.carrier = GetParam();
    placement_.parent_from_group = GetParam() == TagCarrier::kBase
                                       ? Rigid3{UniformRotation(generator_), platform_ * offset}
                                       : Rigid3{UniformRotation(generator_), offset};
    tag_.corners_in_group_m = {
        Eigen::Vector3d(-0.02, -0.02, 0), {0.02, -0.02, 0}, {0.02, 0.02, 0}, {-0.02, 0.02, 0}};
    for (Eigen::Vector2d& corner : tag_.corners_px)
      corner = {Uniform(generator_, 0, 1280), Uniform(generator_, 0, 960)};
    for (Eigen::Matrix2d& covariance_px2 : tag_.covariances_px2) {
      const double off_px2 = Uniform(generator_, -0.02, 0.02);
      covariance_px2 << Uniform(generator_, 0.03, 0.1), off_px2, off_px2, Uniform(generator_, 0.03, 0.1);
    }
    tag_.sigma_scale = 1.3;
  }

  TagResiduals At(const Camera& camera, const Vector6d& placed, const Vector6d& posed) const {
    return EvaluateTag(camera, placement_, placed, platform_, posed, tag_).value();
  }

  std::mt19937_64 generator_;
  Camera camera_ = DesktopCamera(true);
  TagPlacement placement_;
  Rigid3 platform_;
  TagObservation tag_;
};

// Relative to the size of the largest entry.
template <typename A, typename B>
void ExpectSameJacobian(const A& found, const B& numeric) {
  const double size = std::max(numeric.cwiseAbs().maxCoeff(), 1.0);
  EXPECT_TRUE(AreNear(found / size, numeric / size, 1e-8));
}

TEST_P(OneTag, DerivativesAgreeWithNumericOnesAtAnyDisplacement) {
  for (const double size : {0.0, 1e-6, 0.05}) {
    const Vector6d placed = RandomDisplacement(generator_, size),
                   posed = RandomDisplacement(generator_, size);
    const TagResiduals found = At(camera_, placed, posed);
    ExpectSameJacobian(found.d_camera,
                       NumericJacobian(
                           [&](const CameraParameters& camera) -> Rows {
                             return At(WithParameters(camera_, camera), placed, posed).residual;
                           },
                           ParametersOf(camera_)));
    ExpectSameJacobian(
        found.d_placement,
        NumericJacobian([&](const Vector6d& moved) -> Rows { return At(camera_, moved, posed).residual; },
                        placed));
    ExpectSameJacobian(
        found.d_pose,
        NumericJacobian([&](const Vector6d& moved) -> Rows { return At(camera_, placed, moved).residual; },
                        posed));
  }
}

// Their squares are the errors' squared Mahalanobis distances.
TEST_P(OneTag, ResidualsAreReprojectionErrorsInSigmas) {
  const Rigid3 camera_from_group = GetParam() == TagCarrier::kBase ? placement_.parent_from_group
                                                                   : platform_ * placement_.parent_from_group;
  const TagResiduals found = At(camera_, Vector6d::Zero(), Vector6d::Zero());
  for (size_t k = 0; k < 4; ++k) {
    const Eigen::Vector2d pixel =
        Project(DesktopCamera(true), camera_from_group * tag_.corners_in_group_m[k]);
    const Eigen::Vector2d error_px = pixel - tag_.corners_px[k];
    const Eigen::Index row = 2 * static_cast<Eigen::Index>(k);
    EXPECT_TRUE(AreNear(found.error_px.segment<2>(row), error_px, 1e-9));
    const double distance = error_px.dot(tag_.covariances_px2[k].inverse() * error_px) / (1.3 * 1.3);
    EXPECT_NEAR(found.residual.segment<2>(row).squaredNorm() / distance, 1, 1e-9);
  }
}

TEST_P(OneTag, BehindTheCameraThereIsNothing) {
  platform_.translation.z() = -2;
  if (GetParam() == TagCarrier::kBase) placement_.parent_from_group.translation.z() = -2;
  EXPECT_FALSE(
      EvaluateTag(camera_, placement_, Vector6d::Zero(), platform_, Vector6d::Zero(), tag_).has_value());
}

INSTANTIATE_TEST_SUITE_P(Carriers, OneTag, testing::Values(TagCarrier::kBase, TagCarrier::kPlatform),
                         [](const auto& carrier) {
                           return std::string(carrier.param == TagCarrier::kBase ? "Base" : "Platform");
                         });

// A base whose joints are off the drawing, and a group that is off its place.
class PlacementOffItsDrawing : public testing::TestWithParam<TagCarrier> {};

TEST_P(PlacementOffItsDrawing, DerivativesAgreeWithNumericOnes) {
  using Joints = Eigen::Matrix<double, 18, 1>;
  std::mt19937_64 generator = TestGenerator();
  const Rigid3 camera_from_base{UniformRotation(generator), UniformVector(generator, -1, 1)};
  LegPoints drawn;
  Joints joints;
  for (size_t i = 0; i < kLegCount; ++i) {
    drawn[i] = DesktopHexapod().legs[i].base_joint_m;
    joints.segment<3>(3 * static_cast<Eigen::Index>(i)) =
        camera_from_base * (drawn[i] + UniformVector(generator, -0.01, 0.01));
  }
  TagPlacement placement;
  placement.carrier = GetParam();
  placement.drawn_carrier_from_group = {UniformRotation(generator), UniformVector(generator, -0.3, 0.3)};
  const Rigid3 parent_from_drawn = GetParam() == TagCarrier::kBase
                                       ? camera_from_base * placement.drawn_carrier_from_group
                                       : placement.drawn_carrier_from_group;
  placement.parent_from_group = Displaced(parent_from_drawn, RandomDisplacement(generator, 0.3));
  placement.translation_sigma_m = 0.01;
  placement.rotation_sigma_rad = 0.1;
  const auto at = [&](const Joints& moved, const Vector6d& placed) {
    LegPoints points;
    for (int i = 0; i < kLegCount; ++i) points[static_cast<size_t>(i)] = moved.segment<3>(3 * i);
    return EvaluatePlacement(placement, placed, FitBaseFrame(points, drawn));
  };
  const Vector6d placed = RandomDisplacement(generator, 0.2);
  const PlacementResiduals found = at(joints, placed);
  ExpectSameJacobian(
      found.d_placement,
      NumericJacobian([&](const Vector6d& moved) { return at(joints, moved).residual; }, placed));
  ExpectSameJacobian(
      found.d_base_joints,
      NumericJacobian([&](const Joints& moved) { return at(moved, placed).residual; }, joints));
}

INSTANTIATE_TEST_SUITE_P(Carriers, PlacementOffItsDrawing,
                         testing::Values(TagCarrier::kBase, TagCarrier::kPlatform), [](const auto& carrier) {
                           return std::string(carrier.param == TagCarrier::kBase ? "Base" : "Platform");
                         });

}  // namespace
}  // namespace legible
