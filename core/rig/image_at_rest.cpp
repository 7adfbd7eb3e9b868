#include "core/rig/image_at_rest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <stdexcept>

namespace legible {
namespace {

constexpr double kMeansAgree_sigma = 3;
constexpr double kAlwaysAgree_m = 2e-7;  // what no camera sees
constexpr double kSameTime_s = 1e-9;     // clocks are sums of periods

// A whole number.
double HalfOf(size_t count) {
  const size_t half = count / 2;
  return static_cast<double>(half);
}

class Rest {
 public:
  Rest(Rig& rig, const RestOptions& options) : rig_(rig), options_(options), start_s_(rig.Now()) {}

  ImageAtRest Wait() {
    while (true) {
      readings_.push_back(rig_.ReadJoints());
      // Once it stands still all readings are kept, for the image may come late.
      if (!is_still_ && static_cast<int>(readings_.size()) > options_.readings) readings_.pop_front();
      if (!readings_.back().joint_readings_m.allFinite())
        return Missing("the joint readings are not numbers");
      if (options_.is_stopped()) return Missing("stopped by the user");
      is_still_ = IsStill();
      if (is_still_ && TakeImage()) return std::move(taken_);
      if (rig_.Now() - start_s_ >= options_.timeout_s)
        return Missing(is_still_ ? NoImageText() : StillMovesText());
      rig_.WaitUntil(start_s_ + ++periods_ * options_.period_s);
    }
  }

 private:
  // With the newest readings, which may be why.
  ImageAtRest Missing(const std::string& why) const {
    ImageAtRest none;
    none.readings = readings_.back();
    none.missing = why;
    return none;
  }

  // By how much the joints moved from one half of the readings to the other.
  Vector6d Moved() const {
    const size_t half = readings_.size() / 2;
    Vector6d sums[2] = {Vector6d::Zero(), Vector6d::Zero()};
    for (size_t i = 0; i < half; ++i) {
      sums[0] += readings_[i].joint_readings_m;
      sums[1] += readings_[readings_.size() - 1 - i].joint_readings_m;
    }
    return (sums[1] - sums[0]) / static_cast<double>(half);
  }

  bool IsStill() const {
    if (static_cast<int>(readings_.size()) < options_.readings) return false;
    const double allowed_m =
        kMeansAgree_sigma * options_.reading_sigma_m * std::sqrt(2.0 / HalfOf(readings_.size()));
    return Moved().cwiseAbs().maxCoeff() <= std::max(allowed_m, kAlwaysAgree_m);
  }

  // Whether there is one of this rest.
  bool TakeImage() {
    taken_.image = rig_.Grab();
    newest_image_s_ = taken_.image.time_s;
    if (newest_image_s_ < readings_.front().time_s - kSameTime_s) return false;
    taken_.readings = readings_.front();
    for (const StampedReadings& readings : readings_)
      if (std::abs(readings.time_s - newest_image_s_) <= std::abs(taken_.readings.time_s - newest_image_s_))
        taken_.readings = readings;
    return true;
  }

  std::string StillMovesText() const {
    int leg = 0;
    const double moved_m = Moved().cwiseAbs().maxCoeff(&leg);
    return fmt::format("leg {} does not settle: its reading still moves by {:.2g} mm within {:.2g} s",
                       leg + 1, 1e3 * moved_m, HalfOf(readings_.size()) * options_.period_s);
  }

  std::string NoImageText() const {
    return fmt::format("no image comes of the robot at rest: the newest is {:.2g} s old",
                       rig_.Now() - newest_image_s_);
  }

  Rig& rig_;
  const RestOptions& options_;
  double start_s_;
  int periods_ = 0;
  std::deque<StampedReadings> readings_;
  bool is_still_ = false;
  double newest_image_s_ = 0;
  ImageAtRest taken_;
};

}  // namespace

void RestOptions::Check() const {
  if (!(period_s > 0) || !(timeout_s > 0) || !(reading_sigma_m >= 0) || readings < 4)
    throw std::invalid_argument(
        "RestOptions: period_s and timeout_s must be positive, reading_sigma_m not negative, readings 4 or "
        "more");
}

ImageAtRest TakeImageAtRest(Rig& rig, const RestOptions& options) {
  options.Check();
  return Rest(rig, options).Wait();
}

}  // namespace legible
