// What a control law knows of the robot and its camera, with what follows from it once and for all.
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/geometry/camera.h"
#include "core/robots/gough_stewart.h"

namespace legible {

struct ServoModel {
  GoughStewart robot;
  Camera camera;
  Rigid3 camera_from_base;

  std::array<Eigen::Vector3d, kLegCount> base_joint_in_camera_m;  // A
  double platform_radius_m = 0;  // makes rotations comparable to displacements
  // The paper's pixel frame (Andreff et al., section 2.1): the origin in the middle of the image, coordinates
  // from -1 to 1 across its width. K takes normalised image coordinates there.
  Eigen::Matrix3d k;
  Eigen::Matrix3d k_inverse_transposed;
  double focal_px = 0;  // mean of fx and fy: what an angle is in pixels
};

// Throws std::invalid_argument for a camera without size or focal length.
ServoModel MakeServoModel(const GoughStewart& robot, const Camera& camera, const Rigid3& camera_from_base);

// Makes displacements of the platform (m) and its rotations, as displacements at its radius, one unit: twists
// are these times that.
Vector6d RotationsByRadius(const ServoModel& model);

// Singular values of the robot's inverse Jacobian at a pose in these units, descending: the last over the
// first is its conditioning, 0 at a Type 2 singularity.
Vector6d RobotSingularValues(const ServoModel& model, const Rigid3& base_from_platform);

// Leg lengths by the joint readings, m.
Vector6d LegLengths(const GoughStewart& robot, const Vector6d& joint_readings_m);

}  // namespace legible
