#include "core/hidden/path_certificate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>

#include "core/robots/leg_state.h"
#include "core/robots/platform_motion.h"
#include "core/robots/straight_path.h"
#include "tests/testing/random.h"
#include "tests/testing/random_robots.h"
#include "tests/testing/robot_makers.h"

namespace legible {
namespace {

struct Family {
  const char* name;
  RobotKind kind;
  std::vector<int> legs;
  RobotMaker draw;
};

std::vector<Family> Families() {
  const RobotKind hidden = RobotKind::kHidden, real = RobotKind::kReal;
  const std::vector<std::string> six_ups(6, "U_PS");
  return {{"hidden RRRRR", hidden, {0, 1}, Planar({"_RRR", "R_RR"})},
          {"hidden 3-RRR", hidden, {0, 1, 2}, Planar({"_RRR", "_RRR", "R_RR"})},
          {"hidden 3-PRR", hidden, {0, 1, 2}, Planar({"_PRR", "_PRR", "P_RR"})},
          {"hidden RRP-2-RRR", hidden, {0, 1, 2}, Planar({"_RRP", "_RRR", "_RRR"})},
          {"hidden 3-UPS", hidden, {0, 2, 4}, Spatial(six_ups)},
          {"hidden 4-UPS", hidden, {0, 2, 4, 5}, Spatial(six_ups)},
          {"hidden 3-RPS", hidden, {0, 1, 2}, Spatial({"R_PS", "R_PS", "R_PS"})},
          {"hidden 2 of 4-RPS", hidden, {0, 2}, Spatial({"R_PS", "R_PS", "_RPS", "R_PS"})},
          {"hidden RPS-2-PUS", hidden, {0, 1, 2}, Spatial({"R_PS", "_PUS", "_PUS", "_PUS", "_PUS"})},
          {"hidden Delta", hidden, {0, 1}, Delta("_R-{2-US}")},
          {"hidden Quattro", hidden, {0, 3}, Quattro("_R-{2-US}")},
          {"3-RRR", real, {0, 1, 2}, Planar({"_RRR", "_RRR", "_RRR"})},
          {"5-bar by its rods", real, {0, 1}, Planar({"R_RR", "P_RR"})},
          {"3-RRR by their second R", real, {0, 1, 2}, Planar({"R_RR", "R_RR", "R_RR"})},
          {"RPR, PRR, RRR", real, {0, 1, 2}, Planar({"_RPR", "P_RR", "_RRR"})},
          {"PPR, PPR, RPR", real, {0, 1, 2}, Planar({"_PPR", "P_PR", "R_PR"})},
          {"PRP, RRP, RRP", real, {0, 1, 2}, Planar({"_PRP", "_RRP", "R_RP"})},
          {"PRP, RRR, RRR", real, {0, 1, 2}, Planar({"P_RP", "_RRR", "R_RR"})},
          {"4-RRR", real, {0, 1, 2, 3}, Planar({"_RRR", "R_RR", "_RRR", "R_RR"})},
          {"hexapod", real, {0, 1, 2, 3, 4, 5}, Spatial(six_ups)},
          {"3-RPS", real, {0, 1, 2}, Spatial({"R_PS", "R_PS", "R_PS"})},
          {"3-RPS by their R", real, {0, 1, 2}, Spatial({"_RPS", "_RPS", "_RPS"})},
          {"2-RPS-2-UPS", real, {0, 1, 2, 3}, Spatial({"R_PS", "_RPS", "U_PS", "U_PS"})},
          {"Delta", real, {0, 1, 2}, Delta("_P-{2-US}")},
          {"Quattro", real, {0, 1, 2, 3}, Quattro("_R-{2-US}")}};
}

// The path's poses at equal steps; none where RPS legs let none go on.
std::vector<Rigid3> PosesOnPath(const ParallelRobot& robot, const Rigid3& from, const Rigid3& to, int count) {
  return StraightPath(robot, from, to).Poses(count).value_or(std::vector<Rigid3>());
}

Rigid3 OnPath(const Rigid3& from, const Rigid3& to, double s) {
  return Displaced(from, s * Displacement(from, to));
}

bool IsReached(const RobotAtPose& random, const std::vector<int>& legs, const Rigid3& to) {
  const std::vector<Rigid3> poses = PosesOnPath(random.robot, random.pose, to, 101);
  return !poses.empty() && std::all_of(poses.begin(), poses.end(), [&](const Rigid3& pose) {
    return StatesOf(random.robot, legs, pose).has_value();
  });
}

// What samples of a path say.
struct Sampled {
  double least_matrix = 1;  // smallest singular value, of the largest
  double least_sine = 1;    // of a leg's direction with what it has to cross (Type 1)
  bool keeps_sign = true;
};

Sampled SampledOn(const Family& family, const ParallelRobot& robot, const std::vector<Rigid3>& poses) {
  Sampled sampled;
  const auto start = Type2MeasureOf(robot, family.kind, family.legs, poses.front());
  for (const Rigid3& pose : poses) {
    const auto measure = Type2MeasureOf(robot, family.kind, family.legs, pose);
    if (!measure) return {0, 0, false};
    sampled.least_matrix = std::min(sampled.least_matrix, measure->matrix);
    sampled.least_sine = std::min(sampled.least_sine, Type1MeasureOf(robot, family.legs, pose).value());
    if (measure->geometric)
      sampled.keeps_sign = sampled.keeps_sign && *measure->geometric * *start->geometric > 0;
  }
  return sampled;
}

void ExpectFree(const Family& family, const ParallelRobot& robot, const Rigid3& from, const Rigid3& to) {
  const std::vector<Rigid3> poses = PosesOnPath(robot, from, to, 10001);
  ASSERT_FALSE(poses.empty());
  const Sampled sampled = SampledOn(family, robot, poses);
  EXPECT_TRUE(sampled.keeps_sign);
  EXPECT_GT(sampled.least_matrix, 1e-9);
  EXPECT_GT(sampled.least_sine, 0);
}

// How many paths of a family have which verdict.
struct Verdicts {
  int free = 0, singular = 0, undecided = 0;
  int clear = 0, clear_free = 0;  // far from any singularity by samples; of these those proved free
};

// Of a path that is not free.
void ExpectSignedVerdict(const Family& family, const RobotAtPose& random, const Rigid3& to,
                         const PathCertificate& found, Verdicts& verdicts) {
  EXPECT_LT(found.at, 1);
  EXPECT_NE(found.why, "");
  const auto a = Type2MeasureOf(random.robot, family.kind, family.legs, random.pose);
  const auto b = Type2MeasureOf(random.robot, family.kind, family.legs, to);
  const bool is_signed = a->geometric && family.name != std::string("hidden Delta");
  const bool changes_sign = is_signed && *a->geometric * *b->geometric < 0;
  EXPECT_EQ(found.verdict == PathVerdict::kSingular, changes_sign);
  ++(found.verdict == PathVerdict::kSingular ? verdicts.singular : verdicts.undecided);
}

void JudgeRandomPath(const Family& family, std::mt19937_64& generator, Verdicts& verdicts) {
  constexpr double kClear = 0.02, kClearSine = 0.1;
  const RobotAtPose random = family.draw(generator);
  const Rigid3 to = RandomPoseNear(generator, random.robot, random.pose, Uniform(generator, 0.01, 0.4));
  if (!IsReached(random, family.legs, to)) return;
  const Sampled sampled = SampledOn(family, random.robot, PosesOnPath(random.robot, random.pose, to, 201));
  const bool is_clear =
      sampled.keeps_sign && sampled.least_matrix > kClear && sampled.least_sine > kClearSine;
  verdicts.clear += is_clear ? 1 : 0;
  const PathCertificate found = CertifyStraightPath(random.robot, family.kind, family.legs, random.pose, to);
  if (found.verdict != PathVerdict::kFree) return ExpectSignedVerdict(family, random, to, found, verdicts);
  EXPECT_EQ(found.at, 1);
  EXPECT_EQ(found.why, "");
  EXPECT_LT(Displacement(found.pose, to).norm(), 1e-7);
  verdicts.clear_free += is_clear ? 1 : 0;
  if (++verdicts.free <= 3) ExpectFree(family, random.robot, random.pose, to);
}

TEST(CertifyStraightPath, IsFreeWhereNoSampleIsSingularAndSingularWhereTheConditionChangesSign) {
  std::mt19937_64 generator = TestGenerator();
  for (const Family& family : Families()) {
    SCOPED_TRACE(family.name);
    Verdicts verdicts;
    for (int n = 0; n < 40; ++n) JudgeRandomPath(family, generator, verdicts);
    std::cout << family.name << ": " << verdicts.free << " free, " << verdicts.singular << " singular, "
              << verdicts.undecided << " undecided; " << verdicts.clear_free << " of " << verdicts.clear
              << " clearly free by samples\n";
    EXPECT_GT(verdicts.free, 0);
    EXPECT_GE(verdicts.clear_free, 0.95 * verdicts.clear);
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

// The signed condition of a family at a pose; nothing where a leg does not reach it.
std::optional<double> ConditionAt(const Family& family, const ParallelRobot& robot, const Rigid3& pose) {
  const auto measure = Type2MeasureOf(robot, family.kind, family.legs, pose);
  return measure ? measure->geometric : std::nullopt;
}

// A singular pose of a random robot of the family on a path between two others.
RobotAtPose RandomRobotAtSingularity(const Family& family, std::mt19937_64& generator) {
  constexpr double kClearSine = 0.02;
  while (true) {
    RobotAtPose random = family.draw(generator);
    const Rigid3 to = RandomPoseNear(generator, random.robot, random.pose, 0.4);
    if (!IsReached(random, family.legs, to)) continue;
    const auto condition = [&](double s) {
      return ConditionAt(family, random.robot, OnPath(random.pose, to, s)).value_or(0);
    };
    if (!(condition(0) * condition(1) < 0)) continue;
    double low = 0, high = 1;
    for (int i = 0; i < 100; ++i)
      (condition((low + high) / 2) * condition(0) > 0 ? low : high) = (low + high) / 2;
    random.pose = OnPath(random.pose, to, low);
    // Where a leg passes Type 1 between the samples that reach, the sign may change as well.
    const auto sine = Type1MeasureOf(random.robot, family.legs, random.pose);
    if (sine && *sine > kClearSine) return random;
  }
}

// The twist, of length 1, by which the condition grows most.
Vector6d AcrossSurface(const Family& family, const RobotAtPose& singular) {
  const auto basis = MotionBasis(singular.robot, singular.pose);
  Eigen::VectorXd gradient(basis.cols());
  for (Eigen::Index k = 0; k < basis.cols(); ++k) {
    const auto at = [&](double step) {
      return ConditionAt(family, singular.robot, Displaced(singular.pose, step * basis.col(k))).value();
    };
    gradient[k] = (at(1e-6) - at(-1e-6)) / 2e-6;
  }
  return basis * gradient.normalized();
}

// A short way along the surface of singularities, from before a point of it to behind.
Vector6d HalfWayAlongSurface(const RobotAtPose& singular, const Vector6d& across,
                             std::mt19937_64& generator) {
  const auto basis = MotionBasis(singular.robot, singular.pose);
  Vector6d way = Vector6d::Zero();
  for (Eigen::Index k = 0; k < basis.cols(); ++k) way += Uniform(generator, -0.1, 0.1) * basis.col(k);
  return way - across * across.dot(way);
}

// Families whose paths are straight and whose condition has a sign.
std::vector<Family> StraightFamilies(std::mt19937_64& generator) {
  std::vector<Family> straight;
  for (const Family& family : Families()) {
    const RobotAtPose any = family.draw(generator);
    if (LegsKeptInPlanes(any.robot).empty() && family.name != std::string("hidden Delta") &&
        ConditionAt(family, any.robot, any.pose))
      straight.push_back(family);
  }
  return straight;
}

// To the one side or the other, by so little that it is no more than a touch, the path crosses the surface
// twice.
TEST(CertifyStraightPath, GivesUpAtSomePointWhereThePathTouchesASingularity) {
  std::mt19937_64 generator = TestGenerator();
  for (const Family& family : StraightFamilies(generator)) {
    SCOPED_TRACE(family.name);
    int most_pieces = 0;
    for (int n = 0; n < 5; ++n) {
      const RobotAtPose singular = RandomRobotAtSingularity(family, generator);
      const Vector6d across = AcrossSurface(family, singular);
      const Vector6d half = HalfWayAlongSurface(singular, across, generator);
      for (const double side_m : {-1e-9, 1e-9}) {
        const Rigid3 middle = Displaced(singular.pose, side_m * across);
        const Rigid3 from = Displaced(middle, -half), to = Displaced(middle, half);
        if (!IsReached({singular.robot, from}, family.legs, to)) continue;
        const auto condition = [&](const Rigid3& pose) {
          return ConditionAt(family, singular.robot, pose).value();
        };
        const bool crosses_before_middle = condition(from) * condition(middle) < 0;
        if (!crosses_before_middle && condition(middle) * condition(to) > 0) continue;
        const PathCertificate found = CertifyStraightPath(singular.robot, family.kind, family.legs, from, to);
        EXPECT_NE(found.verdict, PathVerdict::kFree);
        EXPECT_LE(found.at, crosses_before_middle ? 0.5 : 1);
        most_pieces = std::max(most_pieces, found.pieces);
      }
    }
    std::cout << family.name << ": given up after " << most_pieces << " pieces at most\n";
    EXPECT_LE(most_pieces, 1000);
  }
}

// A thousandth of m and rad beside the surface, as far as the path does not cross it all the same.
TEST(CertifyStraightPath, IsFreeWhereThePathPassesASingularityClosely) {
  std::mt19937_64 generator = TestGenerator();
  int close = 0, free = 0;
  for (const Family& family : StraightFamilies(generator))
    for (int n = 0; n < 10; ++n) {
      const RobotAtPose singular = RandomRobotAtSingularity(family, generator);
      const Vector6d across = AcrossSurface(family, singular);
      const Vector6d half = HalfWayAlongSurface(singular, across, generator);
      const Rigid3 middle = Displaced(singular.pose, 1e-3 * across);
      const Rigid3 from = Displaced(middle, -half), to = Displaced(middle, half);
      if (!IsReached({singular.robot, from}, family.legs, to)) continue;
      const Sampled sampled = SampledOn(family, singular.robot, PosesOnPath(singular.robot, from, to, 2001));
      const PathCertificate found = CertifyStraightPath(singular.robot, family.kind, family.legs, from, to);
      const bool is_close = sampled.keeps_sign && sampled.least_matrix > 1e-6 && sampled.least_sine > 0.02;
      EXPECT_TRUE(sampled.keeps_sign || found.verdict != PathVerdict::kFree) << family.name;
      close += is_close ? 1 : 0;
      free += is_close && found.verdict == PathVerdict::kFree ? 1 : 0;
    }
  std::cout << free << " of " << close << " paths that pass closely are proved free\n";
  EXPECT_GT(close, 20);
  EXPECT_GE(free, 0.9 * close);
}

// 5 m off; an RPS leg lets the platform translate in its plane.
TEST(CertifyStraightPath, IsOutOfReachWhereALegDoesNotReachTheGoal) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 20; ++n)
    for (const RobotAtPose& random :
         {RandomTranslationRobot(generator, {"_R-{2-US}", "_R-{2-US}", "_R-{2-US}"}),
          RandomPlanarRobot(generator, {"_RRR", "_RRR", "_PRR"}),
          RandomSpatialRobot(generator, {"R_PS", "_RUS", "_RUS", "_RUS", "_RUS"})}) {
      const Eigen::Vector3d across = random.robot.motion == PlatformMotion::kTranslation
                                         ? Eigen::Vector3d::UnitX()
                                         : random.robot.legs[0].first_axis;
      Rigid3 to = random.pose;
      to.translation += 5 * RandomDirectionAcross(generator, across);
      for (const RobotKind kind : {RobotKind::kHidden, RobotKind::kReal}) {
        const PathCertificate found =
            CertifyStraightPath(random.robot, kind, AllLegs(random.robot), random.pose, to);
        EXPECT_EQ(found.verdict, PathVerdict::kOutOfReach);
        EXPECT_THAT(found.why, testing::HasSubstr("cannot reach"));
      }
    }
}

// Two legs with longer arms than rods, beside each other: the platform would pass their base joints on the
// way.
TEST(CertifyStraightPath, IsOutOfReachWhereALegDoesNotReachBetweenStartAndGoal) {
  RobotLeg leg;
  leg.chain = ChainFromText("_RRR");
  leg.arm_m = 1;
  leg.rod_m = 0.5;
  RobotLeg other = leg;
  other.base_joint_m = {0, -0.1, 0};
  other.working_mode = -1;
  const ParallelRobot robot{"", PlatformMotion::kPlanarPoint, {}, {leg, other}};
  const Rigid3 from{Eigen::Quaterniond::Identity(), {-1, 0, 0}}, to{from.rotation, {1, 0, 0}};
  ASSERT_TRUE(StatesOf(robot, {0, 1}, from) && StatesOf(robot, {0, 1}, to));
  for (const RobotKind kind : {RobotKind::kHidden, RobotKind::kReal}) {
    const PathCertificate found = CertifyStraightPath(robot, kind, {0, 1}, from, to);
    EXPECT_EQ(found.verdict, PathVerdict::kOutOfReach) << found.why;
    EXPECT_LT(found.at, 0.25);
  }
}

// Two joints at different heights, which their planes hold, as in path_enclosure_test.cpp: turned to the
// mirror image, the platform stays as it was. Three more legs hold it all along the way, but for the planes.
TEST(CertifyStraightPath, SaysWhereThePathLeadsToAnotherPoseThanTheGoal) {
  constexpr double kTilt_rad = 0.4;
  std::mt19937_64 generator = TestGenerator();
  RobotAtPose random = RandomSpatialRobot(generator, {"R_PS", "R_PS", "U_PS", "U_PS", "U_PS", "U_PS"});
  const Eigen::Vector3d joint_m = 0.3 * Eigen::Vector3d(std::cos(kTilt_rad), 0, std::sin(kTilt_rad));
  for (const int side : {0, 1}) {
    RobotLeg& leg = random.robot.legs[static_cast<size_t>(side)];
    leg.first_axis = Eigen::Vector3d::UnitZ();
    leg.platform_joint_m = side == 0 ? joint_m : Eigen::Vector3d(-joint_m);
    leg.base_joint_m = {0, 1, leg.platform_joint_m.z()};
  }
  for (size_t i = 2; i < 6; ++i) random.robot.legs[i].base_joint_m.z() -= 1;
  const Rigid3 to{RotationFromVector({0, 2 * kTilt_rad - std::numbers::pi, 0}), Eigen::Vector3d::Zero()};
  ASSERT_TRUE(PosesOnPath(random.robot, {}, to, 11).empty());
  const PathCertificate found = CertifyStraightPath(random.robot, RobotKind::kHidden, {2, 3, 4, 5}, {}, to);
  EXPECT_EQ(found.verdict, PathVerdict::kUndecided);
  EXPECT_EQ(found.at, 1);
  EXPECT_THAT(found.why, testing::HasSubstr("another pose than the goal"));
}

// How many of 20 random paths of three parts are free.
int FreePaths(const std::vector<std::string>& chains, const std::vector<int>& legs) {
  std::mt19937_64 generator = TestGenerator();
  int free = 0;
  for (int n = 0; n < 20; ++n) {
    const RobotAtPose random = RandomSpatialRobot(generator, chains);
    std::vector<Rigid3> poses = {random.pose};
    for (int i = 0; i < 3; ++i) poses.push_back(RandomPoseNear(generator, random.robot, poses.back(), 0.05));
    bool all_free = true;
    double parts = 0;
    for (size_t i = 0; i + 1 < poses.size() && all_free; ++i) {
      const PathCertificate part =
          CertifyStraightPath(random.robot, RobotKind::kHidden, legs, poses[i], poses[i + 1]);
      all_free = part.verdict == PathVerdict::kFree;
      parts += part.at / 3;
    }
    const PathCertificate found = CertifyPath(random.robot, RobotKind::kHidden, legs, poses);
    EXPECT_EQ(found.verdict == PathVerdict::kFree, all_free);
    EXPECT_NEAR(found.at, parts, 1e-12);
    if (all_free) ++free;
  }
  return free;
}

TEST(CertifyPath, IsFreeWhereEveryPartIs) {
  EXPECT_GT(FreePaths(std::vector<std::string>(6, "U_PS"), {0, 2, 4}), 3);
  EXPECT_GT(FreePaths({"R_PS", "R_PS", "R_PS"}, {0, 1, 2}), 3);
}

TEST(CertifyStraightPath, SaysWhereAnEndIsNoPoseThatRpsLegsAllow) {
  std::mt19937_64 generator = TestGenerator();
  const RobotAtPose random = RandomSpatialRobot(generator, {"R_PS", "R_PS", "R_PS"});
  Rigid3 beside = random.pose;
  beside.translation += 0.01 * random.robot.legs[0].first_axis;
  for (const auto& [from, to] : {std::pair(random.pose, beside), std::pair(beside, random.pose)}) {
    const PathCertificate found = CertifyStraightPath(random.robot, RobotKind::kReal, {0, 1, 2}, from, to);
    EXPECT_EQ(found.verdict, PathVerdict::kUndecided);
    EXPECT_EQ(found.at, 0);
    EXPECT_THAT(found.why, testing::HasSubstr("RPS"));
  }
}

// Directions that do not tell where the platform is hold it nowhere, however the path goes.
TEST(CertifyStraightPath, IsUndecidedOfLegsThatDoNotHoldThePlatform) {
  std::mt19937_64 generator = TestGenerator();
  for (const auto& chains : {std::vector<std::string>{"_PPR", "_RRR", "_RRR"}, {"_PRP", "_RRP", "_RRR"}}) {
    const RobotAtPose random = RandomPlanarRobot(generator, chains);
    const PathCertificate found =
        CertifyStraightPath(random.robot, RobotKind::kHidden, {0, 1, 2}, random.pose, random.pose);
    EXPECT_EQ(found.verdict, PathVerdict::kUndecided);
    EXPECT_EQ(found.at, 0);
  }
}

}  // namespace
}  // namespace legible
