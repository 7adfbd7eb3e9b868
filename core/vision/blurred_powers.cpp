#include "core/vision/blurred_powers.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace legible {
namespace {

constexpr double kFrom = -8, kTo = 16;  // beyond, the step is 0 or the power's own expansion holds to 3e-6
constexpr int kPerUnit = 64;
constexpr int kEntries = static_cast<int>((kTo - kFrom) * kPerUnit) + 1;

double Density(double z) { return std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi); }

// Integrals over u > 0 of u^p phi(z - u) for p = -1/2, 1/2, 3/2, 5/2, with u = v^2 so that the root at 0 does
// no harm (2 v^(2p+1) has a whole exponent); trapezoidal, which is exact to rounding for a smooth integrand
// that vanishes at the far end.
Eigen::Array4d BlurredPowersByQuadrature(double z) {
  constexpr int kSteps = 200;
  const double last = std::sqrt(std::max(z, 0.0) + 9);
  Eigen::Array4d sum(Density(z), 0, 0, 0);  // v = 0
  for (int i = 1; i < kSteps; ++i) {
    const double v = last * i / kSteps, v2 = v * v;
    sum += 2 * Density(z - v2) * Eigen::Array4d(1, v2, v2 * v2, v2 * v2 * v2);
  }
  return sum * last / kSteps;
}

// The powers on the grid, read by cubic Hermite interpolation.
class Table {
 public:
  Table() {
    entries_.reserve(kEntries);
    for (int i = 0; i < kEntries; ++i) entries_.push_back(EntryAt(kFrom + static_cast<double>(i) / kPerUnit));
  }

  BlurredPowers At(double z) const {
    const Place at(z, entries_);
    const Cubic<Eigen::Array4d> cubic(at.a.value, at.a.derivative, at.b.value, at.b.derivative);
    return {cubic.Value(at.t), cubic.Derivative(at.t)};
  }

  Eigen::Array4d CurvaturesAt(double z) const {
    const Place at(z, entries_);
    return Cubic<Eigen::Array4d>(at.a.value, at.a.derivative, at.b.value, at.b.derivative).Second(at.t);
  }

  // Of p = 0 alone.
  BlurredPower StepAt(double z) const {
    const Place at(z, entries_);
    const Cubic<double> cubic(at.a.value[0], at.a.derivative[0], at.b.value[0], at.b.derivative[0]);
    return {cubic.Value(at.t), cubic.Derivative(at.t)};
  }

 private:
  struct Entry {
    Eigen::Array4d value, derivative;
  };
  using Entries = std::vector<Entry, Eigen::aligned_allocator<Entry>>;
  static Entry EntryAt(double z);

  // Between two entries, t of the way from a to b.
  struct Place {
    const Entry &a, &b;
    double t;
    Place(double z, const Entries& entries)
        : Place((z - kFrom) * kPerUnit, static_cast<int>((z - kFrom) * kPerUnit), entries) {}

   private:
    Place(double position, int i, const Entries& entries)
        : a(entries[static_cast<size_t>(i)]), b(entries[static_cast<size_t>(i) + 1]), t(position - i) {}
  };

  template <typename T>
  struct Cubic {
    static constexpr double h = 1.0 / kPerUnit;
    T c0, c1, c2, c3;
    Cubic(const T& a, const T& d_a, const T& b, const T& d_b)
        : c0(a), c1(h * d_a), c2(3 * (b - a) - h * (2 * d_a + d_b)), c3(h * (d_a + d_b) - 2 * (b - a)) {}
    T Value(double t) const { return c0 + t * (c1 + t * (c2 + t * c3)); }
    T Derivative(double t) const { return (c1 + t * (2 * c2 + 3 * t * c3)) / h; }
    T Second(double t) const { return (2 * c2 + 6 * t * c3) / (h * h); }
  };

  Entries entries_;
};

Table::Entry Table::EntryAt(double z) {
  Entry entry;
  entry.value[0] = std::erfc(-z / std::numbers::sqrt2) / 2;
  entry.derivative[0] = Density(z);
  const Eigen::Array4d powers = BlurredPowersByQuadrature(z);
  entry.value.tail<3>() = powers.tail<3>();
  entry.derivative.tail<3>() = Eigen::Array3d(0.5, 1.5, 2.5) * powers.head<3>();
  return entry;
}

// Far inside: z^p (1 + p (p - 1) / (2 z^2)).
BlurredPowers Expansion(double z) {
  BlurredPowers powers{Eigen::Array4d(1, 0, 0, 0), Eigen::Array4d::Zero()};
  for (int i = 1; i < 4; ++i) {
    const double p = i - 0.5, second = p * (p - 1) / 2;
    powers.value[i] = std::pow(z, p) * (1 + second / (z * z));
    powers.derivative[i] = p * std::pow(z, p - 1) + (p - 2) * second * std::pow(z, p - 3);
  }
  return powers;
}

const Table& Powers() {
  static const Table table;
  return table;
}
}  // namespace

BlurredPowers BlurredPowersAt(double z) {
  if (z <= kFrom) return {Eigen::Array4d::Zero(), Eigen::Array4d::Zero()};
  return z < kTo - 1 ? Powers().At(z) : Expansion(z);
}

Eigen::Array4d BlurredCurvaturesAt(double z) {
  if (z <= kFrom) return Eigen::Array4d::Zero();
  if (z < kTo - 1) return Powers().CurvaturesAt(z);
  const Eigen::Array4d p(0, 0.5, 1.5, 2.5);
  const Eigen::Array4d correction = (p - 2) * (p - 3) / (2 * z * z);
  return p * (p - 1) * Eigen::Array4d::Constant(z).pow(p - 2) * (1 + correction);
}

BlurredPower BlurredStepAt(double z) {
  if (z <= kFrom) return {0, 0};
  return z < kTo - 1 ? Powers().StepAt(z) : BlurredPower{1, 0};
}

BlurredPower BlurredRampAt(double z, const BlurredPower& step) {
  return {z * step.value + step.derivative, step.value};
}

BlurredPower BlurredRampAt(double z) {
  constexpr double kStraightFrom = 6;  // to 1e-10
  if (z < -kStraightFrom) return {0, 0};
  return z > kStraightFrom ? BlurredPower{z, 1} : BlurredRampAt(z, Powers().StepAt(z));
}

}  // namespace legible
