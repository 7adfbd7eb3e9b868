#include "tests/testing/random_robots.h"

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "core/robots/leg_state.h"
#include "core/robots/platform_motion.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

constexpr double kLeastSine = 0.1;
constexpr int kMostDraws = 100000;

// How far the leg is from where it would be singular.
double SineOf(const RobotLeg& leg, const LegState& state) {
  const SeenSegment segment = SeenSegmentOf(leg.chain);
  if (segment.direction == DirectionOf::kLeg) return std::abs(state.direction.dot(state.free_direction));
  if (segment.carrier == Carrier::kLine) return state.direction.cross(leg.first_axis).norm();
  return std::abs(state.direction.dot(state.start_m - leg.base_joint_m)) / leg.arm_m;
}

RobotLeg LegThatReaches(const std::function<RobotLeg()>& draw, const Rigid3& pose) {
  for (int i = 0; i < kMostDraws; ++i) {
    RobotLeg leg = draw();
    const auto state = StateOf(leg, pose);
    if (state && SineOf(leg, *state) > kLeastSine) return leg;
  }
  throw std::logic_error("no random leg reaches the pose");
}

double RandomSign(std::mt19937_64& generator) { return Uniform(generator, -1, 1) > 0 ? 1 : -1; }

Eigen::Vector3d InPlane(std::mt19937_64& generator, double low, double high) {
  return {Uniform(generator, low, high), Uniform(generator, low, high), 0};
}

RobotLeg PlanarLeg(std::mt19937_64& generator, const std::string& chain, bool is_of_point) {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  RobotLeg leg;
  leg.chain = ChainFromText(chain);
  leg.base_joint_m = InPlane(generator, -1, 1);
  const bool turns_first = leg.chain[0].type == JointType::kRevolute;
  leg.first_axis = turns_first ? RandomSign(generator) * z : RandomDirectionAcross(generator, z);
  leg.zero_direction = RandomDirectionAcross(generator, z);
  leg.second_axis = RandomDirectionAcross(generator, z);
  leg.arm_m = Uniform(generator, 0.3, 1);
  leg.rod_m = Uniform(generator, 0.3, 1.2);
  leg.working_mode = static_cast<int>(RandomSign(generator));
  if (!is_of_point) leg.platform_joint_m = InPlane(generator, -0.4, 0.4);
  leg.carried_offset_m = InPlane(generator, -0.05, 0.05);
  leg.joint_offset = Uniform(generator, -0.1, 0.1);
  return leg;
}

// An axis across the way to the platform joint, as an RPS leg's has to be.
void GiveAxes(std::mt19937_64& generator, const Rigid3& pose, RobotLeg& leg) {
  const bool is_rps =
      leg.chain[0].type == JointType::kRevolute && SeenSegmentOf(leg.chain).carrier == Carrier::kFixed;
  const Eigen::Vector3d to_platform = (pose * leg.platform_joint_m - leg.base_joint_m).normalized();
  leg.first_axis = is_rps ? RandomDirectionAcross(generator, to_platform) : RandomDirection(generator);
  leg.zero_direction = RandomDirectionAcross(generator, leg.first_axis);
}

RobotLeg SpatialLeg(std::mt19937_64& generator, const std::string& chain, const Rigid3& pose) {
  RobotLeg leg;
  leg.chain = ChainFromText(chain);
  leg.base_joint_m = UniformVector(generator, -0.6, 0.6).cwiseProduct(Eigen::Vector3d(1, 1, 0.2));
  leg.platform_joint_m = UniformVector(generator, -0.4, 0.4).cwiseProduct(Eigen::Vector3d(1, 1, 0.2));
  GiveAxes(generator, pose, leg);
  leg.arm_m = Uniform(generator, 0.2, 0.5);
  leg.rod_m = Uniform(generator, 0.5, 1.2);
  leg.working_mode = static_cast<int>(RandomSign(generator));
  leg.joint_offset = Uniform(generator, -0.1, 0.1);
  return leg;
}

// Of a Delta-like robot, at that angle about its base.
RobotLeg DeltaLeg(std::mt19937_64& generator, const std::string& chain, double angle_rad) {
  const Eigen::Vector3d out(std::cos(angle_rad), std::sin(angle_rad), 0);
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  RobotLeg leg;
  leg.chain = ChainFromText(chain);
  leg.base_joint_m = 0.3 * out + UniformVector(generator, -0.05, 0.05);
  const bool is_rail = SeenSegmentOf(leg.chain).carrier == Carrier::kLine;
  const Eigen::Vector3d axis = is_rail ? Eigen::Vector3d(out - z) : Eigen::Vector3d(out.cross(z));
  leg.first_axis = (axis.normalized() + UniformVector(generator, -0.3, 0.3)).normalized();
  leg.zero_direction = RandomDirectionAcross(generator, leg.first_axis);
  leg.arm_m = Uniform(generator, 0.3, 0.45);
  leg.rod_m = Uniform(generator, 0.6, 0.9);
  leg.working_mode = static_cast<int>(RandomSign(generator));
  leg.joint_offset = Uniform(generator, -0.1, 0.1);
  return leg;
}

}  // namespace

Eigen::Vector3d RandomDirection(std::mt19937_64& generator) {
  return UniformRotation(generator) * Eigen::Vector3d::UnitZ();
}

Eigen::Vector3d RandomDirectionAcross(std::mt19937_64& generator, const Eigen::Vector3d& axis) {
  return axis.cross(RandomDirection(generator)).normalized();
}

RobotAtPose RandomPlanarRobot(std::mt19937_64& generator, const std::vector<std::string>& chains) {
  const bool is_of_point = chains.size() == 2;
  RobotAtPose random;
  random.robot.name = "planar";
  random.robot.motion = is_of_point ? PlatformMotion::kPlanarPoint : PlatformMotion::kPlanar;
  random.pose.translation = InPlane(generator, -0.3, 0.3);
  if (!is_of_point) random.pose.rotation = RotationFromVector({0, 0, Uniform(generator, -3, 3)});
  random.robot.home = random.pose;
  for (const std::string& chain : chains)
    random.robot.legs.push_back(
        LegThatReaches([&] { return PlanarLeg(generator, chain, is_of_point); }, random.pose));
  return random;
}

RobotAtPose RandomSpatialRobot(std::mt19937_64& generator, const std::vector<std::string>& chains) {
  RobotAtPose random;
  random.robot.name = "spatial";
  random.pose.translation = Eigen::Vector3d(0, 0, 0.7) + UniformVector(generator, -0.1, 0.1);
  random.pose.rotation = RotationFromVector(UniformVector(generator, -0.4, 0.4));
  random.robot.home = random.pose;
  for (const std::string& chain : chains)
    random.robot.legs.push_back(
        LegThatReaches([&] { return SpatialLeg(generator, chain, random.pose); }, random.pose));
  return random;
}

RobotAtPose RandomTranslationRobot(std::mt19937_64& generator, const std::vector<std::string>& chains) {
  RobotAtPose random;
  random.robot.name = "translation";
  random.robot.motion = PlatformMotion::kTranslation;
  random.pose.translation = Eigen::Vector3d(0, 0, -0.6) + UniformVector(generator, -0.1, 0.1);
  random.pose.rotation = UniformRotation(generator);
  random.robot.home = random.pose;
  for (size_t i = 0; i < chains.size(); ++i) {
    const double angle_rad =
        2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(chains.size());
    random.robot.legs.push_back(LegThatReaches(
        [&] {
          RobotLeg leg = DeltaLeg(generator, chains[i], angle_rad);
          leg.platform_joint_m = UniformVector(generator, -0.1, 0.1);
          leg.carried_offset_m = UniformVector(generator, -0.05, 0.05);
          return leg;
        },
        random.pose));
  }
  return random;
}

RobotAtPose RandomSchoenfliesRobot(std::mt19937_64& generator, const std::string& chain) {
  return RandomSchoenfliesRobot(generator, std::vector<std::string>(4, chain));
}

RobotAtPose RandomSchoenfliesRobot(std::mt19937_64& generator, const std::vector<std::string>& chains) {
  RobotAtPose random;
  random.robot.name = "Schoenflies";
  random.robot.motion = PlatformMotion::kSchoenflies;
  random.pose.translation = Eigen::Vector3d(0, 0, -0.6) + UniformVector(generator, -0.1, 0.1);
  random.pose.rotation = RotationFromVector({0, 0, Uniform(generator, -1.5, 1.5)});
  random.robot.home = random.pose;
  const std::vector<Eigen::Vector3d> halves = {UniformVector(generator, -0.1, 0.1),
                                               UniformVector(generator, -0.1, 0.1)};
  for (size_t i = 0; i < chains.size(); ++i) {
    const double angle_rad = std::numbers::pi / 2 * (static_cast<double>(i) - 1.5);
    random.robot.legs.push_back(LegThatReaches(
        [&] {
          RobotLeg leg = DeltaLeg(generator, chains[i], angle_rad);
          leg.platform_joint_m = halves[i / 2];
          leg.carried_offset_m = UniformVector(generator, -0.08, 0.08);
          return leg;
        },
        random.pose));
  }
  return random;
}

Rigid3 RandomPoseNear(std::mt19937_64& generator, const ParallelRobot& robot, const Rigid3& pose,
                      double displacement) {
  const auto basis = MotionBasis(robot, pose);
  Vector6d twist = Vector6d::Zero();
  for (Eigen::Index k = 0; k < basis.cols(); ++k)
    twist += Uniform(generator, -displacement, displacement) * basis.col(k);
  return BackToMotion(robot, Displaced(pose, twist));
}

std::vector<int> AllLegs(const ParallelRobot& robot) {
  std::vector<int> legs(robot.legs.size());
  std::iota(legs.begin(), legs.end(), 0);
  return legs;
}

}  // namespace legible
