// How a servo ends, and what is decided of it in each cycle.
#pragma once

#include <string>

namespace legible {

enum class ServoEnd {
  kRunning,
  kConverged,
  kBadReadings,     // not numbers
  kStaleReadings,   // too old
  kFrozenReadings,  // the same though the joints should have moved
  kStaleImages,
  kFrozenImages,
  kDrivesDoNotMove,  // neither readings nor images change
  kTooFewEdges,
  kIllConditionedEdges,
  kRobotSingular,
  kNoPose,
  kErrorGrows,
  kStalled,  // the error no longer falls
  kTimeout,
  kLinkLost,
  kStoppedByUser,
  kFailed,  // the program itself
};
// "converged", "stale-images", …
const char* ToString(ServoEnd end);

struct Verdict {
  ServoEnd end = ServoEnd::kRunning;
  std::string reason;       // in words; empty while it runs
  bool is_waiting = false;  // running, but not allowed to move: too little is seen
  double tolerance = 0;     // of the error, in the mode's unit
};

Verdict Ended(ServoEnd end, const std::string& reason);

}  // namespace legible
