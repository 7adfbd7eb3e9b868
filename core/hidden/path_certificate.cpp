#include "core/hidden/path_certificate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "core/algebra/ball.h"
#include "core/hidden/singularity_geometry.h"
#include "core/robots/leg_geometry.h"
#include "core/robots/platform_motion.h"

namespace legible {
namespace {

// Of the path; a smaller piece is left undecided.
constexpr double kSmallestPiece = 1e-7;
constexpr double kLargestPiece = 1.0 / 8;
// By which pieces overlap, and row sums stay below 1.
constexpr double kMargin = 1e-9;
constexpr int kReachSamples = 64;

using Vector3Ball = leg_geometry::Vector3<RealBall>;
using Matrix3Ball = Eigen::Matrix<RealBall, 3, 3>;

// The straight path's pose at s, which may be a whole piece.
struct PathPose {
  Vector3Ball translation_m;
  Matrix3Ball rotation;
};

class StraightPath {
 public:
  StraightPath(const Rigid3& from, const Rigid3& to)
      : from_(from),
        travel_m_(to.translation - from.translation),
        turn_rad_(VectorFromRotation(to.rotation * from.rotation.conjugate())) {}

  Rigid3 At(double s) const {
    return {RotationFromVector(s * turn_rad_) * from_.rotation, from_.translation + s * travel_m_};
  }

  // R = (cos a I + (1 - cos a) n n^T + sin a [n]x) R_from, a = s |turn|, n its axis: for any n near to a unit
  // vector a rotation up to rounding, which is what the path is then taken to be.
  PathPose Over(const RealBall& s) const {
    PathPose pose;
    for (Eigen::Index k = 0; k < 3; ++k)
      pose.translation_m[k] = RealBall(from_.translation[k]) + s * RealBall(travel_m_[k]);
    const Eigen::Matrix3d start = from_.rotation.toRotationMatrix();
    const double angle_rad = turn_rad_.norm();
    if (angle_rad == 0) {
      pose.rotation = start.cast<RealBall>();
      return pose;
    }
    const Eigen::Vector3d axis = turn_rad_ / angle_rad;
    const RealBall turned = s * RealBall(angle_rad);
    const RealBall cosine = Cos(turned), sine = Sin(turned);
    const Matrix3Ball along = (axis * (axis.transpose() * start)).cast<RealBall>();
    const Matrix3Ball across = (Skew(axis) * start).cast<RealBall>();
    pose.rotation = cosine * (start.cast<RealBall>() - along) + along + sine * across;
    return pose;
  }

 private:
  Rigid3 from_;
  Eigen::Vector3d travel_m_, turn_rad_;
};

// [I, -[R b]x] in balls.
Eigen::Matrix<RealBall, 3, 6> PlatformJointVelocity(const Vector3Ball& turned_m) {
  Eigen::Matrix<RealBall, 3, 6> velocity;
  velocity.setZero();
  for (int k = 0; k < 3; ++k) velocity(k, k) = RealBall(1.0);
  velocity(0, 4) = turned_m[2];
  velocity(0, 5) = -turned_m[1];
  velocity(1, 3) = -turned_m[2];
  velocity(1, 5) = turned_m[0];
  velocity(2, 3) = turned_m[1];
  velocity(2, 4) = -turned_m[0];
  return velocity;
}

Vector3Ball Times(const Matrix3Ball& rotation, const Eigen::Vector3d& x) {
  return rotation * x.cast<RealBall>();
}

// What a leg holds on the whole piece, rows of M; nothing where it may not reach, with what is known of that.
struct LegRows {
  std::optional<Eigen::Matrix<RealBall, Eigen::Dynamic, 6>> rows;
  bool is_out_of_reach = false;
};

LegRows RowsOf(const RobotLeg& leg, RobotKind kind, const PathPose& pose) {
  const Vector3Ball turned_m = Times(pose.rotation, leg.platform_joint_m);
  const Vector3Ball c = pose.translation_m + turned_m + leg.carried_offset_m.cast<RealBall>();
  const auto reached = leg_geometry::Reach<RealBall>(leg, SeenSegmentOf(leg.chain), c);
  if (!(LowerBound(reached.reach) > 0)) return {std::nullopt, UpperBound(reached.reach) < 0};
  const auto velocity = PlatformJointVelocity(turned_m);
  if (kind == RobotKind::kReal)
    return {Eigen::Matrix<RealBall, Eigen::Dynamic, 6>(reached.along_m.transpose() * velocity), false};
  return {Eigen::Matrix<RealBall, Eigen::Dynamic, 6>(
              leg_geometry::DirectionByPlatformJoint<RealBall>(reached.along_m, reached.free_direction) *
              velocity),
          false};
}

// |I - Y M| < 1 in the row sum norm.
bool HasFullRank(const RealBallMatrix& m) {
  const Eigen::MatrixXd middle = m.unaryExpr([](const RealBall& x) { return MidpointOf(x); });
  if (!middle.allFinite()) return false;
  const Eigen::MatrixXd inverse = middle.completeOrthogonalDecomposition().pseudoInverse();
  const RealBallMatrix product = inverse.cast<RealBall>() * m;
  for (Eigen::Index i = 0; i < product.rows(); ++i) {
    double sum = 0;
    for (Eigen::Index j = 0; j < product.cols(); ++j) {
      const RealBall off = product(i, j) - RealBall(i == j ? 1.0 : 0.0);
      sum += std::max(std::abs(LowerBound(off)), std::abs(UpperBound(off)));
    }
    if (!(sum < 1 - kMargin)) return false;
  }
  return true;
}

// Whether no pose of the piece is singular.
bool IsFree(const ParallelRobot& robot, RobotKind kind, const std::vector<int>& legs,
            const Eigen::MatrixXd& scaled_basis, const PathPose& pose) {
  const Eigen::Index rows_per_leg = kind == RobotKind::kReal ? 1 : 3;
  RealBallMatrix held(rows_per_leg * static_cast<Eigen::Index>(legs.size()), 6);
  for (size_t k = 0; k < legs.size(); ++k) {
    const LegRows leg = RowsOf(robot.legs[static_cast<size_t>(legs[k])], kind, pose);
    if (!leg.rows) return false;
    held.middleRows(rows_per_leg * static_cast<Eigen::Index>(k), rows_per_leg) = *leg.rows;
  }
  return HasFullRank(held * scaled_basis.cast<RealBall>());
}

// The signed condition of as few legs as the platform needs, enclosed at a pose; nothing where there is none.
std::optional<RealBall> EnclosedCondition(const ParallelRobot& robot, RobotKind kind,
                                          const std::vector<int>& legs, const PathPose& pose, double size_m) {
  std::vector<singularity_geometry::Joint<RealBall>> joints;
  for (const int leg : legs) {
    const RobotLeg& it = robot.legs[static_cast<size_t>(leg)];
    const Vector3Ball turned_m = Times(pose.rotation, it.platform_joint_m);
    const Vector3Ball c = pose.translation_m + turned_m + it.carried_offset_m.cast<RealBall>();
    const auto reached = leg_geometry::Reach<RealBall>(it, SeenSegmentOf(it.chain), c);
    if (!(LowerBound(reached.reach) > 0)) return std::nullopt;
    joints.push_back({c, turned_m, kind == RobotKind::kReal ? reached.along_m : reached.free_direction});
  }
  return singularity_geometry::SignedCondition(robot.motion, kind, joints, RealBall(size_m));
}

// Whether the signed condition is proved to have one sign at the one end and the other at the other.
bool SignsDiffer(const ParallelRobot& robot, RobotKind kind, const std::vector<int>& legs,
                 const StraightPath& path, double size_m) {
  const auto a = EnclosedCondition(robot, kind, legs, path.Over(RealBall(0.0)), size_m);
  const auto b = EnclosedCondition(robot, kind, legs, path.Over(RealBall(1.0)), size_m);
  if (!a || !b) return false;
  return (LowerBound(*a) > 0 && UpperBound(*b) < 0) || (UpperBound(*a) < 0 && LowerBound(*b) > 0);
}

// Whether a leg is proved not to reach some pose of the path beyond s.
bool LeavesReach(const ParallelRobot& robot, RobotKind kind, const std::vector<int>& legs,
                 const StraightPath& path, double s) {
  for (int i = 1; i <= kReachSamples; ++i) {
    const PathPose pose = path.Over(RealBall(s + (1 - s) * i / kReachSamples));
    for (const int leg : legs)
      if (RowsOf(robot.legs[static_cast<size_t>(leg)], kind, pose).is_out_of_reach) return true;
  }
  return false;
}

std::optional<std::string> WhyNotJudged(const ParallelRobot& robot, RobotKind kind,
                                        const std::vector<int>& legs) {
  for (const int leg : legs) {
    const LegChain& chain = robot.legs[static_cast<size_t>(leg)].chain;
    const bool is_judged = kind == RobotKind::kReal ? HoldsAlongSegment(chain)
                                                    : SeenSegmentOf(chain).direction == DirectionOf::kLeg;
    if (!is_judged) return "paths of " + ToText(chain) + " legs are not judged";
  }
  if (robot.motion == PlatformMotion::kSpatial && MotionBasis(robot, robot.home).cols() < 6)
    return std::string("a straight path leaves what RPS legs allow");
  return std::nullopt;
}

}  // namespace

const char* ToString(PathVerdict verdict) {
  switch (verdict) {
    case PathVerdict::kFree:
      return "free";
    case PathVerdict::kSingular:
      return "singular";
    case PathVerdict::kOutOfReach:
      return "out-of-reach";
    case PathVerdict::kUndecided:
      break;
  }
  return "undecided";
}

PathCertificate CertifyStraightPath(const ParallelRobot& robot, RobotKind kind, const std::vector<int>& legs,
                                    const Rigid3& from, const Rigid3& to) {
  PathCertificate certificate;
  certificate.pose = from;
  if (const auto why = WhyNotJudged(robot, kind, legs)) {
    certificate.why = *why;
    return certificate;
  }
  const StraightPath path(from, to);
  const double size_m = SizeOf_m(robot, from);
  const auto scaled_basis = MotionBasisInSize(robot, from, size_m);
  for (double piece = kLargestPiece; certificate.at < 1 && piece >= kSmallestPiece;) {
    const double end = std::min(certificate.at + piece, 1.0);
    const RealBall s((certificate.at + end) / 2, (end - certificate.at) / 2 * (1 + kMargin));
    if (!IsFree(robot, kind, legs, scaled_basis, path.Over(s))) {
      piece /= 2;
      continue;
    }
    ++certificate.pieces;
    certificate.at = end;
    piece = std::min(2 * piece, kLargestPiece);
  }
  certificate.pose = path.At(certificate.at);
  if (certificate.at >= 1) {
    certificate.verdict = PathVerdict::kFree;
  } else if (SignsDiffer(robot, kind, legs, path, size_m)) {
    certificate.verdict = PathVerdict::kSingular;
    certificate.why = "start and goal lie on either side of a singularity: no path avoids it";
  } else if (LeavesReach(robot, kind, legs, path, certificate.at)) {
    certificate.verdict = PathVerdict::kOutOfReach;
    certificate.why = "a leg cannot reach the straight path beyond there";
  } else {
    certificate.why = "the path passes a singularity there, or very near to one";
  }
  return certificate;
}

PathCertificate CertifyPath(const ParallelRobot& robot, RobotKind kind, const std::vector<int>& legs,
                            const std::vector<Rigid3>& poses) {
  if (poses.size() < 2) throw std::invalid_argument("a path has two poses or more");
  PathCertificate whole;
  whole.verdict = PathVerdict::kFree;
  const double parts = static_cast<double>(poses.size() - 1);
  for (size_t i = 0; i + 1 < poses.size(); ++i) {
    PathCertificate part = CertifyStraightPath(robot, kind, legs, poses[i], poses[i + 1]);
    part.pieces += whole.pieces;
    part.at = (static_cast<double>(i) + part.at) / parts;
    whole = part;
    if (whole.verdict != PathVerdict::kFree) break;
  }
  return whole;
}

}  // namespace legible
