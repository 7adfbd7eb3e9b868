// A gain that grows as the error shrinks (ViSP's vpAdaptiveGain): slow from afar, strong enough near the goal
// to overcome friction.
#pragma once

#include <cmath>
#include <stdexcept>

namespace legible {

struct AdaptiveGain {
  double at_zero_per_s = 1;
  double at_infinity_per_s = 1;
  double slope_at_zero = 0;  // by how much it falls with the error at first, 1/s by unit of the error

  static AdaptiveGain Constant(double gain_per_s) { return {gain_per_s, gain_per_s, 0}; }

  double At(double error) const {
    const double range = at_zero_per_s - at_infinity_per_s;
    if (range == 0) return at_zero_per_s;
    return range * std::exp(-slope_at_zero * error / range) + at_infinity_per_s;
  }

  void Check() const {
    if (!(at_infinity_per_s > 0) || !(at_zero_per_s >= at_infinity_per_s) || !std::isfinite(at_zero_per_s))
      throw std::invalid_argument("AdaptiveGain: gains must be positive, that at zero the larger");
    if (!(slope_at_zero >= 0)) throw std::invalid_argument("AdaptiveGain: the slope must not be negative");
  }
};

}  // namespace legible
