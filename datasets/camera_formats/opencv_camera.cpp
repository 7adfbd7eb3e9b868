#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>

#include "datasets/camera_formats/camera_readers.h"
#include "datasets/camera_formats/plausible_camera.h"
#include "datasets/camera_formats/xml_text.h"
#include "datasets/input_error.h"
#include "datasets/text.h"
#include "datasets/yaml_value.h"

namespace legible {
namespace {

// An entry of a FileStorage: a matrix row by row, a list of numbers, or a text.
struct Entry {
  int line = 0;
  std::string text;
  std::vector<double> numbers;
};
using Entries = std::map<std::string, Entry>;

// The names in use, the present one first.
const std::vector<std::string> kMatrixNames = {"camera_matrix", "cameraMatrix", "Camera_Matrix"};
const std::vector<std::string> kDistortionNames = {"distortion_coefficients", "dist_coeffs", "distCoeffs",
                                                   "Distortion_Coefficients", "distortionMatrix"};
const std::vector<std::string> kWidthNames = {"image_width", "image_Width"};
const std::vector<std::string> kHeightNames = {"image_height", "image_Height"};
const std::vector<std::string> kSizeNames = {"cameraResolution"};

bool IsOfInterest(const std::string& name) {
  for (const auto* names : {&kMatrixNames, &kDistortionNames, &kWidthNames, &kHeightNames, &kSizeNames})
    if (std::find(names->begin(), names->end(), name) != names->end()) return true;
  return name == "fisheye_model" || name == "calibrationModel";
}

// --- YAML and XML to entries. ----------------------------------------------------------------------------

// yaml-cpp knows no "%YAML:1.0", which OpenCV writes instead of "%YAML 1.0"; the line stays, so that the
// others keep their numbers.
std::string AsYaml(std::string text) {
  if (const size_t at = text.find("%YAML:"); at == 0) text.replace(0, text.find('\n'), "#");
  return text;
}

Entry EntryOf(const YamlValue& value) {
  Entry entry{value.Line(), "", {}};
  if (value.IsMap())
    entry.numbers = value.Get("data").Numbers();
  else if (value.IsList())
    entry.numbers = value.Numbers();
  else if (!value.IsNull())
    entry.text = value.Text();
  return entry;
}

Entries EntriesOfYaml(const std::filesystem::path& file, const std::string& text) {
  Entries entries;
  for (const auto& [name, value] : YamlValue::Parse(file, AsYaml(text)).Entries())
    if (IsOfInterest(name)) entries[name] = EntryOf(value);
  return entries;
}

std::vector<double> NumbersIn(const XmlText& xml, const pugi::xml_node& node) {
  std::vector<double> numbers;
  for (std::string_view rest = Trimmed(node.text().get()); !rest.empty(); rest = Trimmed(rest)) {
    const std::string_view word = rest.substr(0, rest.find_first_of(" \t\r\n"));
    const std::optional<double> number = ParseFinite(word);
    if (!number) xml.Fail(node, fmt::format("holds \"{}\", not a finite number", word), "give numbers");
    numbers.push_back(*number);
    rest.remove_prefix(word.size());
  }
  return numbers;
}

Entries EntriesOfXml(const std::filesystem::path& file, const std::string& text) {
  const XmlText xml(file, text);
  Entries entries;
  for (const pugi::xml_node& node : xml.Root().children()) {
    if (!IsOfInterest(node.name())) continue;
    Entry& entry = entries[node.name()] = {xml.LineOf(node), std::string(Trimmed(node.text().get())), {}};
    if (const pugi::xml_node data = node.child("data"))
      entry.numbers = NumbersIn(xml, data);
    else if (entry.text.find(' ') != std::string::npos)
      entry.numbers = NumbersIn(xml, node);
  }
  return entries;
}

// --- Entries to a camera. --------------------------------------------------------------------------------

class CameraOfEntries {
 public:
  CameraOfEntries(const std::filesystem::path& file, Entries entries)
      : file_(file), entries_(std::move(entries)) {}

  CameraFile Read() const {
    Camera camera;
    ReadSize(camera);
    ReadMatrix(camera);
    ReadDistortion(camera);
    return {camera, std::nullopt};
  }

 private:
  const Entry* Find(const std::vector<std::string>& names) const {
    for (const std::string& name : names)
      if (const auto found = entries_.find(name); found != entries_.end()) return &found->second;
    return nullptr;
  }
  const Entry& Get(const std::vector<std::string>& names) const {
    const Entry* entry = Find(names);
    if (entry == nullptr)
      throw InputError(file_, 0, fmt::format("is OpenCV's, and has no \"{}\"", fmt::join(names, "\" or \"")),
                       "add it, or name another file");
    return *entry;
  }
  [[noreturn]] void Fail(const Entry& entry, const std::string& what_is_wrong,
                         const std::string& what_to_do) const {
    throw InputError(file_, entry.line, what_is_wrong, what_to_do);
  }

  int Size(const std::vector<std::string>& names) const {
    const Entry& entry = Get(names);
    const std::optional<int> size = ParseInteger(entry.text);
    if (!size || *size < 1)
      Fail(entry, fmt::format("{} is \"{}\"", names.front(), entry.text), "give a whole number of pixels");
    return *size;
  }

  void ReadSize(Camera& camera) const {
    const Entry* resolution = Find(kSizeNames);
    if (resolution == nullptr) {
      camera.width_px = Size(kWidthNames);
      camera.height_px = Size(kHeightNames);
      return;
    }
    const std::vector<double>& size = resolution->numbers;
    if (size.size() != 2 || size[0] < 1 || size[1] < 1 || size[0] > 1e6 || size[1] > 1e6)
      Fail(*resolution, "cameraResolution is not [width, height]", "give both in pixels");
    camera.width_px = static_cast<int>(size[0]);
    camera.height_px = static_cast<int>(size[1]);
  }

  void ReadMatrix(Camera& camera) const {
    const Entry& entry = Get(kMatrixNames);
    const std::vector<double>& k = entry.numbers;
    if (k.size() != 9)
      Fail(entry, fmt::format("camera_matrix has {} values", k.size()), "give the 9 of a 3 x 3 matrix");
    if (k[1] != 0 || k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1)
      Fail(entry, "camera_matrix is not of the form [fx, 0, cx, 0, fy, cy, 0, 0, 1]",
           "give one without skew");
    camera.fx_px = k[0];
    camera.fy_px = k[4];
    camera.cx_px = k[2];
    camera.cy_px = k[5];
    if (const auto wrong = WhatIsImplausible(camera))
      Fail(entry, "camera_matrix " + wrong->what_is_wrong, wrong->what_to_do);
  }

  bool IsFisheye() const {
    const Entry *flag = Find({"fisheye_model"}), *model = Find({"calibrationModel"});
    if (model != nullptr && model->text == "omni")
      Fail(*model, "calibrationModel is omni, a lens model not known here",
           "calibrate with pinhole or fisheye");
    return (flag != nullptr && flag->text != "0") || (model != nullptr && model->text == "fisheye");
  }

  void ReadDistortion(Camera& camera) const {
    camera.lens = LensModel::kPinhole;
    const Entry* entry = Find(kDistortionNames);
    const bool is_fisheye = IsFisheye();
    if (entry == nullptr && !is_fisheye) return;
    const std::vector<double>& k = Get(kDistortionNames).numbers;
    camera.lens = LensOf(*entry, is_fisheye);
    std::copy_n(k.begin(), std::min<size_t>(k.size(), 8), camera.distortion.begin());
  }

  LensModel LensOf(const Entry& entry, bool is_fisheye) const {
    const size_t count = entry.numbers.size();
    if (is_fisheye) {
      if (count != 4)
        Fail(entry, fmt::format("distortion_coefficients has {} values, and a fisheye has 4", count),
             "give 4");
      return LensModel::kFisheye;
    }
    if (count == 12 || count == 14) {
      if (std::any_of(entry.numbers.begin() + 8, entry.numbers.end(), [](double k) { return k != 0; }))
        Fail(entry,
             "distortion_coefficients has the thin prism or the tilted sensor of OpenCV, not known here",
             "calibrate with at most 8 coefficients");
      return LensModel::kRational;
    }
    if (count == 0) return LensModel::kPinhole;
    if (count == 4 || count == 5) return LensModel::kBrownConrady;
    if (count != 8)
      Fail(entry, fmt::format("distortion_coefficients has {} values", count), "give 4, 5 or 8");
    return LensModel::kRational;
  }

  std::filesystem::path file_;
  Entries entries_;
};

}  // namespace

CameraFile ReadOpenCvCamera(const std::filesystem::path& file, const std::string& text) {
  const bool is_xml = Trimmed(text).starts_with('<');
  return CameraOfEntries(file, is_xml ? EntriesOfXml(file, text) : EntriesOfYaml(file, text)).Read();
}

}  // namespace legible
