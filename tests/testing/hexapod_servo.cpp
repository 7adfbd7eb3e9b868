#include "tests/testing/hexapod_servo.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <sstream>

#include "apps/program.h"
#include "datasets/camera_file.h"
#include "datasets/csv_table.h"
#include "datasets/robot_file.h"
#include "datasets/simulation_file.h"
#include "datasets/synthetic_session.h"

namespace legible {
namespace {

constexpr double kReach_m = 0.06, kTurn_rad = 0.4, kMargin_m = 3e-3;

Rigid3 DrawPose(const GoughStewart& robot, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (;;) {
    Vector6d step;
    for (double& coordinate : step) coordinate = uniform(random);
    step.head<3>() *= kReach_m;
    step.tail<3>() *= kTurn_rad;
    Rigid3 pose = Displaced(robot.home, step);
    if (KeepsMargin(robot, pose, kMargin_m)) return pose;
  }
}

std::string PoseOption(const Rigid3& pose) {
  const Eigen::Vector3d &t = pose.translation, w = VectorFromRotation(pose.rotation);
  return fmt::format("{} {} {} {} {} {}", t.x(), t.y(), t.z(), w.x(), w.y(), w.z());
}

std::string TextOf(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

// The true pose of the last cycle, when the robot has come to rest but for what noise commands.
Rigid3 LastTruePose(const std::filesystem::path& cycles_file) {
  const std::string text = TextOf(cycles_file);
  const std::vector<CsvRow> rows = SplitCsv(text);
  const auto value = [&](const std::string& column) {
    const auto& names = rows.front().fields;
    const auto at = static_cast<size_t>(std::find(names.begin(), names.end(), column) - names.begin());
    return std::stod(std::string(rows.back().fields.at(at)));
  };
  const Eigen::Vector3d rotation(value("true_rx_rad"), value("true_ry_rad"), value("true_rz_rad"));
  return {RotationFromVector(rotation), {value("true_x_m"), value("true_y_m"), value("true_z_m")}};
}

void TakeResult(const std::filesystem::path& log, ServoedHexapod& servoed) {
  const auto result = nlohmann::json::parse(TextOf(log / "result.json"));
  servoed.status = result.at("status");
  for (const int leg : result.at("legs")) servoed.legs.push_back(leg - 1);
  servoed.time_s = result.at("time_s");
  servoed.final_error = result.at("final_error");
  servoed.unit = result.at("unit");
  servoed.position_m = result.at("final_pose_error").at("position_m");
  servoed.rotation_rad = result.at("final_pose_error").at("rotation_rad");
  servoed.true_end = LastTruePose(log / "cycles.csv");
}

}  // namespace

SimulationTruth ShippedHexapod() {
  const std::filesystem::path folder = LEGIBLE_SOURCE_DIR "/datasets/hexapod";
  const CameraFile camera = ReadCamera(folder / "camera.yaml");
  return {ReadRobot(folder / "robot.yaml"), camera.camera, camera.camera_from_base.value()};
}

std::vector<HexapodWay> DrawHexapodWays(const GoughStewart& robot, int count) {
  std::mt19937 random(kHexapodWaysSeed);
  std::vector<HexapodWay> ways;
  for (int i = 0; i < count; ++i) {
    const Rigid3 from = DrawPose(robot, random);
    ways.push_back({from, DrawPose(robot, random)});
  }
  return ways;
}

bool KeepsMargin(const GoughStewart& robot, const Rigid3& base_from_platform, double margin_m) {
  const Vector6d readings_m = InverseKinematics(robot, base_from_platform);
  for (int i = 0; i < kLegCount; ++i) {
    const auto& range_m = robot.legs[static_cast<size_t>(i)].joint_range_m;
    if (readings_m[i] < range_m[0] + margin_m || readings_m[i] > range_m[1] - margin_m) return false;
  }
  return true;
}

ServoedHexapod ServoHexapod(const std::filesystem::path& folder, const HexapodWay& way,
                            const std::vector<std::string>& options) {
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  SimulatedTruth truth{ShippedHexapod(), {}, {}, {}};
  truth.options.start = way.from;
  truth.options.drives.reading_noise_m = SyntheticOptions().joint_reading_sigma_m;  // as `legible simulate`
  const std::filesystem::path rig = folder / "truth.yaml", log = folder / "log";
  WriteTruth(rig, truth);
  std::vector<std::string> arguments = {
      "servo", rig, "--rig", "sim:" + rig.string(), "--goal-pose", PoseOption(way.to), "--log", log};
  arguments.insert(arguments.end(), options.begin(), options.end());
  std::ostringstream out, err;
  ServoedHexapod servoed;
  servoed.exit_code = RunProgram(arguments, {out, err, false});
  servoed.said = err.str();
  if (std::filesystem::exists(log / "result.json")) TakeResult(log, servoed);
  return servoed;
}

std::vector<Eigen::Vector3d> WarnedPositions_m(const std::string& said) {
  static const std::regex kMode(R"(as they do at the goal at \((\S+), (\S+), (\S+)\) m)");
  std::vector<Eigen::Vector3d> positions_m;
  for (std::sregex_iterator it(said.begin(), said.end(), kMode), end; it != end; ++it)
    positions_m.emplace_back(std::stod((*it)[1]), std::stod((*it)[2]), std::stod((*it)[3]));
  return positions_m;
}

}  // namespace legible
