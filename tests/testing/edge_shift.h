// Shifts of leg edges in the image by first principles: what EdgeInteraction is checked against.
#pragma once

#include "core/geometry/cylinder_outline.h"
#include "core/robots/leg_interaction.h"
#include "datasets/synthetic_session.h"
#include "tests/testing/derivatives.h"

namespace legible {

// The synthetic sessions' hexapod and camera, with lens distortion.
struct View {
  GoughStewart robot = DesktopHexapod();
  Camera camera = DesktopCamera(true);
  Rigid3 camera_from_base = SyntheticOptions().camera_from_base;
};

inline Eigen::Vector3d EdgeNormal(const View& view, const EdgeEnd& end, const Rigid3& pose) {
  const Leg& leg = view.robot.legs[static_cast<size_t>(end.leg)];
  const auto axis = LineThrough<double>(view.camera_from_base * leg.base_joint_m,
                                        view.camera_from_base * (pose * leg.platform_joint_m));
  return CylinderOutline(axis, leg.radius_m)[static_cast<size_t>(end.edge)];
}

// Where an edge passes its leg's joint in the image.
inline Eigen::Vector2d EndPoint(const View& view, const EdgeEnd& end, const Rigid3& pose) {
  const Leg& leg = view.robot.legs[static_cast<size_t>(end.leg)];
  const Eigen::Vector3d joint =
      view.camera_from_base * (end.is_at_platform ? pose * leg.platform_joint_m : leg.base_joint_m);
  return Project(view.camera, joint + leg.radius_m * EdgeNormal(view, end, pose));
}

// How far outward the edge has moved past an image point that it went through: minus n.(x, 1) over its
// gradient in pixels by differences; in first order, exact where it is 0.
inline double ShiftPast(const View& view, const Eigen::Vector3d& normal, const Eigen::Vector2d& point_px) {
  const auto level = [&](const Eigen::Vector2d& pixel) -> Eigen::Matrix<double, 1, 1> {
    return Eigen::Matrix<double, 1, 1>(normal.dot(Unproject(view.camera, pixel)->homogeneous()));
  };
  return -level(point_px)[0] / NumericJacobian(level, point_px, 0.05).norm();
}

}  // namespace legible
