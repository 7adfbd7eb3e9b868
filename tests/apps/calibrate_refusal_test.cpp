// What `legible calibrate` refuses: one clear line, exit code 2, nothing written.
#include <fstream>

#include "tests/apps/program_fixture.h"

namespace legible {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

constexpr char kCameraPlace[] =
    "camera_from_base:          # by tape measure: about 3 cm and 3 deg\n"
    "  rotation_xyzw: [0.518849851, 0.550845912, -0.489188099, 0.433657257]\n"
    "  translation_m: [0.021, 0.156, 0.975]\n";

using CalibrateRefuses = HexapodSession;

TEST_F(CalibrateRefuses, AFolderThatDoesNotExist) {
  const std::string nowhere = (folder_.path() / "nowhere").string();
  ExpectRefusal(RunLegible({"calibrate", nowhere, "--out", out()}),
                StartsWith("legible: " + nowhere + ": is no folder; "));
}

TEST_F(CalibrateRefuses, ASessionWithoutRows) {
  KeepImages(0);
  ExpectRefusal(RunOnIt(), HasSubstr("joints.csv: no image"));
}

TEST_F(CalibrateRefuses, AnEmptyImageFolder) {
  for (const auto& image : std::filesystem::directory_iterator(images())) std::filesystem::remove(image);
  ExpectRefusal(RunOnIt(), HasSubstr("images: no image in this folder"));
}

TEST_F(CalibrateRefuses, ADamagedImageThatIsTheOnlyOne) {
  KeepImages(1);
  Truncate("000.png");
  ExpectRefusal(RunOnIt(), StartsWith("legible: " + (images() / "000.png").string() +
                                      ": is not an image, or damaged; "));
}

TEST_F(CalibrateRefuses, AColumnMissingInJointsCsv) {
  Edit("joints.csv", ",q6_m\n", "\n");
  ExpectRefusal(RunOnIt(), HasSubstr("joints.csv:1: column q6_m is missing"));
}

TEST_F(CalibrateRefuses, ANaNInJointsCsv) {
  Edit("joints.csv", "0.42782314", "nan");
  ExpectRefusal(RunOnIt(), HasSubstr("joints.csv:2: q2_m is \"nan\", not a finite number; "));
}

TEST_F(CalibrateRefuses, ImagesOfAnotherSizeThanTheCameras) {
  Edit("camera.yaml", "image_width: 1280", "image_width: 640");
  Edit("camera.yaml", "image_height: 960", "image_height: 480");
  ExpectRefusal(RunOnIt(), AllOf(StartsWith("legible: " + (images() / "000.png").string()),
                                 HasSubstr("1280 x 960"), HasSubstr("640 x 480"), HasSubstr("camera.yaml")));
}

TEST_F(CalibrateRefuses, AFocalLengthThatMakesNoSense) {
  Edit("camera.yaml", "[1250, 0, 639.5, 0, 1250,", "[100, 0, 639.5, 0, 100,");
  ExpectRefusal(RunOnIt(),
                AllOf(HasSubstr("camera.yaml:"), HasSubstr("has fx 100 px"), HasSubstr("; give ")));
}

TEST_F(CalibrateRefuses, ACameraThatCouldBeAnywhere) {
  Edit("camera.yaml", kCameraPlace, "");
  Edit("session.yaml", "tags: tags.yaml\n", "");
  ExpectRefusal(RunOnIt(), AllOf(HasSubstr("camera.yaml: does not say where the camera is"),
                                 HasSubstr("; give camera_from_base")));
}

TEST_F(CalibrateRefuses, AnOutputFolderThatCannotBeMade) {
  const std::string below_a_file = (session() / "robot.yaml" / "out").string();
  ExpectRefusal(RunLegible({"calibrate", session(), "--out", below_a_file}),
                AllOf(StartsWith("legible: " + below_a_file + ": cannot be written"), HasSubstr("--out")));
}

TEST_F(CalibrateRefuses, AnOutputFolderThatIsAFile) {
  ExpectRefusal(RunLegible({"calibrate", session(), "--out", session() / "robot.yaml"}),
                HasSubstr("cannot be written"));
}

TEST_F(CalibrateRefuses, BadInputWithoutTouchingEarlierResults) {
  folder_.Write("out/model.yaml", "of an earlier run");
  Edit("joints.csv", "0.42782314", "nan");
  EXPECT_EQ(RunOnIt().exit_code, kExitBadInput);
  EXPECT_EQ(Bytes(out() / "model.yaml"), "of an earlier run");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(out()), {}), 1);
}

TEST_F(CalibrateRefuses, BadUsageNamingTheOptionAndTheHelp) {
  const std::string help = "; see `legible calibrate --help`\n";
  const auto refused = [&](const std::vector<std::string>& options, const std::string& what) {
    ExpectRefusal(RunOnIt(options), AllOf(HasSubstr(what), EndsWith(help)));
  };
  refused({"--fold", "3"}, "unknown option --fold;");
  refused({"another-session"}, "unexpected argument another-session");
  refused({"--format", "xml"}, "--format: \"xml\" is none of table, json");
  refused({"--lens", "plumb_bob"},
          "--lens: \"plumb_bob\" is none of pinhole, brown-conrady, rational, fisheye");
  refused({"--hold", "radii,wheels"}, "--hold: \"wheels\" is none of focal-length, ");
  refused({"--known", "radius=0.1"}, "--known: \"radius\" is none of ");
  refused({"--known", "radius_m=-1"}, "--known: radius_m is \"-1\"");
  refused({"--known", "radius_m"}, "--known: \"radius_m\" has no value");
  refused({"--known", "radius_m=1e-300"}, "--known: radius_m is \"1e-300\", which is neither a number from ");
  for (const char* folds : {"1", "few", "-2", "3.5"})
    refused({"--folds", folds}, "--folds: give 0, or a whole number from 2");
  for (const char* seed : {"-1", "1.5", "99999999999999999999"})
    refused({"--seed", seed}, "--seed: give a whole number of at most 9 digits");
  refused({"--out", ""}, "--out: name a folder");
  refused({"--threads", "0"}, "--threads");
  for (const std::string of_board : {"--board-warp", "--all-corners"})
    refused({of_board}, of_board + " requires --with-board");
}

TEST_F(CalibrateRefuses, AFolderWhereAResultIsToBeWritten) {
  std::filesystem::create_directories(out() / "report.html");
  const ProgramRun run = RunOnIt();
  EXPECT_EQ(run.exit_code, kExitBadInput);
  EXPECT_THAT(run.err, HasSubstr("report.html: is a folder where a file is to be written"));
}

TEST_F(CalibrateRefuses, AKnowledgeThatIsNone) {
  Edit("session.yaml", "radius_m: 5.0e-4", "radius_m: 1.0e-30");
  ExpectRefusal(RunOnIt(), HasSubstr("session.yaml:"));
}

TEST_F(CalibrateRefuses, TagsThatTheSessionDoesNotHave) {
  ExpectRefusal(RunOnIt({"--tags", "bord"}),
                HasSubstr("\"bord\" is none of the session's groups base_board, platform_tag"));
  ExpectRefusal(RunOnIt({"--tags", "platform_tag", "--free-legs"}),
                HasSubstr("\"platform_tag\" is on the platform"));
}

TEST_F(CalibrateRefuses, ToRunWithoutASession) {
  ExpectRefusal(RunLegible({"calibrate"}), HasSubstr("SESSION is required; see `legible calibrate --help`"));
}

TEST(Program, NamesACommandThatItDoesNotHave) {
  const ProgramRun run = RunLegible({"bogus"});
  EXPECT_EQ(run.exit_code, kExitBadInput);
  EXPECT_EQ(run.err, "legible: unknown command bogus; see `legible --help`\n");
}

TEST(Program, SaysWhenItsOutputCannotBeWritten) {
  std::ofstream full("/dev/full");
  std::ostringstream err;
  EXPECT_EQ(RunProgram({"--help"}, {full, err, false}), kExitNoResult);
  EXPECT_EQ(err.str(), "legible: standard output cannot be written\n");
}

TEST(Program, RefusesToRunWithoutACommand) {
  const ProgramRun run = RunLegible({});
  EXPECT_EQ(run.exit_code, kExitBadInput);
  EXPECT_EQ(run.err, "legible: A subcommand is required; see `legible --help`\n");
}

TEST(Program, PrintsItsVersion) {
  const ProgramRun run = RunLegible({"--version"});
  EXPECT_EQ(run.exit_code, kExitSuccess);
  EXPECT_EQ(run.out, std::string("legible ") + ProgramVersion() + "\n");
  EXPECT_EQ(run.err, "");
}

TEST(Program, HelpListsTheCommands) { EXPECT_THAT(RunLegible({"--help"}).out, HasSubstr("\n  calibrate ")); }

TEST(Program, HelpOfCalibrateTeachesFilesExitCodesAndAnExample) {
  const ProgramRun run = RunLegible({"calibrate", "--help"});
  EXPECT_EQ(run.exit_code, kExitSuccess);
  for (const char* part :
       {"session.yaml", "joints.csv", "model.yaml", "report.html", "Exit codes",
        "Examples:", "legible calibrate datasets/hexapod", "--known NAME=SIGMA", "--free-legs"})
    EXPECT_THAT(run.out, HasSubstr(part));
}

}  // namespace
}  // namespace legible
