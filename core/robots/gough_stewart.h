// The Gough-Stewart hexapod: six cylindrical legs of variable length between a base and a platform.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

#include "core/geometry/rigid3.h"
#include "core/robots/full_inverse_jacobian.h"

namespace legible {

inline constexpr int kLegCount = 6;

struct Leg {
  Eigen::Vector3d base_joint_m = Eigen::Vector3d::Zero();      // A, in base
  Eigen::Vector3d platform_joint_m = Eigen::Vector3d::Zero();  // B, in platform
  double radius_m = 0;                                         // R of the leg's cylinder
  double joint_offset_m = 0;                                   // leg length = joint reading + joint_offset_m
  std::array<double, 2> joint_range_m = {0, 0};                // shortest and longest joint reading
};

struct GoughStewart {
  std::string name;
  Rigid3 home;  // base_from_platform where forward kinematics starts
  std::array<Leg, kLegCount> legs;
};

// Root mean square distance of the platform joints from the platform's origin, m: by what a rotation is made
// comparable to a displacement.
double PlatformRadius(const GoughStewart& robot);

// The pose in the frames of another robot of the same build: those that fit its base and platform joints
// best.
Rigid3 InFramesOf(const GoughStewart& to, const GoughStewart& from, const Rigid3& base_from_platform);

// Joint readings |B_i - A_i| - offset_i (m) that put the platform at base_from_platform.
Vector6d InverseKinematics(const GoughStewart& robot, const Rigid3& base_from_platform);

// d(leg lengths) / d(platform twist), 6 x 6: row i = (u_i, b_i x u_i) for a platform twist (v, omega) in base
// whose v is the velocity of the platform's origin; b_i = base_rotation_platform B_i (m), u_i the leg's
// direction A to B.
Matrix6d InverseJacobian(const GoughStewart& robot, const Rigid3& base_from_platform);

// The same as the accuracy of any robot is computed from.
FullInverseJacobian FullInverseJacobianOf(const GoughStewart& robot, const Rigid3& base_from_platform);

// Parameters of the geometry that move the platform: for each leg A (base), B (platform) and the joint
// offset, m.
inline constexpr int kGeometryPerLeg = 7;
inline constexpr int kGeometryCount = kGeometryPerLeg * kLegCount;

// Names as model.yaml has them: "legs[1].base_joint_m.x", …, "legs[6].joint_offset_m".
const std::array<std::string, kGeometryCount>& GeometryNames();

// d(joint readings) / d(geometry) at a fixed pose, 6 x 42. With J the inverse of InverseJacobian, a platform
// whose readings are kept moves by -J times this (Merlet 2006, section 2, the design parameters P).
Eigen::Matrix<double, kLegCount, kGeometryCount> ReadingsByGeometry(const GoughStewart& robot,
                                                                    const Rigid3& base_from_platform);

enum class ForwardKinematicsStatus {
  kConverged,
  kSingular,      // the inverse Jacobian lost rank, on the way or at the pose found
  kNotConverged,  // the readings belong to no pose within a leg's length of the guess, or are not numbers
};
const char* ToString(ForwardKinematicsStatus status);

struct ForwardKinematicsResult {
  ForwardKinematicsStatus status = ForwardKinematicsStatus::kNotConverged;
  Rigid3 base_from_platform;          // the last iterate, also where it did not converge
  double largest_length_error_m = 0;  // of a leg, there
  int iterations = 0;                 // Newton steps taken
};

// The pose of the given joint readings (m) to which Newton on the six leg lengths converges from the guess:
// on a desktop hexapod the right one from 8 cm and 20 degrees away. Allocates nothing.
ForwardKinematicsResult ForwardKinematics(const GoughStewart& robot, const Vector6d& joint_readings_m,
                                          const Rigid3& guess_base_from_platform);

}  // namespace legible
