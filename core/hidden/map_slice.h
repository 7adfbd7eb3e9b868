// Singularities and largest errors over a slice of a robot's workspace (Figures 19 to 21 of Briot et al.
// 2016).
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "core/geometry/pose_coordinates.h"
#include "core/hidden/cone_noise.h"
#include "core/hidden/singularity_conditions.h"
#include "core/robots/parallel_robot.h"

namespace legible {

// Rates of a pose's six coordinates (core/geometry/pose_coordinates.h) by the twists of the platform's motion
// at the pose, which are orthonormal; lengths in units of the robot's size. 6 x dof; the row of a coordinate
// along which the platform does not move is zero.
Eigen::Matrix<double, 6, Eigen::Dynamic> CoordinateRates(const ParallelRobot& robot,
                                                         const Rigid3& base_from_platform);

// Poses of which two coordinates change.
struct PoseSlice {
  std::array<int, 2> axes = {0, 1};
  Eigen::VectorXd first, second;     // values of the two
  Vector6d held = Vector6d::Zero();  // of the other four, from which RPS legs may take the platform away

  Eigen::Index CellCount() const { return first.size() * second.size(); }
};

// Of a cell: first[cell % first.size()] and second[cell / first.size()] to 1e-9, the other coordinates as
// held or, where RPS legs do not allow that, near to it. Nothing where the platform cannot take such a pose.
std::optional<Rigid3> PoseOfCell(const ParallelRobot& robot, const PoseSlice& slice, Eigen::Index cell);

enum class CellState {
  kFine,
  kOutsideJointRanges,
  kOutOfReach,  // of some leg, or the platform cannot take the pose
};
const char* ToString(CellState state);

CellState StateOfCell(const ParallelRobot& robot, const Rigid3& base_from_platform);

// One entry a cell, nothing where it is out of reach.
struct SingularityMap {
  std::vector<std::optional<Type2Measure>> type_2;
  std::vector<std::optional<double>> type_1;
};

struct LegSetMap {
  std::vector<int> legs;  // from 0
  SingularityMap hidden;
  std::vector<std::optional<LargestPoseError>> errors;  // by cone noise
};

struct SliceMap {
  PoseSlice slice;
  std::vector<CellState> states;
  SingularityMap real;
  std::vector<LegSetMap> sets;
};

// Of the real robot and of the robots hidden in servos of these sets of legs (from 0), whose seen directions
// are off by at most half_angle_rad. `progress(cells, of)` is told of every cell.
SliceMap MapSlice(const ParallelRobot& robot, const PoseSlice& slice,
                  const std::vector<std::vector<int>>& leg_sets, double half_angle_rad,
                  const std::function<void(int cells, int of)>& progress = {});

}  // namespace legible
