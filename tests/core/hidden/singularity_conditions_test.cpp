#include "core/hidden/singularity_conditions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/hidden/assembly_modes.h"
#include "core/hidden/singularity_geometry.h"
#include "core/robots/leg_state.h"
#include "core/robots/platform_motion.h"
#include "tests/testing/random.h"
#include "tests/testing/random_robots.h"
#include "tests/testing/robot_makers.h"

namespace legible {
namespace {

// A robot's way from a random pose, all of which its legs reach with their working modes.
struct Way {
  ParallelRobot robot;
  Rigid3 from;
  Vector6d twist;

  Rigid3 At(double s) const { return BackToMotion(robot, Displaced(from, s * twist)); }
};

struct Family {
  const char* name;
  RobotKind kind;
  std::vector<int> legs;
  RobotMaker draw;
};

RobotMaker SpatialOf(int count, const char* chain) {
  return Spatial(std::vector<std::string>(static_cast<size_t>(count), chain));
}

std::vector<Family> Families() {
  const RobotKind hidden = RobotKind::kHidden, real = RobotKind::kReal;
  return {{"hidden RRRRR", hidden, {0, 1}, Planar({"_RRR", "R_RR"})},
          {"hidden RPRPR", hidden, {0, 1}, Planar({"_RPR", "R_PR"})},
          {"hidden RRRRP", hidden, {0, 1}, Planar({"_RRR", "_PRR"})},
          {"hidden 3-RRR", hidden, {0, 1, 2}, Planar({"_RRR", "R_RR", "_RRR"})},
          {"hidden 3-RPR", hidden, {0, 1, 2}, Planar({"R_PR", "R_PR", "_RPR"})},
          {"hidden 3-PRR", hidden, {0, 1, 2}, Planar({"_PRR", "P_RR", "_PRR"})},
          {"hidden 3-UPS", hidden, {0, 2, 4}, SpatialOf(6, "U_PS")},
          {"hidden 3-PUS", hidden, {0, 2, 4}, SpatialOf(6, "_PUS")},
          {"hidden 3-RUS", hidden, {0, 2, 4}, SpatialOf(6, "_RUS")},
          {"hidden 3-RPS", hidden, {0, 1, 2}, SpatialOf(3, "R_PS")},
          {"hidden RPS-2-UPS", hidden, {0, 1, 2}, Spatial({"R_PS", "U_PS", "U_PS", "U_PS", "U_PS"})},
          {"hidden RRP-2-RRR", hidden, {0, 1, 2}, Planar({"_RRP", "_RRR", "R_RR"})},
          {"hidden PRP-PRR-RRR", hidden, {0, 1, 2}, Planar({"_PRP", "_PRR", "R_RR"})},
          {"hidden Quattro", hidden, {0, 3}, Quattro("_R-{2-US}")},
          {"hidden Quattro on rails", hidden, {1, 3}, Quattro("_P-{2-US}")},
          {"RRRRR", real, {0, 1}, Planar({"_RRR", "_RRR"})},
          {"3-RRR", real, {0, 1, 2}, Planar({"_RRR", "_RRR", "_RRR"})},
          {"3-RPR", real, {0, 1, 2}, Planar({"R_PR", "R_PR", "R_PR"})},
          {"3-PRR", real, {0, 1, 2}, Planar({"_PRR", "_PRR", "_PRR"})},
          {"RRRRP by their second R", real, {0, 1}, Planar({"R_RR", "P_RR"})},
          {"RPRPR by their R", real, {0, 1}, Planar({"_RPR", "_RPR"})},
          {"3-RRR by their second R", real, {0, 1, 2}, Planar({"R_RR", "R_RR", "R_RR"})},
          {"3-PRR by their R", real, {0, 1, 2}, Planar({"P_RR", "P_RR", "P_RR"})},
          {"3-RPR by their R", real, {0, 1, 2}, Planar({"_RPR", "_RPR", "_RPR"})},
          {"PPR, PPR, RRR", real, {0, 1, 2}, Planar({"_PPR", "P_PR", "R_RR"})},
          {"PRP, RRP, RRP", real, {0, 1, 2}, Planar({"_PRP", "_RRP", "R_RP"})},
          {"PRP, PRR, RRR", real, {0, 1, 2}, Planar({"P_RP", "P_RR", "_RRR"})},
          {"3-RPS", real, {0, 1, 2}, SpatialOf(3, "R_PS")},
          {"3-RPS by their R", real, {0, 1, 2}, SpatialOf(3, "_RPS")},
          {"2-RPS-2-UPS", real, {0, 1, 2, 3}, Spatial({"R_PS", "_RPS", "U_PS", "U_PS"})},
          {"hexapod", real, {0, 1, 2, 3, 4, 5}, SpatialOf(6, "U_PS")},
          {"6-RUS", real, {0, 1, 2, 3, 4, 5}, SpatialOf(6, "_RUS")},
          {"Delta", real, {0, 1, 2}, Delta("_R-{2-US}")},
          {"linear Delta", real, {0, 1, 2}, Delta("_P-{2-US}")},
          {"3-UPU", real, {0, 1, 2}, Delta("U_PU")},
          {"Quattro", real, {0, 1, 2, 3}, Quattro("_R-{2-US}")}};
}

Type2Measure MeasureAt(const Family& family, const Way& way, double s) {
  return Type2MeasureOf(way.robot, family.kind, family.legs, way.At(s)).value();
}

// No leg comes so near to Type 1 that it might pass it between the samples: there the condition may change
// its sign as well.
bool IsReached(const Way& way) {
  constexpr double kClearSine = 0.03;
  for (int i = 0; i <= 50; ++i) {
    const auto sine = Type1MeasureOf(way.robot, AllLegs(way.robot), way.At(i / 50.0));
    if (!sine || *sine < kClearSine) return false;
  }
  return true;
}

// A way at whose ends the condition has opposite signs and is not small.
Way WayThroughSingularity(const Family& family, std::mt19937_64& generator) {
  constexpr double kNotSmall = 1e-3;
  for (int draw = 0; draw < 100000; ++draw) {
    const RobotAtPose random = family.draw(generator);
    const auto basis = MotionBasis(random.robot, random.pose);
    Vector6d twist = Vector6d::Zero();
    for (Eigen::Index k = 0; k < basis.cols(); ++k) twist += Uniform(generator, -0.5, 0.5) * basis.col(k);
    Way way{random.robot, random.pose, twist};
    if (!IsReached(way)) continue;
    const double a = MeasureAt(family, way, 0).geometric.value(),
                 b = MeasureAt(family, way, 1).geometric.value();
    if (a * b < 0 && std::min(std::abs(a), std::abs(b)) > kNotSmall) return way;
  }
  throw std::logic_error("no way passes a singularity");
}

double ZeroOn(const Family& family, const Way& way) {
  double low = 0, high = 1;
  const double sign = MeasureAt(family, way, 0).geometric.value();
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (MeasureAt(family, way, middle).geometric.value() * sign > 0 ? low : high) = middle;
  }
  return low;
}

TEST(Type2Measure, OfMatricesIsZeroWhereThatOfGeometryIsAndNowhereElse) {
  std::mt19937_64 generator = TestGenerator();
  for (const Family& family : Families()) {
    SCOPED_TRACE(family.name);
    for (int n = 0; n < 20; ++n) {
      const Way way = WayThroughSingularity(family, generator);
      const double zero = ZeroOn(family, way);
      const Type2Measure there = MeasureAt(family, way, zero);
      EXPECT_LT(std::abs(there.geometric.value()), 1e-12);
      EXPECT_LT(there.matrix, 1e-6);
      for (const double s : {0.0, 1.0}) EXPECT_GT(MeasureAt(family, way, s).matrix, 1e-5);
      // Both leave zero together, in first order of the distance.
      for (const double beside : {zero - 1e-4, zero + 1e-4}) {
        const Type2Measure measure = MeasureAt(family, way, beside);
        EXPECT_GT(measure.matrix, 1e-12);
        EXPECT_NE(measure.geometric.value(), 0);
      }
    }
  }
}

// What is held of a leg, direction or reading, in three numbers.
Eigen::Vector3d HeldOf(RobotKind kind, const RobotLeg& leg, const Rigid3& pose) {
  const LegState state = StateOf(leg, pose).value();
  if (kind == RobotKind::kHidden) return state.direction;
  if (!ReadsAngle(leg.chain)) return {state.reading, 0, 0};
  return {std::cos(state.reading), std::sin(state.reading), 0};
}

// Smallest singular value of d(directions or readings)/d(twist) by differences, which has to vanish too.
TEST(Type2Measure, IsZeroWhereThePlatformMovesWithAllHeld) {
  std::mt19937_64 generator = TestGenerator();
  for (const Family& family : Families()) {
    SCOPED_TRACE(family.name);
    const Way way = WayThroughSingularity(family, generator);
    const Rigid3 pose = way.At(ZeroOn(family, way));
    const auto basis = MotionBasis(way.robot, pose);
    Eigen::MatrixXd rates(3 * family.legs.size(), basis.cols());
    for (size_t i = 0; i < family.legs.size(); ++i)
      for (Eigen::Index k = 0; k < basis.cols(); ++k) {
        const RobotLeg& leg = way.robot.legs[static_cast<size_t>(family.legs[i])];
        const auto held = [&](double step) {
          return HeldOf(family.kind, leg, Displaced(pose, step * basis.col(k)));
        };
        rates.block<3, 1>(static_cast<Eigen::Index>(3 * i), k) = (held(1e-5) - held(-1e-5)) / 2e-5;
      }
    const auto values = rates.jacobiSvd().singularValues();
    EXPECT_LT(values.tail<1>()[0], 1e-5 * values[0]);
  }
}

// There two assembly modes coincide, which rounding makes one, two or none: the pose is found all the same.
TEST(AssemblyModes, OfASingularPoseBeginWithThePose) {
  std::mt19937_64 generator = TestGenerator();
  for (const Family& family : Families()) {
    if (family.kind == RobotKind::kReal) continue;
    SCOPED_TRACE(family.name);
    for (int n = 0; n < 5; ++n) {
      const Way way = WayThroughSingularity(family, generator);
      const Rigid3 pose = way.At(ZeroOn(family, way));
      const AssemblyModes found = AssemblyModesOf(way.robot, family.legs, pose);
      EXPECT_EQ(found.why.empty(), found.status == AssemblyModesStatus::kComplete);
      if (found.status == AssemblyModesStatus::kInfinite) continue;
      ASSERT_FALSE(found.modes.empty());
      EXPECT_LT(Displacement(found.modes[0].base_from_platform, pose).norm(), 1e-6);
      EXPECT_LT(found.modes[0].largest_direction_error, 1e-9);
    }
  }
}

// With arms in parallel planes t_1 and t_2 turn about one axis, and can be parallel.
TEST(Type2Measure, OfADeltaPairIsZeroWhereItsTangentsAreParallel) {
  std::mt19937_64 generator = TestGenerator();
  int checked = 0;
  while (checked < 20) {
    RobotAtPose random = RandomTranslationRobot(generator, {"_R-{2-US}", "_R-{2-US}"});
    random.robot.legs[1].first_axis = random.robot.legs[0].first_axis;
    random.robot.legs[1].zero_direction = random.robot.legs[0].zero_direction;
    const Family family{"", RobotKind::kHidden, {0, 1}, {}};
    Way way{random.robot, random.pose, Vector6d::Zero()};
    way.twist.head<3>() = UniformVector(generator, -0.4, 0.4);
    if (!IsReached(way)) continue;
    const auto sine = [&](double s) {
      const Rigid3 pose = way.At(s);
      return StateOf(random.robot.legs[0], pose)
          ->free_direction.cross(StateOf(random.robot.legs[1], pose)->free_direction)
          .dot(random.robot.legs[0].first_axis);
    };
    if (sine(0) * sine(1) > 0) continue;
    double low = 0, high = 1;
    for (int i = 0; i < 100; ++i) (sine((low + high) / 2) * sine(0) > 0 ? low : high) = (low + high) / 2;
    EXPECT_LT(MeasureAt(family, way, low).geometric.value(), 1e-9);
    EXPECT_LT(MeasureAt(family, way, low).matrix, 1e-6);
    EXPECT_GT(MeasureAt(family, way, 0).matrix, 1e-6);
    ++checked;
  }
}

// Section 4.2.2 names parallel planes, t_1 parallel to t_2, as the singularity of a Quattro's pair. They are
// one, but not the only one: the platform may also turn.
TEST(Type2Measure, OfAQuattroPairIsZeroAlsoWherePlanesAreNotParallel) {
  std::mt19937_64 generator = TestGenerator();
  const Family family{"hidden Quattro", RobotKind::kHidden, {0, 3}, Quattro("_R-{2-US}")};
  int not_parallel = 0;
  for (int n = 0; n < 20; ++n) {
    const Way way = WayThroughSingularity(family, generator);
    const Rigid3 pose = way.At(ZeroOn(family, way));
    const Eigen::Vector3d t1 = StateOf(way.robot.legs[0], pose)->free_direction;
    const Eigen::Vector3d t2 = StateOf(way.robot.legs[3], pose)->free_direction;
    EXPECT_LT(Type2MeasureOf(way.robot, RobotKind::kHidden, {0, 3}, pose)->matrix, 1e-6);
    if (t1.cross(t2).norm() > 0.1) ++not_parallel;
  }
  EXPECT_GT(not_parallel, 0);
}

TEST(Type2Measure, OfAQuattroPairIsZeroWherePlanesAreParallel) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 20; ++n) {
    RobotAtPose random = RandomSchoenfliesRobot(generator, "_P-{2-US}");
    random.robot.legs[2].first_axis = random.robot.legs[0].first_axis;
    if (!StateOf(random.robot.legs[2], random.pose)) continue;
    const Type2Measure found = Type2MeasureOf(random.robot, RobotKind::kHidden, {0, 2}, random.pose).value();
    EXPECT_LT(std::abs(found.geometric.value()), 1e-15);
    EXPECT_LT(found.matrix, 1e-12);
  }
}

TEST(Type2Measure, HasAGeometricConditionForAsManyLegsAsThePlatformNeedsAlone) {
  std::mt19937_64 generator = TestGenerator();
  const RobotAtPose hexapod = RandomSpatialRobot(generator, std::vector<std::string>(6, "U_PS"));
  const auto geometric = [](const RobotAtPose& random, RobotKind kind, const std::vector<int>& legs) {
    return Type2MeasureOf(random.robot, kind, legs, random.pose)->geometric.has_value();
  };
  EXPECT_TRUE(geometric(hexapod, RobotKind::kHidden, {0, 1, 2}));
  EXPECT_FALSE(geometric(hexapod, RobotKind::kHidden, {0, 1, 2, 3}));
  EXPECT_FALSE(geometric(hexapod, RobotKind::kHidden, {0, 1}));
  EXPECT_TRUE(geometric(hexapod, RobotKind::kReal, {0, 1, 2, 3, 4, 5}));
  const RobotAtPose rail = RandomPlanarRobot(generator, {"P_RP", "_RRR", "R_RR"});
  EXPECT_TRUE(geometric(rail, RobotKind::kReal, {0, 1, 2}));
  EXPECT_TRUE(geometric(rail, RobotKind::kHidden, {0, 1, 2}));
  const RobotAtPose constant = RandomPlanarRobot(generator, {"_PPR", "_RRR", "_RRR"});
  EXPECT_TRUE(geometric(constant, RobotKind::kReal, {0, 1, 2}));
  EXPECT_FALSE(geometric(constant, RobotKind::kHidden, {0, 1, 2}));  // its direction tells nothing
  const RobotAtPose mixed = RandomSpatialRobot(generator, {"R_PS", "U_PS", "U_PS", "U_PS", "U_PS"});
  EXPECT_TRUE(geometric(mixed, RobotKind::kReal, {0, 1, 2, 3, 4}));
  EXPECT_TRUE(geometric(mixed, RobotKind::kHidden, {0, 1, 2}));
  EXPECT_FALSE(geometric(mixed, RobotKind::kHidden, {1, 2, 3}));  // and what the first leg's R forbids
}

// Out along a direction until a leg is stretched or folded.
// Of every matrix in the balls, also where all middles of a column are 0.
TEST(DeterminantOfBalls, EnclosesThatOfEveryMatrix) {
  using Balls = Eigen::Matrix<RealBall, Eigen::Dynamic, Eigen::Dynamic>;
  const auto determinant = [](const Balls& balls) {
    return singularity_geometry::DeterminantOf<RealBall>(balls);
  };
  const RealBall about_zero(0, 0.1);
  Balls balls(2, 2);
  balls << about_zero, RealBall(1), about_zero, RealBall(2);
  EXPECT_TRUE(Contains(determinant(balls), 0.3));
  EXPECT_TRUE(Contains(determinant(balls), -0.3));
  balls(0, 0) = RealBall(0);
  EXPECT_TRUE(Contains(determinant(balls), 0.1));
  balls(1, 0) = RealBall(0);
  EXPECT_EQ(LargestModulus(determinant(balls)), 0);
  balls << RealBall(1), RealBall(0), RealBall(0), about_zero;
  EXPECT_TRUE(Contains(determinant(balls), 0.1));
  EXPECT_EQ(singularity_geometry::DeterminantOf<double>(Eigen::Matrix2d{{0, 1}, {0, 2}}), 0);
}

TEST(Type1Measure, VanishesWhereALegJustReaches) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 50; ++n)
    for (const RobotAtPose& random :
         {RandomPlanarRobot(generator, {"_RRR", "_PRR", "R_RR"}),
          RandomPlanarRobot(generator, {"_RRP", "R_RP", "_RRP"}),
          RandomTranslationRobot(generator, {"_R-{2-US}", "_P-{2-US}", "_RUU"})}) {
      Vector6d way = Vector6d::Zero();
      way.head<3>() = MotionBasis(random.robot, random.pose).leftCols<2>().topRows<3>() *
                      Eigen::Vector2d(Uniform(generator, -20, 20), Uniform(generator, 16, 20));
      double low = 0, high = 1;
      const auto at = [&](double s) {
        return Type1MeasureOf(random.robot, AllLegs(random.robot), Displaced(random.pose, s * way));
      };
      ASSERT_FALSE(at(high).has_value());
      for (int i = 0; i < 60; ++i) (at((low + high) / 2) ? low : high) = (low + high) / 2;
      EXPECT_LT(at(low).value(), 1e-5);
      EXPECT_GT(at(0).value(), 0.1);
    }
}

TEST(Type1Measure, OfLegsThatOnlyExtendIsOne) {
  std::mt19937_64 generator = TestGenerator();
  const RobotAtPose hexapod = RandomSpatialRobot(generator, std::vector<std::string>(6, "U_PS"));
  EXPECT_NEAR(Type1MeasureOf(hexapod.robot, {0, 3}, hexapod.pose).value(), 1, 1e-15);
}

TEST(Type2Measure, IsNothingWhereALegDoesNotReach) {
  std::mt19937_64 generator = TestGenerator();
  RobotAtPose random = RandomTranslationRobot(generator, {"_R-{2-US}", "_R-{2-US}", "_R-{2-US}"});
  random.pose.translation.z() -= 5;
  EXPECT_FALSE(Type2MeasureOf(random.robot, RobotKind::kHidden, {0, 1}, random.pose).has_value());
  EXPECT_FALSE(Type1MeasureOf(random.robot, {0, 1}, random.pose).has_value());
}

}  // namespace
}  // namespace legible
