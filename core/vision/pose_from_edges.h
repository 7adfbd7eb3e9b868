// The platform's pose that fits the edges of its legs best, for a known robot and camera.
#pragma once

#include "core/robots/gough_stewart.h"
#include "core/vision/seen_edges.h"

namespace legible {

enum class EdgePoseStatus {
  kConverged,
  kTooFewEdges,   // fewer than six, or they leave a motion of the platform open
  kNotConverged,  // no pose near the guess has such edges
};
const char* ToString(EdgePoseStatus status);

struct EdgePose {
  EdgePoseStatus status = EdgePoseStatus::kNotConverged;
  Rigid3 base_from_platform;  // the last iterate, also where it did not converge
  // Of the displacement (v, omega) in base that leads to it, by the edges' own covariances.
  Matrix6d covariance = Matrix6d::Zero();
  double rms_sigma = 0;  // of the edges' residuals, in their own sigmas
  int iterations = 0;
};

// Minimises the squared differences between the predicted and the seen outline normals, each in the metric of
// its covariance (rank 2; nothing is assumed of what moves several edges alike), by Gauss-Newton from the
// guess. Allocates nothing.
EdgePose FitPoseToEdges(const GoughStewart& robot, const Rigid3& camera_from_base, const SeenEdges& seen,
                        const Rigid3& guess_base_from_platform);

}  // namespace legible
