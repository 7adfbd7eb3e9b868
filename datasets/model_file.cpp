#include "datasets/model_file.h"

#include <fmt/format.h>

#include <set>
#include <stdexcept>

#include "datasets/atomic_file.h"
#include "datasets/camera_file.h"
#include "datasets/camera_formats/camera_format.h"
#include "datasets/robot_file.h"
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

void DemandSymmetric(const Eigen::MatrixXd& matrix, const std::vector<YamlValue>& rows) {
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    if (matrix(i, i) < 0) rows[i].Fail(fmt::format("has the variance {}", matrix(i, i)), "give 0 or more");
    for (Eigen::Index j = 0; j < i; ++j) {
      if (matrix(i, j) == matrix(j, i)) continue;
      rows[i].Fail(fmt::format("has {} in column {}, and row {} has {} in column {}", matrix(i, j), j + 1,
                               j + 1, matrix(j, i), i + 1),
                   "give a symmetric matrix or its lower triangle");
    }
  }
}

// Rows of the lower triangle (1, 2, … values) or whole rows (`size` values each).
Eigen::MatrixXd SymmetricFromYaml(const YamlValue& section, size_t size) {
  const std::vector<YamlValue> rows = section.List(size);
  const bool is_whole = size > 1 && rows[0].List().size() == size;
  Eigen::MatrixXd matrix(size, size);
  for (size_t i = 0; i < size; ++i) {
    const std::vector<double> values = rows[i].Numbers(is_whole ? size : i + 1);
    for (size_t j = 0; j < values.size(); ++j) {
      matrix(i, j) = values[j];
      if (!is_whole) matrix(j, i) = values[j];
    }
  }
  DemandSymmetric(matrix, rows);
  return matrix;
}

std::string CovarianceToYaml(const std::vector<std::string>& names, const Eigen::MatrixXd& covariance) {
  std::string text =
      "covariance:  # of the parameters in this order, SI units, lower triangle\n  parameters:\n";
  for (const std::string& name : names) text += fmt::format("    - {}\n", QuotedText(name));
  text += "  rows:\n";
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    const Eigen::VectorXd row = covariance.row(i).head(i + 1);
    text += fmt::format("    - {}\n", ListText(row.data(), static_cast<size_t>(row.size())));
  }
  return text;
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
