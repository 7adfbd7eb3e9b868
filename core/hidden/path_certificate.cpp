#include "core/hidden/path_certificate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "core/algebra/ball.h"
#include "core/algebra/ball_jet.h"
#include "core/hidden/path_enclosure.h"
#include "core/hidden/singularity_geometry.h"
#include "core/robots/leg_geometry.h"
#include "core/robots/platform_motion.h"
#include "core/robots/straight_path.h"

namespace legible {
namespace {

// Of the path; a smaller piece is left undecided, and so is what is not proved in so many trials.
constexpr double kSmallestPiece = 1e-7;
constexpr double kLargestPiece = 1.0 / 8;
constexpr int kMostTrials = 1000;
// Row sums stay below 1 by it, and pieces are made so long that they come to kAim.
constexpr double kMargin = 1e-9, kAim = 0.7;
constexpr int kWeightSteps = 5;
constexpr double kLeastWeight = 1e-3;
constexpr int kReachSamples = 64;
// Bound of what is not known.
constexpr double kNothingKnown = std::numeric_limits<double>::infinity();

// What is asked along the path.
struct Question {
  const ParallelRobot& robot;
  RobotKind kind;
  const std::vector<int>& legs;
  double size_m;

  const RobotLeg& leg(size_t k) const { return robot.legs[static_cast<size_t>(legs[k])]; }
};

template <typename T>
using MatrixOf = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;

// What the legs hold at a pose, by the platform's twist with lengths in the robot's size; nothing where one
// may not reach it.
template <typename T>
std::optional<MatrixOf<T>> HeldAt(const Question& question, const StraightPath& path,
                                  const leg_geometry::PlatformPose<T>& pose) {
  const Eigen::Index rows_per_leg = question.kind == RobotKind::kReal ? 1 : 3;
  const Eigen::Index of_legs = rows_per_leg * static_cast<Eigen::Index>(question.legs.size());
  MatrixOf<T> held(of_legs + path.corrections(), 6);
  for (size_t k = 0; k < question.legs.size(); ++k) {
    const auto placed = leg_geometry::Placed<T>(question.leg(k), pose);
    if (!(placed.reached.reach > T(0))) return std::nullopt;
    const Eigen::Index at = rows_per_leg * static_cast<Eigen::Index>(k);
    if (question.kind == RobotKind::kReal)
      held.row(at) = leg_geometry::HeldByJoint<T>(question.leg(k), placed).line;
    else
      held.template middleRows<3>(at) = leg_geometry::DirectionRate<T>(question.leg(k), placed);
  }
  held.bottomRows(path.corrections()) = path.SidewaysLines(pose) / T(question.size_m);
  held.template leftCols<3>() *= T(question.size_m);
  return MatrixOf<T>(held(Eigen::all, FreeCoordinates(question.robot.motion)));
}

// M on a piece: what is held at its middle, and its rates all over it by s, which is `half_length` from
// there.
struct HeldOnPiece {
  RealBallMatrix middle, rates;
  double half_length = 0;
};

std::optional<HeldOnPiece> HeldOn(const Question& question, const StraightPath& path,
                                  const PathPiece& piece) {
  const auto all = HeldAt<RealBallJet>(question, path, piece.pose);
  const auto middle = HeldAt<RealBall>(question, path, piece.middle_pose);
  if (!all || !middle) return std::nullopt;
  return HeldOnPiece{*middle, all->unaryExpr([](const RealBallJet& jet) { return jet.rate(); }),
                     piece.half_length};
}

// The least row sum norm found of a matrix whose elements have these moduli, by weights: near to Perron's
// vector it is near to the spectral radius, the least that any weights give. Infinite where that overflows.
double WeightedNorm(const Eigen::MatrixXd& moduli) {
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(moduli.cols());
  for (int i = 0; i < kWeightSteps; ++i) {
    weights = (moduli * weights).eval();
    weights.array() += kLeastWeight * weights.maxCoeff() + std::numeric_limits<double>::min();
    weights /= weights.maxCoeff();
  }
  const Eigen::VectorXd row_sums = (moduli * weights).cwiseQuotient(weights);
  return row_sums.allFinite() ? row_sums.maxCoeff() : kNothingKnown;
}

// A bound of |I - S^-1 U^T M V| for every M on the piece, with U S V^T the middle's singular value
// decomposition: where it is below 1 every M has full rank. By the mean value theorem every element of
// S^-1 U^T M V is within half the length times its rate of that at the middle. Infinite where nothing is
// known.
double OffFullRank(const HeldOnPiece& held) {
  const Eigen::MatrixXd middle = held.middle.unaryExpr([](const RealBall& x) { return MidpointOf(x); });
  const Eigen::Index n = middle.cols();
  if (!middle.allFinite() || middle.rows() < n) return kNothingKnown;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(middle, Eigen::ComputeThinU | Eigen::ComputeThinV);
  if (!(svd.singularValues()[n - 1] > 0)) return kNothingKnown;
  const Eigen::MatrixXd inverse =
      svd.singularValues().cwiseInverse().asDiagonal() * svd.matrixU().transpose();
  const RealBallMatrix left = inverse.cast<RealBall>(), right = svd.matrixV().cast<RealBall>();
  const RealBallMatrix at_middle = left * held.middle * right - RealBallMatrix::Identity(n, n);
  const RealBallMatrix rates = left * held.rates * right;
  const RealBallMatrix off = at_middle + rates * RealBall(0, held.half_length);
  const Eigen::MatrixXd moduli = off.unaryExpr([](const RealBall& x) { return LargestModulus(x); });
  return moduli.allFinite() ? WeightedNorm(moduli) : kNothingKnown;
}

// Whether the signed condition is proved to have one sign at the one end and the other at the other.
bool SignsDiffer(const Question& question, const StraightPath& path) {
  const auto sign_at = [&](double s) {
    const auto correction = CorrectionAtEnd(path, s);
    if (!correction) return 0;
    const auto condition = singularity_geometry::SignedCondition<RealBall>(
        question.robot, question.kind, question.legs, path.PoseAt<RealBall>(s, *correction), question.size_m);
    if (!condition) return 0;
    return LowerBound(*condition) > 0 ? 1 : UpperBound(*condition) < 0 ? -1 : 0;
  };
  return sign_at(0) * sign_at(1) < 0;
}

bool IsOutOfReach(const Question& question, const PoseBalls& pose) {
  for (size_t k = 0; k < question.legs.size(); ++k)
    if (UpperBound(leg_geometry::Placed<RealBall>(question.leg(k), pose).reached.reach) < 0) return true;
  return false;
}

// Whether a leg is proved not to reach some pose of the path beyond s: of a path that RPS legs correct, which
// is known up to there only, its goal.
bool LeavesReach(const Question& question, const StraightPath& path, double s) {
  const auto at_goal = CorrectionAtEnd(path, 1);
  if (!at_goal) return false;
  for (int i = path.corrections() > 0 ? kReachSamples : 1; i <= kReachSamples; ++i)
    if (IsOutOfReach(question, path.PoseAt<RealBall>(s + (1 - s) * i / kReachSamples, *at_goal))) return true;
  return false;
}

Rigid3 MiddleOf(const PoseBalls& pose) {
  const auto middle = [](const RealBall& x) { return MidpointOf(x); };
  const Eigen::Matrix3d rotation = pose.rotation.unaryExpr(middle);
  return {Eigen::Quaterniond(rotation).normalized(), pose.translation_m.unaryExpr(middle)};
}

// How far a path is proved free, and what stopped the proof.
struct Progress {
  double at = 0;
  int pieces = 0;
  RealBallVector correction;  // there
  bool is_lost = false;       // the next piece is no path that RPS legs are proved to allow

  bool EndsElsewhere() const { return at >= 1 && !IsAtEnd(correction); }
};

// By which the next piece, or the next trial, is longer than one that was `off` full rank.
double NextLength(double off, bool is_proved) {
  const double factor = kAim / off;
  return is_proved ? std::clamp(factor, 0.5, 2.0) : std::clamp(factor, 0.1, 0.5);
}

Progress ProveAlong(const Question& question, const StraightPath& path, const RealBallVector& start) {
  Progress progress{0, 0, start};
  double length = kLargestPiece;
  for (int trial = 0; trial < kMostTrials && progress.at < 1 && length >= kSmallestPiece; ++trial) {
    const double end = std::min(progress.at + length, 1.0);
    const auto piece = EnclosePiece(path, progress.at, progress.correction, end);
    const auto held = piece ? HeldOn(question, path, *piece) : std::nullopt;
    progress.is_lost = !piece;
    const double off = held ? OffFullRank(*held) : kNothingKnown;
    const bool is_proved = off < 1 - kMargin;
    length = std::min(length * NextLength(off, is_proved), kLargestPiece);
    if (!is_proved) continue;
    ++progress.pieces;
    progress.at = end;
    progress.correction = piece->end_correction;
  }
  return progress;
}

// Of a path that is not free all along.
void SayWhyNotFree(const Question& question, const StraightPath& path, const Progress& progress,
                   PathCertificate& certificate) {
  if (SignsDiffer(question, path)) {
    certificate.verdict = PathVerdict::kSingular;
    certificate.why = "start and goal lie on either side of a singularity: no path avoids it";
  } else if (LeavesReach(question, path, progress.at)) {
    certificate.verdict = PathVerdict::kOutOfReach;
    certificate.why = "a leg cannot reach the straight path beyond there";
  } else if (progress.EndsElsewhere()) {
    certificate.why =
        "the straight path, brought back to what RPS legs allow, leads to another pose than the goal";
  } else if (progress.is_lost) {
    certificate.why = "the straight path is not proved to go on there within what RPS legs allow";
  } else {
    certificate.why = "the path passes a singularity there, or very near to one";
  }
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
  const StraightPath path(robot, from, to);
  const auto start = CorrectionAtEnd(path, 0);
  if (!start || !CorrectionAtEnd(path, 1)) {
    certificate.why = "start or goal is not proved to be a pose that RPS legs allow";
    return certificate;
  }
  const Question question{robot, kind, legs, SizeOf_m(robot, from)};
  const Progress progress = ProveAlong(question, path, *start);
  certificate.at = progress.at;
  certificate.pieces = progress.pieces;
  certificate.pose = MiddleOf(path.PoseAt<RealBall>(progress.at, progress.correction));
  if (progress.at >= 1 && !progress.EndsElsewhere())
    certificate.verdict = PathVerdict::kFree;
  else
    SayWhyNotFree(question, path, progress, certificate);
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
