// `legible calibrate` on the shipped session and on what is left of it: images in, files out.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "datasets/model_file.h"
#include "datasets/session_file.h"
#include "tests/apps/program_fixture.h"

namespace legible {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using testing::UnorderedElementsAre;

std::vector<std::string> NamesIn(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename());
  return names;
}

// Numbers in a value, at any depth; nulls count apart.
struct Numbers {
  int known = 0, null = 0;
};
Numbers CountNumbers(const json& value) {
  if (value.is_null()) return {0, 1};
  if (value.is_number()) return {1, 0};
  Numbers sum;
  if (!value.is_structured()) return sum;
  for (const json& part : value) {
    const Numbers of_part = CountNumbers(part);
    sum = {sum.known + of_part.known, sum.null + of_part.null};
  }
  return sum;
}

void ExpectNumbers(const json& value, int count) {
  EXPECT_EQ(CountNumbers(value).known, count) << value;
  EXPECT_EQ(CountNumbers(value).null, 0) << value;
}

void ExpectLegsKnown(const json& legs) {
  ASSERT_EQ(legs.size(), 6u);
  for (const json& leg : legs) {
    for (const json& values : {leg, leg.at("sigma")}) {
      for (const char* point : {"base_joint_m", "base_joint_in_camera_m", "platform_joint_m"})
        ExpectNumbers(values.at(point), 3);
      ExpectNumbers(values.at("radius_m"), 1);
      ExpectNumbers(values.at("joint_offset_m"), 1);
    }
    EXPECT_GT(leg.at("sigma").at("radius_m"), 0);
  }
}

void ExpectCameraKnown(const json& document) {
  for (const json& values : {document.at("camera"), document.at("camera").at("sigma")}) {
    for (const char* name : {"fx", "fy", "cx", "cy"}) ExpectNumbers(values.at(name), 1);
    ExpectNumbers(values.at("distortion"), 5);
  }
  ExpectNumbers(document.at("camera_from_base").at("rotation_xyzw"), 4);
  ExpectNumbers(document.at("camera_from_base").at("translation_m"), 3);
}

void ExpectEveryMemberOfAModel(const json& document) {
  EXPECT_EQ(document.at("status"), "converged");
  for (const char* name : {"rms_px", "edge_sigma_px", "images_used", "edges_used"})
    ExpectNumbers(document.at(name), 1);
  ExpectCameraKnown(document);
  ExpectLegsKnown(document.at("legs"));
  EXPECT_EQ(document.at("images_left_out"), json::array());
  EXPECT_EQ(document.at("unobservable"), json::array());
  ExpectNumbers(document.at("held_out").at("rms_px"), 1);
  for (const char* stage : {"read", "detect", "solve", "covariance", "total"})
    ExpectNumbers(document.at("time_s").at(stage), 1);
}

// Of correlations: covariances mix px^2 with m^2.
double LeastEigenvalueOfCorrelations(const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd scale = covariance.diagonal().array().max(1e-300).sqrt().inverse();
  const Eigen::MatrixXd correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(correlation).eigenvalues().minCoeff();
}

void ExpectTraceableModel(const CalibratedModel& model, const std::filesystem::path& session) {
  EXPECT_TRUE(model.camera && model.camera_from_base);
  EXPECT_GT(model.covariance.diagonal().maxCoeff(), 0);
  EXPECT_GT(LeastEigenvalueOfCorrelations(model.covariance), -1e-9);
  EXPECT_EQ(model.provenance.at("content_hash"), ContentHash(ReadSession(session)));
  EXPECT_EQ(model.provenance.at("session"), session);
  EXPECT_EQ(model.provenance.at("program_version"), ProgramVersion());
  EXPECT_EQ(model.provenance.at("options"), "none");
}

using Calibrate = HexapodSession;

TEST_F(Calibrate, TurnsTheShippedSessionIntoAModelAReportAndASummary) {
  const ProgramRun run = RunOnIt();
  EXPECT_EQ(run.exit_code, kExitSuccess);
  EXPECT_EQ(run.err, "");
  for (const char* part :
       {"Converged: 16 of 16 images", "held out", "Tags platform_tag", "fx_px", "offset mm"})
    EXPECT_THAT(run.out, HasSubstr(part));
  EXPECT_THAT(NamesIn(out()), UnorderedElementsAre("model.yaml", "calibration.json", "report.html"));
  ExpectEveryMemberOfAModel(json::parse(Bytes(out() / "calibration.json")));
  ExpectTraceableModel(ReadModel(out() / "model.yaml"), session());
  EXPECT_THAT(Bytes(out() / "report.html"), HasSubstr("data:image/jpeg;base64,"));
}

TEST_F(Calibrate, NamesTheScaleOfEachLegWhereThereAreOnlyEdges) {
  folder_.Write("out/model.yaml", "of an earlier run");
  const ProgramRun run = RunOnIt({"--free-legs", "--no-pictures"});
  EXPECT_EQ(run.exit_code, kExitNoResult);
  EXPECT_THAT(NamesIn(out()), UnorderedElementsAre("calibration.json", "report.html"));
  const json document = json::parse(Bytes(out() / "calibration.json"));
  EXPECT_EQ(document.at("status"), "unobservable");
  ASSERT_GE(document.at("unobservable").size(), 6u) << document.at("unobservable");
  for (int leg = 1; leg <= 6; ++leg) {
    const std::string scale = "scale of leg " + std::to_string(leg) + " is free";
    EXPECT_THAT(document.at("unobservable").at(static_cast<size_t>(leg - 1)), HasSubstr(scale));
    EXPECT_THAT(run.err, HasSubstr(scale));
  }
  // Edges of free legs say next to nothing of the camera either, which is named behind them.
  for (size_t i = 6; i < document.at("unobservable").size(); ++i)
    EXPECT_THAT(document.at("unobservable").at(i), HasSubstr("camera."));
  for (const char* name : {"fx", "fy", "cx", "cy"})
    EXPECT_TRUE(document.at("camera").at(name).is_null()) << name;
  EXPECT_EQ(CountNumbers(document.at("legs")).known, 0);
  EXPECT_EQ(CountNumbers(document.at("camera_from_base")).known, 0);
  EXPECT_THAT(run.out, Not(HasSubstr("±")));
  EXPECT_THAT(Bytes(out() / "report.html"), Not(HasSubstr("data:image/jpeg")));
}

TEST_F(Calibrate, TakesTagsAsObservationsWhereAskedTo) {
  const ProgramRun run = RunOnIt({"--no-readings", "--tags", "all", "--folds", "0", "--no-pictures"});
  EXPECT_EQ(run.exit_code, kExitSuccess) << run.err;
  EXPECT_THAT(run.out, HasSubstr("Tags platform_tag as observations: 16 seen"));
  const json document = json::parse(Bytes(out() / "calibration.json"));
  EXPECT_EQ(document.at("options"), "--tags all --no-readings --folds 0");
  ASSERT_EQ(document.at("tags").size(), 2u);
  for (const json& group : document.at("tags")) {
    EXPECT_LT(group.at("sigma_px"), 0.1);
    EXPECT_LT(group.at("placement_sigmas"), 2);
    EXPECT_EQ(group.at("tags_left_out"), 0);
  }
  for (const json& check : document.at("tag_checks")) EXPECT_EQ(check.at("took_part"), true);
  for (const json& leg : document.at("legs")) ExpectNumbers(leg.at("radius_m"), 1);
}

TEST_F(Calibrate, SaysInOneLineThatOneImageIsTooFew) {
  KeepImages(1);
  const ProgramRun run = RunOnIt();
  EXPECT_EQ(run.exit_code, kExitNoResult);
  EXPECT_EQ(run.err,
            "legible: no model: only 1 image could be used, too few to determine the parameters; give some "
            "forty in clearly different poses.\n");
  EXPECT_THAT(NamesIn(out()), UnorderedElementsAre("calibration.json", "report.html"));
  EXPECT_EQ(CountNumbers(json::parse(Bytes(out() / "calibration.json")).at("camera_from_base")).known, 0);
}

// The libraries below have messages of their own.
TEST_F(Calibrate, AsAProcessWritesThatLineAndNothingElseOnStandardError) {
  KeepImages(1);
  const std::filesystem::path err = folder_.path() / "err";
  const std::string command = std::string(LEGIBLE_PROGRAM) + " calibrate " + session().string() + " --out " +
                              out().string() + " --format json >/dev/null 2>" + err.string();
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), kExitNoResult);
  EXPECT_THAT(Bytes(err), testing::MatchesRegex("legible: no model: [^\n]*\n"));
}

TEST_F(Calibrate, LeavesADamagedImageOutWithAWarningAndItsReason) {
  KeepImages(3);
  Truncate("001.png");
  const ProgramRun run = RunOnIt({"--format", "json", "--folds", "0", "--no-pictures"});
  EXPECT_THAT(run.err, HasSubstr("legible: warning: 001.png: left out: "));
  EXPECT_EQ(run.out, Bytes(out() / "calibration.json"));
  const json document = json::parse(run.out);
  EXPECT_EQ(document.at("images_used"), 2);
  ASSERT_EQ(document.at("images_left_out").size(), 1u);
  EXPECT_EQ(document.at("images_left_out").at(0).at("name"), "001.png");
  EXPECT_NE(document.at("images_left_out").at(0).at("reason"), "");
}

TEST_F(Calibrate, LeavesAnImageOutWhoseReadingsLeadToNoPose) {
  KeepImages(3);
  Edit("joints.csv", "001.png,0.44459822,0.46647168,0.45847603,0.44923659,0.37544442,0.42079856",
       "001.png,0.28,0.55,0.28,0.55,0.28,0.55");
  const ProgramRun run = RunOnIt({"--folds", "0", "--no-pictures"});
  EXPECT_THAT(run.err, HasSubstr("001.png: left out: no pose of the platform has its joint readings\n"));
  EXPECT_EQ(json::parse(Bytes(out() / "calibration.json")).at("images_used"), 2);
}

TEST_F(Calibrate, NamesAJointReadingThatIsWrong) {
  Edit("joints.csv", "001.png,0.44459822,", "001.png,0.44559822,");
  const ProgramRun run = RunOnIt({"--folds", "0", "--no-pictures"});
  EXPECT_EQ(run.exit_code, kExitSuccess);
  EXPECT_THAT(run.err,
              testing::MatchesRegex(
                  "legible: warning: joints.csv: 001.png: the joint readings did not count: that of leg 1 is "
                  "[01]\\.[0-9]* mm longer than [^\n]*\n"));
  EXPECT_EQ(json::parse(Bytes(out() / "calibration.json")).at("joint_readings_left_out").size(), 1u);
}

TEST_F(Calibrate, PlacesTheCameraWithoutTagsThatTheImagesContradict) {
  Edit("tags.yaml", "{id: 0, corners_m", "{id: 9, corners_m");
  Edit("tags.yaml", "{id: 3, corners_m", "{id: 0, corners_m");
  Edit("tags.yaml", "{id: 9, corners_m", "{id: 3, corners_m");
  const ProgramRun run = RunOnIt({"--folds", "0", "--no-pictures"});
  EXPECT_EQ(run.exit_code, kExitSuccess) << run.err;
  EXPECT_THAT(run.err,
              testing::MatchesRegex("legible: warning: the tags base_board lie [0-9]* px from [^\n]*\n"));
  EXPECT_EQ(json::parse(Bytes(out() / "calibration.json")).at("first_camera_pose_from"), "camera.yaml");
}

// Tags can be absent: a tape measure's 3 cm and 3 degrees, here 110 px in the image, have to do.
TEST_F(Calibrate, StartsThreeCentimetresAndThreeDegreesOff) {
  Edit("session.yaml", "tags: tags.yaml\n", "");
  Edit("camera.yaml", "rotation_xyzw: [0.518849851, 0.550845912, -0.489188099, 0.433657257]",
       "rotation_xyzw: [0.53298008, 0.55198020, -0.46664450, 0.43987841]");
  Edit("camera.yaml", "translation_m: [0.021, 0.156, 0.975]",
       "translation_m: [-0.045154, 0.130898, 0.957076]");
  const ProgramRun run = RunOnIt({"--folds", "0", "--no-pictures"});
  EXPECT_EQ(run.exit_code, kExitSuccess) << run.err;
  EXPECT_LT(json::parse(Bytes(out() / "calibration.json")).at("rms_px"), 0.04);
}

TEST_F(Calibrate, SaysWhereTheLegsAreNotWhereTheyShouldBe) {
  Edit("session.yaml", "tags: tags.yaml\n", "");
  Edit("camera.yaml", "translation_m: [0.021, 0.156, 0.975]", "translation_m: [0.321, 0.156, 0.975]");
  const ProgramRun run = RunOnIt({"--no-pictures"});
  EXPECT_EQ(run.exit_code, kExitNoResult);
  EXPECT_THAT(run.err, HasSubstr("legible: no model: the legs were not found where the session puts them. "));
}

// Base joints of a drawing that is 2 mm off leave ten times what the edges allow.
TEST_F(Calibrate, RefusesAModelThatTheEdgesContradict) {
  const ProgramRun run = RunOnIt({"--hold", "base-joints", "--folds", "0", "--no-pictures"});
  EXPECT_EQ(run.exit_code, kExitNoResult);
  EXPECT_THAT(run.err,
              testing::MatchesRegex("legible: no model: [0-9]* of 192 edges in sight were found near the "
                                    "best model, and these lie [0-9.]* times as far [^\n]*\n"));
  EXPECT_THAT(NamesIn(out()), UnorderedElementsAre("calibration.json", "report.html"));
  EXPECT_EQ(CountNumbers(json::parse(Bytes(out() / "calibration.json")).at("legs")).known, 0);
}

// The middle of the image is some 15 px from this camera's principal point.
TEST_F(Calibrate, WarnsOfAHeldValueThatTheImagesContradict) {
  const ProgramRun run = RunOnIt({"--hold", "principal-point", "--folds", "0", "--no-pictures"});
  EXPECT_EQ(run.exit_code, kExitSuccess);
  EXPECT_THAT(run.err,
              testing::MatchesRegex("legible: warning: the images contradict what is held: camera.c[xy]_px "
                                    "by [0-9.]* σ, [^\n]*\n"));
}

// Legs exchanged in the table of readings: no parameter is open, and no reading is a thousand kilometres off.
TEST_F(Calibrate, SaysThatTheEdgesContradictLegsInAnotherOrder) {
  Edit("joints.csv", "image,q1_m,q2_m,q3_m,q4_m,q5_m,q6_m", "image,q1_m,q2_m,q4_m,q3_m,q5_m,q6_m");
  const ProgramRun run = RunOnIt({"--folds", "0", "--no-pictures"});
  EXPECT_EQ(run.exit_code, kExitNoResult);
  EXPECT_THAT(run.err, HasSubstr("legs"));
  EXPECT_THAT(run.err, HasSubstr("in another order in joints.csv than in robot.yaml"));
  EXPECT_THAT(run.err, Not(HasSubstr("did not count")));
}

TEST_F(Calibrate, LooksFirstAtImagesThatCanBeRead) {
  for (int i = 0; i < 16; i += 2) Truncate(fmt::format("{:03}.png", i));
  const ProgramRun run = RunOnIt({"--folds", "0", "--no-pictures"});
  EXPECT_EQ(run.exit_code, kExitSuccess) << run.err;
  EXPECT_THAT(run.err, HasSubstr("8 of 16 images left out: not an image, or damaged (000.png, "));
}

// Radii of the drawing that are 0.3 mm off, given as if they were known to 0.02 mm.
TEST_F(Calibrate, WarnsOfAValueThatTheImagesContradict) {
  const ProgramRun run = RunOnIt({"--known", "radius_m=2e-5", "--folds", "0", "--no-pictures"});
  EXPECT_THAT(run.err, HasSubstr("legible: warning: the images contradict what was said beforehand: "
                                 "legs[4].radius_m by "));
}

TEST_F(Calibrate, SaysTheSameWarningsOnTheConsoleInItsFileAndInItsReport) {
  KeepImages(5);
  const ProgramRun run = RunOnIt({"--no-pictures"});
  const json warnings = json::parse(Bytes(out() / "calibration.json")).at("warnings");
  ASSERT_FALSE(warnings.empty());
  EXPECT_THAT(warnings.at(0), HasSubstr("only 5 images were used"));
  std::string lines;
  for (const std::string sentence : warnings) lines += "legible: warning: " + sentence + "\n";
  EXPECT_EQ(run.err, lines);
  EXPECT_THAT(Bytes(out() / "report.html"), HasSubstr(warnings.at(0).get<std::string>()));
}

TEST_F(Calibrate, WarnsOfTagsOfAnotherFamily) {
  KeepImages(2);
  Edit("tags.yaml", "family: tag36h11", "family: tag25h9");
  const ProgramRun run = RunOnIt({"--folds", "0", "--no-pictures"});
  EXPECT_THAT(run.err, HasSubstr("no image shows a tag of tags.yaml: check its family (tag25h9) and ids"));
}

TEST_F(Calibrate, SaysWhichImagesHaveNoRowInJointsCsv) {
  KeepImages(1);
  folder_.Write("session/images/new.png", "");
  const ProgramRun run = RunOnIt({"--no-pictures"});
  EXPECT_THAT(run.err,
              HasSubstr("legible: warning: 1 image of the session's folder without a row in joints.csv"));
  EXPECT_EQ(json::parse(Bytes(out() / "calibration.json")).at("images_left_out").at(0).at("name"), "new.png");
}

}  // namespace
}  // namespace legible
