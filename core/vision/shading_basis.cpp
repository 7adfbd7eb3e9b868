#include "core/vision/shading_basis.h"

#include <cmath>

#include "core/vision/blurred_powers.h"

namespace legible {
namespace {

constexpr double kFirstKink_rad = 0.65;  // surface angle
constexpr double kKinkStep_rad = 0.1;
constexpr double kPixelVariance = 1.0 / 12;  // of a pixel's own extent

}  // namespace

ShadingBasis::ShadingBasis(ShadingModel model, double blur_px, double half_width_px, double inside_px)
    : model_(model), s_(std::sqrt(blur_px * blur_px + kPixelVariance)), w_(half_width_px) {
  size_ = model == ShadingModel::kFlat ? 2 : kFirstKink;
  if (model != ShadingModel::kKinked) return;
  for (double psi = kFirstKink_rad; size_ < kMaxColumns; psi += kKinkStep_rad) {
    const double x = w_ * (1 - std::cos(psi));
    if (x > inside_px + 1.5) break;
    kinks_.push_back({x, 1 / (w_ * std::sin(psi))});
    ++size_;
  }
}

void ShadingBasis::Evaluate(double x, Columns& value, Columns& slope) const {
  const double z = x / s_;
  const BlurredPower step = BlurredStep(z);
  value[0] = 1 - step.value;
  slope[0] = -step.derivative / s_;
  if (model_ == ShadingModel::kFlat) {
    value[1] = step.value;
    slope[1] = -slope[0];
    return;
  }
  const BlurredPower ramp = BlurredRamp(z);
  value[kOutside] = x - s_ * ramp.value;  // x for x < 0, blurred
  slope[kOutside] = 1 - ramp.derivative;
  // 1 - cos psi = x / w
  value[kAmbient] = s_ / w_ * ramp.value;
  slope[kAmbient] = ramp.derivative / w_;
  value[kLevel] = step.value - value[kAmbient];
  slope[kLevel] = -slope[0] - slope[kAmbient];
  EvaluateAngle(z, value[kAngle], slope[kAngle]);
  for (size_t k = 0; k < kinks_.size(); ++k) {
    const BlurredPower kink = BlurredRamp((x - kinks_[k].place_px) / s_);
    value[kFirstKink + static_cast<Eigen::Index>(k)] = s_ * kink.value * kinks_[k].rad_per_px;
    slope[kFirstKink + static_cast<Eigen::Index>(k)] = kink.derivative * kinks_[k].rad_per_px;
  }
}

// psi = acos(1 - x/w) = sqrt(2 x/w) (1 + x/(12 w) + 3 x^2/(160 w^2) + …), blurred term by term.
void ShadingBasis::EvaluateAngle(double z, double& value, double& slope) const {
  const double ratio = s_ / w_;
  const double factor = std::sqrt(2 * ratio);
  const BlurredPower a = BlurredHalfPower(HalfPower::kOneHalf, z);
  const BlurredPower b = BlurredHalfPower(HalfPower::kThreeHalves, z);
  const BlurredPower c = BlurredHalfPower(HalfPower::kFiveHalves, z);
  const double of_b = ratio / 12, of_c = 3 * ratio * ratio / 160;
  value = factor * (a.value + of_b * b.value + of_c * c.value);
  slope = factor / s_ * (a.derivative + of_b * b.derivative + of_c * c.derivative);
}

}  // namespace legible
