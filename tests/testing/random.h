// Random values for tests; every generator prints its seed, so that a failure can be repeated.
#pragma once

#include <Eigen/Core>
#include <random>

#include "core/geometry/rigid3.h"
#include "core/robots/gough_stewart.h"

namespace legible {

// A generator seeded for the running test, from the environment variable LEGIBLE_TEST_SEED where that is set;
// prints "seed N".
std::mt19937_64 TestGenerator();

double Uniform(std::mt19937_64& generator, double low, double high);
Eigen::Vector3d UniformVector(std::mt19937_64& generator, double low, double high);
Eigen::Quaterniond UniformRotation(std::mt19937_64& generator);

// A hexapod of the size of a desktop robot: pairs of base joints at 2k pi/3 +- alpha, of platform joints at
// 2k pi/3 +- (pi/3 - beta), every coordinate perturbed by up to perturbation_m.
GoughStewart DesktopHexapod(std::mt19937_64& generator, double perturbation_m);

}  // namespace legible
