// What a simulated rig is like. The section `simulation` of a model.yaml says it in a file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/camera.h"
#include "core/geometry/rigid3.h"
#include "core/robots/gough_stewart.h"

namespace legible {

// Drives and encoders of the joints.
struct DriveOptions {
  double lag_s = 0.02;               // time constant with which a speed follows its command; 0: at once
  double speed_limit_m_per_s = 0.1;  // a command beyond is cut off, joint by joint
  // Friction, of the lagging speed: a joint at rest begins to move only when that exceeds the breakaway
  // speed; one that moves loses the sliding speed of it, and sticks when nothing is left. Both depend on the
  // configuration: they vary by the share `friction_variation` of themselves with each joint's length, each
  // joint in a phase of its own.
  double breakaway_speed_m_per_s = 0;
  double sliding_loss_m_per_s = 0;  // at most the breakaway speed
  double friction_variation = 0.5;
  double friction_period_m = 0.03;  // of joint length over which the friction varies once
  double reading_step_m = 1e-6;     // quantisation of the readings; 0: none
  double reading_noise_m = 0;       // 1 sigma, before quantisation
};

// σ of a joint reading (m) as a data sheet would state it: noise, and what quantisation adds. Nothing where
// the readings are exact.
std::optional<double> ReadingSigma(const DriveOptions& drives);

// Light, surfaces and sensor of the simulated camera.
struct SceneOptions {
  double blur_px = 0.8;   // standard deviation of the lens's Gaussian; the pixels' own extent is added
  double noise_grey = 2;  // standard deviation of a pixel, grey levels
  double ambient = 0.45;  // share of the light that comes from everywhere
  // Towards the main light, far away; any length: from the camera's right and from above.
  Eigen::Vector3d light_in_camera{1.16, -0.90, -0.70};
  double leg_grey = 230;  // brightness where the light falls perpendicularly
  double plate_grey = 34;
  double joint_grey = 90;
  double ground_grey = 48;
  double texture_grey = 5;  // of the ground: standard deviation of smooth blotches
};

enum class FaultKind {
  kFramesDropped,  // no new image comes
  kFramesLate,     // images come delay_s late
  kFramesFrozen,   // the same image comes again and again with new stamps
  kLegCovered,     // something stands before a leg
  kReadingsNan,
  kReadingsFrozen,  // the same readings again and again with new stamps
  kLinkLost,        // every call fails
};

// "frames-dropped", … as files name them.
inline const std::vector<std::pair<FaultKind, std::string>> kFaultNames = {
    {FaultKind::kFramesDropped, "frames-dropped"}, {FaultKind::kFramesLate, "frames-late"},
    {FaultKind::kFramesFrozen, "frames-frozen"},   {FaultKind::kLegCovered, "leg-covered"},
    {FaultKind::kReadingsNan, "readings-nan"},     {FaultKind::kReadingsFrozen, "readings-frozen"},
    {FaultKind::kLinkLost, "link-lost"},
};

struct Fault {
  FaultKind kind = FaultKind::kFramesDropped;
  double from_s = 0;
  double until_s = 1e9;
  int leg = 0;           // 0-based: of kLegCovered
  double delay_s = 0.2;  // of kFramesLate

  bool IsActiveAt(double time_s) const { return time_s >= from_s && time_s < until_s; }
};

struct SimulationOptions {
  double period_s = 0.02;  // of the camera: it exposes at the multiples of this
  DriveOptions drives;
  SceneOptions scene;
  double edge_noise_px = 0.05;  // image-free: 1 sigma of each end of an edge, across it
  std::vector<Fault> faults;
  std::uint64_t seed = 1;       // of all noise
  std::optional<Rigid3> start;  // base_from_platform in the beginning; none: the robot's home

  void Check() const;  // throws std::invalid_argument that names the field out of its range
};

// A number of an options struct, by the name that files and messages give it, and the bounds that Check
// keeps.
template <typename Options>
struct NumberField {
  std::string name;
  double Options::*value;
  double lowest, highest;
};
inline const std::vector<NumberField<DriveOptions>> kDriveFields = {
    {"lag_s", &DriveOptions::lag_s, 0, 10},
    {"speed_limit_m_per_s", &DriveOptions::speed_limit_m_per_s, 1e-6, 100},
    {"breakaway_speed_m_per_s", &DriveOptions::breakaway_speed_m_per_s, 0, 100},
    {"sliding_loss_m_per_s", &DriveOptions::sliding_loss_m_per_s, 0, 100},
    {"friction_variation", &DriveOptions::friction_variation, 0, 1},
    {"friction_period_m", &DriveOptions::friction_period_m, 1e-4, 100},
    {"reading_step_m", &DriveOptions::reading_step_m, 0, 0.01},
    {"reading_noise_m", &DriveOptions::reading_noise_m, 0, 0.01},
};
inline const std::vector<NumberField<SceneOptions>> kSceneFields = {
    {"blur_px", &SceneOptions::blur_px, 0, 20},
    {"noise_grey", &SceneOptions::noise_grey, 0, 100},
    {"ambient", &SceneOptions::ambient, 0, 1},
    {"leg_grey", &SceneOptions::leg_grey, 0, 255},
    {"plate_grey", &SceneOptions::plate_grey, 0, 255},
    {"joint_grey", &SceneOptions::joint_grey, 0, 255},
    {"ground_grey", &SceneOptions::ground_grey, 0, 255},
    {"texture_grey", &SceneOptions::texture_grey, 0, 100},
};
inline const std::vector<NumberField<Fault>> kFaultFields = {
    {"from_s", &Fault::from_s, 0, 1e9},
    {"until_s", &Fault::until_s, 0, 1e9},
    {"delay_s", &Fault::delay_s, 0, 1e9},
};
inline const std::vector<NumberField<SimulationOptions>> kSimulationFields = {
    {"period_s", &SimulationOptions::period_s, 1e-3, 10},
    {"edge_noise_px", &SimulationOptions::edge_noise_px, 0, 100},
};

// A rig as it really is.
struct SimulationTruth {
  GoughStewart robot;
  Camera camera;
  Rigid3 camera_from_base;
};

}  // namespace legible
