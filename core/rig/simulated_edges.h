// The edges of a simulated robot without any image: its true outlines, moved by noise.
#pragma once

#include "core/rig/edge_source.h"
#include "core/rig/simulated_rig.h"
#include "core/vision/predicted_legs.h"

namespace legible {

// Of each edge the longest stretch that nothing hides, unless it is shorter than kShortestSeen_px. Each of
// its ends is moved across the edge by a normal deviate of options.edge_noise_px, in pixels of the
// undistorted image; the line through both is the edge that was seen, and its covariance that of this noise
// to first order. The noise depends on the seed and the frame's number alone. Faults of frames and covered
// legs are those of the rig's images, and so are the stamps.
class SimulatedEdges : public EdgeSource {
 public:
  static constexpr double kShortestSeen_px = 40;
  // Without noise the covariance is that of this noise, px: of rank 2 all the same.
  static constexpr double kLeastNoise_px = 1e-4;

  // The rig must outlive this. Throws std::invalid_argument if its truth has no camera.
  explicit SimulatedEdges(SimulatedRig& rig);

  // Needs no motion. Throws RigError as the rig's Grab does.
  SeenEdges See(const MotionNow& motion) override;

 private:
  SimulatedRig& rig_;
  VisibilityOptions visibility_;
};

}  // namespace legible
