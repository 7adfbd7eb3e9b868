#include "core/vision/leg_lock.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "tests/core/vision/scene.h"
#include "tests/testing/random.h"
#include "tests/testing/render_legs.h"

namespace legible {
namespace {

// Middle of the leg's two edge points nearest to the given place on its axis.
struct Middle {
  Eigen::Vector2d centre_px, across_px;  // towards edge 2
};
Middle MiddleOf(const PredictedEdges& edges, size_t leg, double share) {
  const std::vector<PredictedEdgePoint>&first = edges[leg][0].points, &second = edges[leg][1].points;
  const size_t at =
      static_cast<size_t>(share * static_cast<double>(std::min(first.size(), second.size()) - 1));
  return {(first[at].point_px + second[at].point_px) / 2, second[at].normal_px};
}

// Displaces the robot, and expects the lock to find most legs where they are from where they were predicted.
void ExpectLocks(const Vector6d& displacement, const LegLockOptions& options, double least_displacement_px,
                 double within_px) {
  std::mt19937_64 generator = TestGenerator();
  const Scene scene(true);
  const PredictedEdges truth = PredictEdges(scene.Legs(), scene.camera, {});
  const GrayImage image = WithNoise(RenderLegs(scene.Legs(), scene.camera, {}), 2, generator);
  const PredictedEdges predicted = PredictEdges(scene.LegsDisplaced(displacement), scene.camera, {});
  const auto locks = LockOnLegs(image, predicted, options);
  double furthest_px = 0;
  int locked = 0;
  for (size_t leg = 0; leg < kLegCount; ++leg) {
    const Middle from = MiddleOf(predicted, leg, 0.5), to = MiddleOf(truth, leg, 0.5);
    furthest_px = std::max(furthest_px, (to.centre_px - from.centre_px).norm());
    if (!locks[leg]) continue;
    ++locked;
    const double shift_px = (locks[leg]->shift_at_a_px + locks[leg]->shift_at_b_px) / 2;
    EXPECT_NEAR(shift_px, from.across_px.dot(to.centre_px - from.centre_px), within_px) << "leg " << leg + 1;
  }
  EXPECT_GT(furthest_px, least_displacement_px);
  EXPECT_GE(locked, 4);
}

TEST(LockOnLegs, FindsLegsFortyPixelsFromTheirPrediction) {
  Vector6d displacement;
  displacement << 0.025, -0.018, 0.02, 0.02, 0.03, 0.03;
  // A leg this bright reaches the largest contrast that counts over some 3 px to either side of its place.
  ExpectLocks(displacement, {}, 38, 3.5);
}

TEST(LockOnLegs, FindsLegsAsFarOffAsTheRangeSays) {
  Vector6d displacement;
  displacement << 0.025, -0.07, -0.055, 0.02, 0.03, 0.03;
  // From here perspective too takes some pixels that no shift, roll and growth can; the search for edges
  // has 12.
  ExpectLocks(displacement, {.range_px = 120}, 100, 6);
}

TEST(LockOnLegs, FindsNothingInAnEmptyImage) {
  const Scene scene(false);
  const GrayImage image{
      scene.camera.width_px, scene.camera.height_px,
      std::vector<std::uint8_t>(static_cast<size_t>(scene.camera.width_px * scene.camera.height_px), 90)};
  for (const auto& lock : LockOnLegs(image, PredictEdges(scene.Legs(), scene.camera, {}), {}))
    EXPECT_FALSE(lock);
}

TEST(LegLockOptions, RejectRangesThatAreNotPositive) {
  EXPECT_THROW(LegLockOptions{.blur_px = 0}.Check(), std::invalid_argument);
  EXPECT_THROW(LegLockOptions{.range_px = -1}.Check(), std::invalid_argument);
  EXPECT_THROW(LegLockOptions{.leg_range_px = 0}.Check(), std::invalid_argument);
}

}  // namespace
}  // namespace legible
