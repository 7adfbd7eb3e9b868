// Measures the edges of the legs in an image, from a prediction of where they are.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/vision/edge_observation.h"
#include "core/vision/gray_image.h"
#include "core/vision/leg_lock.h"
#include "core/vision/predicted_legs.h"

namespace legible {

// How far outward of its prediction an edge lies where it passes its leg's two joints.
struct EndShifts {
  double at_a_px = 0, at_b_px = 0;
};
// By leg and edge; none: where it is predicted.
using EdgeShifts = std::array<std::array<std::optional<EndShifts>, 2>, kLegCount>;

struct LegEdgeOptions {
  VisibilityOptions visibility;
  std::optional<LegLockOptions> lock = LegLockOptions{};  // none: the prediction is good to search_px
  EdgeShifts shifts = {};                                 // known beforehand, instead of a lock
  double search_px = 5;  // how far from the (locked) prediction an edge is looked for
  // Rough places only, to a few tenths of a pixel, and edges that bend from the prediction by up to
  // rough_bend_px (a quarter of that in the middle): what finds the camera while its lens is unknown.
  bool rough_only = false;
  double rough_bend_px = 0;
  bool keeps_rough = false;              // an edge that cannot be measured finely keeps its rough place
  double least_length_px = 40;           // of the visible stretch
  double least_contrast = 15;            // grey levels: below, the shading of dark sides dominates
  double largest_common_sigma_px = 0.1;  // an edge whose place is less certain is left out
  double sample_length_px = 80;          // of edge behind each sample
  std::optional<double> blur_px;  // known blur; otherwise estimated from all edges of the image together

  void Check() const;  // throws std::invalid_argument
};

// An edge as measured, or why it was not.
struct LegEdge {
  int leg = 0;            // 0-based
  int edge = 0;           // 0 or 1
  std::string left_out;   // the reason; empty: measured
  bool in_sight = true;   // enough of it, as predicted: other legs, plates and the image's border leave it
  bool is_rough = false;  // its place is the rough one
  EdgeObservation observation;
  // Outline normal of the line through the samples, in the camera frame, unit, away from the leg.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  // Of `normal`, rank 2: by the samples' own sigmas; what moves all of them alike is the observation's
  // common_sigma_px.
  Eigen::Matrix3d normal_covariance = Eigen::Matrix3d::Zero();
  double contrast = 0;  // grey levels, inside minus outside
  double rms_px = 0;    // of the samples about their line
};

struct LegEdges {
  std::vector<LegEdge> edges;  // twelve: leg 1 edge 1, leg 1 edge 2, leg 2 edge 1, …
  double blur_px = 0;          // standard deviation of the image's blur; 0 if no edge was measured
  double grey_noise = 0;       // standard deviation of a pixel
};

// Finds both edges of each leg: lock on to the legs coarsely, trace each edge roughly, then fit the
// brightness of all pixels in a band along it (FitSimplestModel) with one blur for the image, and from that
// the place of each stretch of sample_length_px. The lens distortion is followed exactly: bands bend with the
// predicted outline.
LegEdges MeasureLegEdges(const GrayImage& image, const LegsInCamera& legs, const Camera& camera,
                         const LegEdgeOptions& options);

// The samples that count as measured.
ImageObservation ToObservation(const std::string& name, const std::optional<Vector6d>& joint_readings_m,
                               const LegEdges& edges);

}  // namespace legible
