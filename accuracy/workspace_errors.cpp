#include "accuracy/workspace_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "accuracy/batch_errors.h"
#include "accuracy/conditioning.h"
#include "accuracy/maximal_errors.h"

namespace legible {
namespace {

std::vector<Rigid3> PosesOf(const Eigen::MatrixXd& points, const WorkspaceErrorOptions& options) {
  std::vector<Rigid3> poses;
  poses.reserve(static_cast<size_t>(points.cols()));
  for (Eigen::Index i = 0; i < points.cols(); ++i) poses.push_back(options.pose_of_point(points.col(i)));
  return poses;
}

PointState StateOf(PoseStatus status) {
  if (status == PoseStatus::kRegular) return PointState::kInside;
  return status == PoseStatus::kSingular ? PointState::kSingular : PointState::kNearSingular;
}

BatchValues EvaluateHexapod(const GoughStewart& robot, const std::vector<Rigid3>& poses,
                            const WorkspaceErrorOptions& options) {
  BatchOptions batch_options;
  batch_options.joint_error_bounds_m = options.joint_error_bounds;
  batch_options.any_direction = batch_options.condition = batch_options.determinant = true;
  batch_options.joint_readings = options.within_joint_ranges;
  batch_options.characteristic_length_m = options.characteristic_length_m;
  batch_options.threads = options.threads;
  const BatchErrors errors = EvaluateBatch(robot, poses, batch_options);
  BatchValues batch{Eigen::MatrixXd(kErrorRows, static_cast<Eigen::Index>(poses.size())), {}};
  batch.values.topRows<6>() = errors.of_coordinate.transpose();
  batch.values.row(kPositionRow) = errors.position_m.transpose();
  batch.values.row(kRotationRow) = errors.rotation_rad.transpose();
  batch.values.row(kInverseConditionRow) = errors.inverse_condition_two.transpose();
  batch.values.row(kDeterminantRow) = errors.determinant.transpose();
  for (size_t i = 0; i < poses.size(); ++i) {
    const bool counts =
        !options.within_joint_ranges ||
        JointsOutOfRange(robot, errors.joint_readings_m.row(static_cast<Eigen::Index>(i)).transpose())
            .empty();
    batch.states.push_back(counts ? StateOf(errors.status[i]) : PointState::kOutside);
  }
  return batch;
}

// Of any mechanism, one pose after the other.
BatchValues EvaluateEach(const Mechanism& mechanism, const std::vector<Rigid3>& poses,
                         const WorkspaceErrorOptions& options) {
  BatchValues batch{Eigen::MatrixXd::Zero(kErrorRows, static_cast<Eigen::Index>(poses.size())),
                    std::vector<PointState>(poses.size(), PointState::kOutside)};
  const double length_m = options.characteristic_length_m;
  for (size_t i = 0; i < poses.size(); ++i) {
    if (!CanTake(mechanism, poses[i])) continue;
    if (options.within_joint_ranges && !IsReachable(mechanism, poses[i])) continue;
    const FullInverseJacobian inverse = FullInverseJacobianOf(mechanism, poses[i]);
    const PlatformJacobian jacobian = Invert(inverse);
    batch.states[i] = StateOf(jacobian.status);
    auto column = batch.values.col(static_cast<Eigen::Index>(i));
    column[kDeterminantRow] = DeterminantOf(inverse);
    if (jacobian.status == PoseStatus::kSingular) continue;
    const MaximalErrors errors = MaximalErrorsOf(jacobian, options.joint_error_bounds);
    column.head<6>() = errors.of_coordinate;
    column[kPositionRow] = errors.position_m();
    column[kRotationRow] = errors.rotation_rad();
    column[kInverseConditionRow] =
        1 / NormalizedConditionNumbers(inverse, {length_m, length_m, length_m}).two;
  }
  return batch;
}

// --- Where the platform's origin can be.

constexpr int kSubdivisions = 8;  // cells of 1/256 of the first

// The places that one leg allows: between two spheres.
struct LegShell {
  Eigen::Vector3d centre_m;
  double shortest_m, longest_m;
};

// Turned by up to turn_rad, R B moves by at most |B| times that.
std::vector<LegShell> ShellsOf(const Mechanism& mechanism, const Rigid3& pose, double turn_rad) {
  std::vector<LegShell> shells;
  const std::vector<LegShape> legs = LegShapesOf(mechanism);
  const auto ranges = JointRangesOf(mechanism);
  for (size_t i = 0; i < legs.size(); ++i) {
    const double swing_m = turn_rad * legs[i].platform_joint_m.norm();
    shells.push_back({legs[i].base_joint_m - pose.rotation * legs[i].platform_joint_m,
                      ranges[i][0] + legs[i].joint_offset_m - swing_m,
                      ranges[i][1] + legs[i].joint_offset_m + swing_m});
  }
  return shells;
}

struct Cell {
  Eigen::Vector3d centre, half;  // m
};

// A cell that holds the balls of all longest legs' intersection on the pose's side of the base: cut across
// the axis that the pose is farthest along, for the other assembly lies on the other side.
Cell CellAround(const std::vector<LegShell>& shells, const Eigen::Vector3d& place_m) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity()), high = -low;
  Eigen::Vector3d base_m = Eigen::Vector3d::Zero();
  for (const LegShell& shell : shells) {
    low = low.cwiseMax((shell.centre_m.array() - shell.longest_m).matrix());
    high = high.cwiseMin((shell.centre_m.array() + shell.longest_m).matrix());
    base_m += shell.centre_m / static_cast<double>(shells.size());
  }
  Eigen::Index axis = 0;
  (place_m - base_m).cwiseAbs().maxCoeff(&axis);
  if (place_m[axis] > base_m[axis])
    low[axis] = std::max(low[axis], base_m[axis]);
  else
    high[axis] = std::min(high[axis], base_m[axis]);
  return {(low + high) / 2, ((high - low) / 2).cwiseMax(0)};
}

bool MayBeReached(const Cell& cell, const std::vector<LegShell>& shells) {
  return std::all_of(shells.begin(), shells.end(), [&](const LegShell& shell) {
    const Eigen::Vector3d offset = (cell.centre - shell.centre_m).cwiseAbs();
    const double nearest_m = (offset - cell.half).cwiseMax(0).norm(),
                 farthest_m = (offset + cell.half).norm();
    return nearest_m <= shell.longest_m && farthest_m >= shell.shortest_m;
  });
}

std::array<Cell, 8> Halved(const Cell& cell) {
  std::array<Cell, 8> children;
  for (size_t i = 0; i < children.size(); ++i) {
    const Eigen::Vector3d side(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
    children[i] = {cell.centre + side.cwiseProduct(cell.half), cell.half / 2};
  }
  return children;
}

}  // namespace

BatchEvaluator ErrorEvaluator(const Mechanism& mechanism, const WorkspaceErrorOptions& options) {
  const FullInverseJacobian home = FullInverseJacobianOf(mechanism, HomeOf(mechanism));
  // At a singular home rounding makes the sign.
  const bool home_has_aspect = Invert(home).status != PoseStatus::kSingular;
  const double home_determinant = home_has_aspect ? DeterminantOf(home) : 0;
  return [mechanism, options, home_determinant](const Eigen::MatrixXd& points) {
    const std::vector<Rigid3> poses = PosesOf(points, options);
    const auto* hexapod = std::get_if<GoughStewart>(&mechanism);
    BatchValues batch = hexapod != nullptr ? EvaluateHexapod(*hexapod, poses, options)
                                           : EvaluateEach(mechanism, poses, options);
    if (options.in_aspect_of_home)
      for (size_t i = 0; i < poses.size(); ++i)
        if (batch.values(kDeterminantRow, static_cast<Eigen::Index>(i)) * home_determinant < 0)
          batch.states[i] = PointState::kOutside;
    return batch;
  };
}

std::optional<Eigen::Matrix<double, 3, 2>> ReachableRanges(const Mechanism& mechanism, const Rigid3& pose,
                                                           double turn_rad) {
  const std::vector<LegShell> shells = ShellsOf(mechanism, pose, turn_rad);
  std::vector<Cell> cells = {CellAround(shells, pose.translation)};
  for (int level = 0; level < kSubdivisions; ++level) {
    std::vector<Cell> finer;
    for (const Cell& cell : cells)
      for (const Cell& child : Halved(cell))
        if (MayBeReached(child, shells)) finer.push_back(child);
    cells = std::move(finer);
  }
  if (cells.empty()) return std::nullopt;
  Eigen::Matrix<double, 3, 2> ranges;
  ranges << cells[0].centre - cells[0].half, cells[0].centre + cells[0].half;
  for (const Cell& cell : cells) {
    ranges.col(0) = ranges.col(0).cwiseMin(cell.centre - cell.half);
    ranges.col(1) = ranges.col(1).cwiseMax(cell.centre + cell.half);
  }
  return ranges;
}

}  // namespace legible
