#include "tests/testing/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <numbers>
#include <string>

namespace legible {
namespace {

// The FNV-1a hash of the running test's name: other values in every test, the same in every run.
uint64_t SeedOfRunningTest() {
  const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
  if (test == nullptr) return 1;
  uint64_t seed = 0xcbf29ce484222325;
  for (const char c : std::string(test->test_suite_name()) + "." + test->name()) {
    seed = (seed ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  }
  return seed;
}

Eigen::Vector3d OnCircle(double radius_m, double angle_rad) {
  return {radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), 0};
}

}  // namespace

std::mt19937_64 TestGenerator() {
  const char* wanted = std::getenv("LEGIBLE_TEST_SEED");
  const uint64_t seed = wanted != nullptr ? std::stoull(wanted) : SeedOfRunningTest();
  std::cout << "seed " << seed << std::endl;
  return std::mt19937_64(seed);
}

double Uniform(std::mt19937_64& generator, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(generator);
}

Eigen::Vector3d UniformVector(std::mt19937_64& generator, double low, double high) {
  Eigen::Vector3d vector;
  for (double& coordinate : vector) coordinate = Uniform(generator, low, high);
  return vector;
}

Eigen::Quaterniond UniformRotation(std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  Eigen::Quaterniond rotation;
  for (double& coefficient : rotation.coeffs()) coefficient = normal(generator);
  return rotation.normalized();
}

GoughStewart DesktopHexapod(std::mt19937_64& generator, double perturbation_m) {
  constexpr double kBaseRadius_m = 0.27, kPlatformRadius_m = 0.195;
  constexpr double kAlpha_rad = 0.0742, kBeta_rad = 0.1027;
  GoughStewart robot;
  robot.name = "desktop hexapod";
  robot.home.translation = {0, 0, 0.3124};
  for (int i = 0; i < kLegCount; ++i) {
    const int pair = i / 2;
    const double pair_rad = 2 * std::numbers::pi / 3 * pair;
    const double side = i % 2 == 0 ? 1 : -1;
    Leg& leg = robot.legs[i];
    leg.base_joint_m = OnCircle(kBaseRadius_m, pair_rad + side * kAlpha_rad) +
                       UniformVector(generator, -perturbation_m, perturbation_m);
    leg.platform_joint_m = OnCircle(kPlatformRadius_m, pair_rad + side * (std::numbers::pi / 3 - kBeta_rad)) +
                           UniformVector(generator, -perturbation_m, perturbation_m);
    leg.radius_m = 0.01;
    leg.joint_range_m = {0.345, 0.485};
  }
  return robot;
}

}  // namespace legible
