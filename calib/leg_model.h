// The unknowns of a calibration and the residuals of one leg in one image, with derivatives; free of any
// solver.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "calib/edge_residuals.h"
#include "core/robots/gough_stewart.h"

namespace legible {

// One leg's unknowns, in this order: A in the camera frame (3, m), B in the platform frame (3, m), R (m),
// joint offset (m), and what shading does to its edges in all images alike (px, outward): shift and tilt
// (towards B, at the edge's end) of edge 1, shift and tilt of edge 2.
inline constexpr int kLegParameterCount = 12;
using LegParameters = Eigen::Matrix<double, kLegParameterCount, 1>;
namespace leg_parameter {
inline constexpr int kBaseJoint = 0, kPlatformJoint = 3, kRadius = 6, kJointOffset = 7, kShading = 8;
}

// All unknowns that the images share: the camera's, then each leg's.
inline constexpr int kSharedParameterCount = kCameraParameterCount + kLegCount * kLegParameterCount;
struct SharedParameters {
  CameraParameters camera;
  std::array<LegParameters, kLegCount> legs;
};
inline constexpr int FirstParameterOfLeg(int leg) { return kCameraParameterCount + leg * kLegParameterCount; }

// Where a leg's axis ends in the camera frame, b, with its derivatives. `d_pose` has a column for each
// unknown of the image: six where the platform is rigid, two where each leg's direction is free.
struct LegTip {
  Eigen::Vector3d b_in_camera;
  Eigen::Matrix3d d_base_joint;
  Eigen::Matrix3d d_platform_joint;
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 6> d_pose;
};

// The tip of a leg on a rigid platform at Displaced(camera_from_platform, displacement): displacement = (v,
// omega) in the camera frame.
LegTip TipOnPlatform(const LegParameters& leg, const Rigid3& camera_from_platform,
                     const Vector6d& displacement);

// The tip of a leg whose direction is free: A + axis + (two tangents of axis) * displacement; axis is not
// zero.
LegTip TipAlongDirection(const LegParameters& leg, const Eigen::Vector3d& axis_in_camera,
                         const Eigen::Vector2d& displacement);

// What one image says of one leg.
struct LegObservation {
  int leg = 0;
  std::vector<WhitenedEdge> edges;
  std::optional<double> reading_m;
  double reading_sigma_m = 1;
};

// Whitened residuals (dimensionless) of one leg in one image: edge samples first, then the reading.
struct LegResiduals {
  Eigen::VectorXd residual;
  Eigen::Matrix<double, Eigen::Dynamic, kCameraParameterCount> d_camera;
  Eigen::Matrix<double, Eigen::Dynamic, kLegParameterCount> d_leg;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, Eigen::Dynamic, 6> d_pose;
};

// Residuals of the observation: one a sample, and one for its reading.
Eigen::Index RowCount(const LegObservation& observation);

// Nothing where the model cannot produce the edges (camera centre inside a leg, a lens folded over).
std::optional<LegResiduals> EvaluateLeg(const Camera& camera, const LegParameters& leg, const LegTip& tip,
                                        const LegObservation& observation);

}  // namespace legible
