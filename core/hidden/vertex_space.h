// Where a leg's platform joint can go while the direction of its seen segment is held: a line or a circle
// (the vertex spaces of Briot et al. 2016, Table 1 and Figures 7, 11, 13).
#pragma once

#include <Eigen/Core>

#include "core/robots/parallel_robot.h"

namespace legible {

struct VertexSpace {
  bool is_circle = false;
  Eigen::Vector3d point_m;  // a point of the line, the circle's centre; in base
  // In base: along the line, unit to 1e-6; of a circle two radii, unit and across each other to rounding.
  Eigen::Vector3d along, second_radius;
  double radius_m = 0;  // of the circle
};

// Of a leg whose seen segment has the direction (unit, in base). The leg's direction has to be its own.
VertexSpace VertexSpaceOf(const RobotLeg& leg, const Eigen::Vector3d& direction);

}  // namespace legible
