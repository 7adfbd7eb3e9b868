#include "servo/commanded_way.h"

#include <algorithm>

namespace legible {
namespace {

constexpr double kLongestMemory_s = 1;

}  // namespace

FarthestLeg Farthest(const Vector6d& way_m) {
  FarthestLeg farthest;
  farthest.way_m = way_m.cwiseAbs().maxCoeff(&farthest.leg);
  return farthest;
}

void CommandedWay::Add(double time_s, const Vector6d& way_m) {
  const Vector6d before_m = moments_.empty() ? Vector6d::Zero() : InAll();
  moments_.push_back({time_s, before_m + way_m});
  while (moments_.size() > 2 && moments_[1].time_s < time_s - kLongestMemory_s) moments_.pop_front();
}

Vector6d CommandedWay::At(double time_s) const {
  if (time_s <= moments_.front().time_s) return moments_.front().way_m;
  const auto after = std::find_if(moments_.begin(), moments_.end(),
                                  [time_s](const Moment& moment) { return moment.time_s >= time_s; });
  if (after == moments_.end()) return moments_.back().way_m;
  const Moment& before = *(after - 1);
  const double share = (time_s - before.time_s) / (after->time_s - before.time_s);
  return before.way_m + share * (after->way_m - before.way_m);
}

}  // namespace legible
