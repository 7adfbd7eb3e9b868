// The straight edge through its measured samples, robustly, through any lens.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/geometry/camera.h"
#include "core/vision/edge_observation.h"

namespace legible {

struct EdgeLine {
  Eigen::Vector3d normal;                                       // outline normal
  Eigen::Matrix3d normal_covariance = Eigen::Matrix3d::Zero();  // rank 2
  std::vector<EdgeSample> samples;                              // those that do not stand out from the line
  double rms_px = 0;                                            // of them about it
};

// From a start of the normal; fewer than two samples leave it there.
EdgeLine FitEdgeLine(const Camera& camera, const Eigen::Vector3d& start_normal,
                     const std::vector<EdgeSample>& samples);

}  // namespace legible
