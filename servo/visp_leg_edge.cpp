#include "servo/visp_leg_edge.h"

#include <visp3/core/vpException.h>
#include <visp3/core/vpFeatureDisplay.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <iostream>

namespace legible {
namespace {

constexpr unsigned kDimension = 3;

bool IsSelected(unsigned select, unsigned i) { return (select & vpBasicFeature::FEATURE_LINE[i]) != 0; }

// Those rows of the matrix that are selected.
template <int kColumns>
vpMatrix Selected(const Eigen::Matrix<double, kDimension, kColumns>& matrix, unsigned select) {
  vpMatrix rows(0, kColumns);
  for (unsigned i = 0; i < kDimension; ++i) {
    if (!IsSelected(select, i)) continue;
    rows.resize(rows.getRows() + 1, kColumns, false);
    for (unsigned j = 0; j < kColumns; ++j) rows[rows.getRows() - 1][j] = matrix(i, j);
  }
  return rows;
}

}  // namespace

LegEdgeFeature::LegEdgeFeature(const ServoModel& model, int leg) : model_(model), leg_(leg) {
  model_.base_joint_in_camera_m.at(static_cast<size_t>(leg));
  init();
}

void LegEdgeFeature::init() {
  dim_s = kDimension;
  s.resize(kDimension, true);
  has_interaction_ = false;
}

void LegEdgeFeature::Keep(const ImageLine& line) {
  for (unsigned i = 0; i < kDimension; ++i) s[i] = line.line[i];
}

void LegEdgeFeature::BuildGoal(const Eigen::Vector3d& normal) { Keep(ToImage(model_, normal)); }

void LegEdgeFeature::BuildSeen(const Eigen::Vector3d& normal, const Eigen::Vector3d& direction,
                               double length_m, const LegEdgeFeature& goal) {
  const Eigen::Vector3d& a = model_.base_joint_in_camera_m[static_cast<size_t>(leg_)];
  const Eigen::Vector3d in_plane = (direction - normal * normal.dot(direction)).normalized();
  const ImageLine line = ToImage(model_, normal);
  Keep(line);
  interaction_ = -Skew(goal.Line()) * line.d_normal * EdgeByDirection(a, in_plane, normal) *
                 DirectionInteraction(a, in_plane, length_m);
  has_interaction_ = true;
}

vpColVector LegEdgeFeature::error(const vpBasicFeature& goal, unsigned select) {
  const Eigen::Vector3d goal_line(goal[0], goal[1], goal[2]);
  if (s.sumSquare() == 0 || goal_line.isZero())
    throw vpException(vpException::notInitialized, "LegEdgeFeature: the edge or its goal is not built yet");
  return vpColVector(Selected<1>(Line().cross(goal_line), select).getCol(0));
}

vpMatrix LegEdgeFeature::interaction(unsigned select) {
  if (!has_interaction_)
    throw vpException(vpException::notInitialized, "LegEdgeFeature: the edge is not built as seen yet");
  return Selected<6>(interaction_, select);
}

void LegEdgeFeature::print(unsigned select) const {
  std::cout << "LegEdgeFeature, leg " << leg_ + 1 << ":";
  for (unsigned i = 0; i < kDimension; ++i)
    if (IsSelected(select, i)) std::cout << " " << s[i];
  std::cout << std::endl;
}

LegEdgeFeature::RhoTheta LegEdgeFeature::ToRhoTheta() const {
  const Eigen::Vector3d normal = model_.k.transpose() * Line();
  return {-normal.z() / normal.head<2>().norm(), std::atan2(normal.y(), normal.x())};
}

void LegEdgeFeature::display(const vpCameraParameters& camera, const vpImage<unsigned char>& image,
                             const vpColor& color, unsigned thickness) const {
  const RhoTheta line = ToRhoTheta();
  vpFeatureDisplay::displayLine(line.rho, line.theta_rad, camera, image, color, thickness);
}

void LegEdgeFeature::display(const vpCameraParameters& camera, const vpImage<vpRGBa>& image,
                             const vpColor& color, unsigned thickness) const {
  const RhoTheta line = ToRhoTheta();
  vpFeatureDisplay::displayLine(line.rho, line.theta_rad, camera, image, color, thickness);
}

vpMatrix TwistByJointSpeeds(const ServoModel& model, const LegDirections& directions) {
  const Matrix6d inverse = CameraInverseJacobian(model, directions).inverse();
  vpMatrix twist(6, 6);
  for (unsigned i = 0; i < 6; ++i)
    for (unsigned j = 0; j < 6; ++j) twist[i][j] = inverse(i, j);
  return twist;
}

}  // namespace legible
