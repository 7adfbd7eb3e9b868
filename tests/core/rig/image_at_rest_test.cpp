#include "core/rig/image_at_rest.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/rig/desktop_rig.h"

namespace legible {
namespace {

using testing::HasSubstr;

// Two pixels: the frame's number, and how many legs are covered.
GrayImage NumberedPicture(const Rigid3&, const std::vector<int>& covered_legs, std::uint64_t frame) {
  return {2, 1, {static_cast<std::uint8_t>(frame % 256), static_cast<std::uint8_t>(covered_legs.size())}};
}

struct Taken {
  ImageAtRest image;
  double largest_speed_m_per_s = 0;  // when it was taken
  double duration_s = 0;
  Vector6d true_readings_m;
};

// After half a second of motion, which is stopped at once.
Taken TakeAfterMotion(const SimulationOptions& simulation, const RestOptions& options) {
  SimulatedRig rig(DesktopTruth(), simulation, NumberedPicture);
  CommandUntil(rig, Rising(0.04), 0.5);
  rig.Stop();
  Taken taken;
  taken.image = TakeImageAtRest(rig, options);
  taken.largest_speed_m_per_s = rig.true_motion().joint_speeds_m_per_s.cwiseAbs().maxCoeff();
  taken.duration_s = rig.true_time_s() - 0.5;
  taken.true_readings_m = rig.true_motion().joint_readings_m;
  return taken;
}

TEST(ImageAtRest, IsOfAnUnmovedRobotWithTheReadingsOfItsMoment) {
  SimulationOptions simulation;
  simulation.drives.lag_s = 0.1;
  const Taken taken = TakeAfterMotion(simulation, {});
  EXPECT_EQ(taken.image.missing, "");
  // Three sigmas of the difference of two means of five readings, in the tenth of a second between these:
  // within an exposure of 10 ms not a thousandth of a pixel.
  EXPECT_LT(taken.largest_speed_m_per_s, 2e-5);
  EXPECT_GT(taken.duration_s, 0.5);
  EXPECT_LT(taken.duration_s, 2);
  EXPECT_NEAR(taken.image.image.time_s, taken.image.readings.time_s, 1e-9);
  EXPECT_LT((taken.image.readings.joint_readings_m - taken.true_readings_m).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(ImageAtRest, ComesInSpiteOfTheNoiseOfTheReadings) {
  SimulationOptions simulation;
  simulation.drives.reading_noise_m = 5e-5;
  RestOptions options;
  options.reading_sigma_m = 5e-5;
  const Taken taken = TakeAfterMotion(simulation, options);
  EXPECT_EQ(taken.image.missing, "");
  EXPECT_LT(taken.duration_s, 1);
}

TEST(ImageAtRest, IsNotTakenWhileAJointMovesAndNamesIt) {
  SimulationOptions simulation;
  SimulatedRig rig(DesktopTruth(), simulation, NumberedPicture);
  Vector6d creep = Vector6d::Zero();
  creep[3] = 2e-4;
  RestOptions options;
  options.is_stopped = [&] {  // asked in each period: somebody else keeps it going
    rig.CommandSpeeds(creep);
    return false;
  };
  const ImageAtRest none = TakeImageAtRest(rig, options);
  EXPECT_THAT(none.missing,
              HasSubstr("leg 4 does not settle: its reading still moves by 0.02 mm within 0.1 s"));
  EXPECT_GE(rig.true_time_s(), RestOptions().timeout_s);
}

TEST(ImageAtRest, IsOneExposedAtRestWhereImagesComeLate) {
  const Taken taken = TakeAfterMotion(WithFault({FaultKind::kFramesLate, 0, 1e9, 0, 0.5}), {});
  EXPECT_EQ(taken.image.missing, "");
  EXPECT_GT(taken.image.image.time_s, 0.5);
  EXPECT_NEAR(taken.image.image.time_s, taken.image.readings.time_s, 1e-9);
  EXPECT_EQ(taken.image.image.image.pixels[0], std::lround(taken.image.image.time_s / 0.02));
}

TEST(ImageAtRest, SaysThatNoImageComes) {
  const Taken taken = TakeAfterMotion(WithFault({FaultKind::kFramesDropped, 0.1}), {});
  EXPECT_THAT(taken.image.missing, HasSubstr("no image comes of the robot at rest"));
}

TEST(ImageAtRest, SaysThatReadingsAreNoNumbersAndThatTheUserStopped) {
  const ImageAtRest blind = TakeAfterMotion(WithFault({FaultKind::kReadingsNan, 0.6}), {}).image;
  EXPECT_THAT(blind.missing, HasSubstr("not numbers"));
  EXPECT_FALSE(blind.readings.joint_readings_m.allFinite());
  RestOptions options;
  options.is_stopped = [] { return true; };
  EXPECT_EQ(TakeAfterMotion({}, options).image.missing, "stopped by the user");
}

TEST(ImageAtRest, LeavesALostLinkToWhoeverCalls) {
  EXPECT_THROW(TakeAfterMotion(WithFault({FaultKind::kLinkLost, 0.6}), {}), RigError);
}

TEST(ImageAtRest, RefusesOptionsThatShowNoMotion) {
  SimulatedRig rig(DesktopTruth(), {}, NumberedPicture);
  RestOptions options;
  options.readings = 3;
  EXPECT_THROW(TakeImageAtRest(rig, options), std::invalid_argument);
}

}  // namespace
}  // namespace legible
