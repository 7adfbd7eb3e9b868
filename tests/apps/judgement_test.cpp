// Each finding that a user must hear of, on a calibration made by hand that is otherwise in order.
#include "apps/judgement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "apps/prior_pulls.h"
#include "calib/calibrated_model.h"
#include "datasets/synthetic_session.h"

namespace legible {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

ImageOutcome GoodImage(int number) {
  ImageOutcome image;
  image.name = std::to_string(number) + ".png";
  image.edges.edges.resize(2 * kLegCount);
  image.rms_px = 0.03;
  image.held_out_rms_px = 0.035;
  return image;
}

CalibrationRun GoodRun() {
  CalibrationRun run;
  run.session.robot = DesktopHexapod();
  run.session.camera = run.result.guessed_camera = DesktopCamera(false);
  for (int i = 0; i < 12; ++i) run.result.images.push_back(GoodImage(i));
  LegCalibration& calibration = run.result.calibration;
  calibration.status = CalibrationStatus::kConverged;
  calibration.noise = {0.6, 0.4, 0.4};
  calibration.rms_px = 0.03;
  calibration.reading_rms = 0.6;
  calibration.reading_scatter = 0.9;
  run.result.held_out_rms_px = 0.035;
  run.result.held_out_folds = 5;
  return run;
}

// What was found is what was drawn, to a known sigma; nothing was said beforehand.
FoundParameters FoundAsDrawn(const CalibrationRun& run) {
  FoundParameters found;
  found.camera = ParametersOf(run.session.camera);
  found.camera_sigma.setOnes();
  for (size_t i = 0; i < kLegCount; ++i) {
    const Leg& leg = run.session.robot.legs[i];
    found.legs[i].base_joint_m = leg.base_joint_m;
    found.legs[i].platform_joint_m = leg.platform_joint_m;
    found.legs[i].radius_m = leg.radius_m;
    found.legs[i].joint_offset_m = leg.joint_offset_m;
    found.legs[i].sigma.base_joint_m = found.legs[i].sigma.platform_joint_m = Eigen::Vector3d::Constant(1e-5);
    found.legs[i].sigma.radius_m = found.legs[i].sigma.joint_offset_m = 1e-5;
  }
  return found;
}

std::vector<std::string> WarningsAfter(const std::function<void(CalibrationRun&)>& change) {
  CalibrationRun run = GoodRun();
  change(run);
  return Warnings(run, FoundAsDrawn(run));
}

TEST(Warnings, AreNoneWhereAllIsInOrder) {
  EXPECT_THAT(WarningsAfter([](CalibrationRun&) {}), IsEmpty());
}

TEST(Warnings, SayOneSentenceForEachFinding) {
  const std::vector<std::pair<std::string, std::function<void(CalibrationRun&)>>> findings = {
      {"only 9 images were used", [](auto& run) { run.result.images.resize(9); }},
      {"the edges lie 1.6 times as far", [](auto& run) { run.result.calibration.noise.tilt = 1.6; }},
      {"disagree with the images 1.4 times", [](auto& run) { run.result.calibration.reading_scatter = 1.4; }},
      {"agree with the images to 0.2 of", [](auto& run) { run.result.calibration.reading_scatter = 0.2; }},
      {"images held out is 2.0 times", [](auto& run) { run.result.held_out_rms_px = 0.06; }},
      {"in 2 of 5 turns", [](auto& run) { run.result.held_out_folds_failed = 2; }},
      {"7.png: held out, its edges are predicted 1.20 px off, the other images' 0.04 px",
       [](auto& run) { run.result.images[7].held_out_rms_px = 1.2; }},
      {"known only to 6 % of its size: camera.fx_px",
       [](auto& run) {
         run.result.calibration.observability.weak = {{"camera.fx_px", 0.06, {}}};
       }},
      {"contradict what is held: camera.cx_px by 26.5 σ",
       [](auto& run) {
         run.result.held_differences = {{"camera.cx_px", -26.5}};
       }},
      {"the tags board lie 2.0 px (1.00 mm)",
       [](auto& run) {
         run.result.tag_checks = {{"board", false, false, false, 12, 2, 1e-3}};
       }},
      {"the tags board are 5.0 σ",
       [](auto& run) {
         run.result.calibration.tags = {{"board", {}, 5, 3, 0, 0.1}};
       }},
      {"only 66 of 144 edges in sight could be used",
       [](auto& run) {
         for (ImageOutcome& image : run.result.images)
           for (size_t i = 0; i < image.edges.edges.size(); ++i)
             if (i % 2 == 0 || image.name == "0.png") image.edges.edges[i].left_out = "no edge";
       }},
  };
  for (const auto& [sentence, change] : findings)
    EXPECT_THAT(WarningsAfter(change), ElementsAre(HasSubstr(sentence)));
}

TEST(Warnings, NameImagesThatWereLeftOutForTheSameReasonTogether) {
  const auto warnings = WarningsAfter([](CalibrationRun& run) {
    for (const size_t i : {11, 2, 0}) run.result.images[i].left_out = i == 0 ? "dark" : "damaged";
    run.result.images.push_back(GoodImage(12));
  });
  EXPECT_THAT(warnings,
              ElementsAre("2 of 13 images left out: damaged (2.png, 11.png)", "0.png: left out: dark"));
}

// A board that is solved together with the legs, its lens model poor.
TEST(Warnings, SayByHowMuchABoardIsWeighedDown) {
  const auto warnings = WarningsAfter([](CalibrationRun& run) {
    IntrinsicsRun& board = run.board.emplace();
    board.result.status = BoardCalibrationStatus::kConverged;
    board.result.information = {Eigen::MatrixXd::Identity(9, 9), 1e-4 * Eigen::MatrixXd::Identity(15, 15)};
    board.result = Widened(board.result, 2.5);
    board.halves.ratio = 9;
    board.halves.ratio_limit = 2;
  });
  EXPECT_THAT(warnings, testing::Contains(testing::AllOf(
                            testing::StartsWith("the board: "), HasSubstr("the lens model does not fit"),
                            HasSubstr("σ are therefore 2.5 times what the residuals give"))));
}

// Legs that are hidden as predicted say nothing against the model.
TEST(Warnings, DoNotCountEdgesThatAreOutOfSight) {
  EXPECT_THAT(WarningsAfter([](CalibrationRun& run) {
                for (ImageOutcome& image : run.result.images)
                  for (size_t i = 0; i < 8; ++i) {
                    image.edges.edges[i].left_out = "hidden";
                    image.edges.edges[i].in_sight = false;
                  }
              }),
              IsEmpty());
}

// An observation 3 +- 4 joins one of 0 +- 3 (radii in mm): the average is 1.08 +- 2.4, and (1.08 - 0) /
// sqrt(9 - 5.76) = 0.6 is 3 / 5, the difference of the two over its sigma.
TEST(PriorPulls, AreTheDifferenceOfWhatWasSaidAndWhatTheRestSaysInItsSigma) {
  CalibrationRun run = GoodRun();
  run.session.known.radius_m = 3e-3;
  FoundParameters found = FoundAsDrawn(run);
  found.legs[0].radius_m += 1.08e-3;
  found.legs[0].sigma.radius_m = 2.4e-3;
  const std::vector<PriorPull> pulls = PriorPulls(run, found);
  ASSERT_EQ(pulls.size(), 6u);
  EXPECT_EQ(pulls[0].name, "legs[1].radius_m");
  EXPECT_NEAR(pulls[0].pull, 0.6, 1e-9);
}

// Joints said to be known so well that the images cannot move them: sigma is what the fit of their frame
// leaves of what was said, to a millionth and less, and the pull must still be seen.
TEST(PriorPulls, OfJointsSeeWhatASigmaThatIsTooSmallHides) {
  CalibrationRun run = GoodRun();
  constexpr double kSaid_m = 1e-5, kOfImages_m = 1e-4, kOff_m = 1e-3;
  run.session.known.platform_joint_m = kSaid_m;
  FoundParameters found = FoundAsDrawn(run);
  LegPoints drawn;
  for (size_t i = 0; i < kLegCount; ++i) drawn[i] = run.session.robot.legs[i].platform_joint_m;
  const auto gauge = PlatformGauge(drawn);
  const Eigen::MatrixXd motions =
      gauge.transpose() * (gauge * gauge.transpose()).inverse() * gauge;  // projects on them
  const double said = kSaid_m * kSaid_m * (1 - motions(0, 0)), images = kOfImages_m * kOfImages_m;
  found.legs[0].sigma.platform_joint_m.x() = std::sqrt(said * images / (said + images));
  found.legs[0].platform_joint_m.x() += kOff_m * said / (said + images);
  const std::vector<PriorPull> pulls = PriorPulls(run, found);
  EXPECT_EQ(pulls[0].name, "legs[1].platform_joint_m.x");
  EXPECT_NEAR(pulls[0].pull, kOff_m / std::sqrt(said + images), 1e-6);
}

}  // namespace
}  // namespace legible
