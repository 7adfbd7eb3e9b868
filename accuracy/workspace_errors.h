// Maximal errors over a workspace: what SampleWorkspace and maps evaluate at each point.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "accuracy/workspace.h"
#include "core/robots/mechanism.h"

namespace legible {

// Rows of what ErrorEvaluator gives for each point.
inline constexpr int kPositionRow = 6, kRotationRow = 7, kInverseConditionRow = 8, kDeterminantRow = 9;
inline constexpr int kErrorRows = 10;

struct WorkspaceErrorOptions {
  Eigen::VectorXd joint_error_bounds;  // m
  double characteristic_length_m = 1;  // of the 2-norm condition number
  bool within_joint_ranges = false;    // poses beyond them are outside
  bool in_aspect_of_home = false;      // poses whose determinant has another sign than home's are outside
  int threads = 1;
  // base_from_platform of a point of the box: x y z and three orientation coordinates.
  std::function<Rigid3(const Eigen::Ref<const Eigen::VectorXd>&)> pose_of_point;
};

// Six maximal errors (m, rad), the largest position error (m), the largest rotation (rad), the inverse 2-norm
// condition number of the length-normalised inverse Jacobian, its determinant (SI).
BatchEvaluator ErrorEvaluator(const Mechanism& mechanism, const WorkspaceErrorOptions& options);

// Ranges of x, y, z that hold every place of the platform's origin that the joint ranges allow with the
// platform oriented as in `pose` or turned from there by up to turn_rad, on the side of the base where the
// pose is; for one orientation up to a third wider than they must be. By subdivision: a cell is out where the
// shortest or longest length of some leg in it, the distances of a point from a base joint, is. Columns:
// lowest, highest. Nothing where there is no such place.
std::optional<Eigen::Matrix<double, 3, 2>> ReachableRanges(const Mechanism& mechanism, const Rigid3& pose,
                                                           double turn_rad = 0);

}  // namespace legible
