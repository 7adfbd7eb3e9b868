// The six drives of a simulated robot with their encoders: lag, limits, friction, end stops, readings.
#pragma once

#include <array>
#include <cstdint>

#include "core/rig/simulation_options.h"

namespace legible {

// What loses a joint's speed where it stands; see DriveOptions.
struct Friction {
  double breakaway_speed_m_per_s = 0;
  double sliding_loss_m_per_s = 0;
};

// The motor of each joint follows its command with a lag of first order, solved exactly. The joint follows
// the motor as far as friction and the end stops (the leg's joint_range_m) let it: friction is that of the
// place where the joint is at the start of each substep of 1 ms or less.
class Drives {
 public:
  // At rest at the readings (m) of the robot's pose. Throws std::invalid_argument if one is outside its
  // range.
  Drives(const DriveOptions& options, const GoughStewart& robot, const Vector6d& joint_readings_m,
         std::uint64_t seed);

  // Kept until the next one; what exceeds the speed limit is cut off. Throws std::invalid_argument for what
  // is not finite.
  void Command(const Vector6d& joint_speeds_m_per_s);
  void Halt() noexcept { command_m_per_s_.setZero(); }
  void Advance(double duration_s);

  // The true readings moved by the encoders' noise, which depends on the key alone, and quantised.
  Vector6d Measure(std::uint64_t key) const;

  Vector6d joint_readings_m() const;  // true
  Vector6d joint_speeds_m_per_s() const;
  Friction FrictionAt(int joint, double joint_reading_m) const;

  // Since the beginning.
  double largest_speed_m_per_s() const { return largest_speed_m_per_s_; }
  const std::array<bool, kLegCount>& hit_end_stop() const { return hit_end_stop_; }
  bool was_commanded_too_fast() const { return was_commanded_too_fast_; }

 private:
  struct Joint {
    double reading_m = 0;
    double motor_m_per_s = 0;  // the lagging speed
    int direction = 0;         // in which it slides; 0: it sticks
    double speed_m_per_s = 0;
    double phase_rad = 0;  // of its friction
    std::array<double, 2> range_m = {0, 0};
  };

  void AdvanceJoint(int joint, double duration_s);
  double Slide(int joint, const Friction& friction, double duration_s);
  double Rest(int joint, const Friction& friction, double duration_s);

  DriveOptions options_;
  std::uint64_t seed_;
  std::array<Joint, kLegCount> joints_;
  Vector6d command_m_per_s_ = Vector6d::Zero();
  double largest_speed_m_per_s_ = 0;
  std::array<bool, kLegCount> hit_end_stop_{};
  bool was_commanded_too_fast_ = false;
};

}  // namespace legible
