// What noise of the edges makes of the laws, and what these say of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <string>
#include <vector>

#include "servo/servo_step.h"
#include "tests/servo/law_task.h"
#include "tests/testing/matrices.h"

namespace legible {
namespace {

TEST(ControlLaw, KnowsWhatNoiseMakesOfItsWayAndError) {
  std::mt19937_64 generator = TestGenerator();
  for (const ControlMode mode : {ControlMode::kEdges, ControlMode::kDirections}) {
    const ServoScene scene = RandomScene(generator);
    const LawTask task{scene, GoalAtPose(scene.model, scene.pose)};
    SeenEdges seen = EdgesAt(scene.model, scene.pose);
    GiveCovariances(seen, 3e-5, generator);
    constexpr int kDraws = 3000;
    double chi2 = 0, squares = 0, predicted = 0;
    for (int n = 0; n < kDraws; ++n) {
      const LawResult result = EvaluateLaw(scene.model, task.goal, task.Input(Moved(seen, generator)),
                                           Law(mode, true, DirectionSource::kModel));
      chi2 += (result.metric * result.to_go_m).squaredNorm();
      squares += result.error * result.error;
      predicted += result.error_noise * result.error_noise;
    }
    // Sum of 6 squares of standard normals: its mean varies by sqrt(12 / draws) = 0.063. The seen
    // directions' covariance is of first order in 3e-5 / 0.02, the angle between the edges.
    EXPECT_NEAR(chi2 / kDraws, 6, 5 * std::sqrt(12.0 / kDraws));
    EXPECT_NEAR(squares / predicted, 1, 5 * std::sqrt(2.0 / (6 * kDraws)));
  }
}

// Motion of the platform about its origin, rotations by its radius, that a way of the joints makes.
Vector6d PlatformMotion(const LawTask& task, const Vector6d& way_m) {
  Vector6d scale = Vector6d::Ones();
  scale.tail<3>().setConstant(1 / task.scene.model.platform_radius_m);
  const Matrix6d jacobian = InverseJacobian(task.scene.model.robot, task.scene.pose) * scale.asDiagonal();
  return jacobian.fullPivLu().solve(way_m);
}

TEST(ControlLaw, KnowsTheScatterOfTheMotionThatItIsToldWorst) {
  std::mt19937_64 generator = TestGenerator();
  std::vector<ControlLawOptions> laws;
  for (const ControlMode mode : {ControlMode::kEdges, ControlMode::kDirections})
    for (const bool is_weighted : {false, true})
      laws.push_back(Law(mode, is_weighted, DirectionSource::kModel));
  laws.push_back(Law(ControlMode::kPose));
  laws.back().pose_source = PoseSource::kEdges;
  for (const ControlLawOptions& law : laws) {
    SCOPED_TRACE(std::string(ToString(law.mode)) + (law.is_weighted ? ", weighted" : ""));
    const ServoScene scene = RandomScene(generator);
    const LawTask task{scene, GoalAtPose(scene.model, scene.pose)};
    SeenEdges seen = EdgesAt(scene.model, scene.pose);
    GiveCovariances(seen, 3e-5, generator);
    const double sigma_m = EvaluateLaw(scene.model, task.goal, task.Input(seen), law).motion_sigma_m;
    constexpr int kDraws = 2000;
    Matrix6d squares = Matrix6d::Zero();
    for (int n = 0; n < kDraws; ++n) {
      const LawResult result = EvaluateLaw(scene.model, task.goal, task.Input(Moved(seen, generator)), law);
      ASSERT_EQ(result.status, LawStatus::kOk);
      const Vector6d motion = PlatformMotion(task, result.to_go_m);
      squares += motion * motion.transpose() / kDraws;
    }
    const double largest = Eigen::SelfAdjointEigenSolver<Matrix6d>(squares).eigenvalues()[5];
    EXPECT_NEAR(largest / (sigma_m * sigma_m), 1, 5 * std::sqrt(2.0 / kDraws));
  }
}

TEST(ServoStep, SlowsAsNoiseLeavesAMotionLessCertainAndStopsAtTheLimit) {
  std::mt19937_64 generator = TestGenerator();
  for (const bool is_weighted : {false, true}) {
    const LawTask task = RandomTask(generator, 1e-4);
    SeenEdges seen = EdgesAt(task.scene.model, task.scene.pose);
    GiveCovariances(seen, 3e-5, generator);
    ServoStepOptions options;
    options.law = Law(ControlMode::kEdges, is_weighted);
    const auto step = [&] { return EvaluateStep(task.scene.model, task.goal, task.Input(seen), options); };
    options.law.most_motion_sigma = 1e3;
    const ServoStep free = step();
    EXPECT_EQ(free.singularity_factor, 1);
    const double sigma = free.law.motion_sigma_m / task.scene.model.platform_radius_m;
    options.law.most_motion_sigma = 1.5 * sigma;
    const double factor = 1.5 / options.slow_conditioning;
    EXPECT_NEAR(step().singularity_factor, factor, 1e-9);
    EXPECT_EQ(step().slowed_by, SlowedBy::kNoise);
    EXPECT_THAT(DescribeLimits(step()),
                testing::HasSubstr("for noise leaves a motion of the platform a σ of"));
    EXPECT_TRUE(AreNear(step().joint_speeds_m_per_s, factor * free.joint_speeds_m_per_s, 1e-12));
    options.law.most_motion_sigma = 0.99 * sigma;
    EXPECT_EQ(step().law.status, LawStatus::kIllConditionedEdges);
    EXPECT_EQ(step().joint_speeds_m_per_s, Vector6d::Zero());
    EXPECT_THAT(WhyNoSpeeds(step(), options.law), testing::HasSubstr("noise leaves it a σ of"));
  }
}

// The ends of a stretch that was seen lie on its line.
SeenEdges WithEndsOnTheirLines(SeenEdges seen) {
  for (SeenEdge& edge : seen.edges)
    for (Eigen::Vector2d& end : edge.ends) {
      const Eigen::Vector2d across = edge.normal.head<2>();
      end -= across * (edge.normal.dot(end.homogeneous()) / across.squaredNorm());
    }
  return seen;
}

// A goal that was shown has noise of its own, for good.
TEST(ControlLaw, KnowsWhatNoiseOfAShownGoalMakesOfItsError) {
  std::mt19937_64 generator = TestGenerator();
  for (const ControlMode mode : {ControlMode::kEdges, ControlMode::kDirections}) {
    SCOPED_TRACE(ToString(mode));
    const ServoScene scene = RandomScene(generator);
    SeenEdges exact = EdgesAt(scene.model, scene.pose);
    GiveCovariances(exact, 3e-5, generator);
    constexpr int kDraws = 1000;
    double squares = 0, predicted = 0;
    for (int n = 0; n < kDraws; ++n) {
      const SeenEdges shown = WithEndsOnTheirLines(Moved(exact, generator));
      const LawTask task{scene, GoalFromEdges(scene.model, shown, scene.pose)};
      const LawResult result =
          EvaluateLaw(scene.model, task.goal, task.Input(Moved(exact, generator)), Law(mode));
      squares += result.error * result.error;
      predicted += result.error_noise * result.error_noise;
    }
    EXPECT_NEAR(squares / predicted, 1, 5 * std::sqrt(2.0 / (6 * kDraws)));
  }
}

TEST(PoseLaw, KnowsWhatNoiseMakesOfItsError) {
  std::mt19937_64 generator = TestGenerator();
  const ServoScene scene = RandomScene(generator);
  const LawTask task{scene, GoalAtPose(scene.model, scene.pose)};
  SeenEdges seen = EdgesAt(scene.model, scene.pose);
  GiveCovariances(seen, 3e-5, generator);
  ControlLawOptions law = Law(ControlMode::kPose);
  law.pose_source = PoseSource::kEdges;
  constexpr int kDraws = 1000;
  double squares = 0, predicted = 0;
  for (int n = 0; n < kDraws; ++n) {
    const LawResult result = EvaluateLaw(scene.model, task.goal, task.Input(Moved(seen, generator)), law);
    squares += result.error * result.error;
    predicted += result.error_noise * result.error_noise;
  }
  EXPECT_NEAR(squares / predicted, 1, 5 * std::sqrt(2.0 / kDraws));  // one direction alone could hold it all
}

TEST(DirectionCovariance, IsTheScatterOfDirections) {
  std::mt19937_64 generator = TestGenerator();
  for (int leg = 0; leg < kLegCount; ++leg) {
    const ServoScene scene = RandomScene(generator);
    SeenEdges seen = Only(EdgesAt(scene.model, scene.pose), [&](int i, int) { return i == leg; });
    GiveCovariances(seen, 1e-5, generator);
    const Eigen::Matrix3d covariance = DirectionCovariance(seen.edges[0], seen.edges[1]);
    const Eigen::Vector3d u = DirectionFromEdges(seen.edges[0].normal, seen.edges[1].normal);
    EXPECT_NEAR((covariance * u).norm(), 0, 1e-12 * covariance.norm());
    const Eigen::Matrix<double, 3, 2> across = TangentsOf(u);
    const Eigen::Matrix2d inverse = (across.transpose() * covariance * across).inverse();
    constexpr int kDraws = 2000;
    double chi2 = 0;
    for (int n = 0; n < kDraws; ++n) {
      const SeenEdges moved = Moved(seen, generator);
      const Eigen::Vector2d off =
          across.transpose() * DirectionFromEdges(moved.edges[0].normal, moved.edges[1].normal);
      chi2 += off.dot(inverse * off);
    }
    EXPECT_NEAR(chi2 / kDraws, 2, 5 * std::sqrt(4.0 / kDraws));
  }
}

}  // namespace
}  // namespace legible
