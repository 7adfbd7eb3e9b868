#include "tests/reproduction/lab_curves.h"

namespace legible {
namespace {

using Json = nlohmann::json;

Json InPlane_mm(const Eigen::Vector3d& x_in_base_m) { return {1e3 * x_in_base_m.x(), 1e3 * x_in_base_m.z()}; }

Json Middle_mm(const GoughStewart& robot, const Rigid3& base_from_platform, size_t leg, size_t other) {
  const Eigen::Vector3d middle = (robot.legs[leg].platform_joint_m + robot.legs[other].platform_joint_m) / 2;
  return InPlane_mm(base_from_platform * middle);
}

Json DirectionErrors_mrad(const ServoGoal& goal, const EdgesByLeg& seen) {
  Json errors = Json::array();
  for (size_t leg = 0; leg < kLegCount; ++leg) {
    const auto& [edge_1, edge_2] = seen[leg];
    const bool is_seen = edge_1 && edge_2 && goal.directions[leg];
    const Eigen::Vector3d error =
        is_seen
            ? Eigen::Vector3d(DirectionFromEdges(edge_1->normal, edge_2->normal).cross(*goal.directions[leg]))
            : Eigen::Vector3d::Zero();
    for (int i = 0; i < 3; ++i) errors.push_back(is_seen ? Json(1e3 * error[i]) : Json());
  }
  return errors;
}

Json EdgeErrors_px(const ServoModel& model, const ServoGoal& goal, const EdgesByLeg& seen) {
  Json errors = Json::array();
  for (size_t leg = 0; leg < kLegCount; ++leg)
    for (size_t edge = 0; edge < 2; ++edge) {
      const auto &now = seen[leg][edge], &then = goal.edges[leg][edge];
      for (size_t end = 0; end < 2; ++end)
        errors.push_back(now && then ? Json(model.focal_px / now->normal.head<2>().norm() *
                                            now->normal.dot(then->ends[end].homogeneous()))
                                     : Json());
    }
  return errors;
}

}  // namespace

nlohmann::json SideView(const LabServo& servo, const LabRun& run) {
  const GoughStewart& robot = servo.truth.robot;
  Json moments = Json::array();
  for (const LabMoment& moment : run.moments) {
    const Rigid3& pose = moment.true_base_from_platform;
    moments.push_back({{"time_s", moment.time_s},
                       {"origin_mm", InPlane_mm(pose.translation)},
                       {"rear_mm", Middle_mm(robot, pose, 2, 5)},
                       {"front_mm", Middle_mm(robot, pose, 0, 1)}});
  }
  Json legs = Json::array();
  for (const Leg& leg : robot.legs)
    legs.push_back({InPlane_mm(leg.base_joint_m), InPlane_mm(*servo.simulation.start * leg.platform_joint_m),
                    InPlane_mm(servo.true_goal * leg.platform_joint_m)});
  return {{"goal_mm", InPlane_mm(servo.true_goal.translation)}, {"legs_mm", legs}, {"moments", moments}};
}

nlohmann::json ErrorCurves(const LabServo& servo, const LabRun& run) {
  Json moments = Json::array();
  for (const LabMoment& moment : run.moments) {
    const EdgesByLeg seen = ByLeg(moment.seen);
    moments.push_back({{"time_s", moment.time_s},
                       {"directions_mrad", DirectionErrors_mrad(servo.goal, seen)},
                       {"edges_px", EdgeErrors_px(servo.model, servo.goal, seen)},
                       {"direction_rms_mrad", 1e3 * moment.direction_error_rad},
                       {"edge_rms_px", moment.edge_error_px}});
  }
  return moments;
}

}  // namespace legible
