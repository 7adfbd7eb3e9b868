// The legs' edges as one image shows them: what a control law takes from it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace legible {

// One edge of one leg.
struct SeenEdge {
  int leg = 0;   // 0-based
  int edge = 0;  // 0 or 1: outline normal n1 or n2 of CylinderOutline
  // Outline normal in the camera frame, unit, away from the leg; its covariance has rank 2.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Matrix3d normal_covariance = Eigen::Matrix3d::Zero();
  // Where the stretch that was seen begins (towards A) and ends, normalised image coordinates without
  // distortion.
  std::array<Eigen::Vector2d, 2> ends = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
};

// At most twelve, ordered by leg and edge, each at most once.
struct SeenEdges {
  double time_s = 0;  // of the exposure, by the rig's clock
  std::vector<SeenEdge> edges;
};

}  // namespace legible
