// The file formats that hold a camera.
#pragma once

#include <string_view>

namespace legible {

enum class CameraFormat {
  kRos,     // camera_info YAML: our own camera.yaml
  kOpenCv,  // cv::FileStorage, YAML or XML
  kKalibr,  // camchain YAML
  kVisp,    // vpXmlParserCamera's XML
  kMrcal,   // .cameramodel: a Python literal
};

// By the content; what is none of the others counts as ROS YAML, whose reader says what is wrong with it.
CameraFormat RecogniseCameraFormat(std::string_view text);

// As messages name it.
const char* NameOf(CameraFormat format);

}  // namespace legible
