#include "core/robots/gough_stewart_assembly_modes.h"

#include <array>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/algebra/quadric_system.h"
#include "core/algebra/root_certificate.h"
#include "core/robots/assembly_mode_start.h"
#include "core/robots/study_quadrics.h"

namespace legible {
namespace {

using Point = PathTracker<8>::Point;
using BallMatrix8 = Eigen::Matrix<RealBall, 8, 8>;
using BallQuadrics = std::array<BallMatrix8, 7>;

constexpr double kTolerance = 1e-4;
constexpr double kTightTolerance = 1e-6;
constexpr double kAtInfinity = 1e-5;  // 1e-8 and less is usual there, 1e-3 and more for a multiple root

// Frames at the middle of the joints, parallel to those of base and platform, and a unit of length: in them
// the quadrics of robots of all sizes and places are alike.
struct MiddleFrames {
  Eigen::Vector3d base_m = Eigen::Vector3d::Zero(), platform_m = Eigen::Vector3d::Zero();
  double unit_m = 0;
};

MiddleFrames MiddleFramesOf(const GoughStewart& robot, const Vector6d& joint_readings_m) {
  MiddleFrames frames;
  for (const Leg& leg : robot.legs) {
    frames.base_m += leg.base_joint_m / kLegCount;
    frames.platform_m += leg.platform_joint_m / kLegCount;
  }
  double sum_m2 = joint_readings_m.squaredNorm();
  for (const Leg& leg : robot.legs)
    sum_m2 += (leg.base_joint_m - frames.base_m).squaredNorm() +
              (leg.platform_joint_m - frames.platform_m).squaredNorm();
  frames.unit_m = std::sqrt(sum_m2 / kLegCount);
  return frames;
}

// In balls, for they have to hold what the robot's numbers make of them exactly.
BallQuadrics QuadricsOf(const GoughStewart& robot, const Vector6d& joint_readings_m,
                        const MiddleFrames& frames) {
  using Vector = Eigen::Matrix<RealBall, 3, 1>;
  const RealBall unit_m(frames.unit_m);
  const auto scaled = [&](const Eigen::Vector3d& x_m, const Eigen::Vector3d& middle_m) {
    return Vector((x_m.cast<RealBall>() - middle_m.cast<RealBall>()) / unit_m);
  };
  std::array<MotionCondition<RealBall>, kLegCount> conditions;
  for (size_t i = 0; i < kLegCount; ++i) {
    const Leg& leg = robot.legs[i];
    const RealBall length_m =
        RealBall(joint_readings_m[static_cast<Eigen::Index>(i)]) + RealBall(leg.joint_offset_m);
    conditions[i] =
        LegCondition<RealBall>(scaled(leg.base_joint_m, frames.base_m),
                               scaled(leg.platform_joint_m, frames.platform_m), length_m / unit_m);
  }
  return MotionQuadrics(conditions);
}

HomogeneousQuadrics<8> MidpointsOf(const BallQuadrics& quadrics) {
  HomogeneousQuadrics<8> midpoints;
  for (size_t k = 0; k < quadrics.size(); ++k)
    midpoints[k] = quadrics[k].unaryExpr([](const RealBall& ball) { return MidpointOf(ball); });
  return midpoints;
}

// Where each path ends; paths of which two have the same end are followed again, closer.
std::vector<PathEnd<8>> EndsOfPaths(const AssemblyModeStart& start, const HomogeneousQuadrics<8>& quadrics) {
  const PathTracker<8> tracker(start.quadrics, quadrics);
  std::vector<PathEnd<8>> ends;
  for (const Point& solution : start.solutions) ends.push_back(tracker.Track(solution, kTolerance));
  std::vector<bool> is_shared(ends.size());
  for (size_t i = 0; i < ends.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      if (std::abs(ends[i].point.dot(ends[j].point)) > 1 - 1e-12) is_shared[i] = is_shared[j] = true;
  for (size_t i = 0; i < ends.size(); ++i)
    if (is_shared[i]) ends[i] = tracker.Track(start.solutions[i], kTightTolerance);
  return ends;
}

// |x.x| of a point of length 1, which vanishes with 1 / |t|^2 where the platform leaves for infinity.
bool IsLeaving(const PathEnd<8>& end) {
  const auto x = end.point.head<4>();
  return end.s < 1 && std::abs(x.cwiseProduct(x).sum()) < kAtInfinity;
}

// Eight coordinates with v = Chart() (1, z): a reflection that lets no motion of practice be far off in z. It
// is invertible, which is all that is asked of its doubles.
Eigen::Matrix<double, 8, 8> Chart() {
  Eigen::Matrix<double, 8, 1> axis;
  axis << -0.6, 0.37, 0.43, 0.29, 0.23, 0.19, 0.31, 0.25;
  axis.normalize();
  return Eigen::Matrix<double, 8, 8>::Identity() - 2 * axis * axis.transpose();
}

QuadricSystem InChart(const BallQuadrics& quadrics, const Eigen::Matrix<double, 8, 8>& chart) {
  const BallMatrix8 v_from_z = chart.cast<RealBall>();
  std::vector<ComplexBallMatrix> matrices;
  for (const BallMatrix8& quadric : quadrics) {
    const BallMatrix8 half = quadric.lazyProduct(v_from_z);
    matrices.push_back(BallMatrix8(v_from_z.transpose().lazyProduct(half)).cast<ComplexBall>());
  }
  return QuadricSystem(std::move(matrices));
}

// The pose in the robot's own frames.
GoughStewartAssemblyMode ModeAt(const Eigen::Matrix<double, 8, 1>& study, const MiddleFrames& frames,
                                const GoughStewart& robot, const Vector6d& joint_readings_m) {
  Rigid3 pose = MotionOf(study);
  pose.translation = frames.unit_m * pose.translation + frames.base_m - pose.rotation * frames.platform_m;
  return {pose, (InverseKinematics(robot, pose) - joint_readings_m).cwiseAbs().maxCoeff()};
}

void Check(const GoughStewart& robot, const Vector6d& joint_readings_m) {
  for (size_t i = 0; i < kLegCount; ++i) {
    const Leg& leg = robot.legs[i];
    const double length_m = joint_readings_m[static_cast<Eigen::Index>(i)] + leg.joint_offset_m;
    if (!leg.base_joint_m.allFinite() || !leg.platform_joint_m.allFinite() || !std::isfinite(length_m) ||
        !(length_m > 0))
      throw std::invalid_argument("AllAssemblyModes: leg " + std::to_string(i + 1) +
                                  " needs joints that are finite and a length above 0");
  }
}

}  // namespace

GoughStewartAssemblyModes AllAssemblyModes(const GoughStewart& robot, const Vector6d& joint_readings_m) {
  static const AssemblyModeStart start = MakeAssemblyModeStart(1);
  return AllAssemblyModes(robot, joint_readings_m, start);
}

GoughStewartAssemblyModes AllAssemblyModes(const GoughStewart& robot, const Vector6d& joint_readings_m,
                                           const AssemblyModeStart& start) {
  static const Eigen::Matrix<double, 8, 8> chart = Chart();
  Check(robot, joint_readings_m);
  const MiddleFrames frames = MiddleFramesOf(robot, joint_readings_m);
  const BallQuadrics quadrics = QuadricsOf(robot, joint_readings_m, frames);
  GoughStewartAssemblyModes result;
  std::vector<Eigen::VectorXcd> approximations;
  for (const PathEnd<8>& end : EndsOfPaths(start, MidpointsOf(quadrics))) {
    if (IsLeaving(end)) {
      ++result.at_infinity;
      continue;
    }
    const Point w = chart.transpose() * end.point;
    approximations.emplace_back(w.tail<7>() / w[0]);
  }
  const std::vector<CertifiedRoot> roots = CertifyRoots(InChart(quadrics, chart), approximations).roots;
  for (const CertifiedRoot& root : roots) {
    if (!root.is_real) continue;
    Eigen::Matrix<double, 8, 1> w;
    w << 1, root.midpoint.real();
    result.modes.push_back(ModeAt(chart * w, frames, robot, joint_readings_m));
  }
  result.certified = static_cast<int>(roots.size());
  result.uncertified = kGoughStewartRootCount - result.certified - result.at_infinity;
  result.is_complete = result.certified == kGoughStewartRootCount;
  return result;
}

}  // namespace legible
