// A servo from cycle to cycle: the step, the supervisor, and what both remember. It reads no clock and
// touches no rig, so that the same inputs lead to the same commands, bit for bit.
#pragma once

#include <string>

#include "servo/servo_step.h"
#include "servo/supervisor.h"

namespace legible {

struct ServoOptions {
  ServoStepOptions step;
  SupervisorOptions supervision;

  void Check() const;  // throws std::invalid_argument
};

struct CycleOutput {
  ServoStep step;
  Vector6d joint_speeds_m_per_s = Vector6d::Zero();  // to command; 0 once it has ended and while it waits
  Verdict verdict;
};

class ServoController {
 public:
  // Throws std::invalid_argument where the options or the goal are not fit for each other.
  ServoController(const ServoModel& model, const ServoGoal& goal, const ServoOptions& options);

  CycleOutput Cycle(const CycleInput& input);

  bool NeedsImages() const { return LooksAtImages(options_.step.law); }

  // Ends it from outside, unless it has ended.
  Verdict End(ServoEnd end, const std::string& reason) { return supervisor_.End(end, reason); }

 private:
  ServoModel model_;
  ServoGoal goal_;
  ServoOptions options_;
  Supervisor supervisor_;
  Rigid3 base_from_platform_;  // by the last readings
  Vector6d commanded_m_per_s_ = Vector6d::Zero();
};

}  // namespace legible
