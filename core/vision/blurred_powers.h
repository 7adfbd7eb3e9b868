// Powers of the distance inside an edge, seen through a Gaussian blur.
#pragma once

#include <Eigen/Core>

namespace legible {

// G * max(0, x)^p for a Gaussian G of standard deviation 1, at z: of p = 0 (the normal distribution
// function), 1/2, 3/2 and 5/2, in this order. Half-integer powers have no elementary blurred form (they are
// parabolic cylinder functions): tabulated once.
struct BlurredPowers {
  Eigen::Array4d value, derivative;
};
BlurredPowers BlurredPowersAt(double z);
// Their second derivatives.
Eigen::Array4d BlurredCurvaturesAt(double z);

// One of them, or of p = 1, with its derivative.
struct BlurredPower {
  double value, derivative;
};
// p = 0 alone.
BlurredPower BlurredStepAt(double z);
// p = 1: z Phi(z) + phi(z); the second from p = 0 at z.
BlurredPower BlurredRampAt(double z);
BlurredPower BlurredRampAt(double z, const BlurredPower& step);

}  // namespace legible
