// How long the kinematics and the lens model take: every control step and every residual pays for them.
#include <benchmark/benchmark.h>

#include <array>
#include <numbers>
#include <random>

#include "core/geometry/camera.h"
#include "core/robots/gough_stewart.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

constexpr size_t kCases = 256;  // enough that no branch predictor learns them

struct Solve {
  Rigid3 guess;
  Vector6d joint_readings_m;
};

// A displacement by the given lengths in random directions.
Vector6d RandomDisplacement(std::mt19937_64& generator, double translation_m, double rotation_rad) {
  Vector6d displacement;
  displacement << translation_m * UniformVector(generator, -1, 1).normalized(),
      rotation_rad * UniformVector(generator, -1, 1).normalized();
  return displacement;
}

// Poses about the robot's home, each with a guess 2 cm and 5 degrees away.
std::array<Solve, kCases> RandomSolves(std::mt19937_64& generator, const GoughStewart& robot) {
  std::array<Solve, kCases> solves;
  for (Solve& solve : solves) {
    const Rigid3 pose = Displaced(robot.home, RandomDisplacement(generator, 0.05, 0.2));
    solve.joint_readings_m = InverseKinematics(robot, pose);
    solve.guess = Displaced(pose, RandomDisplacement(generator, 0.02, 5 * std::numbers::pi / 180));
  }
  return solves;
}

void BM_ForwardKinematics(benchmark::State& state) {
  std::mt19937_64 generator(1);
  const GoughStewart robot = DesktopHexapod(generator, 0.002);
  const std::array<Solve, kCases> solves = RandomSolves(generator, robot);
  size_t i = 0;
  double iterations = 0;
  while (state.KeepRunning()) {
    const Solve& solve = solves[i++ % kCases];
    const ForwardKinematicsResult result = ForwardKinematics(robot, solve.joint_readings_m, solve.guess);
    if (result.status != ForwardKinematicsStatus::kConverged) state.SkipWithError(ToString(result.status));
    iterations += result.iterations;
  }
  state.counters["newton_steps"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
}
BENCHMARK(BM_ForwardKinematics);

void BM_InverseKinematics(benchmark::State& state) {
  std::mt19937_64 generator(1);
  const GoughStewart robot = DesktopHexapod(generator, 0.002);
  const std::array<Solve, kCases> solves = RandomSolves(generator, robot);
  size_t i = 0;
  while (state.KeepRunning()) benchmark::DoNotOptimize(InverseKinematics(robot, solves[i++ % kCases].guess));
}
BENCHMARK(BM_InverseKinematics);

void BM_Undistort(benchmark::State& state, LensModel lens, const Distortion& distortion) {
  std::mt19937_64 generator(1);
  std::array<Eigen::Vector2d, kCases> points;
  for (Eigen::Vector2d& point : points) {
    point = Distort<double>(lens, distortion, UniformVector(generator, -0.5, 0.5).head<2>());
  }
  size_t i = 0;
  while (state.KeepRunning()) benchmark::DoNotOptimize(Undistort(lens, distortion, points[i++ % kCases]));
}
BENCHMARK_CAPTURE(BM_Undistort, brown_conrady, LensModel::kBrownConrady,
                  (Distortion() << -0.25, 0.09, 0.0008, -0.0006, -0.01, 0, 0, 0).finished());
BENCHMARK_CAPTURE(BM_Undistort, rational, LensModel::kRational,
                  (Distortion() << 0.6, 0.04, 0.0008, -0.0006, 0.002, 0.9, 0.1, 0.005).finished());
BENCHMARK_CAPTURE(BM_Undistort, fisheye, LensModel::kFisheye,
                  (Distortion() << -0.05, 0.02, -0.01, 0.003, 0, 0, 0, 0).finished());

}  // namespace
}  // namespace legible
