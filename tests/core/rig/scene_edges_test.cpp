// Edges in the simulated camera's images against the outlines that they are images of.
#include <gtest/gtest.h>

#include <numbers>

#include "core/vision/leg_edges.h"
#include "tests/core/rig/edge_places.h"
#include "tests/core/rig/rig_scene.h"

namespace legible {
namespace {

constexpr int kReach_px = 6;
constexpr size_t kLeastCrossings = 100;

double MeanError(const std::vector<EdgeCrossing>& crossings, size_t from, size_t to) {
  double sum = 0;
  for (size_t i = from; i < to; ++i) sum += crossings[i].error_px;
  return sum / static_cast<double>(to - from);
}

// Mean errors of edges, and of short stretches of them.
struct EdgeErrors {
  std::vector<double> of_edges_px, of_stretches_px;

  void Add(const std::vector<EdgeCrossing>& crossings) {
    constexpr size_t kStretch = 30;
    if (crossings.size() < kLeastCrossings) return;
    of_edges_px.push_back(MeanError(crossings, 0, crossings.size()));
    for (size_t start = 0; start + kStretch <= crossings.size(); start += kStretch)
      of_stretches_px.push_back(MeanError(crossings, start, start + kStretch));
  }
};

double Largest(const std::vector<double>& numbers) {
  double largest = 0;
  for (const double number : numbers) largest = std::max(largest, std::abs(number));
  return largest;
}

double Mean(const std::vector<double>& numbers) {
  double sum = 0;
  for (const double number : numbers) sum += number;
  return sum / static_cast<double>(numbers.size());
}

double Rms(const std::vector<double>& numbers) {
  double squares = 0;
  for (const double number : numbers) squares += number * number;
  return std::sqrt(squares / static_cast<double>(numbers.size()));
}

void AddEdges(const SimulationTruth& truth, const Rigid3& base_from_platform, EdgeErrors& errors) {
  const SceneOptions options = EvenScene();
  const SceneCamera camera(truth, options, 1);
  const BrightnessImage image = camera.TakeNoiseless(base_from_platform, {});
  const EdgePlaces places(image, truth.camera, options.leg_grey, options.ground_grey, kReach_px);
  for (const auto& of_leg : PredictEdges(LegsOf(truth, base_from_platform), truth.camera, {}))
    for (const PredictedEdge& edge : of_leg) errors.Add(places.Of(edge));
}

void ExpectWithinAHundredth(const EdgeErrors& errors, size_t least_edges) {
  EXPECT_GE(errors.of_edges_px.size(), least_edges);
  EXPECT_LT(std::abs(Mean(errors.of_edges_px)), 0.002);
  EXPECT_LT(Rms(errors.of_edges_px), 0.005);
  EXPECT_LT(Largest(errors.of_edges_px), 0.01);
  EXPECT_LT(Largest(errors.of_stretches_px), 0.025);
  std::printf(
      "%zu edges: mean %.5f, rms %.5f, largest %.5f px; stretches of 30 px: rms %.4f, largest %.4f px\n",
      errors.of_edges_px.size(), Mean(errors.of_edges_px), Rms(errors.of_edges_px),
      Largest(errors.of_edges_px), Rms(errors.of_stretches_px), Largest(errors.of_stretches_px));
}

TEST(SceneEdges, LieWithinAHundredthOfAPixelOfTheOutlineThroughTheLensInEveryDirection) {
  std::mt19937_64 generator = TestGenerator();
  EdgeErrors errors;
  for (int draw = 0; draw < 6; ++draw) {
    SimulationTruth truth = DesktopTruth(HalfCamera(true));
    truth.robot = DesktopHexapod(generator, 0.002);
    truth.camera_from_base =
        Rolled(truth.camera_from_base, Uniform(generator, -std::numbers::pi, std::numbers::pi));
    AddEdges(truth, RandomPose(generator), errors);
  }
  ExpectWithinAHundredth(errors, 30);
}

// There the places that an edge takes within its pixels change only slowly along it.
TEST(SceneEdges, LieThereAlsoWhereTheyAreAlongTheRowsOrColumns) {
  std::mt19937_64 generator = TestGenerator();
  EdgeErrors errors;
  for (const double angle_rad : {0.0, 0.5 * std::numbers::pi})
    for (const double off_rad : {0.0, 0.004}) {
      SimulationTruth truth = DesktopTruth(HalfCamera(false));
      const Rigid3 pose = RandomPose(generator);
      const PredictedEdge edge = PredictEdges(LegsOf(truth, pose), truth.camera, {})[0][0];
      const Eigen::Vector2d normal = edge.points[edge.points.size() / 2].normal_px;
      truth.camera_from_base =
          Rolled(truth.camera_from_base, angle_rad + off_rad - std::atan2(normal.y(), normal.x()));
      AddEdges(truth, pose, errors);
    }
  ExpectWithinAHundredth(errors, 20);
}

TEST(SceneEdges, BendAsTheLensDistorts) {
  std::mt19937_64 generator = TestGenerator();
  SimulationTruth truth = DesktopTruth(HalfCamera(true));
  truth.camera.distortion.head<4>() << -0.32, 0.12, 0.002, -0.003;
  const Rigid3 pose = RandomPose(generator);
  EdgeErrors errors;
  AddEdges(truth, pose, errors);
  ExpectWithinAHundredth(errors, 6);
  // By far more than that: the straight line through an edge's ends passes its middle at a pixel's distance.
  double largest_bend_px = 0;
  for (const auto& of_leg : PredictEdges(LegsOf(truth, pose), truth.camera, {}))
    for (const PredictedEdge& edge : of_leg) {
      const auto& points = edge.points;
      const Eigen::Vector2d chord = points.back().point_px - points.front().point_px;
      const Eigen::Vector2d sag = points[points.size() / 2].point_px - points.front().point_px;
      largest_bend_px =
          std::max(largest_bend_px, std::abs(chord.x() * sag.y() - chord.y() * sag.x()) / chord.norm());
    }
  EXPECT_GT(largest_bend_px, 1);
}

TEST(SceneEdges, LieThereAlsoThroughAFisheye) {
  std::mt19937_64 generator = TestGenerator();
  EdgeErrors errors;
  for (int draw = 0; draw < 2; ++draw) {
    SimulationTruth truth = DesktopTruth(DesktopFisheye());
    truth.camera_from_base = LookAt({0.52, 0.074, 0.3}, {0, 0, 0.13});
    AddEdges(truth, RandomPose(generator), errors);
  }
  ExpectWithinAHundredth(errors, 10);
}

// The brightness across an edge rises like a Gaussian's integral, smoothed over the pixel: variances add up.
TEST(SceneEdges, AreAsWideAsBlurAndPixelMakeThem) {
  const SimulationTruth truth = DesktopTruth(HalfCamera(true));
  const Rigid3 pose = truth.robot.home;
  for (const double blur_px : {0.0, 0.5, 0.8, 1.3}) {
    SceneOptions options = EvenScene();
    options.blur_px = blur_px;
    const BrightnessImage image = SceneCamera(truth, options, 1).TakeNoiseless(pose, {});
    const EdgePlaces places(image, truth.camera, options.leg_grey, options.ground_grey, kReach_px);
    double variance = 0, count = 0;
    for (const auto& of_leg : PredictEdges(LegsOf(truth, pose), truth.camera, {}))
      for (const PredictedEdge& edge : of_leg)
        for (const EdgeCrossing& crossing : places.Of(edge)) {
          // Taken from differences of neighbours, which are a pixel apart.
          variance += (crossing.variance_px2 - 1.0 / 12) / (1 + crossing.slope * crossing.slope) - 1.0 / 12;
          count += 1;
        }
    EXPECT_NEAR(variance / count, blur_px * blur_px, 0.02 * (0.5 + blur_px * blur_px)) << blur_px;
  }
}

// Distance of an edge's samples from the true outline, px outward.
double MeanOffset(const LegEdge& edge, const PredictedEdge& truth, const Camera& camera) {
  double sum = 0;
  for (const EdgeSample& sample : edge.observation.samples)
    sum += DistanceToEdge(camera, truth.normal, sample.point_px, sample.normal_px).value().distance_px;
  return sum / static_cast<double>(edge.observation.samples.size());
}

TEST(SceneEdges, AreMeasuredOnLegsInTheLightAsOnImagesRenderedElsewhere) {
  std::mt19937_64 generator = TestGenerator();
  const SimulationTruth truth = DesktopTruth(DesktopCamera(true));
  const SceneCamera camera(truth, {}, 1);
  std::vector<double> offsets_px;
  int in_sight = 0, with_contrast = 0;
  for (std::uint64_t frame = 0; frame < 10; ++frame) {
    const Rigid3 pose = RandomPose(generator);
    const LegsInCamera legs = LegsOf(truth, pose);
    const PredictedEdges predicted = PredictEdges(legs, truth.camera, {});
    for (const LegEdge& edge : MeasureLegEdges(camera.Take(pose, {}, frame), legs, truth.camera, {}).edges) {
      in_sight += edge.in_sight ? 1 : 0;
      if (!edge.left_out.empty()) continue;
      with_contrast += edge.contrast > 40 ? 1 : 0;
      offsets_px.push_back(MeanOffset(
          edge, predicted[static_cast<size_t>(edge.leg)][static_cast<size_t>(edge.edge)], truth.camera));
    }
  }
  const double measured = static_cast<double>(offsets_px.size());
  EXPECT_GE(in_sight, 100);
  EXPECT_GE(measured, 0.95 * in_sight);
  EXPECT_GE(with_contrast, 0.9 * measured);
  EXPECT_LT(Rms(offsets_px), 0.03);
  std::printf("%.0f of %d edges in sight measured, rms %.4f px\n", measured, in_sight, Rms(offsets_px));
}

// Seen from all around, from low above the ground to 35 degrees above it.
TEST(SceneEdges, AreHiddenNowhereWherePredictionsSayThatTheyAreInSight) {
  std::mt19937_64 generator = TestGenerator();
  SceneOptions options = EvenScene();
  options.blur_px = 0;
  int points = 0, hidden = 0;
  for (int draw = 0; draw < 12; ++draw) {
    SimulationTruth truth = DesktopTruth(HalfCamera(true));
    const double azimuth_rad = Uniform(generator, -std::numbers::pi, std::numbers::pi);
    truth.camera_from_base =
        LookAt({std::cos(azimuth_rad), std::sin(azimuth_rad), 0.02 + 0.075 * draw}, {0, 0, 0.15});
    const Rigid3 pose = RandomPose(generator);
    const BrightnessImage image = SceneCamera(truth, options, 1).TakeNoiseless(pose, {});
    for (const auto& of_leg : PredictEdges(LegsOf(truth, pose), truth.camera, {}))
      for (const PredictedEdge& edge : of_leg)
        for (const PredictedEdgePoint& point : edge.points) {
          if (point.obstacle != EdgeObstacle::kNone) continue;
          const Eigen::Vector2d inside = point.point_px - 1.5 * point.normal_px;
          const float grey = image.Row(static_cast<int>(std::lround(inside.y())))[std::lround(inside.x())];
          ++points;
          hidden += std::abs(grey - options.leg_grey) > 1 ? 1 : 0;
        }
  }
  EXPECT_GT(points, 2000);
  EXPECT_EQ(hidden, 0);
}

TEST(SceneEdges, OfACoveredLegAreNotFound) {
  std::mt19937_64 generator = TestGenerator();
  const SimulationTruth truth = DesktopTruth(DesktopCamera(true));
  const SceneCamera camera(truth, {}, 1);
  const Rigid3 pose = RandomPose(generator);
  const LegsInCamera legs = LegsOf(truth, pose);
  for (int covered = 0; covered < kLegCount; ++covered) {
    int measured = 0;
    for (const LegEdge& edge :
         MeasureLegEdges(camera.Take(pose, {covered}, 3), legs, truth.camera, {}).edges) {
      measured += edge.left_out.empty() ? 1 : 0;
      if (edge.leg == covered) {
        EXPECT_NE(edge.left_out, "") << covered + 1;
      }
    }
    EXPECT_GE(measured, 5) << covered + 1;
  }
}

}  // namespace
}  // namespace legible
