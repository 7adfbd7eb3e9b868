#include "servo/supervisor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "servo/edge_motion.h"

namespace legible {
namespace {

constexpr double kTimeSlack_s = 1e-9;   // clocks are sums of periods
constexpr double kLongestMemory_s = 1;  // older readings and images end it
constexpr double kFollowedShare = 0.2;  // of a commanded way that a drive makes at least if it follows
constexpr double kLeastWay_m = 5e-5;    // that says anything about following
constexpr double kSureWay_m = 2e-4;     // that is more than the noise of readings

Verdict Ended(ServoEnd end, const std::string& reason) { return {end, reason, false, 0}; }

// The leg commanded farthest.
struct FarthestLeg {
  int leg;
  double way_m;
};
FarthestLeg Farthest(const Vector6d& way_m) {
  FarthestLeg farthest{0, 0};
  farthest.way_m = way_m.cwiseAbs().maxCoeff(&farthest.leg);
  return farthest;
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

const char* ToString(ServoEnd end) {
  switch (end) {
    case ServoEnd::kRunning:
      return "running";
    case ServoEnd::kConverged:
      return "converged";
    case ServoEnd::kBadReadings:
      return "bad-readings";
    case ServoEnd::kStaleReadings:
      return "stale-readings";
    case ServoEnd::kFrozenReadings:
      return "frozen-readings";
    case ServoEnd::kStaleImages:
      return "stale-images";
    case ServoEnd::kFrozenImages:
      return "frozen-images";
    case ServoEnd::kDrivesDoNotMove:
      return "drives-do-not-move";
    case ServoEnd::kTooFewEdges:
      return "too-few-edges";
    case ServoEnd::kIllConditionedEdges:
      return "ill-conditioned-edges";
    case ServoEnd::kRobotSingular:
      return "robot-singular";
    case ServoEnd::kNoPose:
      return "no-pose";
    case ServoEnd::kErrorGrows:
      return "error-grows";
    case ServoEnd::kStalled:
      return "stalled";
    case ServoEnd::kTimeout:
      return "timeout";
    case ServoEnd::kLinkLost:
      return "link-lost";
    case ServoEnd::kStoppedByUser:
      return "stopped-by-user";
    case ServoEnd::kFailed:
      return "failed";
  }
  throw std::invalid_argument("ToString: not a ServoEnd");
}

double DefaultTolerance(ControlMode mode) {
  switch (mode) {
    case ControlMode::kEdges:
      return 0.1;
    case ControlMode::kDirections:
      return 2e-3;
    case ControlMode::kPose:
      return 1e-4;
    case ControlMode::kJoints:
      return 5e-5;
  }
  throw std::invalid_argument("DefaultTolerance: not a ControlMode");
}

void SupervisorOptions::Check() const {
  if (!(tolerance >= 0) || !(tolerance_in_noise >= 0))
    throw std::invalid_argument("SupervisorOptions: tolerances must not be negative");
  for (const double time_s : {dwell_s, stale_s, unusable_s, growth_s, stall_s, timeout_s})
    if (!(time_s > 0)) throw std::invalid_argument("SupervisorOptions: times must be positive");
  if (!(unanswered_m > 0) || !(growth_factor > 1) || !(growth_tolerances >= 0) ||
      !(stall_share > 0 && stall_share < 1))
    throw std::invalid_argument("SupervisorOptions: a threshold is out of its range");
}

Supervisor::Supervisor(const ControlLawOptions& law, const SupervisorOptions& options)
    : law_(law), options_(options) {
  options.Check();
  if (options_.tolerance == 0) options_.tolerance = DefaultTolerance(law.mode);
}

void Supervisor::Note(const CycleInput& input, const Vector6d& commanded_m_per_s) {
  if (!start_s_) {
    start_s_ = readings_changed_s_ = images_changed_s_ = input.time_s;
    seen_at_readings_ = input.seen;
    readings_at_images_m_ = input.readings.joint_readings_m;
    ways_.push_back({input.time_s, Vector6d::Zero()});
    before_ = input;
    return;
  }
  const Vector6d way_m = (input.time_s - before_->time_s) * commanded_m_per_s;
  commanded_way_m_ += way_m;
  way_since_readings_m_ += way_m;
  ways_.push_back({input.time_s, commanded_way_m_});
  while (ways_.size() > 2 && ways_[1].time_s < input.time_s - kLongestMemory_s) ways_.pop_front();
  const Vector6d way_at_readings_m = CommandedWayAt(input.readings.time_s);
  const Vector6d way_at_image_m = CommandedWayAt(input.seen.time_s);
  if (input.readings.joint_readings_m != before_->readings.joint_readings_m) {
    readings_changed_s_ = input.readings.time_s;
    answered_by_readings_m_ = way_at_readings_m;
    seen_at_readings_ = input.seen;
  }
  for (int i = 0; i < kLegCount; ++i)  // what was commanded after it was taken is still ahead of a reading
    if (input.readings.joint_readings_m[i] != before_->readings.joint_readings_m[i])
      way_since_readings_m_[i] = (input.time_s - input.readings.time_s) * commanded_m_per_s[i];
  if (input.readings.time_s != before_->readings.time_s)
    following_.Note(input.readings.time_s, way_at_readings_m, input.readings.joint_readings_m);
  if (!SameEdges(input.seen, before_->seen)) {
    images_changed_s_ = input.seen.time_s;
    answered_by_images_m_ = way_at_image_m;
    readings_at_images_m_ = input.readings.joint_readings_m;
  }
  // What was commanded after they were taken is not unanswered.
  unanswered_by_readings_m_ = way_at_readings_m - answered_by_readings_m_;
  unanswered_by_images_m_ = way_at_image_m - answered_by_images_m_;
  before_ = input;
}

Vector6d Supervisor::CommandedWayAt(double time_s) const {
  if (time_s <= ways_.front().time_s) return ways_.front().way_m;
  const auto after = std::find_if(ways_.begin(), ways_.end(),
                                  [time_s](const CommandedWay& way) { return way.time_s >= time_s; });
  if (after == ways_.end()) return ways_.back().way_m;
  const CommandedWay& before = *(after - 1);
  const double share = (time_s - before.time_s) / (after->time_s - before.time_s);
  return before.way_m + share * (after->way_m - before.way_m);
}

Verdict Supervisor::Judge(const CycleInput& input, const ServoStep& step) {
  if (last_.end != ServoEnd::kRunning) return last_;
  ++cycles_;
  std::optional<Verdict> verdict = JudgeInput(input);
  if (!verdict) verdict = JudgeAnswers(input);
  if (!verdict) verdict = JudgeUsability(input, step);
  if (!verdict) verdict = JudgeProgress(input, step);
  if (!verdict && input.time_s - *start_s_ >= options_.timeout_s - kTimeSlack_s)
    verdict = Ended(ServoEnd::kTimeout, WhyTooLate(step));
  if (verdict) last_ = *verdict;
  last_.tolerance = options_.tolerance;
  return last_;
}

std::string Supervisor::WhyTooLate(const ServoStep& step) const {
  const std::string error = last_.is_waiting ? "" : ": " + ErrorText(step.law.error) + " left";
  const std::string waits = waits_ == 0
                                ? ""
                                : fmt::format("; it waited in {:.0f} % of its cycles, last because {}",
                                              100.0 * waits_ / cycles_, why_waited_);
  const std::string limits = DescribeLimits(step);
  return fmt::format("not converged within {:.1f} s{}{}{}", options_.timeout_s, error, waits,
                     limits.empty() ? "" : "; " + limits);
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
    return age_s >= -options_.stale_s && age_s <= options_.stale_s + kTimeSlack_s;
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

// Whether readings and images answer what is commanded.
std::optional<Verdict> Supervisor::JudgeAnswers(const CycleInput& input) const {
  const bool looks = LooksAtImages(law_);
  const FarthestLeg by_readings = Farthest(unanswered_by_readings_m_);
  const FarthestLeg by_images = Farthest(unanswered_by_images_m_);
  const bool readings_stand = by_readings.way_m > options_.unanswered_m;
  const bool images_stand = looks && by_images.way_m > options_.unanswered_m;
  const auto way_text = [](const FarthestLeg& farthest) {
    return fmt::format("leg {} was commanded by {:.1f} mm", farthest.leg + 1, 1e3 * farthest.way_m);
  };
  const bool seem_to_stand = readings_stand && looks && !HaveMoved(seen_at_readings_, input.seen);
  if (seem_to_stand || (images_stand && !HaveJointsMovedSinceImages()))
    return Ended(ServoEnd::kDrivesDoNotMove,
                 fmt::format("neither joint readings nor images show any motion though {}: the drives do not "
                             "move{}",
                             way_text(readings_stand ? by_readings : by_images),
                             readings_stand && HasNoise(input.seen)
                                 ? ", or the joint readings are frozen and the images too noisy to tell"
                                 : ""));
  if (readings_stand)
    return Ended(ServoEnd::kFrozenReadings,
                 fmt::format("the joint readings have not changed for {:.2f} s though {}: they are frozen{}",
                             input.time_s - readings_changed_s_, way_text(by_readings),
                             looks ? ", for the images show motion" : ", or the drives do not move"));
  const double images_for_s = input.time_s - images_changed_s_;
  const bool repeats = looks && HasNoise(input.seen) && images_for_s > options_.stale_s + kTimeSlack_s;
  if (images_stand || repeats)
    return Ended(ServoEnd::kFrozenImages,
                 fmt::format("the images have not changed for {:.2f} s{}: they are frozen", images_for_s,
                             images_stand ? " though " + way_text(by_images) : ", not even by their noise"));
  return JudgeFollowing();
}

// Joint by joint: one frozen reading among others, or drives that stand while their readings are noisy.
std::optional<Verdict> Supervisor::JudgeFollowing() const {
  const bool all_stand = !unanswered_by_readings_m_.isZero(0);  // judged above, with the images
  const auto behind = all_stand ? std::nullopt : following_.Farthest(options_.unanswered_m);
  if (!behind) return std::nullopt;
  const std::string way = fmt::format("leg {} was commanded by {:.1f} mm in {:.2f} s", behind->joint + 1,
                                      1e3 * behind->commanded_m, behind->for_s);
  if (behind->has_not_changed)
    return Ended(
        ServoEnd::kFrozenReadings,
        fmt::format("{} and its joint reading has not changed: it is frozen, or the drives do not move",
                    way));
  return Ended(ServoEnd::kDrivesDoNotMove,
               fmt::format("{} and moved by {:.1f} mm: the drives do not move, or its joint reading is wrong",
                           way, 1e3 * behind->made_m));
}

bool Supervisor::HaveJointsMovedSinceImages() const {
  return (before_->readings.joint_readings_m - readings_at_images_m_).cwiseAbs().maxCoeff() > kSureWay_m;
}

// Whether the law had what it needs. It may lack edges for a moment.
std::optional<Verdict> Supervisor::JudgeUsability(const CycleInput& input, const ServoStep& step) {
  const LawStatus status = step.law.status;
  last_.is_waiting = status != LawStatus::kOk;
  if (!last_.is_waiting) {
    unusable_since_s_.reset();
    return std::nullopt;
  }
  ++waits_;
  why_waited_ = WhyNoSpeeds(step, law_);
  if (!unusable_since_s_) unusable_since_s_ = input.time_s;
  // Nothing is known of the error meanwhile.
  within_since_s_.reset();
  growing_since_s_.reset();
  recent_.clear();
  const bool at_once = status == LawStatus::kBadReadings || status == LawStatus::kRobotSingular;
  const double for_s = input.time_s - *unusable_since_s_;
  if (!at_once && for_s < options_.unusable_s - kTimeSlack_s) return std::nullopt;
  return Ended(EndOf(status), why_waited_);
}

std::optional<Verdict> Supervisor::JudgeProgress(const CycleInput& input, const ServoStep& step) {
  if (last_.is_waiting) return std::nullopt;
  if (HasArrived(input, step))
    return Ended(ServoEnd::kConverged,
                 fmt::format("{} left, within the tolerance of {}{}", ErrorText(step.law.error),
                             ErrorText(options_.tolerance), CertaintyText(step)));
  if (Grows(input, step))
    return Ended(ServoEnd::kErrorGrows,
                 fmt::format("the error grows: {} after {} at its smallest", ErrorText(step.law.error),
                             ErrorText(smallest_errors_[EdgesBehind(input)])));
  return JudgeStall(input, step);
}

bool Supervisor::HasArrived(const CycleInput& input, const ServoStep& step) {
  if (!(step.law.error <= options_.tolerance)) {
    within_since_s_.reset();
    return false;
  }
  if (!within_since_s_) within_since_s_ = input.time_s;
  return input.time_s - *within_since_s_ >= options_.dwell_s - kTimeSlack_s;
}

std::bitset<2 * kLegCount> Supervisor::EdgesBehind(const CycleInput& input) const {
  std::bitset<2 * kLegCount> edges;
  if (UnitOf(law_.mode) == UnitOf(ControlMode::kPose)) return edges;
  for (const SeenEdge& edge : input.seen.edges)
    if (law_.legs[static_cast<size_t>(edge.leg)]) edges.set(static_cast<size_t>(2 * edge.leg + edge.edge));
  return edges;
}

bool Supervisor::Grows(const CycleInput& input, const ServoStep& step) {
  const double error = step.law.error;
  double& smallest = smallest_errors_.try_emplace(EdgesBehind(input), error).first->second;
  smallest = std::min(smallest, error);
  constexpr double kNoises = 3;  // what noise leaves is no growth
  const double allowed =
      std::max(options_.growth_factor * smallest + options_.growth_tolerances * DefaultTolerance(law_.mode),
               kNoises * step.law.error_noise);
  if (error <= allowed) {
    growing_since_s_.reset();
    return false;
  }
  if (!growing_since_s_) growing_since_s_ = input.time_s;
  return input.time_s - *growing_since_s_ >= options_.growth_s - kTimeSlack_s;
}

// What an error in the image says of the platform's place.
std::string Supervisor::CertaintyText(const ServoStep& step) const {
  if (!LooksAtImages(law_)) return "";
  return fmt::format("; one image tells the platform's place to a σ of {:.2g} mm",
                     1e3 * step.law.motion_sigma_m);
}

// Compares the two halves of the last stall_s.
std::optional<Verdict> Supervisor::JudgeStall(const CycleInput& input, const ServoStep& step) {
  recent_.push_back({input.time_s, EdgesBehind(input), step.law.error,
                     step.joint_speeds_m_per_s.cwiseAbs().maxCoeff(),
                     (step.law.metric * step.law.to_go_m).squaredNorm() / kLegCount, step.singularity_factor,
                     step.speed_factor < 1, step.at_shortest, step.at_longest,
                     input.readings.joint_readings_m, commanded_way_m_});
  if (input.time_s - recent_.front().time_s < options_.stall_s - kTimeSlack_s) return std::nullopt;
  const double middle_s = input.time_s - options_.stall_s / 2;
  double sums[2] = {0, 0}, counts[2] = {0, 0};
  for (const Moment& moment : recent_) {
    if (moment.edges != recent_.back().edges) continue;
    sums[moment.time_s >= middle_s] += moment.error;
    ++counts[moment.time_s >= middle_s];
  }
  if (counts[0] == 0) {  // these edges are new: nothing to compare with
    recent_.pop_front();
    return std::nullopt;
  }
  const double mean = sums[1] / counts[1];
  const bool falls = mean < (1 - options_.stall_share) * sums[0] / counts[0];
  if (!falls && IsOnItsWay()) {
    recent_.clear();
    return std::nullopt;
  }
  if (!falls && IsNoiseAlone(mean, step.law.error_noise))
    return Ended(
        ServoEnd::kConverged,
        fmt::format("{} left, which no longer falls and is what the noise of the edges leaves ({}){}",
                    ErrorText(mean), ErrorText(step.law.error_noise), CertaintyText(step)));
  if (!falls) return WhyStalled(step);
  recent_.pop_front();
  return std::nullopt;
}

// Whether what is left is no more than noise: by the error itself, and, where each edge has its weight, by
// the way to go, of which noise of image and goal leaves a mean square of 1 and 1.
bool Supervisor::IsNoiseAlone(double mean_error, double error_noise) const {
  if (!(mean_error <= options_.tolerance_in_noise * error_noise)) return false;
  if (!law_.is_weighted || law_.mode != ControlMode::kEdges) return true;
  double sum = 0;
  for (const Moment& moment : recent_) sum += moment.noises;
  return sum <=
         2 * options_.tolerance_in_noise * options_.tolerance_in_noise * static_cast<double>(recent_.size());
}

// Whether the speed limit alone makes it slow: mostly at the limit, and not to and fro as noise drives it.
bool Supervisor::IsOnItsWay() const {
  constexpr double kShare = 0.5;
  const auto count = static_cast<double>(recent_.size());
  double limited = 0, speeds_m_per_s = 0;
  for (const Moment& moment : recent_) {
    limited += moment.is_at_speed_limit;
    speeds_m_per_s += moment.fastest_m_per_s;
  }
  const double most_m = speeds_m_per_s / count * (recent_.back().time_s - recent_.front().time_s);
  const double made_m = Farthest(commanded_way_m_ - recent_.front().commanded_way_m).way_m;
  return limited > kShare * count && made_m > kShare * most_m;
}

// The legs that are in the set in most moments of the later half.
std::bitset<kLegCount> Supervisor::MostlyHeld(std::bitset<kLegCount> Moment::*held) const {
  const size_t first = recent_.size() / 2;
  std::array<size_t, kLegCount> counts{};
  for (size_t i = first; i < recent_.size(); ++i)
    for (size_t leg = 0; leg < kLegCount; ++leg) counts[leg] += (recent_[i].*held)[leg];
  std::bitset<kLegCount> mostly;
  for (size_t leg = 0; leg < kLegCount; ++leg) mostly[leg] = 2 * counts[leg] > recent_.size() - first;
  return mostly;
}

Verdict Supervisor::WhyStalled(const ServoStep& step) const {
  const double images_for_s = recent_.back().time_s - images_changed_s_;
  if (LooksAtImages(law_) && images_for_s > options_.stale_s + kTimeSlack_s && HaveJointsMovedSinceImages())
    return Ended(
        ServoEnd::kFrozenImages,
        fmt::format("the images have not changed for {:.2f} s though the joints moved: they are frozen",
                    images_for_s));
  const std::string error = fmt::format("the error no longer falls: {} left", ErrorText(step.law.error));
  if (LooksAtImages(law_) && Farthest(unanswered_by_readings_m_).way_m > kLeastWay_m &&
      HaveMoved(seen_at_readings_, before_->seen))
    return Ended(
        ServoEnd::kFrozenReadings,
        fmt::format("the joint readings have not changed for {:.2f} s: they are frozen, for the images "
                    "show motion",
                    recent_.back().time_s - readings_changed_s_));
  ServoStep held;
  held.at_shortest = MostlyHeld(&Moment::at_shortest);
  held.at_longest = MostlyHeld(&Moment::at_longest);
  if ((held.at_shortest | held.at_longest).any())
    return Ended(
        ServoEnd::kStalled,
        fmt::format("{}, {}: the goal is out of the joint ranges{}", error, DescribeLimits(held),
                    step.law.error_noise > options_.tolerance ? ", or noise drives the joints there" : ""));
  constexpr double kHeldFactor = 0.3;
  if (recent_.back().singularity_factor < kHeldFactor)
    return Ended(step.is_robot_near_singularity ? ServoEnd::kRobotSingular : ServoEnd::kIllConditionedEdges,
                 fmt::format("{}: {}", error, DescribeLimits(step)));
  const Vector6d commanded_m = commanded_way_m_ - recent_.front().commanded_way_m;
  const Vector6d moved_m = recent_.back().readings_m - recent_.front().readings_m;
  const FarthestLeg farthest = Farthest(commanded_m);
  double whole_way_m = 0;
  for (size_t i = 1; i < recent_.size(); ++i)
    whole_way_m +=
        std::abs(recent_[i].commanded_way_m[farthest.leg] - recent_[i - 1].commanded_way_m[farthest.leg]);
  // Commands to and fro say nothing: their drives lag behind.
  const bool is_one_way = 2 * farthest.way_m > whole_way_m;
  if (farthest.way_m > kLeastWay_m && is_one_way &&
      std::abs(moved_m[farthest.leg]) < kFollowedShare * farthest.way_m)
    return Ended(
        ServoEnd::kStalled,
        fmt::format("{}: the drive of leg {} does not follow, it was commanded by {:.2f} mm in {:.1f} s "
                    "and moved by {:.2f} mm (friction, or frozen joint readings)",
                    error, farthest.leg + 1, 1e3 * farthest.way_m, options_.stall_s,
                    1e3 * std::abs(moved_m[farthest.leg])));
  return Ended(
      ServoEnd::kStalled,
      fmt::format("{} and nothing holds the robot: a local minimum, or noise above the tolerance of {}",
                  error, ErrorText(options_.tolerance)));
}

std::string Supervisor::ErrorText(double error) const {
  if (law_.mode == ControlMode::kEdges) return fmt::format("{:.2f} px", error);
  if (law_.mode == ControlMode::kDirections) return fmt::format("{:.2f} mrad", 1e3 * error);
  return fmt::format("{:.3f} mm", 1e3 * error);
}

}  // namespace legible
