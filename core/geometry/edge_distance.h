// How far a measured image point lies from the distorted image of a leg's edge, and how that changes with the
// model.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/geometry/camera_parameters.h"

namespace legible {

struct EdgeDistance {
  double distance_px = 0;            // along direction_px; positive where the point lies outside the leg
  Eigen::Vector2d foot_undistorted;  // the edge's point that was measured to, normalised coordinates
  Eigen::RowVector3d d_distance_d_normal;
  Eigen::Matrix<double, 1, kCameraParameterCount> d_distance_d_camera;
};

// Signed distance, measured along the unit vector direction_px, from the distorted image of the edge with
// outline normal `normal` (CylinderOutline) to the image point point_px. The foot is the point x of the line
// normal.(x, 1) = 0 whose distorted projection lies on the ray point_px - r direction_px; exact for any lens
// model, by Newton on x. Nothing where that has no solution near the point (the edge parallel to
// direction_px, or a lens that folds over).
std::optional<EdgeDistance> DistanceToEdge(const Camera& camera, const Eigen::Vector3d& normal,
                                           const Eigen::Vector2d& point_px,
                                           const Eigen::Vector2d& direction_px);

}  // namespace legible
