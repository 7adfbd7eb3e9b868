#include "core/vision/edge_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "tests/testing/random.h"

namespace legible {
namespace {

constexpr double kBin_px = 0.125;
constexpr double kPixelVariance = 1.0 / 12;

double NormalDistribution(double z) { return std::erfc(-z / std::numbers::sqrt2) / 2; }

// The profile of bins whose mean brightness is given, each of `count` pixels with normal grey noise.
EdgeProfile DrawProfile(const std::function<double(double)>& brightness, double count, double grey_noise,
                        std::mt19937_64* generator) {
  std::normal_distribution<double> normal;
  EdgeProfile profile;
  for (double x = -9 + kBin_px / 2; x < 7; x += kBin_px) {
    const double noise = generator != nullptr ? grey_noise / std::sqrt(count) * normal(*generator) : 0;
    profile.push_back({x, brightness(x) + noise, count});
  }
  return profile;
}

// A step from 40 to 160 at place_px through a blur.
std::function<double(double)> Step(double place_px, double blur_px) {
  const double s = std::sqrt(blur_px * blur_px + kPixelVariance);
  return [=](double x) { return 40 + 120 * NormalDistribution((x - place_px) / s); };
}

// What a matt cylinder of half width w_px, its edge at place_px, looks like under a light at light_rad from
// the outline (0: from the side of this edge, pi / 2: from the camera) and light from everywhere, through a
// blur: by fine summation.
std::function<double(double)> MattCylinder(double place_px, double w_px, double light_rad, double blur_px,
                                           double ambient = 60) {
  const double s = std::sqrt(blur_px * blur_px + kPixelVariance);
  return [=](double x) {
    constexpr double kStep_px = 1.0 / 512;
    double sum = 0, weights = 0;
    for (double u = -6 * s; u <= 6 * s; u += kStep_px) {
      const double inside = x - u - place_px;
      const double weight = std::exp(-u * u / (2 * s * s));
      double grey = 40;
      if (inside > 0) {
        const double psi = std::acos(std::max(-1.0, 1 - inside / w_px));
        grey = ambient + (200 - ambient) * std::max(0.0, std::cos(psi - light_rad));
      }
      sum += weight * grey;
      weights += weight;
    }
    return sum / weights;
  };
}

ProfileFitOptions Options(double blur_px, double half_width_px, double grey_noise) {
  return {.blur_px = blur_px,
          .half_width_px = half_width_px,
          .grey_noise = grey_noise,
          .outside_px = 8,
          .inside_px = 6};
}

// Places found, less the truth, over draws of the noise about steps at random places.
struct PlaceStatistics {
  double mean_px = 0, scatter_px = 0, reported_px = 0;
};

template <typename Fit>
PlaceStatistics DrawSteps(std::mt19937_64& generator, double blur_px, int draws, const Fit& fit) {
  PlaceStatistics statistics;
  double squares = 0, reported = 0;
  for (int i = 0; i < draws; ++i) {
    const double place_px = Uniform(generator, -0.4, 0.4);
    const EdgeProfile profile = DrawProfile(Step(place_px, blur_px), 400 * kBin_px, 2, &generator);
    const std::optional<ProfileFit> found = fit(profile);
    EXPECT_TRUE(found);
    const double error = found.value().place_px - place_px;
    statistics.mean_px += error / draws;
    squares += error * error;
    reported += found->sigma_px * found->sigma_px;
  }
  statistics.scatter_px = std::sqrt(squares / draws);
  statistics.reported_px = std::sqrt(reported / draws);
  return statistics;
}

// Cramér-Rao bound of the place of an edge of 400 px with noise 2 and contrast 120 from a window of 14 px.
// The mean level is unknown: what the edge's derivative (a Gaussian of norm^2 1 / (2 s sqrt(pi))) has in
// common with a constant over the window is lost, a share of 2 s sqrt(pi) / 14 of its information.
double BoundOfStep(double blur_px) {
  const double s = std::sqrt(blur_px * blur_px + kPixelVariance);
  const double width_px = 2 * s * std::sqrt(std::numbers::pi);
  return 2.0 / 120 * std::sqrt(width_px) / std::sqrt(400) / std::sqrt(1 - width_px / 14);
}

TEST(FitProfile, FindsAStepWithoutBiasAndNearTheBound) {
  std::mt19937_64 generator = TestGenerator();
  for (const double blur_px : {0.5, 1.0, 2.0}) {
    const PlaceStatistics found = DrawSteps(generator, blur_px, 400, [&](const EdgeProfile& profile) {
      return FitProfile(profile, ShadingModel::kFlat, 0, Options(blur_px, 12, 2));
    });
    EXPECT_LT(std::abs(found.mean_px), 3 * found.scatter_px / std::sqrt(400)) << blur_px;
    EXPECT_GT(found.scatter_px, 0.9 * BoundOfStep(blur_px)) << blur_px;
    EXPECT_LT(found.scatter_px, 1.1 * BoundOfStep(blur_px)) << blur_px;
    EXPECT_NEAR(found.reported_px / found.scatter_px, 1, 0.12) << blur_px;
  }
}

TEST(FitSimplestModel, StaysNearTheBoundOnAStep) {
  std::mt19937_64 generator = TestGenerator();
  const PlaceStatistics found = DrawSteps(generator, 1, 400, [&](const EdgeProfile& profile) {
    return FitSimplestModel(profile, 0, Options(1, 12, 2));
  });
  EXPECT_LT(found.scatter_px, 1.1 * BoundOfStep(1));
  EXPECT_LT(std::abs(found.mean_px), 3 * found.scatter_px / std::sqrt(400));
}

TEST(FitSimplestModel, TakesTheFlatModelForAStep) {
  std::mt19937_64 generator = TestGenerator();
  int flat = 0;
  for (int i = 0; i < 100; ++i) {
    const auto found = FitSimplestModel(DrawProfile(Step(0.2, 1), 50, 2, &generator), 0, Options(1, 12, 2));
    ASSERT_TRUE(found);
    flat += found->model == ShadingModel::kFlat;
  }
  EXPECT_GE(flat, 98);
}

// Light from the side of the edge, from the camera and from behind on the other side, where the leg's own
// shadow ends 0.83 rad inside the outline.
class MattCylinderUnderLight : public testing::TestWithParam<double> {};

TEST_P(MattCylinderUnderLight, BiasOfTheSimplestModelIsBelowSixHundredthsOfAPixel) {
  for (const double w_px : {10.0, 14.0, 20.0})
    for (const double place_px : {-0.3, 0.0, 0.21}) {
      const EdgeProfile profile = DrawProfile(MattCylinder(place_px, w_px, GetParam(), 0.8), 50, 2, nullptr);
      const auto found = FitSimplestModel(profile, 0, Options(0.8, w_px, 2));
      ASSERT_TRUE(found);
      EXPECT_NEAR(found->place_px, place_px, 0.06) << "half width " << w_px;
    }
}

TEST_P(MattCylinderUnderLight, LittleOrMuchLightFromEverywhereMovesTheEdgeByLessThanATenth) {
  for (const double ambient : {30.0, 90.0}) {
    const EdgeProfile profile = DrawProfile(MattCylinder(0, 14, GetParam(), 0.8, ambient), 50, 2, nullptr);
    const auto found = FitSimplestModel(profile, 0, Options(0.8, 14, 2));
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->place_px, 0, 0.1) << "ambient " << ambient;
  }
}

// Refitted at each blur, from the fit.
double SquaresAt(double blur_px, const EdgeProfile& profile, const ProfileFit& fit) {
  const auto there = Refit(profile, fit, Options(blur_px, 14, 2));
  return there ? there->squares : std::nan("");
}

TEST(EvidenceOnBlur, IsHowTheSquaresOfRefitsFall) {
  for (const ShadingModel model : {ShadingModel::kFlat, ShadingModel::kAngular, ShadingModel::kKinked}) {
    const EdgeProfile profile = DrawProfile(MattCylinder(0.1, 14, 1, 0.8), 50, 2, nullptr);
    const auto first = FitProfile(profile, model, 0, Options(0.74, 14, 2));
    ASSERT_TRUE(first);
    const auto fit = Refit(profile, *first, Options(0.74, 14, 2));
    ASSERT_TRUE(fit);
    const BlurEvidence evidence = EvidenceOnBlur(profile, *fit, Options(0.74, 14, 2));
    const double misfit = std::max(fit->chi2_per_bin, 1.0);
    const double slope = (SquaresAt(0.75, profile, *fit) - SquaresAt(0.73, profile, *fit)) / 0.02;
    EXPECT_NEAR(-2 * evidence.moment * misfit, slope, 0.03 * std::abs(slope)) << static_cast<int>(model);
  }
}

TEST(EvidenceOnBlur, LeadsToTheBlurOfAStep) {
  const EdgeProfile profile = DrawProfile(Step(0.1, 0.8), 50, 2, nullptr);
  double blur_px = 0.65;
  auto fit = FitProfile(profile, ShadingModel::kFlat, 0, Options(blur_px, 14, 2));
  for (int step = 0; step < 4 && fit; ++step) {
    const BlurEvidence evidence = EvidenceOnBlur(profile, *fit, Options(blur_px, 14, 2));
    EXPECT_GT(evidence.information, 0);
    blur_px += evidence.moment / evidence.information;
    fit = Refit(profile, *fit, Options(blur_px, 14, 2));
  }
  EXPECT_NEAR(blur_px, 0.8, 0.005);
}

TEST(PredictParts, AddUpToTheProfile) {
  const double w_px = 14;
  const auto brightness = MattCylinder(0.1, w_px, 1.0, 0.8);
  const auto fit =
      FitProfile(DrawProfile(brightness, 50, 2, nullptr), ShadingModel::kKinked, 0, Options(0.8, w_px, 2));
  ASSERT_TRUE(fit);
  const std::vector<double> places{-5, -0.4, 0.3, 4};
  const auto parts = PredictParts(*fit, places, Options(0.8, w_px, 2));
  for (size_t i = 0; i < places.size(); ++i)
    EXPECT_NEAR(parts[i].background + parts[i].leg, brightness(places[i]), 2) << places[i];
  EXPECT_NEAR(parts.front().leg, 0, 1e-3);
  EXPECT_NEAR(parts.back().background, 0, 1e-3);
}

TEST_P(MattCylinderUnderLight, FlatModelIsFurtherOffThanTheSimplestThatFits) {
  const double w_px = 14;
  const EdgeProfile profile = DrawProfile(MattCylinder(0, w_px, GetParam(), 0.8), 50, 2, nullptr);
  const auto simplest = FitSimplestModel(profile, 0, Options(0.8, w_px, 2));
  const auto flat = FitProfile(profile, ShadingModel::kFlat, 0, Options(0.8, w_px, 2));
  ASSERT_TRUE(simplest && flat);
  EXPECT_NE(simplest->model, ShadingModel::kFlat);
  EXPECT_GT(std::abs(flat->place_px), std::abs(simplest->place_px));
}

INSTANTIATE_TEST_SUITE_P(Lights, MattCylinderUnderLight,
                         testing::Values(0.6, 1.0, std::numbers::pi / 2, 2.4));

TEST(FitProfile, HasNoPlaceWithoutAnEdge) {
  const EdgeProfile far = DrawProfile(Step(6.5, 1), 50, 2, nullptr);
  EXPECT_FALSE(FitProfile(far, ShadingModel::kFlat, 0, Options(1, 12, 2)));
  EXPECT_FALSE(FitProfile({}, ShadingModel::kFlat, 0, Options(1, 12, 2)));
  EXPECT_FALSE(FitSimplestModel({}, 0, Options(1, 12, 2)));
}

}  // namespace
}  // namespace legible
