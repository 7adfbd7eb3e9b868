#include "servo/servo_end.h"

#include <stdexcept>

namespace legible {

const char* ToString(ServoEnd end) {
  switch (end) {
    case ServoEnd::kRunning:
      return "running";
    case ServoEnd::kConverged:
      return "converged";
    case ServoEnd::kBadReadings:
      return "bad-readings";
    case ServoEnd::kStaleReadings:
      return "stale-readings";
    case ServoEnd::kFrozenReadings:
      return "frozen-readings";
    case ServoEnd::kStaleImages:
      return "stale-images";
    case ServoEnd::kFrozenImages:
      return "frozen-images";
    case ServoEnd::kDrivesDoNotMove:
      return "drives-do-not-move";
    case ServoEnd::kTooFewEdges:
      return "too-few-edges";
    case ServoEnd::kIllConditionedEdges:
      return "ill-conditioned-edges";
    case ServoEnd::kRobotSingular:
      return "robot-singular";
    case ServoEnd::kNoPose:
      return "no-pose";
    case ServoEnd::kErrorGrows:
      return "error-grows";
    case ServoEnd::kStalled:
      return "stalled";
    case ServoEnd::kTimeout:
      return "timeout";
    case ServoEnd::kLinkLost:
      return "link-lost";
    case ServoEnd::kStoppedByUser:
      return "stopped-by-user";
    case ServoEnd::kFailed:
      return "failed";
  }
  throw std::invalid_argument("ToString: not a ServoEnd");
}

Verdict Ended(ServoEnd end, const std::string& reason) { return {end, reason, false, 0}; }

}  // namespace legible
