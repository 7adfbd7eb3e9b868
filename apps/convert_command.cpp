#include "apps/convert_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/program.h"
#include "apps/wording.h"
#include "datasets/atomic_file.h"
#include "datasets/camera_formats/camera_export.h"
#include "datasets/input_error.h"
#include "datasets/model_file.h"
#include "datasets/session_file.h"
#include "datasets/text.h"
#include "datasets/yaml_value.h"

namespace legible {
namespace {

namespace fs = std::filesystem;

constexpr char kLinuxCnc[] = "linuxcnc";
const std::vector<std::pair<std::string, CameraFormat>> kFormats = {{"opencv", CameraFormat::kOpenCv},
                                                                    {"ros", CameraFormat::kRos},
                                                                    {"kalibr", CameraFormat::kKalibr},
                                                                    {"visp", CameraFormat::kVisp},
                                                                    {"mrcal", CameraFormat::kMrcal}};

// --- Which file is meant. --------------------------------------------------------------------------------

fs::path FileIn(const fs::path& folder, bool wants_robot) {
  if (fs::exists(folder / "model.yaml")) return folder / "model.yaml";
  if (fs::exists(folder / "session.yaml")) {
    const Session session = ReadSession(folder);
    return session.files[wants_robot ? 1 : 2];
  }
  const char* name = wants_robot ? "robot.yaml" : "camera.yaml";
  if (fs::exists(folder / name)) return folder / name;
  throw InputError(folder, 0, fmt::format("holds no model.yaml, session.yaml or {}", name),
                   "name the file that is meant");
}

// --- Cameras. --------------------------------------------------------------------------------------------

struct CameraToConvert {
  CameraFile file;
  std::vector<std::string> left_behind;  // beside the camera
};

CameraToConvert ReadCameraToConvert(const fs::path& file, const std::string& to) {
  if (!HoldsRobot(file)) {
    CameraToConvert camera{ReadCamera(file), {}};
    if (camera.file.information.size() > 0 && to != "ros")
      camera.left_behind.emplace_back("how well a board has told the camera");
    return camera;
  }
  const CalibratedModel model = ReadModel(file);
  if (!model.camera)
    throw InputError(file, 0, "has no camera", "give the model.yaml of a calibration, or a camera");
  CameraToConvert camera{{*model.camera, model.camera_from_base}, {"the robot"}};
  if (model.covariance.size() > 0) camera.left_behind.emplace_back("the covariance of what was estimated");
  return camera;
}

std::string ErrorText(const ConversionError& error) {
  if (!std::isfinite(error.max_px)) return fmt::format("{}: no such lens covers the image", error.of);
  return fmt::format("{}: {:.2g} px rms, {:.2g} px at most", error.of, error.rms_px, error.max_px);
}

std::string ErrorsText(const std::vector<ConversionError>& errors) {
  std::vector<std::string> texts;
  texts.reserve(errors.size());
  for (const ConversionError& error : errors) texts.push_back(ErrorText(error));
  return fmt::format("{}", fmt::join(texts, "; "));
}

double LargestError(const std::vector<ConversionError>& errors) {
  double largest = 0;
  for (const ConversionError& error : errors) largest = std::max(largest, error.max_px);
  return largest;
}

// The least number of two digits that is not less.
std::string RoundedUp(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
  return fmt::format("{:g}", std::ceil(value / unit) * unit);
}

std::string RefusalText(const std::vector<ConversionError>& errors, CameraFormat format) {
  const double largest = LargestError(errors);
  const std::string mend = std::isfinite(largest)
                               ? fmt::format("--accept-error {} writes it all the same", RoundedUp(largest))
                               : "name another format with --to";
  return fmt::format("legible: {} has no lens as near to this one as is accepted ({}); {}\n", NameOf(format),
                     ErrorsText(errors), mend);
}

// --- The command. ----------------------------------------------------------------------------------------

void Write(const ConvertSettings& settings, const std::string& text, const Console& console) {
  if (settings.out)
    WriteFileAtomically(*settings.out, text);
  else
    console.out << text;
}

int ConvertCamera(const ConvertSettings& settings, const fs::path& file, CameraFormat format,
                  const Console& console) {
  const CameraToConvert camera = ReadCameraToConvert(file, settings.to);
  const bool is_xml = settings.out && settings.out->extension() == ".xml";
  ExportedCamera exported = ExportCamera(camera.file, format, is_xml ? OpenCvText::kXml : OpenCvText::kYaml);
  if (LargestError(exported.errors) > settings.accepted_error_px) {
    console.err << RefusalText(exported.errors, format);
    return kExitNoResult;
  }
  std::vector<std::string> warnings = camera.file.warnings;
  if (!exported.errors.empty())
    warnings.push_back(fmt::format("{} holds the nearest lens that it has: {}", NameOf(format),
                                   ErrorsText(exported.errors)));
  exported.left_behind.insert(exported.left_behind.end(), camera.left_behind.begin(),
                              camera.left_behind.end());
  warnings.reserve(warnings.size() + exported.left_behind.size());
  for (const std::string& what : exported.left_behind)
    warnings.push_back(fmt::format("{} has no place for {}", NameOf(format), what));
  Write(settings, exported.text, console);
  console.err << WarningsText(warnings);
  return kExitSuccess;
}

int ConvertRobot(const ConvertSettings& settings, const fs::path& file, const Console& console) {
  if (!HoldsRobot(file)) throw InputError(file, 0, "holds no robot", "give a model.yaml or a robot.yaml");
  Write(settings, LinuxCncText(ReadModel(file).robot, settings.unit), console);
  return kExitSuccess;
}

}  // namespace

std::vector<std::string> ConvertTargets() {
  std::vector<std::string> names;
  names.reserve(kFormats.size() + 1);
  for (const auto& [name, format] : kFormats) names.push_back(name);
  names.emplace_back(kLinuxCnc);
  return names;
}

int RunConvert(const ConvertSettings& settings, const Console& console) {
  const bool wants_robot = settings.to == kLinuxCnc;
  const bool is_folder = fs::is_directory(settings.input);
  const fs::path file = is_folder ? FileIn(settings.input, wants_robot) : settings.input;
  const auto format = std::find_if(kFormats.begin(), kFormats.end(),
                                   [&](const auto& entry) { return entry.first == settings.to; });
  if (is_folder) console.err << fmt::format("legible: taking {}\n", file.string());
  return wants_robot ? ConvertRobot(settings, file, console)
                     : ConvertCamera(settings, file, format->second, console);
}

}  // namespace legible
