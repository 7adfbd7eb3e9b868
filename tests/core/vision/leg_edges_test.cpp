#include "core/vision/leg_edges.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <random>
#include <stdexcept>

#include "core/geometry/edge_distance.h"
#include "tests/core/vision/scene.h"
#include "tests/testing/random.h"
#include "tests/testing/render_legs.h"

namespace legible {
namespace {

constexpr double kNoise = 2;  // grey levels

Eigen::Vector3d TrueNormal(const LegsInCamera& legs, const LegEdge& edge) {
  const LegInCamera& leg = legs[static_cast<size_t>(edge.leg)];
  return CylinderOutline(LineThrough<double>(leg.a_in_camera, leg.b_in_camera),
                         leg.radius_m)[static_cast<size_t>(edge.edge)];
}

// Distances of an edge's samples from the true outline: their mean, and the largest.
struct SampleErrors {
  double mean_px = 0, largest_px = 0;
};
SampleErrors ErrorsOf(const LegEdge& edge, const LegsInCamera& legs, const Camera& camera) {
  SampleErrors errors;
  const double count = static_cast<double>(edge.observation.samples.size());
  for (const EdgeSample& sample : edge.observation.samples) {
    const auto distance = DistanceToEdge(camera, TrueNormal(legs, edge), sample.point_px, sample.normal_px);
    errors.mean_px += distance.value().distance_px / count;
    errors.largest_px = std::max(errors.largest_px, std::abs(distance->distance_px));
  }
  return errors;
}

// The longest run of points of an edge that can be seen, px.
double LongestVisible(const PredictedEdge& edge) {
  double longest = 0, run = 0;
  for (size_t i = 1; i < edge.points.size(); ++i) {
    const bool visible =
        edge.points[i - 1].obstacle == EdgeObstacle::kNone && edge.points[i].obstacle == EdgeObstacle::kNone;
    run = visible ? run + (edge.points[i].point_px - edge.points[i - 1].point_px).norm() : 0;
    longest = std::max(longest, run);
  }
  return longest;
}

LegEdgeOptions WithoutLock() {
  LegEdgeOptions options;
  options.lock.reset();
  return options;
}

// All edges of which 150 px can be seen are measured, and what is measured is right.
void ExpectEdgesRight(const LegEdges& found, const Scene& scene, double mean_px) {
  const LegsInCamera legs = scene.Legs();
  const PredictedEdges predicted = PredictEdges(legs, scene.camera, {});
  ASSERT_EQ(found.edges.size(), 12);
  for (const LegEdge& edge : found.edges) {
    SCOPED_TRACE("leg " + std::to_string(edge.leg + 1) + " edge " + std::to_string(edge.edge + 1));
    if (!edge.left_out.empty()) {
      EXPECT_LT(LongestVisible(predicted[static_cast<size_t>(edge.leg)][static_cast<size_t>(edge.edge)]), 150)
          << edge.left_out;
      continue;
    }
    const SampleErrors errors = ErrorsOf(edge, legs, scene.camera);
    EXPECT_LT(std::abs(errors.mean_px), mean_px);
    EXPECT_GE(edge.observation.samples.size(), 3);
  }
}

int MeasuredCount(const LegEdges& edges) {
  return static_cast<int>(std::count_if(edges.edges.begin(), edges.edges.end(),
                                        [](const LegEdge& edge) { return edge.left_out.empty(); }));
}

class LegEdgesThroughLens : public testing::TestWithParam<bool> {};

TEST_P(LegEdgesThroughLens, BothEdgesAreFoundWithinTwoHundredthsFromTwoPixelsAway) {
  std::mt19937_64 generator = TestGenerator();
  const Scene scene(GetParam());
  const GrayImage image = WithNoise(RenderLegs(scene.Legs(), scene.camera, {}), kNoise, generator);
  Vector6d displacement;
  displacement << 0.0012, -0.001, 0.001, 0, 0, 0;
  const LegEdges found =
      MeasureLegEdges(image, scene.LegsDisplaced(displacement), scene.camera, WithoutLock());
  EXPECT_GE(MeasuredCount(found), 8);
  ExpectEdgesRight(found, scene, 0.02);
  EXPECT_NEAR(found.blur_px, 0.8, 0.1);
  EXPECT_NEAR(found.grey_noise, kNoise, 0.3);
}

TEST_P(LegEdgesThroughLens, LocksOnFromFortyPixelsAway) {
  std::mt19937_64 generator = TestGenerator();
  const Scene scene(GetParam());
  const GrayImage image = WithNoise(RenderLegs(scene.Legs(), scene.camera, {}), kNoise, generator);
  Vector6d displacement;
  displacement << 0.025, -0.018, 0.02, 0.02, 0.03, 0.03;
  const LegEdges found = MeasureLegEdges(image, scene.LegsDisplaced(displacement), scene.camera, {});
  EXPECT_GE(MeasuredCount(found), 6);
  for (const LegEdge& edge : found.edges)
    if (edge.left_out.empty()) {
      EXPECT_LT(std::abs(ErrorsOf(edge, scene.Legs(), scene.camera).mean_px), 0.1)
          << "leg " << edge.leg + 1 << " edge " << edge.edge + 1;
    }
}

// From the side, and from behind, which leaves a bright rim whose inner side is an edge as well.
TEST_P(LegEdgesThroughLens, ShadingMovesTheEdgesOfMattLegsByLessThanATenth) {
  std::mt19937_64 generator = TestGenerator();
  const Scene scene(GetParam());
  for (const LambertLight& light : {LambertLight{40, 170, Eigen::Vector3d(-0.5, -0.5, -0.7).normalized()},
                                    LambertLight{30, 170, Eigen::Vector3d(-0.9, -0.3, 0.3).normalized()}}) {
    RenderOptions options;
    options.background = 10;
    options.light = light;
    const CleanImage clean = RenderLegs(scene.Legs(), scene.camera, options);
    for (int draw = 0; draw < 4; ++draw) {
      Vector6d displacement;
      displacement << 0.001 * UniformVector(generator, -1, 1), 0.003 * UniformVector(generator, -1, 1);
      const LegEdges found = MeasureLegEdges(WithNoise(clean, kNoise, generator),
                                             scene.LegsDisplaced(displacement), scene.camera, WithoutLock());
      EXPECT_GE(MeasuredCount(found), 7);
      for (const LegEdge& edge : found.edges) {
        if (!edge.left_out.empty()) continue;
        EXPECT_LT(std::abs(ErrorsOf(edge, scene.Legs(), scene.camera).mean_px), 0.1)
            << "leg " << edge.leg + 1 << " edge " << edge.edge + 1;
      }
    }
  }
}

// Light from behind leaves a bright rim at some edges, whose inner side is an edge as well.
TEST_P(LegEdgesThroughLens, TheirPlacesDoNotDependOnWhereTheyWerePredicted) {
  std::mt19937_64 generator = TestGenerator();
  const Scene scene(GetParam());
  RenderOptions options;
  options.background = 10;
  options.light = LambertLight{30, 170, Eigen::Vector3d(-0.9, -0.3, 0.3).normalized()};
  const GrayImage image = WithNoise(RenderLegs(scene.Legs(), scene.camera, options), kNoise, generator);
  const LegEdges from_truth = MeasureLegEdges(image, scene.Legs(), scene.camera, WithoutLock());
  int compared = 0;
  for (int draw = 0; draw < 6; ++draw) {
    Vector6d displacement;
    displacement << 0.001 * UniformVector(generator, -1, 1), 0.003 * UniformVector(generator, -1, 1);
    const LegEdges found =
        MeasureLegEdges(image, scene.LegsDisplaced(displacement), scene.camera, WithoutLock());
    for (size_t i = 0; i < found.edges.size(); ++i) {
      if (!found.edges[i].left_out.empty() || !from_truth.edges[i].left_out.empty()) continue;
      SCOPED_TRACE("leg " + std::to_string(i / 2 + 1) + " edge " + std::to_string(i % 2 + 1));
      const double sigma_px = from_truth.edges[i].observation.common_sigma_px;
      for (const EdgeSample& sample : found.edges[i].observation.samples) {
        const auto off =
            DistanceToEdge(scene.camera, from_truth.edges[i].normal, sample.point_px, sample.normal_px);
        EXPECT_LT(std::abs(off.value().distance_px), std::max(3 * sigma_px, 0.05));
        ++compared;
      }
    }
  }
  EXPECT_GE(compared, 150);
}

std::string NameOfLens(const testing::TestParamInfo<bool>& is_distorted) {
  return is_distorted.param ? "Distorted" : "Pinhole";
}

INSTANTIATE_TEST_SUITE_P(Lenses, LegEdgesThroughLens, testing::Values(false, true), NameOfLens);

TEST(LegEdges, ShareTheBlurOfTheirImage) {
  std::mt19937_64 generator = TestGenerator();
  const Scene scene(true);
  for (const double blur_px : {0.5, 0.8, 1.5, 2.5}) {
    RenderOptions options;
    options.blur_px = blur_px;
    const GrayImage image = WithNoise(RenderLegs(scene.Legs(), scene.camera, options), kNoise, generator);
    const LegEdges found = MeasureLegEdges(image, scene.Legs(), scene.camera, WithoutLock());
    EXPECT_NEAR(found.blur_px / blur_px, 1, 0.05) << blur_px;
    EXPECT_GE(MeasuredCount(found), 6) << blur_px;
  }
}

TEST(LegEdges, AMissingLegIsLeftOutWithAReason) {
  std::mt19937_64 generator = TestGenerator();
  const Scene scene(true);
  for (size_t missing = 0; missing < kLegCount; ++missing) {
    LegsInCamera rendered = scene.Legs();
    rendered[missing] = {{5, 5, 1}, {5, 5.1, 1}, 0.01};
    const GrayImage image = WithNoise(RenderLegs(rendered, scene.camera, {}), kNoise, generator);
    const LegEdges found = MeasureLegEdges(image, scene.Legs(), scene.camera, WithoutLock());
    for (size_t edge = 0; edge < 2; ++edge)
      EXPECT_NE(found.edges[2 * missing + edge].left_out, "") << missing + 1;
  }
}

// The image above a row, and another one from it on.
GrayImage Joined(const GrayImage& above, const GrayImage& below, int row) {
  GrayImage joined = above;
  const auto start = static_cast<std::ptrdiff_t>(row) * above.width;
  std::copy(below.pixels.begin() + start, below.pixels.end(), joined.pixels.begin() + start);
  return joined;
}

// Legs bent in the middle.
TEST(LegEdges, AreNoMoreCertainThanTheirStretchesLieOnOneLine) {
  std::mt19937_64 generator = TestGenerator();
  const Scene scene(false);
  RenderOptions render;
  render.leg = render.background + 30;  // little contrast: the samples are not certain enough to stand out
  LegsInCamera bent = scene.Legs();
  for (LegInCamera& leg : bent) {
    leg.a_in_camera.x() += 0.003;
    leg.b_in_camera.x() -= 0.003;
  }
  const GrayImage above = WithNoise(RenderLegs(scene.Legs(), scene.camera, render), kNoise, generator);
  const GrayImage below = WithNoise(RenderLegs(bent, scene.camera, render), kNoise, generator);
  const auto middle_px = Project(scene.camera, scene.Legs()[0].AxisPoint(0.5));
  LegEdgeOptions options = WithoutLock();
  options.largest_common_sigma_px = 1;
  const LegEdges found = MeasureLegEdges(Joined(above, below, static_cast<int>(middle_px.y())), scene.Legs(),
                                         scene.camera, options);
  double largest_px = 0;
  for (const LegEdge& edge : found.edges) {
    if (!edge.left_out.empty()) continue;
    EXPECT_GE(edge.observation.common_sigma_px, edge.rms_px);
    largest_px = std::max(largest_px, edge.rms_px);
  }
  EXPECT_GT(largest_px, 0.05);
}

TEST(LegEdges, ALegThatSomethingCoversIsMeasuredRightOrNotAtAll) {
  std::mt19937_64 generator = TestGenerator();
  const Scene scene(true);
  const LegsInCamera legs = scene.Legs();
  const CleanImage clean = RenderLegs(legs, scene.camera, {});
  for (size_t covered = 0; covered < kLegCount; ++covered) {
    CleanImage image = clean;
    const Eigen::Vector2d middle = Project(scene.camera, legs[covered].AxisPoint(0.5));
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        if ((Eigen::Vector2d(x, y) - middle).cwiseAbs().maxCoeff() < 70)
          image.grey[static_cast<size_t>(y * image.width + x)] = 120;
    const LegEdges found =
        MeasureLegEdges(WithNoise(image, kNoise, generator), legs, scene.camera, WithoutLock());
    EXPECT_GE(MeasuredCount(found), 6) << covered + 1;
    for (const LegEdge& edge : found.edges)
      if (edge.left_out.empty()) {
        EXPECT_LT(ErrorsOf(edge, legs, scene.camera).largest_px, 0.1)
            << "leg " << edge.leg + 1 << " edge " << edge.edge + 1 << " with leg " << covered + 1
            << " covered";
      }
  }
}

// Squared errors of normals about their mean, in sigmas of the mean covariance, over their expectation.
double SquaredErrorRatio(const std::vector<LegEdge>& draws) {
  const double count = static_cast<double>(draws.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const LegEdge& draw : draws) {
    mean += draw.normal / count;
    covariance += draw.normal_covariance / count;
  }
  // The covariance has rank 2: compared in the plane across the normal.
  Eigen::Matrix<double, 3, 2> across;
  across.col(0) = mean.unitOrthogonal();
  across.col(1) = mean.normalized().cross(across.col(0));
  const Eigen::Matrix2d inverse = (across.transpose() * covariance * across).inverse();
  double squares = 0;
  for (const LegEdge& draw : draws) {
    const Eigen::Vector2d error = across.transpose() * (draw.normal - mean);
    squares += error.dot(inverse * error);
  }
  return squares / (2 * (count - 1));
}

TEST(LegEdges, NormalCovarianceIsTheScatterOverTheNoise) {
  constexpr int kDraws = 100;
  std::mt19937_64 generator = TestGenerator();
  const Scene scene(true);
  RenderOptions render;
  render.leg = 120;  // so little contrast and so much noise that the noise rules each sample's sigma
  const CleanImage clean = RenderLegs(scene.Legs(), scene.camera, render);
  LegEdgeOptions options = WithoutLock();
  options.blur_px = render.blur_px;
  options.largest_common_sigma_px = 1;
  std::array<std::vector<LegEdge>, 12> draws;
  for (int draw = 0; draw < kDraws; ++draw) {
    const LegEdges found =
        MeasureLegEdges(WithNoise(clean, 8, generator), scene.Legs(), scene.camera, options);
    for (size_t i = 0; i < draws.size(); ++i)
      if (found.edges[i].left_out.empty()) draws[i].push_back(found.edges[i]);
  }
  double ratio = 0, edges = 0;
  for (const std::vector<LegEdge>& of_edge : draws) {
    if (of_edge.size() < 0.9 * kDraws) continue;
    ratio += SquaredErrorRatio(of_edge);
    ++edges;
  }
  EXPECT_GE(edges, 6);
  EXPECT_GT(std::sqrt(ratio / edges), 0.7);
  EXPECT_LT(std::sqrt(ratio / edges), 1.4);
}

TEST(LegEdges, OnlyMeasuredOnesBecomeObservations) {
  std::mt19937_64 generator = TestGenerator();
  const Scene scene(false);
  const GrayImage image = WithNoise(RenderLegs(scene.Legs(), scene.camera, {}), kNoise, generator);
  LegEdges found = MeasureLegEdges(image, scene.Legs(), scene.camera, WithoutLock());
  found.edges[0].left_out = "covered";
  const ImageObservation observation = ToObservation("7", Vector6d::Ones().eval(), found);
  EXPECT_EQ(observation.name, "7");
  EXPECT_EQ(static_cast<int>(observation.edges.size()), MeasuredCount(found));
  for (const EdgeObservation& edge : observation.edges) EXPECT_FALSE(edge.leg == 0 && edge.edge == 0);
}

TEST(LegEdges, AnEmptyImageHasNone) {
  const Scene scene(false);
  const GrayImage image{
      scene.camera.width_px, scene.camera.height_px,
      std::vector<std::uint8_t>(static_cast<size_t>(scene.camera.width_px * scene.camera.height_px), 90)};
  for (const LegEdgeOptions& options : {LegEdgeOptions{}, WithoutLock()}) {
    const LegEdges found = MeasureLegEdges(image, scene.Legs(), scene.camera, options);
    EXPECT_EQ(MeasuredCount(found), 0);
    EXPECT_EQ(found.blur_px, 0);
  }
}

TEST(LegEdgeOptions, RejectLengthsThatAreNotPositive) {
  for (double LegEdgeOptions::*length :
       {&LegEdgeOptions::search_px, &LegEdgeOptions::least_length_px, &LegEdgeOptions::sample_length_px}) {
    LegEdgeOptions options;
    options.*length = 0;
    EXPECT_THROW(options.Check(), std::invalid_argument);
  }
}

}  // namespace
}  // namespace legible
