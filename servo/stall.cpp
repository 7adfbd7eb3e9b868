#include "servo/stall.h"

#include <fmt/format.h>

#include <cmath>

#include "servo/duration.h"
#include "servo/error_text.h"

namespace legible {
namespace {

constexpr double kHeldFactor = 0.3;  // slowed to less near a singularity, a robot is held there

}  // namespace

StallWatch::StallWatch(const ControlLawOptions& law, const SupervisorOptions& options)
    : law_(law), options_(options) {}

std::optional<Verdict> StallWatch::Judge(const CycleInput& input, const std::bitset<2 * kLegCount>& edges,
                                         const ServoStep& step, const CommandAnswers& answers) {
  recent_.push_back({input.time_s, edges, step.law.error, step.joint_speeds_m_per_s.cwiseAbs().maxCoeff(),
                     (step.law.metric * step.law.to_go_m).squaredNorm() / kLegCount,
                     step.speed_factor < 1 && step.singularity_factor >= kHeldFactor, step.at_shortest,
                     step.at_longest, input.readings.joint_readings_m, answers.CommandedInAll()});
  if (!HasLasted(input.time_s - recent_.front().time_s, options_.stall_s)) return std::nullopt;
  const auto [earlier, later] = Halves();
  const double mean = later.sum / later.count;
  const bool are_edges_new = earlier.count == 0;  // nothing to compare with
  if (are_edges_new || mean < (1 - options_.stall_share) * earlier.sum / earlier.count) {
    recent_.pop_front();
    return std::nullopt;
  }
  if (IsOnItsWay()) {
    recent_.clear();
    return std::nullopt;
  }
  if (IsNoiseAlone(mean, step.law.error_noise))
    return Ended(
        ServoEnd::kConverged,
        fmt::format("{} left, which no longer falls and is what the noise of the edges leaves ({}){}",
                    ErrorText(law_.mode, mean), ErrorText(law_.mode, step.law.error_noise),
                    CertaintyText(law_, step.law)));
  return WhyStalled(step, answers);
}

std::array<StallWatch::Half, 2> StallWatch::Halves() const {
  const double middle_s = recent_.back().time_s - options_.stall_s / 2;
  std::array<Half, 2> halves;
  for (const Moment& moment : recent_) {
    if (moment.edges != recent_.back().edges) continue;
    Half& half = halves[moment.time_s >= middle_s];
    half.sum += moment.error;
    ++half.count;
  }
  return halves;
}

// Whether the speed limit alone makes it slow: mostly at the limit, and not to and fro as noise drives it.
bool StallWatch::IsOnItsWay() const {
  constexpr double kShare = 0.5;
  const auto count = static_cast<double>(recent_.size());
  double limited = 0, speeds_m_per_s = 0;
  for (const Moment& moment : recent_) {
    limited += moment.is_at_speed_limit;
    speeds_m_per_s += moment.fastest_m_per_s;
  }
  const double most_m = speeds_m_per_s / count * (recent_.back().time_s - recent_.front().time_s);
  const double made_m = Farthest(CommandedSinceFirst()).way_m;
  return limited > kShare * count && made_m > kShare * most_m;
}

// Whether what is left is no more than noise: by the error itself, and, where each edge has its weight, by
// the way to go, of which noise of image and goal leaves a mean square of 1 and 1.
bool StallWatch::IsNoiseAlone(double mean_error, double error_noise) const {
  if (!(mean_error <= options_.tolerance_in_noise * error_noise)) return false;
  if (!law_.is_weighted || law_.mode != ControlMode::kEdges) return true;
  double sum = 0;
  for (const Moment& moment : recent_) sum += moment.noises;
  return sum <=
         2 * options_.tolerance_in_noise * options_.tolerance_in_noise * static_cast<double>(recent_.size());
}

Verdict StallWatch::WhyStalled(const ServoStep& step, const CommandAnswers& answers) const {
  std::optional<Verdict> verdict = answers.JudgeStalled();
  if (!verdict) verdict = JudgeRanges(step);
  if (!verdict) verdict = JudgeSingularity(step);
  if (!verdict) verdict = JudgeFollowing(step);
  if (verdict) return *verdict;
  return Ended(
      ServoEnd::kStalled,
      fmt::format("{} and nothing holds the robot: a local minimum, or noise above the tolerance of {}",
                  LeftText(step), ErrorText(law_.mode, options_.tolerance)));
}

std::optional<Verdict> StallWatch::JudgeRanges(const ServoStep& step) const {
  ServoStep held;
  held.at_shortest = MostlyHeld(&Moment::at_shortest);
  held.at_longest = MostlyHeld(&Moment::at_longest);
  if ((held.at_shortest | held.at_longest).none()) return std::nullopt;
  return Ended(
      ServoEnd::kStalled,
      fmt::format("{}, {}: the goal is out of the joint ranges{}", LeftText(step), DescribeLimits(held),
                  step.law.error_noise > options_.tolerance ? ", or noise drives the joints there" : ""));
}

// The legs that are in the set in most moments of the later half.
std::bitset<kLegCount> StallWatch::MostlyHeld(std::bitset<kLegCount> Moment::*held) const {
  const size_t first = recent_.size() / 2;
  std::array<size_t, kLegCount> counts{};
  for (size_t i = first; i < recent_.size(); ++i)
    for (size_t leg = 0; leg < kLegCount; ++leg) counts[leg] += (recent_[i].*held)[leg];
  std::bitset<kLegCount> mostly;
  for (size_t leg = 0; leg < kLegCount; ++leg) mostly[leg] = 2 * counts[leg] > recent_.size() - first;
  return mostly;
}

std::optional<Verdict> StallWatch::JudgeSingularity(const ServoStep& step) const {
  if (!(step.singularity_factor < kHeldFactor)) return std::nullopt;
  return Ended(step.slowed_by == SlowedBy::kRobotSingularity ? ServoEnd::kRobotSingular
                                                             : ServoEnd::kIllConditionedEdges,
               fmt::format("{}: {}", LeftText(step), DescribeLimits(step)));
}

// The drive that was commanded farthest. Commands to and fro say nothing: their drives lag behind.
std::optional<Verdict> StallWatch::JudgeFollowing(const ServoStep& step) const {
  const FarthestLeg farthest = Farthest(CommandedSinceFirst());
  const double moved_m =
      std::abs(recent_.back().readings_m[farthest.leg] - recent_.front().readings_m[farthest.leg]);
  const bool is_one_way = 2 * farthest.way_m > WholeWay_m(farthest.leg);
  if (!(farthest.way_m > kLeastWay_m && is_one_way && moved_m < kFollowedShare * farthest.way_m))
    return std::nullopt;
  return Ended(
      ServoEnd::kStalled,
      fmt::format("{}: the drive of leg {} does not follow, it was commanded by {:.2f} mm in {:.1f} s "
                  "and moved by {:.2f} mm (friction, or frozen joint readings)",
                  LeftText(step), farthest.leg + 1, 1e3 * farthest.way_m, options_.stall_s, 1e3 * moved_m));
}

Vector6d StallWatch::CommandedSinceFirst() const {
  return recent_.back().commanded_way_m - recent_.front().commanded_way_m;
}

// Back and forth counted alike.
double StallWatch::WholeWay_m(int leg) const {
  double whole_way_m = 0;
  for (size_t i = 1; i < recent_.size(); ++i)
    whole_way_m += std::abs(recent_[i].commanded_way_m[leg] - recent_[i - 1].commanded_way_m[leg]);
  return whole_way_m;
}

std::string StallWatch::LeftText(const ServoStep& step) const {
  return fmt::format("the error no longer falls: {} left", ErrorText(law_.mode, step.law.error));
}

}  // namespace legible
