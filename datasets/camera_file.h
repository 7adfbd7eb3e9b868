// camera.yaml: ROS camera_info YAML, optionally with the camera's place; other tools' camera files in its
// stead.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/camera.h"
#include "core/geometry/rigid3.h"

namespace legible {

class YamlValue;

struct CameraFile {
  Camera camera;
  std::optional<Rigid3> camera_from_base;
  // The inverse covariance of fx fy cx cy and the coefficients of the lens, px, (4 + coefficients) square,
  // positive semi-definite; empty: how well the camera is known is not said.
  Eigen::MatrixXd information = {};
  std::vector<std::string> warnings = {};  // what a user has to know of how the file was understood
};

// Reads any format of CameraFormat, recognised by its content; of those of other tools what their readers say
// (datasets/camera_formats/camera_readers.h). Of ROS camera_info it reads what describes the raw image; of
// the rest, rectification, projection, header and name are passed over. legible's own additions are
// camera_from_base and `information`, the lower triangle of CameraFile's, row by row. distortion_model:
// plumb_bob (5 coefficients), rational_polynomial (8), equidistant (4), none or nothing (0). Throws
// InputError for anything else: unknown keys, skew, binning, a region of interest, a focal length that makes
// no sense for the image size (below 0.2 or above 50 times the width or height).
CameraFile ReadCamera(const std::filesystem::path& file);

// The text of a camera.yaml, which ReadCamera takes back to the same bits. Throws std::invalid_argument if a
// number is not finite.
std::string CameraInfoText(const CameraFile& file);

// Writes so that ReadCamera gives back the same bits and ROS reads it too. Throws InputError if the file
// cannot be written and std::invalid_argument if a number is not finite.
void WriteCamera(const std::filesystem::path& file, const Camera& camera,
                 const std::optional<Rigid3>& camera_from_base = std::nullopt);

// The camera alone as a section of another file.
Camera CameraFromYaml(const YamlValue& section);
std::string CameraToYaml(const Camera& camera);

}  // namespace legible
