#include "apps/rig_opening.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "core/rig/scene_camera.h"
#include "datasets/input_error.h"
#include "datasets/simulation_file.h"

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

OpenedRig OpenSimulatedRig(const std::filesystem::path& truth_file) {
  const SimulatedTruth truth = ReadTruth(truth_file);
  OpenedRig opened;
  try {
    auto rig = std::make_unique<SimulatedRig>(truth.truth, truth.options, PicturesOf(truth));
    opened.simulation = {truth_file, rig.get()};
    opened.rig = std::move(rig);
  } catch (const std::invalid_argument& error) {
    throw InputError(truth_file, 0, "is no rig that can be simulated", error.what());
  }
  opened.width_px = truth.truth.camera.width_px;
  opened.height_px = truth.truth.camera.height_px;
  opened.drawing_robot = truth.drawing_robot;
  opened.drawing_camera = truth.drawing_camera;
  opened.reading_sigma_m = ReadingSigma(truth.options.drives);
  return opened;
}

}  // namespace

OpenedRig OpenRig(const std::string& name) {
  constexpr std::string_view kSimulated = "sim:";
  if (name.starts_with(kSimulated)) return OpenSimulatedRig(name.substr(kSimulated.size()));
  throw InputError(name, 0, "is no rig that is known here", "give sim:TRUTH, TRUTH a model.yaml");
}

void DemandSameImageSize(const std::filesystem::path& file, const Camera& camera, const OpenedRig& rig) {
  if (camera.width_px == rig.width_px && camera.height_px == rig.height_px) return;
  throw InputError(file, 0,
                   fmt::format("has a camera of {} x {} px, and the rig one of {} x {}", camera.width_px,
                               camera.height_px, rig.width_px, rig.height_px),
                   "give the file of this rig's camera");
}

}  // namespace legible
