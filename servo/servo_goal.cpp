#include "servo/servo_goal.h"

#include <Eigen/Geometry>

#include "core/geometry/cylinder_outline.h"

namespace legible {
namespace {

// An edge as the model has it; `axis` from A to B in camera.
SeenEdge PredictedSighting(const ServoModel& model, int leg, int edge, const Eigen::Vector3d& b_in_camera,
                           const Eigen::Vector3d& normal) {
  const auto i = static_cast<size_t>(leg);
  // The outline touches the cylinder beside a joint P at P + R n.
  const Eigen::Vector3d aside = model.robot.legs[i].radius_m * normal;
  SeenEdge sighting;
  sighting.leg = leg;
  sighting.edge = edge;
  sighting.normal = normal;
  sighting.ends = {(model.base_joint_in_camera_m[i] + aside).hnormalized(),
                   (b_in_camera + aside).hnormalized()};
  return sighting;
}

}  // namespace

Eigen::Vector3d DirectionFromEdges(const Eigen::Vector3d& normal_1, const Eigen::Vector3d& normal_2) {
  return normal_1.cross(normal_2).normalized();
}

Eigen::Matrix3d DirectionCovariance(const SeenEdge& edge_1, const SeenEdge& edge_2) {
  const Eigen::Vector3d cross = edge_1.normal.cross(edge_2.normal);
  const double sine = cross.norm();
  const Eigen::Vector3d u = cross / sine;
  const Eigen::Matrix3d across = (Eigen::Matrix3d::Identity() - u * u.transpose()) / sine;
  const Eigen::Matrix3d by_1 = -across * Skew(edge_2.normal), by_2 = across * Skew(edge_1.normal);
  return by_1 * edge_1.normal_covariance * by_1.transpose() +
         by_2 * edge_2.normal_covariance * by_2.transpose();
}

EdgesByLeg ByLeg(const SeenEdges& seen) {
  EdgesByLeg edges;
  for (const SeenEdge& edge : seen.edges)
    edges.at(static_cast<size_t>(edge.leg)).at(static_cast<size_t>(edge.edge)) = edge;
  return edges;
}

ServoGoal GoalAtPose(const ServoModel& model, const Rigid3& base_from_platform) {
  ServoGoal goal;
  goal.base_from_platform = base_from_platform;
  goal.joint_readings_m = InverseKinematics(model.robot, base_from_platform);
  for (int leg = 0; leg < kLegCount; ++leg) {
    const auto i = static_cast<size_t>(leg);
    const Eigen::Vector3d b_in_camera =
        model.camera_from_base * (base_from_platform * model.robot.legs[i].platform_joint_m);
    const auto axis = LineThrough<double>(model.base_joint_in_camera_m[i], b_in_camera);
    goal.directions[i] = axis.direction;
    const double radius_m = model.robot.legs[i].radius_m;
    if (!CameraIsOutside(axis, radius_m)) continue;
    const auto normals = CylinderOutline(axis, radius_m);
    for (int edge = 0; edge < 2; ++edge)
      goal.edges[i][static_cast<size_t>(edge)] =
          PredictedSighting(model, leg, edge, b_in_camera, normals[static_cast<size_t>(edge)]);
  }
  return goal;
}

ServoGoal GoalFromEdges(const ServoModel& model, const SeenEdges& seen,
                        const Rigid3& guess_base_from_platform) {
  ServoGoal goal;
  goal.edges = ByLeg(seen);
  for (size_t leg = 0; leg < kLegCount; ++leg) {
    const auto& [edge_1, edge_2] = goal.edges[leg];
    if (edge_1 && edge_2) goal.directions[leg] = DirectionFromEdges(edge_1->normal, edge_2->normal);
  }
  const EdgePose pose = FitPoseToEdges(model.robot, model.camera_from_base, seen, guess_base_from_platform);
  if (pose.status != EdgePoseStatus::kConverged) return goal;
  goal.base_from_platform = pose.base_from_platform;
  goal.joint_readings_m = InverseKinematics(model.robot, pose.base_from_platform);
  return goal;
}

}  // namespace legible
