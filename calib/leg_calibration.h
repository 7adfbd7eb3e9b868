// Identifies camera and hexapod from the edges of the legs, joint readings and what is known beforehand.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "calib/base_frame.h"
#include "calib/leg_model.h"
#include "calib/observability.h"
#include "calib/reading_rounds.h"
#include "calib/robust_weights.h"
#include "core/session/session.h"
#include "core/vision/edge_observation.h"
#include "core/vision/tags.h"

namespace legible {

// Where the iterations begin, if not at the drawing: an earlier estimate.
struct CalibrationStart {
  Camera camera;
  GoughStewart robot;
  Rigid3 camera_from_base;
  std::vector<Rigid3> camera_from_platform;  // of each image of the input
};

// Tags that count as observations: a group, with known corners and roughly known place, and what each image
// shows of it.
struct ObservedTagGroup {
  TagGroup group;
  std::vector<std::vector<TagDetection>> detections;  // of each image of the input
};

// What a calibration is given. Images without edges are allowed and ignored. Without a start the poses begin
// at the forward kinematics of the drawing from the readings.
struct LegCalibrationInput {
  GoughStewart drawing;
  Camera camera;            // first guess; its lens model says which coefficients are estimated
  Rigid3 camera_from_base;  // first guess
  std::vector<ImageObservation> images;
  PriorKnowledge known;  // about the values in `drawing` and `camera`
  std::optional<CalibrationStart> start;
  std::vector<ObservedTagGroup> tags = {};  // on the platform: only where it is rigid
  // Views of a board by the same camera, whitened by their own calibration (SolvedProblem in
  // calib/board/board_calibration.h), to be solved together with the legs.
  std::optional<BoardProblem> board = {};
};

// Parameters that keep their first value.
struct HeldParameters {
  bool focal_length = false;
  bool principal_point = false;
  bool distortion = false;
  bool base_joints = false;  // among themselves: where the base stands stays free
  bool camera_pose = false;  // together with base_joints: where the base stands
  bool platform_joints = false;
  bool radii = false;
  bool joint_offsets = false;
};

// By the names that options give them.
using HoldField = bool HeldParameters::*;
inline const std::vector<std::pair<std::string, HoldField>> kHoldFields = {
    {"focal-length", &HeldParameters::focal_length},
    {"principal-point", &HeldParameters::principal_point},
    {"distortion", &HeldParameters::distortion},
    {"base-joints", &HeldParameters::base_joints},
    {"platform-joints", &HeldParameters::platform_joints},
    {"radii", &HeldParameters::radii},
    {"joint-offsets", &HeldParameters::joint_offsets},
};

struct LegCalibrationOptions {
  bool use_joint_readings = true;
  bool rigid_platform = true;  // false: each leg's direction is free in each image; nothing ties the legs
  // Shading that is the same in all images, relative to an edge's common_sigma_px: a shift and a tilt of each
  // leg's edges that no residual shows (radius and joints take them up) but the uncertainty must.
  double lasting_shading = 1;
  HeldParameters hold;
  double default_joint_reading_sigma_m = 1e-4;  // where nothing is known of the readings' noise
  int max_iterations = 50;                      // of each least-squares solve
  int threads = 2;
  std::function<void(int iteration, double rms_px)> progress;

  void Check() const;  // throws std::invalid_argument
};

enum class CalibrationStatus {
  kConverged,
  kUnobservable,        // the data leave something open: see `observability`
  kNotConverged,        // the iterations ended elsewhere than in a minimum, or the minimum is absurd
  kTooFewObservations,  // fewer residuals than unknowns
};
const char* ToString(CalibrationStatus status);

// What became of a tag group that counted as observation.
struct TagGroupFit {
  std::string group;
  Rigid3 carrier_from_group;  // as found; tags.yaml's place is one of the observations
  double placement_sigmas =
      0;                  // root mean square of its six differences from tags.yaml, in their sigmas there
  int tags = 0;           // seen; on the base once for all images
  int tags_left_out = 0;  // of these, without weight
  double rms_px = 0;      // of the corners' distances, weighted
};

struct LegCalibration {
  CalibrationStatus status = CalibrationStatus::kNotConverged;
  std::string message;  // why, in a sentence, where the status is not kConverged
  Camera camera;
  Rigid3 camera_from_base;  // base: the rigid fit of A to the drawing
  GoughStewart robot;       // A in base, B in platform (the rigid fit of B to the drawing)
  LegPoints base_joints_in_camera_m;
  LegPoints drawn_base_joints_m;                      // that the base frame is fitted by
  bool base_joints_held = false;                      // among themselves, at the drawing
  std::vector<Rigid3> camera_from_platform;           // by image; the first guess where it is not rigid
  std::array<Eigen::Vector4d, kLegCount> shading_px;  // lasting: shift and tilt of edge 1, of edge 2
  Observability observability;                        // covariance of the shared parameters, A in camera
  EdgeNoise noise;  // what the residuals say of the samples' own sigmas, over all edges
  NoiseByEdge noise_by_edge;
  double edge_sigma_px = 0;    // root mean square over the samples of what `noise` says of one sample
  double rms_px = 0;           // weighted, of all samples' distances
  double reading_rms = 0;      // of the reading residuals in their sigmas, weighted; 0 without readings
  double reading_scatter = 0;  // about what each image alone predicts: see ReadingRounds::Scatter
  std::vector<OutlyingReading> outlying_readings;
  std::vector<EdgeResidualSet> edges;  // residual and weight of every sample
  std::vector<TagGroupFit> tags;       // of each group of the input; only where converged
  double tag_sigma_px = 0;  // of a coordinate of a corner in the median, as residuals show; 0 without tags
  int samples = 0;
  int iterations = 0;
  bool weights_steady = true;  // false: noise and weights still changed when the rounds were used up
  double covariance_s = 0;     // time that the observability took

  bool ReadingsCountIn(size_t image) const;  // of the input: its readings are none of the outlying ones
  // By what factor the edges lie farther from the model than their own sigmas say; at most about 1 where
  // model and sigmas are right.
  double Misfit() const;
};

// Maximum-likelihood estimate with outliers taken out by re-weighting and the noise re-estimated from the
// residuals. Throws std::invalid_argument on malformed input; every numerical outcome is in the status.
LegCalibration CalibrateLegs(const LegCalibrationInput& input, const LegCalibrationOptions& options);

}  // namespace legible
