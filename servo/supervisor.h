// Decides when a servo has arrived and when it must not go on. What it has decided stays decided.
#pragma once

#include <optional>
#include <string>

#include "servo/command_answers.h"
#include "servo/cycle_input.h"
#include "servo/duration.h"
#include "servo/servo_end.h"
#include "servo/servo_progress.h"
#include "servo/servo_step.h"
#include "servo/supervisor_options.h"

namespace legible {

// Judges in this order: what came has to be fresh; it has to answer what was commanded (CommandAnswers); the
// law has to have what it needs, but for a moment; the error has to fall (ServoProgress), in time.
class Supervisor {
 public:
  // Throws std::invalid_argument where the options are out of their ranges.
  Supervisor(const ControlLawOptions& law, const SupervisorOptions& options);

  // How far each joint was commanded since its reading last changed, m.
  const Vector6d& WaySinceReadings() const { return answers_.WaySinceReadings(); }

  // To be told of each cycle before the step: what came, and the speeds commanded since the last one.
  void Note(const CycleInput& input, const Vector6d& commanded_m_per_s);
  // And after it: the same input.
  Verdict Judge(const CycleInput& input, const ServoStep& step);
  // From outside: the link, the user. Keeps an earlier end.
  Verdict End(ServoEnd end, const std::string& reason);

 private:
  std::optional<Verdict> JudgeInput(const CycleInput& input) const;
  std::optional<Verdict> JudgeUsability(const CycleInput& input, const ServoStep& step);
  std::optional<Verdict> JudgeTime(const CycleInput& input, const ServoStep& step) const;

  ControlLawOptions law_;
  SupervisorOptions options_;
  Verdict last_;
  std::optional<double> start_s_;
  CommandAnswers answers_;
  ServoProgress progress_;
  LastingCondition is_unusable_;
  int cycles_ = 0, waits_ = 0;
  std::string why_waited_;
};

}  // namespace legible
