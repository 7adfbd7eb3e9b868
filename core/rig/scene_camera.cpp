#include "core/rig/scene_camera.h"

#include <stdexcept>

#include "core/rig/scene_parts.h"
#include "core/rig/scene_renderer.h"

namespace legible {
namespace {

void Demand(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(what);
}

const SimulationTruth& Checked(const SimulationTruth& truth, const SceneOptions& options) {
  Demand(truth.camera.width_px > 0 && truth.camera.height_px > 0,
         "the camera must have a width and a height");
  Demand(truth.camera.fx_px > 0 && truth.camera.fy_px > 0,
         "the camera's focal lengths must be greater than 0");
  Demand(options.blur_px >= 0, "blur_px must be 0 or more");
  Demand(options.noise_grey >= 0, "noise_grey must be 0 or more");
  Demand(options.ambient >= 0 && options.ambient <= 1, "ambient must be 0 to 1");
  Demand(options.light_in_camera.allFinite() && options.light_in_camera.norm() > 0,
         "light_in_camera must be a direction");
  Demand(options.texture_grey >= 0, "texture_grey must be 0 or more");
  return truth;
}

SceneLight LightOf(const SceneOptions& options) {
  const Eigen::Vector3d towards = options.light_in_camera.normalized();
  return {towards.cast<float>(), static_cast<float>(options.ambient)};
}

}  // namespace

class SceneCamera::Scene {
 public:
  Scene(const SimulationTruth& truth, const SceneOptions& options, std::uint64_t seed)
      : truth_(Checked(truth, options)),
        options_(options),
        renderer_(truth.camera, RoomParts(truth, options), BaseParts(truth, options), LightOf(options),
                  options.ground_grey, Blotches(options.texture_grey, Scrambled(seed))),
        noise_(options.noise_grey, seed) {}

  BrightnessImage Render(const Rigid3& base_from_platform, const std::vector<int>& covered_legs) const {
    return Blurred(renderer_.Render(MovingParts(truth_, options_, base_from_platform, covered_legs)),
                   options_.blur_px);
  }
  const PixelNoise& noise() const { return noise_; }

 private:
  SimulationTruth truth_;
  SceneOptions options_;
  SceneRenderer renderer_;
  PixelNoise noise_;
};

SceneCamera::SceneCamera(const SimulationTruth& truth, const SceneOptions& options, std::uint64_t seed)
    : scene_(std::make_unique<Scene>(truth, options, seed)) {}

SceneCamera::~SceneCamera() = default;

GrayImage SceneCamera::Take(const Rigid3& base_from_platform, const std::vector<int>& covered_legs,
                            std::uint64_t frame) const {
  return scene_->noise().Expose(TakeNoiseless(base_from_platform, covered_legs), frame);
}

BrightnessImage SceneCamera::TakeNoiseless(const Rigid3& base_from_platform,
                                           const std::vector<int>& covered_legs) const {
  return scene_->Render(base_from_platform, covered_legs);
}

}  // namespace legible
