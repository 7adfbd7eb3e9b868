#include "servo/visp_leg_edge.h"

#include <gtest/gtest.h>
#include <visp3/vs/vpAdaptiveGain.h>
#include <visp3/vs/vpServo.h>

#include <memory>
#include <optional>

#include "servo/servo_step.h"
#include "tests/servo/servo_scene.h"
#include "tests/testing/matrices.h"

namespace legible {
namespace {

constexpr double kGain_per_s = 1.7;

// A scene, a goal, and some edges of some legs, off what any pose has by some noise.
struct Task {
  ServoScene scene;
  ServoGoal goal;
  SeenEdges seen;
  LegDirections directions;  // of both edges where they are seen, else of the model
  Vector6d length_m;
};

Task RandomTask(std::mt19937_64& generator, int hidden_legs, int single_legs) {
  Task task;
  task.scene = RandomScene(generator);
  const ServoModel& model = task.scene.model;
  task.goal = GoalAtPose(model, Nearby(task.scene.pose, 0.03, generator));
  task.seen = EdgesAt(model, task.scene.pose);
  GiveCovariances(task.seen, 1e-3, generator);
  task.seen = Moved(task.seen, generator);
  const int first = static_cast<int>(Uniform(generator, 0, kLegCount));
  const auto is_seen = [&](int leg, int edge) {
    const int place = (leg + first) % kLegCount;
    return place >= hidden_legs && (place >= hidden_legs + single_legs || edge == first % 2);
  };
  task.seen = Only(task.seen, is_seen);
  const EdgesByLeg by_leg = ByLeg(task.seen);
  for (int leg = 0; leg < kLegCount; ++leg) {
    const auto i = static_cast<size_t>(leg);
    const auto& edges = by_leg[i];
    task.directions.col(leg) = edges[0] && edges[1]
                                   ? DirectionFromEdges(edges[0]->normal, edges[1]->normal)
                                   : Eigen::Vector3d((PlatformJointInCamera(model, task.scene.pose, leg) -
                                                      model.base_joint_in_camera_m[i])
                                                         .normalized());
  }
  task.length_m = LegLengths(model.robot, InverseKinematics(model.robot, task.scene.pose));
  return task;
}

// What the project's own law makes of it, all edges alike.
ServoStep OwnStep(const Task& task, const AdaptiveGain& gain) {
  ServoStepOptions options;
  options.law.is_weighted = false;
  options.law.direction_source = DirectionSource::kEdges;
  options.slow_conditioning = 1 + 1e-9;
  options.gain = gain;
  options.limits.speed_limit_m_per_s = 1e6;
  options.limits.look_ahead_s = 1e-9;
  const Vector6d readings_m = InverseKinematics(task.scene.model.robot, task.scene.pose);
  return EvaluateStep(task.scene.model, task.goal, {task.seen, readings_m, Vector6d::Zero(), task.scene.pose},
                      options);
}

// A vpServo task of the same edges.
class VispTask {
 public:
  VispTask(const Task& task, vpServo::vpServoType type) {
    servo_.setServo(type);
    servo_.setInteractionMatrixType(vpServo::CURRENT);
    servo_.setPseudoInverseThreshold(1e-9);
    for (const SeenEdge& edge : task.seen.edges) {
      const auto& goal_edge = *task.goal.edges[static_cast<size_t>(edge.leg)][static_cast<size_t>(edge.edge)];
      goals_.push_back(std::make_unique<LegEdgeFeature>(task.scene.model, edge.leg));
      goals_.back()->BuildGoal(goal_edge.normal);
      seen_.push_back(std::make_unique<LegEdgeFeature>(task.scene.model, edge.leg));
      seen_.back()->BuildSeen(edge.normal, task.directions.col(edge.leg), task.length_m[edge.leg],
                              *goals_.back());
      servo_.addFeature(*seen_.back(), *goals_.back());
    }
    if (type == vpServo::EYEINHAND_CAMERA) return;
    servo_.set_cVe(vpVelocityTwistMatrix());
    servo_.set_eJe(TwistByJointSpeeds(task.scene.model, task.directions));
  }

  vpServo& servo() { return servo_; }

  Vector6d Speeds() {
    const vpColVector speeds = servo_.computeControlLaw();
    Vector6d converted;
    for (unsigned i = 0; i < 6; ++i) converted[i] = speeds[i];
    return converted;
  }

 private:
  std::vector<std::unique_ptr<LegEdgeFeature>> seen_, goals_;
  vpServo servo_;
};

// Legs that are hidden, and legs that show one edge alone.
const std::vector<std::pair<int, int>> kSubsets = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {0, 2}, {1, 2}, {2, 1}};

template <typename Check>
void ForTasks(const Check& check) {
  std::mt19937_64 generator = TestGenerator();
  for (const auto& [hidden, single] : kSubsets)
    for (int n = 0; n < 15; ++n) {
      Task task = RandomTask(generator, hidden, single);
      // Edges too ill-conditioned to servo by would only show rounding.
      while (OwnStep(task, AdaptiveGain::Constant(1)).law.status != LawStatus::kOk)
        task = RandomTask(generator, hidden, single);
      ASSERT_EQ(static_cast<int>(task.seen.edges.size()), 12 - 2 * hidden - single);
      check(task);
    }
}

TEST(LegEdgeFeature, MakesVpServoGiveTheTwistOfTheProjectsLaw) {
  ForTasks([](const Task& task) {
    VispTask visp(task, vpServo::EYEINHAND_CAMERA);
    visp.servo().setLambda(kGain_per_s);
    const Vector6d twist = visp.Speeds();
    // The law's joint speeds are the twist's: it names none itself.
    const Matrix6d by_twist = CameraInverseJacobian(task.scene.model, task.directions);
    const Vector6d own = by_twist.partialPivLu().solve(
        OwnStep(task, AdaptiveGain::Constant(kGain_per_s)).joint_speeds_m_per_s);
    EXPECT_TRUE(AreNear(twist, own, 1e-9 * own.norm()));
  });
}

TEST(LegEdgeFeature, MakesVpServoGiveTheJointSpeedsOfTheProjectsLaw) {
  ForTasks([](const Task& task) {
    VispTask visp(task, vpServo::EYEINHAND_L_cVe_eJe);
    visp.servo().setLambda(kGain_per_s);
    const Vector6d own = OwnStep(task, AdaptiveGain::Constant(kGain_per_s)).joint_speeds_m_per_s;
    EXPECT_TRUE(AreNear(visp.Speeds(), own, 1e-9 * own.norm()));
  });
}

TEST(LegEdgeFeature, MakesVpServoTakeItsAdaptiveGainAsTheProjectDoes) {
  ForTasks([](const Task& task) {
    VispTask visp(task, vpServo::EYEINHAND_L_cVe_eJe);
    visp.servo().setLambda(4, 0.5, 60);
    const Vector6d own = OwnStep(task, {4, 0.5, 60}).joint_speeds_m_per_s;
    EXPECT_TRUE(AreNear(visp.Speeds(), own, 1e-9 * own.norm()));
  });
}

TEST(LegEdgeFeature, ServesAVpServoTaskFromCycleToCycleToTheGoal) {
  std::mt19937_64 generator = TestGenerator();
  Task task = RandomTask(generator, 0, 0);
  const ServoModel& model = task.scene.model;
  Rigid3 pose = task.scene.pose;
  Vector6d readings_m = InverseKinematics(model.robot, pose);
  std::vector<LegEdgeFeature> seen, goals;
  for (const SeenEdge& edge : task.seen.edges) {
    seen.emplace_back(model, edge.leg);
    goals.emplace_back(model, edge.leg);
    goals.back().BuildGoal(
        task.goal.edges[static_cast<size_t>(edge.leg)][static_cast<size_t>(edge.edge)]->normal);
  }
  vpServo servo;
  servo.setServo(vpServo::EYEINHAND_L_cVe_eJe);
  servo.setInteractionMatrixType(vpServo::CURRENT);
  servo.setLambda(2);
  for (size_t i = 0; i < seen.size(); ++i) servo.addFeature(seen[i], goals[i]);
  for (int cycle = 0; cycle < 600; ++cycle) {
    const SeenEdges edges = EdgesAt(model, pose);
    LegDirections directions;
    for (int leg = 0; leg < kLegCount; ++leg)
      directions.col(leg) =
          (PlatformJointInCamera(model, pose, leg) - model.base_joint_in_camera_m[static_cast<size_t>(leg)])
              .normalized();
    const Vector6d length_m = LegLengths(model.robot, readings_m);
    for (size_t i = 0; i < seen.size(); ++i) {
      const int leg = edges.edges[i].leg;
      seen[i].BuildSeen(edges.edges[i].normal, directions.col(leg), length_m[leg], goals[i]);
    }
    servo.set_cVe(vpVelocityTwistMatrix());
    servo.set_eJe(TwistByJointSpeeds(model, directions));
    const vpColVector speeds = servo.computeControlLaw();
    for (unsigned i = 0; i < 6; ++i) readings_m[i] += 0.02 * speeds[i];
    pose = ForwardKinematics(model.robot, readings_m, pose).base_from_platform;
  }
  EXPECT_TRUE(AreNear(Displacement(pose, *task.goal.base_from_platform), Vector6d::Zero(), 1e-8));
}

TEST(LegEdgeFeature, SelectsRowsAndCopiesItself) {
  std::mt19937_64 generator = TestGenerator();
  const Task task = RandomTask(generator, 0, 0);
  const SeenEdge& edge = task.seen.edges[3];
  LegEdgeFeature goal(task.scene.model, edge.leg), seen(task.scene.model, edge.leg);
  goal.BuildGoal(task.goal.edges[1][1]->normal);
  seen.BuildSeen(edge.normal, task.directions.col(edge.leg), task.length_m[edge.leg], goal);
  const vpColVector error = seen.error(goal);
  const vpMatrix interaction = seen.interaction();
  ASSERT_EQ(error.size(), 3u);
  const unsigned select = vpBasicFeature::FEATURE_LINE[0] | vpBasicFeature::FEATURE_LINE[2];
  EXPECT_EQ(seen.getDimension(select), 2u);
  EXPECT_EQ(seen.error(goal, select)[1], error[2]);
  EXPECT_EQ(seen.interaction(select)[1][4], interaction[2][4]);
  const std::unique_ptr<LegEdgeFeature> copy(seen.duplicate());
  EXPECT_EQ(copy->error(goal)[1], error[1]);
  EXPECT_EQ(copy->interaction()[2][5], interaction[2][5]);
}

TEST(LegEdgeFeature, RefusesToBeUsedBeforeItIsBuilt) {
  std::mt19937_64 generator = TestGenerator();
  const Task task = RandomTask(generator, 0, 0);
  LegEdgeFeature goal(task.scene.model, 0), seen(task.scene.model, 0);
  EXPECT_THROW(seen.interaction(), vpException);
  EXPECT_THROW(seen.error(goal), vpException);
  goal.BuildGoal(task.seen.edges[0].normal);
  EXPECT_THROW(seen.error(goal), vpException);
  EXPECT_THROW(goal.interaction(), vpException);
  EXPECT_THROW(LegEdgeFeature(task.scene.model, 6), std::out_of_range);
}

TEST(AdaptiveGain, IsVpAdaptiveGain) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 50; ++n) {
    AdaptiveGain own;
    own.at_infinity_per_s = Uniform(generator, 0.1, 2);
    own.at_zero_per_s = own.at_infinity_per_s + (n == 0 ? 0 : Uniform(generator, 0.1, 5));
    own.slope_at_zero = Uniform(generator, 0, 50);
    const vpAdaptiveGain visp(own.at_zero_per_s, own.at_infinity_per_s, own.slope_at_zero);
    for (const double error : {0.0, 1e-4, 0.03, 0.5, 10.0})
      EXPECT_NEAR(own.At(error), visp.value(error), 1e-14 * own.at_zero_per_s);
  }
}

}  // namespace
}  // namespace legible
