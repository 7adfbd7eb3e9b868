#include "calib/pose_candidates.h"

#include <gtest/gtest.h>

#include <Eigen/SVD>

#include "datasets/synthetic_session.h"
#include "tests/calib/random_rigs.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

RigModel DesktopRig() {
  return {DesktopHexapod(), DesktopCamera(true), LookAt({0.94, 0.074, 0.285}, {0, 0, 0.13})};
}

PoseCandidateOptions Few(int count, std::uint64_t seed = 1) {
  PoseCandidateOptions options;
  options.count = count;
  options.seed = seed;
  return options;
}

TEST(PoseCandidates, KeepTheJointRangesAndAreFoundFromHome) {
  std::mt19937_64 generator = TestGenerator();
  const RigModel rig = DrawRig(generator).guess;
  const PoseCandidates found = DrawPoseCandidates(rig, Few(100));
  ASSERT_EQ(found.poses.size(), 100);
  EXPECT_EQ(found.drawn, 100 + found.out_of_reach + found.out_of_sight);
  for (const PoseCandidate& candidate : found.poses) {
    const Rigid3& pose = candidate.base_from_platform;
    const Vector6d readings_m = InverseKinematics(rig.robot, pose);
    for (size_t i = 0; i < kLegCount; ++i) {
      EXPECT_GE(readings_m[static_cast<Eigen::Index>(i)], rig.robot.legs[i].joint_range_m[0] + 0.005);
      EXPECT_LE(readings_m[static_cast<Eigen::Index>(i)], rig.robot.legs[i].joint_range_m[1] - 0.005);
    }
    EXPECT_LE(pose.rotation.angularDistance(rig.robot.home.rotation), 0.5);
    const auto from_home = ForwardKinematics(rig.robot, readings_m, rig.robot.home);
    EXPECT_TRUE(AreNear(from_home.base_from_platform.translation, pose.translation, 1e-7));
  }
}

// Points of the two axes, densely: their least distance.
double DistanceBySteps(const LegInCamera& a, const LegInCamera& b) {
  double least = 1;
  for (double s = 0; s <= 1; s += 0.01)
    for (double t = 0; t <= 1; t += 0.01) least = std::min(least, (a.AxisPoint(s) - b.AxisPoint(t)).norm());
  return least;
}

TEST(PoseCandidates, KeepTheLegsApart) {
  const RigModel rig = DesktopRig();
  for (const PoseCandidate& candidate : DrawPoseCandidates(rig, Few(20)).poses) {
    const LegsInCamera legs = PlaceLegs(rig.robot, rig.camera_from_base, candidate.base_from_platform);
    for (size_t i = 0; i < kLegCount; ++i)
      for (size_t j = i + 1; j < kLegCount; ++j) EXPECT_GE(DistanceBySteps(legs[i], legs[j]), 0.025 - 1e-9);
  }
}

TEST(PoseCandidates, AreNotSentWhereLegsWouldMeet) {
  RigModel rig = DesktopRig();
  for (Leg& leg : rig.robot.legs) leg.joint_range_m = {0.01, 1};
  ReachOptions any_turn;
  any_turn.largest_turn_rad = 3.2;
  int near = 0, clear = 0;
  for (double turn_rad = 0; turn_rad < 3; turn_rad += 0.1) {
    Rigid3 turned = rig.robot.home;
    turned.rotation = RotationFromVector({0, 0, turn_rad}) * turned.rotation;
    const LegsInCamera legs = PlaceLegs(rig.robot, rig.camera_from_base, turned);
    double least_m = 1;
    for (size_t i = 0; i < kLegCount; ++i)
      for (size_t j = i + 1; j < kLegCount; ++j)
        least_m = std::min(least_m, DistanceBySteps(legs[i], legs[j]));
    if (std::abs(least_m - 0.025) < 0.001) continue;  // the steps do not tell
    EXPECT_EQ(MayBeSentTo(rig.robot, turned, any_turn), least_m > 0.025) << turn_rad << " rad " << least_m;
    ++(least_m > 0.025 ? clear : near);
  }
  EXPECT_GT(near, 0);
  EXPECT_GT(clear, 0);
}

TEST(PoseCandidates, ShowEdgesThatNothingHides) {
  std::mt19937_64 generator = TestGenerator();
  const RigModel rig = DrawRig(generator).guess;
  for (const PoseCandidate& candidate : DrawPoseCandidates(rig, Few(30)).poses) {
    EXPECT_GE(candidate.expected.edges.size(), 8);
    const LegsInCamera legs = PlaceLegs(rig.robot, rig.camera_from_base, candidate.base_from_platform);
    for (const EdgeObservation& edge : candidate.expected.edges) {
      EXPECT_GE(edge.samples.size(), 3);
      for (const EdgeSample& sample : edge.samples) {
        EXPECT_GT(sample.point_px.minCoeff(), 9);
        EXPECT_LT(sample.point_px.x(), rig.camera.width_px - 10);
        EXPECT_LT(sample.point_px.y(), rig.camera.height_px - 10);
        // On the outline: its sight line passes the axis at the leg's radius.
        const LegInCamera& leg = legs[static_cast<size_t>(edge.leg)];
        const Eigen::Vector3d sight = Unproject(rig.camera, sample.point_px).value().homogeneous();
        const Eigen::Vector3d normal = (leg.b_in_camera - leg.a_in_camera).cross(sight).normalized();
        EXPECT_NEAR(std::abs(normal.dot(leg.a_in_camera)), leg.radius_m, 1e-9);
      }
    }
  }
}

TEST(PoseCandidates, AreTheSameForASeedAndOthersForAnother) {
  const RigModel rig = DesktopRig();
  const auto first = [&](std::uint64_t seed) {
    return DrawPoseCandidates(rig, Few(1, seed)).poses.at(0).base_from_platform.translation;
  };
  EXPECT_EQ(first(1), first(1));
  EXPECT_NE(first(1), first(2));
}

TEST(PoseCandidates, AreNoneWhereTheCameraLooksAway) {
  RigModel rig = DesktopRig();
  rig.camera_from_base = LookAt({0.94, 0.074, 0.285}, {3, 0, 0.13});
  const PoseCandidates found = DrawPoseCandidates(rig, Few(1));
  EXPECT_TRUE(found.poses.empty());
  EXPECT_EQ(found.out_of_sight + found.out_of_reach, found.drawn);
  EXPECT_GT(found.out_of_sight, 0);
}

TEST(PoseCandidates, DemandSensibleOptions) {
  PoseCandidateOptions options;
  options.least_edges = 13;
  EXPECT_THROW(DrawPoseCandidates(DesktopRig(), options), std::invalid_argument);
  options = {};
  options.edges.sample_sigma_px = 0;
  EXPECT_THROW(DrawPoseCandidates(DesktopRig(), options), std::invalid_argument);
  options = {};
  options.reach.largest_turn_rad = 0;
  EXPECT_THROW(DrawPoseCandidates(DesktopRig(), options), std::invalid_argument);
}

}  // namespace
}  // namespace legible
