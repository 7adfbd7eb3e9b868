#include "core/hidden/map_slice.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>

#include "core/robots/platform_motion.h"
#include "tests/testing/random.h"
#include "tests/testing/random_robots.h"

namespace legible {
namespace {

constexpr double kHalfAngle_rad = 1e-3;

// Two extensible legs from (-1, 0) and (1, 0) that meet in a point.
ParallelRobot TwoExtensibleLegs() {
  ParallelRobot robot;
  robot.motion = PlatformMotion::kPlanarPoint;
  robot.home.translation = {0, 1, 0};
  for (const double x_m : {-1.0, 1.0}) {
    RobotLeg leg;
    leg.chain = ChainFromText("R_PR");
    leg.base_joint_m = {x_m, 0, 0};
    leg.joint_range = {0.51, 2.53};
    robot.legs.push_back(leg);
  }
  return robot;
}

PoseSlice AroundTheBase() {
  PoseSlice slice;
  slice.first = Eigen::VectorXd::LinSpaced(31, -3, 3);
  slice.second = Eigen::VectorXd::LinSpaced(20, -1.9, 1.9);  // none is 0
  return slice;
}

Eigen::Vector2d PointOf(const PoseSlice& slice, Eigen::Index cell) {
  return {slice.first[cell % slice.first.size()], slice.second[cell / slice.first.size()]};
}

// With its legs' directions held, the point stays where two lines cross, unless they are one: on the line of
// the base joints. With their lengths held it is where two circles cross, which touch on the same line.
TEST(MapSlice, SignsOfAPointOnTwoExtensibleLegsChangeOnTheLineOfItsBaseJointsAlone) {
  const ParallelRobot robot = TwoExtensibleLegs();
  const SliceMap map = MapSlice(robot, AroundTheBase(), {{0, 1}}, kHalfAngle_rad);
  ASSERT_EQ(map.states.size(), static_cast<size_t>(map.slice.CellCount()));
  const auto sign_above = std::copysign(1.0, *map.sets[0].hidden.type_2.back()->geometric);
  const auto real_above = std::copysign(1.0, *map.real.type_2.back()->geometric);
  for (size_t cell = 0; cell < map.states.size(); ++cell) {
    const double side = PointOf(map.slice, static_cast<Eigen::Index>(cell)).y() > 0 ? 1 : -1;
    EXPECT_GT(side * sign_above * *map.sets[0].hidden.type_2[cell]->geometric, 0);
    EXPECT_GT(side * real_above * *map.real.type_2[cell]->geometric, 0);
    EXPECT_DOUBLE_EQ(*map.real.type_1[cell], 1);
  }
}

TEST(MapSlice, CellsOutsideTheJointRangesAreThoseOutsideTheRings) {
  const ParallelRobot robot = TwoExtensibleLegs();
  const SliceMap map = MapSlice(robot, AroundTheBase(), {}, kHalfAngle_rad);
  for (size_t cell = 0; cell < map.states.size(); ++cell) {
    const Eigen::Vector2d point = PointOf(map.slice, static_cast<Eigen::Index>(cell));
    bool is_fine = true;
    for (const double x_m : {-1.0, 1.0}) {
      const double length_m = (point - Eigen::Vector2d(x_m, 0)).norm();
      is_fine = is_fine && length_m >= 0.51 && length_m <= 2.53;
    }
    EXPECT_EQ(map.states[cell] == CellState::kFine, is_fine) << point.transpose();
  }
}

// Triangulation: rays of length r1, r2 that cross at an angle c move their crossing by the diagonal of a
// rhombus-like cell, psi / sin c sqrt(r1^2 + r2^2 + 2 r1 r2 |cos c|).
TEST(MapSlice, LargestErrorOfTwoRaysIsThatOfTriangulation) {
  const ParallelRobot robot = TwoExtensibleLegs();
  const SliceMap map = MapSlice(robot, AroundTheBase(), {{0, 1}}, kHalfAngle_rad);
  for (size_t cell = 0; cell < map.states.size(); ++cell) {
    const Eigen::Vector2d point = PointOf(map.slice, static_cast<Eigen::Index>(cell));
    const Eigen::Vector2d a = point - Eigen::Vector2d(-1, 0), b = point - Eigen::Vector2d(1, 0);
    const double cosine = a.normalized().dot(b.normalized());
    const double expected_m =
        kHalfAngle_rad / std::sqrt(1 - cosine * cosine) *
        std::sqrt(a.squaredNorm() + b.squaredNorm() + 2 * a.norm() * b.norm() * std::abs(cosine));
    EXPECT_NEAR(map.sets[0].errors[cell]->position_m, expected_m, 1.1e-3 * expected_m) << point.transpose();
  }
}

PoseSlice SliceAround(const Rigid3& pose, const std::array<int, 2>& axes, double reach) {
  PoseSlice slice;
  slice.axes = axes;
  slice.held = CoordinatesOf(pose);
  slice.first = slice.held[axes[0]] + Eigen::ArrayXd::LinSpaced(5, -reach, reach);
  slice.second = slice.held[axes[1]] + Eigen::ArrayXd::LinSpaced(5, -reach, reach);
  return slice;
}

TEST(MapSlice, PosesOfRpsRobotsAreOnTheirCellsAndSuchThatTheirLegsAllow) {
  std::mt19937_64 generator = TestGenerator();
  int tried = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const RobotAtPose random = RandomSpatialRobot(generator, {"R_PS", "R_PS", "R_PS"});
    const Eigen::MatrixXd rates = CoordinateRates(random.robot, random.pose)(std::array{2, 3}, Eigen::all);
    if (rates.jacobiSvd().singularValues()[1] < 0.3) continue;  // one follows from the other
    ++tried;
    const PoseSlice slice = SliceAround(random.pose, {2, 3}, 0.03);
    for (Eigen::Index cell = 0; cell < slice.CellCount(); ++cell) {
      const auto pose = PoseOfCell(random.robot, slice, cell);
      ASSERT_TRUE(pose) << "trial " << trial << ", cell " << cell;
      EXPECT_TRUE(CanTake(random.robot, *pose));
      const Vector6d coordinates = CoordinatesOf(*pose);
      EXPECT_NEAR(coordinates[2], slice.first[cell % 5], 1e-9);
      EXPECT_NEAR(coordinates[3], slice.second[cell / 5], 1e-9);
    }
  }
  EXPECT_GT(tried, 5);
}

// Three legs in planes through the axis of symmetry: a platform that is level stays on the axis and does not
// turn about it.
TEST(MapSlice, NoPoseIsOnACellToWhichRpsLegsDoNotLetThePlatform) {
  ParallelRobot robot;
  robot.home.translation.z() = 0.5;
  for (const double angle_rad : {0.0, 2.0, 4.0}) {
    RobotLeg leg;
    leg.chain = ChainFromText("R_PS");
    const Eigen::Vector3d out(std::cos(angle_rad), std::sin(angle_rad), 0);
    leg.base_joint_m = 0.3 * out;
    leg.platform_joint_m = 0.2 * out;
    leg.first_axis = Eigen::Vector3d::UnitZ().cross(out);
    robot.legs.push_back(leg);
  }
  const Eigen::VectorXd moved = CoordinateRates(robot, robot.home).rowwise().norm();
  for (const int coordinate : {0, 1, 5}) EXPECT_LT(moved[coordinate], 1e-12);
  for (const int coordinate : {2, 3, 4}) EXPECT_GT(moved[coordinate], 0.5);
  PoseSlice slice = SliceAround(robot.home, {0, 1}, 0.2);
  for (Eigen::Index cell = 0; cell < slice.CellCount(); ++cell)
    EXPECT_EQ(PoseOfCell(robot, slice, cell).has_value(), cell == slice.CellCount() / 2) << cell;
  slice = SliceAround(robot.home, {2, 3}, 0.2);
  for (Eigen::Index cell = 0; cell < slice.CellCount(); ++cell)
    EXPECT_TRUE(PoseOfCell(robot, slice, cell)) << cell;
}

TEST(MapSlice, RatesOfCoordinatesAreThoseOfSmallDisplacements) {
  std::mt19937_64 generator = TestGenerator();
  for (const auto& chains : {std::vector<std::string>{"R_PS", "R_PS", "R_PS"}, {"U_PS", "R_PS", "U_PS"}}) {
    const RobotAtPose random = RandomSpatialRobot(generator, chains);
    const double size_m = SizeOf_m(random.robot, random.pose), step = 1e-6;
    const Eigen::MatrixXd basis = MotionBasisInSize(random.robot, random.pose, size_m);
    const Eigen::MatrixXd rates = CoordinateRates(random.robot, random.pose);
    ASSERT_EQ(rates.cols(), basis.cols());
    for (Eigen::Index k = 0; k < basis.cols(); ++k) {
      Vector6d numeric = (CoordinatesOf(Displaced(random.pose, step * basis.col(k))) -
                          CoordinatesOf(Displaced(random.pose, -step * basis.col(k)))) /
                         (2 * step);
      numeric.head<3>() /= size_m;
      EXPECT_LT((numeric - rates.col(k)).norm(), 1e-7);
    }
  }
}

TEST(MapSlice, NothingIsSaidOfCellsThatALegDoesNotReach) {
  ParallelRobot robot = TwoExtensibleLegs();
  for (RobotLeg& leg : robot.legs) {
    leg.chain = ChainFromText("_RRR");
    leg.arm_m = leg.rod_m = 0.75;
    leg.joint_range.reset();
  }
  robot.legs[1].working_mode = -1;
  const SliceMap map = MapSlice(robot, AroundTheBase(), {{0, 1}}, kHalfAngle_rad);
  for (size_t cell = 0; cell < map.states.size(); ++cell) {
    const Eigen::Vector2d point = PointOf(map.slice, static_cast<Eigen::Index>(cell));
    const bool reaches =
        (point - Eigen::Vector2d(-1, 0)).norm() < 1.5 && (point - Eigen::Vector2d(1, 0)).norm() < 1.5;
    EXPECT_EQ(map.states[cell] == CellState::kFine, reaches) << point.transpose();
    EXPECT_EQ(map.sets[0].hidden.type_2[cell].has_value(), reaches);
    EXPECT_EQ(map.real.type_1[cell].has_value(), reaches);
    EXPECT_EQ(map.sets[0].errors[cell].has_value(), reaches);
  }
}

}  // namespace
}  // namespace legible
