// What a servo is held to: its tolerance, and when it must not go on.
#pragma once

#include "servo/control_law.h"

namespace legible {

struct SupervisorOptions {
  double tolerance = 0;  // of the error, in the mode's unit; 0: DefaultTolerance
  // An error that no longer falls and is no more than this many times what noise alone leaves has converged
  // too.
  double tolerance_in_noise = 1.5;
  double dwell_s = 0.2;        // for which it is to stay there
  double stale_s = 0.1;        // oldest image, oldest readings
  double unusable_s = 0.5;     // for which too little may be seen: the robot waits
  double unanswered_m = 3e-3;  // of commanded way that nothing answers
  double growth_factor = 1.5;  // over the smallest error so far, and as many default tolerances as below
  double growth_tolerances = 50;
  double growth_s = 0.5;
  double stall_s = 3;  // in which the error must fall by stall_share
  double stall_share = 0.05;
  double timeout_s = 60;

  void Check() const;  // throws std::invalid_argument
};

// 0.1 px, 2 mrad, 0.1 mm for a pose and 0.05 mm for joints.
double DefaultTolerance(ControlMode mode);

}  // namespace legible
