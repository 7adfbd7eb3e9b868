// One step of a servo: from what is seen to the joints' speeds, within all limits.
#pragma once

#include <string>

#include "servo/adaptive_gain.h"
#include "servo/control_law.h"
#include "servo/joint_limits.h"

namespace legible {

struct ServoStepOptions {
  ControlLawOptions law;
  // Of the farthest that a joint still has to go, m: in every mode the same.
  AdaptiveGain gain{4, 2, 400};
  JointLimitOptions limits;
  // Between this many times the least conditioning, of the robot or of what is seen, and the least itself the
  // robot slows down to nothing; but not on its way out of a singularity of its own. From this part of
  // most_motion_sigma on it slows down too, so that noise alone never drives it faster than there.
  double slow_conditioning = 3;

  void Check() const;  // throws std::invalid_argument
};

enum class SlowedBy { kNothing, kRobotSingularity, kSightSingularity, kNoise };

struct ServoStep {
  LawResult law;
  Vector6d joint_speeds_m_per_s = Vector6d::Zero();
  double gain_per_s = 0;
  // What the limits made of the speeds that the law asked for, and why.
  double speed_factor = 1;        // one for all joints: the fastest at its limit
  int fastest_leg = -1;           // 0-based, where speed_factor < 1
  double singularity_factor = 1;  // near a singularity, or where noise leaves a motion uncertain
  SlowedBy slowed_by = SlowedBy::kNothing;
  std::bitset<kLegCount> at_shortest, at_longest;  // held back by their range
};

// Depends on nothing but what it is given. Allocates nothing.
ServoStep EvaluateStep(const ServoModel& model, const ServoGoal& goal, const LawInput& input,
                       const ServoStepOptions& options);

// Why the law gives no speeds, in a clause: "legs 1 and 4 alone are seen, three are needed"; empty if it
// does.
std::string WhyNoSpeeds(const ServoStep& step, const ControlLawOptions& options);

// Every limit that the step applied, in clauses joined by "; ": "leg 2 at its longest"; empty: none.
std::string DescribeLimits(const ServoStep& step);

// "leg 2", "legs 1, 2 and 5"; legs 0-based.
std::string LegList(const std::bitset<kLegCount>& legs);

}  // namespace legible
