// The set-up of Andreff, Dallej and Martinet 2007, section 4, and servos in it: a DeltaLab hexapod whose
// front pair of legs (1 and 2) faces a camera 0.70 m from the base centre; from equal legs to the two in the
// back (3 and 6) longer by 100 mm.
//
// The paper says neither the sensor nor how high the camera stands. Taken here: a 1/3" sensor of 640 x 480
// pixels of 7.5 um, so that 4.8 mm are 640 px; no distortion; 0.15 m above the base, in the symmetry plane.
#pragma once

#include <cstdint>
#include <vector>

#include "core/rig/simulated_rig.h"
#include "datasets/synthetic_session.h"
#include "servo/servo_loop.h"

namespace legible {

Camera DeltaLabCamera();
Rigid3 DeltaLabCameraFromBase();
SimulationTruth DeltaLab();  // as drawn

Vector6d DeltaLabStart();  // joint readings, m
Vector6d DeltaLabGoal();

// Forward kinematics from home; throws std::runtime_error where the readings lead nowhere.
Rigid3 PoseAt(const GoughStewart& robot, const Vector6d& joint_readings_m);

// A servo to be: a rig, and what its law believes of it.
struct LabServo {
  SimulationTruth truth;
  ServoModel model;
  ServoGoal goal;
  Rigid3 true_goal;  // base_from_platform of the true robot
  SimulationOptions simulation;
  ServoOptions options;
};

// What the camera sees of the true robot at the goal in one image, as the model's camera has it: "teach by
// showing". The noise is of another seed than the servo's own.
SeenEdges ShownAt(const SimulationTruth& truth, const Camera& model_camera, const Rigid3& base_from_platform,
                  SimulationOptions simulation);

struct LabMoment {
  double time_s = 0;
  double edge_error_px = 0, direction_error_rad = 0;  // as the law sees them, rms
  SeenEdges seen;
  Rigid3 true_base_from_platform;
};

struct LabRun {
  ServoRun run;
  std::vector<LabMoment> moments;  // of each cycle
  Rigid3 true_end;
};

LabRun RunInLab(const LabServo& servo);

// The law as printed: all edges count alike, and the directions in the interaction matrices are those seen.
ControlLawOptions PaperLaw(ControlMode mode);

// Without noise, lag, friction or errors of the model, a constant gain of 1/s, a period of 20 ms: the paper's
// section 4.2. Nothing ends it but the time.
LabServo PerfectServo(ControlMode mode, double duration_s);

// error = exp(-rate t) times a constant, fitted to the logarithms over a stretch of time.
struct Decay {
  double rate_per_s = 0;
  double rms_log = 0;  // of the logarithm's residuals
};
Decay FitDecay(const LabRun& run, double LabMoment::*error, double from_s, double until_s);

}  // namespace legible
