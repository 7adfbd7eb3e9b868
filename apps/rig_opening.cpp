#include "apps/rig_opening.h"

#include <stdexcept>

#include "core/rig/scene_camera.h"
#include "datasets/input_error.h"

namespace legible {

namespace {

// Its scene is built when the first picture is asked for: an image-free run needs none.
PictureSource PicturesOf(const SimulatedTruth& truth) {
  auto camera = std::make_shared<std::unique_ptr<SceneCamera>>();
  return [truth, camera](const Rigid3& base_from_platform, const std::vector<int>& covered_legs,
                         std::uint64_t frame) {
    if (!*camera)
      *camera = std::make_unique<SceneCamera>(truth.truth, truth.options.scene, truth.options.seed);
    return (*camera)->Take(base_from_platform, covered_legs, frame);
  };
}

}  // namespace

OpenedRig OpenRig(const std::string& name) {
  constexpr std::string_view kSimulated = "sim:";
  if (!name.starts_with(kSimulated))
    throw InputError(name, 0, "is no rig that is known here", "give sim:TRUTH, TRUTH a model.yaml");
  OpenedRig opened;
  opened.truth_file = name.substr(kSimulated.size());
  opened.truth = ReadTruth(opened.truth_file);
  const SimulatedTruth& truth = opened.truth;
  try {
    opened.rig = std::make_unique<SimulatedRig>(truth.truth, truth.options, PicturesOf(truth));
  } catch (const std::invalid_argument& error) {
    throw InputError(opened.truth_file, 0, "is no rig that can be simulated", error.what());
  }
  return opened;
}

}  // namespace legible
