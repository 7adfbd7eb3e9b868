#include "servo/interaction.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/servo/servo_scene.h"
#include "tests/testing/derivatives.h"
#include "tests/testing/matrices.h"

namespace legible {
namespace {

// A leg before the camera.
struct LegThere {
  Eigen::Vector3d a, b;
  double radius_m;

  Eigen::Vector3d Direction() const { return (b - a).normalized(); }
  double Length() const { return (b - a).norm(); }
};

LegThere LegOf(const ServoScene& scene, int leg) {
  return {scene.model.base_joint_in_camera_m[static_cast<size_t>(leg)],
          PlatformJointInCamera(scene.model, scene.pose, leg),
          scene.model.robot.legs[static_cast<size_t>(leg)].radius_m};
}

// Where the platform joint comes to if camera and base move by the twist and the platform stands: in the
// camera's frame A stays, and B goes the other way.
Eigen::Vector3d AfterTwist(const Eigen::Vector3d& b, const Vector6d& twist) {
  return RotationFromVector(-twist.tail<3>()) * b - twist.head<3>();
}

// Calls check(scene, leg) for all legs of some scenes.
template <typename Check>
void ForLegs(const Check& check) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 10; ++n) {
    const ServoScene scene = RandomScene(generator);
    for (int leg = 0; leg < kLegCount; ++leg) check(scene, leg);
  }
}

TEST(DirectionInteraction, IsHowADirectionFollowsTheCamerasTwistByDifferences) {
  ForLegs([](const ServoScene& scene, int i) {
    const LegThere leg = LegOf(scene, i);
    const auto direction = [&](const Vector6d& twist) -> Eigen::Vector3d {
      return (AfterTwist(leg.b, twist) - leg.a).normalized();
    };
    EXPECT_TRUE(AreNear(DirectionInteraction(leg.a, leg.Direction(), leg.Length()),
                        NumericJacobian(direction, Vector6d::Zero().eval()), 1e-9));
  });
}

TEST(EdgeByDirection, IsHowAnEdgeFollowsALegThatTurnsAboutItsBaseJointByDifferences) {
  ForLegs([](const ServoScene& scene, int i) {
    const LegThere leg = LegOf(scene, i);
    const Eigen::Vector3d u = leg.Direction();
    for (size_t edge = 0; edge < 2; ++edge) {
      const auto normal = [&](const Eigen::Vector3d& change) -> Eigen::Vector3d {
        return CylinderOutline(LineThrough<double>(leg.a, leg.a + u + change), leg.radius_m)[edge];
      };
      // A change along u is none.
      const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - u * u.transpose();
      const Eigen::Matrix3d found = EdgeByDirection(leg.a, u, normal(Eigen::Vector3d::Zero()));
      EXPECT_TRUE(AreNear(found * across, NumericJacobian(normal, Eigen::Vector3d::Zero().eval()), 1e-8));
    }
  });
}

TEST(EdgeByDirection, TimesTheDirectionsInteractionIsHowAnEdgeFollowsTheCamerasTwistByDifferences) {
  ForLegs([](const ServoScene& scene, int i) {
    const LegThere leg = LegOf(scene, i);
    for (size_t edge = 0; edge < 2; ++edge) {
      const auto normal = [&](const Vector6d& twist) -> Eigen::Vector3d {
        return CylinderOutline(LineThrough<double>(leg.a, AfterTwist(leg.b, twist)), leg.radius_m)[edge];
      };
      const Eigen::Matrix<double, 3, 6> found =
          EdgeByDirection(leg.a, leg.Direction(), normal(Vector6d::Zero())) *
          DirectionInteraction(leg.a, leg.Direction(), leg.Length());
      EXPECT_TRUE(AreNear(found, NumericJacobian(normal, Vector6d::Zero().eval()), 1e-8));
    }
  });
}

TEST(ToImage, IsTheEdgesLineInThePixelFrameAndFollowsItsNormalByDifferences) {
  ForLegs([](const ServoScene& scene, int i) {
    const LegThere leg = LegOf(scene, i);
    const Camera& camera = scene.model.camera;
    for (const Eigen::Vector3d& normal : CylinderOutline(LineThrough<double>(leg.a, leg.b), leg.radius_m)) {
      const ImageLine image = ToImage(scene.model, normal);
      EXPECT_NEAR(image.line.norm(), 1, 1e-14);
      // From -1 to 1 across the width, from border to border: pixel 0 is the centre of the first.
      const Eigen::Vector2d pixel = Project(camera, leg.b + leg.radius_m * normal);
      const Eigen::Vector2d centred =
          pixel + Eigen::Vector2d(0.5, 0.5) - Eigen::Vector2d(camera.width_px, camera.height_px) / 2;
      EXPECT_NEAR(image.line.dot((centred / (camera.width_px / 2.0)).homogeneous()), 0, 1e-14);
      const auto line = [&](const Eigen::Vector3d& n) -> Eigen::Vector3d {
        return ToImage(scene.model, n).line;
      };
      EXPECT_TRUE(AreNear(image.d_normal, NumericJacobian(line, normal), 1e-9));
      // Andreff et al., eq. 36.
      const Eigen::Matrix3d printed = (scene.model.k.transpose() * image.line).norm() *
                                      (Eigen::Matrix3d::Identity() - image.line * image.line.transpose()) *
                                      scene.model.k.inverse().transpose();
      EXPECT_TRUE(AreNear(image.d_normal, printed, 1e-12));
    }
  });
}

TEST(CameraInverseJacobian, IsHowTheLegLengthsFollowTheCamerasTwistByDifferences) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 10; ++n) {
    const ServoScene scene = RandomScene(generator);
    LegDirections directions;
    for (int i = 0; i < kLegCount; ++i) directions.col(i) = LegOf(scene, i).Direction();
    const auto lengths = [&](const Vector6d& twist) {
      Vector6d lengths_m;
      for (int i = 0; i < kLegCount; ++i)
        lengths_m[i] = (AfterTwist(LegOf(scene, i).b, twist) - LegOf(scene, i).a).norm();
      return lengths_m;
    };
    EXPECT_TRUE(AreNear(CameraInverseJacobian(scene.model, directions),
                        NumericJacobian(lengths, Vector6d::Zero().eval()), 1e-9));
  }
}

TEST(ServoModel, NeedsACameraWithASizeAndFocalLengths) {
  std::mt19937_64 generator = TestGenerator();
  const ServoScene scene = RandomScene(generator);
  Camera camera = scene.model.camera;
  camera.width_px = 0;
  EXPECT_THROW(MakeServoModel(scene.model.robot, camera, scene.model.camera_from_base),
               std::invalid_argument);
  camera = scene.model.camera;
  camera.fy_px = 0;
  EXPECT_THROW(MakeServoModel(scene.model.robot, camera, scene.model.camera_from_base),
               std::invalid_argument);
}

}  // namespace
}  // namespace legible
