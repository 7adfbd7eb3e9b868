// Whether each joint follows what is commanded, by its reading.
#pragma once

#include <deque>
#include <optional>

#include "core/geometry/rigid3.h"

namespace legible {

class JointFollowing {
 public:
  // Of each fresh set of readings: how far the joints had been commanded in all when these were taken, m.
  void Note(double time_s, const Vector6d& commanded_way_m, const Vector6d& readings_m);

  struct Behind {
    int joint = 0;  // 0-based
    double commanded_m = 0, made_m = 0, for_s = 0;
    bool has_not_changed = false;  // its reading, to the last bit
  };
  // The joint that made least of what was commanded: within the last kLongest_s at least way_m, all in one
  // direction (a lag hides what goes to and fro), of which its reading shows less than kFollowedShare
  // (servo/commanded_way.h), either way. Slower commands say nothing here: friction may hold a joint for a
  // while.
  std::optional<Behind> Farthest(double way_m) const;

 private:
  static constexpr double kLongest_s = 0.5;   // longest that is looked back
  static constexpr double kLeast_s = 0.25;    // shortest: drives answer with a lag
  static constexpr double kSettled_s = 0.15;  // before that, in which it was not commanded the other way
  static constexpr double kToAndFro = 1.1;    // most whole way over the way that is left of it

  struct Moment {
    double time_s;
    Vector6d way_m, readings_m;
  };
  std::optional<Behind> OfJoint(int joint, double way_m) const;

  std::deque<Moment> moments_;
};

}  // namespace legible
