#include "core/robots/parallel_kinematics.h"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "core/robots/leg_state.h"
#include "core/robots/platform_motion.h"

namespace legible {
namespace {

constexpr double kSameReading = 1e-12;  // m, rad
constexpr int kMostSteps = 100;
// Of the largest singular value; below it the readings do not tell the pose.
constexpr double kLeastSingularValue = 1e-10;

// Readings wanted less readings there, angles the short way round; nothing where a leg does not reach.
std::optional<Eigen::VectorXd> ReadingErrors(const ParallelRobot& robot, const Eigen::VectorXd& wanted,
                                             const Rigid3& base_from_platform) {
  const auto readings = InverseKinematics(robot, base_from_platform);
  if (!readings) return std::nullopt;
  Eigen::VectorXd errors = wanted - *readings;
  for (size_t i = 0; i < robot.legs.size(); ++i) {
    double& error = errors[static_cast<Eigen::Index>(i)];
    if (ReadsAngle(robot.legs[i].chain)) error = std::remainder(error, 2 * std::numbers::pi);
  }
  return errors;
}

// The twist that takes the readings on by `errors` in first order; nothing where they do not tell the pose.
std::optional<Vector6d> GaussNewtonStep(const ParallelRobot& robot, const Eigen::VectorXd& errors,
                                        const Rigid3& base_from_platform) {
  const auto basis = MotionBasis(robot, base_from_platform);
  Eigen::MatrixXd rows(errors.size(), 6);
  for (size_t i = 0; i < robot.legs.size(); ++i) {
    const auto state = StateOf(robot.legs[i], base_from_platform);
    rows.row(static_cast<Eigen::Index>(i)) = ReadingRow(robot.legs[i], *state, base_from_platform);
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows * basis, Eigen::ComputeThinU | Eigen::ComputeThinV);
  if (rows.rows() < basis.cols() ||
      !(svd.singularValues().tail<1>()[0] > kLeastSingularValue * svd.singularValues()[0]))
    return std::nullopt;
  return basis * svd.solve(errors);
}

}  // namespace

std::optional<Eigen::VectorXd> InverseKinematics(const ParallelRobot& robot,
                                                 const Rigid3& base_from_platform) {
  Eigen::VectorXd readings(static_cast<Eigen::Index>(robot.legs.size()));
  for (size_t i = 0; i < robot.legs.size(); ++i) {
    const auto state = StateOf(robot.legs[i], base_from_platform);
    if (!state) return std::nullopt;
    readings[static_cast<Eigen::Index>(i)] = state->reading;
  }
  return readings;
}

bool IsWithinJointRange(const RobotLeg& leg, double reading) {
  if (!leg.joint_range) return true;
  const auto& [least, largest] = *leg.joint_range;
  const double off = reading - (least + largest) / 2;
  return std::abs(ReadsAngle(leg.chain) ? std::remainder(off, 2 * std::numbers::pi) : off) <=
         (largest - least) / 2;
}

bool AreWithinJointRanges(const ParallelRobot& robot, const Eigen::VectorXd& readings) {
  for (size_t i = 0; i < robot.legs.size(); ++i)
    if (!IsWithinJointRange(robot.legs[i], readings[static_cast<Eigen::Index>(i)])) return false;
  return true;
}

ForwardResult ForwardKinematics(const ParallelRobot& robot, const Eigen::VectorXd& readings,
                                const Rigid3& guess_base_from_platform) {
  ForwardResult result{ForwardKinematicsStatus::kNotConverged, guess_base_from_platform, 0};
  for (int step = 0; step < kMostSteps; ++step) {
    const auto errors = ReadingErrors(robot, readings, result.base_from_platform);
    if (!errors) return result;
    result.largest_error = errors->lpNorm<Eigen::Infinity>();
    const auto twist = GaussNewtonStep(robot, *errors, result.base_from_platform);
    if (!twist) {
      result.status = ForwardKinematicsStatus::kSingular;
      return result;
    }
    if (result.largest_error < kSameReading || twist->norm() < kSameReading) {
      result.status = ForwardKinematicsStatus::kConverged;
      return result;
    }
    result.base_from_platform = BackToMotion(robot, Displaced(result.base_from_platform, *twist));
  }
  return result;
}

}  // namespace legible
