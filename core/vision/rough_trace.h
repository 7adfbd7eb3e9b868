// Where an edge runs to a tenth or two of a pixel: the strongest step of each short stretch, and the curve on
// which most of them lie.
#pragma once

#include <optional>
#include <vector>

#include "core/vision/edge_observation.h"
#include "core/vision/gray_image.h"
#include "core/vision/predicted_legs.h"

namespace legible {

struct RoughTraceOptions {
  // How far from the prediction an edge is looked for; into the leg no farther than to its axis.
  double search_px = 5;
  double bend_px = 0;  // by how much it may bend from it (a quarter of that in the middle)
  double step_px = 6;  // between the prediction's points
};

struct RoughTrace {
  double at_a_px = 0, at_b_px = 0;  // of the edge outward from the prediction, at the leg's two ends
  std::vector<EdgeSample> samples;  // the stretches that lie on the curve
  double contrast = 0;              // mean of their steps, grey levels: inside minus outside
};

// Nothing where no straight edge is near the prediction.
std::optional<RoughTrace> TraceRoughly(const GrayImage& image, const PredictedEdge& edge,
                                       const RoughTraceOptions& options);

}  // namespace legible
