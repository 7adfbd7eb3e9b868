#include "core/hidden/path_certificate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/algebra/ball.h"
#include "core/robots/leg_geometry.h"
#include "core/robots/platform_motion.h"

namespace legible {
namespace {

// Of the path; a smaller piece is left undecided.
constexpr double kSmallestPiece = 1e-7;
constexpr double kLargestPiece = 1.0 / 8;
constexpr double kSignMargin = 1e-9;

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

enum class PieceVerdict { kFree, kOutOfReach, kUndecided };

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
    if (!(sum < 1 - kSignMargin)) return false;
  }
  return true;
}

PieceVerdict JudgePiece(const ParallelRobot& robot, RobotKind kind, const std::vector<int>& legs,
                        const Eigen::MatrixXd& scaled_basis, const PathPose& pose) {
  const Eigen::Index rows_per_leg = kind == RobotKind::kReal ? 1 : 3;
  RealBallMatrix held(rows_per_leg * static_cast<Eigen::Index>(legs.size()), 6);
  for (size_t k = 0; k < legs.size(); ++k) {
    const LegRows leg = RowsOf(robot.legs[static_cast<size_t>(legs[k])], kind, pose);
    if (!leg.rows) return leg.is_out_of_reach ? PieceVerdict::kOutOfReach : PieceVerdict::kUndecided;
    held.middleRows(rows_per_leg * static_cast<Eigen::Index>(k), rows_per_leg) = *leg.rows;
  }
  return HasFullRank(held * scaled_basis.cast<RealBall>()) ? PieceVerdict::kFree : PieceVerdict::kUndecided;
}

// Of a signed condition that is known at both ends; 0 where it is not.
int SignsBetween(const ParallelRobot& robot, RobotKind kind, const std::vector<int>& legs, const Rigid3& from,
                 const Rigid3& to) {
  if (robot.motion == PlatformMotion::kTranslation && kind == RobotKind::kHidden) return 0;  // unsigned
  const auto a = Type2MeasureOf(robot, kind, legs, from), b = Type2MeasureOf(robot, kind, legs, to);
  if (!a || !b || !a->geometric || !b->geometric) return 0;
  if (std::min(std::abs(*a->geometric), std::abs(*b->geometric)) < kSignMargin) return 0;
  return *a->geometric * *b->geometric > 0 ? 1 : -1;
}

std::optional<std::string> WhyNotJudged(const ParallelRobot& robot, RobotKind kind,
                                        const std::vector<int>& legs) {
  for (const int leg : legs) {
    const LegChain& chain = robot.legs[static_cast<size_t>(leg)].chain;
    const SeenSegment segment = SeenSegmentOf(chain);
    const bool holds_along = chain[0].is_actuated == (segment.carrier != Carrier::kFixed);
    if (segment.direction != DirectionOf::kLeg || (kind == RobotKind::kReal && !holds_along))
      return "paths of " + ToText(chain) + " legs are not judged";
    if (robot.motion == PlatformMotion::kSpatial && chain[0].type == JointType::kRevolute &&
        segment.carrier == Carrier::kFixed)
      return std::string("a straight path leaves what RPS legs allow");
  }
  return std::nullopt;
}

const char* WhyUndecided(PieceVerdict piece) {
  return piece == PieceVerdict::kOutOfReach ? "a leg cannot reach the path there"
                                            : "the path passes a singularity there, or very near to one";
}

}  // namespace

const char* ToString(PathVerdict verdict) {
  switch (verdict) {
    case PathVerdict::kFree:
      return "free";
    case PathVerdict::kSingular:
      return "singular";
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
  const auto scaled_basis = MotionBasisInSize(robot, from, SizeOf_m(robot, from));
  double piece = kLargestPiece;
  auto last = PieceVerdict::kFree;
  while (certificate.at < 1 && piece >= kSmallestPiece) {
    const double end = std::min(certificate.at + piece, 1.0);
    const double middle = (certificate.at + end) / 2;
    last =
        JudgePiece(robot, kind, legs, scaled_basis, path.Over(RealBall(middle, (end - certificate.at) / 2)));
    if (last == PieceVerdict::kOutOfReach) break;
    if (last == PieceVerdict::kUndecided) {
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
    return certificate;
  }
  certificate.why = WhyUndecided(last);
  if (last == PieceVerdict::kOutOfReach) certificate.verdict = PathVerdict::kSingular;
  if (SignsBetween(robot, kind, legs, from, to) < 0) {
    certificate.verdict = PathVerdict::kSingular;
    certificate.why = "start and goal lie on either side of a singularity: no path avoids it";
  }
  return certificate;
}

PathCertificate CertifyPath(const ParallelRobot& robot, RobotKind kind, const std::vector<int>& legs,
                            const std::vector<Rigid3>& poses) {
  PathCertificate whole;
  whole.verdict = PathVerdict::kFree;
  const double parts = static_cast<double>(std::max<size_t>(poses.size(), 2) - 1);
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
