#include "core/robots/gough_stewart.h"

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace legible {
namespace {

constexpr int kMaxIterations = 30;

// Largest length error in lengths of the longest leg; the next step would only move it within rounding.
constexpr double kLengthTolerance = 1e-12;

// Smallest over largest pivot of the Jacobian below which a pose counts as singular. Newton comes within
// about sqrt(kLengthTolerance) = 1e-6 of a singular pose before its lengths fit, and this must still see it.
// A length error of a nanometre is here a pose error of about a tenth of a millimetre.
constexpr double kSingularPivotRatio = 1e-5;

using Columns = Eigen::Matrix<double, 3, kLegCount>;  // one a leg

// The legs of a robot in one pose, in base.
struct LegVectors {
  Columns arm_m;      // platform origin to platform joint
  Columns direction;  // unit, base joint to platform joint
  Vector6d length_m;
};

LegVectors LegVectorsAt(const GoughStewart& robot, const Rigid3& base_from_platform) {
  const Eigen::Matrix3d base_rotation_platform = base_from_platform.rotation.toRotationMatrix();
  LegVectors legs;
  for (int i = 0; i < kLegCount; ++i) {
    legs.arm_m.col(i) = base_rotation_platform * robot.legs[i].platform_joint_m;
    legs.direction.col(i) = base_from_platform.translation + legs.arm_m.col(i) - robot.legs[i].base_joint_m;
    legs.length_m[i] = legs.direction.col(i).norm();
    legs.direction.col(i) /= legs.length_m[i];
  }
  return legs;
}

Vector6d JointOffsets(const GoughStewart& robot) {
  Vector6d offsets_m;
  for (int i = 0; i < kLegCount; ++i) offsets_m[i] = robot.legs[i].joint_offset_m;
  return offsets_m;
}

// The inverse Jacobian for linear velocities in units of unit_m / s.
Matrix6d InverseJacobian(const LegVectors& legs, double unit_m) {
  Matrix6d jacobian;
  for (int i = 0; i < kLegCount; ++i) {
    const Eigen::Vector3d u = legs.direction.col(i);
    jacobian.row(i) << unit_m * u.transpose(), legs.arm_m.col(i).cross(u).transpose();
  }
  return jacobian;
}

// Whether a platform joint has travelled farther than the longest leg was at the start.
bool HasLeft(const LegVectors& start, const LegVectors& now) {
  const Columns travel_m =
      now.direction * now.length_m.asDiagonal() - start.direction * start.length_m.asDiagonal();
  return !(travel_m.colwise().norm().maxCoeff() <= start.length_m.maxCoeff());
}

}  // namespace

double PlatformRadius(const GoughStewart& robot) {
  double sum_m2 = 0;
  for (const Leg& leg : robot.legs) sum_m2 += leg.platform_joint_m.squaredNorm();
  return std::sqrt(sum_m2 / kLegCount);
}

Rigid3 InFramesOf(const GoughStewart& to, const GoughStewart& from, const Rigid3& base_from_platform) {
  std::vector<Eigen::Vector3d> from_a, from_b, to_a, to_b;
  for (size_t i = 0; i < kLegCount; ++i) {
    from_a.push_back(from.legs[i].base_joint_m);
    from_b.push_back(from.legs[i].platform_joint_m);
    to_a.push_back(to.legs[i].base_joint_m);
    to_b.push_back(to.legs[i].platform_joint_m);
  }
  return FitRigid(from_a, to_a) * base_from_platform * FitRigid(to_b, from_b);
}

Vector6d InverseKinematics(const GoughStewart& robot, const Rigid3& base_from_platform) {
  return LegVectorsAt(robot, base_from_platform).length_m - JointOffsets(robot);
}

Matrix6d InverseJacobian(const GoughStewart& robot, const Rigid3& base_from_platform) {
  return InverseJacobian(LegVectorsAt(robot, base_from_platform), 1);
}

FullInverseJacobian FullInverseJacobianOf(const GoughStewart& robot, const Rigid3& base_from_platform) {
  return {InverseJacobian(robot, base_from_platform), kLegCount, 3};
}

const std::array<std::string, kGeometryCount>& GeometryNames() {
  static const std::array<std::string, kGeometryCount> names = [] {
    constexpr std::array<const char*, kGeometryPerLeg> kOfLeg = {
        "base_joint_m.x",     "base_joint_m.y",     "base_joint_m.z", "platform_joint_m.x",
        "platform_joint_m.y", "platform_joint_m.z", "joint_offset_m"};
    std::array<std::string, kGeometryCount> all;
    for (size_t i = 0; i < all.size(); ++i)
      all[i] = "legs[" + std::to_string(i / kGeometryPerLeg + 1) + "]." + kOfLeg[i % kGeometryPerLeg];
    return all;
  }();
  return names;
}

Eigen::Matrix<double, kLegCount, kGeometryCount> ReadingsByGeometry(const GoughStewart& robot,
                                                                    const Rigid3& base_from_platform) {
  const LegVectors legs = LegVectorsAt(robot, base_from_platform);
  const Eigen::Matrix3d platform_rotation_base = base_from_platform.rotation.toRotationMatrix().transpose();
  Eigen::Matrix<double, kLegCount, kGeometryCount> derivative;
  derivative.setZero();
  for (int i = 0; i < kLegCount; ++i) {
    const Eigen::Vector3d u = legs.direction.col(i);
    derivative.block<1, kGeometryPerLeg>(i, kGeometryPerLeg * i) << -u.transpose(),
        (platform_rotation_base * u).transpose(), -1;
  }
  return derivative;
}

const char* ToString(ForwardKinematicsStatus status) {
  switch (status) {
    case ForwardKinematicsStatus::kConverged:
      return "converged";
    case ForwardKinematicsStatus::kSingular:
      return "singular";
    case ForwardKinematicsStatus::kNotConverged:
      return "not converged";
  }
  throw std::invalid_argument("ToString: not a ForwardKinematicsStatus");
}

ForwardKinematicsResult ForwardKinematics(const GoughStewart& robot, const Vector6d& joint_readings_m,
                                          const Rigid3& guess_base_from_platform) {
  const Vector6d target_m = joint_readings_m + JointOffsets(robot);
  const double platform_radius_m = PlatformRadius(robot);
  const LegVectors guess_legs = LegVectorsAt(robot, guess_base_from_platform);
  LegVectors legs = guess_legs;
  ForwardKinematicsResult result;
  result.base_from_platform = guess_base_from_platform;
  for (;;) {
    const Vector6d error_m = target_m - legs.length_m;
    result.largest_length_error_m = error_m.cwiseAbs().maxCoeff();
    if (!error_m.allFinite() || HasLeft(guess_legs, legs)) return result;
    // With the platform's radius as the unit of length the pivots do not depend on the robot's size.
    Eigen::FullPivLU<Matrix6d> jacobian(InverseJacobian(legs, platform_radius_m));
    if (!jacobian.setThreshold(kSingularPivotRatio).isInvertible()) {
      result.status = ForwardKinematicsStatus::kSingular;
      return result;
    }
    if (result.largest_length_error_m <= kLengthTolerance * legs.length_m.maxCoeff()) {
      result.status = ForwardKinematicsStatus::kConverged;
      return result;
    }
    if (result.iterations == kMaxIterations) return result;
    Vector6d step = jacobian.solve(error_m);
    step.head<3>() *= platform_radius_m;
    result.base_from_platform = Displaced(result.base_from_platform, step);
    legs = LegVectorsAt(robot, result.base_from_platform);
    ++result.iterations;
  }
}

}  // namespace legible
