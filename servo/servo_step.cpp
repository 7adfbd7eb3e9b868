#include "servo/servo_step.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace legible {
namespace {

// 0 where a number is at its limit or beyond, or is none; 1 from `slow` times as far on.
double FactorNear(double times_the_limit, double slow) {
  return times_the_limit > 1 ? std::min((times_the_limit - 1) / (slow - 1), 1.0) : 0;
}

// Nearest to the wanted speeds within the bounds, and which joints these hold.
void HoldWithin(const SpeedBounds& bounds, const Vector6d& wanted, ServoStep& step) {
  Vector6d& speeds = step.joint_speeds_m_per_s;
  step.at_shortest = step.at_longest = {};
  speeds = wanted;
  const bool is_free =
      (speeds.array() >= bounds.lowest.array()).all() && (speeds.array() <= bounds.highest.array()).all();
  if (is_free) return;
  speeds = NearestWithin(bounds, step.law.metric, wanted);
  for (int i = 0; i < kLegCount; ++i) {
    step.at_shortest[static_cast<size_t>(i)] = speeds[i] <= bounds.lowest[i];
    step.at_longest[static_cast<size_t>(i)] = speeds[i] >= bounds.highest[i];
  }
}

// One factor for all joints that keeps the fastest at the limit, if none is that small already.
void Slow(const JointLimitOptions& limits, ServoStep& step) {
  int fastest = 0;
  const double largest = step.joint_speeds_m_per_s.cwiseAbs().maxCoeff(&fastest);
  if (step.speed_factor * largest <= limits.speed_limit_m_per_s) return;
  step.speed_factor = limits.speed_limit_m_per_s / largest;
  step.fastest_leg = fastest;
}

// What is slowed down for the speed limit comes no farther than its slow speed leads: a range must not turn
// it aside before. So the bounds count for the speeds as they are when slowed down.
void KeepLimits(const ServoModel& model, const LawInput& input, const JointLimitOptions& limits,
                ServoStep& step) {
  SpeedBounds bounds = BoundsByRange(model.robot, input.joint_readings_m, input.way_since_readings_m, limits);
  const Vector6d wanted = step.joint_speeds_m_per_s;
  HoldWithin(bounds, wanted, step);
  Slow(limits, step);
  if (step.speed_factor < 1 && (step.at_shortest | step.at_longest).any()) {
    bounds.lowest /= step.speed_factor;
    bounds.highest /= step.speed_factor;
    HoldWithin(bounds, wanted, step);
    Slow(limits, step);
  }
  step.joint_speeds_m_per_s *= step.speed_factor;
  // Rounding must not lead beyond the limit.
  step.joint_speeds_m_per_s =
      step.joint_speeds_m_per_s.cwiseMax(-limits.speed_limit_m_per_s).cwiseMin(limits.speed_limit_m_per_s);
}

// Whether the speeds lead the robot to a better conditioning: out of a singularity.
bool LeadsOut(const ServoModel& model, const ServoStep& step) {
  constexpr double kAhead = 1e-4;  // m or rad: enough to tell
  const Rigid3& pose = step.law.base_from_platform;
  const Vector6d twist = InverseJacobian(model.robot, pose).partialPivLu().solve(step.joint_speeds_m_per_s);
  if (!(twist.norm() > 0)) return false;
  const Vector6d ahead = RobotSingularValues(model, Displaced(pose, kAhead * twist.normalized()));
  return ahead[5] / ahead[0] > step.law.robot_conditioning;
}

// What leads out is judged by the speeds that would be sent: a joint that its range holds may turn the motion
// towards a singularity.
void SlowDown(const ServoModel& model, const LawInput& input, const ServoStepOptions& options,
              ServoStep& step) {
  const LawResult& law = step.law;
  const auto slow = [&step](SlowedBy by, double factor) {
    if (factor >= step.singularity_factor) return;
    step.singularity_factor = factor;
    step.slowed_by = by;
  };
  const double robot =
      FactorNear(law.robot_conditioning / options.law.least_robot_conditioning, options.slow_conditioning);
  if (robot < 1) {
    ServoStep sent = step;
    KeepLimits(model, input, options.limits, sent);
    if (!LeadsOut(model, sent)) slow(SlowedBy::kRobotSingularity, robot);
  }
  if (LooksAtImages(options.law)) {
    slow(SlowedBy::kSightSingularity,
         FactorNear(law.Conditioning() / options.law.least_conditioning, options.slow_conditioning));
    slow(SlowedBy::kNoise, law.most_motion_sigma_m / (options.slow_conditioning * law.motion_sigma_m));
  }
  step.joint_speeds_m_per_s *= step.singularity_factor;
}

}  // namespace

void ServoStepOptions::Check() const {
  law.Check();
  gain.Check();
  limits.Check();
  if (!(slow_conditioning > 1))
    throw std::invalid_argument("ServoStepOptions: slow_conditioning must be over 1");
}

ServoStep EvaluateStep(const ServoModel& model, const ServoGoal& goal, const LawInput& input,
                       const ServoStepOptions& options) {
  ServoStep step;
  step.law = EvaluateLaw(model, goal, input, options.law);
  if (step.law.status != LawStatus::kOk) return step;
  step.gain_per_s = options.gain.At(step.law.to_go_m.cwiseAbs().maxCoeff());
  step.joint_speeds_m_per_s = step.gain_per_s * step.law.to_go_m;
  SlowDown(model, input, options, step);
  KeepLimits(model, input, options.limits, step);
  return step;
}

std::string LegList(const std::bitset<kLegCount>& legs) {
  std::vector<std::string> numbers;
  for (size_t leg = 0; leg < kLegCount; ++leg)
    if (legs[leg]) numbers.push_back(std::to_string(leg + 1));
  if (numbers.empty()) return "no leg";
  std::string text = numbers.size() == 1 ? "leg " : "legs ";
  for (size_t i = 0; i < numbers.size(); ++i)
    text += (i == 0 ? "" : i + 1 == numbers.size() ? " and " : ", ") + numbers[i];
  return text;
}

namespace {

// "; leg 2 is not seen, of legs 3 and 5 one edge alone", or nothing.
std::string UnseenText(const LawResult& law) {
  std::string text;
  if (law.unseen.any())
    text = fmt::format("; {} {} not seen", LegList(law.unseen), law.unseen.count() == 1 ? "is" : "are");
  if (law.half_seen.any())
    text += fmt::format("{} of {} one edge alone{}", text.empty() ? ";" : ",", LegList(law.half_seen),
                        text.empty() ? " is seen" : "");
  return text;
}

// By what a motion counts as open.
std::string OpenMotionText(const LawResult& law, const ControlLawOptions& options) {
  if (law.Conditioning() >= options.least_conditioning)
    return fmt::format("noise leaves it a σ of {:.2g} mm, at most {:.2g} mm are asked for",
                       1e3 * law.motion_sigma_m, 1e3 * law.most_motion_sigma_m);
  return fmt::format("conditioning {:.2g}, at least {:.2g} is asked for", law.Conditioning(),
                     options.least_conditioning);
}

}  // namespace

std::string WhyNoSpeeds(const ServoStep& step, const ControlLawOptions& options) {
  const LawResult& law = step.law;
  switch (law.status) {
    case LawStatus::kOk:
      return "";
    case LawStatus::kBadReadings:
      return "the joint readings are not numbers";
    case LawStatus::kNoPose:
      return "the joint readings belong to no pose of the platform";
    case LawStatus::kRobotSingular:
      return fmt::format("the robot is at a singularity: conditioning {:.2g}, at least {:.2g} is asked for",
                         law.robot_conditioning, options.least_robot_conditioning);
    case LawStatus::kTooFewEdges:
      return fmt::format("too few edges are seen: {} of {} legs, where six edges of three legs are needed{}",
                         law.edges, law.legs, UnseenText(law));
    case LawStatus::kIllConditionedEdges:
      return fmt::format("the {} edges seen, of {} legs, leave a motion of the platform open: {}{}",
                         law.edges, law.legs, OpenMotionText(law, options), UnseenText(law));
    case LawStatus::kNoPoseFromEdges:
      return "no pose of the platform near the joint readings fits the edges" + UnseenText(law);
  }
  throw std::invalid_argument("WhyNoSpeeds: not a LawStatus");
}

namespace {

std::string SlowedText(const ServoStep& step) {
  switch (step.slowed_by) {
    case SlowedBy::kNothing:
      break;
    case SlowedBy::kRobotSingularity:
      return "near a singularity of the robot";
    case SlowedBy::kSightSingularity:
      return "near a singularity of what is seen";
    case SlowedBy::kNoise:
      return fmt::format("for noise leaves a motion of the platform a σ of {:.2g} mm",
                         1e3 * step.law.motion_sigma_m);
  }
  return "";
}

}  // namespace

std::string DescribeLimits(const ServoStep& step) {
  std::vector<std::string> clauses;
  if (step.at_shortest.any()) clauses.push_back(LegList(step.at_shortest) + " held back at the shortest");
  if (step.at_longest.any()) clauses.push_back(LegList(step.at_longest) + " held back at the longest");
  if (step.speed_factor < 1)
    clauses.push_back(fmt::format("all at {:.0f} % so that leg {} keeps its speed limit",
                                  100 * step.speed_factor, step.fastest_leg + 1));
  if (step.singularity_factor < 1)
    clauses.push_back(fmt::format("slowed to {:.0f} % {}", 100 * step.singularity_factor, SlowedText(step)));
  std::string text;
  for (const std::string& clause : clauses) text += (text.empty() ? "" : "; ") + clause;
  return text;
}

}  // namespace legible
