// The robot found in the simulated camera's images, anywhere in its workspace.
#include "core/vision/robot_finder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "core/stopwatch.h"
#include "tests/core/rig/moving_robot.h"

namespace legible {
namespace {

struct FinderScore {
  int tried = 0, found = 0, wrong = 0;
  double largest_off_px = 0, total_s = 0;
};

// Poses as sessions have them, up to 10 cm and 20 degrees from home, each of another robot.
FinderScore FindRobots(int count, double largest_azimuth_rad, bool is_perfect, std::mt19937_64& generator) {
  FinderScore score;
  for (int i = 0; i < count; ++i) {
    SyntheticOptions options;
    options.image_count = 1;
    options.seed = generator() % 100000;
    const Rigid3 pose = GenerateSession(options).true_base_from_platform[0];
    const RobotAndDrawing robot = SeenFrom(DrawRobot(options.seed, true),
                                           Uniform(generator, -largest_azimuth_rad, largest_azimuth_rad));
    const BelievedRobot believed = is_perfect ? robot.Perfect() : robot.drawing;
    const GrayImage image = SceneCamera(robot.truth, {}, options.seed).Take(pose, {}, 0);
    const Stopwatch watch;
    const FoundRobot found = FindRobot(image, believed.robot, believed.camera, believed.camera_from_base, {});
    score.total_s += watch.Seconds();
    ++score.tried;
    if (found.status != RobotFinderStatus::kFound) {
      EXPECT_NE(found.reason, "");
      EXPECT_TRUE(found.seen.edges.empty());
      continue;
    }
    ++score.found;
    double largest_px = 0;
    for (const SeenEdge& edge : found.seen.edges)
      largest_px = std::max(largest_px, LargestOff(robot.truth, pose, believed.camera, edge));
    score.wrong += largest_px > FollowingScore::kFalse_px ? 1 : 0;
    score.largest_off_px = std::max(score.largest_off_px, largest_px);
  }
  std::printf("%d of %d robots found, %d of them wrong, an edge %.2f px off at most; %.2f s each\n",
              score.found, score.tried, score.wrong, score.largest_off_px, score.total_s / score.tried);
  return score;
}

TEST(RobotFinder, FindsTheRobotAnywhereInItsWorkspaceByACalibratedModel) {
  std::mt19937_64 generator = TestGenerator();
  const FinderScore score = FindRobots(40, 0.1, true, generator);
  EXPECT_GE(score.found, 0.95 * score.tried);
  EXPECT_EQ(score.wrong, 0);
}

TEST(RobotFinder, FindsItByADrawingAndAGuessedCameraToo) {
  std::mt19937_64 generator = TestGenerator();
  const FinderScore score = FindRobots(24, 0.1, false, generator);
  EXPECT_GE(score.found, 0.9 * score.tried);
  EXPECT_EQ(score.wrong, 0);
}

// Where legs hide each other too few edges may be left: then it must not be found rather than be wrong.
TEST(RobotFinder, IsNeverWrongWhereLegsHideEachOther) {
  std::mt19937_64 generator = TestGenerator();
  EXPECT_EQ(FindRobots(30, std::numbers::pi, true, generator).wrong, 0);
}

TEST(RobotFinder, FindsNoRobotWhereThereIsNone) {
  std::mt19937_64 generator = TestGenerator();
  const RobotAndDrawing robot = DrawRobot(11, true);
  const Camera& camera = robot.truth.camera;
  const SceneCamera scene(robot.truth, {}, 1);
  GrayImage noise = scene.Take(robot.truth.robot.home, {}, 0);
  const GrayImage covered = scene.Take(robot.truth.robot.home, {0, 1, 2, 3, 4}, 0);
  GrayImage upside_down = noise;
  std::reverse(upside_down.pixels.begin(), upside_down.pixels.end());
  for (std::uint8_t& pixel : noise.pixels) pixel = static_cast<std::uint8_t>(generator() % 256);
  noise = Blurred(noise, 2);
  for (const GrayImage* image : std::initializer_list<const GrayImage*>{&noise, &covered, &upside_down})
    for (const BelievedRobot& believed : {robot.Perfect(), robot.drawing}) {
      const FoundRobot found =
          FindRobot(*image, believed.robot, believed.camera, believed.camera_from_base, {});
      EXPECT_NE(found.status, RobotFinderStatus::kFound);
      EXPECT_THAT(found.reason, testing::StartsWith("shows "));
    }
  EXPECT_THROW(FindRobot({8, 8, std::vector<std::uint8_t>(64)}, robot.truth.robot, camera,
                         robot.truth.camera_from_base, {}),
               std::invalid_argument);
}

TEST(RobotFinder, FindsTheSameAgain) {
  const RobotAndDrawing robot = DrawRobot(12, true);
  const GrayImage image = SceneCamera(robot.truth, {}, 1).Take(robot.truth.robot.home, {}, 0);
  const auto find = [&] {
    return FindRobot(image, robot.truth.robot, robot.truth.camera, robot.truth.camera_from_base, {});
  };
  const FoundRobot first = find(), second = find();
  ASSERT_EQ(first.status, RobotFinderStatus::kFound);
  ASSERT_EQ(first.seen.edges.size(), second.seen.edges.size());
  for (size_t i = 0; i < first.seen.edges.size(); ++i)
    EXPECT_EQ(first.seen.edges[i].normal, second.seen.edges[i].normal);
  EXPECT_EQ(first.base_from_platform.translation, second.base_from_platform.translation);
}

}  // namespace
}  // namespace legible
