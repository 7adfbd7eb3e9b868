// Elapsed wall-clock time.
#pragma once

#include <chrono>

namespace legible {

class Stopwatch {
 public:
  double Seconds() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
  }  // since the start
  // Since the start or the last lap, whichever was later.
  double Lap() {
    const double total_s = Seconds(), lap_s = total_s - before_lap_s_;
    before_lap_s_ = total_s;
    return lap_s;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
  double before_lap_s_ = 0;
};

}  // namespace legible
