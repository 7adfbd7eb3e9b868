#include "datasets/model_file.h"

#include <fmt/format.h>

#include <set>
#include <stdexcept>

#include "datasets/atomic_file.h"
#include "datasets/camera_file.h"
#include "datasets/camera_formats/camera_format.h"
#include "datasets/robot_file.h"
#include "datasets/symmetric_yaml.h"
#include "datasets/text.h"
#include "datasets/yaml_value.h"

namespace legible {
namespace {

std::vector<std::string> NamesFromYaml(const YamlValue& section) {
  std::vector<std::string> names;
  std::set<std::string> seen;
  for (const YamlValue& value : section.List()) {
    names.push_back(value.Text());
    if (!seen.insert(names.back()).second)
      value.Fail(fmt::format("is \"{}\" again", names.back()), "name it once");
  }
  return names;
}

std::string CovarianceToYaml(const std::vector<std::string>& names, const Eigen::MatrixXd& covariance) {
  std::string text =
      "covariance:  # of the parameters in this order, SI units, lower triangle\n  parameters:\n";
  for (const std::string& name : names) text += fmt::format("    - {}\n", QuotedText(name));
  return text + "  rows:\n" + Indented(SymmetricToYaml(covariance));
}

std::string ProvenanceToYaml(const std::map<std::string, std::string>& provenance) {
  std::string text = "provenance:\n";
  for (const auto& [key, value] : provenance)
    text += fmt::format("  {}: {}\n", QuotedText(key), QuotedText(value));
  return text;
}

void DemandCovarianceOfNames(const CalibratedModel& model) {
  const auto size = static_cast<Eigen::Index>(model.parameter_names.size());
  if (model.covariance.rows() != size || model.covariance.cols() != size) {
    throw std::invalid_argument(fmt::format("a covariance of {} x {} for {} parameter names",
                                            model.covariance.rows(), model.covariance.cols(), size));
  }
}

CalibratedModel ModelFromYaml(const YamlValue& root) {
  root.AllowKeys({"robot", "camera", "camera_from_base", "provenance", "covariance", "simulation"});
  CalibratedModel model;
  model.robot = RobotFromYaml(root.Get("robot"));
  if (const auto camera = root.Find("camera")) model.camera = CameraFromYaml(*camera);
  if (const auto placement = root.Find("camera_from_base")) model.camera_from_base = placement->Rigid();
  if (const auto provenance = root.Find("provenance")) {
    for (const auto& [key, value] : provenance->Entries()) model.provenance[key] = value.Text();
  }
  if (const auto covariance = root.Find("covariance")) {
    covariance->AllowKeys({"parameters", "rows"});
    model.parameter_names = NamesFromYaml(covariance->Get("parameters"));
    model.covariance = SymmetricFromYaml(covariance->Get("rows"), model.parameter_names.size());
  }
  return model;
}

}  // namespace

CalibratedModel ReadModel(const std::filesystem::path& file) {
  const YamlValue root = YamlValue::LoadFile(file);
  const std::optional<YamlValue> robot = root.Find("robot");
  if (robot && robot->IsMap()) return ModelFromYaml(root);
  CalibratedModel drawing;
  drawing.robot = RobotFromYaml(root);
  return drawing;
}

bool HoldsRobot(const std::filesystem::path& file) {
  const std::string text = ReadTextFile(file);
  return RecogniseCameraFormat(text) == CameraFormat::kRos && YamlValue::Parse(file, text).Find("robot");
}

bool HoldsModel(const std::filesystem::path& file) {
  const std::optional<YamlValue> kind = YamlValue::LoadFile(file).Find("robot");
  return kind && (kind->IsMap() || (!kind->IsNull() && kind->Text() == "gough-stewart"));
}

std::string ModelToYaml(const CalibratedModel& model) {
  DemandCovarianceOfNames(model);
  std::string text = "robot:\n" + Indented(RobotToYaml(model.robot));
  if (model.camera) text += "camera:\n" + Indented(CameraToYaml(*model.camera));
  if (model.camera_from_base)
    text += fmt::format("camera_from_base: {}\n", RigidText(*model.camera_from_base));
  if (!model.provenance.empty()) text += ProvenanceToYaml(model.provenance);
  if (!model.parameter_names.empty()) text += CovarianceToYaml(model.parameter_names, model.covariance);
  return text;
}

void WriteModel(const std::filesystem::path& file, const CalibratedModel& model) {
  WriteFileAtomically(file, ModelToYaml(model));
}

}  // namespace legible
