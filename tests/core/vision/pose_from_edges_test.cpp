#include "core/vision/pose_from_edges.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "tests/testing/hexapod_view.h"
#include "tests/testing/matrices.h"

namespace legible {
namespace {

SeenEdges EdgesOf(const HexapodView& view) {
  return EdgesOf(view.robot, view.camera_from_base, view.base_from_platform);
}

EdgePose Fit(const HexapodView& view, const SeenEdges& seen, const Rigid3& guess) {
  return FitPoseToEdges(view.robot, view.camera_from_base, seen, guess);
}

TEST(FitPoseToEdges, RecoversThePoseOfExactEdges) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 30; ++n) {
    const HexapodView view = RandomView(generator);
    SeenEdges seen = EdgesOf(view);
    if (n % 2 == 0) GiveCovariances(seen, 1e-4, generator);
    const EdgePose found = Fit(view, seen, Nearby(view.base_from_platform, 0.05, generator));
    ASSERT_EQ(found.status, EdgePoseStatus::kConverged);
    EXPECT_TRUE(
        AreNear(Displacement(view.base_from_platform, found.base_from_platform), Vector6d::Zero(), 1e-11));
  }
}

TEST(FitPoseToEdges, SixEdgesAreEnough) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 20; ++n) {
    const HexapodView view = RandomView(generator);
    const auto one_of_each = [&](int leg, int edge) { return edge == (leg + n) % 2; };
    const EdgePose found =
        Fit(view, Only(EdgesOf(view), one_of_each), Nearby(view.base_from_platform, 1e-3, generator));
    ASSERT_EQ(found.status, EdgePoseStatus::kConverged);
    EXPECT_TRUE(
        AreNear(Displacement(view.base_from_platform, found.base_from_platform), Vector6d::Zero(), 1e-9));
  }
}

TEST(FitPoseToEdges, ScattersAsItsCovarianceSays) {
  std::mt19937_64 generator = TestGenerator();
  constexpr int kScenes = 4, kDraws = 800;
  double chi2 = 0, residuals2 = 0;
  for (int n = 0; n < kScenes; ++n) {
    const HexapodView view = RandomView(generator);
    SeenEdges seen = EdgesOf(view);
    GiveCovariances(seen, 5e-5, generator);
    for (int draw = 0; draw < kDraws; ++draw) {
      const EdgePose found = Fit(view, Moved(seen, generator), view.base_from_platform);
      ASSERT_EQ(found.status, EdgePoseStatus::kConverged);
      const Vector6d off = Displacement(view.base_from_platform, found.base_from_platform);
      chi2 += off.dot(found.covariance.llt().solve(off));
      residuals2 += 24 * found.rms_sigma * found.rms_sigma;
    }
  }
  // chi^2 of 6 and of 24 - 6 degrees of freedom; the variance of their means is twice that by the draws.
  constexpr double kCount = kScenes * kDraws;
  EXPECT_NEAR(chi2 / kCount, 6, 5 * std::sqrt(12 / kCount));
  EXPECT_NEAR(residuals2 / kCount, 18, 5 * std::sqrt(36 / kCount));
}

TEST(FitPoseToEdges, SaysWhereEdgesAreTooFewOrLeaveAMotionOpen) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 10; ++n) {
    HexapodView view = RandomView(generator);
    const SeenEdges all = EdgesOf(view);
    const auto status = [&](const auto& keep) {
      return Fit(view, Only(all, keep), view.base_from_platform).status;
    };
    EXPECT_EQ(Fit(view, {}, view.base_from_platform).status, EdgePoseStatus::kTooFewEdges);
    EXPECT_EQ(status([](int leg, int edge) { return leg > 0 && edge == 0; }), EdgePoseStatus::kTooFewEdges);
    EXPECT_EQ(status([](int leg, int) { return leg == 1 || leg == 4; }), EdgePoseStatus::kTooFewEdges);
    // Three legs that are parallel: the platform can move along them.
    for (size_t i = 0; i < kLegCount; i += 2)
      view.robot.legs[i].base_joint_m =
          view.base_from_platform * view.robot.legs[i].platform_joint_m - Eigen::Vector3d(0, 0, 0.32);
    const SeenEdges parallel = Only(EdgesOf(view), [](int leg, int) { return leg % 2 == 0; });
    EXPECT_EQ(Fit(view, parallel, view.base_from_platform).status, EdgePoseStatus::kTooFewEdges);
  }
}

TEST(FitPoseToEdges, DoesNotConvergeOnWhatIsNoNumberOrNoLeg) {
  std::mt19937_64 generator = TestGenerator();
  HexapodView view = RandomView(generator);
  SeenEdges seen = EdgesOf(view);
  seen.edges[7].normal.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(Fit(view, seen, view.base_from_platform).status, EdgePoseStatus::kNotConverged);
  seen = EdgesOf(view);
  view.robot.legs[0].radius_m = 5;  // the camera is inside it
  EXPECT_EQ(Fit(view, seen, view.base_from_platform).status, EdgePoseStatus::kNotConverged);
}

}  // namespace
}  // namespace legible
