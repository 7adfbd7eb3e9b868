// What the camera is expected to see of the legs in a pose that the platform has not been in yet.
#pragma once

#include "core/vision/edge_observation.h"
#include "core/vision/leg_edges.h"

namespace legible {

// The robot and its camera as far as they are known.
struct RigModel {
  GoughStewart robot;
  Camera camera;
  Rigid3 camera_from_base;
};

// How edges will be measured, and how well. The sigmas are the medians over the edges of datasets/hexapod.
struct ExpectedEdgeOptions {
  LegEdgeOptions measured;         // what can be seen, least_length_px, sample_length_px
  double sample_sigma_px = 0.025;  // of each stretch's place
  double common_sigma_px = 0.02;   // of what the samples of an edge share

  void Check() const;  // throws std::invalid_argument
};

// The readings of the pose and the edges of which enough is in sight, as MeasureLegEdges takes samples: one
// in the middle of each stretch of about sample_length_px, none where something hides the edge. Without
// noise.
ImageObservation ExpectObservation(const RigModel& model, const Rigid3& base_from_platform,
                                   const ExpectedEdgeOptions& options);

}  // namespace legible
