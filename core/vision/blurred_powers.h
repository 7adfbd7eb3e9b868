// Powers of the distance inside an edge, seen through a Gaussian blur.
#pragma once

#include <array>

namespace legible {

// G * max(0, x)^p for a Gaussian G of standard deviation 1, and its derivative, at z.
struct BlurredPower {
  double value;
  double derivative;
};

// Half-integer powers have no elementary blurred form (they are parabolic cylinder functions): tabulated
// once.
enum class HalfPower { kOneHalf, kThreeHalves, kFiveHalves };
BlurredPower BlurredHalfPower(HalfPower power, double z);

// p = 0: the normal distribution function.
BlurredPower BlurredStep(double z);
// p = 1: z Phi(z) + phi(z).
BlurredPower BlurredRamp(double z);

}  // namespace legible
