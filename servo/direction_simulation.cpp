#include "servo/direction_simulation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/hidden/singularity_conditions.h"
#include "core/robots/leg_state.h"
#include "core/robots/platform_motion.h"

namespace legible {
namespace {

// A step that leads where a leg does not reach is halved; one this much smaller than asked for is given up.
constexpr int kMostHalvings = 20;

// Uniform over the disc across the direction.
Eigen::Vector3d Noisy(const Eigen::Vector3d& direction, double half_angle_rad, std::mt19937& random) {
  if (half_angle_rad == 0) return direction;
  std::uniform_real_distribution<double> uniform(0, 1);
  const double radius = half_angle_rad * std::sqrt(uniform(random));
  const double angle_rad = 2 * std::numbers::pi * uniform(random);
  const Eigen::Vector3d first = direction.unitOrthogonal();
  return (direction + radius * (std::cos(angle_rad) * first + std::sin(angle_rad) * direction.cross(first)))
      .normalized();
}

class Simulation {
 public:
  Simulation(const ParallelRobot& robot, const std::vector<int>& legs, const Rigid3& goal,
             const DirectionServoOptions& options)
      : robot_(robot), legs_(legs), options_(options), goal_(StatesAt(goal, "goal")) {}

  // Nothing where a leg does not reach the pose.
  std::optional<DirectionServoSample> At(double time_s, const Rigid3& pose) const {
    const auto states = StatesOf(robot_, legs_, pose);
    if (!states) return std::nullopt;
    DirectionServoSample sample{time_s, pose, {}};
    for (size_t k = 0; k < states->size(); ++k)
      sample.errors_rad.push_back((*states)[k].direction.cross(goal_[k].direction).norm());
    return sample;
  }

  // What the law commands at a pose that all seen legs reach.
  Vector6d Twist(const Rigid3& pose, std::mt19937& random) const {
    const std::vector<LegState> states = StatesAt(pose, "pose");
    const auto rows = static_cast<Eigen::Index>(3 * legs_.size());
    Eigen::VectorXd errors(rows);
    Eigen::MatrixXd interaction(rows, 6);
    for (size_t k = 0; k < states.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(3 * k);
      const RobotLeg& leg = robot_.legs[static_cast<size_t>(legs_[k])];
      const Eigen::Vector3d& wanted = goal_[k].direction;
      errors.segment<3>(at) = Noisy(states[k].direction, options_.cone_half_angle_rad, random).cross(wanted);
      interaction.middleRows<3>(at) = -Skew(wanted) * DirectionInteraction(leg, states[k], pose);
    }
    const Eigen::MatrixXd basis = MotionBasis(robot_, pose);
    return -options_.gain_per_s *
           (basis * (interaction * basis).completeOrthogonalDecomposition().solve(errors));
  }

  // The sample a step later, or less where a leg would not reach; nothing where it does not even reach just
  // beside.
  std::optional<DirectionServoSample> Next(const DirectionServoSample& sample, const Vector6d& twist) const {
    double step_s = options_.step_s;
    for (int halving = 0; halving < kMostHalvings; ++halving, step_s /= 2) {
      const Rigid3 pose = BackToMotion(robot_, Displaced(sample.base_from_platform, step_s * twist));
      if (auto next = At(sample.time_s + step_s, pose)) return next;
    }
    return std::nullopt;
  }

  bool IsConverged(const DirectionServoSample& sample) const {
    return std::all_of(sample.errors_rad.begin(), sample.errors_rad.end(),
                       [&](double error) { return error < options_.converged_rad; });
  }

  bool Stands(const DirectionServoSample& sample, Vector6d twist) const {
    twist.head<3>() /= SizeOf_m(robot_, sample.base_from_platform);
    return twist.norm() < options_.slowest_per_s;
  }

 private:
  std::vector<LegState> StatesAt(const Rigid3& pose, const std::string& which) const {
    auto states = StatesOf(robot_, legs_, pose);
    if (!states) throw std::invalid_argument("a seen leg does not reach the " + which);
    return *std::move(states);
  }

  const ParallelRobot& robot_;
  const std::vector<int>& legs_;
  const DirectionServoOptions& options_;
  std::vector<LegState> goal_;
};

}  // namespace

const char* ToString(DirectionServoEnd end) {
  switch (end) {
    case DirectionServoEnd::kConverged:
      return "converged";
    case DirectionServoEnd::kLocalMinimum:
      return "local-minimum";
    case DirectionServoEnd::kAtBoundary:
      return "at-boundary";
    case DirectionServoEnd::kTimeUp:
      break;
  }
  return "time-up";
}

DirectionServoRun SimulateDirectionServo(const ParallelRobot& robot, const std::vector<int>& legs,
                                         const Rigid3& from, const Rigid3& to,
                                         const DirectionServoOptions& options, std::mt19937& random) {
  if (!(options.step_s > 0) || !(options.gain_per_s > 0))
    throw std::invalid_argument("a simulated servo needs a step and a gain of more than 0");
  const Simulation simulation(robot, legs, to, options);
  DirectionServoRun run;
  const auto start = simulation.At(0, from);
  if (!start) throw std::invalid_argument("a seen leg does not reach the start");
  run.samples.push_back(*start);
  const bool is_noisy = options.cone_half_angle_rad > 0;
  while (run.samples.back().time_s < options.longest_s) {
    const DirectionServoSample& now = run.samples.back();
    if (!is_noisy && simulation.IsConverged(now)) {
      run.end = DirectionServoEnd::kConverged;
      break;
    }
    const Vector6d twist = simulation.Twist(now.base_from_platform, random);
    if (!is_noisy && simulation.Stands(now, twist)) {
      run.end = DirectionServoEnd::kLocalMinimum;
      break;
    }
    const auto next = simulation.Next(now, twist);
    if (!next) {
      run.end = DirectionServoEnd::kAtBoundary;
      break;
    }
    run.samples.push_back(*next);
  }
  return run;
}

}  // namespace legible
