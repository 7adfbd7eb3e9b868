#include "calib/held_out.h"

#include <gtest/gtest.h>

#include <cmath>

#include "datasets/synthetic_session.h"
#include "tests/calib/synthetic_tags.h"

namespace legible {
namespace {

struct Setting {
  std::string name;
  bool use_joint_readings, rigid_platform;
};

// Readings, a rigid platform without readings, and legs whose directions are free: in all three the edges of
// an image that was held out must be predicted as well as their noise lets them.
class HeldOutImages : public testing::TestWithParam<Setting> {
 protected:
  HeldOutImages() {
    SyntheticOptions synthetic;
    synthetic.image_count = 20;
    session_ = GenerateSession(synthetic);
    options_.use_joint_readings = GetParam().use_joint_readings;
    options_.rigid_platform = GetParam().rigid_platform;
    // Without readings nothing else says how large the robot is; without a rigid platform what the camera is.
    options_.hold.radii = !options_.use_joint_readings;
    options_.hold.focal_length = options_.hold.principal_point = options_.hold.distortion =
        !options_.rigid_platform;
  }

  HeldOut Run(const std::vector<ImageObservation>& observations) const {
    LegCalibrationInput input{
        session_.nominal_robot, session_.true_camera, session_.true_camera_from_base, observations, {}, {}};
    for (size_t i = 0; i < kLegCount; ++i)
      input.drawing.legs[i].radius_m = session_.true_robot.legs[i].radius_m;
    input.known.joint_reading_m = 2e-5;
    const LegCalibration solution = CalibrateLegs(input, options_);
    EXPECT_EQ(solution.status, CalibrationStatus::kConverged) << solution.message;
    return CrossValidate(input, solution, options_, FoldsOf(observations.size(), 4, std::nullopt));
  }

  SyntheticSession session_;
  LegCalibrationOptions options_;
};

TEST_P(HeldOutImages, ArePredictedExactlyFromExactObservations) {
  const HeldOut held_out = Run(session_.exact_observations);
  ASSERT_TRUE(held_out.rms_px);
  EXPECT_LT(*held_out.rms_px, 1e-4);
}

TEST_P(HeldOutImages, ArePredictedToHardlyMoreThanTheirNoise) {
  const HeldOut held_out = Run(session_.observations);
  ASSERT_TRUE(held_out.rms_px);
  EXPECT_GT(*held_out.rms_px, 0.27);
  EXPECT_LT(*held_out.rms_px, 0.36);
  for (const auto& of_image : held_out.image_rms_px) EXPECT_TRUE(of_image);
}

INSTANTIATE_TEST_SUITE_P(Settings, HeldOutImages,
                         testing::Values(Setting{"Readings", true, true}, Setting{"Platform", false, true},
                                         Setting{"FreeLegs", false, false}),
                         [](const auto& setting) { return setting.param.name; });

// Which images are left out together.
// Of the base's board as the truth sees it, as drawn or with two tags' corners exchanged.
std::optional<GroupCheck> CheckOfBoard(bool exchanged) {
  SyntheticOptions synthetic;
  synthetic.image_count = 6;
  const SyntheticSession session = GenerateSession(synthetic);
  ObservedTagGroup board = DrawTags(session, {.corner_sigma_px = 0.05}).front();
  if (exchanged) std::swap(board.group.tags.front().corners_m, board.group.tags.back().corners_m);
  std::vector<GroupSighting> sightings;
  for (const auto& detections : board.detections) sightings.push_back(Match(board.group, detections));
  return CheckGroup(board.group, session.true_camera, sightings,
                    std::vector<Rigid3>(sightings.size(), session.true_camera_from_base));
}

TEST(CheckGroup, FindsTheNoiseOfTheCornersWhereverTheGroupStands) {
  const auto check = CheckOfBoard(false);
  ASSERT_TRUE(check);
  EXPECT_NEAR(check->rms_px, 0.05 * std::sqrt(2.0), 0.015);
}

// No place suits them: the best that was found on the way, not wherever the search for it ran to.
TEST(CheckGroup, StaysWithinReachWhereCornersContradictEachOther) {
  const auto check = CheckOfBoard(true);
  ASSERT_TRUE(check);
  EXPECT_GT(check->rms_px, 1);
  EXPECT_LT(check->rms_m, 1);
}

// Tags on base and platform, in images that neither the model nor their own places have seen.
HeldOut HeldOutTags(double edge_noise_px, double corner_sigma_px, double moved_m) {
  SyntheticOptions synthetic;
  synthetic.image_count = 20;
  const SyntheticSession session = GenerateSession(synthetic);
  const bool exact = edge_noise_px == 0;
  LegCalibrationInput input{session.nominal_robot,
                            session.true_camera,
                            session.true_camera_from_base,
                            exact ? session.exact_observations : session.observations,
                            {},
                            {}};
  input.known.joint_reading_m = 2e-5;
  std::vector<CheckedGroup> groups;
  for (const ObservedTagGroup& tags : DrawTags(session, {.corner_sigma_px = corner_sigma_px})) {
    groups.push_back({tags.group, {}});
    for (const auto& detections : tags.detections)
      groups.back().sightings.push_back(Match(tags.group, detections));
    for (Eigen::Vector3d& corner : groups.back().sightings.front().corners_in_group_m) corner.x() += moved_m;
  }
  const LegCalibration solution = CalibrateLegs(input, {});
  EXPECT_EQ(solution.status, CalibrationStatus::kConverged) << solution.message;
  return CrossValidate(input, solution, {}, FoldsOf(input.images.size(), 4, std::nullopt), groups);
}

TEST(HeldOutTags, ArePredictedExactlyFromExactObservations) {
  const HeldOut held_out = HeldOutTags(0, 0, 0);
  ASSERT_EQ(held_out.groups.size(), 2u);
  for (const auto& group : held_out.groups) {
    ASSERT_TRUE(group);
    EXPECT_EQ(group->images, 20);
    EXPECT_LT(group->rms_px, 1e-3);
    EXPECT_LT(group->rms_m, 1e-6);
  }
}

TEST(HeldOutTags, ArePredictedToHardlyMoreThanTheirNoise) {
  for (const auto& group : HeldOutTags(0.3, 0.1, 0).groups) {
    ASSERT_TRUE(group);
    EXPECT_GT(group->rms_px, 0.1);
    EXPECT_LT(group->rms_px, 0.3);
  }
}

// One image's tags, 5 mm off: what was seen of the others does not hide it.
TEST(HeldOutTags, ShowAnImageInWhichTheTagsHaveMoved) {
  for (const auto& group : HeldOutTags(0.3, 0.1, 5e-3).groups) {
    ASSERT_TRUE(group);
    EXPECT_GT(group->rms_m, 0.9 * 5e-3 / std::sqrt(20.0));
  }
}

TEST(FoldsOf, AreEveryNthImageOrAsManyDrawnFromTheSeed) {
  EXPECT_EQ(FoldsOf(7, 3, std::nullopt), (std::vector<int>{0, 1, 2, 0, 1, 2, 0}));
  const std::vector<int> drawn = FoldsOf(40, 5, 3);
  EXPECT_EQ(drawn, FoldsOf(40, 5, 3));
  EXPECT_NE(drawn, FoldsOf(40, 5, 4));
  for (int fold = 0; fold < 5; ++fold) EXPECT_EQ(std::count(drawn.begin(), drawn.end(), fold), 8);
}

}  // namespace
}  // namespace legible
