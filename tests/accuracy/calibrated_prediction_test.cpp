// Whether what a calibrated model says of its own accuracy is true: calibrate synthetic sessions, drive to
// fresh poses by joint readings, and count how often the true pose lies in the region reported.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <iostream>
#include <thread>

#include "accuracy/pose_accuracy.h"
#include "calib/calibrated_model.h"
#include "calib/leg_calibration.h"
#include "datasets/synthetic_session.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

constexpr int kCalibrations = 200;
constexpr int kPosesEach = 20;
constexpr double kReadingBound_m = 2e-5;  // uniform within it

// The true robot in the frames that the drawing defines, as a calibrated model's are (docs/conventions.md,
// gauges).
GoughStewart InDrawnFrames(GoughStewart truth, const GoughStewart& drawing) {
  for (const auto joint : {&Leg::base_joint_m, &Leg::platform_joint_m}) {
    std::vector<Eigen::Vector3d> true_joints(kLegCount), drawn_joints(kLegCount);
    for (size_t i = 0; i < kLegCount; ++i) {
      true_joints[i] = truth.legs[i].*joint;
      drawn_joints[i] = drawing.legs[i].*joint;
    }
    const Rigid3 drawn_from_true = FitRigid(true_joints, drawn_joints);
    for (Leg& leg : truth.legs) leg.*joint = drawn_from_true * (leg.*joint);
  }
  return truth;
}

struct Counts {
  int poses = 0, inside = 0;
  std::vector<double> squared_errors;  // e^T C^-1 e
};

// One calibration, and poses that it has not seen.
Counts Predict(std::uint64_t seed) {
  SyntheticOptions options;
  options.image_count = 16;
  options.seed = seed;
  options.joint_reading_sigma_m = kReadingBound_m / std::sqrt(3.0);
  const SyntheticSession session = GenerateSession(options);
  LegCalibrationInput input{session.nominal_robot,
                            session.nominal_camera,
                            session.nominal_camera_from_base,
                            DrawObservations(session, options, seed),
                            {},
                            {}};
  input.known.joint_reading_m = options.joint_reading_sigma_m;
  LegCalibrationOptions calibration_options;
  calibration_options.threads = 1;
  const LegCalibration found = CalibrateLegs(input, calibration_options);
  Counts counts;
  if (found.status != CalibrationStatus::kConverged) return counts;
  const CalibratedModel model = ToModel(found);
  const JudgedRobot robot{model.robot, model.camera, model.camera_from_base,
                          GeometryCovariance(model.parameter_names, model.covariance)};
  PoseAccuracyOptions accuracy_options;
  accuracy_options.joint_error_bounds = Vector6d::Constant(kReadingBound_m);

  const GoughStewart truth = InDrawnFrames(session.true_robot, session.nominal_robot);
  std::mt19937_64 generator(seed);
  for (int i = 0; i < kPosesEach; ++i) {
    Vector6d place;
    place << UniformVector(generator, -0.05, 0.05), UniformVector(generator, -0.15, 0.15);
    const Rigid3 true_pose = Displaced(truth.home, place);
    Vector6d reading_errors_m;
    reading_errors_m << UniformVector(generator, -kReadingBound_m, kReadingBound_m),
        UniformVector(generator, -kReadingBound_m, kReadingBound_m);
    const auto driven =
        ForwardKinematics(model.robot, InverseKinematics(truth, true_pose) + reading_errors_m, true_pose);
    const Vector6d error = Displacement(driven.base_from_platform, true_pose);
    const PoseAccuracy accuracy = AccuracyAt(robot, driven.base_from_platform, accuracy_options);
    const double squared = error.dot(accuracy.together->covariance.ldlt().solve(error));
    counts.squared_errors.push_back(squared);
    counts.inside += squared <= kChiSquared95Of6;
    ++counts.poses;
  }
  return counts;
}

TEST(CalibratedPrediction, TruePosesLieInTheReported95PercentRegionsAsOftenAsTheySay) {
  std::vector<Counts> all(kCalibrations);
  std::atomic<int> next = 0;
  const auto work = [&] {
    for (int i = next++; i < kCalibrations; i = next++)
      all[static_cast<size_t>(i)] = Predict(static_cast<std::uint64_t>(i + 1));
  };
  std::thread other(work);
  work();
  other.join();
  double poses = 0, inside = 0, mean = 0;
  for (const Counts& counts : all) {
    EXPECT_EQ(counts.poses, kPosesEach);
    poses += counts.poses;
    inside += counts.inside;
    for (const double squared : counts.squared_errors) mean += squared;
  }
  std::cout << "inside the 95 % region: " << 100 * inside / poses << " % of " << poses
            << " poses; squared error in its covariance: mean " << mean / poses << " of 6" << std::endl;
  EXPECT_GE(inside / poses, 0.92);
  EXPECT_LE(inside / poses, 0.98);
}

}  // namespace
}  // namespace legible
