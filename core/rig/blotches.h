// A smooth random pattern in space: what keeps a painted ground from being too even.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace legible {

// A sum of plane waves of 6 to 50 cm, of mean 0 and standard deviation `sigma` over space.
class Blotches {
 public:
  Blotches(double sigma, std::uint64_t seed);
  double At(const Eigen::Vector3d& x_m) const;

 private:
  struct Wave {
    Eigen::Vector3d number_per_m;  // rad/m
    double phase = 0;
  };
  std::array<Wave, 16> waves_;
  double amplitude_;
};

}  // namespace legible
