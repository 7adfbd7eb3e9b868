#include <fmt/format.h>

#include <algorithm>

#include "core/geometry/rigid3.h"
#include "datasets/camera_formats/camera_readers.h"
#include "datasets/camera_formats/plausible_camera.h"
#include "datasets/input_error.h"
#include "datasets/yaml_value.h"

namespace legible {
namespace {

// A Python literal of the kinds that mrcal writes as YAML: tuples become lists, and bytes, the inputs of
// mrcal's optimisation, become empty. Lines keep their numbers.
std::string AsYaml(const std::string& python) {
  std::string yaml;
  char quote = 0;
  bool is_bytes = false, is_comment = false;
  for (size_t i = 0; i < python.size(); ++i) {
    const char c = python[i];
    if (quote != 0) {
      if (!is_bytes || c == '\n' || c == quote) yaml += c;
      if (c == quote) quote = 0;
    } else if (is_comment || c == '#') {
      is_comment = c != '\n';
      if (!is_comment) yaml += c;
    } else if (c == '\'' || c == '"') {
      is_bytes = !yaml.empty() && yaml.back() == 'b';
      if (is_bytes) yaml.pop_back();
      quote = c;
      yaml += c;
    } else {
      yaml += c == '(' ? '[' : c == ')' ? ']' : c;
    }
  }
  return yaml;
}

// The name without what older versions put before it.
std::string LensNameOf(const YamlValue& model) {
  const std::string name = model.Text();
  const size_t prefix = name.find('_');
  return prefix == std::string::npos ? name : name.substr(prefix + 1);
}

struct MrcalLens {
  LensModel lens;
  size_t coefficients;
};

MrcalLens LensOf(const YamlValue& model) {
  const std::string name = LensNameOf(model);
  if (name == "PINHOLE") return {LensModel::kPinhole, 0};
  if (name == "OPENCV4") return {LensModel::kBrownConrady, 4};
  if (name == "OPENCV5") return {LensModel::kBrownConrady, 5};
  if (name == "OPENCV8") return {LensModel::kRational, 8};
  model.Fail(fmt::format("is \"{}\", a lens model not known here", model.Text()),
             "convert it with `mrcal-convert-lensmodel LENSMODEL_OPENCV8`");
}

YamlValue GetOneOf(const YamlValue& root, std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (const auto value = root.Find(name)) return *value;
  return root.Get(*names.begin());
}

// A rotation vector and a translation, of the camera from mrcal's reference frame; all 0 where none is known.
// What the reference is, mrcal leaves to its user: of cameras that were calibrated together the first one.
void ReadPlace(const std::filesystem::path& file, const YamlValue& root, CameraFile& camera) {
  const std::vector<double> rt = GetOneOf(root, {"extrinsics", "rt_cam_ref"}).Numbers(6);
  if (std::all_of(rt.begin(), rt.end(), [](double x) { return x == 0; })) return;
  camera.camera_from_base = Rigid3{RotationFromVector({rt[0], rt[1], rt[2]}), {rt[3], rt[4], rt[5]}};
  camera.warnings.push_back(fmt::format(
      "{}: its extrinsics are taken for camera_from_base, mrcal's reference frame for the robot's "
      "base; where the reference is another camera, set them to 0",
      file.string()));
}

}  // namespace

CameraFile ReadMrcalCamera(const std::filesystem::path& file, const std::string& text) {
  const YamlValue root = YamlValue::Parse(file, AsYaml(text));
  const YamlValue model = GetOneOf(root, {"lensmodel", "lens_model", "distortion_model"});
  const MrcalLens lens = LensOf(model);
  const std::vector<YamlValue> size = root.Get("imagersize").List(2);
  const YamlValue intrinsics = root.Get("intrinsics");
  const std::vector<double> k = intrinsics.Numbers(4 + lens.coefficients);
  Camera camera{size[0].PositiveInteger(), size[1].PositiveInteger(), k[0], k[1], k[2], k[3], lens.lens,
                Distortion::Zero()};
  if (const auto wrong = WhatIsImplausible(camera)) intrinsics.Fail(wrong->what_is_wrong, wrong->what_to_do);
  std::copy(k.begin() + 4, k.end(), camera.distortion.begin());
  CameraFile result{camera, std::nullopt};
  ReadPlace(file, root, result);
  return result;
}

}  // namespace legible
