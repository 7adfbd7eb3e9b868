// A robot with its camera, as a program drives it: what hardware implements and what the simulated rig is.
#pragma once

#include <stdexcept>

#include "core/geometry/rigid3.h"
#include "core/vision/gray_image.h"

namespace legible {

// The rig does not answer any more. Whoever catches it stops: the rig itself has done what it can.
class RigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The rig answers, but its camera has not given an image yet: it may be asked again.
class NoImageYet : public RigError {
 public:
  NoImageYet() : RigError("the camera has not given an image yet") {}
};

struct StampedImage {
  double time_s = 0;  // of the exposure, by the rig's clock
  GrayImage image;
};

struct StampedReadings {
  double time_s = 0;  // of the measurement, by the rig's clock
  Vector6d joint_readings_m = Vector6d::Zero();
};

// One thread at a time. Every call but Stop may throw RigError.
class Rig {
 public:
  // A command of speeds holds for this long at most, s. If it has not been renewed by then the drives bring
  // the joints to rest by themselves, whatever the reason: a program that hangs or was killed, a lost link.
  // They stay there until the next command.
  static constexpr double kCommandHolds_s = 0.25;

  Rig() = default;
  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;
  virtual ~Rig() = default;

  // The rig's clock, s: it never goes back, and may go on while the program computes.
  virtual double Now() = 0;
  // Returns at that time of the rig's clock; at once if it is past.
  virtual void WaitUntil(double time_s) = 0;

  // The newest there is, at once: the same one again, with the same stamp, where nothing newer has come.
  // Neither waits for the next exposure or measurement; the time that transport takes is the rig's own. Grab
  // throws NoImageYet before the first.
  virtual StampedImage Grab() = 0;
  virtual StampedReadings ReadJoints() = 0;

  // Speeds of the joint readings (m/s), until the next command or Stop, or until they lapse.
  virtual void CommandSpeeds(const Vector6d& joint_speeds_m_per_s) = 0;
  // All joints to rest. May be called in any state: before the first command, without a link, after an error,
  // again.
  virtual void Stop() noexcept = 0;
};

}  // namespace legible
