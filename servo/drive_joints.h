// Brings the joints of a rig to given readings: no image is looked at.
#pragma once

#include <functional>
#include <string>

#include "core/rig/rig.h"
#include "core/robots/gough_stewart.h"
#include "servo/servo_loop.h"

namespace legible {

struct JointDriveOptions {
  double gain_per_s = 4;
  JointLimitOptions limits;
  double tolerance_m = 1e-4;  // of the joint that is farthest off
  // A drive that gets no farther, by friction for instance, has arrived all the same this near.
  double near_enough_m = 0.002;
  double period_s = 0.02;
  double timeout_s = 60;
  std::function<bool()> is_stopped = [] { return false; };  // true: the user wants it stopped

  void Check() const;  // throws std::invalid_argument
};

struct JointDrive {
  bool has_arrived = false;
  ServoEnd end = ServoEnd::kRunning;
  std::string reason;  // in words, why it ended
  // Not this goal was the trouble but the rig, or the user: no other goal would do better.
  bool is_hopeless = false;
};

// All joints move together with speeds in proportion to what they have to go, under the limits and the
// supervision of every servo. The robot is only told to stand still at the end: it may still come to rest.
JointDrive DriveJoints(Rig& rig, const GoughStewart& robot, const Vector6d& joint_readings_m,
                       const JointDriveOptions& options);

}  // namespace legible
