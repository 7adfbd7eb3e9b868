#include "servo/servo_progress.h"

#include <fmt/format.h>

#include <algorithm>

#include "servo/error_text.h"

namespace legible {

ServoProgress::ServoProgress(const ControlLawOptions& law, const SupervisorOptions& options)
    : law_(law), options_(options), stall_(law, options) {}

std::optional<Verdict> ServoProgress::Judge(const CycleInput& input, const ServoStep& step,
                                            const CommandAnswers& answers) {
  const double error = step.law.error;
  if (HasArrived(input, step))
    return Ended(ServoEnd::kConverged,
                 fmt::format("{} left, within the tolerance of {}{}", ErrorText(law_.mode, error),
                             ErrorText(law_.mode, options_.tolerance), CertaintyText(law_, step.law)));
  const Edges edges = EdgesBehind(input);
  double& smallest = smallest_errors_.try_emplace(edges, error).first->second;
  smallest = std::min(smallest, error);
  if (Grows(input, step, smallest)) {
    const std::string limits = DescribeLimits(step);
    return Ended(ServoEnd::kErrorGrows,
                 fmt::format("the error grows: {} after {} at its smallest{}", ErrorText(law_.mode, error),
                             ErrorText(law_.mode, smallest), limits.empty() ? "" : "; " + limits));
  }
  return stall_.Judge(input, edges, step, answers);
}

void ServoProgress::Interrupt() {
  is_within_.Forget();
  grows_.Forget();
  stall_.Forget();
}

ServoProgress::Edges ServoProgress::EdgesBehind(const CycleInput& input) const {
  Edges edges;
  if (UnitOf(law_.mode) == UnitOf(ControlMode::kPose)) return edges;
  for (const SeenEdge& edge : input.seen.edges)
    if (law_.legs[static_cast<size_t>(edge.leg)]) edges.set(static_cast<size_t>(2 * edge.leg + edge.edge));
  return edges;
}

bool ServoProgress::HasArrived(const CycleInput& input, const ServoStep& step) {
  return is_within_.HasHeld(step.law.error <= options_.tolerance, input.time_s, options_.dwell_s);
}

bool ServoProgress::Grows(const CycleInput& input, const ServoStep& step, double smallest_error) {
  constexpr double kNoises = 3;  // what noise leaves is no growth
  const double allowed = std::max(
      options_.growth_factor * smallest_error + options_.growth_tolerances * DefaultTolerance(law_.mode),
      kNoises * step.law.error_noise);
  return grows_.HasHeld(!(step.law.error <= allowed), input.time_s, options_.growth_s);
}

}  // namespace legible
