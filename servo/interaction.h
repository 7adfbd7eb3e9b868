// How the directions and edges of the legs follow the motion of the platform: the interaction matrices of
// Andreff, Dallej and Martinet 2007, section 3.1.
//
// The twist is the paper's: of the camera, as if it and the base moved and the platform stood still, (v,
// omega) with v the velocity of the camera's centre, in the camera frame. A platform that moves past a camera
// that stands has the opposite twist, (v, omega) with v at the camera's centre too.
#pragma once

#include <Eigen/Core>

#include "servo/servo_model.h"

namespace legible {

// Joint speeds by the twist, row i = -(u_i, A_i x u_i) (eq. 10); directions u in columns, unit, A to B, in
// camera.
using LegDirections = Eigen::Matrix<double, 3, kLegCount>;
Matrix6d CameraInverseJacobian(const ServoModel& model, const LegDirections& directions);

// d(direction) / d(twist) of a leg of that length (eq. 20).
Eigen::Matrix<double, 3, 6> DirectionInteraction(const Eigen::Vector3d& base_joint_in_camera_m,
                                                 const Eigen::Vector3d& direction, double length_m);

// d(outline normal) / d(direction) of a leg that turns about A (eq. 27); the normal is perpendicular to the
// direction.
Eigen::Matrix3d EdgeByDirection(const Eigen::Vector3d& base_joint_in_camera_m,
                                const Eigen::Vector3d& direction, const Eigen::Vector3d& normal);

// A line of the image in the model's pixel frame, unit (eq. 5), and how it follows its normal in the camera
// frame (eq. 36).
struct ImageLine {
  Eigen::Vector3d line;
  Eigen::Matrix3d d_normal;
};
ImageLine ToImage(const ServoModel& model, const Eigen::Vector3d& normal);

}  // namespace legible
