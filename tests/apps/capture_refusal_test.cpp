// What `legible capture` and `legible simulate` refuse: one clear line, exit code 2, nothing written.
#include "datasets/camera_file.h"
#include "datasets/robot_file.h"
#include "tests/apps/simulated_rigs.h"

namespace legible {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

class CaptureRefuses : public RigOnDisk {
 protected:
  CaptureRefuses() : RigOnDisk(64) {}

  void ExpectRefusal(const ProgramRun& run, const testing::Matcher<const std::string&>& line) const {
    EXPECT_EQ(run.exit_code, kExitBadInput);
    EXPECT_THAT(run.err, line);
    EXPECT_THAT(run.err, StartsWith("legible: "));
    EXPECT_EQ(run.err.find('\n'), run.err.size() - 1) << "not one line: " << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_FALSE(std::filesystem::exists(session() / "session.yaml"));
    for (const std::string& name : folder_.Names()) EXPECT_THAT(name, testing::Not(EndsWith(".part")));
  }
};

TEST_F(CaptureRefuses, ARigThatIsNone) {
  const auto capture = [&](const std::string& rig) {
    return RunLegible({"capture", "--rig", rig, "--out", session().string()});
  };
  ExpectRefusal(capture("tcp:robot"), HasSubstr("tcp:robot: is no rig that is known here; give sim:TRUTH"));
  ExpectRefusal(capture("sim:" + (rig() / "nowhere.yaml").string()), HasSubstr("nowhere.yaml"));
  ExpectRefusal(capture("sim:" + (rig() / "robot.yaml").string()), HasSubstr("has no \"camera\""));
}

TEST_F(CaptureRefuses, AFolderThatHoldsSomethingElse) {
  folder_.Write("session/notes.txt", "mine");
  ExpectRefusal(Capture({}), HasSubstr("session: is there already, and is no session; name another folder"));
  ExpectRefusal(Capture({"--resume"}), HasSubstr("session: is there already, and is no session"));
}

TEST_F(CaptureRefuses, ACameraOfAnotherSizeOrWithoutItsPlace) {
  WriteCamera(rig() / "other.yaml", DesktopCamera(false), Rigid3());
  ExpectRefusal(Capture({"--camera", rig() / "other.yaml"}),
                HasSubstr("other.yaml: has a camera of 1280 x 960 px, and the rig one of 64 x 48"));
  WriteCamera(rig() / "other.yaml", ReadCamera(rig() / "camera.yaml").camera);
  ExpectRefusal(Capture({"--camera", rig() / "other.yaml"}),
                HasSubstr("other.yaml: does not say where the camera is"));
}

TEST_F(CaptureRefuses, ADrawingThatIsNotThere) {
  ExpectRefusal(Capture({"--robot", rig() / "nowhere.yaml"}), HasSubstr("nowhere.yaml"));
}

TEST_F(CaptureRefuses, PosesThatCannotBeTakenNamingTheirLine) {
  const auto refused = [&](const std::string& row, const std::string& what) {
    const auto file =
        folder_.Write("poses.csv", "name,x,y,z,rx,ry,rz\nfine,0,0,0.32,0,0,0\n# a remark\n" + row + "\n");
    ExpectRefusal(Capture({"--poses", file}), HasSubstr("poses.csv:4: " + what));
  };
  refused("far,0,0,0.9,0,0,0", "pose \"far\" is out of reach: leg 1 would read 0.");
  refused("a/b,0,0,0.32,0,0,0", "pose \"a/b\" gives no file name for its image; name it by letters");
  refused("odd,0,0,nan,0,0,0", "z is \"nan\", not a finite number");
  ExpectRefusal(Capture({"--poses", folder_.path() / "nowhere.csv"}), HasSubstr("nowhere.csv"));
}

TEST_F(CaptureRefuses, BadUsageNamingTheOptionAndTheHelp) {
  const std::string help = "; see `legible capture --help`\n";
  const auto refused = [&](const std::vector<std::string>& options, const std::string& what) {
    ExpectRefusal(Capture(options), AllOf(HasSubstr(what), EndsWith(help)));
  };
  refused({"--poses", WritePoses(2), "--count", "3"}, "--count");
  refused({"--count", "0"}, "--count: give a whole number from 1");
  refused({"--until", "-1"}, "--until: -1 is not more than 0");
  refused({"--speed-limit", "fast"}, "--speed-limit: \"fast\" is not a finite number");
  refused({"--known", "radius=1"}, "--known: \"radius\" is none of");
  refused({"--format", "xml"}, "--format: \"xml\" is none of table, json");
  refused({"--seed", "-1"}, "--seed");
  refused({"--photo"}, "unknown option --photo");
  ExpectRefusal(RunLegible({"capture", "--rig", "sim:x"}), HasSubstr("--out is required"));
  ExpectRefusal(RunLegible({"capture", "--out", "x"}), HasSubstr("--rig is required"));
}

TEST(Program, HelpOfCaptureTeachesPosesResumingAndExitCodes) {
  const ProgramRun run = RunLegible({"capture", "--help"});
  EXPECT_EQ(run.exit_code, kExitSuccess);
  for (const char* part : {"sim:TRUTH", "--poses FILE", "--until SIGMA", "--resume", "Exit codes",
                           "Examples:", "legible capture --rig sim:rig/truth.yaml", "camera_from_base"})
    EXPECT_THAT(run.out, HasSubstr(part));
}

class SimulateRefuses : public CaptureRefuses {
 protected:
  ProgramRun Simulate(std::vector<std::string> options) const {
    options.insert(options.begin(), {"simulate", "--out", session().string()});
    return RunLegible(options);
  }
};

TEST_F(SimulateRefuses, AFolderThatHoldsSomethingElse) {
  folder_.Write("session/images/000.png", "of a session that somebody held");
  ExpectRefusal(Simulate({"--images", "0"}), HasSubstr("session: is there already, and is no simulation's"));
  EXPECT_EQ(Bytes(session() / "images" / "000.png"), "of a session that somebody held");
}

TEST_F(SimulateRefuses, FilesThatAreNoRig) {
  ExpectRefusal(Simulate({folder_.path() / "nowhere.yaml"}), HasSubstr("nowhere.yaml"));
  ExpectRefusal(Simulate({rig() / "robot.yaml"}), HasSubstr("has no \"camera\""));
  ExpectRefusal(Simulate({"--robot", rig() / "camera.yaml"}), HasSubstr("camera.yaml"));
}

TEST_F(SimulateRefuses, ErrorsThatLeaveNoRobot) {
  ExpectRefusal(Simulate({"--radius-error", "0.02"}), HasSubstr("radius_m of each leg must be greater"));
  ExpectRefusal(Simulate({"--offset-error", "1"}), HasSubstr("cannot take its home pose"));
}

TEST_F(SimulateRefuses, BadUsage) {
  const std::string help = "; see `legible simulate --help`\n";
  const auto refused = [&](const std::vector<std::string>& options, const std::string& what) {
    ExpectRefusal(Simulate(options), AllOf(HasSubstr(what), EndsWith(help)));
  };
  refused({truth(), "--geometry-error", "0.001"}, "--geometry-error");
  refused({truth(), "--robot", rig() / "robot.yaml"}, "--robot");
  refused({"--geometry-error", "-1"}, "--geometry-error: -1 is less than 0");
  refused({"--images", "many"}, "--images");
  refused({"--width", "3"}, "--width");
  ExpectRefusal(RunLegible({"simulate"}), HasSubstr("--out is required"));
}

}  // namespace
}  // namespace legible
