// YAML for this folder's own .cpp files: values that can say where they stand, and text for the writers.
#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/geometry/rigid3.h"

namespace legible {

// A value of a YAML file together with its file, line and path of keys ("legs[2].radius_m", lists counted
// from 1). Every accessor throws an InputError that names these if the value is not what is asked for.
class YamlValue {
 public:
  // The one document of a file.
  static YamlValue LoadFile(const std::filesystem::path& file);
  // The one document of a text, `file` being its name in messages.
  static YamlValue Parse(const std::filesystem::path& file, const std::string& text);

  bool IsMap() const { return node_.IsMap(); }
  bool IsNull() const { return node_.IsNull(); }
  bool IsList() const { return node_.IsSequence(); }
  int Line() const { return line_; }

  // Demands a map whose keys are all among `known`, none of them twice.
  void AllowKeys(const std::vector<std::string>& known) const;
  YamlValue Get(const std::string& key) const;
  std::optional<YamlValue> Find(const std::string& key) const;
  std::vector<std::pair<std::string, YamlValue>> Entries() const;  // of a map, in the order of the file
  std::vector<YamlValue> List() const;
  std::vector<YamlValue> List(size_t size) const;

  std::string Text() const;
  double Number() const;  // finite
  double PositiveNumber() const;
  int Integer() const;
  int PositiveInteger() const;
  std::vector<double> Numbers() const;
  std::vector<double> Numbers(size_t size) const;
  Eigen::Vector3d Vector3() const;
  Rigid3 Rigid() const;  // {rotation_xyzw, translation_m}

  // Throws the InputError "FILE:LINE: <path of keys> <what is wrong>; <what to do>".
  [[noreturn]] void Fail(const std::string& what_is_wrong, const std::string& what_to_do) const;

 private:
  YamlValue(const YAML::Node& node, std::shared_ptr<const std::filesystem::path> file, std::string keys,
            int line);
  YamlValue Child(const YAML::Node& child, const std::string& keys, int fallback_line) const;
  void DemandMap() const;
  Eigen::Quaterniond Rotation() const;

  YAML::Node node_;
  std::shared_ptr<const std::filesystem::path> file_;
  std::string keys_;
  int line_ = 0;
};

// The shortest text that reads back as exactly `value`. Throws std::invalid_argument unless it is finite.
std::string NumberText(double value);

// "[1, 2, 3]" and "{rotation_xyzw: […], translation_m: […]}".
std::string ListText(const double* values, size_t size);
std::string ListText(const Eigen::Vector3d& values);
std::string RigidText(const Rigid3& b_from_a);

// A double-quoted YAML scalar.
std::string QuotedText(std::string_view text);

// Every line moved right by two columns.
std::string Indented(std::string_view text);

}  // namespace legible
