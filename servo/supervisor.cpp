#include "servo/supervisor.h"

#include <fmt/format.h>

#include <cmath>

#include "servo/error_text.h"

namespace legible {
namespace {

SupervisorOptions Completed(SupervisorOptions options, ControlMode mode) {
  options.Check();
  if (options.tolerance == 0) options.tolerance = DefaultTolerance(mode);
  return options;
}

ServoEnd EndOf(LawStatus status) {
  switch (status) {
    case LawStatus::kOk:
      break;
    case LawStatus::kBadReadings:
      return ServoEnd::kBadReadings;
    case LawStatus::kNoPose:
    case LawStatus::kNoPoseFromEdges:
      return ServoEnd::kNoPose;
    case LawStatus::kRobotSingular:
      return ServoEnd::kRobotSingular;
    case LawStatus::kTooFewEdges:
      return ServoEnd::kTooFewEdges;
    case LawStatus::kIllConditionedEdges:
      return ServoEnd::kIllConditionedEdges;
  }
  return ServoEnd::kRunning;
}

}  // namespace

Supervisor::Supervisor(const ControlLawOptions& law, const SupervisorOptions& options)
    : law_(law),
      options_(Completed(options, law.mode)),
      answers_(law_, options_),
      progress_(law_, options_) {}

void Supervisor::Note(const CycleInput& input, const Vector6d& commanded_m_per_s) {
  if (!start_s_) start_s_ = input.time_s;
  answers_.Note(input, commanded_m_per_s);
}

Verdict Supervisor::Judge(const CycleInput& input, const ServoStep& step) {
  if (last_.end != ServoEnd::kRunning) return last_;
  ++cycles_;
  std::optional<Verdict> verdict = JudgeInput(input);
  if (!verdict) verdict = answers_.Judge();
  if (!verdict) verdict = JudgeUsability(input, step);
  if (!verdict && !last_.is_waiting) verdict = progress_.Judge(input, step, answers_);
  if (!verdict) verdict = JudgeTime(input, step);
  if (verdict) last_ = *verdict;
  last_.tolerance = options_.tolerance;
  return last_;
}

Verdict Supervisor::End(ServoEnd end, const std::string& reason) {
  if (last_.end == ServoEnd::kRunning) last_ = Ended(end, reason);
  return last_;
}

// Whether what came can be trusted at all.
std::optional<Verdict> Supervisor::JudgeInput(const CycleInput& input) const {
  if (!input.readings.joint_readings_m.allFinite()) {
    std::bitset<kLegCount> bad;
    for (int i = 0; i < kLegCount; ++i)
      bad[static_cast<size_t>(i)] = !std::isfinite(input.readings.joint_readings_m[i]);
    return Ended(ServoEnd::kBadReadings, fmt::format("joint readings of {} are not numbers", LegList(bad)));
  }
  const auto is_fresh = [this](double age_s) {  // false for what is no number, too
    return age_s >= -options_.stale_s && !IsLongerThan(age_s, options_.stale_s);
  };
  const double readings_age_s = input.time_s - input.readings.time_s;
  if (!is_fresh(readings_age_s))
    return Ended(ServoEnd::kStaleReadings,
                 fmt::format("no fresh joint readings: the newest are {:.2f} s old", readings_age_s));
  const double image_age_s = input.time_s - input.seen.time_s;
  if (LooksAtImages(law_) && !is_fresh(image_age_s))
    return Ended(ServoEnd::kStaleImages,
                 fmt::format("no fresh image: the newest is {:.2f} s old", image_age_s));
  return std::nullopt;
}

// Whether the law had what it needs. It may lack edges for a moment.
std::optional<Verdict> Supervisor::JudgeUsability(const CycleInput& input, const ServoStep& step) {
  const LawStatus status = step.law.status;
  last_.is_waiting = status != LawStatus::kOk;
  const bool is_too_long = is_unusable_.HasHeld(last_.is_waiting, input.time_s, options_.unusable_s);
  if (!last_.is_waiting) return std::nullopt;
  ++waits_;
  why_waited_ = WhyNoSpeeds(step, law_);
  progress_.Interrupt();
  const bool at_once = status == LawStatus::kBadReadings || status == LawStatus::kRobotSingular;
  if (!at_once && !is_too_long) return std::nullopt;
  return Ended(EndOf(status), why_waited_);
}

std::optional<Verdict> Supervisor::JudgeTime(const CycleInput& input, const ServoStep& step) const {
  if (!HasLasted(input.time_s - *start_s_, options_.timeout_s)) return std::nullopt;
  const std::string error = last_.is_waiting ? "" : ": " + ErrorText(law_.mode, step.law.error) + " left";
  const std::string waits = waits_ == 0
                                ? ""
                                : fmt::format("; it waited in {:.0f} % of its cycles, last because {}",
                                              100.0 * waits_ / cycles_, why_waited_);
  const std::string limits = DescribeLimits(step);
  return Ended(ServoEnd::kTimeout, fmt::format("not converged within {:.1f} s{}{}{}", options_.timeout_s,
                                               error, waits, limits.empty() ? "" : "; " + limits));
}

}  // namespace legible
