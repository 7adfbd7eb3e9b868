// Edges followed in the simulated camera's images, against the outlines that they are images of.
#include "core/vision/edge_tracker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "core/geometry/tangents.h"
#include "tests/core/rig/moving_robot.h"

namespace legible {
namespace {

constexpr bool kHalfSize = true;

// A few robots, each seen from its own side, each for so many frames.
FollowingScore FollowRobots(int robots, int frames, double largest_azimuth_rad, bool is_perfect,
                            std::mt19937_64& generator) {
  FollowingScore score;
  for (int i = 0; i < robots; ++i) {
    const auto seed = static_cast<std::uint64_t>(generator() % 100000);
    const RobotAndDrawing robot =
        SeenFrom(DrawRobot(seed, kHalfSize), Uniform(generator, -largest_azimuth_rad, largest_azimuth_rad));
    const Wandering way(robot.truth.robot, 1.5, generator);
    Follower follower(robot, is_perfect ? robot.Perfect() : robot.drawing, seed);
    for (int frame = 0; frame < frames; ++frame) follower.Follow(way.At(Follower::kPeriod_s * frame), score);
  }
  return score;
}

TEST(EdgeTracker, FollowsAllEdgesInSightOfARobotOnTheMove) {
  std::mt19937_64 generator = TestGenerator();
  const FollowingScore score = FollowRobots(4, 40, 0.1, true, generator);
  score.Print("perfect model");
  EXPECT_GE(score.seen, 0.98 * score.in_sight);
  EXPECT_LT(score.FineRms_px(), 0.08);
  EXPECT_LT(score.RoughRms_px(), 0.25);
  EXPECT_EQ(score.wrong, 0);
}

// A drawing 2 mm off, a camera guess 8 px, 3 cm and 0.05 rad off, and without the lens's distortion.
TEST(EdgeTracker, FollowsThemByADrawingAndAGuessedCamera) {
  std::mt19937_64 generator = TestGenerator();
  const FollowingScore score = FollowRobots(6, 30, 0.1, false, generator);
  score.Print("drawing and guessed camera");
  EXPECT_GE(score.seen, 0.95 * score.in_sight);
  EXPECT_LT(score.FineRms_px(), 0.15);  // the guessed camera has no distortion
  EXPECT_LT(score.wrong, 0.002 * score.seen);
}

// From as near as its view is wide.
TEST(EdgeTracker, FollowsThemThroughAFisheye) {
  std::mt19937_64 generator = TestGenerator();
  RobotAndDrawing robot = DrawRobot(4, kHalfSize);
  robot.truth.camera = Halved(DesktopFisheye());
  robot.truth.camera_from_base = LookAt({0.52, 0.074, 0.3}, {0, 0, 0.13});
  const Wandering way(robot.truth.robot, 1.5, generator);
  Follower follower(robot, robot.Perfect(), 4);
  FollowingScore score;
  for (int frame = 0; frame < 40; ++frame) follower.Follow(way.At(Follower::kPeriod_s * frame), score);
  score.Print("perfect model, fisheye");
  EXPECT_GE(score.seen, 0.95 * score.in_sight);
  EXPECT_LT(score.FineRms_px(), 0.1);
  EXPECT_EQ(score.wrong, 0);
}

// From all sides: legs hide each other and come out again.
TEST(EdgeTracker, HardlyEverTakesSomethingElseForAnEdgeWhereLegsCrossEachOther) {
  std::mt19937_64 generator = TestGenerator();
  const FollowingScore perfect = FollowRobots(8, 30, std::numbers::pi, true, generator);
  perfect.Print("perfect model, all sides");
  EXPECT_GE(perfect.seen, 0.93 * perfect.in_sight);
  EXPECT_LE(perfect.wrong, 0.001 * perfect.seen);
  EXPECT_LE(perfect.longest_wrong, 2);
  const FollowingScore drawing = FollowRobots(16, 20, std::numbers::pi, false, generator);
  drawing.Print("drawing, all sides");
  EXPECT_GE(drawing.seen, 0.8 * drawing.in_sight);
  EXPECT_LE(drawing.wrong, 0.004 * drawing.seen);
}

TEST(EdgeTracker, SaysWhyEachEdgeIsMissingWhereThereIsNothingToSeeAndGoesOnAfterwards) {
  const RobotAndDrawing robot = DrawRobot(3, kHalfSize);
  const Camera& camera = robot.truth.camera;
  const Rigid3 pose = robot.truth.robot.home;
  EdgeTracker tracker(robot.truth.robot, camera, robot.truth.camera_from_base, {});
  const SceneCamera scene(robot.truth, {}, 1);
  const GrayImage dark{camera.width_px, camera.height_px,
                       std::vector<std::uint8_t>(
                           static_cast<size_t>(camera.width_px) * static_cast<size_t>(camera.height_px), 40)};
  const auto expect_nothing = [](const TrackedEdges& tracked) {
    EXPECT_TRUE(tracked.seen.edges.empty());
    for (const auto& of_leg : tracked.missing)
      for (const std::string& why : of_leg) EXPECT_NE(why, "");
  };
  expect_nothing(tracker.Track(dark, 0, pose));
  EXPECT_EQ(tracker.Track(scene.Take(pose, {}, 1), 0.02, pose).seen.edges.size(), 12u);
  expect_nothing(tracker.Track(dark, 0.04, pose));
  EXPECT_EQ(tracker.Track(scene.Take(pose, {}, 2), 0.06, pose).seen.edges.size(), 12u);
  expect_nothing(tracker.Track(dark, 0.08, pose));
  // Long after what was seen last has been forgotten.
  EXPECT_EQ(tracker.Track(scene.Take(pose, {}, 3), 5, pose).seen.edges.size(), 12u);
}

TEST(EdgeTracker, RefusesAnImageOfAnotherSizeAndOptionsThatCannotBe) {
  const SimulationTruth truth = DesktopTruth(HalfCamera(true));
  EdgeTracker tracker(truth.robot, truth.camera, truth.camera_from_base, {});
  EXPECT_THROW(tracker.Track({640, 479, std::vector<std::uint8_t>(640 * 479)}, 0, truth.robot.home),
               std::invalid_argument);
  for (const auto& break_one : std::vector<void (*)(EdgeTrackerOptions&)>{
           [](EdgeTrackerOptions& o) { o.search_px = 0; }, [](EdgeTrackerOptions& o) { o.gate_px = -1; },
           [](EdgeTrackerOptions& o) { o.leg_m = 0; }, [](EdgeTrackerOptions& o) { o.leg_gate_sigmas = 0; },
           [](EdgeTrackerOptions& o) { o.forget_s = 0; },
           [](EdgeTrackerOptions& o) { o.first_look.least_length_px = 0; }}) {
    EdgeTrackerOptions options;
    break_one(options);
    EXPECT_THROW(EdgeTracker(truth.robot, truth.camera, truth.camera_from_base, options),
                 std::invalid_argument);
  }
}

// Squares of normalised errors, whose mean is 1 where the covariance is right.
struct Chi2 {
  double sum = 0;
  int count = 0;

  void Add(const SeenEdge& edge, const Eigen::Vector3d& error) {
    const Eigen::Matrix<double, 3, 2> tangents = TangentsOf(edge.normal);
    const Eigen::Matrix2d covariance = tangents.transpose() * edge.normal_covariance * tangents;
    const Eigen::Vector2d in_tangents = tangents.transpose() * error;
    sum += in_tangents.dot(covariance.inverse() * in_tangents);
    count += 2;
  }
  double Mean() const { return sum / count; }
};

// The covariance is of noise and of what shading does to a whole edge. The second is the same in every image
// of a pose: scatter over draws of the noise is less, the error against the truth about as large as it says.
TEST(EdgeTracker, CovariancesHoldTheScatterOfTheNoiseAndTheErrorsAgainstTheTruth) {
  std::mt19937_64 generator = TestGenerator();
  constexpr int kPoses = 4, kDraws = 24;
  Chi2 scatter, error;
  for (int i = 0; i < kPoses; ++i) {
    const RobotAndDrawing robot = DrawRobot(static_cast<std::uint64_t>(i), kHalfSize);
    const Rigid3 pose = Wandering(robot.truth.robot, 1, generator).At(0);
    const SceneCamera scene(robot.truth, {}, static_cast<std::uint64_t>(i));
    EdgeTracker tracker(robot.truth.robot, robot.truth.camera, robot.truth.camera_from_base, {});
    std::array<std::array<std::vector<SeenEdge>, 2>, kLegCount> draws;
    for (int draw = 0; draw < kDraws; ++draw)
      for (const SeenEdge& edge :
           tracker.Track(scene.Take(pose, {}, static_cast<std::uint64_t>(draw)), 0.02 * draw, pose)
               .seen.edges)
        draws[static_cast<size_t>(edge.leg)][static_cast<size_t>(edge.edge)].push_back(edge);
    const LegsInCamera legs = LegsOf(robot.truth, pose);
    for (size_t leg = 0; leg < kLegCount; ++leg)
      for (size_t side = 0; side < 2; ++side) {
        Eigen::Vector3d mean = Eigen::Vector3d::Zero();
        for (const SeenEdge& edge : draws[leg][side]) mean += edge.normal;
        mean /= static_cast<double>(draws[leg][side].size());
        const double unbiased = std::sqrt(kDraws / (kDraws - 1.0));
        const Eigen::Vector3d exact = CylinderOutline(
            LineThrough<double>(legs[leg].a_in_camera, legs[leg].b_in_camera), legs[leg].radius_m)[side];
        for (const SeenEdge& edge : draws[leg][side]) {
          scatter.Add(edge, unbiased * (edge.normal - mean));
          error.Add(edge, edge.normal - exact);
        }
      }
  }
  std::printf("squares over the covariance: scatter %.3f, error %.3f (%d numbers)\n", scatter.Mean(),
              error.Mean(), error.count);
  EXPECT_LT(scatter.Mean(), 1);
  EXPECT_GT(scatter.Mean(), 0.1);
  EXPECT_GT(error.Mean(), 0.3);
  EXPECT_LT(error.Mean(), 2);
}

}  // namespace
}  // namespace legible
