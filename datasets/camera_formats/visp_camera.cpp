#include <fmt/format.h>

#include <set>
#include <string_view>

#include "datasets/camera_formats/camera_readers.h"
#include "datasets/camera_formats/plausible_camera.h"
#include "datasets/camera_formats/xml_text.h"
#include "datasets/input_error.h"
#include "datasets/text.h"

namespace legible {
namespace {

constexpr char kPinhole[] = "perspectiveProjWithoutDistortion";
constexpr char kRadial[] = "perspectiveProjWithDistortion";
constexpr char kFisheye[] = "ProjWithKannalaBrandtDistortion";

std::string_view TypeOf(const pugi::xml_node& model) { return Trimmed(model.child("type").text().get()); }

int SizeIn(const XmlText& xml, const pugi::xml_node& camera, const char* name) {
  const pugi::xml_node node = xml.Get(camera, name);
  const std::optional<int> size = ParseInteger(Trimmed(node.text().get()));
  if (!size || *size < 1)
    xml.Fail(node, fmt::format("is \"{}\"", node.text().get()), "give the size of the image in pixels");
  return *size;
}

// ViSP keeps the models of a camera in one <camera> or several; more cameras or sizes than one leave open
// which is meant.
void DemandOneCamera(const XmlText& xml) {
  std::set<std::string> seen;
  for (const pugi::xml_node& camera : xml.Root().children("camera")) {
    seen.insert(fmt::format("{} of {} x {} px", Trimmed(camera.child("name").text().get()),
                            Trimmed(camera.child("image_width").text().get()),
                            Trimmed(camera.child("image_height").text().get())));
    if (seen.size() > 1)
      xml.Fail(camera, fmt::format("is another camera: {} beside {}", *seen.begin(), *seen.rbegin()),
               "keep the one that is meant");
  }
  if (seen.empty()) xml.Fail(xml.Root(), "holds no <camera>", "name a camera file that is known here");
}

pugi::xml_node ModelOf(const XmlText& xml, const char* type) {
  for (const pugi::xml_node& camera : xml.Root().children("camera"))
    for (const pugi::xml_node& model : camera.children("model"))
      if (TypeOf(model) == type) return model;
  return {};
}

pugi::xml_node BestModel(const XmlText& xml) {
  for (const char* type : {kFisheye, kRadial, kPinhole})
    if (const pugi::xml_node model = ModelOf(xml, type)) return model;
  xml.Fail(xml.Root().child("camera"), "has no model that is known here",
           fmt::format("give a <model> of type {}, {} or {}", kPinhole, kRadial, kFisheye));
}

void ReadLens(const XmlText& xml, const pugi::xml_node& model, Camera& camera) {
  camera.lens = LensModel::kPinhole;
  if (TypeOf(model) == kRadial) {
    camera.lens = LensModel::kBrownConrady;
    camera.distortion[0] = xml.Number(xml.Get(model, "kud"));
  }
  if (TypeOf(model) != kFisheye) return;
  camera.lens = LensModel::kFisheye;
  const char* const names[] = {"k1", "k2", "k3", "k4"};
  for (int i = 0; i < 4; ++i) camera.distortion[i] = xml.Number(xml.Get(model, names[i]));
  const pugi::xml_node fifth = model.child("k5");
  if (fifth && xml.Number(fifth) != 0)
    xml.Fail(fifth, "is not 0, and ViSP's projection takes no fifth coefficient", "give one with four");
}

}  // namespace

CameraFile ReadVispCamera(const std::filesystem::path& file, const std::string& text) {
  const XmlText xml(file, text);
  DemandOneCamera(xml);
  const pugi::xml_node model = BestModel(xml);
  Camera camera;
  camera.width_px = SizeIn(xml, model.parent(), "image_width");
  camera.height_px = SizeIn(xml, model.parent(), "image_height");
  camera.fx_px = xml.Number(xml.Get(model, "px"));
  camera.fy_px = xml.Number(xml.Get(model, "py"));
  camera.cx_px = xml.Number(xml.Get(model, "u0"));
  camera.cy_px = xml.Number(xml.Get(model, "v0"));
  if (const auto wrong = WhatIsImplausible(camera)) xml.Fail(model, wrong->what_is_wrong, wrong->what_to_do);
  ReadLens(xml, model, camera);
  return {camera, std::nullopt};
}

}  // namespace legible
