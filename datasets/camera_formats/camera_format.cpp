#include "datasets/camera_formats/camera_format.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "datasets/text.h"

namespace legible {
namespace {

bool Holds(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

// From the first line on that is neither empty nor a comment.
std::string_view WithoutLeadingComments(std::string_view text) {
  for (;;) {
    text = Trimmed(text);
    if (text.empty() || text.front() != '#') return text;
    const size_t end = text.find('\n');
    text = end == std::string_view::npos ? std::string_view() : text.substr(end);
  }
}

bool IsOpenCvMatrix(const YAML::Node& node) {
  return node.Tag().find("opencv-matrix") != std::string::npos;  // the tag's prefix is the parser's
}

// By the keys: the same words in a comment say nothing.
CameraFormat RecogniseYaml(const YAML::Node& root) {
  if (!root.IsMap()) return CameraFormat::kRos;
  const auto any_value = [&](const auto& is_such) {
    return std::any_of(root.begin(), root.end(), [&](const auto& entry) { return is_such(entry.second); });
  };
  if (any_value(IsOpenCvMatrix)) return CameraFormat::kOpenCv;
  const auto is_kalibrs = [](const YAML::Node& node) { return node.IsMap() && node["camera_model"]; };
  return is_kalibrs(root) || any_value(is_kalibrs) ? CameraFormat::kKalibr : CameraFormat::kRos;
}

}  // namespace

CameraFormat RecogniseCameraFormat(std::string_view text) {
  const std::string_view body = WithoutLeadingComments(text);
  if (body.starts_with('<'))
    return Holds(body, "<opencv_storage") ? CameraFormat::kOpenCv : CameraFormat::kVisp;
  if (body.starts_with('{') && (Holds(body, "LENSMODEL_") || Holds(body, "DISTORTION_")))
    return CameraFormat::kMrcal;
  if (body.starts_with("%YAML")) return CameraFormat::kOpenCv;
  try {
    return RecogniseYaml(YAML::Load(std::string(text)));
  } catch (const YAML::Exception&) {
    return CameraFormat::kRos;
  }
}

const char* NameOf(CameraFormat format) {
  switch (format) {
    case CameraFormat::kRos:
      return "ROS camera_info YAML";
    case CameraFormat::kOpenCv:
      return "OpenCV's FileStorage";
    case CameraFormat::kKalibr:
      return "Kalibr's camchain";
    case CameraFormat::kVisp:
      return "ViSP's XML";
    case CameraFormat::kMrcal:
      return "mrcal's cameramodel";
  }
  return "";
}

}  // namespace legible
