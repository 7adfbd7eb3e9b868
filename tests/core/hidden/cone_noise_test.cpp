#include "core/hidden/cone_noise.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <numbers>

#include "core/hidden/seen_features.h"
#include "core/robots/platform_motion.h"
#include "tests/testing/random.h"
#include "tests/testing/random_robots.h"

namespace legible {
namespace {

constexpr double kHalfAngle_rad = 1e-3;

// Errors of the seen directions, one below the other, and the twists that follow from them.
class ConeNoise {
 public:
  ConeNoise(const RobotAtPose& random, const std::vector<int>& legs) {
    for (const int leg : legs)
      directions_.push_back(StateOf(random.robot.legs[static_cast<size_t>(leg)], random.pose)->direction);
    const auto basis = MotionBasis(random.robot, random.pose);
    const Eigen::MatrixXd rows =
        *FeatureInteraction(random.robot, legs, random.pose, SeenFeature::kDirections) * basis;
    twists_ = basis * rows.completeOrthogonalDecomposition().pseudoInverse();
  }

  // On the boundary of each leg's disc.
  Eigen::VectorXd RandomErrors(std::mt19937_64& generator) const {
    Eigen::VectorXd errors(twists_.cols());
    for (size_t i = 0; i < directions_.size(); ++i)
      errors.segment<3>(static_cast<Eigen::Index>(3 * i)) =
          kHalfAngle_rad * RandomDirectionAcross(generator, directions_[i]);
    return errors;
  }

  // Three rows of the twist: 0 for the position's, 3 for the rotation's.
  Eigen::Vector3d Part(const Eigen::VectorXd& errors, Eigen::Index row) const {
    return twists_.middleRows<3>(row) * errors;
  }

  // Turns each leg's error, the others' kept, to where it moves the platform most the way that it moves.
  double AfterLocalMaximisation(Eigen::VectorXd errors, Eigen::Index row) const {
    for (int sweep = 0; sweep < 500; ++sweep) {
      const Eigen::VectorXd uphill = twists_.middleRows<3>(row).transpose() * Part(errors, row);
      for (size_t i = 0; i < directions_.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(3 * i);
        const Eigen::Vector3d gradient = uphill.segment<3>(at);
        const Eigen::Vector3d across = gradient - directions_[i] * directions_[i].dot(gradient);
        if (across.norm() > 0) errors.segment<3>(at) = kHalfAngle_rad * across.normalized();
      }
    }
    return Part(errors, row).norm();
  }

 private:
  std::vector<Eigen::Vector3d> directions_;
  Eigen::MatrixXd twists_;
};

struct Case {
  RobotAtPose random;
  std::vector<int> legs;
};

std::vector<Case> Cases(std::mt19937_64& generator) {
  return {{RandomSpatialRobot(generator, std::vector<std::string>(6, "U_PS")), {0, 2, 4}},
          {RandomSpatialRobot(generator, std::vector<std::string>(6, "U_PS")), {0, 1, 2, 3, 4, 5}},
          {RandomSpatialRobot(generator, {"R_PS", "R_PS", "R_PS"}), {0, 1, 2}},
          {RandomSchoenfliesRobot(generator, "_R-{2-US}"), {1, 2}},
          {RandomSchoenfliesRobot(generator, "_R-{2-US}"), {0, 1, 2, 3}},
          {RandomTranslationRobot(generator, {"_R-{2-US}", "_R-{2-US}", "_R-{2-US}"}), {0, 2}},
          {RandomPlanarRobot(generator, {"_RRR", "_RRR", "_RRR"}), {0, 1, 2}}};
}

// The true maximum lies between the largest found by brute force and one part in 1000 over what is returned.
TEST(LargestErrorByConeNoise, IsThatOfBruteForce) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 10; ++n)
    for (const Case& it : Cases(generator)) {
      SCOPED_TRACE(it.random.robot.name + " of " + std::to_string(it.legs.size()));
      const ConeNoise noise(it.random, it.legs);
      const auto found =
          LargestErrorByConeNoise(it.random.robot, it.legs, it.random.pose, kHalfAngle_rad).value();
      double largest_position_m = 0, largest_rotation_rad = 0;
      for (int start = 0; start < 1000; ++start) {
        const Eigen::VectorXd errors = noise.RandomErrors(generator);
        EXPECT_LE(noise.Part(errors, 0).norm(), 1.001 * found.position_m + 1e-15);
        EXPECT_LE(noise.Part(errors, 3).norm(), 1.001 * found.rotation_rad + 1e-15);
        if (start >= 20) continue;
        largest_position_m = std::max(largest_position_m, noise.AfterLocalMaximisation(errors, 0));
        largest_rotation_rad = std::max(largest_rotation_rad, noise.AfterLocalMaximisation(errors, 3));
      }
      EXPECT_NEAR(largest_position_m, found.position_m, 2e-3 * found.position_m);
      EXPECT_NEAR(largest_rotation_rad, found.rotation_rad, 2e-3 * found.rotation_rad + 1e-15);
    }
}

// Two legs that extend, at an angle a to each other: their ends move by L1 e1 and L2 e2 across them, so the
// point where they meet by (L1^2 + L2^2 + 2 L1 L2 |cos a|)^(1/2) / sin a times the angle, at most.
TEST(LargestErrorByConeNoise, OfTwoLegsInAPlaneIsThatOfTriangulation) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 100; ++n) {
    const RobotAtPose random = RandomPlanarRobot(generator, {"R_PR", "R_PR"});
    const LegState a = StateOf(random.robot.legs[0], random.pose).value();
    const LegState b = StateOf(random.robot.legs[1], random.pose).value();
    const double cosine = std::abs(a.direction.dot(b.direction)),
                 sine = a.direction.cross(b.direction).norm();
    const double expected_m =
        kHalfAngle_rad / sine *
        std::sqrt(a.length_m * a.length_m + b.length_m * b.length_m + 2 * a.length_m * b.length_m * cosine);
    const auto found = LargestErrorByConeNoise(random.robot, {0, 1}, random.pose, kHalfAngle_rad).value();
    EXPECT_NEAR(found.position_m, expected_m, 1e-3 * expected_m);
    EXPECT_EQ(found.rotation_rad, 0);
  }
}

TEST(LargestErrorByConeNoise, IsNothingWhereTheDirectionsDoNotTellThePose) {
  std::mt19937_64 generator = TestGenerator();
  const RobotAtPose hexapod = RandomSpatialRobot(generator, std::vector<std::string>(6, "U_PS"));
  EXPECT_FALSE(LargestErrorByConeNoise(hexapod.robot, {0, 1}, hexapod.pose, kHalfAngle_rad).has_value());
  RobotAtPose delta = RandomTranslationRobot(generator, {"_R-{2-US}", "_R-{2-US}", "_R-{2-US}"});
  EXPECT_TRUE(LargestErrorByConeNoise(delta.robot, {0, 1}, delta.pose, kHalfAngle_rad).has_value());
  delta.pose.translation.z() -= 5;
  EXPECT_FALSE(LargestErrorByConeNoise(delta.robot, {0, 1}, delta.pose, kHalfAngle_rad).has_value());
}

}  // namespace
}  // namespace legible
