// The base frame: the rigid fit of the drawing to the base joints as the camera sees them, with its
// derivative.
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/geometry/rigid3.h"
#include "core/robots/gough_stewart.h"

namespace legible {

using LegPoints = std::array<Eigen::Vector3d, kLegCount>;

// Where the base stands, and how it moves with the base joints A in the camera frame (x y z of legs 1 to 6),
// exactly to first order: camera_from_base becomes {Exp(omega) rotation, translation + v}, (v, omega) =
// d_joints dA.
struct BaseFrame {
  Rigid3 camera_from_base;
  Eigen::Matrix<double, 6, 18> d_joints;

  // How a point that stands still in the base moves with the base joints.
  Eigen::Matrix<double, 3, 18> MotionOf(const Eigen::Vector3d& x_in_camera) const {
    return d_joints.topRows<3>() -
           Skew(x_in_camera - camera_from_base.translation) * d_joints.bottomRows<3>();
  }
};

// Throws std::invalid_argument where either six points lie on one line.
BaseFrame FitBaseFrame(const LegPoints& base_joints_in_camera_m, const LegPoints& drawn_base_joints_m);

// A in the base frame, and its derivative by A in the camera frame: a motion of all A together leaves it as
// it is.
struct JointsInBase {
  LegPoints base_joints_m;
  Eigen::Matrix<double, 18, 18> d_joints;
};
JointsInBase TakeToBase(const BaseFrame& frame, const LegPoints& base_joints_in_camera_m);

}  // namespace legible
