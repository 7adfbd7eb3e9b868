#include "servo/joint_limits.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace legible {
namespace {

constexpr int kMaxRounds = 60;
constexpr double kLeastPull = 1e-10;  // of a bound on what it holds, as a share of the wanted speeds' pull

// Where each joint's speed stands.
enum class At { kFree, kLowest, kHighest };

class BoundedLeastSquares {
 public:
  BoundedLeastSquares(const SpeedBounds& bounds, const Matrix6d& metric, const Vector6d& wanted)
      : bounds_(bounds),
        hessian_(metric.transpose() * metric),
        wanted_(wanted),
        x_(wanted.cwiseMax(bounds.lowest).cwiseMin(bounds.highest)) {
    for (int i = 0; i < 6; ++i)
      at_[static_cast<size_t>(i)] = wanted[i] < bounds.lowest[i]    ? At::kLowest
                                    : wanted[i] > bounds.highest[i] ? At::kHighest
                                                                    : At::kFree;
  }

  Vector6d Solve() {
    for (int round = 0; round < kMaxRounds; ++round) {
      if (!MoveFree()) continue;
      if (!ReleaseOne()) break;
    }
    return x_;
  }

 private:
  bool IsFree(int i) const { return at_[static_cast<size_t>(i)] == At::kFree; }

  // The best speeds of the free joints, the others as they stand.
  Vector6d BestFree() const {
    Matrix6d system = hessian_;
    Vector6d right = hessian_ * wanted_;
    for (int i = 0; i < 6; ++i) {
      if (IsFree(i)) continue;
      right -= hessian_.col(i) * x_[i];
      system.row(i).setZero();
      system.col(i).setZero();
      system(i, i) = 1;
    }
    for (int i = 0; i < 6; ++i)
      if (!IsFree(i)) right[i] = x_[i];
    return system.ldlt().solve(right);
  }

  // Towards the best as far as the bounds allow; whether it was reached. A joint that stopped it is held.
  bool MoveFree() {
    const Vector6d best = BestFree();
    double step = 1;
    int stopped_by = -1;
    bool is_stopped_below = false;
    for (int i = 0; i < 6; ++i) {
      if (!IsFree(i)) continue;
      const double bound = best[i] < x_[i] ? bounds_.lowest[i] : bounds_.highest[i];
      const bool passes = best[i] < x_[i] ? best[i] < bound : best[i] > bound;
      if (!passes) continue;
      const double share = std::clamp((bound - x_[i]) / (best[i] - x_[i]), 0.0, 1.0);
      if (stopped_by >= 0 && share >= step) continue;
      step = share;
      stopped_by = i;
      is_stopped_below = best[i] < x_[i];
    }
    for (int i = 0; i < 6; ++i)
      if (IsFree(i))
        x_[i] = std::clamp(x_[i] + step * (best[i] - x_[i]), bounds_.lowest[i], bounds_.highest[i]);
    if (stopped_by < 0) return true;
    at_[static_cast<size_t>(stopped_by)] = is_stopped_below ? At::kLowest : At::kHighest;
    x_[stopped_by] = is_stopped_below ? bounds_.lowest[stopped_by] : bounds_.highest[stopped_by];
    return false;
  }

  // Lets go the joint whose bound holds it back from the wrong side most; whether there is one.
  bool ReleaseOne() {
    const Vector6d pull = hessian_ * (wanted_ - x_);
    const double least = kLeastPull * (hessian_ * wanted_).cwiseAbs().maxCoeff();
    int strongest = -1;
    double strength = least;
    for (int i = 0; i < 6; ++i) {
      // A joint without any play would be held again at once, and so on for ever.
      if (IsFree(i) || bounds_.lowest[i] == bounds_.highest[i]) continue;
      const double inward = at_[static_cast<size_t>(i)] == At::kLowest ? pull[i] : -pull[i];
      if (inward <= strength) continue;
      strength = inward;
      strongest = i;
    }
    if (strongest < 0) return false;
    at_[static_cast<size_t>(strongest)] = At::kFree;
    return true;
  }

  const SpeedBounds& bounds_;
  Matrix6d hessian_;
  Vector6d wanted_, x_;
  std::array<At, 6> at_;
};

}  // namespace

void JointLimitOptions::Check() const {
  if (!(speed_limit_m_per_s > 0) || !(range_margin_m >= 0))
    throw std::invalid_argument(
        "JointLimitOptions: speed_limit_m_per_s must be positive, range_margin_m not negative");
  if (!(look_ahead_s >= Rig::kCommandHolds_s))
    throw std::invalid_argument(
        fmt::format("JointLimitOptions: look_ahead_s must be {} or more, for which a rig holds a command",
                    Rig::kCommandHolds_s));
}

SpeedBounds BoundsByRange(const GoughStewart& robot, const Vector6d& joint_readings_m,
                          const Vector6d& way_since_readings_m, const JointLimitOptions& options) {
  SpeedBounds bounds;
  for (int i = 0; i < kLegCount; ++i) {
    const auto [shortest_m, longest_m] = robot.legs[static_cast<size_t>(i)].joint_range_m;
    const double way_m = way_since_readings_m[i];
    const double shortest_now_m = joint_readings_m[i] + std::min(way_m, 0.0);
    const double longest_now_m = joint_readings_m[i] + std::max(way_m, 0.0);
    bounds.lowest[i] =
        std::min(0.0, (shortest_m + options.range_margin_m - shortest_now_m) / options.look_ahead_s);
    bounds.highest[i] =
        std::max(0.0, (longest_m - options.range_margin_m - longest_now_m) / options.look_ahead_s);
  }
  return bounds;
}

Vector6d NearestWithin(const SpeedBounds& bounds, const Matrix6d& metric, const Vector6d& wanted) {
  return BoundedLeastSquares(bounds, metric, wanted).Solve();
}

}  // namespace legible
