#include "datasets/camera_formats/camera_export.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/geometry/nearest_camera.h"
#include "datasets/yaml_value.h"

namespace legible {
namespace {

constexpr char kPlace[] = "where the camera stands (camera_from_base)";

std::vector<double> Coefficients(const Camera& camera, int count) {
  return {camera.distortion.begin(), camera.distortion.begin() + count};
}

std::string Joined(const std::vector<double>& values) {
  std::vector<std::string> texts;
  texts.reserve(values.size());
  for (const double value : values) texts.push_back(NumberText(value));
  return fmt::format("{}", fmt::join(texts, ", "));
}

// With free coefficients among the first ones of the lens.
NearestCamera NearestWith(const Camera& camera, LensModel lens, int coefficients) {
  std::bitset<kCameraParameterCount> free;
  for (int i = 0; i < 4 + coefficients; ++i) free.set(static_cast<size_t>(i));
  return FindNearestCamera(camera, lens, free);
}

// What an exact or a fitted lens costs.
std::vector<ConversionError> ErrorsOf(const NearestCamera& nearest) {
  if (nearest.max_px == 0) return {};
  return {{"projection", nearest.rms_px, nearest.max_px}};
}

ExportedCamera Exported(std::string text, const NearestCamera& nearest) {
  return {std::move(text), nearest.camera, ErrorsOf(nearest), {}};
}

// --- OpenCV. ---------------------------------------------------------------------------------------------

struct NamedMatrix {
  const char* name;
  int rows, columns;
  std::vector<double> values;
};

std::vector<NamedMatrix> OpenCvMatrices(const Camera& camera) {
  const int count = camera.lens == LensModel::kPinhole ? 5 : static_cast<int>(camera.lens);
  return {{"camera_matrix", 3, 3, {camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1}},
          {"distortion_coefficients", 1, count, Coefficients(camera, count)}};
}

std::string OpenCvYaml(const Camera& camera) {
  std::string text =
      fmt::format("%YAML:1.0\n---\nimage_width: {}\nimage_height: {}\nfisheye_model: {}\n", camera.width_px,
                  camera.height_px, camera.lens == LensModel::kFisheye ? 1 : 0);
  for (const NamedMatrix& matrix : OpenCvMatrices(camera))
    text += fmt::format("{}: !!opencv-matrix\n   rows: {}\n   cols: {}\n   dt: d\n   data: [ {} ]\n",
                        matrix.name, matrix.rows, matrix.columns, Joined(matrix.values));
  return text;
}

std::string OpenCvXml(const Camera& camera) {
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<opencv_storage>\n<image_width>{}</image_width>\n"
      "<image_height>{}</image_height>\n<fisheye_model>{}</fisheye_model>\n",
      camera.width_px, camera.height_px, camera.lens == LensModel::kFisheye ? 1 : 0);
  for (const NamedMatrix& matrix : OpenCvMatrices(camera)) {
    std::string data = Joined(matrix.values);
    std::erase(data, ',');
    text += fmt::format(
        "<{0} type_id=\"opencv-matrix\">\n  <rows>{1}</rows>\n  <cols>{2}</cols>\n  <dt>d</dt>\n"
        "  <data>\n    {3}</data></{0}>\n",
        matrix.name, matrix.rows, matrix.columns, data);
  }
  return text + "</opencv_storage>\n";
}

// --- Kalibr. ---------------------------------------------------------------------------------------------

// PyYAML takes "1e-05" for a text and Kalibr demands floats: always with a point.
std::string FloatText(double value) {
  std::string text = NumberText(value);
  if (text.find('.') != std::string::npos) return text;
  return text.insert(std::min(text.find('e'), text.size()), ".0");
}

std::string FloatList(const std::vector<double>& values) {
  std::vector<std::string> texts;
  texts.reserve(values.size());
  for (const double value : values) texts.push_back(FloatText(value));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

ExportedCamera ToKalibr(const Camera& camera) {
  const NearestCamera radtan = NearestWith(camera, LensModel::kBrownConrady, 4);
  const NearestCamera equidistant = NearestWith(camera, LensModel::kFisheye, 4);
  const NearestCamera& best = radtan.rms_px <= equidistant.rms_px ? radtan : equidistant;
  const Camera& k = best.camera;
  return Exported(fmt::format("cam0:\n"
                              "  camera_model: pinhole\n"
                              "  intrinsics: {}\n"
                              "  distortion_model: {}\n"
                              "  distortion_coeffs: {}\n"
                              "  resolution: [{}, {}]\n"
                              "  rostopic: /cam0/image_raw\n"
                              "  cam_overlaps: []\n",
                              FloatList({k.fx_px, k.fy_px, k.cx_px, k.cy_px}),
                              k.lens == LensModel::kFisheye ? "equidistant" : "radtan",
                              FloatList(Coefficients(k, 4)), k.width_px, k.height_px),
                  best);
}

// --- ViSP. -----------------------------------------------------------------------------------------------

// ViSP's x = x_d (1 + kdu r_d^2), by least squares over the image, and how far the camera has the images of
// these x from the pixels that they came from.
struct WayBack {
  double kdu = 0;
  ConversionError error;
};

WayBack FindWayBack(const Camera& original, const Camera& visp) {
  constexpr int kSteps = 40;
  std::vector<std::array<Eigen::Vector2d, 3>>
      points;  // pixel, distorted by ViSP, undistorted by the original
  for (int row = 0; row <= kSteps; ++row)
    for (int column = 0; column <= kSteps; ++column) {
      const Eigen::Vector2d pixel(column * (visp.width_px - 1.0) / kSteps,
                                  row * (visp.height_px - 1.0) / kSteps);
      const Eigen::Vector2d distorted((pixel.x() - visp.cx_px) / visp.fx_px,
                                      (pixel.y() - visp.cy_px) / visp.fy_px);
      if (const auto x = Unproject(original, pixel)) points.push_back({pixel, distorted, *x});
    }
  double product = 0, square = 0;
  for (const auto& [pixel, distorted, x] : points) {
    const Eigen::Vector2d cubic = distorted * distorted.squaredNorm();
    product += cubic.dot(x - distorted);
    square += cubic.squaredNorm();
  }
  WayBack back{product / square, {"way back from pixels", 0, 0}};
  for (const auto& [pixel, distorted, x] : points) {
    const Eigen::Vector2d found = distorted * (1 + back.kdu * distorted.squaredNorm());
    const double distance = (ProjectNormalised(original, found) - pixel).norm();
    back.error.rms_px += distance * distance / static_cast<double>(points.size());
    back.error.max_px = std::max(back.error.max_px, distance);
  }
  back.error.rms_px = std::sqrt(back.error.rms_px);
  return back;
}

std::string VispText(const Camera& camera, const char* type, const std::string& coefficients) {
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<root>\n  <camera>\n    <name>camera</name>\n"
      "    <image_width>{}</image_width>\n    <image_height>{}</image_height>\n    <model>\n"
      "      <type>{}</type>\n      <px>{}</px>\n      <py>{}</py>\n      <u0>{}</u0>\n      <v0>{}</v0>\n{}"
      "    </model>\n  </camera>\n</root>\n",
      camera.width_px, camera.height_px, type, NumberText(camera.fx_px), NumberText(camera.fy_px),
      NumberText(camera.cx_px), NumberText(camera.cy_px), coefficients);
}

std::string Element(const char* name, double value) {
  return fmt::format("      <{0}>{1}</{0}>\n", name, NumberText(value));
}

ExportedCamera ToVisp(const Camera& camera) {
  if (camera.lens == LensModel::kFisheye) {
    std::string coefficients;
    const char* const names[] = {"k1", "k2", "k3", "k4", "k5"};
    for (int i = 0; i < 5; ++i) coefficients += Element(names[i], i < 4 ? camera.distortion[i] : 0.0);
    return {VispText(camera, "ProjWithKannalaBrandtDistortion", coefficients), camera, {}, {}};
  }
  if (camera.distortion.isZero())
    return {VispText(camera, "perspectiveProjWithoutDistortion", ""), camera, {}, {}};
  const NearestCamera nearest = NearestWith(camera, LensModel::kBrownConrady, 1);
  const WayBack back = FindWayBack(camera, nearest.camera);
  ExportedCamera exported =
      Exported(VispText(nearest.camera, "perspectiveProjWithDistortion",
                        Element("kud", nearest.camera.distortion[0]) + Element("kdu", back.kdu)),
               nearest);
  exported.errors.push_back(back.error);
  return exported;
}

// --- mrcal. ----------------------------------------------------------------------------------------------

ExportedCamera ToMrcal(const CameraFile& file) {
  const LensModel lens = file.camera.lens == LensModel::kFisheye ? LensModel::kRational : file.camera.lens;
  const int count = static_cast<int>(lens);
  const NearestCamera nearest = NearestWith(file.camera, lens, count);
  const Camera& k = nearest.camera;
  std::vector<double> intrinsics = {k.fx_px, k.fy_px, k.cx_px, k.cy_px};
  const std::vector<double> coefficients = Coefficients(k, count);
  intrinsics.insert(intrinsics.end(), coefficients.begin(), coefficients.end());
  std::vector<double> place(6, 0.0);
  if (file.camera_from_base) {
    Eigen::Map<Eigen::Vector3d>(place.data()) = VectorFromRotation(file.camera_from_base->rotation);
    Eigen::Map<Eigen::Vector3d>(place.data() + 3) = file.camera_from_base->translation;
  }
  return Exported(
      fmt::format("{{\n    'lensmodel':  'LENSMODEL_{}',\n\n"
                  "    # intrinsics are fx,fy,cx,cy,distortion0,distortion1,....\n"
                  "    'intrinsics': [ {} ],\n\n"
                  "    # extrinsics are rt_fromref; the reference is the base frame of the robot\n"
                  "    'extrinsics': [ {} ],\n\n"
                  "    'imagersize': [ {}, {} ],\n}}\n",
                  count == 0 ? "PINHOLE" : fmt::format("OPENCV{}", count), Joined(intrinsics), Joined(place),
                  k.width_px, k.height_px),
      nearest);
}

}  // namespace

ExportedCamera ExportCamera(const CameraFile& camera, CameraFormat format, OpenCvText open_cv) {
  ExportedCamera exported;
  switch (format) {
    case CameraFormat::kRos:
      return {CameraInfoText(camera), camera.camera, {}, {}};
    case CameraFormat::kMrcal:
      return ToMrcal(camera);
    case CameraFormat::kOpenCv:
      exported = {open_cv == OpenCvText::kXml ? OpenCvXml(camera.camera) : OpenCvYaml(camera.camera),
                  camera.camera,
                  {},
                  {}};
      break;
    case CameraFormat::kKalibr:
      exported = ToKalibr(camera.camera);
      break;
    case CameraFormat::kVisp:
      exported = ToVisp(camera.camera);
      break;
  }
  if (camera.camera_from_base) exported.left_behind.emplace_back(kPlace);
  return exported;
}

}  // namespace legible
