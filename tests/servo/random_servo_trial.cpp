#include "tests/servo/random_servo_trial.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/robots/mechanism.h"
#include "tests/testing/hexapod_view.h"

namespace legible {
namespace {

using Generator = std::mt19937_64;

constexpr double kTimeout_s = 20;
constexpr double kClose_m = 3e-4;  // to the margins: what a goal within the ranges keeps from them

bool Chance(Generator& generator, double share) { return Uniform(generator, 0, 1) < share; }

int OneOf(Generator& generator, int count) {
  return std::uniform_int_distribution<int>(0, count - 1)(generator);
}

// 0 with that chance, else up to the most.
double OftenZero(Generator& generator, double chance_of_zero, double most) {
  return Chance(generator, chance_of_zero) ? 0 : Uniform(generator, 0, most);
}

bool IsInRange(const GoughStewart& robot, const Rigid3& pose, double margin_m) {
  const Vector6d readings_m = InverseKinematics(robot, pose);
  for (int i = 0; i < kLegCount; ++i) {
    const auto [shortest_m, longest_m] = robot.legs[static_cast<size_t>(i)].joint_range_m;
    if (readings_m[i] < shortest_m + margin_m || readings_m[i] > longest_m - margin_m) return false;
  }
  return true;
}

// The first of the poses drawn about home whose joints keep that from the ends of their ranges.
Rigid3 DrawPose(Generator& generator, const GoughStewart& robot, double margin_m) {
  for (;;) {
    Vector6d displacement;
    displacement << UniformVector(generator, -0.05, 0.05), UniformVector(generator, -0.2, 0.2);
    const Rigid3 pose = Displaced(robot.home, displacement);
    if (IsInRange(robot, pose, margin_m)) return pose;
  }
}

// One joint within a millimetre of an end of its range, or beyond it by up to 2 cm.
Rigid3 DrawPoseAtAnEnd(Generator& generator, const GoughStewart& robot, double beyond_m) {
  for (;;) {
    const Rigid3 near_by = DrawPose(generator, robot, 1e-3);
    Vector6d readings_m = InverseKinematics(robot, near_by);
    const int leg = OneOf(generator, kLegCount);
    const auto [shortest_m, longest_m] = robot.legs[static_cast<size_t>(leg)].joint_range_m;
    const double inside_m = Uniform(generator, -beyond_m, beyond_m > 0 ? 0 : 1e-3);
    const bool is_long = readings_m[leg] > (shortest_m + longest_m) / 2;
    readings_m[leg] = is_long ? longest_m - inside_m : shortest_m + inside_m;
    const auto pose = ForwardKinematics(robot, readings_m, near_by);
    if (pose.status == ForwardKinematicsStatus::kConverged) return pose.base_from_platform;
  }
}

// The robot and its camera, and what is believed of them.
void DrawRig(Generator& generator, ServoTrial& trial) {
  trial.model_error = OftenZero(generator, 0.4, 1);
  SyntheticOptions options;
  options.seed = generator();
  options.image_count = 1;
  const double around_rad = Chance(generator, 0.5) ? 0.08 : Uniform(generator, -3.1, 3.1);
  options.camera_from_base = LookAt(
      {0.95 * std::cos(around_rad), 0.95 * std::sin(around_rad), Uniform(generator, 0.2, 0.4)}, {0, 0, 0.13});
  for (double* error :
       {&options.geometry_error_m, &options.joint_offset_error_m, &options.radius_error_m,
        &options.camera_error_px, &options.camera_position_error_m, &options.camera_rotation_error_rad})
    *error *= trial.model_error;
  const SyntheticSession drawn = GenerateSession(options);
  trial.truth = {drawn.true_robot, drawn.true_camera, drawn.true_camera_from_base};
  trial.model =
      trial.model_error == 0
          ? MakeServoModel(drawn.true_robot, drawn.true_camera, drawn.true_camera_from_base)
          : MakeServoModel(drawn.nominal_robot, drawn.nominal_camera, drawn.nominal_camera_from_base);
}

void DrawWay(Generator& generator, ServoTrial& trial) {
  trial.simulation.start = Chance(generator, 0.1) ? DrawPoseAtAnEnd(generator, trial.truth.robot, 0)
                                                  : DrawPose(generator, trial.truth.robot, 1e-3);
  const GoughStewart& robot = trial.model.robot;
  trial.is_goal_in_range = !Chance(generator, 0.2);
  const double margin_m = trial.options.step.limits.range_margin_m + kClose_m;
  trial.goal_pose =
      trial.is_goal_in_range ? DrawPose(generator, robot, margin_m) : DrawPoseAtAnEnd(generator, robot, 0.02);
  trial.goal = GoalAtPose(trial.model, trial.goal_pose);
  if (trial.model_error == 0 || Chance(generator, 0.5)) return;
  // Taught by showing: a pose of the true robot.
  const Rigid3 shown = DrawPose(generator, trial.truth.robot, margin_m);
  const SeenEdges seen = ThroughModel(EdgesOf(trial.truth.robot, trial.truth.camera_from_base, shown),
                                      trial.truth.camera, trial.model.camera);
  const ServoGoal taught = GoalFromEdges(trial.model, seen, shown);
  if (taught.base_from_platform) trial.goal = taught;
}

void DrawDrives(Generator& generator, ServoTrial& trial) {
  SimulationOptions& simulation = trial.simulation;
  JointLimitOptions& limits = trial.options.step.limits;
  limits.speed_limit_m_per_s = Uniform(generator, 0.02, 0.1);
  DriveOptions& drives = simulation.drives;
  drives.lag_s = OftenZero(generator, 0.1, 0.04);
  drives.speed_limit_m_per_s = Chance(generator, 0.5) ? limits.speed_limit_m_per_s : 0.1;
  if (Chance(generator, 0.4)) {
    drives.breakaway_speed_m_per_s = Uniform(generator, 0, 2e-3);
    drives.sliding_loss_m_per_s = Uniform(generator, 0, 1) * drives.breakaway_speed_m_per_s;
  }
  drives.reading_noise_m = OftenZero(generator, 0.4, 2e-5);
  simulation.edge_noise_px = OftenZero(generator, 0.25, 0.5);
  simulation.seed = generator();
}

void DrawLaw(Generator& generator, ServoTrial& trial) {
  ControlLawOptions& law = trial.options.step.law;
  const double mode = Uniform(generator, 0, 1);
  law.mode = mode < 0.4    ? ControlMode::kEdges
             : mode < 0.6  ? ControlMode::kDirections
             : mode < 0.85 ? ControlMode::kPose
                           : ControlMode::kJoints;
  if (Chance(generator, 0.6)) law.pose_source = PoseSource::kEdges;
  if (Chance(generator, 0.5)) law.direction_source = DirectionSource::kEdges;
  law.is_weighted = Chance(generator, 0.7);
  if (Chance(generator, 0.25)) {
    const int count = 3 + OneOf(generator, 3);
    while (static_cast<int>(law.legs.count()) > count)
      law.legs.reset(static_cast<size_t>(OneOf(generator, kLegCount)));
  }
  if (Chance(generator, 0.5)) {
    trial.options.step.gain = AdaptiveGain::Constant(Uniform(generator, 0.5, 4));
  } else {
    const double far_per_s = Uniform(generator, 0.5, 3);
    trial.options.step.gain = {far_per_s + Uniform(generator, 0.5, 3), far_per_s,
                               Uniform(generator, 50, 1000)};
  }
  trial.options.supervision.timeout_s = kTimeout_s;
}

// Short ones are to be ridden out.
void DrawFault(Generator& generator, ServoTrial& trial) {
  if (!Chance(generator, 0.6)) return;
  Fault fault;
  fault.kind = kFaultNames[static_cast<size_t>(OneOf(generator, static_cast<int>(kFaultNames.size())))].first;
  fault.from_s = OftenZero(generator, 0.15, 2.5);
  const double lasting = Uniform(generator, 0, 1);
  if (lasting < 0.25)
    fault.until_s = fault.from_s + Uniform(generator, 0.005, 0.08);
  else if (lasting < 0.4)
    fault.until_s = fault.from_s + Uniform(generator, 0.08, 1);
  fault.leg = OneOf(generator, kLegCount);
  fault.delay_s = Uniform(generator, 0.02, 0.4);
  trial.fault = fault;
  trial.simulation.faults = {fault};
}

}  // namespace

SeenEdges ThroughModel(const SeenEdges& seen, const Camera& truth, const Camera& model) {
  const auto matrix = [](const Camera& camera) {
    Eigen::Matrix3d k;
    k << camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1;
    return k;
  };
  const Eigen::Matrix3d points = matrix(model).inverse() * matrix(truth);
  const Eigen::Matrix3d lines = points.inverse().transpose();
  SeenEdges through = seen;
  for (SeenEdge& edge : through.edges) {
    const Eigen::Vector3d moved = lines * edge.normal;
    edge.normal = moved.normalized();
    const Eigen::Matrix3d derivative =
        (Eigen::Matrix3d::Identity() - edge.normal * edge.normal.transpose()) * lines / moved.norm();
    edge.normal_covariance = derivative * edge.normal_covariance * derivative.transpose();
    for (Eigen::Vector2d& end : edge.ends) end = (points * end.homogeneous()).hnormalized();
  }
  return through;
}

bool ServoTrial::FaultMatters() const {
  if (!fault) return false;
  switch (fault->kind) {
    case FaultKind::kReadingsNan:
    case FaultKind::kReadingsFrozen:
    case FaultKind::kLinkLost:
      return true;
    case FaultKind::kLegCovered:
      return Looks() && options.step.law.legs[static_cast<size_t>(fault->leg)];
    case FaultKind::kFramesDropped:
    case FaultKind::kFramesLate:
    case FaultKind::kFramesFrozen:
      return Looks();
  }
  return true;
}

std::string ServoTrial::Describe() const {
  const ControlLawOptions& law = options.step.law;
  const DriveOptions& drives = simulation.drives;
  std::string text = fmt::format(
      "{} by {}, model error {:.2f}, goal {}, lag {:.0f} ms, friction {:.2f}/{:.2f} mm/s, noise {:.2f} px "
      "{:.0f} um, "
      "gain {:.1f} to {:.1f} 1/s, limit {:.0f} mm/s",
      ToString(law.mode), law.mode == ControlMode::kJoints ? "all legs" : LegList(law.legs), model_error,
      is_goal_in_range ? "in range" : "near or beyond range", 1e3 * drives.lag_s,
      1e3 * drives.breakaway_speed_m_per_s, 1e3 * drives.sliding_loss_m_per_s, simulation.edge_noise_px,
      1e6 * drives.reading_noise_m, options.step.gain.at_infinity_per_s, options.step.gain.at_zero_per_s,
      1e3 * options.step.limits.speed_limit_m_per_s);
  if (fault)
    text += fmt::format(", {} from {:.3f} to {:.3g} s leg {} delay {:.3f} s",
                        kFaultNames[static_cast<size_t>(fault->kind)].second, fault->from_s, fault->until_s,
                        fault->leg + 1, fault->delay_s);
  return text;
}

ServoTrial DrawTrial(std::uint64_t seed, int number) {
  std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                         static_cast<std::uint32_t>(number)};
  Generator generator(sequence);
  ServoTrial trial;
  DrawRig(generator, trial);
  DrawWay(generator, trial);
  DrawDrives(generator, trial);
  DrawLaw(generator, trial);
  DrawFault(generator, trial);
  return trial;
}

}  // namespace legible
