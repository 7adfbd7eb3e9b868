#include "core/rig/scene_camera.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <stdexcept>

#include "core/vision/predicted_legs.h"
#include "tests/core/rig/rig_scene.h"

namespace legible {
namespace {

constexpr double kRoundingVariance = 1.0 / 12;

struct Moments {
  double mean = 0, variance = 0;
};
template <typename NumberAt>
Moments MomentsOf(size_t count, const NumberAt& at) {
  double sum = 0, squares = 0;
  for (size_t i = 0; i < count; ++i) {
    sum += at(i);
    squares += at(i) * at(i);
  }
  const double mean = sum / static_cast<double>(count);
  return {mean, squares / static_cast<double>(count) - mean * mean};
}

// Between pixels.
double GreyAt(const BrightnessImage& image, const Eigen::Vector2d& place) {
  const int x = static_cast<int>(std::floor(place.x())), y = static_cast<int>(std::floor(place.y()));
  const double right = place.x() - x, down = place.y() - y;
  return (1 - down) * ((1 - right) * image.Row(y)[x] + right * image.Row(y)[x + 1]) +
         down * ((1 - right) * image.Row(y + 1)[x] + right * image.Row(y + 1)[x + 1]);
}

TEST(SceneCamera, TakesTheSameImageAgainWithAnyNumberOfThreads) {
  const SimulationTruth truth = DesktopTruth(HalfCamera(true));
  const SceneCamera camera(truth, {}, 5);
  const GrayImage image = camera.Take(truth.robot.home, {2}, 7);
  EXPECT_EQ(camera.Take(truth.robot.home, {2}, 7).pixels, image.pixels);
  tbb::task_arena one_thread(1);
  one_thread.execute(
      [&] { EXPECT_EQ(SceneCamera(truth, {}, 5).Take(truth.robot.home, {2}, 7).pixels, image.pixels); });
  EXPECT_NE(camera.Take(truth.robot.home, {2}, 8).pixels, image.pixels);
  EXPECT_NE(SceneCamera(truth, {}, 6).Take(truth.robot.home, {2}, 7).pixels, image.pixels);
}

TEST(SceneCamera, NoiseIsWhatWasAskedForAndNewInEveryFrame) {
  const SimulationTruth truth = DesktopTruth(HalfCamera(true));
  for (const double sigma : {0.0, 2.0, 5.0}) {
    SceneOptions options;
    options.noise_grey = sigma;
    const SceneCamera camera(truth, options, 5);
    const BrightnessImage clean = camera.TakeNoiseless(truth.robot.home, {});
    const GrayImage a = camera.Take(truth.robot.home, {}, 1), b = camera.Take(truth.robot.home, {}, 2);
    const size_t count = clean.grey.size();
    const Moments noise = MomentsOf(count, [&](size_t i) { return a.pixels[i] - double{clean.grey[i]}; });
    const Moments change = MomentsOf(count, [&](size_t i) { return double(a.pixels[i]) - b.pixels[i]; });
    const double variance = sigma * sigma + kRoundingVariance;
    // The standard error of the mean is 0.01, that of a variance its own times 0.0026.
    EXPECT_NEAR(noise.mean, 0, 0.05) << sigma;
    EXPECT_NEAR(noise.variance, variance, 0.02 * variance + 0.01) << sigma;
    if (sigma > 0) {
      EXPECT_NEAR(change.variance, 2 * variance, 0.04 * variance) << sigma;
    }
  }
}

TEST(SceneCamera, NoiseIsNormalAndWhite) {
  const BrightnessImage grey{512, 512, std::vector<float>(512 * 512, 100.0F)};
  const GrayImage image = PixelNoise(10, 3).Expose(grey, 4);
  const size_t count = image.pixels.size() - 512;
  const auto at = [&](size_t i) { return image.pixels[i] - 100.0; };
  double fourth = 0, with_right = 0, with_below = 0;
  for (size_t i = 0; i < count; ++i) {
    fourth += std::pow(at(i), 4) / static_cast<double>(count);
    with_right += at(i) * at(i + 1) / static_cast<double>(count);
    with_below += at(i) * at(i + 512) / static_cast<double>(count);
  }
  EXPECT_NEAR(fourth / 1e4, 3, 0.1);
  EXPECT_NEAR(with_right / 100, 0, 0.01);
  EXPECT_NEAR(with_below / 100, 0, 0.01);
}

// A sight line to a leg's axis meets the leg where its normal is the line's own part across the axis.
TEST(SceneCamera, LegsAreAsBrightAsLambertSays) {
  SimulationTruth truth = DesktopTruth(HalfCamera(true));
  SceneOptions options;
  options.blur_px = 0;
  const Eigen::Vector3d camera_in_base = Inverse(truth.camera_from_base).translation;
  // What is seen is hardly in shadow.
  options.light_in_camera = truth.camera_from_base.rotation * (camera_in_base + Eigen::Vector3d(0, 0.1, 0.1));
  const Eigen::Vector3d towards_light = options.light_in_camera.normalized();
  const BrightnessImage image = SceneCamera(truth, options, 1).TakeNoiseless(truth.robot.home, {});
  const LegsInCamera legs = LegsOf(truth, truth.robot.home);
  for (const size_t front : {0, 1})  // nothing stands before them
    for (const double share : {0.3, 0.5, 0.7}) {
      const LegInCamera& leg = legs[front];
      const Eigen::Vector3d axis = (leg.b_in_camera - leg.a_in_camera).normalized();
      const Eigen::Vector3d sight = leg.AxisPoint(share);
      const Eigen::Vector3d normal = -(sight - sight.dot(axis) * axis).normalized();
      const double share_of_light =
          options.ambient + (1 - options.ambient) * std::max(0.0, normal.dot(towards_light));
      EXPECT_NEAR(GreyAt(image, Project(truth.camera, sight)), options.leg_grey * share_of_light, 0.5);
    }
}

TEST(SceneCamera, ThePlatformCastsItsShadowOnTheGround) {
  const SimulationTruth truth = DesktopTruth(HalfCamera(true));
  SceneOptions options;
  options.texture_grey = 0;
  // The base plate's lower side, on which the robot stands: 8 mm and 20 mm below the joints.
  const Eigen::Vector3d in_shadow(0.15, 0.42, -0.028), in_light(0.35, 0.35, -0.028);
  const Eigen::Vector3d light_in_base = truth.robot.home.translation - in_shadow;
  options.light_in_camera = truth.camera_from_base.rotation * light_in_base;
  const BrightnessImage image = SceneCamera(truth, options, 1).TakeNoiseless(truth.robot.home, {});
  const auto grey_of = [&](const Eigen::Vector3d& x) {
    return GreyAt(image, Project(truth.camera, truth.camera_from_base * x));
  };
  const double cosine = light_in_base.normalized().z();
  EXPECT_NEAR(grey_of(in_shadow), options.ground_grey * options.ambient, 0.1);
  EXPECT_NEAR(grey_of(in_light), options.ground_grey * (options.ambient + (1 - options.ambient) * cosine),
              0.1);
}

// Where the image of the lens ends, short of the sensor's corners.
TEST(SceneCamera, ShowsTheGroundsGreyWhereTheLensHasNoImage) {
  SimulationTruth truth = DesktopTruth(HalfCamera(false));
  truth.camera.distortion[0] = -1.0;
  ASSERT_FALSE(Unproject(truth.camera, {5, 5}).has_value());
  const SceneOptions options;
  const BrightnessImage image = SceneCamera(truth, options, 1).TakeNoiseless(truth.robot.home, {});
  EXPECT_EQ(image.Row(1)[1], static_cast<float>(options.ground_grey));
  for (const float grey : image.grey) ASSERT_TRUE(grey >= 0 && grey <= 255);
}

TEST(SceneCamera, RefusesWhatCannotBe) {
  const SimulationTruth truth = DesktopTruth(HalfCamera(true));
  const auto make = [&](auto change) {
    SceneOptions options;
    change(options);
    SceneCamera(truth, options, 1);
  };
  EXPECT_THROW(make([](SceneOptions& o) { o.blur_px = -1; }), std::invalid_argument);
  EXPECT_THROW(make([](SceneOptions& o) { o.noise_grey = -1; }), std::invalid_argument);
  EXPECT_THROW(make([](SceneOptions& o) { o.ambient = 1.1; }), std::invalid_argument);
  EXPECT_THROW(make([](SceneOptions& o) { o.light_in_camera.setZero(); }), std::invalid_argument);
  const SceneCamera camera(truth, {}, 1);
  EXPECT_THROW(camera.TakeNoiseless(truth.robot.home, {6}), std::invalid_argument);
}

}  // namespace
}  // namespace legible
