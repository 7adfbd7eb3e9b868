// Where a servo is to lead, in whatever terms are known of it.
#pragma once

#include <array>
#include <optional>

#include "core/vision/pose_from_edges.h"
#include "core/vision/seen_edges.h"
#include "servo/servo_model.h"

namespace legible {

// Unit direction of a leg, A to B, from the outline normals of its two edges (Andreff et al., eq. 13).
Eigen::Vector3d DirectionFromEdges(const Eigen::Vector3d& normal_1, const Eigen::Vector3d& normal_2);
// And its covariance, rank 2.
Eigen::Matrix3d DirectionCovariance(const SeenEdge& edge_1, const SeenEdge& edge_2);

// At most one sighting of each edge of each leg.
using EdgesByLeg = std::array<std::array<std::optional<SeenEdge>, 2>, kLegCount>;
EdgesByLeg ByLeg(const SeenEdges& seen);

struct ServoGoal {
  EdgesByLeg edges;
  std::array<std::optional<Eigen::Vector3d>, kLegCount> directions;  // in camera
  std::optional<Rigid3> base_from_platform;
  std::optional<Vector6d> joint_readings_m;
};

// All four as the model has them at a pose; edges from joint to joint, without noise. A leg that has no
// outline in this camera has no edges.
ServoGoal GoalAtPose(const ServoModel& model, const Rigid3& base_from_platform);

// "Teach by showing": the edges as they were seen with the robot at the goal, directions where both edges of
// a leg were seen, and pose and readings by the pose that fits the edges best, where there is one near the
// guess. Edges and directions do not depend on the model's geometry.
ServoGoal GoalFromEdges(const ServoModel& model, const SeenEdges& seen,
                        const Rigid3& guess_base_from_platform);

}  // namespace legible
