#include "core/vision/pose_from_edges.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "core/geometry/cylinder_outline.h"
#include "core/geometry/tangents.h"

namespace legible {
namespace {

constexpr int kMaxIterations = 60;          // slow where the camera is only roughly known: large residuals
constexpr int kLeastEdges = 6;              // each says one number of the pose, for its leg turns about A
constexpr double kSmallStep = 1e-11;        // of the platform joints, in leg lengths
constexpr double kLeastPivotShare = 1e-12;  // of the information in natural units
constexpr double kLeastNormalSigma = 1e-9;  // rad: edges without noise weigh alike

using Information = Eigen::Matrix<double, 6, 6>;

struct Normals {
  Matrix6d information = Matrix6d::Zero();
  Vector6d moment = Vector6d::Zero();
  double squares = 0;
  int rows = 0;
};

// Both numbers that say where the edge is, whitened, and how they follow a displacement of the platform in
// base.
struct EdgeEquation {
  Eigen::Vector2d residual;
  Eigen::Matrix<double, 2, 6> derivative;
};

std::optional<EdgeEquation> EquationOf(const GoughStewart& robot, const Rigid3& camera_from_base,
                                       const SeenEdge& seen, const Rigid3& base_from_platform) {
  const Leg& leg = robot.legs.at(static_cast<size_t>(seen.leg));
  const Eigen::Vector3d arm_in_base = base_from_platform.rotation * leg.platform_joint_m;
  const Eigen::Vector3d a = camera_from_base * leg.base_joint_m;
  const Eigen::Vector3d b = camera_from_base * (base_from_platform.translation + arm_in_base);
  const auto axis = LineThrough<double>(a, b);
  if (!CameraIsOutside(axis, leg.radius_m)) return std::nullopt;
  const Eigen::Vector3d normal = CylinderOutline(axis, leg.radius_m)[static_cast<size_t>(seen.edge)];
  const Eigen::Matrix<double, 3, 2> tangents = TangentsOf(seen.normal);
  Eigen::Matrix2d covariance = tangents.transpose() * seen.normal_covariance * tangents;
  covariance.diagonal().array() += kLeastNormalSigma * kLeastNormalSigma;
  const Eigen::LLT<Eigen::Matrix2d> root(covariance);
  const Eigen::Matrix3d camera_rotation_base = camera_from_base.rotation.toRotationMatrix();
  Eigen::Matrix<double, 3, 6> d_b;
  d_b << camera_rotation_base, -camera_rotation_base * Skew(arm_in_base);
  const Eigen::Matrix<double, 2, 6> derivative =
      tangents.transpose() * OutlineJacobian(a, b, normal).middleCols<3>(3) * d_b;
  return EdgeEquation{root.matrixL().solve(Eigen::Vector2d(tangents.transpose() * normal)),
                      root.matrixL().solve(derivative)};
}

std::optional<Normals> NormalsAt(const GoughStewart& robot, const Rigid3& camera_from_base,
                                 const SeenEdges& seen, const Rigid3& base_from_platform) {
  Normals normals;
  for (const SeenEdge& edge : seen.edges) {
    const auto equation = EquationOf(robot, camera_from_base, edge, base_from_platform);
    if (!equation) return std::nullopt;
    normals.information += equation->derivative.transpose() * equation->derivative;
    normals.moment += equation->derivative.transpose() * equation->residual;
    normals.squares += equation->residual.squaredNorm();
    normals.rows += 2;
  }
  return normals;
}

// Whether some motion of the platform, rotations by the platform's radius, stays open.
bool IsOpen(const Matrix6d& information, double radius_m) {
  Vector6d unit;
  unit << 1, 1, 1, 1 / radius_m, 1 / radius_m, 1 / radius_m;
  const Matrix6d natural = unit.asDiagonal() * information * unit.asDiagonal();
  const Eigen::LDLT<Matrix6d> factors(natural);
  const Vector6d pivots = factors.vectorD();
  return !(pivots.minCoeff() > kLeastPivotShare * pivots.maxCoeff());
}

}  // namespace

const char* ToString(EdgePoseStatus status) {
  switch (status) {
    case EdgePoseStatus::kConverged:
      return "converged";
    case EdgePoseStatus::kTooFewEdges:
      return "too few edges";
    case EdgePoseStatus::kNotConverged:
      return "not converged";
  }
  throw std::invalid_argument("ToString: not an EdgePoseStatus");
}

EdgePose FitPoseToEdges(const GoughStewart& robot, const Rigid3& camera_from_base, const SeenEdges& seen,
                        const Rigid3& guess_base_from_platform) {
  EdgePose found;
  found.base_from_platform = guess_base_from_platform;
  const double radius_m = PlatformRadius(robot);
  const double length_m = (guess_base_from_platform.translation).norm() + radius_m;
  for (; found.iterations < kMaxIterations; ++found.iterations) {
    const auto normals = NormalsAt(robot, camera_from_base, seen, found.base_from_platform);
    if (!normals || !std::isfinite(normals->squares)) return found;
    if (normals->rows < 2 * kLeastEdges || IsOpen(normals->information, radius_m)) {
      found.status = EdgePoseStatus::kTooFewEdges;
      return found;
    }
    const Eigen::LLT<Matrix6d> information(normals->information);
    const Vector6d step = -information.solve(normals->moment);
    if (!(step.head<3>().norm() + radius_m * step.tail<3>().norm() < length_m)) return found;
    found.base_from_platform = Displaced(found.base_from_platform, step);
    found.rms_sigma = std::sqrt(normals->squares / normals->rows);
    if (step.head<3>().norm() + radius_m * step.tail<3>().norm() > kSmallStep * length_m) continue;
    found.status = EdgePoseStatus::kConverged;
    found.covariance = information.solve(Matrix6d::Identity());
    return found;
  }
  return found;
}

}  // namespace legible
