#include "servo/supervisor_options.h"

#include <stdexcept>

namespace legible {

double DefaultTolerance(ControlMode mode) {
  switch (mode) {
    case ControlMode::kEdges:
      return 0.1;
    case ControlMode::kDirections:
      return 2e-3;
    case ControlMode::kPose:
      return 1e-4;
    case ControlMode::kJoints:
      return 5e-5;
  }
  throw std::invalid_argument("DefaultTolerance: not a ControlMode");
}

void SupervisorOptions::Check() const {
  if (!(tolerance >= 0) || !(tolerance_in_noise >= 0))
    throw std::invalid_argument("SupervisorOptions: tolerances must not be negative");
  for (const double time_s : {dwell_s, stale_s, unusable_s, growth_s, stall_s, timeout_s})
    if (!(time_s > 0)) throw std::invalid_argument("SupervisorOptions: times must be positive");
  if (!(unanswered_m > 0) || !(growth_factor > 1) || !(growth_tolerances >= 0) ||
      !(stall_share > 0 && stall_share < 1))
    throw std::invalid_argument("SupervisorOptions: a threshold is out of its range");
}

}  // namespace legible
