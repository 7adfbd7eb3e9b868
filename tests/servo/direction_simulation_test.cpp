#include "servo/direction_simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "core/hidden/assembly_modes.h"
#include "core/hidden/cone_noise.h"
#include "core/hidden/singularity_conditions.h"
#include "core/robots/leg_state.h"
#include "core/robots/platform_motion.h"
#include "datasets/parallel_robot_file.h"
#include "tests/testing/random.h"
#include "tests/testing/random_robots.h"

namespace legible {
namespace {

struct Case {
  RobotAtPose random;
  std::vector<int> legs;
};

// Of hidden robots that are far from singular.
std::vector<Case> Cases(std::mt19937_64& generator) {
  const auto spatial = [&](int count, const char* chain) {
    return RandomSpatialRobot(generator, std::vector<std::string>(static_cast<size_t>(count), chain));
  };
  std::vector<Case> cases = {
      {RandomPlanarRobot(generator, {"_RRR", "R_PR"}), {0, 1}},
      {RandomPlanarRobot(generator, {"_RRR", "_PRR", "_RRR"}), {0, 1, 2}},
      {spatial(6, "U_PS"), {0, 2, 4}},
      {spatial(6, "U_PS"), {0, 1, 2, 3, 4, 5}},
      {spatial(6, "_RUS"), {0, 2, 4}},
      {spatial(3, "R_PS"), {0, 1, 2}},
      {RandomTranslationRobot(generator, {"_R-{2-US}", "_R-{2-US}", "_R-{2-US}"}), {0, 1}},
      {RandomSchoenfliesRobot(generator, "_R-{2-US}"), {0, 3}},
      {RandomSchoenfliesRobot(generator, "_R-{2-US}"), {0, 1, 2, 3}}};
  std::erase_if(cases, [](const Case& it) {
    return Type2MeasureOf(it.random.robot, RobotKind::kHidden, it.legs, it.random.pose)->matrix < 0.03;
  });
  return cases;
}

double ErrorAt(const DirectionServoRun& run, double time_s) {
  for (const DirectionServoSample& sample : run.samples) {
    if (sample.time_s < time_s) continue;
    double sum = 0;
    for (const double error : sample.errors_rad) sum += error * error;
    return std::sqrt(sum);
  }
  return 0;
}

TEST(DirectionServo, ConvergesExponentiallyWithTheGain) {
  std::mt19937_64 generator = TestGenerator();
  std::mt19937 no_noise(0);
  int runs = 0;
  for (int n = 0; n < 10; ++n)
    for (const Case& it : Cases(generator)) {
      SCOPED_TRACE(it.random.robot.name + " of " + std::to_string(it.legs.size()));
      DirectionServoOptions options;
      options.gain_per_s = Uniform(generator, 0.5, 1.5);
      const Rigid3 from = RandomPoseNear(generator, it.random.robot, it.random.pose, 2e-3);
      const DirectionServoRun run =
          SimulateDirectionServo(it.random.robot, it.legs, from, it.random.pose, options, no_noise);
      EXPECT_EQ(run.end, DirectionServoEnd::kConverged);
      EXPECT_LT(Displacement(run.samples.back().base_from_platform, it.random.pose).norm(), 1e-5);
      for (const double error : run.samples.back().errors_rad) EXPECT_LT(error, options.converged_rad);
      const double early_s = 1 / options.gain_per_s, late_s = 5 / options.gain_per_s;
      const double rate_per_s = std::log(ErrorAt(run, early_s) / ErrorAt(run, late_s)) / (late_s - early_s);
      EXPECT_NEAR(rate_per_s, options.gain_per_s, 0.02 * options.gain_per_s);
      ++runs;
    }
  EXPECT_GT(runs, 40);
}

TEST(DirectionServo, KeepsToWhatThePlatformCanDo) {
  std::mt19937_64 generator = TestGenerator();
  std::mt19937 no_noise(0);
  for (const Case& it : Cases(generator)) {
    const Rigid3 from = RandomPoseNear(generator, it.random.robot, it.random.pose, 0.02);
    const DirectionServoRun run =
        SimulateDirectionServo(it.random.robot, it.legs, from, it.random.pose, {}, no_noise);
    for (const DirectionServoSample& sample : run.samples)
      EXPECT_TRUE(CanTake(it.random.robot, sample.base_from_platform)) << it.random.robot.name;
  }
}

// Three legs of a hexapod, from near another assembly mode of the hidden robot: it is that mode where all
// errors vanish, not the goal (section 3.3, point 2).
TEST(DirectionServo, OfThreeLegsMayEndInAnotherAssemblyModeWithAllErrorsZero) {
  std::mt19937_64 generator = TestGenerator();
  std::mt19937 no_noise(0);
  const std::vector<int> legs = {0, 2, 4};
  int misled = 0;
  for (int n = 0; n < 30; ++n) {
    const RobotAtPose random = RandomSpatialRobot(generator, std::vector<std::string>(6, "U_PS"));
    const AssemblyModes found = AssemblyModesOf(random.robot, legs, random.pose);
    for (size_t i = 1; i < found.modes.size(); ++i) {
      const Rigid3& other = found.modes[i].base_from_platform;
      if (Type2MeasureOf(random.robot, RobotKind::kHidden, legs, other)->matrix < 0.03) continue;
      const Rigid3 from = RandomPoseNear(generator, random.robot, other, 1e-3);
      const DirectionServoRun run =
          SimulateDirectionServo(random.robot, legs, from, random.pose, {}, no_noise);
      EXPECT_EQ(run.end, DirectionServoEnd::kConverged);
      EXPECT_LT(Displacement(run.samples.back().base_from_platform, other).norm(), 1e-5);
      ++misled;
    }
  }
  EXPECT_GT(misled, 10);
}

// The pose follows the noise as a mean of what single views would ask for: it cannot be farther off than one.
TEST(DirectionServo, WithNoiseStaysWithinTheLargestErrorByConeNoise) {
  std::mt19937_64 generator = TestGenerator();
  std::mt19937 noise(1);
  for (const Case& it : Cases(generator)) {
    SCOPED_TRACE(it.random.robot.name + " of " + std::to_string(it.legs.size()));
    DirectionServoOptions options;
    options.cone_half_angle_rad = 1e-5;
    options.longest_s = 10;
    const DirectionServoRun run =
        SimulateDirectionServo(it.random.robot, it.legs, it.random.pose, it.random.pose, options, noise);
    EXPECT_EQ(run.end, DirectionServoEnd::kTimeUp);
    EXPECT_NEAR(run.samples.back().time_s, 10, options.step_s);
    const auto largest = LargestErrorByConeNoise(it.random.robot, it.legs, it.random.pose, 1e-5).value();
    double farthest_m = 0;
    for (const DirectionServoSample& sample : run.samples) {
      const Vector6d off = Displacement(it.random.pose, sample.base_from_platform);
      farthest_m = std::max(farthest_m, off.head<3>().norm());
      EXPECT_LT(off.tail<3>().norm(), 1.01 * largest.rotation_rad + 1e-12);
    }
    EXPECT_LT(farthest_m, 1.01 * largest.position_m);
    EXPECT_GT(farthest_m, 0.01 * largest.position_m);
  }
}

TEST(DirectionServo, ReportsTheTrueErrorsOfTheLegsAskedFor) {
  std::mt19937_64 generator = TestGenerator();
  std::mt19937 noise(1);
  const RobotAtPose random = RandomSpatialRobot(generator, std::vector<std::string>(6, "U_PS"));
  const Rigid3 from = RandomPoseNear(generator, random.robot, random.pose, 0.02);
  DirectionServoOptions options;
  options.cone_half_angle_rad = 1e-3;
  options.longest_s = 0.1;
  const std::vector<int> legs = {4, 0, 2};
  for (const auto& sample :
       SimulateDirectionServo(random.robot, legs, from, random.pose, options, noise).samples) {
    ASSERT_EQ(sample.errors_rad.size(), 3);
    for (size_t k = 0; k < 3; ++k) {
      const RobotLeg& leg = random.robot.legs[static_cast<size_t>(legs[k])];
      const auto direction = [&](const Rigid3& pose) {
        return (pose * leg.platform_joint_m - leg.base_joint_m).normalized().eval();
      };
      EXPECT_NEAR(sample.errors_rad[k],
                  direction(sample.base_from_platform).cross(direction(random.pose)).norm(), 1e-14);
    }
  }
}

const std::vector<int> kQuattroLegs = {0, 1, 2, 3};

ParallelRobot ShippedQuattro() {
  return ReadParallelRobot(LEGIBLE_SOURCE_DIR "/datasets/robots/quattro.yaml");
}

Rigid3 At(double x_m, double y_m, double z_m) { return {Eigen::Quaterniond::Identity(), {x_m, y_m, z_m}}; }

DirectionServoRun QuattroServo(const ParallelRobot& robot, const Rigid3& from, const Rigid3& to) {
  std::mt19937 no_noise(0);
  return SimulateDirectionServo(robot, kQuattroLegs, from, to, {}, no_noise);
}

// All u x u*, one after the other.
Eigen::VectorXd ErrorsAt(const ParallelRobot& robot, const Rigid3& pose, const Rigid3& goal) {
  Eigen::VectorXd errors(12);
  const auto here = StatesOf(robot, kQuattroLegs, pose).value();
  const auto there = StatesOf(robot, kQuattroLegs, goal).value();
  for (size_t k = 0; k < 4; ++k)
    errors.segment<3>(static_cast<Eigen::Index>(3 * k)) = here[k].direction.cross(there[k].direction);
  return errors;
}

// The least-squares step on the errors, their derivative by differences: zero where the sum of their squares
// is least among the poses around.
double LeastSquaresStep(const ParallelRobot& robot, const Rigid3& pose, const Rigid3& goal) {
  constexpr double kDifference = 1e-6;
  const auto basis = MotionBasis(robot, pose);
  Eigen::MatrixXd rates(12, basis.cols());
  for (Eigen::Index k = 0; k < basis.cols(); ++k)
    rates.col(k) = (ErrorsAt(robot, Displaced(pose, kDifference * basis.col(k)), goal) -
                    ErrorsAt(robot, Displaced(pose, -kDifference * basis.col(k)), goal)) /
                   (2 * kDifference);
  return rates.colPivHouseholderQr().solve(ErrorsAt(robot, pose, goal)).norm();
}

// How far C is from where its leg, an arm that turns in a plane and a rod, is stretched or folded.
double ToBoundary_m(const RobotLeg& leg, const Rigid3& pose) {
  const Eigen::Vector3d c_m = pose * leg.platform_joint_m + leg.carried_offset_m - leg.base_joint_m;
  const double height_m = leg.first_axis.dot(c_m);
  const double in_plane_m = (c_m - height_m * leg.first_axis).norm();
  const double rod_in_plane_m = std::sqrt(leg.rod_m * leg.rod_m - height_m * height_m);
  return std::min(std::abs(in_plane_m - (leg.arm_m + rod_in_plane_m)),
                  std::abs(in_plane_m - std::abs(leg.arm_m - rod_in_plane_m)));
}
double ToBoundary_m(const ParallelRobot& robot, const Rigid3& pose) {
  double least_m = 1;
  for (const RobotLeg& leg : robot.legs) least_m = std::min(least_m, ToBoundary_m(leg, pose));
  return least_m;
}

void ExpectLocalMinimum(const ParallelRobot& robot, const DirectionServoRun& run, const Rigid3& goal) {
  const DirectionServoSample& last = run.samples.back();
  EXPECT_GT(*std::max_element(last.errors_rad.begin(), last.errors_rad.end()), 1e-4);
  EXPECT_LT(LeastSquaresStep(robot, last.base_from_platform, goal), 1e-6);
}

void ExpectBoundary(const ParallelRobot& robot, const DirectionServoRun& run) {
  const DirectionServoSample& last = run.samples.back();
  EXPECT_GT(*std::max_element(last.errors_rad.begin(), last.errors_rad.end()), 1e-4);
  EXPECT_LT(ToBoundary_m(robot, last.base_from_platform), 1e-6);
}

// With more legs than the platform needs the errors can lie in the kernel of L^+ (docs/reproduction.md).
TEST(DirectionServo, OfAllLegsOfAQuattroMayStandInALocalMinimum) {
  const ParallelRobot robot = ShippedQuattro();
  const Rigid3 goal = At(-0.020, -0.055, -0.719);
  const DirectionServoRun run = QuattroServo(robot, At(0.355, 0.084, -0.541), goal);
  EXPECT_EQ(run.end, DirectionServoEnd::kLocalMinimum);
  EXPECT_STREQ(ToString(run.end), "local-minimum");
  ExpectLocalMinimum(robot, run, goal);
}

// A leg is stretched before the others are where they should be.
TEST(DirectionServo, OfAllLegsOfAQuattroMayEndAtTheBoundaryOfALeg) {
  const ParallelRobot robot = ShippedQuattro();
  const DirectionServoRun run = QuattroServo(robot, At(-0.495, 0.294, -0.649), At(0.601, -0.446, -0.636));
  EXPECT_EQ(run.end, DirectionServoEnd::kAtBoundary);
  EXPECT_STREQ(ToString(run.end), "at-boundary");
  ExpectBoundary(robot, run);
}

TEST(DirectionServo, EndsForTheReasonThatItNames) {
  std::mt19937_64 generator = TestGenerator();
  const ParallelRobot robot = ShippedQuattro();
  const auto draw = [&]() -> std::optional<Rigid3> {
    const Eigen::Vector3d p = UniformVector(generator, -1, 1).cwiseProduct(Eigen::Vector3d(0.65, 0.65, 0.3));
    const Rigid3 pose = At(p.x(), p.y(), p.z() - 0.75);
    if (!StatesOf(robot, kQuattroLegs, pose)) return std::nullopt;
    return pose;
  };
  int minima = 0, boundaries = 0;
  for (int n = 0; n < 600; ++n) {
    const auto from = draw(), to = draw();
    if (!from || !to) continue;
    const DirectionServoRun run = QuattroServo(robot, *from, *to);
    if (run.end == DirectionServoEnd::kLocalMinimum) {
      ExpectLocalMinimum(robot, run, *to);
      ++minima;
    } else if (run.end == DirectionServoEnd::kAtBoundary) {
      ExpectBoundary(robot, run);
      ++boundaries;
    } else if (run.end == DirectionServoEnd::kConverged) {
      EXPECT_LT(ErrorsAt(robot, run.samples.back().base_from_platform, *to).norm(), 2 * 1e-7);
    }
  }
  EXPECT_GT(minima, 0);
  EXPECT_GT(boundaries, 0);
}

TEST(DirectionServo, RefusesAStartOrGoalOutOfReach) {
  std::mt19937_64 generator = TestGenerator();
  std::mt19937 no_noise(0);
  const RobotAtPose random = RandomTranslationRobot(generator, {"_R-{2-US}", "_R-{2-US}", "_R-{2-US}"});
  Rigid3 far = random.pose;
  far.translation.z() -= 5;
  EXPECT_THROW(SimulateDirectionServo(random.robot, {0, 1}, far, random.pose, {}, no_noise),
               std::invalid_argument);
  EXPECT_THROW(SimulateDirectionServo(random.robot, {0, 1}, random.pose, far, {}, no_noise),
               std::invalid_argument);
}

}  // namespace
}  // namespace legible
