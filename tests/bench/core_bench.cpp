// How long the kinematics and the lens model take: every control step and every residual pays for them; and
// how long all assembly modes take, certified.
#include <benchmark/benchmark.h>

#include <array>
#include <numbers>
#include <random>
#include <vector>

#include "core/algebra/three_quadrics.h"
#include "core/geometry/camera.h"
#include "core/hidden/assembly_modes.h"
#include "core/robots/gough_stewart.h"
#include "core/robots/gough_stewart_assembly_modes.h"
#include "tests/testing/random.h"
#include "tests/testing/random_robots.h"

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

// The hidden 3-UPS robot's equations are such a system, and a pair of a Quattro's legs leaves one.
void BM_AllRootsOfThreeQuadrics(benchmark::State& state) {
  std::mt19937_64 generator(1);
  std::vector<QuadricSystem> systems;
  for (size_t i = 0; i < kCases; ++i) {
    std::vector<ComplexBallMatrix> matrices;
    for (int k = 0; k < 3; ++k) {
      Eigen::Matrix4d matrix;
      for (double& coefficient : matrix.reshaped()) coefficient = Uniform(generator, -1, 1);
      matrices.emplace_back(matrix.cast<RealBall>().cast<ComplexBall>());
    }
    systems.emplace_back(matrices);
  }
  size_t i = 0;
  double complete = 0;
  while (state.KeepRunning()) complete += AllRoots(systems[i++ % kCases]).is_complete ? 1 : 0;
  state.counters["complete"] = benchmark::Counter(complete, benchmark::Counter::kAvgIterations);
}
BENCHMARK(BM_AllRootsOfThreeQuadrics)->Unit(benchmark::kMillisecond);

// Of the hidden robot: from the legs' directions at a pose to certified modes.
void BM_AssemblyModes(benchmark::State& state, RobotAtPose (*make)(std::mt19937_64&),
                      const std::vector<int>& legs) {
  std::mt19937_64 generator(1);
  std::vector<RobotAtPose> robots;
  for (size_t i = 0; i < kCases; ++i) robots.push_back(make(generator));
  size_t i = 0;
  double complete = 0;
  while (state.KeepRunning()) {
    const RobotAtPose& it = robots[i++ % kCases];
    complete += AssemblyModesOf(it.robot, legs, it.pose).status == AssemblyModesStatus::kComplete ? 1 : 0;
  }
  state.counters["complete"] = benchmark::Counter(complete, benchmark::Counter::kAvgIterations);
}
RobotAtPose LikeAQuattro(std::mt19937_64& generator) {
  return RandomSchoenfliesRobot(generator, "_R-{2-US}");
}
RobotAtPose LikeAHexapod(std::mt19937_64& generator) {
  return RandomSpatialRobot(generator, std::vector<std::string>(6, "U_PS"));
}
RobotAtPose OnSixArms(std::mt19937_64& generator) {
  return RandomSpatialRobot(generator, std::vector<std::string>(6, "_RUS"));
}
RobotAtPose WithThreePlanarArms(std::mt19937_64& generator) {
  return RandomPlanarRobot(generator, std::vector<std::string>(3, "_RRR"));
}
BENCHMARK_CAPTURE(BM_AssemblyModes, quattro_pair, LikeAQuattro, {0, 2})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_AssemblyModes, three_ups, LikeAHexapod, {0, 1, 2})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_AssemblyModes, three_rus, OnSixArms, {0, 1, 2})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_AssemblyModes, three_pi_rr, WithThreePlanarArms, {0, 1, 2})
    ->Unit(benchmark::kMillisecond);

// Perturbed by nothing, 12 of its 40 paths leave for infinity.
void BM_AllAssemblyModes(benchmark::State& state, double perturbation_m) {
  std::mt19937_64 generator(1);
  const GoughStewart robot = DesktopHexapod(generator, perturbation_m);
  const std::array<Solve, kCases> solves = RandomSolves(generator, robot);
  benchmark::DoNotOptimize(
      AllAssemblyModes(robot, solves[0].joint_readings_m));  // prepares the paths' starts
  size_t i = 0;
  double certified = 0;
  while (state.KeepRunning())
    certified += AllAssemblyModes(robot, solves[i++ % kCases].joint_readings_m).certified;
  state.counters["certified"] = benchmark::Counter(certified, benchmark::Counter::kAvgIterations);
}
BENCHMARK_CAPTURE(BM_AllAssemblyModes, symmetric, 0.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_AllAssemblyModes, built, 0.002)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_AllAssemblyModes, general, 0.2)->Unit(benchmark::kMillisecond);

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
