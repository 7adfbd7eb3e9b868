// A servo of leg directions, simulated: robots of every family under the law of Briot et al. (2016),
// section 2.3.2, with drives that follow at once.
#pragma once

#include <random>
#include <vector>

#include "core/robots/parallel_robot.h"

namespace legible {

struct DirectionServoOptions {
  double gain_per_s = 0.8;
  double step_s = 0.01;
  double longest_s = 60;
  // Every seen direction is drawn anew in each step from the cone of this half angle about the true one,
  // uniformly over its cross-section.
  double cone_half_angle_rad = 0;
  double converged_rad = 1e-7;  // largest |u x u*| of a seen leg, without noise
  double slowest_per_s = 1e-8;  // twist, lengths in the robot's size, below which it stands
};

enum class DirectionServoEnd {
  kConverged,     // |u x u*| is 0 for every seen leg: it points as at the goal, or exactly the other way
  kLocalMinimum,  // it stands, and they are not
  kAtBoundary,    // a leg is stretched or folded (Type 1): it cannot go on
  kTimeUp,
};
const char* ToString(DirectionServoEnd end);

struct DirectionServoSample {
  double time_s = 0;
  Rigid3 base_from_platform;
  std::vector<double>
      errors_rad;  // |u x u*| of each seen leg, in the order asked for; true ones, without noise
};

struct DirectionServoRun {
  DirectionServoEnd end = DirectionServoEnd::kTimeUp;
  std::vector<DirectionServoSample> samples;  // start and end included
};

// From a pose to where the legs (from 0) have the directions that they have at the goal: e_i = u_i x u*_i,
// L_i = -[u*_i]x M_i, twist = -gain L^+ e (eq. 9-11) on what the platform's motion allows.
// Throws std::invalid_argument where a seen leg does not reach the start or the goal.
DirectionServoRun SimulateDirectionServo(const ParallelRobot& robot, const std::vector<int>& legs,
                                         const Rigid3& from, const Rigid3& to,
                                         const DirectionServoOptions& options, std::mt19937& random);

}  // namespace legible
