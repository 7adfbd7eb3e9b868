// The way that the joints were commanded, and what it takes to say that a joint has followed it.
#pragma once

#include <deque>

#include "core/geometry/rigid3.h"

namespace legible {

constexpr double kLeastWay_m = 5e-5;    // that says anything about following
constexpr double kFollowedShare = 0.2;  // of a commanded way that a drive makes at least if it follows

// The leg that goes farthest, 0-based, either way.
struct FarthestLeg {
  int leg = 0;
  double way_m = 0;
};
FarthestLeg Farthest(const Vector6d& way_m);

// How far each joint had been commanded in all at any moment of the last second, m. What is older ends a
// servo anyway.
class CommandedWay {
 public:
  // Times never go back; the first addition is where the way begins.
  void Add(double time_s, const Vector6d& way_m);
  // Between two additions as if at a steady speed; before the oldest and after the newest as there. Both
  // demand an addition.
  Vector6d At(double time_s) const;
  const Vector6d& InAll() const { return moments_.back().way_m; }

 private:
  struct Moment {
    double time_s;
    Vector6d way_m;
  };
  std::deque<Moment> moments_;
};

}  // namespace legible
