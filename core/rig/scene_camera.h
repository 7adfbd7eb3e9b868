// The camera of the simulated rig: images of a robot, ray traced through its lens.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/rig/sensor.h"
#include "core/rig/simulation_options.h"
#include "core/vision/gray_image.h"

namespace legible {

// Legs, joints and plates on a ground, in a light of which one part (SceneOptions::ambient) comes from
// everywhere and the rest from far away in one direction, with shadows; matt surfaces (Lambert's law):
//   brightness = grey (ambient + (1 - ambient) max(0, normal . towards_light) [unless in shadow])
// Each pixel is the mean over its extent, the edges of everything through the exact lens model; then comes
// the blur. Where the lens has no image of anything the ground's grey is seen.
//
// Several threads may take images with one camera. Images depend on the arguments and on nothing else, not on
// the number of threads either.
class SceneCamera {
 public:
  // The seed is of the noise and of the ground's blotches. Throws std::invalid_argument where the options or
  // the camera cannot be.
  SceneCamera(const SimulationTruth& truth, const SceneOptions& options, std::uint64_t seed);
  ~SceneCamera();
  SceneCamera(const SceneCamera&) = delete;
  SceneCamera& operator=(const SceneCamera&) = delete;

  // The robot in that pose, a board before each of the covered legs (0-based). The noise is the frame's.
  GrayImage Take(const Rigid3& base_from_platform, const std::vector<int>& covered_legs,
                 std::uint64_t frame) const;

  // The same before noise and rounding.
  BrightnessImage TakeNoiseless(const Rigid3& base_from_platform, const std::vector<int>& covered_legs) const;

 private:
  class Scene;
  std::unique_ptr<const Scene> scene_;
};

}  // namespace legible
