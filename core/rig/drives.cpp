#include "core/rig/drives.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "core/rig/keyed_random.h"

namespace legible {
namespace {

constexpr double kLongestSubstep_s = 1e-3;
constexpr double kSettled_m_per_s = 1e-15;  // from the command: what follows would only be denormal numbers

int SignOf(double value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

// A speed that follows its command with a lag: v(t) = command + (v(0) - command) exp(-t / lag). Without lag
// v(0) must be the command.
struct LaggingSpeed {
  double start, command, lag_s;

  double At(double time_s) const {
    const double left = lag_s > 0 ? (start - command) * std::exp(-time_s / lag_s) : 0;
    return std::abs(left) < kSettled_m_per_s ? command : command + left;
  }
  double Distance(double time_s) const {
    return command * time_s - (lag_s > 0 ? (start - command) * lag_s * std::expm1(-time_s / lag_s) : 0);
  }
  // For a speed between start (inclusive) and command (exclusive).
  double TimeTo(double speed) const { return lag_s * std::log((start - command) / (speed - command)); }
};

}  // namespace

Drives::Drives(const DriveOptions& options, const GoughStewart& robot, const Vector6d& joint_readings_m,
               std::uint64_t seed)
    : options_(options), seed_(seed) {
  KeyedRandom random(seed, RandomUse::kFrictionPhase, 0);
  for (int i = 0; i < kLegCount; ++i) {
    Joint& joint = joints_[static_cast<size_t>(i)];
    joint.reading_m = joint_readings_m[i];
    joint.range_m = robot.legs[static_cast<size_t>(i)].joint_range_m;
    joint.phase_rad = 2 * std::numbers::pi * std::generate_canonical<double, 53>(random);
    if (!(joint.reading_m >= joint.range_m[0] && joint.reading_m <= joint.range_m[1]))
      throw std::invalid_argument("Drives: joint " + std::to_string(i + 1) + " starts at " +
                                  std::to_string(joint.reading_m) + " m, outside its range");
  }
}

void Drives::Command(const Vector6d& joint_speeds_m_per_s) {
  if (!joint_speeds_m_per_s.allFinite())
    throw std::invalid_argument("Drives: a commanded speed is not a finite number");
  const double limit = options_.speed_limit_m_per_s;
  was_commanded_too_fast_ |= joint_speeds_m_per_s.cwiseAbs().maxCoeff() > limit;
  command_m_per_s_ = joint_speeds_m_per_s.cwiseMax(-limit).cwiseMin(limit);
}

void Drives::Advance(double duration_s) {
  if (!(duration_s > 0)) return;
  const int substeps = std::max(1, static_cast<int>(std::ceil(duration_s / kLongestSubstep_s - 1e-9)));
  for (int i = 0; i < kLegCount; ++i)
    for (int step = 0; step < substeps; ++step) AdvanceJoint(i, duration_s / substeps);
}

Vector6d Drives::Measure(std::uint64_t key) const {
  KeyedRandom random(seed_, RandomUse::kReadingNoise, key);
  std::normal_distribution<double> normal;
  const double step_m = options_.reading_step_m;
  Vector6d measured_m = joint_readings_m();
  for (double& reading_m : measured_m) {
    if (options_.reading_noise_m > 0) reading_m += options_.reading_noise_m * normal(random);
    if (step_m > 0) reading_m = std::round(reading_m / step_m) * step_m;
  }
  return measured_m;
}

Vector6d Drives::joint_readings_m() const {
  Vector6d readings_m;
  for (int i = 0; i < kLegCount; ++i) readings_m[i] = joints_[static_cast<size_t>(i)].reading_m;
  return readings_m;
}

Vector6d Drives::joint_speeds_m_per_s() const {
  Vector6d speeds_m_per_s;
  for (int i = 0; i < kLegCount; ++i) speeds_m_per_s[i] = joints_[static_cast<size_t>(i)].speed_m_per_s;
  return speeds_m_per_s;
}

Friction Drives::FrictionAt(int joint, double joint_reading_m) const {
  const double turns_rad = 2 * std::numbers::pi * joint_reading_m / options_.friction_period_m;
  const double share =
      1 + options_.friction_variation * std::sin(turns_rad + joints_[static_cast<size_t>(joint)].phase_rad);
  return {share * options_.breakaway_speed_m_per_s, share * options_.sliding_loss_m_per_s};
}

// Within a substep the motor's speed is monotonic: the joint at most comes to rest once and starts once.
void Drives::AdvanceJoint(int joint, double duration_s) {
  Joint& state = joints_[static_cast<size_t>(joint)];
  if (options_.lag_s == 0) state.motor_m_per_s = command_m_per_s_[joint];
  const Friction friction = FrictionAt(joint, state.reading_m);
  double left_s = duration_s;
  while (left_s > 0)
    left_s -= state.direction == 0 ? Rest(joint, friction, left_s) : Slide(joint, friction, left_s);
}

// Until the joint sticks, or all the time; returns how long that is.
double Drives::Slide(int joint, const Friction& friction, double duration_s) {
  Joint& state = joints_[static_cast<size_t>(joint)];
  const double sign = state.direction;
  const double loss = friction.sliding_loss_m_per_s;
  const LaggingSpeed motor{sign * state.motor_m_per_s, sign * command_m_per_s_[joint], options_.lag_s};
  const auto stick = [&] { state.direction = 0, state.speed_m_per_s = 0; };
  if (motor.start < loss) {
    stick();
    return 0;
  }
  const bool slows_to_rest = motor.command < loss && motor.TimeTo(loss) <= duration_s;
  const double time_s = slows_to_rest ? motor.TimeTo(loss) : duration_s;
  const double end = slows_to_rest ? loss : motor.At(time_s);
  state.motor_m_per_s = sign * end;
  state.speed_m_per_s = sign * (end - loss);
  largest_speed_m_per_s_ = std::max({largest_speed_m_per_s_, motor.start - loss, end - loss});
  if (slows_to_rest) stick();
  const double target_m = state.reading_m + sign * (motor.Distance(time_s) - loss * time_s);
  state.reading_m = std::clamp(target_m, state.range_m[0], state.range_m[1]);
  if (state.reading_m != target_m) {
    hit_end_stop_[static_cast<size_t>(joint)] = true;
    stick();
  }
  return time_s;
}

// Until the motor overcomes the breakaway speed in a direction that no end stop blocks, or all the time;
// returns how long that is.
double Drives::Rest(int joint, const Friction& friction, double duration_s) {
  Joint& state = joints_[static_cast<size_t>(joint)];
  const double breakaway = friction.breakaway_speed_m_per_s;
  const auto is_blocked = [&](int direction) {
    return direction > 0 ? state.reading_m >= state.range_m[1] : state.reading_m <= state.range_m[0];
  };
  const double command = command_m_per_s_[joint];
  if (std::abs(state.motor_m_per_s) > breakaway) {
    const int direction = SignOf(state.motor_m_per_s);
    if (!is_blocked(direction)) {
      state.direction = direction;
      return 0;
    }
    hit_end_stop_[static_cast<size_t>(joint)] = true;
  }
  const int direction = SignOf(command);
  const LaggingSpeed motor{direction * state.motor_m_per_s, std::abs(command), options_.lag_s};
  if (motor.command > breakaway && !is_blocked(direction) && motor.TimeTo(breakaway) < duration_s) {
    const double time_s = motor.TimeTo(breakaway);
    state.direction = direction;
    state.motor_m_per_s = direction * breakaway;
    return time_s;
  }
  state.motor_m_per_s = LaggingSpeed{state.motor_m_per_s, command, options_.lag_s}.At(duration_s);
  return duration_s;
}

}  // namespace legible
