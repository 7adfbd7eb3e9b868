#include "core/robots/leg_state.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/robots/platform_motion.h"
#include "tests/testing/derivatives.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"
#include "tests/testing/random_robots.h"

namespace legible {
namespace {

constexpr double kStep = 3e-5;
constexpr double kTolerance = 1e-7;  // differences' fifth order where a leg is 6 degrees from being stretched

// Twelve planar legs, and the others with each motion of a platform that takes them.
std::vector<RobotAtPose> RobotsOfAllChains(std::mt19937_64& generator) {
  std::vector<RobotAtPose> robots;
  for (const char* chain :
       {"_RRR", "R_RR", "_RPR", "R_PR", "_PRR", "P_RR", "_PPR", "P_PR", "_PRP", "P_RP", "_RRP", "R_RP"}) {
    robots.push_back(RandomPlanarRobot(generator, {chain, chain, chain}));
    robots.push_back(RandomPlanarRobot(generator, {chain, chain}));
  }
  for (const char* chain : {"U_PS", "_PUS", "_RUS"})
    robots.push_back(RandomSpatialRobot(generator, std::vector<std::string>(6, chain)));
  for (const char* chain : {"R_PS", "_RPS"})
    robots.push_back(RandomSpatialRobot(generator, std::vector<std::string>(3, chain)));
  for (const char* chain : {"U_PU", "_R-{2-US}", "_P-{2-US}", "_RUU", "_PUU"})
    robots.push_back(RandomTranslationRobot(generator, std::vector<std::string>(3, chain)));
  for (const char* chain : {"_R-{2-US}", "_P-{2-US}", "_RUU"})
    robots.push_back(RandomSchoenfliesRobot(generator, chain));
  return robots;
}

// The pose displaced by what the motion allows of the twist.
Rigid3 MovedBy(const ParallelRobot& robot, const Rigid3& pose, const Vector6d& twist) {
  const auto basis = MotionBasis(robot, pose);
  return Displaced(pose, basis * (basis.transpose() * twist));
}

template <typename Check>
void ForLegsOfAllChains(const Check& check) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 20; ++n)
    for (const RobotAtPose& random : RobotsOfAllChains(generator))
      for (const RobotLeg& leg : random.robot.legs) {
        SCOPED_TRACE(random.robot.name + " " + ToText(leg.chain));
        const auto basis = MotionBasis(random.robot, random.pose);
        check(random, leg, Matrix6d(basis * basis.transpose()));
      }
}

TEST(LegState, DirectionMovesAsByDifferences) {
  ForLegsOfAllChains([](const RobotAtPose& random, const RobotLeg& leg, const Matrix6d& onto_motion) {
    const auto direction = [&](const Vector6d& twist) -> Eigen::Vector3d {
      return StateOf(leg, MovedBy(random.robot, random.pose, twist)).value().direction;
    };
    const auto found = DirectionInteraction(leg, StateOf(leg, random.pose).value(), random.pose);
    EXPECT_TRUE(
        AreNear(found * onto_motion, NumericJacobian(direction, Vector6d::Zero().eval(), kStep), kTolerance));
  });
}

TEST(LegState, ReadingMovesAsByDifferences) {
  ForLegsOfAllChains([](const RobotAtPose& random, const RobotLeg& leg, const Matrix6d& onto_motion) {
    const LegState state = StateOf(leg, random.pose).value();
    const auto reading = [&](const Vector6d& twist) {
      const double moved = StateOf(leg, MovedBy(random.robot, random.pose, twist)).value().reading;
      const bool is_angle = leg.chain[0].is_actuated == (leg.chain[0].type == JointType::kRevolute) ||
                            leg.chain[1].type == JointType::kRevolute;
      const double by = moved - state.reading;
      return Eigen::Matrix<double, 1, 1>(is_angle ? std::remainder(by, 2 * std::numbers::pi) : by);
    };
    const auto found = ReadingRow(leg, state, random.pose);
    EXPECT_TRUE(
        AreNear(found * onto_motion, NumericJacobian(reading, Vector6d::Zero().eval(), kStep), kTolerance));
  });
}

// A leg that closes: from A by the arm or along the rail to B, from there by the rod to C.
TEST(LegState, ClosesTheLoop) {
  ForLegsOfAllChains([](const RobotAtPose& random, const RobotLeg& leg, const Matrix6d&) {
    const LegState state = StateOf(leg, random.pose).value();
    const SeenSegment segment = SeenSegmentOf(leg.chain);
    const Eigen::Vector3d from_a = state.start_m - leg.base_joint_m;
    const Eigen::Vector3d along = state.platform_joint_m - state.start_m;
    EXPECT_NEAR(state.direction.norm(), 1, 1e-12);
    EXPECT_LT(along.cross(state.direction).norm(), 1e-9);
    const double distance_m = segment.carrier == Carrier::kCircle ? std::abs(from_a.dot(leg.first_axis))
                              : segment.carrier == Carrier::kLine ? from_a.cross(leg.first_axis).norm()
                                                                  : from_a.norm();
    EXPECT_LT(distance_m, 1e-12);  // of B from the circle's plane, the rail, A
    EXPECT_NEAR(segment.extends ? leg.rod_m : along.dot(state.direction), leg.rod_m, 1e-12);
    EXPECT_NEAR(segment.carrier == Carrier::kCircle ? from_a.norm() : leg.arm_m, leg.arm_m, 1e-12);
  });
}

TEST(LegState, WorkingModeSaysOnWhichSideOfThePlatformJointTheArmIs) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 50; ++n) {
    const RobotAtPose random = RandomSpatialRobot(generator, {"_RUS", "_PUS"});
    for (RobotLeg leg : random.robot.legs)
      for (const int mode : {1, -1}) {
        leg.working_mode = mode;
        const LegState state = StateOf(leg, random.pose).value();
        const Eigen::Vector3d to_b = state.start_m - leg.base_joint_m;
        const Eigen::Vector3d to_c = state.platform_joint_m - leg.base_joint_m;
        const bool turns = leg.chain[0].type == JointType::kRevolute;
        const double further =
            turns ? to_c.cross(to_b).dot(leg.first_axis) : (to_b - to_c).dot(leg.first_axis);
        EXPECT_GT(mode * further, 0) << ToText(leg.chain);
      }
  }
}

TEST(LegState, IsNothingWhereTheLegIsTooShort) {
  std::mt19937_64 generator = TestGenerator();
  for (RobotAtPose random : RobotsOfAllChains(generator)) {
    RobotLeg& leg = random.robot.legs[0];
    if (SeenSegmentOf(leg.chain).extends) continue;
    random.pose.translation += 10 * RandomDirectionAcross(generator, leg.first_axis);
    EXPECT_FALSE(StateOf(leg, random.pose).has_value()) << ToText(leg.chain);
  }
}

// Briot et al. (2016), Appendix B, in the leg's frame (x outwards, z up): with AC = C - A,
// AC = l1 (cos q, 0, sin q) + l2 u.
struct QuattroLeg {
  double q_rad;
  Eigen::Vector3d u;
  Eigen::Matrix3d interaction;  // du/dt by the velocity of the platform
};

QuattroLeg QuattroLegByAppendixB(const Eigen::Vector3d& ac, double l1, double l2, int sign) {
  const double alpha = -2 * l1 * ac.x(), beta = -2 * l1 * ac.z();  // B.6
  const double gamma = ac.squaredNorm() + l1 * l1 - l2 * l2;       // B.7
  const double root = std::sqrt(alpha * alpha + beta * beta - gamma * gamma);
  QuattroLeg leg;
  leg.q_rad = 2 * std::atan((-beta + sign * root) / (gamma - alpha));            // B.5
  const Eigen::Vector3d v(std::cos(leg.q_rad), 0, std::sin(leg.q_rad));          // B.2
  const Eigen::Vector3d v_across(-std::sin(leg.q_rad), 0, std::cos(leg.q_rad));  // B.10
  leg.u = (ac - l1 * v) / l2;                                                    // B.12
  const Eigen::RowVector3d a = l2 * leg.u.transpose();                           // B.9
  // Differentiating B.4 gives a tau - l1 l2 u v_across dq = 0: B.10 is printed without the minus that B.8
  // needs.
  const double b = -l1 * l2 * leg.u.dot(v_across);
  leg.interaction = (Eigen::Matrix3d::Identity() + l1 * v_across * a / b) / l2;  // B.14
  return leg;
}

TEST(LegState, OfTheQuattroIsThatOfAppendixB) {
  std::mt19937_64 generator = TestGenerator();
  const double l1 = 0.380, l2 = 0.825;
  for (const double angle_deg : {-135, -45, 45, 135}) {
    const double angle_rad = angle_deg * std::numbers::pi / 180;
    const Eigen::Vector3d x(std::cos(angle_rad), std::sin(angle_rad), 0), z = Eigen::Vector3d::UnitZ();
    Eigen::Matrix3d base_from_leg;
    base_from_leg << x, z.cross(x), z;
    RobotLeg leg;
    leg.chain = ChainFromText("_R-{2-US}");
    leg.base_joint_m = 0.275 * x;
    leg.first_axis = x.cross(z);
    leg.zero_direction = x;
    leg.arm_m = l1;
    leg.rod_m = l2;
    for (int n = 0; n < 50; ++n) {
      leg.carried_offset_m = UniformVector(generator, -0.1, 0.1);
      leg.platform_joint_m = UniformVector(generator, -0.1, 0.1);
      const Rigid3 pose{RotationFromVector({0, 0, Uniform(generator, -0.7, 0.7)}),
                        Eigen::Vector3d(0, 0, -0.7) + UniformVector(generator, -0.1, 0.1)};
      const Eigen::Vector3d c = pose * leg.platform_joint_m + leg.carried_offset_m;
      const Eigen::Vector3d ac = base_from_leg.transpose() * (c - leg.base_joint_m);
      std::array<QuattroLeg, 2> both = {QuattroLegByAppendixB(ac, l1, l2, 1),
                                        QuattroLegByAppendixB(ac, l1, l2, -1)};
      const double towards_c_rad = std::atan2(ac.z(), ac.x());
      if (std::remainder(both[0].q_rad - towards_c_rad, 2 * std::numbers::pi) < 0)
        std::swap(both[0], both[1]);
      for (const int mode : {1, -1}) {
        leg.working_mode = mode;
        const QuattroLeg& expected = both[mode == 1 ? 0 : 1];
        const LegState state = StateOf(leg, pose).value();
        EXPECT_NEAR(std::remainder(state.reading - expected.q_rad, 2 * std::numbers::pi), 0, 1e-12);
        EXPECT_TRUE(AreNear(state.direction, base_from_leg * expected.u, 1e-12));
        EXPECT_TRUE(AreNear(DirectionInteraction(leg, state, pose).leftCols<3>(),
                            base_from_leg * expected.interaction * base_from_leg.transpose(), 1e-10));
      }
    }
  }
}

}  // namespace
}  // namespace legible
