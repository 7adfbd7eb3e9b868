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
    : model_(model), blur_px_(blur_px), s_(std::sqrt(blur_px * blur_px + kPixelVariance)), w_(half_width_px) {
  const double ratio = s_ / w_;
  angle_ = std::sqrt(2 * ratio) * Eigen::Array4d(0, 1, ratio / 12, 3 * ratio * ratio / 160);
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
  if (model_ == ShadingModel::kFlat) {
    const BlurredPower step = BlurredStepAt(z);
    value[0] = 1 - step.value;
    value[1] = step.value;
    slope[1] = step.derivative / s_;
    slope[0] = -slope[1];
    return;
  }
  const BlurredPowers powers = BlurredPowersAt(z);
  const BlurredPower step{powers.value[0], powers.derivative[0]};
  const BlurredPower ramp = BlurredRampAt(z, step);
  value[0] = 1 - step.value;
  slope[0] = -step.derivative / s_;
  value[kOutside] = x - s_ * ramp.value;  // x for x < 0, blurred
  slope[kOutside] = 1 - ramp.derivative;
  // 1 - cos psi = x / w
  value[kAmbient] = s_ / w_ * ramp.value;
  slope[kAmbient] = ramp.derivative / w_;
  value[kLevel] = step.value - value[kAmbient];
  slope[kLevel] = -slope[0] - slope[kAmbient];
  value[kAngle] = (angle_ * powers.value).sum();
  slope[kAngle] = (angle_ * powers.derivative).sum() / s_;
  for (size_t k = 0; k < kinks_.size(); ++k) {
    const BlurredPower kink = BlurredRampAt((x - kinks_[k].place_px) / s_);
    value[kFirstKink + static_cast<Eigen::Index>(k)] = s_ * kink.value * kinks_[k].rad_per_px;
    slope[kFirstKink + static_cast<Eigen::Index>(k)] = kink.derivative * kinks_[k].rad_per_px;
  }
}

double ShadingBasis::SlopeByBlur(double x, const Eigen::Ref<const Eigen::VectorXd>& coefficients) const {
  const Eigen::Array4d curvatures = BlurredCurvaturesAt(x / s_) / (s_ * s_);
  const double step = curvatures[0];
  if (model_ == ShadingModel::kFlat) return blur_px_ * (coefficients[1] - coefficients[0]) * step;
  const double ramp = BlurredStepAt(x / s_).derivative / s_;  // of s ramp(x / s)
  double curvature = (coefficients[kLevel] - coefficients[0]) * step - coefficients[kOutside] * ramp +
                     (coefficients[kAmbient] - coefficients[kLevel]) * ramp / w_ +
                     coefficients[kAngle] * (angle_ * curvatures).sum();
  for (size_t k = 0; k < kinks_.size(); ++k) {
    const double z = (x - kinks_[k].place_px) / s_;
    curvature += coefficients[kFirstKink + static_cast<Eigen::Index>(k)] * kinks_[k].rad_per_px *
                 BlurredStepAt(z).derivative / s_;
  }
  return blur_px_ * curvature;
}

}  // namespace legible
