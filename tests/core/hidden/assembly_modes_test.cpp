#include "core/hidden/assembly_modes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "core/robots/leg_state.h"
#include "core/robots/platform_motion.h"
#include "tests/testing/random.h"
#include "tests/testing/random_robots.h"

namespace legible {
namespace {

const std::vector<std::string> kDeltaChains = {"_R-{2-US}", "_R-{2-US}", "_R-{2-US}"};
const std::vector<std::string> kHexapodChains(6, "U_PS");

// Two directions of a Delta leave its platform on two circles in different planes, which meet where the line
// common to both planes passes them: at the pose and, if both pass the line there again, once more.
TEST(AssemblyModes, OfADeltaPairIsThePoseAlone) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 1000; ++n) {
    const RobotAtPose random = RandomTranslationRobot(generator, kDeltaChains);
    const AssemblyModes found = AssemblyModesOf(random.robot, {0, 2}, random.pose);
    EXPECT_EQ(found.status, AssemblyModesStatus::kComplete);
    ASSERT_EQ(found.modes.size(), 1);
    EXPECT_LT(Displacement(found.modes[0].base_from_platform, random.pose).norm(), 1e-9);
  }
}

Eigen::Vector3d Mirrored(const Eigen::Vector3d& x) { return {x.x(), -x.y(), x.z()}; }

// Legs that mirror each other in y = 0, at a pose there: both circles pass that plane at the same two points.
TEST(AssemblyModes, OfAMirroredDeltaPairAreTwo) {
  std::mt19937_64 generator = TestGenerator();
  int found_two = 0;
  for (int n = 0; n < 1000; ++n) {
    RobotAtPose random = RandomTranslationRobot(generator, {"_R-{2-US}"});
    random.robot.home.rotation.setIdentity();
    random.pose = random.robot.home;
    random.pose.translation.y() = 0;
    RobotLeg other = random.robot.legs[0];
    for (Eigen::Vector3d* x :
         {&other.base_joint_m, &other.zero_direction, &other.platform_joint_m, &other.carried_offset_m})
      *x = Mirrored(*x);
    other.first_axis = -Mirrored(other.first_axis);  // an axial vector
    random.robot.legs.push_back(other);
    if (!StateOf(random.robot.legs[0], random.pose)) continue;
    const AssemblyModes found = AssemblyModesOf(random.robot, {0, 1}, random.pose);
    EXPECT_EQ(found.status, AssemblyModesStatus::kComplete);
    ASSERT_EQ(found.modes.size(), 2);
    EXPECT_NEAR(found.modes[1].base_from_platform.translation.y(), 0, 1e-9);
    EXPECT_LT(found.modes[1].largest_direction_error, 1e-9);
    ++found_two;
  }
  EXPECT_GT(found_two, 500);
}

TEST(AssemblyModes, OfThreeUpuPairsIsThePoseAlone) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 200; ++n) {
    const RobotAtPose random = RandomTranslationRobot(generator, {"U_PU", "U_PU", "_P-{2-US}"});
    for (const std::vector<int>& legs : {std::vector<int>{0, 1}, {0, 2}, {0, 1, 2}}) {
      const AssemblyModes found = AssemblyModesOf(random.robot, legs, random.pose);
      EXPECT_EQ(found.status, AssemblyModesStatus::kComplete);
      EXPECT_EQ(found.modes.size(), 1);
    }
  }
}

// A leg more takes modes away and adds none.
TEST(AssemblyModes, OfMoreLegsAreAmongThoseOfFewer) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 50; ++n)
    for (const RobotAtPose& random :
         {RandomSpatialRobot(generator, kHexapodChains), RandomSchoenfliesRobot(generator, "_R-{2-US}"),
          RandomPlanarRobot(generator, {"_RRR", "_RRR", "_RRR", "_RRR"})}) {
      const std::vector<int> fewer = random.robot.motion == PlatformMotion::kSchoenflies
                                         ? std::vector<int>{0, 2}
                                         : std::vector<int>{0, 1, 2};
      const AssemblyModes few = AssemblyModesOf(random.robot, fewer, random.pose);
      const AssemblyModes all = AssemblyModesOf(random.robot, AllLegs(random.robot), random.pose);
      ASSERT_FALSE(all.modes.empty());
      EXPECT_LT(Displacement(all.modes[0].base_from_platform, random.pose).norm(), 1e-8);
      EXPECT_LE(all.modes.size(), few.modes.size());
      for (const AssemblyMode& mode : all.modes)
        EXPECT_TRUE(std::any_of(few.modes.begin(), few.modes.end(), [&](const AssemblyMode& other) {
          return Displacement(mode.base_from_platform, other.base_from_platform).norm() < 1e-7;
        }));
    }
}

TEST(AssemblyModes, AreInOrderOfDistanceFromThePose) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 50; ++n) {
    const RobotAtPose random = RandomSpatialRobot(generator, kHexapodChains);
    const AssemblyModes found = AssemblyModesOf(random.robot, {0, 2, 4}, random.pose);
    const auto distance = [&](const AssemblyMode& mode) {
      return Displacement(random.pose, mode.base_from_platform).norm();
    };
    EXPECT_TRUE(std::is_sorted(found.modes.begin(), found.modes.end(),
                               [&](const auto& a, const auto& b) { return distance(a) < distance(b); }));
  }
}

// At a reversed pose no leg's direction differs from the wanted one but by its sign, and one does differ.
TEST(AssemblyModes, ReversedPosesHaveALegThatPointsTheOtherWay) {
  std::mt19937_64 generator = TestGenerator();
  int reversed = 0;
  for (int n = 0; n < 100; ++n) {
    const RobotAtPose random = RandomSpatialRobot(generator, kHexapodChains);
    const AssemblyModes found = AssemblyModesOf(random.robot, {0, 2, 4}, random.pose);
    for (const Rigid3& pose : found.reversed) {
      double least_cosine = 1;
      for (const int i : {0, 2, 4}) {
        const RobotLeg& leg = random.robot.legs[static_cast<size_t>(i)];
        const Eigen::Vector3d wanted = StateOf(leg, random.pose)->direction;
        const Eigen::Vector3d there = StateOf(leg, pose).value().direction;
        EXPECT_LT(there.cross(wanted).norm(), 1e-9);
        least_cosine = std::min(least_cosine, there.dot(wanted));
      }
      EXPECT_LT(least_cosine, -0.99);
      ++reversed;
    }
  }
  EXPECT_GT(reversed, 0);
}

TEST(AssemblyModes, AreInfiniteWhereTheDirectionsDoNotHoldThePlatform) {
  std::mt19937_64 generator = TestGenerator();
  const auto status = [](const RobotAtPose& random, const std::vector<int>& legs) {
    return AssemblyModesOf(random.robot, legs, random.pose).status;
  };
  const RobotAtPose hexapod = RandomSpatialRobot(generator, kHexapodChains);
  EXPECT_EQ(status(hexapod, {0, 1}), AssemblyModesStatus::kInfinite);
  EXPECT_EQ(status(RandomPlanarRobot(generator, {"_RRR", "_PRP", "_PRP"}), {0, 1, 2}),
            AssemblyModesStatus::kInfinite);
  const RobotAtPose quattro = RandomSchoenfliesRobot(generator, "_R-{2-US}");
  EXPECT_EQ(status(quattro, {0, 1}), AssemblyModesStatus::kInfinite);  // both hold the same half
  EXPECT_EQ(status(quattro, {0, 2}), AssemblyModesStatus::kComplete);
  RobotAtPose in_line = hexapod;
  in_line.robot.legs[2].platform_joint_m =
      2 * in_line.robot.legs[1].platform_joint_m - in_line.robot.legs[0].platform_joint_m;
  EXPECT_EQ(status(in_line, {0, 1, 2}), AssemblyModesStatus::kInfinite);
}

// The seen directions, one after the other.
Eigen::VectorXd DirectionsAt(const ParallelRobot& robot, const std::vector<int>& legs, const Rigid3& pose) {
  const auto states = StatesOf(robot, legs, pose).value();
  Eigen::VectorXd directions(3 * static_cast<Eigen::Index>(legs.size()));
  for (size_t k = 0; k < states.size(); ++k)
    directions.segment<3>(static_cast<Eigen::Index>(3 * k)) = states[k].direction;
  return directions;
}

// How far the platform moves with all seen directions held: along the motion that they do not tell, by
// differences, step by step, and back onto the directions after each.
double UnseenWay(const RobotAtPose& random, const std::vector<int>& legs) {
  constexpr double kStep = 2e-3, kDifference = 1e-6;
  constexpr int kSteps = 12, kCorrections = 8;
  const Eigen::VectorXd wanted = DirectionsAt(random.robot, legs, random.pose);
  const auto rates_at = [&](const Rigid3& pose, const auto& basis) {
    Eigen::MatrixXd rates(wanted.size(), basis.cols());
    for (Eigen::Index k = 0; k < basis.cols(); ++k)
      rates.col(k) = (DirectionsAt(random.robot, legs, Displaced(pose, kDifference * basis.col(k))) -
                      DirectionsAt(random.robot, legs, Displaced(pose, -kDifference * basis.col(k)))) /
                     (2 * kDifference);
    return rates;
  };
  Rigid3 pose = random.pose;
  Vector6d last = Vector6d::Zero();
  for (int step = 0; step < kSteps; ++step) {
    const auto basis = MotionBasis(random.robot, pose);
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(rates_at(pose, basis), Eigen::ComputeFullV);
    svd.setThreshold(1e-6);
    const Eigen::Index unseen = std::max<Eigen::Index>(basis.cols() - svd.rank(), 1);
    const Eigen::MatrixXd kernel = basis * svd.matrixV().rightCols(unseen);
    last = step == 0 ? Vector6d(kernel.col(0)) : Vector6d(kernel * (kernel.transpose() * last)).normalized();
    Rigid3 next = BackToMotion(random.robot, Displaced(pose, kStep * last));
    for (int i = 0; i < kCorrections; ++i) {
      const auto of_next = MotionBasis(random.robot, next);
      Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
      solver.setThreshold(1e-6);  // of differences
      solver.compute(rates_at(next, of_next));
      const Eigen::VectorXd off = wanted - DirectionsAt(random.robot, legs, next);
      next = BackToMotion(random.robot, Displaced(next, of_next * solver.solve(off)));
    }
    if ((wanted - DirectionsAt(random.robot, legs, next)).norm() > 1e-8) break;
    pose = next;
  }
  return Displacement(random.pose, pose).norm();
}

std::vector<std::vector<int>> SubsetsOf(const ParallelRobot& robot) {
  std::vector<std::vector<int>> subsets;
  for (unsigned bits = 1; bits < 1u << robot.legs.size(); ++bits) {
    subsets.emplace_back();
    for (int leg = 0; leg < static_cast<int>(robot.legs.size()); ++leg)
      if ((bits >> leg & 1u) != 0) subsets.back().push_back(leg);
  }
  return subsets;
}

// All that infinite can mean: from such a pose the platform goes on and on with every direction held; and
// where it is not said, the pose is alone.
TEST(AssemblyModes, AreInfiniteExactlyWhereThePlatformMovesWithAllDirectionsHeld) {
  std::mt19937_64 generator = TestGenerator();
  const std::vector<RobotAtPose> robots = {RandomPlanarRobot(generator, {"_RRR", "_PRR", "_RRR", "R_PR"}),
                                           RandomPlanarRobot(generator, {"_RRR", "_RRR", "_PRP"}),
                                           RandomPlanarRobot(generator, {"_RRR", "_PRP", "_RRP"}),
                                           RandomSpatialRobot(generator, {"R_PS", "R_PS", "R_PS"}),
                                           RandomSpatialRobot(generator, {"R_PS", "R_PS", "R_PS", "R_PS"}),
                                           RandomSpatialRobot(generator, {"R_PS", "U_PS", "U_PS", "R_PS"}),
                                           RandomSpatialRobot(generator, {"_RUS", "U_PS", "U_PS", "U_PS"}),
                                           RandomTranslationRobot(generator, kDeltaChains),
                                           RandomSchoenfliesRobot(generator, "_R-{2-US}")};
  int infinite = 0, others = 0;
  for (const RobotAtPose& random : robots)
    for (const std::vector<int>& legs : SubsetsOf(random.robot)) {
      SCOPED_TRACE(random.robot.name + " " + testing::PrintToString(legs));
      const AssemblyModes found = AssemblyModesOf(random.robot, legs, random.pose);
      const bool is_infinite = found.status == AssemblyModesStatus::kInfinite;
      EXPECT_EQ(is_infinite, UnseenWay(random, legs) > 0.01) << found.why;
      EXPECT_NE(found.why.empty(), found.status != AssemblyModesStatus::kComplete);
      ++(is_infinite ? infinite : others);
    }
  EXPECT_GT(infinite, 20);
  EXPECT_GT(others, 20);
}

// A first-order turn about z that no direction shows, A_i = C_i - l z x C_i, but no motion: of four legs
// three have their platform joints on one line and leave the platform free by themselves, all together do
// not.
TEST(AssemblyModes, OfASingularPoseAreNotInfiniteForThreeLegsThatLeaveThePlatformFree) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 20; ++n) {
    RobotAtPose random = RandomSpatialRobot(generator, kHexapodChains);
    random.pose = random.robot.home = {};
    for (size_t i = 0; i < 6; ++i) {
      RobotLeg& leg = random.robot.legs[i];
      leg.platform_joint_m = {Uniform(generator, -0.3, 0.3), Uniform(generator, -0.3, 0.3), 0.0};
      if (i < 3) leg.platform_joint_m = {0.1 + 0.1 * static_cast<double>(i), 0.15, 0.0};
      leg.base_joint_m = leg.platform_joint_m -
                         Uniform(generator, 0.5, 2) * Eigen::Vector3d::UnitZ().cross(leg.platform_joint_m);
    }
    EXPECT_EQ(AssemblyModesOf(random.robot, {0, 1, 2}, random.pose).status, AssemblyModesStatus::kInfinite);
    EXPECT_EQ(AssemblyModesOf(random.robot, {0, 1, 2, 3}, random.pose).status,
              AssemblyModesStatus::kIncomplete);
    EXPECT_LT(UnseenWay(random, {0, 1, 2, 3}), 0.01);
  }
}

// The same, but for a millionth of the platform by which the three joints are off one line.
TEST(AssemblyModes, OfJointsNearlyOnOneLineAreNeitherInfiniteNorComplete) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 20; ++n) {
    RobotAtPose random = RandomSpatialRobot(generator, kHexapodChains);
    random.pose = random.robot.home = {};
    for (size_t i = 0; i < 3; ++i) {
      RobotLeg& leg = random.robot.legs[i];
      leg.platform_joint_m = {0.1 + 0.1 * static_cast<double>(i), i == 1 ? 0.150001 : 0.15, 0.0};
      leg.base_joint_m = leg.platform_joint_m -
                         Uniform(generator, 0.5, 2) * Eigen::Vector3d::UnitZ().cross(leg.platform_joint_m);
    }
    const AssemblyModes found = AssemblyModesOf(random.robot, {0, 1, 2}, random.pose);
    EXPECT_EQ(found.status, AssemblyModesStatus::kIncomplete);
    EXPECT_THAT(found.why, testing::HasSubstr("nearly on one line"));
  }
}

// Both directions are across the line of the platform joints: at the pose the legs hold it along one normal,
// around it along two, of three freedoms.
TEST(AssemblyModes, AreNotInfiniteWhereThePoseLosesMoreThanThoseAroundIt) {
  ParallelRobot robot;
  robot.motion = PlatformMotion::kPlanar;
  for (const int side : {-1, 1}) {
    RobotLeg leg;
    leg.chain = ChainFromText("_RRR");
    leg.base_joint_m = {1.5 * side, -1, 0};
    leg.platform_joint_m = {0.5 * side, 0, 0};
    leg.arm_m = leg.rod_m = 1;
    leg.working_mode = side;
    robot.legs.push_back(leg);
  }
  for (const RobotLeg& leg : robot.legs)
    ASSERT_LT((StateOf(leg, {})->direction - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  const AssemblyModes found = AssemblyModesOf(robot, {0, 1}, {});
  EXPECT_EQ(found.status, AssemblyModesStatus::kIncomplete);
  EXPECT_THAT(found.why, testing::HasSubstr("around the pose"));
  ASSERT_EQ(found.modes.size(), 1);
  EXPECT_LT(Displacement(found.modes[0].base_from_platform, {}).norm(), 1e-12);
}

// A PRP leg's direction is the platform's: of the modes of the others it leaves those with its orientation.
TEST(AssemblyModes, AreSievedByALegWhoseDirectionIsThePlatforms) {
  std::mt19937_64 generator = TestGenerator();
  int sieved = 0;
  for (int n = 0; n < 100; ++n) {
    const RobotAtPose random = RandomPlanarRobot(generator, {"_RRR", "_RRR", "_RRR", "_PRP"});
    const AssemblyModes all = AssemblyModesOf(random.robot, AllLegs(random.robot), random.pose);
    const AssemblyModes without = AssemblyModesOf(random.robot, {0, 1, 2}, random.pose);
    ASSERT_FALSE(all.modes.empty());
    sieved += static_cast<int>(without.modes.size() - all.modes.size());
    for (const AssemblyMode& mode : all.modes)
      for (RobotLeg leg : random.robot.legs) {
        const Eigen::Vector3d wanted = StateOf(leg, random.pose)->direction;
        double error = 2;
        for (int i = 0; i < 2; ++i, leg.working_mode = -leg.working_mode)
          error = std::min(error, (StateOf(leg, mode.base_from_platform)->direction - wanted).norm());
        EXPECT_LT(error, 1e-9);
      }
  }
  EXPECT_GT(sieved, 20);
}

// A second pose of the robot's three legs; nothing where there is none.
std::optional<Rigid3> SecondModeOfThree(const RobotAtPose& random) {
  const AssemblyModes three = AssemblyModesOf(random.robot, {0, 1, 2}, random.pose);
  if (three.status != AssemblyModesStatus::kComplete || three.modes.size() < 2) return std::nullopt;
  return three.modes[1].base_from_platform;
}

void ExpectCompleteOnlyWith(const Rigid3& mode, const AssemblyModes& found) {
  const bool has_mode = std::any_of(found.modes.begin(), found.modes.end(), [&](const AssemblyMode& it) {
    return Displacement(it.base_from_platform, mode).norm() < 1e-6;
  });
  EXPECT_TRUE(has_mode || found.status != AssemblyModesStatus::kComplete);
}

// A leg that has the direction u at a pose, and the same where it is stretched: B is the arm's length from A
// at both, |D + arm u| = arm with D from the platform joint at the second to that at the first.
std::optional<RobotLeg> LegStretchedAt(std::mt19937_64& generator, RobotLeg leg, const Rigid3& pose,
                                       const Rigid3& stretched) {
  const Eigen::Vector3d first_m = pose * leg.platform_joint_m, second_m = stretched * leg.platform_joint_m;
  const Eigen::Vector3d u = RandomDirectionAcross(generator, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d d = first_m - second_m;
  leg.carried_offset_m.setZero();
  leg.arm_m = -d.squaredNorm() / (2 * d.dot(u));
  if (!(leg.arm_m > 0.1 && leg.arm_m < 10)) return std::nullopt;
  leg.base_joint_m = second_m - (leg.arm_m + leg.rod_m) * u;
  for (const int sign : {1, -1}) {
    leg.working_mode = sign;
    const auto state = StateOf(leg, pose);
    if (state && (state->direction - u).norm() < 1e-9) return leg;
  }
  return std::nullopt;
}

TEST(AssemblyModes, AreNotCompleteWithoutOneWhereALegIsStretched) {
  std::mt19937_64 generator = TestGenerator();
  for (int checked = 0; checked < 150;) {
    RobotAtPose random = RandomPlanarRobot(generator, {"_RRR", "_RRR", "_RRR", "_RRR"});
    const auto second = SecondModeOfThree(random);
    if (!second) continue;
    const auto fourth = LegStretchedAt(generator, random.robot.legs[3], random.pose, *second);
    if (!fourth) continue;
    random.robot.legs[3] = *fourth;
    ExpectCompleteOnlyWith(*second, AssemblyModesOf(random.robot, {0, 1, 2, 3}, random.pose));
    ++checked;
  }
}

// Of legs in one plane two directions leave the platform at two places.
TEST(AssemblyModes, OfATranslationAreNotCompleteWithoutOneWhereALegIsStretched) {
  std::mt19937_64 generator = TestGenerator();
  for (int checked = 0; checked < 150;) {
    RobotAtPose random = RandomPlanarRobot(generator, {"_RRR", "_RRR"});
    random.robot.motion = PlatformMotion::kTranslation;
    const AssemblyModes two = AssemblyModesOf(random.robot, {0, 1}, random.pose);
    if (two.modes.size() < 2) continue;
    const Rigid3 second = two.modes[1].base_from_platform;
    const auto third = LegStretchedAt(generator, random.robot.legs[1], random.pose, second);
    if (!third) continue;
    random.robot.legs.push_back(*third);
    ExpectCompleteOnlyWith(second, AssemblyModesOf(random.robot, {0, 1, 2}, random.pose));
    ++checked;
  }
}

// Three legs are seen; the plane in which the fourth, of RPS, keeps its joint goes through two of their
// modes.
TEST(AssemblyModes, AreNotLostWhereALegThatIsNotSeenAllowsThem) {
  std::mt19937_64 generator = TestGenerator();
  int complete = 0;
  for (int checked = 0; checked < 100;) {
    RobotAtPose random = RandomSpatialRobot(generator, {"U_PS", "U_PS", "U_PS"});
    const auto second = SecondModeOfThree(random);
    if (!second) continue;
    RobotLeg fourth = random.robot.legs[0];
    fourth.chain = ChainFromText("R_PS");
    fourth.base_joint_m = UniformVector(generator, -0.6, 0.6);
    fourth.platform_joint_m = UniformVector(generator, -0.4, 0.4);
    fourth.first_axis = (random.pose * fourth.platform_joint_m - fourth.base_joint_m)
                            .cross(*second * fourth.platform_joint_m - fourth.base_joint_m)
                            .normalized();
    random.robot.legs.push_back(fourth);
    const AssemblyModes found = AssemblyModesOf(random.robot, {0, 1, 2}, random.pose);
    ExpectCompleteOnlyWith(*second, found);
    complete += found.status == AssemblyModesStatus::kComplete ? 1 : 0;
    ++checked;
  }
  EXPECT_GT(complete, 80);
}

// Three legs are seen; the fourth, of RPS, keeps its joint in a plane all the same.
TEST(AssemblyModes, ArePosesThatLegsThatAreNotSeenAllow) {
  std::mt19937_64 generator = TestGenerator();
  int modes = 0;
  for (int n = 0; n < 100; ++n) {
    const RobotAtPose random = RandomSpatialRobot(generator, {"R_PS", "R_PS", "R_PS", "R_PS"});
    for (const AssemblyMode& mode : AssemblyModesOf(random.robot, {0, 1, 2}, random.pose).modes) {
      const RobotLeg& leg = random.robot.legs[3];
      const Eigen::Vector3d c_m = mode.base_from_platform * leg.platform_joint_m;
      EXPECT_NEAR(leg.first_axis.dot(c_m - leg.base_joint_m), 0, 1e-8);
      ++modes;
    }
  }
  EXPECT_GE(modes, 100);
}

RobotAtPose WithParallelRails(RobotAtPose random) {
  for (RobotLeg& leg : random.robot.legs) leg.first_axis = Eigen::Vector3d::UnitX();
  return random;
}

bool IsReached(const RobotAtPose& random) {
  return std::all_of(random.robot.legs.begin(), random.robot.legs.end(),
                     [&](const RobotLeg& leg) { return StateOf(leg, random.pose).has_value(); });
}

TEST(AssemblyModes, OfLegsOnParallelRailsAreInfinite) {
  std::mt19937_64 generator = TestGenerator();
  int checked = 0;
  for (int n = 0; n < 50; ++n)
    for (const RobotAtPose& random :
         {WithParallelRails(RandomPlanarRobot(generator, {"_PRR", "_PRR"})),
          WithParallelRails(RandomPlanarRobot(generator, {"_PRR", "_PRR", "_PRR"})),
          WithParallelRails(RandomTranslationRobot(generator, {"_P-{2-US}", "_P-{2-US}", "_P-{2-US}"})),
          WithParallelRails(RandomSchoenfliesRobot(generator, "_P-{2-US}")),
          WithParallelRails(RandomSpatialRobot(generator, std::vector<std::string>(6, "_PUS")))}) {
      if (!IsReached(random)) continue;
      ++checked;
      EXPECT_EQ(AssemblyModesOf(random.robot, AllLegs(random.robot), random.pose).status,
                AssemblyModesStatus::kInfinite)
          << random.robot.name << " of " << random.robot.legs.size();
    }
  EXPECT_GT(checked, 20);
}

TEST(AssemblyModes, AreNotClaimedCompleteWhereTheyAreNotSolvedFor) {
  std::mt19937_64 generator = TestGenerator();
  const RobotAtPose random = RandomSpatialRobot(generator, {"_RUS", "U_PS", "_RUS", "U_PS", "_RUS", "U_PS"});
  const AssemblyModes found = AssemblyModesOf(random.robot, {0, 1, 2}, random.pose);
  EXPECT_EQ(found.status, AssemblyModesStatus::kIncomplete);
  EXPECT_THAT(found.why, testing::HasSubstr("solved for"));
  ASSERT_EQ(found.modes.size(), 1);
  EXPECT_LT(Displacement(found.modes[0].base_from_platform, random.pose).norm(), 1e-12);
}

TEST(AssemblyModes, AreUnreachableWhereASeenLegIs) {
  std::mt19937_64 generator = TestGenerator();
  RobotAtPose random = RandomTranslationRobot(generator, kDeltaChains);
  random.pose.translation.z() -= 5;
  EXPECT_EQ(AssemblyModesOf(random.robot, {0, 1}, random.pose).status, AssemblyModesStatus::kUnreachable);
}

TEST(AssemblyModes, RefusesLegsThatAreNotThereOrNamedTwice) {
  std::mt19937_64 generator = TestGenerator();
  const RobotAtPose random = RandomTranslationRobot(generator, kDeltaChains);
  EXPECT_THROW(AssemblyModesOf(random.robot, {0, 3}, random.pose), std::invalid_argument);
  EXPECT_THROW(AssemblyModesOf(random.robot, {-1, 0}, random.pose), std::invalid_argument);
  EXPECT_THROW(AssemblyModesOf(random.robot, {1, 1}, random.pose), std::invalid_argument);
}

}  // namespace
}  // namespace legible
