#include "tests/testing/delta_lab.h"

#include <Eigen/QR>
#include <cmath>
#include <stdexcept>

#include "core/rig/simulated_edges.h"

namespace legible {

Camera DeltaLabCamera() {
  Camera camera;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.fx_px = camera.fy_px = 640;
  camera.cx_px = 319.5;
  camera.cy_px = 239.5;
  return camera;
}

Rigid3 DeltaLabCameraFromBase() {
  constexpr double kDistance_m = 0.70, kHeight_m = 0.15;
  return LookAt({std::sqrt(kDistance_m * kDistance_m - kHeight_m * kHeight_m), 0, kHeight_m}, {0, 0, 0.13});
}

SimulationTruth DeltaLab() { return {DesktopHexapod(), DeltaLabCamera(), DeltaLabCameraFromBase()}; }

Vector6d DeltaLabStart() { return Vector6d::Constant(0.375); }

Vector6d DeltaLabGoal() {
  Vector6d readings_m = DeltaLabStart();
  readings_m[2] += 0.1;
  readings_m[5] += 0.1;
  return readings_m;
}

Rigid3 PoseAt(const GoughStewart& robot, const Vector6d& joint_readings_m) {
  const auto found = ForwardKinematics(robot, joint_readings_m, robot.home);
  if (found.status != ForwardKinematicsStatus::kConverged)
    throw std::runtime_error("PoseAt: these joint readings lead to no pose");
  return found.base_from_platform;
}

SeenEdges ShownAt(const SimulationTruth& truth, const Camera& model_camera, const Rigid3& base_from_platform,
                  SimulationOptions simulation) {
  simulation.start = base_from_platform;
  simulation.seed += std::uint64_t{1} << 32;
  SimulatedRig rig(truth, simulation);
  return SimulatedEdges(rig, model_camera).See({});
}

LabRun RunInLab(const LabServo& servo) {
  SimulatedRig rig(servo.truth, servo.simulation);
  SimulatedEdges source(rig, servo.model.camera);
  ServoController controller(servo.model, servo.goal, servo.options);
  ServoLoopOptions loop;
  loop.period_s = servo.simulation.period_s;
  LabRun run;
  run.run = RunServo(rig, source, controller, loop, [&](const ServoCycle& cycle) {
    const LawResult& law = cycle.output.step.law;
    run.moments.push_back({cycle.input.time_s, law.edge_error_px, law.direction_error_rad, cycle.input.seen,
                           rig.true_motion().base_from_platform});
  });
  run.true_end = rig.true_motion().base_from_platform;
  return run;
}

ControlLawOptions PaperLaw(ControlMode mode) {
  ControlLawOptions law;
  law.mode = mode;
  law.direction_source = DirectionSource::kEdges;
  law.is_weighted = false;
  law.most_motion_sigma = 1e3;  // the paper asks for no certainty
  law.least_conditioning = 0;
  return law;
}

LabServo PerfectServo(ControlMode mode, double duration_s) {
  LabServo servo;
  servo.truth = DeltaLab();
  servo.model = MakeServoModel(servo.truth.robot, servo.truth.camera, servo.truth.camera_from_base);
  servo.true_goal = PoseAt(servo.truth.robot, DeltaLabGoal());
  servo.goal = GoalAtPose(servo.model, servo.true_goal);
  servo.simulation.start = PoseAt(servo.truth.robot, DeltaLabStart());
  servo.simulation.edge_noise_px = 0;
  DriveOptions& drives = servo.simulation.drives;
  drives.lag_s = drives.reading_step_m = 0;
  drives.speed_limit_m_per_s = 1;
  servo.options.step.law = PaperLaw(mode);
  servo.options.step.gain = AdaptiveGain::Constant(1);
  servo.options.step.limits.speed_limit_m_per_s = 1;
  servo.options.supervision.tolerance = 1e-12;
  servo.options.supervision.timeout_s = duration_s;
  return servo;
}

Decay FitDecay(const LabRun& run, double LabMoment::*error, double from_s, double until_s) {
  std::vector<const LabMoment*> stretch;
  for (const LabMoment& moment : run.moments)
    if (moment.time_s >= from_s && moment.time_s <= until_s) stretch.push_back(&moment);
  const auto count = static_cast<Eigen::Index>(stretch.size());
  Eigen::MatrixX2d design(count, 2);
  Eigen::VectorXd logs(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const LabMoment& moment = *stretch[static_cast<size_t>(i)];
    design.row(i) << 1, -moment.time_s;
    logs[i] = std::log(moment.*error);
  }
  const Eigen::Vector2d fit = design.colPivHouseholderQr().solve(logs);
  return {fit[1], std::sqrt((design * fit - logs).squaredNorm() / static_cast<double>(count))};
}

}  // namespace legible
