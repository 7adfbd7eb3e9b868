// Corners of AprilTags as observations: the residuals of a tag and of its group's placement, with
// derivatives; free of any solver.
#pragma once

#include <Eigen/Core>
#include <array>

#include "calib/base_frame.h"
#include "core/geometry/camera_parameters.h"
#include "core/geometry/rigid3.h"
#include "core/session/session.h"

namespace legible {

// A group of tags on its carrier: an unknown of all images, known beforehand as tags.yaml says. What moves it
// is a displacement (v, omega) in the frame of its parent: of the camera for tags on the base, which stands
// still, of the platform for those on the platform.
struct TagPlacement {
  TagCarrier carrier = TagCarrier::kBase;
  Rigid3 parent_from_group;
  Rigid3 drawn_carrier_from_group;
  double translation_sigma_m = 1, rotation_sigma_rad = 1;  // of the drawing, each coordinate
};

// One tag in one image or, on the base, in all of them together.
struct TagObservation {
  size_t group = 0;  // index of its TagPlacement
  std::array<Eigen::Vector3d, 4> corners_in_group_m;
  std::array<Eigen::Vector2d, 4> corners_px;
  std::array<Eigen::Matrix2d, 4> covariances_px2;  // of each corner, up to sigma_scale^2
  double sigma_scale = 1;
};

inline constexpr int kTagRows = 8;  // x and y of four corners

// Residuals of one tag: predicted less observed corners. All but error_px are whitened (dimensionless).
struct TagResiduals {
  Eigen::Matrix<double, kTagRows, 1> error_px;
  Eigen::Matrix<double, kTagRows, 1> residual;
  Eigen::Matrix<double, kTagRows, kCameraParameterCount> d_camera;
  Eigen::Matrix<double, kTagRows, 6> d_placement;
  Eigen::Matrix<double, kTagRows, 6> d_pose;  // of the carrier, on the platform only: see TipOnPlatform
};

// At the placement moved by placement_displacement and, on the platform, the platform's pose moved by
// pose_displacement (neither is looked at on the base). Nothing where a corner lies behind the camera.
std::optional<TagResiduals> EvaluateTag(const Camera& camera, const TagPlacement& placement,
                                        const Vector6d& placement_displacement,
                                        const Rigid3& camera_from_platform, const Vector6d& pose_displacement,
                                        const TagObservation& observation);

// What is known of the placement, whitened: how far the group is from where its drawing puts it on its
// carrier. On the base the carrier's frame follows the base joints.
struct PlacementResiduals {
  Vector6d residual;
  Matrix6d d_placement;
  Eigen::Matrix<double, 6, 18> d_base_joints;  // by A in camera; zero on the platform
};
PlacementResiduals EvaluatePlacement(const TagPlacement& placement, const Vector6d& placement_displacement,
                                     const BaseFrame& base);

}  // namespace legible
