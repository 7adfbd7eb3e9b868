#include "core/vision/blurred_powers.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace legible {
namespace {

constexpr double kFrom = -8, kTo = 16;  // beyond, the step is 0 or the power's own expansion holds to 1e-7
constexpr int kPerUnit = 64;
constexpr int kEntries = static_cast<int>((kTo - kFrom) * kPerUnit) + 1;

double Density(double z) { return std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi); }

// A function on the grid with its derivative, read by cubic Hermite interpolation.
class Table {
 public:
  template <typename F>
  explicit Table(F evaluate) {
    entries_.reserve(kEntries);
    for (int i = 0; i < kEntries; ++i)
      entries_.push_back(evaluate(kFrom + static_cast<double>(i) / kPerUnit));
  }

  BlurredPower At(double z) const {
    const double position = (z - kFrom) * kPerUnit;
    const int i = static_cast<int>(position);
    const double t = position - i;
    const BlurredPower &a = entries_[static_cast<size_t>(i)], &b = entries_[static_cast<size_t>(i) + 1];
    constexpr double h = 1.0 / kPerUnit;
    const double rise = b.value - a.value;
    const double c2 = 3 * rise - h * (2 * a.derivative + b.derivative);
    const double c3 = h * (a.derivative + b.derivative) - 2 * rise;
    return {a.value + t * (h * a.derivative + t * (c2 + t * c3)),
            a.derivative + t * (2 * c2 + 3 * t * c3) / h};
  }

 private:
  std::vector<BlurredPower> entries_;
};

// Integral over u > 0 of u^p phi(z - u), with u = v^2 so that the root at 0 does no harm; trapezoidal, which
// is exact to rounding for a smooth integrand that vanishes at both ends.
double BlurredPowerByQuadrature(double p, double z) {
  constexpr int kSteps = 600;
  const double last = std::sqrt(std::max(z, 0.0) + 9);
  double sum = 0;
  for (int i = 1; i < kSteps; ++i) {
    const double v = last * i / kSteps;
    sum += 2 * std::pow(v, 2 * p + 1) * Density(z - v * v);
  }
  return sum * last / kSteps;
}

double PowerOf(HalfPower power) { return 0.5 + static_cast<double>(power); }

const Table& HalfPowerTable(HalfPower power) {
  static const std::array<Table, 3> tables = [] {
    const auto table = [](double p) {
      return Table([p](double z) {
        // d/dz = p G * x^(p-1); for p = 1/2 the integrand 2 v^0 phi is still smooth.
        return BlurredPower{BlurredPowerByQuadrature(p, z),
                            p * (BlurredPowerByQuadrature(p - 1, z) +
                                 (p < 1 ? Density(z) * std::sqrt(std::max(z, 0.0) + 9) / 600 : 0))};
      });
    };
    return std::array<Table, 3>{table(0.5), table(1.5), table(2.5)};
  }();
  return tables[static_cast<size_t>(power)];
}

const Table& StepTable() {
  static const Table table([](double z) {
    return BlurredPower{std::erfc(-z / std::numbers::sqrt2) / 2, Density(z)};
  });
  return table;
}

}  // namespace

BlurredPower BlurredHalfPower(HalfPower power, double z) {
  if (z <= kFrom) return {0, 0};
  if (z < kTo - 1) return HalfPowerTable(power).At(z);
  const double p = PowerOf(power);
  const double second = p * (p - 1) / 2;
  return {std::pow(z, p) * (1 + second / (z * z)),
          p * std::pow(z, p - 1) + (p - 2) * second * std::pow(z, p - 3)};
}

BlurredPower BlurredStep(double z) {
  if (z <= kFrom) return {0, 0};
  if (z >= kTo - 1) return {1, 0};
  return StepTable().At(z);
}

BlurredPower BlurredRamp(double z) {
  const BlurredPower step = BlurredStep(z);
  return {z * step.value + step.derivative, step.value};
}

}  // namespace legible
