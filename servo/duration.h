// For how long something has lasted in a servo, whose times are sums of periods.
#pragma once

#include <optional>

namespace legible {

constexpr double kTimeSlack_s = 1e-9;  // for the rounding of such sums

inline bool HasLasted(double lasted_s, double for_s) { return lasted_s >= for_s - kTimeSlack_s; }
inline bool IsLongerThan(double lasted_s, double limit_s) { return lasted_s > limit_s + kTimeSlack_s; }

// A condition that counts only once it has held without a break.
class LastingCondition {
 public:
  // Whether it holds now and has done so for that long.
  bool HasHeld(bool now, double time_s, double for_s) {
    if (!now) since_s_.reset();
    if (now && !since_s_) since_s_ = time_s;
    return now && HasLasted(time_s - *since_s_, for_s);
  }
  // Nothing is known of it any more: it has to hold anew.
  void Forget() { since_s_.reset(); }

 private:
  std::optional<double> since_s_;
};

}  // namespace legible
