// Keeps joints within their ranges and their speeds within a limit.
#pragma once

#include <Eigen/Core>

#include "core/rig/rig.h"
#include "core/robots/gough_stewart.h"

namespace legible {

struct JointLimitOptions {
  double speed_limit_m_per_s = 0.05;
  double range_margin_m = 5e-4;  // that the readings keep from the ends of joint_range_m
  // A joint may go no faster than it would need to reach its margin in this time. It comes to rest without
  // passing the margin if this is at least four times the drives' lag and the control period together. A
  // command that nobody renews leads it at most by (hold + lag + age and delay) * speed / this past where it
  // was measured: with a lag of 40 ms, readings 20 ms old and 10 ms to the drives 0.5 mm past the margin at
  // 50 mm/s. Slower links and faster joints need more margin.
  double look_ahead_s = Rig::kCommandHolds_s + 0.05;

  void Check() const;  // throws std::invalid_argument
};

// What speeds (m/s) the ranges leave; 0 is always among them. The joints are anywhere between their readings
// and way_since_readings_m (m) from there.
struct SpeedBounds {
  Vector6d lowest, highest;
};
SpeedBounds BoundsByRange(const GoughStewart& robot, const Vector6d& joint_readings_m,
                          const Vector6d& way_since_readings_m, const JointLimitOptions& options);

// The speeds x within the bounds that minimise |metric (x - wanted)|: what a joint at its limit cannot do,
// the others make up for as well as they can. Bounded least squares by active sets (Stark and Parker 1995).
Vector6d NearestWithin(const SpeedBounds& bounds, const Matrix6d& metric, const Vector6d& wanted);

}  // namespace legible
