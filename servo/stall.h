// Whether the error of a servo still falls, and what holds the robot where it does not.
#pragma once

#include <array>
#include <bitset>
#include <deque>
#include <optional>
#include <string>

#include "servo/command_answers.h"
#include "servo/servo_step.h"

namespace legible {

// Compares the two halves of the last stall_s.
class StallWatch {
 public:
  StallWatch(const ControlLawOptions& law, const SupervisorOptions& options);

  // To be told of each cycle in which the law gave speeds: also which edges are behind its error. Where the
  // error no longer falls it has stalled, or has converged if it is what noise leaves. None: it falls, or is
  // on its way, or it is too early to tell.
  std::optional<Verdict> Judge(const CycleInput& input, const std::bitset<2 * kLegCount>& edges,
                               const ServoStep& step, const CommandAnswers& answers);
  // Nothing is known of the error meanwhile: it begins anew.
  void Forget() { recent_.clear(); }

 private:
  struct Moment {
    double time_s;
    std::bitset<2 * kLegCount> edges;  // behind the error
    double error, fastest_m_per_s;
    double noises;  // mean square of the way to go, in what noise makes of it; of a weighted law
    bool is_at_speed_limit;
    std::bitset<kLegCount> at_shortest, at_longest;
    Vector6d readings_m, commanded_way_m;
  };
  // Of the errors by the newest edges.
  struct Half {
    double sum = 0, count = 0;
  };

  std::array<Half, 2> Halves() const;
  bool IsOnItsWay() const;
  bool IsNoiseAlone(double mean_error, double error_noise) const;
  Verdict WhyStalled(const ServoStep& step, const CommandAnswers& answers) const;
  std::optional<Verdict> JudgeRanges(const ServoStep& step) const;
  std::optional<Verdict> JudgeSingularity(const ServoStep& step) const;
  std::optional<Verdict> JudgeFollowing(const ServoStep& step) const;
  std::bitset<kLegCount> MostlyHeld(std::bitset<kLegCount> Moment::*held) const;
  Vector6d CommandedSinceFirst() const;
  double WholeWay_m(int leg) const;
  std::string LeftText(const ServoStep& step) const;

  ControlLawOptions law_;
  SupervisorOptions options_;
  std::deque<Moment> recent_;
};

}  // namespace legible
