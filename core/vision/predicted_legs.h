// Where the model says that the legs are in an image: their outlines and which stretches of them can be seen.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/camera.h"
#include "core/geometry/cylinder_outline.h"
#include "core/robots/gough_stewart.h"

namespace legible {

// A leg in front of the camera: its cylinder from base joint to platform joint.
struct LegInCamera {
  Eigen::Vector3d a_in_camera;
  Eigen::Vector3d b_in_camera;
  double radius_m = 0;

  Eigen::Vector3d AxisPoint(double share) const { return a_in_camera + share * (b_in_camera - a_in_camera); }
};
using LegsInCamera = std::array<LegInCamera, kLegCount>;

// The robot's legs as the camera sees them, of the frames base, platform and camera.
LegsInCamera PlaceLegs(const GoughStewart& robot, const Rigid3& camera_from_base,
                       const Rigid3& base_from_platform);

// What hides a point of an edge, or spoils its surroundings.
enum class EdgeObstacle {
  kNone,
  kOtherLeg,  // crosses it: hides it, or disturbs it from behind by its own edges
  kPlatform,
  kJoint,  // the ball or fork at the leg's ends
  kImageBorder,
};

// A point of a leg's edge as the camera would see it.
struct PredictedEdgePoint {
  double share = 0;           // along the axis, 0 at A, 1 at B
  Eigen::Vector2d point_px;   // distorted
  Eigen::Vector2d normal_px;  // unit, away from the leg
  EdgeObstacle obstacle = EdgeObstacle::kNone;
  int obstacle_leg = -1;  // 0-based, where that is another leg
};

struct PredictedEdge {
  Eigen::Vector3d normal;    // outline normal in the camera frame
  double half_width_px = 0;  // of the leg in the image, at its middle
  std::vector<PredictedEdgePoint>
      points;  // from A to B, about step_px apart; none where the leg shows no edge
};

struct VisibilityOptions {
  double step_px = 6;                // between points
  double margin_px = 9;              // kept free around other legs and at the image border
  double joint_radii = 2.2;          // what the joints at a leg's ends cover, in leg radii
  double platform_margin_m = 0.025;  // of the plate beyond the hull of the platform joints
};

// Both edges of every leg.
using PredictedEdges = std::array<std::array<PredictedEdge, 2>, kLegCount>;
PredictedEdges PredictEdges(const LegsInCamera& legs, const Camera& camera, const VisibilityOptions& options);

// The point of the edge with outline normal `normal` that is nearest to the image of x_in_camera
// (undistorted), distorted, with the unit normal of the distorted edge there; nothing behind the camera or
// where the lens folds.
struct ImagePointOnEdge {
  Eigen::Vector2d point_px;
  Eigen::Vector2d normal_px;
};
std::optional<ImagePointOnEdge> EdgePointNear(const Camera& camera, const Eigen::Vector3d& normal,
                                              const Eigen::Vector3d& x_in_camera);

// "hidden by leg 3", "behind the platform", …
std::string Describe(const PredictedEdgePoint& point);

}  // namespace legible
