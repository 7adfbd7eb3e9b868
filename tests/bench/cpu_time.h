// Processor time of this thread: what others do on the machine does not count.
#pragma once

#include <algorithm>
#include <ctime>
#include <vector>

namespace legible {

inline double CpuTime_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// The value below which that share of the times lies; `times` must not be empty.
inline double QuantileOf(std::vector<double> times, double share) {
  const auto place =
      std::min(times.size() - 1, static_cast<size_t>(share * static_cast<double>(times.size())));
  const auto at = times.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(times.begin(), at, times.end());
  return *at;
}

}  // namespace legible
