// The straight path between two poses of a parallel robot: the platform's origin on a line, its rotation
// about one axis, both at constant speed; s runs from 0 to 1. RPS legs, each of which keeps its platform
// joint in a plane, do not allow its poses; each is brought back to those that they do allow. With d_i the
// distances of these joints from their planes, J their rates by the twist at the start, and N = J^+,
//   t = t(s) + N_v c        R = Cayley(N_w c) R(s)        Cayley(w) = I + 4 / (4 + |w|^2) ([w]x + [w]x^2 / 2)
// where c, a number for each of these legs, is the root of d = 0 that goes on from c = 0 at the start.
// For doubles and for balls alike.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <vector>

#include "core/robots/leg_geometry.h"
#include "core/robots/parallel_robot.h"

namespace legible {

class StraightPath {
 public:
  template <typename T>
  using Vector = Eigen::Matrix<T, Eigen::Dynamic, 1>;
  template <typename T>
  using Matrix = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;
  template <typename T>
  using PlatformPose = leg_geometry::PlatformPose<T>;

  // Start and goal have to be poses that the robot's motion allows.
  StraightPath(const ParallelRobot& robot, const Rigid3& from, const Rigid3& to);

  // Of c: as many as the robot has RPS legs.
  Eigen::Index corrections() const { return correction_basis_.cols(); }

  // The straight pose at s corrected by c.
  template <typename T>
  PlatformPose<T> PoseAt(const T& s, const Vector<T>& c) const;

  // d in m and J by the twist (v, omega), at a pose.
  template <typename T>
  Vector<T> Distances_m(const PlatformPose<T>& pose) const;
  template <typename T>
  Matrix<T> SidewaysLines(const PlatformPose<T>& pose) const;

  // dd/dc at the pose with that correction, whose J is `lines`.
  template <typename T>
  Matrix<T> DistancesByCorrection(const Vector<T>& c, const Matrix<T>& lines) const;

  // The root c at s by Newton's method from a guess; nothing where that leads nowhere.
  std::optional<Eigen::VectorXd> CorrectionAt(double s, const Eigen::VectorXd& guess) const;

  // Poses at equal steps of s, ends included, two or more; nothing where RPS legs let none go on, or lead to
  // another pose than the goal (c there is not 0, to 1e-8 m).
  std::optional<std::vector<Rigid3>> Poses(int count) const;

 private:
  Eigen::Vector3d start_m_, travel_m_;
  Eigen::Matrix3d start_rotation_;
  // Unit or, of a path without rotation, zero. Of any axis near to a unit vector the path's rotations are
  // rotations up to rounding, which is what the path is then taken to be.
  Eigen::Vector3d axis_;
  double angle_rad_;
  std::vector<RobotLeg> kept_in_planes_;
  Eigen::Matrix<double, 6, Eigen::Dynamic> correction_basis_;  // N
};

template <typename T>
leg_geometry::PlatformPose<T> StraightPath::PoseAt(const T& s, const Vector<T>& c) const {
  using std::cos;
  using std::sin;
  const T turned = s * T(angle_rad_);
  const Eigen::Matrix3d along = axis_ * (axis_.transpose() * start_rotation_);
  const Eigen::Matrix3d across = Skew(axis_) * start_rotation_;
  // (cos a I + (1 - cos a) n n^T + sin a [n]x) R_from
  PlatformPose<T> pose{start_m_.cast<T>() + s * travel_m_.cast<T>(),
                       cos(turned) * (start_rotation_.cast<T>() - along.cast<T>()) + along.cast<T>() +
                           sin(turned) * across.cast<T>()};
  if (c.size() == 0) return pose;
  const Eigen::Matrix<T, 6, 1> correction = correction_basis_.cast<T>() * c;
  const Eigen::Matrix<T, 3, 1> w = correction.template tail<3>();
  const Eigen::Matrix<T, 3, 3> skew = -leg_geometry::MinusSkew<T>(w);
  const T scale = T(4) / (T(4) + w.dot(w));
  const Eigen::Matrix<T, 3, 3> turn = scale * (skew + T(0.5) * (skew * skew));
  const Eigen::Matrix<T, 3, 3> turned_further = turn * pose.rotation;
  pose.translation_m += correction.template head<3>();
  pose.rotation += turned_further;
  return pose;
}

template <typename T>
StraightPath::Vector<T> StraightPath::Distances_m(const PlatformPose<T>& pose) const {
  Vector<T> distances_m(corrections());
  for (Eigen::Index i = 0; i < corrections(); ++i) {
    const RobotLeg& leg = kept_in_planes_[static_cast<size_t>(i)];
    const Eigen::Matrix<T, 3, 1> from_a =
        pose.translation_m + pose.rotation * leg.platform_joint_m.cast<T>() - leg.base_joint_m.cast<T>();
    distances_m[i] = leg.first_axis.cast<T>().dot(from_a);
  }
  return distances_m;
}

template <typename T>
StraightPath::Matrix<T> StraightPath::SidewaysLines(const PlatformPose<T>& pose) const {
  Matrix<T> lines(corrections(), 6);
  for (Eigen::Index i = 0; i < corrections(); ++i) {
    const RobotLeg& leg = kept_in_planes_[static_cast<size_t>(i)];
    lines.row(i) = leg_geometry::SidewaysLine<T>(leg, pose.rotation * leg.platform_joint_m.cast<T>());
  }
  return lines;
}

template <typename T>
StraightPath::Matrix<T> StraightPath::DistancesByCorrection(const Vector<T>& c,
                                                            const Matrix<T>& lines) const {
  const Eigen::Matrix<T, 6, Eigen::Dynamic> basis = correction_basis_.cast<T>();
  const Eigen::Matrix<T, 3, 1> w = basis.template bottomRows<3>() * c;
  // Of Cayley(w), omega = 4 / (4 + |w|^2) (dw + w x dw / 2).
  Eigen::Matrix<T, 3, 3> rate = T(-0.5) * leg_geometry::MinusSkew<T>(w);
  for (int k = 0; k < 3; ++k) rate(k, k) += T(1);
  rate *= T(4) / (T(4) + w.dot(w));
  Eigen::Matrix<T, 6, Eigen::Dynamic> twists = basis;
  twists.template bottomRows<3>() = rate * basis.template bottomRows<3>();
  return lines * twists;
}

}  // namespace legible
