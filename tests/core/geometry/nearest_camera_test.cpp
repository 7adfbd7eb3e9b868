#include "core/geometry/nearest_camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/testing/matrices.h"

namespace legible {
namespace {

Camera CameraOf(LensModel lens, std::initializer_list<double> coefficients) {
  Camera camera{1280, 960, 640, 644, 652, 467, lens, Distortion::Zero()};
  std::copy(coefficients.begin(), coefficients.end(), camera.distortion.begin());
  return camera;
}

const Camera kPinhole = CameraOf(LensModel::kPinhole, {});
const Camera kBrown = CameraOf(LensModel::kBrownConrady, {-0.2, 0.05, 1e-3, -5e-4, -0.004});
const Camera kRational = CameraOf(LensModel::kRational, {0.6, 0.04, 5e-4, -7e-4, 0.002, 0.9, 0.1, 0.005});
const Camera kFisheye = CameraOf(LensModel::kFisheye, {-0.013, 0.011, -0.009, 0.002});

NearestCamera Nearest(const Camera& camera, LensModel lens) {
  return FindNearestCamera(camera, lens, AllParametersOf(lens));
}

// The largest distance between the pixels of both cameras over the image, on another grid.
double LargestDistance(const Camera& a, const Camera& b) {
  double largest = 0;
  for (int column = 0; column <= 97; ++column)
    for (int row = 0; row <= 89; ++row) {
      const Eigen::Vector2d pixel(column * 1279 / 97.0, row * 959 / 89.0);
      largest = std::max(largest, (ProjectNormalised(b, Unproject(a, pixel).value()) - pixel).norm());
    }
  return largest;
}

TEST(NearestCamera, KeepsWhatTheOtherLensCanExpress) {
  for (const Camera& camera : {kPinhole, kBrown, kRational}) {
    const NearestCamera found = Nearest(camera, LensModel::kRational);
    EXPECT_EQ(ParametersOf(found.camera), ParametersOf(camera));
    EXPECT_EQ(found.camera.lens, LensModel::kRational);
    EXPECT_EQ(found.max_px, 0);
  }
  EXPECT_EQ(Nearest(kFisheye, LensModel::kFisheye).max_px, 0);
}

TEST(NearestCamera, StatesTheDistanceThatIsThere) {
  for (const Camera& camera : {kBrown, kRational, kFisheye})
    for (const LensModel lens : {LensModel::kPinhole, LensModel::kBrownConrady, LensModel::kFisheye}) {
      const NearestCamera found = Nearest(camera, lens);
      EXPECT_LE(found.rms_px, found.max_px);
      if (std::isinf(found.max_px)) continue;
      EXPECT_NEAR(LargestDistance(camera, found.camera), found.max_px, 0.01 * found.max_px + 1e-11)
          << static_cast<int>(lens);
    }
}

// No parameter by itself can be moved to lessen the sum of squares.
TEST(NearestCamera, IsAMinimum) {
  for (const Camera& camera : {kBrown, kRational, kFisheye})
    for (const LensModel lens : {LensModel::kPinhole, LensModel::kFisheye, LensModel::kBrownConrady}) {
      const auto free = AllParametersOf(lens);
      const NearestCamera found = FindNearestCamera(camera, lens, free);
      if (found.max_px == 0 || std::isinf(found.max_px)) continue;
      const auto rms = [&](const Camera& other) {
        double squares = 0;
        for (int row = 0; row <= 40; ++row)
          for (int column = 0; column <= 40; ++column) {
            const Eigen::Vector2d pixel(column * 1279 / 40.0, row * 959 / 40.0);
            squares += (ProjectNormalised(other, Unproject(camera, pixel).value()) - pixel).squaredNorm();
          }
        return std::sqrt(squares / (41 * 41));
      };
      EXPECT_NEAR(rms(found.camera), found.rms_px, 1e-9);
      for (int i = 0; i < kCameraParameterCount; ++i)
        for (const double step : {-1e-3, 1e-3}) {
          if (!free[static_cast<size_t>(i)]) continue;
          const CameraParameters moved = ParametersOf(found.camera) + step * CameraParameters::Unit(i);
          EXPECT_GT(rms(WithParameters(found.camera, moved)), found.rms_px) << "parameter " << i;
        }
    }
}

// tan(theta) = theta + theta^3 / 3 + 2 theta^5 / 15 + 17 theta^7 / 315 + 62 theta^9 / 2835 + ...
TEST(NearestCamera, FisheyeOfAPinholeHasTheTangentsSeriesForSmallAngles) {
  Camera narrow = kPinhole;
  narrow.fx_px = narrow.fy_px = 2500;
  auto free = AllParametersOf(LensModel::kFisheye);
  for (size_t i = 0; i < 4; ++i) free.reset(i);
  const NearestCamera found = FindNearestCamera(narrow, LensModel::kFisheye, free);
  EXPECT_LT(found.max_px, 1e-5);
  EXPECT_NEAR(found.camera.distortion[0], 1 / 3.0, 1e-5);
  EXPECT_NEAR(found.camera.distortion[1], 2 / 15.0, 1e-3);
  EXPECT_EQ(ParametersOf(found.camera).head<4>(), ParametersOf(narrow).head<4>());
}

TEST(NearestCamera, HoldsWhatIsNotFree) {
  std::bitset<kCameraParameterCount> first_coefficient;
  first_coefficient.set(4);
  const NearestCamera found = FindNearestCamera(kBrown, LensModel::kBrownConrady, first_coefficient);
  EXPECT_EQ(ParametersOf(found.camera).head<4>(), ParametersOf(kBrown).head<4>());
  EXPECT_EQ(found.camera.distortion.tail<7>(), Distortion::Zero().tail<7>());
  EXPECT_NE(found.camera.distortion[0], 0);
  EXPECT_GT(found.max_px, 0);
}

TEST(NearestCamera, NeedsAnImage) {
  Camera without = kBrown;
  without.width_px = 0;
  EXPECT_THROW(Nearest(without, LensModel::kPinhole), std::invalid_argument);
}

}  // namespace
}  // namespace legible
