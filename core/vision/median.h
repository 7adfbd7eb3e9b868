// The median of measurements.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace legible {

// The upper one of the two in the middle; `values` is not empty.
inline double MedianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace legible
