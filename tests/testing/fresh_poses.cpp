#include "tests/testing/fresh_poses.h"

#include <cmath>
#include <stdexcept>
#include <vector>

#include "tests/testing/random.h"

namespace legible {
namespace {

std::vector<Eigen::Vector3d> JointsOf(const GoughStewart& robot, Eigen::Vector3d Leg::*joint) {
  std::vector<Eigen::Vector3d> joints;
  for (const Leg& leg : robot.legs) joints.push_back(leg.*joint);
  return joints;
}

bool InRange(const GoughStewart& drawing, const Vector6d& lengths_m) {
  for (size_t i = 0; i < kLegCount; ++i) {
    const auto [shortest_m, longest_m] = drawing.legs[i].joint_range_m;
    const double length_m = lengths_m[static_cast<Eigen::Index>(i)];
    if (length_m < shortest_m || length_m > longest_m) return false;
  }
  return true;
}

Rigid3 DrawPose(const Rigid3& home, const FreshPoseOptions& options, std::mt19937_64& generator) {
  std::normal_distribution<double> normal(0, options.tilt_rad);
  const Eigen::Vector3d turn(normal(generator), normal(generator), normal(generator));
  return {RotationFromVector(turn) * home.rotation,
          {Uniform(generator, -options.shift_m, options.shift_m),
           Uniform(generator, -options.shift_m, options.shift_m),
           Uniform(generator, options.least_height_m, options.largest_height_m)}};
}

}  // namespace

GoughStewart LaidOnto(const GoughStewart& truth, GoughStewart model) {
  for (const auto joint : {&Leg::base_joint_m, &Leg::platform_joint_m}) {
    const Rigid3 truth_from_model = FitRigid(JointsOf(model, joint), JointsOf(truth, joint));
    for (Leg& leg : model.legs) leg.*joint = truth_from_model * (leg.*joint);
  }
  return model;
}

PoseError ErrorInFreshPoses(const GoughStewart& truth, const GoughStewart& model, const GoughStewart& drawing,
                            const FreshPoseOptions& options, std::mt19937_64& generator) {
  std::normal_distribution<double> normal(0, options.reading_sigma_m);
  double position_squares = 0, rotation_squares = 0;
  for (int done = 0; done < options.poses;) {
    const Rigid3 pose = DrawPose(drawing.home, options, generator);
    Vector6d readings_m = InverseKinematics(truth, pose);
    Vector6d lengths_m = readings_m;
    for (size_t i = 0; i < kLegCount; ++i) {
      lengths_m[static_cast<Eigen::Index>(i)] += truth.legs[i].joint_offset_m;
      readings_m[static_cast<Eigen::Index>(i)] += normal(generator);
    }
    if (!InRange(drawing, lengths_m)) continue;
    const auto found = ForwardKinematics(model, readings_m, pose);
    if (found.status != ForwardKinematicsStatus::kConverged)
      throw std::runtime_error("forward kinematics does not converge in a fresh pose");
    const Rigid3& predicted = found.base_from_platform;
    position_squares += (predicted.translation - pose.translation).squaredNorm();
    rotation_squares += std::pow(predicted.rotation.angularDistance(pose.rotation), 2);
    ++done;
  }
  return {std::sqrt(position_squares / options.poses), std::sqrt(rotation_squares / options.poses)};
}

}  // namespace legible
