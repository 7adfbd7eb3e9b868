#include "core/hidden/path_certificate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <iostream>

#include "core/robots/leg_state.h"
#include "core/robots/platform_motion.h"
#include "tests/testing/random.h"
#include "tests/testing/random_robots.h"

namespace legible {
namespace {

struct Family {
  const char* name;
  RobotKind kind;
  std::vector<int> legs;
  std::function<RobotAtPose(std::mt19937_64&)> draw;
};

std::vector<Family> Families() {
  const auto planar = [](const std::vector<std::string>& chains) {
    return [chains](std::mt19937_64& generator) { return RandomPlanarRobot(generator, chains); };
  };
  const auto spatial = [](const char* chain) {
    return [chain](std::mt19937_64& generator) {
      return RandomSpatialRobot(generator, std::vector<std::string>(6, chain));
    };
  };
  const auto delta = [](const char* chain) {
    return [chain](std::mt19937_64& generator) {
      return RandomTranslationRobot(generator, {chain, chain, chain});
    };
  };
  const auto quattro = [](std::mt19937_64& generator) {
    return RandomSchoenfliesRobot(generator, "_R-{2-US}");
  };
  const RobotKind hidden = RobotKind::kHidden, real = RobotKind::kReal;
  return {{"hidden RRRRR", hidden, {0, 1}, planar({"_RRR", "R_RR"})},
          {"hidden 3-RRR", hidden, {0, 1, 2}, planar({"_RRR", "_RRR", "R_RR"})},
          {"hidden 3-PRR", hidden, {0, 1, 2}, planar({"_PRR", "_PRR", "P_RR"})},
          {"hidden 3-UPS", hidden, {0, 2, 4}, spatial("U_PS")},
          {"hidden 4-UPS", hidden, {0, 2, 4, 5}, spatial("U_PS")},
          {"hidden Delta", hidden, {0, 1}, delta("_R-{2-US}")},
          {"hidden Quattro", hidden, {0, 3}, quattro},
          {"3-RRR", real, {0, 1, 2}, planar({"_RRR", "_RRR", "_RRR"})},
          {"hexapod", real, {0, 1, 2, 3, 4, 5}, spatial("U_PS")},
          {"Delta", real, {0, 1, 2}, delta("_P-{2-US}")},
          {"Quattro", real, {0, 1, 2, 3}, quattro}};
}

// The straight path, its rotation about one axis in base.
Rigid3 OnPath(const Rigid3& from, const Rigid3& to, double s) {
  return Displaced(from, s * Displacement(from, to));
}

bool IsReached(const RobotAtPose& random, const std::vector<int>& legs, const Rigid3& to) {
  for (int i = 0; i <= 100; ++i)
    for (const int leg : legs)
      if (!StateOf(random.robot.legs[static_cast<size_t>(leg)], OnPath(random.pose, to, i / 100.0)))
        return false;
  return true;
}

// 10^4 samples: the condition keeps its sign and the matrices their rank.
void ExpectFree(const Family& family, const ParallelRobot& robot, const Rigid3& from, const Rigid3& to) {
  constexpr int kSamples = 10000;
  double least = 1;
  bool keeps_sign = true, is_reached = true;
  const auto start = Type2MeasureOf(robot, family.kind, family.legs, from);
  for (int i = 0; i <= kSamples && is_reached; ++i) {
    const auto measure =
        Type2MeasureOf(robot, family.kind, family.legs, OnPath(from, to, static_cast<double>(i) / kSamples));
    is_reached = measure.has_value();
    if (!is_reached) break;
    least = std::min(least, measure->matrix);
    if (measure->geometric) keeps_sign = keeps_sign && *measure->geometric * *start->geometric > 0;
  }
  EXPECT_TRUE(is_reached);
  EXPECT_TRUE(keeps_sign);
  EXPECT_GT(least, 0);
}

TEST(CertifyStraightPath, IsFreeWhereNoSampleIsSingularAndSingularWhereTheConditionChangesSign) {
  std::mt19937_64 generator = TestGenerator();
  for (const Family& family : Families()) {
    SCOPED_TRACE(family.name);
    int free = 0, singular = 0, undecided = 0;
    for (int n = 0; n < 30; ++n) {
      const RobotAtPose random = family.draw(generator);
      const Rigid3 to = RandomPoseNear(generator, random.robot, random.pose, Uniform(generator, 0.01, 0.4));
      if (!IsReached(random, family.legs, to)) continue;
      const PathCertificate found =
          CertifyStraightPath(random.robot, family.kind, family.legs, random.pose, to);
      if (found.verdict == PathVerdict::kFree) {
        EXPECT_EQ(found.at, 1);
        EXPECT_EQ(found.why, "");
        if (++free <= 3) ExpectFree(family, random.robot, random.pose, to);
        continue;
      }
      EXPECT_LT(found.at, 1);
      EXPECT_NE(found.why, "");
      const auto a = Type2MeasureOf(random.robot, family.kind, family.legs, random.pose);
      const auto b = Type2MeasureOf(random.robot, family.kind, family.legs, to);
      const bool is_signed = a->geometric && family.name != std::string("hidden Delta");
      if (found.verdict == PathVerdict::kSingular) {
        ++singular;
        ASSERT_TRUE(is_signed);
        EXPECT_LT(*a->geometric * *b->geometric, 0);
      } else {
        ++undecided;
        EXPECT_FALSE(is_signed && *a->geometric * *b->geometric < 0);
      }
    }
    std::cout << family.name << ": " << free << " free, " << singular << " singular, " << undecided
              << " undecided\n";
    EXPECT_GT(free, 0);
  }
}

// Where a singular path was last proved free, the crossing is just ahead.
TEST(CertifyStraightPath, GoesOnUntilJustBeforeTheSingularity) {
  std::mt19937_64 generator = TestGenerator();
  int checked = 0;
  while (checked < 10) {
    const RobotAtPose random = RandomPlanarRobot(generator, {"_RRR", "_RRR", "_RRR"});
    const Rigid3 to = RandomPoseNear(generator, random.robot, random.pose, 0.4);
    if (!IsReached(random, {0, 1, 2}, to)) continue;
    const auto condition = [&](double s) {
      return Type2MeasureOf(random.robot, RobotKind::kHidden, {0, 1, 2}, OnPath(random.pose, to, s))
          ->geometric.value();
    };
    if (condition(0) * condition(1) > 0) continue;
    const PathCertificate found =
        CertifyStraightPath(random.robot, RobotKind::kHidden, {0, 1, 2}, random.pose, to);
    EXPECT_EQ(found.verdict, PathVerdict::kSingular);
    EXPECT_GT(condition(found.at) * condition(0), 0);
    EXPECT_LT(condition(found.at + 1e-2) * condition(0), 0);
    EXPECT_LT(Displacement(found.pose, OnPath(random.pose, to, found.at)).norm(), 1e-12);
    ++checked;
  }
}

// A five-bar whose second leg's tangent is that of its rail. Its first arm, and with it the first tangent,
// turns back where the path goes across the first rod: there, at the middle, it is made parallel to the rail.
TEST(CertifyStraightPath, IsNotFreeWhereThePathOnlyTouchesASingularity) {
  std::mt19937_64 generator = TestGenerator();
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  int checked = 0;
  while (checked < 3) {
    RobotAtPose random = RandomPlanarRobot(generator, {"_RRR", "_PRR"});
    const LegState first = StateOf(random.robot.legs[0], random.pose).value();
    random.robot.legs[1].first_axis = first.free_direction;
    Vector6d half = Vector6d::Zero();
    half.head<3>() = 0.1 * z.cross(first.direction);
    const Rigid3 from = Displaced(random.pose, -half), to = Displaced(random.pose, half);
    const RobotAtPose at_start{random.robot, from};
    if (!IsReached(at_start, {0, 1}, to)) continue;
    const auto condition = [&](const Rigid3& pose) {
      return Type2MeasureOf(random.robot, RobotKind::kHidden, {0, 1}, pose)->geometric.value();
    };
    ASSERT_LT(std::abs(condition(random.pose)), 1e-12);
    if (condition(from) * condition(to) < 0) continue;  // crossed elsewhere as well
    const PathCertificate found = CertifyStraightPath(random.robot, RobotKind::kHidden, {0, 1}, from, to);
    EXPECT_EQ(found.verdict, PathVerdict::kUndecided);
    EXPECT_LE(found.at, 0.5);
    ++checked;
  }
}

TEST(CertifyStraightPath, IsSingularWhereALegDoesNotReach) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 20; ++n) {
    const RobotAtPose random = RandomTranslationRobot(generator, {"_R-{2-US}", "_R-{2-US}", "_R-{2-US}"});
    Rigid3 to = random.pose;
    to.translation.z() -= 5;
    for (const RobotKind kind : {RobotKind::kHidden, RobotKind::kReal}) {
      const std::vector<int> legs =
          kind == RobotKind::kReal ? std::vector<int>{0, 1, 2} : std::vector<int>{0, 1};
      const PathCertificate found = CertifyStraightPath(random.robot, kind, legs, random.pose, to);
      EXPECT_NE(found.verdict, PathVerdict::kFree);
    }
  }
}

TEST(CertifyPath, IsFreeWhereEveryPartIs) {
  std::mt19937_64 generator = TestGenerator();
  int free = 0;
  for (int n = 0; n < 20; ++n) {
    const RobotAtPose random = RandomSpatialRobot(generator, std::vector<std::string>(6, "U_PS"));
    std::vector<Rigid3> poses = {random.pose};
    for (int i = 0; i < 3; ++i) poses.push_back(RandomPoseNear(generator, random.robot, poses.back(), 0.05));
    bool all_free = true;
    double parts = 0;
    for (size_t i = 0; i + 1 < poses.size() && all_free; ++i) {
      const PathCertificate part =
          CertifyStraightPath(random.robot, RobotKind::kHidden, {0, 2, 4}, poses[i], poses[i + 1]);
      all_free = part.verdict == PathVerdict::kFree;
      parts += part.at / 3;
    }
    const PathCertificate found = CertifyPath(random.robot, RobotKind::kHidden, {0, 2, 4}, poses);
    EXPECT_EQ(found.verdict == PathVerdict::kFree, all_free);
    EXPECT_NEAR(found.at, parts, 1e-12);
    if (all_free) ++free;
  }
  EXPECT_GT(free, 3);
}

TEST(CertifyStraightPath, SaysOfWhatItDoesNotJudge) {
  std::mt19937_64 generator = TestGenerator();
  const auto why = [](const RobotAtPose& random, RobotKind kind) {
    const PathCertificate found =
        CertifyStraightPath(random.robot, kind, AllLegs(random.robot), random.pose, random.pose);
    EXPECT_EQ(found.verdict, PathVerdict::kUndecided);
    EXPECT_EQ(found.at, 0);
    return found.why;
  };
  EXPECT_THAT(why(RandomSpatialRobot(generator, {"R_PS", "R_PS", "R_PS"}), RobotKind::kHidden),
              testing::HasSubstr("RPS"));
  EXPECT_THAT(why(RandomPlanarRobot(generator, {"_RRP", "_RRR", "_RRR"}), RobotKind::kHidden),
              testing::HasSubstr("_RRP"));
  EXPECT_THAT(why(RandomPlanarRobot(generator, {"R_RR", "_RRR", "_RRR"}), RobotKind::kReal),
              testing::HasSubstr("R_RR"));
}

}  // namespace
}  // namespace legible
