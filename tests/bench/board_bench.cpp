// A real camera with a wide lens: from nothing, and from a start 2 % off beside mrcal in the same run.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "calib/board/board_calibration.h"
#include "core/stopwatch.h"
#include "datasets/board_file.h"
#include "datasets/corner_file.h"
#include "tests/bench/bench_table.h"

namespace legible {
namespace {

constexpr int kRepetitions = 7;
constexpr double kOff = 1.02;  // focal lengths, coefficients and distances of the start

struct Problem {
  Board board;
  BoardCalibrationInput input;
};

Problem ReadProblem() {
  const std::filesystem::path folder = std::filesystem::path(LEGIBLE_SOURCE_DIR) / "datasets/wide-lens";
  Problem problem{ReadBoard(folder / "board.yaml"), {}};
  problem.input = {PointsOf(problem.board), {}, 6016, 4016};
  for (ReadView& read : ReadCorners(folder / "corners.csv", problem.board, true))
    problem.input.views.push_back(std::move(read.view));
  return problem;
}

BoardCalibration Off(BoardCalibration start) {
  start.camera.fx_px *= kOff;
  start.camera.fy_px *= kOff;
  start.camera.distortion *= kOff;
  for (ViewFit& view : start.views) view.camera_from_board.translation *= kOff;
  return start;
}

// mrcal's board has its first corner as origin and y down.
nlohmann::json FrameJson(const Rigid3& camera_from_board, const Eigen::Vector3d& first_corner) {
  const Eigen::Quaterniond down(0, 1, 0, 0);
  const Eigen::Vector3d turn = VectorFromRotation(camera_from_board.rotation * down);
  const Eigen::Vector3d origin = camera_from_board * first_corner;
  return {turn.x(), turn.y(), turn.z(), origin.x(), origin.y(), origin.z()};
}

void WriteForMrcal(const std::filesystem::path& file, const Problem& problem, const BoardCalibration& start) {
  const Chessboard& board = problem.board.chessboard.value();
  const CameraParameters intrinsics = ParametersOf(start.camera);
  nlohmann::json json = {{"columns", board.columns},
                         {"rows", board.rows},
                         {"spacing_m", board.column_step_m},
                         {"size", {problem.input.width_px, problem.input.height_px}},
                         {"repetitions", kRepetitions},
                         {"intrinsics", std::vector<double>(intrinsics.begin(), intrinsics.end())},
                         {"frames", nlohmann::json::array()},
                         {"corners", nlohmann::json::array()}};
  for (size_t i = 0; i < problem.input.views.size(); ++i) {
    json["frames"].push_back(
        FrameJson(start.views[i].camera_from_board, problem.input.points_in_board_m.front()));
    for (const BoardCorner& corner : problem.input.views[i].corners)
      json["corners"].push_back({i, corner.point % board.columns, corner.point / board.columns,
                                 corner.pixel.x(), corner.pixel.y()});
  }
  std::ofstream(file) << json;
}

// What mrcal_optimize.py prints; null where there is no mrcal.
nlohmann::json RunMrcal(const Problem& problem, const BoardCalibration& start) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / fmt::format("legible-board-bench-{}.json", getpid());
  WriteForMrcal(file, problem, start);
  const std::string command =
      fmt::format("/usr/bin/python3 '{}/tests/bench/mrcal_optimize.py' '{}' 2>/dev/null", LEGIBLE_SOURCE_DIR,
                  file.string());
  std::string text;
  if (std::unique_ptr<FILE, int (*)(FILE*)> pipe{popen(command.c_str(), "r"), pclose}) {
    char buffer[256];
    while (std::fgets(buffer, sizeof buffer, pipe.get()) != nullptr) text += buffer;
  }
  std::filesystem::remove(file);
  return nlohmann::json::parse(text, nullptr, false);
}

double MedianSeconds(const Problem& problem, const BoardCalibration& start,
                     const BoardCalibrationOptions& options) {
  std::vector<double> seconds;
  seconds.reserve(kRepetitions);
  for (int i = 0; i < kRepetitions; ++i)
    seconds.push_back(RefineCamera(problem.input, start, options).seconds);
  std::nth_element(seconds.begin(), seconds.begin() + kRepetitions / 2, seconds.end());
  return seconds[kRepetitions / 2];
}

BenchTable WideLens() {
  const Problem problem = ReadProblem();
  const BoardCalibrationOptions options{.lens = LensModel::kRational, .trusts_all = true};
  BenchTable table{"186 views x 100 corners of a wide lens, 8 coefficients", {}};
  const BoardCalibration found = CalibrateCamera(problem.input, options);
  table.rows.push_back({"from no guess, one thread",
                        {{"median_s", found.seconds},
                         {"fx_px", found.camera.fx_px},
                         {"rms_px", found.rms_px},
                         {"ratio_to_mrcal", std::nan("")}}});
  const BoardCalibration start = Off(found), again = RefineCamera(problem.input, start, options);
  const double ours_s = MedianSeconds(problem, start, options);
  const nlohmann::json mrcal = RunMrcal(problem, start);
  const bool has_mrcal = mrcal.is_object();
  const double mrcal_s = has_mrcal ? mrcal.at("median_s").get<double>() : std::nan("");
  table.rows.push_back({"from 2 % off, one thread",
                        {{"median_s", ours_s},
                         {"fx_px", again.camera.fx_px},
                         {"rms_px", again.rms_px},
                         {"ratio_to_mrcal", ours_s / mrcal_s}}});
  if (has_mrcal)
    table.rows.push_back({"mrcal.optimize from the same start",
                          {{"median_s", mrcal_s},
                           {"fx_px", mrcal.at("fx").get<double>()},
                           {"rms_px", mrcal.at("rms_px").get<double>()},
                           {"ratio_to_mrcal", 1}}});
  return table;
}

}  // namespace
}  // namespace legible

int main(int argc, char** argv) { return legible::Report({legible::WideLens()}, argc, argv); }
