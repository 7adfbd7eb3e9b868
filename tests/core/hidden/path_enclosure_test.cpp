#include "core/hidden/path_enclosure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>

#include "core/robots/platform_motion.h"
#include "tests/testing/random.h"
#include "tests/testing/random_robots.h"

namespace legible {
namespace {

constexpr int kPieces = 128;

bool Encloses(const PoseBalls& balls, const Rigid3& pose) {
  constexpr double kRounding = 1e-11;
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  const auto is_in = [](const RealBall& ball, double x) {
    return LowerBound(ball) - kRounding <= x && x <= UpperBound(ball) + kRounding;
  };
  for (int i = 0; i < 3; ++i) {
    if (!is_in(balls.translation_m[i], pose.translation[i])) return false;
    for (int j = 0; j < 3; ++j)
      if (!is_in(balls.rotation(i, j), rotation(i, j))) return false;
  }
  return true;
}

PoseBalls ValuesOf(const PoseJets& jets) {
  const auto value = [](const RealBallJet& jet) { return jet.value(); };
  return {jets.translation_m.unaryExpr(value), jets.rotation.unaryExpr(value)};
}

// Whether the mean rates from one pose to the other, `length` of s apart, are among those enclosed.
bool EnclosesRates(const PoseJets& jets, const Rigid3& a, const Rigid3& b, double length) {
  constexpr double kRounding = 1e-9;
  const Eigen::Vector3d velocity = (b.translation - a.translation) / length;
  const Eigen::Matrix3d turning = (b.rotation.toRotationMatrix() - a.rotation.toRotationMatrix()) / length;
  const auto is_in = [](const RealBallJet& jet, double rate) {
    return LowerBound(jet.rate()) - kRounding <= rate && rate <= UpperBound(jet.rate()) + kRounding;
  };
  for (int i = 0; i < 3; ++i) {
    if (!is_in(jets.translation_m[i], velocity[i])) return false;
    for (int j = 0; j < 3; ++j)
      if (!is_in(jets.rotation(i, j), turning(i, j))) return false;
  }
  return true;
}

// Piece by piece from the start; how many hold the poses on them that Newton's method finds.
TEST(PathEnclosure, HoldsThePosesOfThePathWhereItIsProved) {
  std::mt19937_64 generator = TestGenerator();
  int arrived = 0;
  for (int n = 0; n < 60; ++n)
    for (const auto& chains :
         {std::vector<std::string>{"R_PS", "R_PS", "_RPS"}, {"R_PS", "U_PS", "_PUS", "R_PS", "U_PS"}}) {
      const RobotAtPose random = RandomSpatialRobot(generator, chains);
      const Rigid3 to = RandomPoseNear(generator, random.robot, random.pose, 0.1);
      const StraightPath path(random.robot, random.pose, to);
      const auto poses = path.Poses(2 * kPieces + 1);
      auto correction = CorrectionAtEnd(path, 0);
      ASSERT_TRUE(correction.has_value());
      for (int i = 0; i < kPieces && correction && poses; ++i) {
        const auto piece = EnclosePiece(path, static_cast<double>(i) / kPieces, *correction,
                                        static_cast<double>(i + 1) / kPieces);
        const auto* on_piece = &(*poses)[static_cast<size_t>(2 * i)];
        for (int k = 0; k < 3 && piece; ++k) EXPECT_TRUE(Encloses(ValuesOf(piece->pose), on_piece[k]));
        if (piece) {
          EXPECT_TRUE(Encloses(piece->middle_pose, on_piece[1]));
          EXPECT_TRUE(EnclosesRates(piece->pose, on_piece[0], on_piece[2], 1.0 / kPieces));
          EXPECT_GE(piece->half_length, 0.5 / kPieces);
        }
        correction = piece ? std::optional(piece->end_correction) : std::nullopt;
      }
      if (correction && IsAtEnd(*correction)) ++arrived;
    }
  std::cout << arrived << " of 120 proved to arrive\n";
  EXPECT_GT(arrived, 110);
}

// Two joints at different heights, which their planes hold. Turned over about y to the mirror image, their
// line would pass the vertical, which the planes do not allow: corrected, it stays as it was.
TEST(PathEnclosure, TellsWhereThePathEndsElsewhere) {
  constexpr double kTilt_rad = 0.4;
  const Eigen::Vector3d joint_m = 0.3 * Eigen::Vector3d(std::cos(kTilt_rad), 0, std::sin(kTilt_rad));
  RobotLeg leg;
  leg.chain = ChainFromText("R_PS");
  ParallelRobot robot{"", PlatformMotion::kSpatial, {}, {leg, leg}};
  for (const int side : {0, 1}) {
    RobotLeg& it = robot.legs[static_cast<size_t>(side)];
    it.platform_joint_m = side == 0 ? joint_m : Eigen::Vector3d(-joint_m);
    it.base_joint_m = {0, 1, it.platform_joint_m.z()};
  }
  const Rigid3 to{RotationFromVector({0, 2 * kTilt_rad - std::numbers::pi, 0}), Eigen::Vector3d::Zero()};
  ASSERT_TRUE(CanTake(robot, {}) && CanTake(robot, to));
  const StraightPath path(robot, {}, to);
  ASSERT_TRUE(CorrectionAtEnd(path, 1).has_value());
  auto correction = CorrectionAtEnd(path, 0);
  constexpr int kSmallPieces = 1024;
  for (int i = 0; i < kSmallPieces; ++i) {
    const auto piece = EnclosePiece(path, static_cast<double>(i) / kSmallPieces, *correction,
                                    static_cast<double>(i + 1) / kSmallPieces);
    ASSERT_TRUE(piece.has_value());
    correction = piece->end_correction;
  }
  EXPECT_FALSE(IsAtEnd(*correction));
  EXPECT_TRUE(Encloses(path.PoseAt<RealBall>(1, *correction), {}));
}

// All planes alike: what is asked has no root, or many.
TEST(PathEnclosure, IsNothingWhereTheCorrectionIsNotUnique) {
  std::mt19937_64 generator = TestGenerator();
  RobotAtPose random = RandomSpatialRobot(generator, {"R_PS", "R_PS"});
  random.robot.legs[1] = random.robot.legs[0];
  EXPECT_FALSE(CorrectionAtEnd(StraightPath(random.robot, random.pose, random.pose), 0).has_value());
}

// A correction that is no root of the path is not taken up.
TEST(PathEnclosure, GoesOnFromThePathAlone) {
  std::mt19937_64 generator = TestGenerator();
  const RobotAtPose random = RandomSpatialRobot(generator, {"R_PS", "R_PS", "R_PS"});
  const Rigid3 to = RandomPoseNear(generator, random.robot, random.pose, 0.05);
  const StraightPath path(random.robot, random.pose, to);
  RealBallVector elsewhere = CorrectionAtEnd(path, 0).value();
  ASSERT_TRUE(EnclosePiece(path, 0, elsewhere, 1e-3).has_value());
  elsewhere[0] += RealBall(0.01);
  EXPECT_FALSE(EnclosePiece(path, 0, elsewhere, 1e-3).has_value());
}

}  // namespace
}  // namespace legible
