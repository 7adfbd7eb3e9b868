#include <fmt/format.h>
#include <fmt/ranges.h>

#include "datasets/camera_formats/camera_readers.h"
#include "datasets/camera_formats/plausible_camera.h"
#include "datasets/input_error.h"
#include "datasets/yaml_value.h"

namespace legible {
namespace {

// The one camera of a chain, or of a file that holds a camera without a chain about it.
YamlValue TheCamera(const std::filesystem::path& file, const YamlValue& root) {
  if (root.Find("camera_model")) return root;
  std::vector<std::string> names;
  std::optional<YamlValue> camera;
  for (const auto& [name, value] : root.Entries()) {
    if (!value.IsMap() || !value.Find("camera_model")) continue;
    names.push_back(name);
    camera = value;
  }
  if (names.size() != 1)
    throw InputError(
        file, 0, fmt::format("is Kalibr's, and holds {} cameras ({})", names.size(), fmt::join(names, ", ")),
        "keep the one that is meant");
  return *camera;
}

LensModel LensOf(const YamlValue& model) {
  const std::string name = model.Text();
  if (name == "none") return LensModel::kPinhole;
  if (name == "radtan") return LensModel::kBrownConrady;
  if (name == "equidistant") return LensModel::kFisheye;
  model.Fail(fmt::format("is \"{}\", a lens model not known here", name),
             "calibrate with pinhole-radtan or pinhole-equi");
}

}  // namespace

CameraFile ReadKalibrCamera(const std::filesystem::path& file, const std::string& text) {
  const YamlValue section = TheCamera(file, YamlValue::Parse(file, text));
  const YamlValue model = section.Get("camera_model");
  if (model.Text() != "pinhole")
    model.Fail(fmt::format("is \"{}\", a camera model not known here", model.Text()),
               "calibrate with pinhole-radtan or pinhole-equi");
  const std::vector<YamlValue> resolution = section.Get("resolution").List(2);
  const YamlValue intrinsics = section.Get("intrinsics");
  const std::vector<double> k = intrinsics.Numbers(4);
  Camera camera{resolution[0].PositiveInteger(),
                resolution[1].PositiveInteger(),
                k[0],
                k[1],
                k[2],
                k[3],
                LensOf(section.Get("distortion_model")),
                Distortion::Zero()};
  if (const auto wrong = WhatIsImplausible(camera)) intrinsics.Fail(wrong->what_is_wrong, wrong->what_to_do);
  if (camera.lens != LensModel::kPinhole) {
    const std::vector<double> coefficients = section.Get("distortion_coeffs").Numbers(4);
    std::copy(coefficients.begin(), coefficients.end(), camera.distortion.begin());
  }
  return {camera, std::nullopt};
}

}  // namespace legible
