#include "calib/leg_model.h"

#include <Eigen/Geometry>

#include "core/geometry/tangents.h"

namespace legible {
namespace {

// Residual row of the reading |b - A| - offset - q, with its derivatives by A, b and the offset.
void FillReading(const LegParameters& leg, const LegTip& tip, const LegObservation& observation,
                 LegResiduals& result) {
  const Eigen::Index row = result.residual.size() - 1;
  const Eigen::Vector3d axis = tip.b_in_camera - leg.segment<3>(leg_parameter::kBaseJoint);
  const double length_m = axis.norm();
  const Eigen::RowVector3d direction = axis.transpose() / (length_m * observation.reading_sigma_m);
  result.residual[row] =
      (length_m - leg[leg_parameter::kJointOffset] - *observation.reading_m) / observation.reading_sigma_m;
  result.d_leg.row(row).segment<3>(leg_parameter::kBaseJoint) =
      direction * (tip.d_base_joint - Eigen::Matrix3d::Identity());
  result.d_leg.row(row).segment<3>(leg_parameter::kPlatformJoint) = direction * tip.d_platform_joint;
  result.d_leg(row, leg_parameter::kJointOffset) = -1 / observation.reading_sigma_m;
  result.d_pose.row(row) = direction * tip.d_pose;
}

}  // namespace

LegTip TipOnPlatform(const LegParameters& leg, const Rigid3& camera_from_platform,
                     const Vector6d& displacement) {
  const MovedPoint tip =
      Move(camera_from_platform, displacement, leg.segment<3>(leg_parameter::kPlatformJoint));
  return {tip.x_in_b, Eigen::Matrix3d::Zero(), tip.d_x_in_a, tip.d_displacement};
}

LegTip TipAlongDirection(const LegParameters& leg, const Eigen::Vector3d& axis_in_camera,
                         const Eigen::Vector2d& displacement) {
  const Eigen::Matrix<double, 3, 2> tangents = TangentsOf(axis_in_camera);
  return {leg.segment<3>(leg_parameter::kBaseJoint) + axis_in_camera + tangents * displacement,
          Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Zero(), tangents};
}

Eigen::Index RowCount(const LegObservation& observation) {
  Eigen::Index rows = observation.reading_m ? 1 : 0;
  for (const WhitenedEdge& edge : observation.edges) rows += edge.rows();
  return rows;
}

std::optional<LegResiduals> EvaluateLeg(const Camera& camera, const LegParameters& leg, const LegTip& tip,
                                        const LegObservation& observation) {
  const auto edges =
      EvaluateEdges(camera, leg.segment<3>(leg_parameter::kBaseJoint), tip.b_in_camera,
                    leg[leg_parameter::kRadius], leg.segment<4>(leg_parameter::kShading), observation.edges);
  if (!edges) return std::nullopt;
  const Eigen::Index edge_rows = edges->residual.size();
  const Eigen::Index rows = RowCount(observation);

  LegResiduals result;
  result.residual.resize(rows);
  result.d_camera.setZero(rows, kCameraParameterCount);
  result.d_leg.setZero(rows, kLegParameterCount);
  result.d_pose.setZero(rows, tip.d_pose.cols());
  result.residual.head(edge_rows) = edges->residual;
  result.d_camera.topRows(edge_rows) = edges->d_camera;
  const auto d_b = edges->d_axis.middleCols<3>(3);
  auto d_leg = result.d_leg.topRows(edge_rows);
  d_leg.middleCols<3>(leg_parameter::kBaseJoint) = edges->d_axis.leftCols<3>() + d_b * tip.d_base_joint;
  d_leg.middleCols<3>(leg_parameter::kPlatformJoint) = d_b * tip.d_platform_joint;
  d_leg.col(leg_parameter::kRadius) = edges->d_axis.col(6);
  d_leg.middleCols<4>(leg_parameter::kShading) = edges->d_shading;
  result.d_pose.topRows(edge_rows) = d_b * tip.d_pose;
  if (observation.reading_m) FillReading(leg, tip, observation, result);
  return result;
}

}  // namespace legible
