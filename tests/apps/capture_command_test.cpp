// Sessions held with simulated rigs, and whole ones: images in, files out.
#include <nlohmann/json.hpp>

#include "core/vision/gray_image.h"
#include "datasets/robot_file.h"
#include "datasets/session_file.h"
#include "tests/apps/simulated_rigs.h"
#include "tests/testing/rendered_truth.h"

namespace legible {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

class Capturing : public RigOnDisk {
 protected:
  Capturing() : Capturing(640) {}
  explicit Capturing(int width) : RigOnDisk(width) {}

  json CaptureJson(std::vector<std::string> options, int exit_code) const {
    options.insert(options.end(), {"--format", "json"});
    const ProgramRun run = Capture(options);
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    return json::parse(run.out);
  }

  std::filesystem::path elsewhere() const { return folder_.path() / "elsewhere"; }
};

void ExpectSamePoses(const Session& a, const Session& b) {
  ASSERT_EQ(a.images.size(), b.images.size());
  for (size_t i = 0; i < a.images.size(); ++i) {
    EXPECT_EQ(a.images[i].name, b.images[i].name);
    // A drive ends within a tenth of a millimetre.
    EXPECT_LT((a.images[i].joint_readings_m - b.images[i].joint_readings_m).cwiseAbs().maxCoeff(), 3e-4) << i;
  }
}

std::string Bytes0(const Session& session) { return Bytes(session.images.front().file); }

// In images of full size nearly every edge in sight is measured, whatever the noise: what is proposed depends
// on little else than on where the robot has been.
class CapturingAtFullSize : public Capturing {
 protected:
  CapturingAtFullSize() : Capturing(1280) {}
};
TEST_F(CapturingAtFullSize, ProposesPosesForASessionThatCalibratesAndGoesOnTheSameAfterAnEnd) {
  const json whole = CaptureJson({"--count", "10"}, kExitSuccess);
  EXPECT_EQ(whole.at("status"), "complete");
  EXPECT_EQ(whole.at("images"), 10);
  ASSERT_EQ(whole.at("taken").size(), 10u);
  EXPECT_TRUE(whole.at("taken").at(0).at("expected_sigma").at("position_m").is_null());
  const double expected_m = whole.at("expected_sigma").at("position_m");
  EXPECT_GT(expected_m, 1e-5);
  EXPECT_LT(expected_m, 5e-4);
  std::filesystem::rename(session(), elsewhere());
  EXPECT_EQ(CaptureJson({"--count", "5"}, kExitSuccess).at("images"), 5);
  const std::string first = Bytes0(ReadSession(session()));
  const json rest = CaptureJson({"--count", "10", "--resume"}, kExitSuccess);
  EXPECT_EQ(rest.at("images_before"), 5);
  EXPECT_EQ(rest.at("taken").size(), 5u);
  EXPECT_EQ(Bytes0(ReadSession(session())), first);
  ExpectSamePoses(ReadSession(session()), ReadSession(elsewhere()));
  const ProgramRun calibration = RunLegible(
      {"calibrate", elsewhere(), "--out", folder_.path() / "result", "--folds", "0", "--no-pictures"});
  EXPECT_EQ(calibration.exit_code, kExitSuccess) << calibration.err;
}

TEST_F(CapturingAtFullSize, EndsWhenTheExpectedSigmaIsReachedAndSaysWhereItIsNot) {
  const json reached = CaptureJson({"--until", "0.002"}, kExitSuccess);
  EXPECT_LE(reached.at("expected_sigma").at("position_m"), 0.002);
  EXPECT_THAT(reached.at("reason"), HasSubstr("2 mm were asked for"));
  const size_t images = reached.at("images");
  EXPECT_LT(images, 10u);
  const json again = CaptureJson({"--until", "0.002", "--resume"}, kExitSuccess);
  EXPECT_EQ(again.at("images"), images);
  EXPECT_TRUE(again.at("taken").empty());
}

TEST_F(Capturing, TakesThePosesOfAFileUnderTheirNamesAndWhatIsMissingOfThemLater) {
  EXPECT_EQ(CaptureJson({"--poses", WritePoses(2)}, kExitSuccess).at("images"), 2);
  const std::string first = Bytes0(ReadSession(session()));
  const json rest = CaptureJson({"--poses", WritePoses(3), "--resume"}, kExitSuccess);
  ASSERT_EQ(rest.at("taken").size(), 1u);
  EXPECT_EQ(rest.at("taken").at(0).at("name"), "p2.png");
  const Session held = ReadSession(session());
  ASSERT_EQ(held.images.size(), 3u);
  EXPECT_EQ(Bytes0(held), first);
  EXPECT_EQ(held.known.joint_reading_m.value(), std::hypot(2e-5, 1e-6 / std::sqrt(12)));
  const GoughStewart drawing = ReadRobot(rig() / "robot.yaml");
  const Rigid3 p2{RotationFromVector({0.05 * std::cos(4), 0.05 * std::sin(10), 0.02}),
                  {0.02 * std::sin(2), 0.02 * std::cos(2), 0.325 + 0.012 * std::sin(6)}};
  EXPECT_LT((held.images[2].joint_readings_m - InverseKinematics(drawing, p2)).cwiseAbs().maxCoeff(), 3e-4);
  for (const SessionImage& image : held.images) EXPECT_TRUE(ReadGrayImage(image.file));
}

TEST_F(Capturing, RefusesToReplaceASessionOrToGoOnWithOtherPapers) {
  ASSERT_EQ(Capture({"--poses", WritePoses(1), "--known", "radius_m=1e-4"}).exit_code, kExitSuccess);
  const auto refused = [&](const std::vector<std::string>& options, const std::string& what) {
    const ProgramRun run = Capture(options);
    EXPECT_EQ(run.exit_code, kExitBadInput);
    EXPECT_THAT(run.err, HasSubstr(what));
    EXPECT_EQ(ReadSession(session()).images.size(), 1u);
  };
  refused({}, "holds a session already; go on with it by --resume, or name another folder");
  refused({"--resume", "--known", "radius_m=2e-4"}, "session.yaml: says otherwise of radius_m than --known");
  GoughStewart other = ReadRobot(rig() / "robot.yaml");
  other.legs[0].radius_m += 1e-3;
  WriteRobot(rig() / "other.yaml", other);
  refused({"--resume", "--robot", rig() / "other.yaml"}, "other.yaml: is not the robot that ");
}

TEST_F(Capturing, HoldsASessionInSpiteOfFrictionLagAndNoise) {
  ChangeTruth([](SimulatedTruth& simulated) {
    simulated.options.drives.breakaway_speed_m_per_s = 0.002;
    simulated.options.drives.sliding_loss_m_per_s = 0.001;
    simulated.options.drives.lag_s = 0.1;
  });
  const json document = CaptureJson({"--poses", WritePoses(4)}, kExitSuccess);
  EXPECT_EQ(document.at("images"), 4);
}

TEST_F(Capturing, KeepsWhatItHasWhenTheRigFailsAndSaysWhy) {
  ChangeTruth([](SimulatedTruth& simulated) { simulated.options.faults = {{FaultKind::kLinkLost, 12}}; });
  const ProgramRun run = Capture({"--poses", WritePoses(8)});
  EXPECT_EQ(run.exit_code, kExitNoResult);
  EXPECT_THAT(run.err, HasSubstr("legible: stopped: the rig does not answer: "));
  EXPECT_GE(ReadSession(session()).images.size(), 1u);
  EXPECT_THAT(run.out, HasSubstr(" in " + session().string()));
}

TEST_F(Capturing, PassesOverPosesThatShowNothingAndGivesUpAfterFive) {
  ChangeTruth([](SimulatedTruth& simulated) {
    simulated.options.scene.leg_grey = simulated.options.scene.ground_grey =
        simulated.options.scene.plate_grey = 40;
    simulated.options.scene.joint_grey = 40;
    simulated.options.scene.ambient = 1;
  });
  const json document = CaptureJson({}, kExitNoResult);
  EXPECT_EQ(document.at("images"), 0);
  EXPECT_EQ(document.at("rejected").size(), 5u);
  EXPECT_THAT(document.at("reason"),
              AllOf(HasSubstr("5 poses in a row gave no image of use"),
                    HasSubstr("see that the legs are lit"), HasSubstr("go on with --resume")));
  EXPECT_THAT(folder_.Names(), ElementsAre("rig"));
}

// Legs are thinner there than the first look's search is wide.
TEST_F(Capturing, FindsTheLegsInEachProposedPoseInSmallImagesToo) {
  for (const int seed : {1, 4, 10, 13}) {
    SCOPED_TRACE(seed);
    MakeRig(640, seed);
    const json document = CaptureJson({"--count", "6", "--seed", std::to_string(seed)}, kExitSuccess);
    EXPECT_EQ(document.at("images"), 6);
    EXPECT_EQ(document.at("rejected"), json::array());
    std::filesystem::remove_all(session());
  }
}

TEST_F(Capturing, SaysThatFramesAreFrozen) {
  ChangeTruth([](SimulatedTruth& simulated) { simulated.options.faults = {{FaultKind::kFramesFrozen, 0}}; });
  const json document = CaptureJson({"--poses", WritePoses(3)}, kExitNoResult);
  EXPECT_THAT(document.at("reason"), HasSubstr("it is frozen"));
  EXPECT_EQ(document.at("images"), 1);
}

TEST_F(Capturing, WarnsWhereThereIsNothingToFind) {
  ChangeTruth([](SimulatedTruth& simulated) { simulated.drawing_robot.reset(); });
  EXPECT_THAT(Capture({"--poses", WritePoses(1)}).err,
              HasSubstr("legible: warning: " + truth().string() + " names no drawing of the robot"));
}

class Simulating : public testing::Test {
 protected:
  ProgramRun Simulate(std::vector<std::string> options) const {
    options.insert(options.begin(), {"simulate", "--out", out().string()});
    return RunLegible(options);
  }
  std::filesystem::path out() const { return folder_.path() / "simulation"; }

  TemporaryFolder folder_;
};

TEST_F(Simulating, WritesASessionThatCalibratesTowardsTheTruthBesideIt) {
  ASSERT_EQ(Simulate({"--images", "20", "--seed", "2"}).exit_code, kExitSuccess);
  const ProgramRun run = RunLegible({"calibrate", out(), "--out", folder_.path() / "result", "--folds", "0",
                                     "--no-pictures", "--format", "json"});
  EXPECT_EQ(run.exit_code, kExitSuccess) << run.err;
  const json found = json::parse(run.out);
  const RenderedTruth truth = ReadRenderedTruth(out() / "truth.json");
  ASSERT_EQ(truth.images.size(), 20u);
  const Session session = ReadSession(out());
  for (size_t i = 0; i < kLegCount; ++i) {
    const double drawn_m = std::abs(session.robot.legs[i].radius_m - truth.robot.legs[i].radius_m);
    const double found_m =
        std::abs(found.at("legs").at(i).at("radius_m").get<double>() - truth.robot.legs[i].radius_m);
    EXPECT_LT(found_m, 5e-5) << "drawn " << drawn_m << " m off";
  }
  EXPECT_NEAR(found.at("camera").at("fx"), truth.camera.fx_px,
              6 * found.at("camera").at("sigma").at("fx").get<double>());
}

TEST_F(Simulating, SaysOfEachImageWhatIsTrue) {
  ASSERT_EQ(Simulate({"--images", "3", "--width", "800", "--height", "480"}).exit_code, kExitSuccess);
  const Session session = ReadSession(out());
  const SimulatedTruth simulated = ReadTruth(out() / "truth.yaml");
  const RenderedTruth truth = ReadRenderedTruth(out() / "truth.json");
  ASSERT_EQ(truth.images.size(), session.images.size());
  EXPECT_EQ(truth.camera.fx_px, simulated.truth.camera.fx_px);
  for (size_t i = 0; i < truth.images.size(); ++i) {
    EXPECT_EQ(truth.images[i].first, session.images[i].name);
    const Vector6d readings_m = InverseKinematics(simulated.truth.robot, truth.images[i].second);
    EXPECT_LT((readings_m - session.images[i].joint_readings_m).cwiseAbs().maxCoeff(), 1.2e-4);
    const auto image = ReadGrayImage(session.images[i].file);
    ASSERT_TRUE(image);
    EXPECT_EQ(image->width, 800);
    EXPECT_EQ(image->height, 480);
  }
  EXPECT_EQ(simulated.drawing_robot.value(), out() / "robot.yaml");
  EXPECT_EQ(session.camera.distortion, Distortion::Zero());
}

TEST_F(Simulating, ReplacesAnEarlierSimulationAndIsTheSameForTheSameSeed) {
  ASSERT_EQ(Simulate({"--images", "2", "--width", "800"}).exit_code, kExitSuccess);
  const std::string image = Bytes(out() / "images" / "001.png"), truth = Bytes(out() / "truth.yaml");
  ASSERT_EQ(Simulate({"--images", "0", "--seed", "5"}).exit_code, kExitSuccess);
  EXPECT_THAT(
      [&] {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(out()))
          names.push_back(entry.path().filename());
        return names;
      }(),
      UnorderedElementsAre("truth.yaml", "robot.yaml", "camera.yaml"));
  EXPECT_NE(Bytes(out() / "truth.yaml"), truth);
  ASSERT_EQ(Simulate({"--images", "2", "--width", "800"}).exit_code, kExitSuccess);
  EXPECT_EQ(Bytes(out() / "images" / "001.png"), image);
  EXPECT_EQ(Bytes(out() / "truth.yaml"), truth);
}

TEST_F(Simulating, TakesARigThatThereIsWithItsPapers) {
  ASSERT_EQ(Simulate({"--images", "0", "--width", "800"}).exit_code, kExitSuccess);
  const std::filesystem::path other = folder_.path() / "other";
  const ProgramRun run =
      RunLegible({"simulate", out() / "truth.yaml", "--images", "2", "--out", other.string()});
  EXPECT_EQ(run.exit_code, kExitSuccess) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_EQ(Bytes(other / "robot.yaml"), Bytes(out() / "robot.yaml"));
  EXPECT_EQ(Bytes(other / "camera.yaml"), Bytes(out() / "camera.yaml"));
  EXPECT_EQ(Bytes(other / "truth.yaml"), Bytes(out() / "truth.yaml"));
}

// The desktop's at twice its size, with its base frame turned about.
TEST_F(Simulating, PlacesTheCameraBeforeARobotOfAnotherSizeAndFrame) {
  GoughStewart robot = DesktopHexapod();
  const Rigid3 turned{RotationFromVector({1.2, -0.4, 0.7}), {0.3, 1, -2}};
  for (Leg& leg : robot.legs) {
    leg.base_joint_m = turned * (2 * leg.base_joint_m);
    leg.platform_joint_m *= 2;
    leg.radius_m *= 2;
    for (double& end_m : leg.joint_range_m) end_m *= 2;
  }
  robot.home = turned * Rigid3{robot.home.rotation, 2 * robot.home.translation};
  WriteRobot(folder_.path() / "robot.yaml", robot);
  const ProgramRun run =
      Simulate({"--robot", folder_.path() / "robot.yaml", "--images", "2", "--width", "640"});
  EXPECT_EQ(run.exit_code, kExitSuccess) << run.err;
}

}  // namespace
}  // namespace legible
