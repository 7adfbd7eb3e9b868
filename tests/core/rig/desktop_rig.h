// A desktop hexapod before a camera, as a simulated rig's truth.
#pragma once

#include <algorithm>

#include "core/rig/simulated_rig.h"
#include "datasets/synthetic_session.h"

namespace legible {

inline SimulationTruth DesktopTruth() {
  return {DesktopHexapod(), DesktopCamera(true), LookAt({0.94, 0.074, 0.285}, {0, 0, 0.13})};
}

// Everything that makes a rig less than ideal, in sizes of a real one.
inline SimulationOptions RoughOptions() {
  SimulationOptions options;
  options.drives.breakaway_speed_m_per_s = 0.002;
  options.drives.sliding_loss_m_per_s = 0.001;
  options.drives.reading_noise_m = 2e-6;
  return options;
}

// All joints of a desktop hexapod longer, at the same speed: the platform rises.
inline Vector6d Rising(double speed_m_per_s) { return Vector6d::Constant(speed_m_per_s); }

// Until then, s of the rig's clock, as a program that is alive does: renewed each 20 ms, and once more then.
inline void CommandUntil(Rig& rig, const Vector6d& joint_speeds_m_per_s, double until_s) {
  const double start_s = rig.Now();
  rig.CommandSpeeds(joint_speeds_m_per_s);
  for (int i = 1; rig.Now() < until_s; ++i) {
    rig.WaitUntil(std::min(start_s + 0.02 * i, until_s));
    rig.CommandSpeeds(joint_speeds_m_per_s);
  }
}

inline SimulationOptions WithFault(const Fault& fault) {
  SimulationOptions options;
  options.faults = {fault};
  return options;
}

}  // namespace legible
