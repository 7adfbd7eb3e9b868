// Andreff, Dallej and Martinet 2007, section 4.2: what both laws do without noise and with a perfect model.
#include <gtest/gtest.h>

#include <cmath>

#include "servo/path_shape.h"
#include "tests/testing/delta_lab.h"

namespace legible {
namespace {

constexpr double kGain_per_s = 1, kFrom_s = 1, kUntil_s = 8;

struct Law {
  ControlMode mode;
  double LabMoment::*controlled;
  double LabMoment::*uncontrolled;
};
const Law kEdgeLaw{ControlMode::kEdges, &LabMoment::edge_error_px, &LabMoment::direction_error_rad};
const Law kDirectionLaw{ControlMode::kDirections, &LabMoment::direction_error_rad, &LabMoment::edge_error_px};

LabRun RunOf(const Law& law) { return RunInLab(PerfectServo(law.mode, kUntil_s)); }

double DeviationShare(const Law& law) {
  const LabServo servo = PerfectServo(law.mode, kUntil_s);
  std::vector<Eigen::Vector3d> places_m;
  for (const LabMoment& moment : RunInLab(servo).moments)
    places_m.push_back(moment.true_base_from_platform.translation);
  const PathShape shape = ShapeOfPath(places_m, servo.true_goal.translation);
  return shape.deviation_m / shape.length_m;
}

TEST(PaperSection4, ControlledErrorsFallExponentiallyAtTheGain) {
  for (const Law& law : {kEdgeLaw, kDirectionLaw}) {
    SCOPED_TRACE(ToString(law.mode));
    const Decay decay = FitDecay(RunOf(law), law.controlled, kFrom_s, kUntil_s);
    EXPECT_NEAR(decay.rate_per_s, kGain_per_s, 0.05 * kGain_per_s);
    EXPECT_LT(decay.rms_log, 0.02);
  }
}

TEST(PaperSection4, UncontrolledErrorsFallExponentiallyTooAtASlightlyDifferentRate) {
  for (const Law& law : {kEdgeLaw, kDirectionLaw}) {
    SCOPED_TRACE(ToString(law.mode));
    const Decay decay = FitDecay(RunOf(law), law.uncontrolled, kFrom_s, kUntil_s);
    EXPECT_NEAR(decay.rate_per_s, kGain_per_s, 0.1 * kGain_per_s);
    EXPECT_LT(decay.rms_log, 0.05);
  }
}

TEST(PaperSection4, ThePlatformStaysInTheSymmetryPlane) {
  for (const Law& law : {kEdgeLaw, kDirectionLaw})
    for (const LabMoment& moment : RunOf(law).moments) {
      ASSERT_NEAR(moment.true_base_from_platform.translation.y(), 0, 1e-9) << ToString(law.mode);
      const Eigen::Vector3d turn = VectorFromRotation(moment.true_base_from_platform.rotation);
      ASSERT_NEAR(std::hypot(turn.x(), turn.z()), 0, 1e-8) << ToString(law.mode);
    }
}

TEST(PaperSection4, ThePathIsNearlyStraightUnderDirectionsAndBentUnderEdges) {
  EXPECT_LT(DeviationShare(kDirectionLaw), 0.02);
  EXPECT_GT(DeviationShare(kEdgeLaw), 0.04);
}

TEST(PaperSection4, BothLawsArriveAtTheGoal) {
  for (const Law& law : {kEdgeLaw, kDirectionLaw}) {
    const LabServo servo = PerfectServo(law.mode, 20);
    const Vector6d left = Displacement(RunInLab(servo).true_end, servo.true_goal);
    EXPECT_LT(left.norm(), 1e-8) << ToString(law.mode);
  }
}

}  // namespace
}  // namespace legible
