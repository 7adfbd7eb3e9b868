#include "core/vision/shading_basis.h"

#include <gtest/gtest.h>

#include <cmath>

namespace legible {
namespace {

constexpr double kBlur_px = 0.8, kHalfWidth_px = 14, kInside_px = 6;

ShadingBasis Basis(ShadingModel model) { return {model, kBlur_px, kHalfWidth_px, kInside_px}; }

ShadingBasis::Columns ValuesAt(const ShadingBasis& basis, double x) {
  ShadingBasis::Columns value = ShadingBasis::Columns::Zero(), slope = value;
  basis.Evaluate(x, value, slope);
  return value;
}

TEST(ShadingBasis, SlopesAreThoseOfTheFunctions) {
  for (const ShadingModel model : {ShadingModel::kFlat, ShadingModel::kAngular, ShadingModel::kKinked}) {
    const ShadingBasis basis = Basis(model);
    for (double x = -6; x < 5.5; x += 0.31) {
      ShadingBasis::Columns value = ShadingBasis::Columns::Zero(), slope = value;
      basis.Evaluate(x, value, slope);
      constexpr double kStep = 1e-3;
      const ShadingBasis::Columns numeric =
          (8 * (ValuesAt(basis, x + kStep) - ValuesAt(basis, x - kStep)) -
           (ValuesAt(basis, x + 2 * kStep) - ValuesAt(basis, x - 2 * kStep))) /
          (12 * kStep);
      for (Eigen::Index i = 0; i < basis.size(); ++i)
        EXPECT_NEAR(slope[i], numeric[i], 1e-5) << x << ' ' << i;
    }
  }
}

TEST(ShadingBasis, SlopesByBlurAreThoseOfTheBrightness) {
  constexpr double kStep = 0.01;
  for (const ShadingModel model : {ShadingModel::kFlat, ShadingModel::kAngular, ShadingModel::kKinked}) {
    const ShadingBasis basis = Basis(model);
    Eigen::VectorXd coefficients(basis.size());
    for (Eigen::Index i = 0; i < coefficients.size(); ++i)
      coefficients[i] = 30 + 17 * static_cast<double>(i % 3);
    const auto brightness = [&](double blur_px, double x) {
      return ValuesAt({model, blur_px, kHalfWidth_px, kInside_px}, x).head(basis.size()).dot(coefficients);
    };
    for (double x = -4; x < 5.5; x += 0.31)
      EXPECT_NEAR(basis.SlopeByBlur(x, coefficients),
                  (brightness(kBlur_px + kStep, x) - brightness(kBlur_px - kStep, x)) / (2 * kStep), 0.02)
          << x;
  }
}

// Integral of f over the normal distribution about x of the whole blur, by fine summation.
template <typename F>
double BlurredBySummation(double x, F f) {
  const double s = std::sqrt(kBlur_px * kBlur_px + 1.0 / 12);
  double sum = 0, weights = 0;
  for (double u = -7 * s; u <= 7 * s; u += 1.0 / 1024) {
    const double weight = std::exp(-u * u / (2 * s * s));
    sum += weight * f(x - u);
    weights += weight;
  }
  return sum / weights;
}

TEST(ShadingBasis, ShadedColumnsAreBlurredCosineAngleAndAmbient) {
  const ShadingBasis basis = Basis(ShadingModel::kAngular);
  const auto inside = [](auto f) {
    return [f](double x) { return x > 0 ? f(std::acos(std::max(-1.0, 1 - x / kHalfWidth_px))) : 0.0; };
  };
  for (const double x : {-2.0, -0.5, 0.0, 0.4, 1.5, 5.0}) {
    const ShadingBasis::Columns value = ValuesAt(basis, x);
    EXPECT_NEAR(value[ShadingBasis::kLevel],
                BlurredBySummation(x, inside([](double a) { return std::cos(a); })), 1e-3);
    EXPECT_NEAR(value[ShadingBasis::kAngle], BlurredBySummation(x, inside([](double a) { return a; })), 1e-3);
    EXPECT_NEAR(value[ShadingBasis::kAmbient],
                BlurredBySummation(x, inside([](double a) { return 1 - std::cos(a); })), 1e-3);
    EXPECT_NEAR(value[0], BlurredBySummation(x, [](double at) { return at < 0 ? 1.0 : 0.0; }), 1e-3);
    EXPECT_NEAR(value[ShadingBasis::kOutside],
                BlurredBySummation(x, [](double at) { return std::min(at, 0.0); }), 1e-3);
  }
}

}  // namespace
}  // namespace legible
