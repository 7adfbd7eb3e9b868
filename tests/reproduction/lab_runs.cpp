#include "tests/reproduction/lab_runs.h"

#include "core/rig/simulated_edges.h"

namespace legible {
namespace {

// Both errors at the end as the true model would see them without noise.
LawResult TrueErrors(const LabServo& servo, const Rigid3& end) {
  const SimulationTruth& truth = servo.truth;
  SimulationOptions quiet;
  quiet.edge_noise_px = 0;
  quiet.start = end;
  SimulatedRig rig(truth, quiet);
  const ServoModel model = MakeServoModel(truth.robot, truth.camera, truth.camera_from_base);
  LawInput input;
  input.seen = SimulatedEdges(rig).See({});
  input.joint_readings_m = InverseKinematics(truth.robot, end);
  input.guess_base_from_platform = end;
  return EvaluateLaw(model, GoalAtPose(model, servo.true_goal), input, {});
}

}  // namespace

SimulationOptions RoughRig(double edge_noise_px, std::uint64_t seed) {
  SimulationOptions options;
  options.edge_noise_px = edge_noise_px;
  options.seed = seed;
  options.drives.lag_s = 0.02;
  options.drives.speed_limit_m_per_s = 0.2;
  options.drives.breakaway_speed_m_per_s = 2e-3;
  options.drives.sliding_loss_m_per_s = 1e-3;
  return options;
}

ServoOptions RoughServo(const ControlLawOptions& law) {
  ServoOptions options;
  options.step.law = law;
  options.step.gain = {4, 0.8, 100};
  options.step.limits.speed_limit_m_per_s = 0.2;
  return options;
}

LabServo RoughLabServo(const LabRig& rig, const SimulationTruth& model, const ControlLawOptions& law,
                       GoalKind kind, double edge_noise_px, std::uint64_t seed) {
  LabServo servo;
  servo.truth = rig.truth;
  servo.model = MakeServoModel(model.robot, model.camera, model.camera_from_base);
  servo.simulation = RoughRig(edge_noise_px, seed);
  servo.simulation.start = PoseAt(rig.truth.robot, DeltaLabStart());
  servo.options = RoughServo(law);
  const Rigid3 drawn_goal = PoseAt(DesktopHexapod(), DeltaLabGoal());
  if (kind == GoalKind::kPose) {
    servo.true_goal = InFramesOf(rig.truth.robot, DesktopHexapod(), drawn_goal);
    servo.goal = GoalAtPose(servo.model, drawn_goal);
  } else {
    servo.true_goal = PoseAt(rig.truth.robot, DeltaLabGoal());
    const SeenEdges shown = ShownAt(rig.truth, model.camera, servo.true_goal, servo.simulation);
    servo.goal = GoalFromEdges(servo.model, shown, drawn_goal);
  }
  return servo;
}

LabOutcome OutcomeOf(const LabServo& servo, const LabRun& run) {
  LabOutcome outcome;
  outcome.end = run.run.end;
  outcome.reason = run.run.reason;
  outcome.time_s = run.run.time_s;
  const LawResult errors = TrueErrors(servo, run.true_end);
  outcome.edge_error_px = errors.edge_error_px;
  outcome.direction_error_rad = errors.direction_error_rad;
  const Vector6d off = Displacement(run.true_end, servo.true_goal);
  outcome.position_m = off.head<3>().norm();
  outcome.rotation_rad = off.tail<3>().norm();
  std::vector<Eigen::Vector3d> places_m;
  for (const LabMoment& moment : run.moments) places_m.push_back(moment.true_base_from_platform.translation);
  const PathShape shape = ShapeOfPath(places_m, servo.true_goal.translation);
  outcome.deviation_share = shape.length_m > 0 ? shape.deviation_m / shape.length_m : 0;
  return outcome;
}

}  // namespace legible
