#include "datasets/camera_file.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <utility>

#include "core/geometry/camera_parameters.h"
#include "datasets/atomic_file.h"
#include "datasets/camera_formats/camera_format.h"
#include "datasets/camera_formats/camera_readers.h"
#include "datasets/camera_formats/plausible_camera.h"
#include "datasets/input_error.h"
#include "datasets/symmetric_yaml.h"
#include "datasets/text.h"
#include "datasets/yaml_value.h"

namespace legible {
namespace {

const std::vector<std::string> kCameraKeys = {"image_width",
                                              "image_height",
                                              "camera_matrix",
                                              "distortion_model",
                                              "distortion_coefficients",
                                              "camera_name",
                                              "header",
                                              "binning_x",
                                              "binning_y",
                                              "roi",
                                              "projection_matrix",
                                              "rectification_matrix"};

// The values of {rows, cols, data}, row by row.
std::vector<double> MatrixFromYaml(const YamlValue& section) {
  section.AllowKeys({"rows", "cols", "data"});
  const int rows = section.Get("rows").Integer();
  const int columns = section.Get("cols").Integer();
  std::vector<double> values = section.Get("data").Numbers();
  if (static_cast<double>(rows) * columns != static_cast<double>(values.size())) {
    section.Fail(fmt::format("has {} values for {} rows and {} cols", values.size(), rows, columns),
                 "give rows times cols values");
  }
  return values;
}

std::string MatrixText(int rows, int columns, const std::vector<double>& values) {
  return fmt::format("{{rows: {}, cols: {}, data: {}}}", rows, columns,
                     ListText(values.data(), values.size()));
}

void ReadIntrinsics(const YamlValue& section, Camera& camera) {
  const std::vector<double> k = MatrixFromYaml(section);
  if (k.size() != 9) section.Fail(fmt::format("has {} values", k.size()), "give the 9 of a 3 x 3 matrix");
  if (k[1] != 0 || k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1) {
    section.Fail("is not of the form [fx, 0, cx, 0, fy, cy, 0, 0, 1]", "give one without skew");
  }
  camera.fx_px = k[0];
  camera.fy_px = k[4];
  camera.cx_px = k[2];
  camera.cy_px = k[5];
  if (const auto wrong = WhatIsImplausible(camera)) section.Fail(wrong->what_is_wrong, wrong->what_to_do);
}

LensModel LensFromYaml(const YamlValue& model) {
  if (model.IsNull()) return LensModel::kPinhole;
  const std::string name = model.Text();
  if (name == "plumb_bob") return LensModel::kBrownConrady;
  if (name == "rational_polynomial") return LensModel::kRational;
  if (name == "equidistant") return LensModel::kFisheye;
  if (!name.empty() && name != "none") {
    model.Fail(fmt::format("is \"{}\", a lens model not known here", name),
               "give plumb_bob, rational_polynomial, equidistant or none");
  }
  return LensModel::kPinhole;
}

std::string RosLensName(LensModel lens) {
  if (lens == LensModel::kRational) return "rational_polynomial";
  if (lens == LensModel::kFisheye) return "equidistant";
  return lens == LensModel::kBrownConrady ? "plumb_bob" : "none";
}

void ReadDistortion(const YamlValue& section, Camera& camera) {
  const YamlValue model = section.Get("distortion_model");
  camera.lens = LensFromYaml(model);
  const std::optional<YamlValue> coefficients = section.Find("distortion_coefficients");
  if (!coefficients && camera.lens == LensModel::kPinhole) return;
  const std::vector<double> values = MatrixFromYaml(section.Get("distortion_coefficients"));
  const size_t count = static_cast<size_t>(camera.lens);
  if (values.size() != count) {
    coefficients->Fail(
        fmt::format("has {} values, and {} has {}", values.size(), RosLensName(camera.lens), count),
        "give as many as the model has, or name another distortion_model");
  }
  std::copy(values.begin(), values.end(), camera.distortion.begin());
  if (const auto wrong = WhatCoefficientIsImplausible(camera))
    coefficients->Fail(wrong->what_is_wrong, wrong->what_to_do);
}

// Binning or a region of interest would shift the pixels: refused rather than passed over.
void RefuseBinning(const YamlValue& section) {
  for (const char* key : {"binning_x", "binning_y"}) {
    const std::optional<YamlValue> binning = section.Find(key);
    if (!binning || binning->Integer() <= 1) continue;
    binning->Fail(fmt::format("is {}", binning->Integer()),
                  "give the camera of the images as they are, unbinned");
  }
}

void RefuseRegion(const YamlValue& region, const Camera& camera) {
  const std::pair<const char*, int> whole_image[] = {
      {"x_offset", 0}, {"y_offset", 0}, {"width", camera.width_px}, {"height", camera.height_px}};
  for (const auto& [key, whole] : whole_image) {
    const std::optional<YamlValue> value = region.Find(key);
    if (!value || value->Integer() == 0 || value->Integer() == whole) continue;
    value->Fail(fmt::format("is {}", value->Integer()),
                "give the camera of the images as they are, without roi");
  }
}

Camera ReadCameraInfo(const YamlValue& section) {
  RefuseBinning(section);
  Camera camera;
  camera.width_px = section.Get("image_width").PositiveInteger();
  camera.height_px = section.Get("image_height").PositiveInteger();
  if (const auto region = section.Find("roi")) RefuseRegion(*region, camera);
  ReadIntrinsics(section.Get("camera_matrix"), camera);
  ReadDistortion(section, camera);
  return camera;
}

// Nothing is known of px and coefficients to the last digits of a number.
void DemandUsableSize(const YamlValue& section, const Eigen::MatrixXd& information, const Camera& camera) {
  constexpr double kLeastSigma = 1e-12;
  for (Eigen::Index i = 0; i < information.rows(); ++i) {
    if (information(i, i) * kLeastSigma * kLeastSigma <= 1) continue;
    section.Fail(fmt::format("has {:g} for {}, which would be known to less than {:g}", information(i, i),
                             CameraParameterName(camera.lens, static_cast<int>(i)), kLeastSigma),
                 "give the inverse covariance in px, or leave it out");
  }
}

// Rounding of a matrix that is singular may leave it a little negative.
Eigen::MatrixXd InformationFromYaml(const YamlValue& section, const Camera& camera) {
  constexpr double kRounding = 1e-9;
  Eigen::MatrixXd information = SymmetricFromYaml(section, 4 + static_cast<size_t>(camera.lens));
  DemandUsableSize(section, information, camera);
  const Eigen::VectorXd scale = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::VectorXd eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scale.asDiagonal() * information * scale.asDiagonal())
          .eigenvalues();
  const bool is_semidefinite = eigenvalues[0] >= -kRounding * eigenvalues[eigenvalues.size() - 1];
  if (!is_semidefinite || !eigenvalues.allFinite())
    section.Fail("is no inverse covariance: it has a negative eigenvalue", "leave it as it was written");
  return information;
}

CameraFile ReadRosCamera(const std::filesystem::path& file, const std::string& text) {
  const YamlValue root = YamlValue::Parse(file, text);
  std::vector<std::string> keys = kCameraKeys;
  keys.insert(keys.end(), {"camera_from_base", "information"});
  root.AllowKeys(keys);
  CameraFile result;
  result.camera = ReadCameraInfo(root);
  if (const auto placement = root.Find("camera_from_base")) result.camera_from_base = placement->Rigid();
  if (const auto information = root.Find("information"))
    result.information = InformationFromYaml(*information, result.camera);
  return result;
}

CameraFile ReadAsRecognised(const std::filesystem::path& file, const std::string& text) {
  switch (RecogniseCameraFormat(text)) {
    case CameraFormat::kOpenCv:
      return ReadOpenCvCamera(file, text);
    case CameraFormat::kKalibr:
      return ReadKalibrCamera(file, text);
    case CameraFormat::kVisp:
      return ReadVispCamera(file, text);
    case CameraFormat::kMrcal:
      return ReadMrcalCamera(file, text);
    case CameraFormat::kRos:
      break;
  }
  return ReadRosCamera(file, text);
}

}  // namespace

Camera CameraFromYaml(const YamlValue& section) {
  section.AllowKeys(kCameraKeys);
  return ReadCameraInfo(section);
}

std::string CameraToYaml(const Camera& camera) {
  const int count = static_cast<int>(camera.lens);
  const std::vector<double> coefficients(camera.distortion.begin(), camera.distortion.begin() + count);
  const std::vector<double> matrix = {camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1};
  return fmt::format(
      "image_width: {}\n"
      "image_height: {}\n"
      "camera_matrix: {}\n"
      "distortion_model: {}\n"
      "distortion_coefficients: {}\n",
      camera.width_px, camera.height_px, MatrixText(3, 3, matrix), RosLensName(camera.lens),
      MatrixText(1, count, coefficients));
}

CameraFile ReadCamera(const std::filesystem::path& file) {
  CameraFile result = ReadAsRecognised(file, ReadTextFile(file));
  if (const auto wrong = WhatCoefficientIsImplausible(result.camera))
    throw InputError(file, 0, wrong->what_is_wrong, wrong->what_to_do);
  return result;
}

// ROS wants a rectification and a projection too; those of the raw image are the identity and the camera
// matrix.
std::string CameraInfoText(const CameraFile& file) {
  const Camera& camera = file.camera;
  const std::vector<double> identity = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::vector<double> projection = {
      camera.fx_px, 0, camera.cx_px, 0, 0, camera.fy_px, camera.cy_px, 0, 0, 0, 1, 0};
  std::string text = "camera_name: camera\n" + CameraToYaml(camera);
  text += fmt::format("rectification_matrix: {}\n", MatrixText(3, 3, identity));
  text += fmt::format("projection_matrix: {}\n", MatrixText(3, 4, projection));
  if (file.camera_from_base) text += fmt::format("camera_from_base: {}\n", RigidText(*file.camera_from_base));
  if (file.information.size() > 0)
    text += "information:  # inverse covariance of fx fy cx cy and the coefficients, lower triangle\n" +
            SymmetricToYaml(file.information);
  return text;
}

void WriteCamera(const std::filesystem::path& file, const Camera& camera,
                 const std::optional<Rigid3>& camera_from_base) {
  WriteFileAtomically(file, CameraInfoText({camera, camera_from_base, {}}));
}

}  // namespace legible
