// `legible servo` and `legible replay` run in process on simulated rigs.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <random>

#include "apps/servo_log.h"
#include "core/hidden/assembly_modes.h"
#include "core/rig/scene_camera.h"
#include "core/robots/mechanism.h"
#include "datasets/camera_file.h"
#include "datasets/model_file.h"
#include "datasets/robot_file.h"
#include "datasets/simulation_file.h"
#include "datasets/synthetic_session.h"
#include "tests/apps/program_fixture.h"

namespace legible {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kGoal = "0.01 -0.005 0.335 0.03 -0.04 0.05";

Camera Halved(Camera camera) {
  for (double* length : {&camera.fx_px, &camera.fy_px}) *length /= 2;
  for (double* place : {&camera.cx_px, &camera.cy_px}) *place = (*place + 0.5) / 2 - 0.5;
  camera.width_px /= 2;
  camera.height_px /= 2;
  return camera;
}

// A folder with a rig's truth, its exact model, and its drawing.
class ServoCommand : public testing::Test {
 protected:
  ServoCommand() {
    SyntheticOptions options;
    options.image_count = 1;
    session_ = GenerateSession(options);
    truth_.truth = {session_.true_robot, Halved(session_.true_camera), session_.true_camera_from_base};
    CalibratedModel model;
    model.robot = session_.true_robot;
    model.camera = truth_.truth.camera;
    model.camera_from_base = session_.true_camera_from_base;
    WriteModel(Path("model.yaml"), model);
    WriteRobot(Path("robot.yaml"), session_.nominal_robot);
    WriteCamera(Path("camera.yaml"), Halved(session_.nominal_camera), session_.nominal_camera_from_base);
    Rig({});
  }

  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }

  // The rig from now on.
  void Rig(const std::vector<Fault>& faults) {
    truth_.options.faults = faults;
    WriteTruth(Path("truth.yaml"), truth_);
  }

  std::vector<std::string> Command(const std::vector<std::string>& options) const {
    std::vector<std::string> arguments = {"servo", Path("model.yaml"), "--rig", "sim:" + Path("truth.yaml"),
                                          "--log", Path("log")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return arguments;
  }
  ProgramRun Servo(const std::vector<std::string>& options) const { return RunLegible(Command(options)); }
  ProgramRun ServoToGoal(std::vector<std::string> options) const {
    options.insert(options.end(), {"--goal-pose", kGoal});
    return Servo(options);
  }
  ProgramRun ServoImageFree(std::vector<std::string> options = {}) const {
    options.emplace_back("--image-free");
    return ServoToGoal(options);
  }
  json Result() const { return json::parse(Bytes(folder_.path() / "log" / "result.json")); }
  ProgramRun Replay() const { return RunLegible({"replay", Path("log")}); }

  // A goal, as the command takes it, that legs 1, 2 and 3 share with another pose within the joint ranges,
  // and that.
  std::pair<std::string, std::optional<Rigid3>> GoalWithAnotherMode() const {
    const GoughStewart& robot = session_.true_robot;
    const ParallelRobot general = ParallelRobotOf(robot);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int i = 0; i < 5000; ++i) {
      Vector6d step;
      for (double& coordinate : step) coordinate = uniform(random);
      step.head<3>() *= 0.05;
      step.tail<3>() *= 0.5;
      const Rigid3 goal = Displaced(robot.home, step);
      if (!IsReachable(robot, goal)) continue;
      for (const AssemblyMode& mode : AssemblyModesOf(general, {0, 1, 2}, goal).modes) {
        if (Displacement(goal, mode.base_from_platform).norm() < 1e-3) continue;
        if (!IsReachable(robot, mode.base_from_platform)) continue;
        const Eigen::Vector3d w = VectorFromRotation(goal.rotation), &t = goal.translation;
        return {fmt::format("{} {} {} {} {} {}", t.x(), t.y(), t.z(), w.x(), w.y(), w.z()),
                mode.base_from_platform};
      }
    }
    return {};
  }

  void ExpectReplaysBitForBit() const {
    const ProgramRun run = Replay();
    EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
    EXPECT_THAT(run.out, HasSubstr("the same commands, bit for bit"));
  }

  // Exit code 2, one line that `line` matches, nothing written.
  void ExpectRefusal(const ProgramRun& run, const testing::Matcher<const std::string&>& line) const {
    EXPECT_EQ(run.exit_code, kExitBadInput) << run.out;
    EXPECT_THAT(run.err, AllOf(StartsWith("legible: "), line));
    EXPECT_EQ(run.err.find('\n'), run.err.size() - 1) << "not one line: " << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "log"));
  }

  TemporaryFolder folder_;
  SyntheticSession session_;
  SimulatedTruth truth_;
};

TEST_F(ServoCommand, ConvergesAndSaysSoInItsResult) {
  const ProgramRun run = ServoImageFree({"--format", "json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out, Bytes(folder_.path() / "log" / "result.json"));
  const json result = Result();
  EXPECT_EQ(result["status"], "converged");
  EXPECT_NE(result["reason"].get<std::string>(), "");
  EXPECT_GT(result["iterations"].get<int>(), 10);
  EXPECT_NEAR(result["time_s"].get<double>(), 0.02 * (result["iterations"].get<int>() - 1), 1e-9);
  EXPECT_LT(result["final_edge_error_px"].get<double>(), 0.2);
  EXPECT_GT(result["final_direction_error_rad"].get<double>(), 0);  // as noisy as short legs' directions are
  EXPECT_LT(result["final_pose_error"]["position_m"].get<double>(), 1e-3);
  EXPECT_LT(result["final_pose_error"]["rotation_rad"].get<double>(), 3e-3);
  EXPECT_GT(result["max_joint_speed_m_per_s"].get<double>(), 0);
  EXPECT_LE(result["max_joint_speed_m_per_s"].get<double>(), truth_.options.drives.speed_limit_m_per_s);
  EXPECT_GT(result["min_singular_value"].get<double>(), 0);
  EXPECT_GT(result["compute_time_s"]["median"].get<double>(), 0);
  EXPECT_GE(result["compute_time_s"]["p99"].get<double>(), result["compute_time_s"]["median"].get<double>());
  for (const char* name : {"setup.json", "cycles.csv", "edges.csv", "report.html"})
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / "log" / name)) << name;
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "log" / "frames"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "log" / "unfinished-1"));
}

TEST_F(ServoCommand, EveryModeConvergesAndReplaysBitForBit) {
  for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{
           {"--mode", "edges"},
           {"--mode", "directions"},
           {"--mode", "pose"},
           {"--mode", "pose", "--pose-from", "edges"},
           {"--mode", "joints"},
           {"--mode", "edges", "--directions-from", "edges", "--unweighted"},
           {"--mode", "edges", "--gain", "6:2:300", "--damping", "1e-4"}}) {
    const ProgramRun run = ServoImageFree(options);
    EXPECT_EQ(run.exit_code, 0) << testing::PrintToString(options) << run.err;
    EXPECT_EQ(Result()["mode"], options[1]);
    ExpectReplaysBitForBit();
  }
}

TEST_F(ServoCommand, LooksAtTheLegsThatItIsToldOnly) {
  ServoImageFree({"--legs", "1,2,3,5", "--least-conditioning", "1e-5"});
  EXPECT_EQ(Result()["legs"], json({1, 2, 3, 5}));
  ExpectReplaysBitForBit();
}

TEST_F(ServoCommand, ChoosesLegsThatLeadToTheGoal) {
  const ProgramRun run = ServoImageFree({"--legs", "auto"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_GE(Result()["legs"].size(), 3U);
  EXPECT_EQ(Result()["status"], "converged");
  ExpectReplaysBitForBit();
}

// A goal at which legs 1, 2, 3 point as they do at another pose within the joint ranges, found by search.
TEST_F(ServoCommand, WarnsBeforeItMovesOfEveryPoseThatItMayEndInInstead) {
  const auto [goal, other] = GoalWithAnotherMode();
  ASSERT_TRUE(other.has_value());
  const ProgramRun run = Servo({"--image-free", "--legs", "1,2,3", "--timeout", "0.2", "--goal-pose", goal});
  EXPECT_THAT(run.err, StartsWith("legible: warning: legs 1,2,3 point as they do at the goal at ("));
  EXPECT_THAT(run.err, HasSubstr("the servo may end there"));
}

TEST_F(ServoCommand, StopsForAFaultSaysWhyAndReplaysThatToo) {
  const std::vector<std::pair<FaultKind, std::string>> cases = {
      {FaultKind::kReadingsNan, "bad-readings"},   {FaultKind::kReadingsFrozen, "frozen-readings"},
      {FaultKind::kFramesDropped, "stale-images"}, {FaultKind::kFramesLate, "stale-images"},
      {FaultKind::kFramesFrozen, "frozen-images"}, {FaultKind::kLinkLost, "link-lost"}};
  for (const auto& [kind, status] : cases) {
    Rig({Fault{kind, 0.3}});
    const ProgramRun run = ServoImageFree();
    EXPECT_EQ(run.exit_code, kExitNoResult) << status;
    const json result = Result();
    EXPECT_EQ(result["status"], status);
    EXPECT_EQ(run.err, "legible: stopped: " + result["reason"].get<std::string>() + "\n");
    if (kind != FaultKind::kLinkLost) ExpectReplaysBitForBit();
  }
}

TEST_F(ServoCommand, RefusesWhatItCannotUnderstandInOneLine) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--mode", "edge"}, "none of edges, directions, pose, joints"},
      {{"--pose-from", "nothing"}, "neither readings nor edges"},
      {{"--directions-from", "nothing"}, "neither edges nor model"},
      {{"--legs", "1,7"}, "is no leg"},
      {{"--legs", "1,1"}, "named twice"},
      {{"--gain", "1:2"}, "neither a gain nor"},
      {{"--gain", "-1"}, "not more than 0"},
      {{"--damping", "0"}, "not more than 0"},
      {{"--truncation", "x"}, "not a finite number"},
      {{"--least-conditioning", "0"}, "not more than 0"},
      {{"--speed-limit", "0"}, "not more than 0"},
      {{"--range-margin", "nan"}, "not a finite number"},
      {{"--timeout", "-3"}, "not more than 0"},
      {{"--period", "0"}, "not more than 0"},
      {{"--tolerance", "0"}, "not more than 0"},
      {{"--format", "xml"}, "xml"},
      {{"--goal-joints", "1 2 3 4 5 6"}, "give one goal"},
      {{"--goal-pose", "0 0 0.3"}, ""},
      {{"--nonsense"}, "nonsense"}};
  for (const auto& [options, words] : cases) {
    SCOPED_TRACE(testing::PrintToString(options));
    ExpectRefusal(ServoImageFree(options), HasSubstr(words));
  }
  ExpectRefusal(Servo({}), HasSubstr("no goal"));
  ExpectRefusal(Servo({"--goal-pose", "0 0 0.3 0 0"}), HasSubstr("5 numbers"));
}

TEST_F(ServoCommand, RefusesGoalsModelsAndRigsThatDoNotGoTogether) {
  ExpectRefusal(Servo({"--image-free", "--goal-pose", "0 0 2 0 0 0"}), HasSubstr("the goal is out of reach"));
  ExpectRefusal(Servo({"--image-free", "--goal-joints", "9 9 9 9 9 9"}), HasSubstr("out of reach"));
  const auto with = [&](const std::string& model, const std::string& rig,
                        const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"servo",     model,         "--rig", rig,           "--log",
                                          Path("log"), "--goal-pose", kGoal,   "--image-free"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunLegible(arguments);
  };
  const std::string rig = "sim:" + Path("truth.yaml");
  ExpectRefusal(with(Path("robot.yaml"), rig, {}), HasSubstr("has no camera"));
  ExpectRefusal(with(Path("missing.yaml"), rig, {}), HasSubstr("missing.yaml"));
  ExpectRefusal(with(Path("model.yaml"), "real:robot", {}), HasSubstr("is no rig that is known here"));
  ExpectRefusal(with(Path("model.yaml"), "sim:" + Path("missing.yaml"), {}), HasSubstr("missing.yaml"));
  WriteCamera(Path("large.yaml"), session_.nominal_camera, session_.nominal_camera_from_base);
  ExpectRefusal(with(Path("robot.yaml"), rig, {"--camera", Path("large.yaml")}), HasSubstr("1280 x 960"));
  WriteCamera(Path("nowhere.yaml"), Halved(session_.nominal_camera));
  ExpectRefusal(with(Path("robot.yaml"), rig, {"--camera", Path("nowhere.yaml")}),
                HasSubstr("does not say where the camera is"));
  folder_.Write("file", "");
  EXPECT_EQ(RunLegible({"servo", Path("model.yaml"), "--rig", rig, "--image-free", "--goal-pose", kGoal,
                        "--log", Path("file/log")})
                .exit_code,
            kExitBadInput);
}

TEST_F(ServoCommand, LeavesAForeignFolderOfFramesAlone) {
  folder_.Write("elsewhere/frames/mine.txt", "mine");
  const ProgramRun run = RunLegible({"servo", Path("model.yaml"), "--rig", "sim:" + Path("truth.yaml"),
                                     "--image-free", "--goal-pose", kGoal, "--log", Path("elsewhere")});
  EXPECT_EQ(run.exit_code, kExitBadInput);
  EXPECT_EQ(Bytes(folder_.path() / "elsewhere/frames/mine.txt"), "mine");
}

TEST_F(ServoCommand, TheLogReadsBackWhatHappened) {
  ServoImageFree();
  const RecordedServo recorded = ReadServoLog(folder_.path() / "log");
  EXPECT_EQ(static_cast<int>(recorded.cycles.size()), Result()["iterations"].get<int>());
  EXPECT_EQ(recorded.setup.period_s, 0.02);
  ASSERT_FALSE(recorded.cycles.empty());
  EXPECT_EQ(recorded.cycles.back().end, "converged");
  double fastest = 0;
  for (size_t i = 0; i < recorded.cycles.size(); ++i) {
    EXPECT_NEAR(recorded.cycles[i].input.time_s, 0.02 * static_cast<double>(i), 1e-12);
    EXPECT_GE(recorded.cycles[i].input.seen.edges.size(), 10u);
    fastest = std::max(fastest, recorded.cycles[i].joint_speeds_m_per_s.cwiseAbs().maxCoeff());
  }
  EXPECT_EQ(fastest, Result()["max_joint_speed_m_per_s"].get<double>());
}

// The value of a column in one row of a table, and the text with another one there.
std::string WithChangedField(const std::string& text, const std::string& column, size_t row,
                             const std::string& value) {
  std::istringstream lines(text);
  std::string line, changed;
  std::ptrdiff_t place = -1;
  for (size_t at = 0; std::getline(lines, line);) {
    if (!line.empty() && line[0] != '#') {
      std::vector<std::string> fields;
      std::istringstream parts(line);
      for (std::string field; std::getline(parts, field, ',');) fields.push_back(field);
      if (line.back() == ',') fields.emplace_back();
      if (place < 0) {
        place = std::find(fields.begin(), fields.end(), column) - fields.begin();
      } else if (at++ == row) {
        fields.at(static_cast<size_t>(place)) = value;
        line = fields[0];
        for (size_t i = 1; i < fields.size(); ++i) line += "," + fields[i];
      }
    }
    changed += line + "\n";
  }
  return changed;
}

TEST_F(ServoCommand, ReplayFindsWhatWasChangedInALog) {
  ServoImageFree();
  const std::string cycles = Bytes(folder_.path() / "log/cycles.csv");
  const std::string edges = Bytes(folder_.path() / "log/edges.csv");
  for (const std::string column : {"v3_m_per_s", "q2_m"}) {
    folder_.Write("log/cycles.csv", WithChangedField(cycles, column, 5, "0.3333"));
    const ProgramRun run = Replay();
    EXPECT_EQ(run.exit_code, kExitNoResult) << column;
    EXPECT_THAT(run.out, HasSubstr("the first in cycle 5"));
    EXPECT_THAT(run.err, HasSubstr("other speeds than the log has"));
  }
  folder_.Write("log/cycles.csv", cycles);
  folder_.Write("log/edges.csv", WithChangedField(edges, "n_x", 30, "0.5"));
  EXPECT_EQ(Replay().exit_code, kExitNoResult);
}

TEST_F(ServoCommand, ReplayRefusesADamagedLogNamingFileAndLine) {
  ServoImageFree();
  const auto expect_refusal = [&](const std::string& file, const std::string& text,
                                  const std::string& words) {
    const std::string intact = Bytes(folder_.path() / "log" / file);
    folder_.Write("log/" + file, text);
    const ProgramRun run = Replay();
    EXPECT_EQ(run.exit_code, kExitBadInput) << words;
    EXPECT_THAT(run.err, AllOf(StartsWith("legible: " + Path("log/" + file)), HasSubstr(words)));
    EXPECT_EQ(run.out, "");
    folder_.Write("log/" + file, intact);
  };
  const std::string cycles = Bytes(folder_.path() / "log/cycles.csv");
  const std::string edges = Bytes(folder_.path() / "log/edges.csv");
  const std::string setup = Bytes(folder_.path() / "log/setup.json");
  expect_refusal("cycles.csv", WithChangedField(cycles, "q2_m", 3, "much"), "\"much\" is no number");
  expect_refusal("cycles.csv", WithChangedField(cycles, "cycle", 3, "7"), "cycle 3 is missing");
  expect_refusal("cycles.csv", cycles.substr(0, cycles.size() / 2), "cycles.csv:");
  expect_refusal("edges.csv", WithChangedField(edges, "leg", 3, "9"), "not there");
  expect_refusal("edges.csv", WithChangedField(edges, "edge", 3, "1.5"), "not there");
  expect_refusal("setup.json", setup.substr(0, setup.size() / 2), "is no set-up of a servo");
  expect_refusal("setup.json", Replaced(setup, "\"schema\": 2", "\"schema\": 99"), "knows schema 2");
  ExpectReplaysBitForBit();
  EXPECT_EQ(RunLegible({"replay", Path("nowhere")}).exit_code, kExitBadInput);
}

// As a kill may leave it.
TEST_F(ServoCommand, ReplaysALogThatIsCutOffAsFarAsItIsWhole) {
  ServoImageFree();
  std::filesystem::remove(folder_.path() / "log/result.json");
  const std::string cycles = Bytes(folder_.path() / "log/cycles.csv");
  const size_t count = ReadServoLog(folder_.path() / "log").cycles.size();
  EXPECT_THAT(Replay().out,
              HasSubstr(fmt::format("cut off: no result.json; {} cycles were replayed\n", count)));
  ExpectReplaysBitForBit();
  folder_.Write("log/cycles.csv", cycles.substr(0, cycles.size() - 30));
  EXPECT_THAT(Replay().out, HasSubstr(fmt::format(
                                "{} cycles were replayed, what was half written was left out", count - 1)));
  ExpectReplaysBitForBit();
  const json comparison = json::parse(RunLegible({"replay", Path("log"), "--format", "json"}).out);
  EXPECT_EQ(comparison["cut_off"], true);
  EXPECT_TRUE(comparison["recorded_status"].is_null());
  folder_.Write("log/cycles.csv", WithChangedField(cycles, "v3_m_per_s", 5, "0.3333"));
  EXPECT_EQ(Replay().exit_code, kExitNoResult);
}

// --- With images.

TEST_F(ServoCommand, FollowsEdgesInImagesKeepsThemAndReplays) {
  const ProgramRun run = ServoToGoal({"--keep-images"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const json result = Result();
  EXPECT_LT(result["final_pose_error"]["position_m"].get<double>(), 1e-3);
  size_t frames = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / "log" / "frames")) {
    const auto image = ReadGrayImage(entry.path());
    ASSERT_TRUE(image) << entry.path();
    EXPECT_EQ(image->width, 640);
    ++frames;
  }
  EXPECT_EQ(static_cast<int>(frames), result["iterations"].get<int>());
  ExpectReplaysBitForBit();
}

// As people open it.
TEST_F(ServoCommand, TheReportOfARunShowsAllNumbersInABrowser) {
  ServoImageFree();
  const std::string command = std::string(LEGIBLE_NODE) + " " + LEGIBLE_PAGE_TESTS +
                              "/servo_page.browser.js " + Path("log/report.html") + " >" +
                              Path("browser.txt") + " 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << Bytes(Path("browser.txt"));
}

// Teach by showing: by the drawing and a guessed camera, at a goal far from home.
TEST_F(ServoCommand, LeadsToAGoalThatIsKnownByItsImageAlone) {
  Vector6d way;
  way << 0.03, -0.02, 0.03, 0.12, -0.08, 0.1;
  const Rigid3 goal = Displaced(truth_.truth.robot.home, way);
  const SceneCamera scene(truth_.truth, truth_.options.scene, 77);
  folder_.Write("goal.png", EncodePng(scene.Take(goal, {}, 5)));
  const ProgramRun run =
      RunLegible({"servo", Path("robot.yaml"), "--camera", Path("camera.yaml"), "--rig",
                  "sim:" + Path("truth.yaml"), "--log", Path("log"), "--goal-image", Path("goal.png")});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(Result()["status"], "converged");
  const RecordedServo recorded = ReadServoLog(folder_.path() / "log");
  // The rig's true readings at the goal, up to what half a pixel is.
  const Vector6d off_m =
      recorded.cycles.back().input.readings.joint_readings_m - InverseKinematics(truth_.truth.robot, goal);
  EXPECT_LT(off_m.cwiseAbs().maxCoeff(), 1e-3);
}

TEST_F(ServoCommand, RefusesAGoalImageThatShowsNoRobot) {
  const GrayImage gray{640, 480, std::vector<std::uint8_t>(640 * 480, 90)};
  folder_.Write("gray.png", EncodePng(gray));
  ExpectRefusal(Servo({"--goal-image", Path("gray.png")}), HasSubstr("shows no robot"));
  folder_.Write("small.png", EncodePng({64, 48, std::vector<std::uint8_t>(64 * 48, 90)}));
  ExpectRefusal(Servo({"--goal-image", Path("small.png")}), HasSubstr("64 x 48 px"));
  folder_.Write("broken.png", "no image");
  ExpectRefusal(Servo({"--goal-image", Path("broken.png")}), HasSubstr("is not an image"));
}

}  // namespace
}  // namespace legible
