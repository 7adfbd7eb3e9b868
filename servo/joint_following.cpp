#include "servo/joint_following.h"

#include <cmath>

#include "servo/commanded_way.h"

namespace legible {

void JointFollowing::Note(double time_s, const Vector6d& commanded_way_m, const Vector6d& readings_m) {
  moments_.push_back({time_s, commanded_way_m, readings_m});
  while (moments_.front().time_s < time_s - kLongest_s - 2 * kSettled_s) moments_.pop_front();
}

std::optional<JointFollowing::Behind> JointFollowing::Farthest(double way_m) const {
  std::optional<Behind> farthest;
  for (int joint = 0; joint < 6; ++joint) {
    const auto behind = OfJoint(joint, way_m);
    if (behind && (!farthest || behind->commanded_m > farthest->commanded_m)) farthest = behind;
  }
  return farthest;
}

// Against the newest moment that is old enough and from which it was commanded far enough, unless it was
// commanded the other way shortly before that.
std::optional<JointFollowing::Behind> JointFollowing::OfJoint(int joint, double way_m) const {
  if (moments_.empty()) return std::nullopt;
  const Moment& now = moments_.back();
  std::optional<Behind> behind;
  bool has_not_changed = true;
  double later_way_m = now.way_m[joint], whole_way_m = 0;
  for (auto then = moments_.rbegin(); then != moments_.rend(); ++then) {
    has_not_changed = has_not_changed && then->readings_m[joint] == now.readings_m[joint];
    whole_way_m += std::abs(later_way_m - then->way_m[joint]);
    later_way_m = then->way_m[joint];
    const double commanded_m = std::abs(now.way_m[joint] - then->way_m[joint]);
    const double for_s = now.time_s - then->time_s;
    if (whole_way_m > kToAndFro * commanded_m + way_m / 10) return std::nullopt;
    if (behind ? for_s >= behind->for_s + kSettled_s : for_s > kLongest_s) break;
    if (behind || for_s < kLeast_s || commanded_m < way_m) continue;
    const double made_m = std::abs(now.readings_m[joint] - then->readings_m[joint]);
    if (made_m >= kFollowedShare * commanded_m) return std::nullopt;
    behind = Behind{joint, commanded_m, made_m, for_s, has_not_changed};
  }
  return behind;
}

}  // namespace legible
