#include "servo/servo_controller.h"

namespace legible {

void ServoOptions::Check() const {
  step.Check();
  supervision.Check();
}

ServoController::ServoController(const ServoModel& model, const ServoGoal& goal, const ServoOptions& options)
    : model_(model),
      goal_(goal),
      options_(options),
      supervisor_(options.step.law, options.supervision),
      base_from_platform_(model.robot.home) {
  options.Check();
  DemandGoal(goal, options.step.law);
}

CycleOutput ServoController::Cycle(const CycleInput& input) {
  supervisor_.Note(input, commanded_m_per_s_);
  CycleOutput output;
  output.step = EvaluateStep(
      model_, goal_,
      {input.seen, input.readings.joint_readings_m, supervisor_.WaySinceReadings(), base_from_platform_},
      options_.step);
  base_from_platform_ = output.step.law.base_from_platform;
  if (!output.step.joint_speeds_m_per_s.allFinite())
    supervisor_.End(ServoEnd::kFailed, "the law gave speeds that are not numbers");
  output.verdict = supervisor_.Judge(input, output.step);
  if (output.verdict.end == ServoEnd::kRunning && !output.verdict.is_waiting)
    output.joint_speeds_m_per_s = output.step.joint_speeds_m_per_s;
  commanded_m_per_s_ = output.joint_speeds_m_per_s;
  return output;
}

}  // namespace legible
