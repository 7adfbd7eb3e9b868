// The edges of a simulated robot without any image: its true outlines, moved by noise.
#pragma once

#include <optional>

#include "core/rig/edge_source.h"
#include "core/rig/simulated_rig.h"
#include "core/vision/predicted_legs.h"

namespace legible {

// Of each edge the longest stretch that nothing hides, unless it is shorter than kShortestSeen_px. Each of
// its ends is moved across the edge by a normal deviate of options.edge_noise_px, in pixels of the
// undistorted image; the line through both is the edge that was seen, and its covariance that of this noise
// to first order. The noise depends on the seed and the frame's number alone. Faults of frames and covered
// legs are those of the rig's images, and so are the stamps.
//
// With a model of the camera they are what its user would make of the same image: the pixels of both ends,
// through the true lens, become sight lines by the model, and normal and covariance follow from these. What a
// wrong distortion leaves between the ends is not looked at; an end that the model's lens has no sight line
// for takes its edge with it.
class SimulatedEdges : public EdgeSource {
 public:
  static constexpr double kShortestSeen_px = 40;
  // Without noise the covariance is that of this noise, px: of rank 2 all the same.
  static constexpr double kLeastNoise_px = 1e-4;

  // The rig must outlive this. Throws std::invalid_argument if its truth, or the model, is no camera.
  explicit SimulatedEdges(SimulatedRig& rig, const std::optional<Camera>& model_camera = std::nullopt);

  // Needs no motion. Throws RigError as the rig's Grab does.
  SeenEdges See(const MotionNow& motion) override;

 private:
  SimulatedRig& rig_;
  std::optional<Camera> model_camera_;
  VisibilityOptions visibility_;
};

}  // namespace legible
