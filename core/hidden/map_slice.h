// Singularities and largest errors over a slice of a robot's workspace (Figures 19 to 21 of Briot et al.
// 2016).
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "core/hidden/cone_noise.h"
#include "core/hidden/singularity_conditions.h"
#include "core/robots/parallel_robot.h"

namespace legible {

// Poses of which two coordinates change: of x y z (m) and the rotation vector (rad) of base_from_platform, 0
// to 5.
struct PoseSlice {
  std::array<int, 2> axes = {0, 1};
  Eigen::VectorXd first, second;     // values of the two
  Vector6d held = Vector6d::Zero();  // of the other four

  Eigen::Index CellCount() const { return first.size() * second.size(); }
};

// Of a cell: first[cell % first.size()] and second[cell / first.size()], brought back to what RPS legs allow.
Rigid3 PoseOfCell(const ParallelRobot& robot, const PoseSlice& slice, Eigen::Index cell);

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
// are off by at most half_angle_rad. `is_done(cells, of)` is told of progress.
SliceMap MapSlice(const ParallelRobot& robot, const PoseSlice& slice,
                  const std::vector<std::vector<int>>& leg_sets, double half_angle_rad,
                  const std::function<void(int cells, int of)>& progress = {});

}  // namespace legible
