#include "tests/datasets/camera_formats/visp_camera.h"

#include <visp3/core/vpCameraParameters.h>
#include <visp3/core/vpMeterPixelConversion.h>
#include <visp3/core/vpPixelMeterConversion.h>
#include <visp3/core/vpXmlParserCamera.h>

#include <stdexcept>

namespace legible {
namespace {

vpCameraParameters::vpCameraParametersProjType TypeOf(VispLens lens) {
  if (lens == VispLens::kFisheye) return vpCameraParameters::ProjWithKannalaBrandtDistortion;
  return lens == VispLens::kRadial ? vpCameraParameters::perspectiveProjWithDistortion
                                   : vpCameraParameters::perspectiveProjWithoutDistortion;
}

vpCameraParameters ParametersOf(const VispCamera& camera) {
  const std::vector<double>& v = camera.values;
  vpCameraParameters parameters(v[0], v[1], v[2], v[3]);
  if (camera.lens == VispLens::kRadial)
    parameters.initPersProjWithDistortion(v[0], v[1], v[2], v[3], v[4], v[5]);
  if (camera.lens == VispLens::kFisheye)
    parameters.initProjWithKannalaBrandtDistortion(v[0], v[1], v[2], v[3], {v.begin() + 4, v.end()});
  return parameters;
}

}  // namespace

VispCamera ReadByVisp(const std::string& file, VispLens lens, int width_px, int height_px) {
  vpCameraParameters found;
  vpXmlParserCamera parser;
  if (parser.parse(found, file, "camera", TypeOf(lens), static_cast<unsigned int>(width_px),
                   static_cast<unsigned int>(height_px)) != vpXmlParserCamera::SEQUENCE_OK)
    throw std::runtime_error("ViSP finds no such camera in " + file);
  VispCamera camera{lens, {found.get_px(), found.get_py(), found.get_u0(), found.get_v0()}};
  if (lens == VispLens::kRadial)
    camera.values.insert(camera.values.end(), {found.get_kud(), found.get_kdu()});
  if (lens == VispLens::kFisheye)
    for (const double k : found.getKannalaBrandtDistortionCoefficients()) camera.values.push_back(k);
  return camera;
}

void WriteByVisp(const std::string& file, const VispCamera& camera, int width_px, int height_px) {
  vpXmlParserCamera parser;
  if (parser.save(ParametersOf(camera), file, "camera", static_cast<unsigned int>(width_px),
                  static_cast<unsigned int>(height_px)) != vpXmlParserCamera::SEQUENCE_OK)
    throw std::runtime_error("ViSP cannot write " + file);
}

std::array<double, 2> ToPixelByVisp(const VispCamera& camera, double x, double y) {
  std::array<double, 2> pixel = {};
  vpMeterPixelConversion::convertPoint(ParametersOf(camera), x, y, pixel[0], pixel[1]);
  return pixel;
}

std::array<double, 2> ToMetreByVisp(const VispCamera& camera, double u, double v) {
  std::array<double, 2> x = {};
  vpPixelMeterConversion::convertPoint(ParametersOf(camera), u, v, x[0], x[1]);
  return x;
}

}  // namespace legible
