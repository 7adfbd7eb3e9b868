#include "tests/reproduction/lab_runs.h"

#include <algorithm>
#include <stdexcept>

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

SimulationOptions RoughRig(const LabCase& lab_case, std::uint64_t seed) {
  SimulationOptions options;
  options.edge_noise_px = lab_case.edge_noise_px;
  options.seed = seed;
  options.drives.lag_s = 0.02;
  options.drives.speed_limit_m_per_s = 0.2;
  if (!lab_case.has_friction) return options;
  options.drives.breakaway_speed_m_per_s = 2e-3;
  options.drives.sliding_loss_m_per_s = 1e-3;
  return options;
}

ServoOptions RoughServo(const LabCase& lab_case) {
  ServoOptions options;
  options.step.law = lab_case.law;
  options.step.gain = {4, 0.8, 100};
  options.step.limits.speed_limit_m_per_s = 0.2;
  if (lab_case.unsupervised_s > 0) {
    options.supervision.tolerance = 1e-12;
    options.supervision.stall_s = 2 * lab_case.unsupervised_s;
    options.supervision.unanswered_m = 1;
    options.supervision.growth_factor = 1e6;
    options.supervision.timeout_s = lab_case.unsupervised_s;
  }
  return options;
}

// After which the platform's origin stays within a twentieth of its first distance from where it came to
// rest.
double SettlingTime_s(const LabRun& run) {
  const auto distance_m = [&](const LabMoment& moment) {
    return (moment.true_base_from_platform.translation - run.true_end.translation).norm();
  };
  const double near_m = 0.05 * distance_m(run.moments.front());
  const auto last_far = std::find_if(run.moments.rbegin(), run.moments.rend(),
                                     [&](const LabMoment& moment) { return distance_m(moment) > near_m; });
  return last_far == run.moments.rend() ? 0 : last_far->time_s;
}

}  // namespace

LabServo RoughLabServo(const LabRig& rig, const SimulationTruth& model, const LabCase& lab_case,
                       std::uint64_t seed) {
  LabServo servo;
  servo.truth = rig.truth;
  servo.model = MakeServoModel(model.robot, model.camera, model.camera_from_base);
  servo.simulation = RoughRig(lab_case, seed);
  servo.simulation.start = PoseAt(rig.truth.robot, DeltaLabStart());
  servo.options = RoughServo(lab_case);
  const Rigid3 drawn_goal = PoseAt(DesktopHexapod(), DeltaLabGoal());
  if (lab_case.goal == GoalKind::kPose) {
    servo.true_goal = InFramesOf(rig.truth.robot, DesktopHexapod(), drawn_goal);
    servo.goal = GoalAtPose(servo.model, drawn_goal);
  } else {
    servo.true_goal = PoseAt(rig.truth.robot, DeltaLabGoal());
    SimulationOptions camera = servo.simulation;
    camera.edge_noise_px = lab_case.goal_noise_px;
    servo.goal =
        GoalFromEdges(servo.model, ShownAt(rig.truth, model.camera, servo.true_goal, camera), drawn_goal);
  }
  return servo;
}

LabOutcome OutcomeOf(const LabServo& servo, const LabRun& run) {
  LabOutcome outcome;
  outcome.end = run.run.end;
  outcome.reason = run.run.reason;
  outcome.time_s = run.run.time_s;
  outcome.settled_s = SettlingTime_s(run);
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

LabOutcome RunCase(const LabServo& servo) {
  try {
    DemandGoal(servo.goal, servo.options.step.law);
  } catch (const std::invalid_argument& refusal) {
    LabOutcome outcome;
    outcome.reason = refusal.what();
    return outcome;
  }
  return OutcomeOf(servo, RunInLab(servo));
}

}  // namespace legible
