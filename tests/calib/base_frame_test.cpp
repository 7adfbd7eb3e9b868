#include "calib/base_frame.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/testing/derivatives.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

using Joints = Eigen::Matrix<double, 18, 1>;

LegPoints Points(const Joints& joints) {
  LegPoints points;
  for (int i = 0; i < kLegCount; ++i) points[static_cast<size_t>(i)] = joints.segment<3>(3 * i);
  return points;
}

Joints List(const LegPoints& points) {
  Joints joints;
  for (int i = 0; i < kLegCount; ++i) joints.segment<3>(3 * i) = points[static_cast<size_t>(i)];
  return joints;
}

// Base joints in the camera frame that are off their drawing by a centimetre.
class BaseFrameOfDrawing : public testing::Test {
 protected:
  BaseFrameOfDrawing() {
    std::mt19937_64 generator = TestGenerator();
    const GoughStewart robot = DesktopHexapod(generator, 0);
    const Rigid3 camera_from_base{UniformRotation(generator), UniformVector(generator, -1, 1)};
    for (size_t i = 0; i < kLegCount; ++i) {
      drawn_[i] = robot.legs[i].base_joint_m;
      in_camera_[i] = camera_from_base * (drawn_[i] + UniformVector(generator, -0.01, 0.01));
    }
  }

  LegPoints drawn_, in_camera_;
};

TEST_F(BaseFrameOfDrawing, MovesWithTheJointsAsItsDerivativeSays) {
  const BaseFrame frame = FitBaseFrame(in_camera_, drawn_);
  const auto numeric = NumericJacobian(
      [&](const Joints& joints) {
        return Displacement(frame.camera_from_base, FitBaseFrame(Points(joints), drawn_).camera_from_base);
      },
      List(in_camera_));
  EXPECT_TRUE(AreNear(frame.d_joints, numeric, 1e-9));
}

TEST_F(BaseFrameOfDrawing, JointsInItMoveAsTheirDerivativeSays) {
  const JointsInBase joints = TakeToBase(FitBaseFrame(in_camera_, drawn_), in_camera_);
  const auto numeric = NumericJacobian(
      [&](const Joints& moved) {
        return List(TakeToBase(FitBaseFrame(Points(moved), drawn_), Points(moved)).base_joints_m);
      },
      List(in_camera_));
  EXPECT_TRUE(AreNear(joints.d_joints, numeric, 1e-9));
}

}  // namespace
}  // namespace legible
