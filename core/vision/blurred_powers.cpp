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

// Integral over u > 0 of u^p phi(z - u), with u = v^2 so that the root at 0 does no harm (2 v^(2p+1) has a
// whole exponent); trapezoidal, which is exact to rounding for a smooth integrand that vanishes at the far
// end.
double BlurredPowerByQuadrature(int twice_p, double z) {
  constexpr int kSteps = 200;
  const double last = std::sqrt(std::max(z, 0.0) + 9);
  double sum = twice_p == -1 ? Density(z) : 0;  // v = 0
  for (int i = 1; i < kSteps; ++i) {
    const double v = last * i / kSteps;
    double power = 2;
    for (int k = 0; k <= twice_p; ++k) power *= v;
    sum += power * Density(z - v * v);
  }
  return sum * last / kSteps;
}

int TwiceOf(HalfPower power) { return 1 + 2 * static_cast<int>(power); }

const Table& HalfPowerTable(HalfPower power) {
  static const std::array<Table, 3> tables = [] {
    const auto table = [](HalfPower of) {
      const int twice_p = TwiceOf(of);
      return Table([twice_p](double z) {
        return BlurredPower{BlurredPowerByQuadrature(twice_p, z),
                            0.5 * twice_p * BlurredPowerByQuadrature(twice_p - 2, z)};
      });
    };
    return std::array<Table, 3>{table(HalfPower::kOneHalf), table(HalfPower::kThreeHalves),
                                table(HalfPower::kFiveHalves)};
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
  const double p = 0.5 * TwiceOf(power);
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
  constexpr double kStraightFrom = 6;  // to 1e-10
  if (z < -kStraightFrom) return {0, 0};
  if (z > kStraightFrom) return {z, 1};
  const BlurredPower step = BlurredStep(z);
  return {z * step.value + step.derivative, step.value};
}

}  // namespace legible
