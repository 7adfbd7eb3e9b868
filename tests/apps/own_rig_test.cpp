// `legible servo` and `legible capture` with a rig of a laboratory's own: one that is no simulation as far as
// the program knows, and whose clock goes on while the program computes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "apps/capture_command.h"
#include "apps/servo_command.h"
#include "datasets/csv_table.h"
#include "datasets/input_error.h"
#include "datasets/session_file.h"
#include "tests/apps/simulated_rigs.h"

namespace legible {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

// What its calls take of the rig's time.
struct CallTimes {
  double call_s = 0;  // each
  double first_image_s = 0;
};

class OwnRig : public Rig {
 public:
  OwnRig(std::unique_ptr<Rig> hidden, const CallTimes& times) : hidden_(std::move(hidden)), times_(times) {}

  double Now() override {
    Pass(times_.call_s);
    return hidden_->Now();
  }
  void WaitUntil(double time_s) override { hidden_->WaitUntil(time_s); }
  StampedImage Grab() override {
    StampedImage image = hidden_->Grab();
    Pass(times_.call_s + std::exchange(times_.first_image_s, 0));
    return image;
  }
  StampedReadings ReadJoints() override {
    StampedReadings readings = hidden_->ReadJoints();
    Pass(times_.call_s);
    return readings;
  }
  void CommandSpeeds(const Vector6d& speeds_m_per_s) override { hidden_->CommandSpeeds(speeds_m_per_s); }
  void Stop() noexcept override { hidden_->Stop(); }

 private:
  void Pass(double time_s) {
    if (time_s > 0) hidden_->WaitUntil(hidden_->Now() + time_s);
  }

  std::unique_ptr<Rig> hidden_;
  CallTimes times_;
};

class WithOwnRig : public RigOnDisk {
 protected:
  WithOwnRig() : RigOnDisk(640) {}

  // Without papers and without anything that only a simulation has.
  OpenedRig Open(const CallTimes& times = {}) const {
    OpenedRig simulated = OpenRig("sim:" + truth().string());
    OpenedRig opened;
    opened.rig = std::make_unique<OwnRig>(std::move(simulated.rig), times);
    opened.width_px = simulated.width_px;
    opened.height_px = simulated.height_px;
    return opened;
  }

  ServoSettings Servo() const {
    ServoSettings settings;
    settings.model = truth();
    settings.rig = "own";
    settings.goal.pose = (Vector6d() << 0.01, -0.005, 0.335, 0.03, -0.04, 0.05).finished();
    settings.log = folder_.path() / "log";
    return settings;
  }
  CaptureSettings Capture() const {
    CaptureSettings settings;
    settings.rig = "own";
    settings.robot = rig() / "robot.yaml";
    settings.camera = rig() / "camera.yaml";
    settings.out = session();
    return settings;
  }

  ProgramRun Run(const ServoSettings& settings, OpenedRig opened) const {
    std::ostringstream out, err;
    const int exit_code = RunServoCommand(settings, std::move(opened), {out, err, false});
    return {exit_code, out.str(), err.str()};
  }
  ProgramRun Run(const CaptureSettings& settings, OpenedRig opened) const {
    std::ostringstream out, err;
    const int exit_code = RunCapture(settings, std::move(opened), {out, err, false});
    return {exit_code, out.str(), err.str()};
  }
  // That nothing was written, and what it says.
  template <typename Settings>
  std::string Refusal(const Settings& settings) const {
    try {
      Run(settings, Open());
    } catch (const InputError& error) {
      EXPECT_FALSE(std::filesystem::exists(folder_.path() / "log"));
      EXPECT_FALSE(std::filesystem::exists(session()));
      return error.what();
    }
    return "none";
  }

  std::string Log(const std::string& name) const { return Bytes(folder_.path() / "log" / name); }
};

TEST_F(WithOwnRig, ServosByItsImagesAndSaysNothingThatOnlyASimulationKnows) {
  const ProgramRun run = Run(Servo(), Open());
  EXPECT_EQ(run.exit_code, kExitSuccess) << run.err;
  const json result = json::parse(Log("result.json"));
  EXPECT_EQ(result["status"], "converged");
  EXPECT_TRUE(result["final_pose_error"].is_null());
  EXPECT_LT(result["final_edge_error_px"].get<double>(), 0.2);
  const std::string cycles = Log("cycles.csv");
  const std::vector<CsvRow> rows = SplitCsv(cycles);
  ASSERT_EQ(rows.size(), result["iterations"].get<size_t>() + 1);
  int true_columns = 0;
  for (size_t column = 0; column < rows[0].fields.size(); ++column) {
    if (!rows[0].fields[column].starts_with("true_")) continue;
    ++true_columns;
    for (size_t row = 1; row < rows.size(); ++row) EXPECT_EQ(rows[row].fields[column], "");
  }
  EXPECT_EQ(true_columns, 6);
  const ProgramRun replay = RunLegible({"replay", folder_.path() / "log"});
  EXPECT_EQ(replay.exit_code, kExitSuccess) << replay.out << replay.err;
  EXPECT_THAT(replay.out, HasSubstr("the same commands, bit for bit"));
}

// The first look takes longer than an image may be old, as a search for all edges does.
TEST_F(WithOwnRig, ServosThoughItsClockGoesOnWhileTheProgramComputes) {
  const ProgramRun run = Run(Servo(), Open({.call_s = 0.002, .first_image_s = 0.3}));
  EXPECT_EQ(run.exit_code, kExitSuccess) << run.err;
  EXPECT_EQ(json::parse(Log("result.json"))["status"], "converged");
}

TEST_F(WithOwnRig, HoldsASession) {
  CaptureSettings settings = Capture();
  settings.poses = WritePoses(3);
  const ProgramRun run = Run(settings, Open({.call_s = 0.002}));
  EXPECT_EQ(run.exit_code, kExitSuccess) << run.err;
  const Session held = ReadSession(session());
  EXPECT_EQ(held.images.size(), 3u);
  EXPECT_FALSE(held.known.joint_reading_m) << "its papers do not say";
}

TEST_F(WithOwnRig, IsRefusedWhatOnlyASimulatedRigHas) {
  ServoSettings servo = Servo();
  servo.is_image_free = true;
  EXPECT_THAT(Refusal(servo), AllOf(HasSubstr("own: is no simulated rig"), HasSubstr("--image-free")));
  CaptureSettings capture = Capture();
  capture.robot.reset();
  EXPECT_THAT(Refusal(capture), AllOf(HasSubstr("own: has no drawing of the robot"), HasSubstr("--robot")));
  capture = Capture();
  capture.camera.reset();
  EXPECT_THAT(Refusal(capture), AllOf(HasSubstr("own: has no drawing of the camera"), HasSubstr("--camera")));
}

}  // namespace
}  // namespace legible
