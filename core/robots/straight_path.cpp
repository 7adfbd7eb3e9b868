#include "core/robots/straight_path.h"

#include <Eigen/Dense>
#include <algorithm>
#include <limits>

#include "core/robots/platform_motion.h"

namespace legible {
namespace {

constexpr double kOnPlane_m = 1e-12;
constexpr double kAtGoal_m = 1e-8;  // of c there
constexpr int kMostNewtonSteps = 20;
// Of the path, from root to root at least so many, lest Newton's method takes another root for the next.
constexpr int kLeastSteps = 64;

}  // namespace

StraightPath::StraightPath(const ParallelRobot& robot, const Rigid3& from, const Rigid3& to)
    : start_m_(from.translation),
      travel_m_(to.translation - from.translation),
      start_rotation_(from.rotation.toRotationMatrix()) {
  const Eigen::Vector3d turn_rad = VectorFromRotation(to.rotation * from.rotation.conjugate());
  angle_rad_ = turn_rad.norm();
  axis_ = angle_rad_ > 0 ? Eigen::Vector3d(turn_rad / angle_rad_) : Eigen::Vector3d::Zero();
  for (const RobotLeg* leg : LegsKeptInPlanes(robot)) kept_in_planes_.push_back(*leg);
  correction_basis_.resize(6, static_cast<Eigen::Index>(kept_in_planes_.size()));
  if (corrections() == 0) return;
  const PlatformPose<double> start{start_m_, start_rotation_};
  correction_basis_ = SidewaysLines(start).completeOrthogonalDecomposition().pseudoInverse();
}

std::optional<Eigen::VectorXd> StraightPath::CorrectionAt(double s, const Eigen::VectorXd& guess) const {
  Eigen::VectorXd c = guess;
  double last_step = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMostNewtonSteps && corrections() > 0; ++i) {
    const auto pose = PoseAt<double>(s, c);
    const Eigen::VectorXd step =
        DistancesByCorrection<double>(c, SidewaysLines(pose)).partialPivLu().solve(Distances_m(pose));
    const double length = step.lpNorm<Eigen::Infinity>();
    if (!(length < last_step)) break;
    c -= step;
    last_step = length;
  }
  const Eigen::VectorXd left_m = Distances_m(PoseAt<double>(s, c));
  if (!(left_m.lpNorm<Eigen::Infinity>() < kOnPlane_m)) return std::nullopt;
  return c;
}

std::optional<std::vector<Rigid3>> StraightPath::Poses(int count) const {
  const int steps_per_pose = (kLeastSteps - 1) / (count - 1) + 1;
  const int steps = steps_per_pose * (count - 1);
  std::vector<Rigid3> poses;
  std::optional<Eigen::VectorXd> c = Eigen::VectorXd::Zero(corrections());
  for (int i = 0; i <= steps; ++i) {
    const double s = static_cast<double>(i) / steps;
    c = CorrectionAt(s, *c);
    if (!c) return std::nullopt;
    if (i % steps_per_pose != 0) continue;
    const auto pose = PoseAt<double>(s, *c);
    poses.push_back({Eigen::Quaterniond(pose.rotation).normalized(), pose.translation_m});
  }
  if (c->lpNorm<Eigen::Infinity>() > kAtGoal_m) return std::nullopt;
  return poses;
}

}  // namespace legible
