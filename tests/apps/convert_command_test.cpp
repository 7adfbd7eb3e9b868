// `legible convert`, run as a user runs it.
#include "datasets/camera_file.h"
#include "datasets/model_file.h"
#include "datasets/robot_file.h"
#include "datasets/synthetic_session.h"
#include "tests/apps/program_fixture.h"
#include "tests/datasets/equality.h"

namespace legible {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class Convert : public testing::Test {
 protected:
  std::filesystem::path WriteCameraFile(const Camera& camera) const {
    WriteCamera(folder_.path() / "camera.yaml", camera, LookAt({0.94, 0.074, 0.285}, {0, 0, 0.13}));
    return folder_.path() / "camera.yaml";
  }
  std::filesystem::path WriteModelFile() const {
    CalibratedModel model;
    model.robot = DesktopHexapod();
    model.robot.legs[2].joint_offset_m = 0.00125;
    model.camera = DesktopCamera(true);
    model.camera_from_base = LookAt({0.94, 0.074, 0.285}, {0, 0, 0.13});
    model.parameter_names = {"camera.fx_px"};
    model.covariance = Eigen::MatrixXd::Identity(1, 1);
    WriteModel(folder_.path() / "model.yaml", model);
    return folder_.path() / "model.yaml";
  }
  ProgramRun Run(const std::filesystem::path& in, std::vector<std::string> options) const {
    options.insert(options.begin(), {"convert", in.string()});
    return RunLegible(options);
  }

  TemporaryFolder folder_;
};

TEST_F(Convert, ToEachFormatAndBackIsTheSameCamera) {
  const Camera camera = DesktopCamera(true);
  const auto in = WriteCameraFile(camera);
  for (const std::string format : {"opencv", "ros", "kalibr", "mrcal"}) {
    const auto out = folder_.path() / "other";
    const ProgramRun there = Run(in, {"--to", format, "--out", out.string()});
    EXPECT_EQ(there.exit_code, kExitSuccess) << there.err;
    EXPECT_EQ(there.out, "");
    const ProgramRun back = Run(out, {"--to", "ros"});
    EXPECT_EQ(back.exit_code, kExitSuccess) << back.err;
    const std::string warning =
        format != "mrcal"
            ? ""
            : "legible: warning: " + out.string() +
                  ": its extrinsics are taken for camera_from_base, mrcal's reference frame for "
                  "the robot's base; where the reference is another camera, set them to 0\n";
    EXPECT_EQ(back.err, warning);
    ExpectSame(ReadCamera(folder_.Write("again.yaml", back.out)).camera, camera);
  }
}

TEST_F(Convert, SaysWhatAFormatHasNoPlaceFor) {
  const ProgramRun run = Run(WriteModelFile(), {"--to", "kalibr"});
  EXPECT_EQ(run.exit_code, kExitSuccess);
  EXPECT_THAT(run.out, StartsWith("cam0:\n"));
  EXPECT_EQ(
      run.err,
      "legible: warning: Kalibr's camchain has no place for where the camera stands (camera_from_base)\n"
      "legible: warning: Kalibr's camchain has no place for the robot\n"
      "legible: warning: Kalibr's camchain has no place for the covariance of what was estimated\n");
}

TEST_F(Convert, RefusesALensThatTheFormatDoesNotComeNearTo) {
  const auto in = WriteCameraFile(DesktopCamera(true));
  const auto out = folder_.path() / "camera.xml";
  const ProgramRun refused = Run(in, {"--to", "visp", "--out", out.string()});
  EXPECT_EQ(refused.exit_code, kExitNoResult);
  EXPECT_THAT(refused.err,
              AllOf(StartsWith("legible: ViSP's XML has no lens as near to this one as is accepted "
                               "(projection: "),
                    HasSubstr("px at most; way back from pixels: "), HasSubstr("; --accept-error ")));
  EXPECT_FALSE(std::filesystem::exists(out));
  // What the message proposes does.
  const size_t at = refused.err.find("--accept-error ") + std::string("--accept-error ").size();
  const std::string proposed = refused.err.substr(at, refused.err.find(' ', at) - at);
  const ProgramRun accepted = Run(in, {"--to", "visp", "--accept-error", proposed, "--out", out.string()});
  EXPECT_EQ(accepted.exit_code, kExitSuccess) << accepted.err;
  EXPECT_THAT(accepted.err,
              HasSubstr("warning: ViSP's XML holds the nearest lens that it has: projection: "));
  EXPECT_NEAR(ReadCamera(out).camera.distortion[0], -0.15, 0.01);
}

TEST_F(Convert, TakesFromAFolderWhatItStandsFor) {
  const std::filesystem::path shipped = std::filesystem::path(LEGIBLE_SOURCE_DIR) / "datasets" / "hexapod";
  const ProgramRun camera = Run(shipped, {"--to", "ros"});
  EXPECT_EQ(camera.err, "legible: taking " + (shipped / "camera.yaml").string() + "\n");
  EXPECT_EQ(camera.exit_code, kExitSuccess);
  const ProgramRun robot = Run(shipped, {"--to", "linuxcnc"});
  EXPECT_EQ(robot.err, "legible: taking " + (shipped / "robot.yaml").string() + "\n");
  const auto model = WriteModelFile();
  EXPECT_THAT(Run(folder_.path(), {"--to", "opencv"}).err,
              StartsWith("legible: taking " + model.string() + "\n"));
  std::filesystem::remove(model);
  EXPECT_THAT(Run(folder_.path(), {"--to", "opencv"}).err,
              HasSubstr("holds no model.yaml, session.yaml or camera.yaml; name the file that is meant"));
}

TEST_F(Convert, WritesARobotForLinuxCncInTheMachinesUnit) {
  const auto in = WriteModelFile();
  const ProgramRun run = Run(in, {"--to", "linuxcnc"});
  EXPECT_EQ(run.exit_code, kExitSuccess) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("\nsetp genhexkins.base.5.z "),
                             HasSubstr("# [JOINT_2]\n# HOME_OFFSET = 1.25\n")));
  EXPECT_THAT(Run(in, {"--to", "linuxcnc", "--unit", "inch"}).out, HasSubstr("lengths in inch"));
}

TEST_F(Convert, WritesXmlWhereTheFilesNameSaysSo) {
  const auto out = folder_.path() / "camera.xml";
  EXPECT_EQ(Run(WriteCameraFile(DesktopFisheye()), {"--to", "opencv", "--out", out.string()}).exit_code,
            kExitSuccess);
  EXPECT_THAT(Bytes(out), HasSubstr("<opencv_storage>"));
  ExpectSame(ReadCamera(out).camera, DesktopFisheye());
}

TEST_F(Convert, BadInputIsOneLine) {
  const auto refused = [&](const ProgramRun& run, const std::string& what) {
    EXPECT_EQ(run.exit_code, kExitBadInput) << run.err;
    EXPECT_THAT(run.err, AllOf(StartsWith("legible: "), HasSubstr(what)));
    EXPECT_EQ(run.err.find('\n'), run.err.size() - 1);
    EXPECT_EQ(run.out, "");
  };
  const auto camera = WriteCameraFile(DesktopCamera(true));
  WriteRobot(folder_.path() / "robot.yaml", DesktopHexapod());
  refused(Run(camera, {}), "--to");
  refused(Run(camera, {"--to", "matlab"}),
          "--to: \"matlab\" is none of opencv, ros, kalibr, visp, mrcal, linuxcnc");
  refused(Run(camera, {"--to", "linuxcnc"}),
          "camera.yaml: holds no robot; give a model.yaml or a robot.yaml");
  refused(Run(folder_.path() / "robot.yaml", {"--to", "ros"}), "robot.yaml: has no camera; ");
  refused(Run(folder_.path() / "nowhere", {"--to", "ros"}), "nowhere: ");
  refused(Run(camera, {"--to", "visp", "--accept-error", "-1"}), "--accept-error");
  refused(Run(camera, {"--to", "linuxcnc", "--unit", "ell"}), "--unit: \"ell\" is none of mm, inch");
  refused(Run(camera, {"--to", "ros", "--unit", "mm"}), "--unit: belongs to --to linuxcnc");
  refused(Run(folder_.path() / "robot.yaml", {"--to", "linuxcnc", "--accept-error", "1"}),
          "--accept-error: belongs");
  std::string prose;
  for (int i = 0; i < 100; ++i) prose += "This is a letter and no camera\n";
  const ProgramRun letter = Run(folder_.Write("letter.txt", prose), {"--to", "ros"});
  refused(letter, "letter.txt:1: the file is \"This is a letter");
  EXPECT_LT(letter.err.size(), folder_.path().string().size() + 200);
  refused(Run(folder_.Write("c.xml", "<root><camera></root>"), {"--to", "ros"}), "c.xml:1: is no XML");
}

// A session may name any format.
TEST_F(HexapodSession, ItsCameraMayBeAnotherToolsFile) {
  const CameraFile camera = ReadCamera(session() / "camera.yaml");
  const ProgramRun mrcal = RunLegible({"convert", session().string(), "--to", "mrcal"});
  folder_.Write("session/camera.yaml", mrcal.out);
  const ProgramRun run = RunLegible({"convert", session().string(), "--to", "ros"});
  EXPECT_EQ(run.exit_code, kExitSuccess) << run.err;
  const CameraFile again = ReadCamera(folder_.Write("again.yaml", run.out));
  ExpectSame(again.camera, camera.camera);
  ASSERT_TRUE(again.camera_from_base.has_value());
  EXPECT_LT((again.camera_from_base->translation - camera.camera_from_base->translation).norm(), 1e-15);
  // One without the camera's place, and no tags to say it, leads to the message that there is for that.
  folder_.Write("session/camera.yaml", RunLegible({"convert", session().string(), "--to", "kalibr"}).out);
  std::filesystem::remove(folder_.path() / "again.yaml");
  Edit("session.yaml", "tags: tags.yaml\n", "");
  ExpectRefusal(RunOnIt(), HasSubstr("does not say where the camera is"));
}

}  // namespace
}  // namespace legible
