#include "core/rig/blotches.h"

#include <cmath>
#include <numbers>
#include <random>

namespace legible {

Blotches::Blotches(double sigma, std::uint64_t seed)
    : amplitude_(sigma * std::sqrt(2.0 / static_cast<double>(waves_.size()))) {
  constexpr double kShortest_m = 0.06, kLongest_m = 0.5, kTurn = 2 * std::numbers::pi;
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  for (Wave& wave : waves_) {
    const Eigen::Vector3d direction(normal(generator), normal(generator), normal(generator));
    const double length_m = kShortest_m * std::pow(kLongest_m / kShortest_m, uniform(generator));
    wave.number_per_m = kTurn / length_m * direction.normalized();
    wave.phase = kTurn * uniform(generator);
  }
}

double Blotches::At(const Eigen::Vector3d& x_m) const {
  double sum = 0;
  for (const Wave& wave : waves_) sum += std::cos(wave.number_per_m.dot(x_m) + wave.phase);
  return amplitude_ * sum;
}

}  // namespace legible
