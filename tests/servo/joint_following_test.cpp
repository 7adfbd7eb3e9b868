#include "servo/joint_following.h"

#include <gtest/gtest.h>

#include <cmath>

namespace legible {
namespace {

constexpr double kPeriod_s = 0.02, kWay_m = 3e-3;

// Joint i is commanded at speeds[i]; its reading makes shares[i] of that.
JointFollowing Driven(const Vector6d& speeds_m_per_s, const Vector6d& shares, int cycles) {
  JointFollowing following;
  for (int cycle = 0; cycle < cycles; ++cycle) {
    const Vector6d way_m = cycle * kPeriod_s * speeds_m_per_s;
    following.Note(cycle * kPeriod_s, way_m, Vector6d::Constant(0.4) + shares.cwiseProduct(way_m));
  }
  return following;
}

TEST(JointFollowing, FindsNothingWhereAllFollow) {
  EXPECT_FALSE(Driven(Vector6d::Constant(0.05), Vector6d::Ones(), 50).Farthest(kWay_m));
  EXPECT_FALSE(Driven(Vector6d::Constant(0.05), Vector6d::Constant(0.5), 50).Farthest(kWay_m));
  EXPECT_FALSE(JointFollowing().Farthest(kWay_m));
}

TEST(JointFollowing, NamesTheOneJointWhoseReadingStandsStill) {
  Vector6d shares = Vector6d::Ones();
  shares[2] = 0;
  const auto behind = Driven(Vector6d::Constant(-0.04), shares, 50).Farthest(kWay_m);
  ASSERT_TRUE(behind);
  EXPECT_EQ(behind->joint, 2);
  EXPECT_TRUE(behind->has_not_changed);
  EXPECT_GE(behind->commanded_m, kWay_m);
  EXPECT_EQ(behind->made_m, 0);
}

TEST(JointFollowing, IsNotDeceivedByTheNoiseOfAReading) {
  JointFollowing following;
  for (int cycle = 0; cycle < 50; ++cycle)
    following.Note(cycle * kPeriod_s, Vector6d::Constant(cycle * kPeriod_s * 0.05),
                   Vector6d::Constant(0.4 + (cycle % 2 == 0 ? 2e-5 : -2e-5)));
  const auto behind = following.Farthest(kWay_m);
  ASSERT_TRUE(behind);
  EXPECT_FALSE(behind->has_not_changed);
}

TEST(JointFollowing, GivesDrivesTheTimeOfTheirLag) {
  Vector6d shares = Vector6d::Zero();
  EXPECT_FALSE(Driven(Vector6d::Constant(0.1), shares, 12).Farthest(kWay_m));  // 0.22 s
  EXPECT_TRUE(Driven(Vector6d::Constant(0.1), shares, 15).Farthest(kWay_m));
}

// Noise drives the joints to and fro, and a lag takes much of that away.
TEST(JointFollowing, SaysNothingOfCommandsToAndFro) {
  JointFollowing following;
  double way_m = 0;
  for (int cycle = 0; cycle < 100; ++cycle) {
    way_m += kPeriod_s * (cycle % 3 == 0 ? -0.05 : 0.05);
    following.Note(cycle * kPeriod_s, Vector6d::Constant(way_m), Vector6d::Constant(0.4));
    EXPECT_FALSE(following.Farthest(kWay_m));
  }
}

// What was commanded the other way just before, faster, is still on its way.
TEST(JointFollowing, WaitsUntilAReversalIsOver) {
  constexpr double kLag_s = 0.05;
  JointFollowing following;
  double way_m = 0, speed_m_per_s = 0, reading_m = 0.4;
  for (int cycle = 0; cycle < 100; ++cycle) {
    following.Note(cycle * kPeriod_s, Vector6d::Constant(way_m), Vector6d::Constant(reading_m));
    EXPECT_FALSE(following.Farthest(kWay_m)) << cycle;
    const double commanded_m_per_s = cycle < 40 ? -0.08 : 0.013;
    way_m += kPeriod_s * commanded_m_per_s;
    speed_m_per_s += (commanded_m_per_s - speed_m_per_s) * (1 - std::exp(-kPeriod_s / kLag_s));
    reading_m += kPeriod_s * speed_m_per_s;
  }
}

// Friction may hold a joint that is commanded slowly.
TEST(JointFollowing, SaysNothingOfSlowCommands) {
  EXPECT_FALSE(Driven(Vector6d::Constant(0.005), Vector6d::Zero(), 500).Farthest(kWay_m));
}

}  // namespace
}  // namespace legible
