#include "datasets/yaml_value.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "datasets/input_error.h"
#include "datasets/text.h"

namespace legible {
namespace {

constexpr double kLargestNormError = 1e-3;  // of a quaternion written with three digits
// What rounding leaves of a unit quaternion: one that this program wrote reads back bit by bit.
constexpr double kRoundingOfNorm = 1e-14;

std::vector<YAML::Node> LoadDocuments(const std::filesystem::path& file, const std::string& text) {
  try {
    return YAML::LoadAll(text);
  } catch (const YAML::Exception& error) {
    throw InputError(file, error.mark.line + 1, "is no YAML: " + error.msg, "mend the syntax at this line");
  }
}

std::string KindOf(const YAML::Node& node) {
  if (node.IsMap()) return "a map";
  if (node.IsSequence()) return "a list";
  if (node.IsScalar()) return fmt::format("\"{}\"", Shortened(node.Scalar()));
  return "empty";
}

}  // namespace

YamlValue::YamlValue(const YAML::Node& node, std::shared_ptr<const std::filesystem::path> file,
                     std::string keys, int line)
    : node_(node), file_(std::move(file)), keys_(std::move(keys)), line_(line) {}

YamlValue YamlValue::LoadFile(const std::filesystem::path& file) { return Parse(file, ReadTextFile(file)); }

YamlValue YamlValue::Parse(const std::filesystem::path& file, const std::string& text) {
  const std::vector<YAML::Node> documents = LoadDocuments(file, text);
  if (documents.empty() || documents[0].IsNull()) {
    throw InputError(file, 0, "is empty", "fill it in, or name another file");
  }
  if (documents.size() > 1) {
    throw InputError(file, 0, fmt::format("holds {} YAML documents", documents.size()), "keep one");
  }
  return {documents[0], std::make_shared<const std::filesystem::path>(file), "",
          documents[0].Mark().line + 1};
}

void YamlValue::Fail(const std::string& what_is_wrong, const std::string& what_to_do) const {
  const std::string name = keys_.empty() ? "the file" : keys_;
  throw InputError(*file_, line_, name + " " + what_is_wrong, what_to_do);
}

// yaml-cpp gives an empty value no line of its own, or that of what follows; its key's line is the one to
// look at.
YamlValue YamlValue::Child(const YAML::Node& child, const std::string& keys, int fallback_line) const {
  return {child, file_, keys, child.IsNull() ? fallback_line : child.Mark().line + 1};
}

void YamlValue::DemandMap() const {
  if (!IsMap()) Fail(fmt::format("is {}, not a map", KindOf(node_)), "write \"key: value\" lines");
}

std::vector<std::pair<std::string, YamlValue>> YamlValue::Entries() const {
  DemandMap();
  std::vector<std::pair<std::string, YamlValue>> entries;
  for (const auto& entry : node_) {
    const int line = entry.first.Mark().line + 1;
    if (!entry.first.IsScalar()) Child(entry.first, keys_, line).Fail("has a key that is no text", "name it");
    const std::string& key = entry.first.Scalar();
    entries.emplace_back(key, Child(entry.second, keys_.empty() ? key : keys_ + "." + key, line));
  }
  return entries;
}

void YamlValue::AllowKeys(const std::vector<std::string>& known) const {
  DemandMap();
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    const YamlValue key = Child(entry.first, keys_, entry.first.Mark().line + 1);
    const std::string name = key.Text();
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      key.Fail(
          fmt::format("has the unknown key \"{}\"", Shortened(name)),
          fmt::format("the nearest known key is \"{}\": rename it or take it out", NearestName(name, known)));
    }
    if (!seen.insert(name).second) key.Fail(fmt::format("has the key \"{}\" twice", name), "keep one");
  }
}

std::optional<YamlValue> YamlValue::Find(const std::string& key) const {
  for (const auto& [name, value] : Entries()) {
    if (name == key) return value;
  }
  return std::nullopt;
}

YamlValue YamlValue::Get(const std::string& key) const {
  std::optional<YamlValue> value = Find(key);
  if (!value) Fail(fmt::format("has no \"{}\"", key), "add it");
  return *value;
}

std::vector<YamlValue> YamlValue::List() const {
  if (!node_.IsSequence()) Fail(fmt::format("is {}, not a list", KindOf(node_)), "write [value, value, …]");
  std::vector<YamlValue> values;
  for (const YAML::Node& node : node_) {
    values.push_back(Child(node, fmt::format("{}[{}]", keys_, values.size() + 1), line_));
  }
  return values;
}

std::vector<YamlValue> YamlValue::List(size_t size) const {
  std::vector<YamlValue> values = List();
  if (values.size() != size) Fail(fmt::format("has {} values", values.size()), fmt::format("give {}", size));
  return values;
}

std::string YamlValue::Text() const {
  if (!node_.IsScalar()) Fail(fmt::format("is {}, not a text", KindOf(node_)), "write one value");
  return node_.Scalar();
}

double YamlValue::Number() const {
  const std::optional<double> value = node_.IsScalar() ? ParseFinite(node_.Scalar()) : std::nullopt;
  if (!value) {
    Fail(fmt::format("is {}, not a finite number", KindOf(node_)), "give a number in m, rad or px");
  }
  return *value;
}

double YamlValue::PositiveNumber() const {
  const double value = Number();
  if (value <= 0) Fail(fmt::format("is {}", value), "give a number greater than 0");
  return value;
}

int YamlValue::Integer() const {
  const std::optional<int> value = node_.IsScalar() ? ParseInteger(node_.Scalar()) : std::nullopt;
  if (!value) Fail(fmt::format("is {}, not a whole number", KindOf(node_)), "give a whole number");
  return *value;
}

int YamlValue::PositiveInteger() const {
  const int value = Integer();
  if (value <= 0) Fail(fmt::format("is {}", value), "give a whole number greater than 0");
  return value;
}

std::vector<double> YamlValue::Numbers() const {
  std::vector<double> numbers;
  for (const YamlValue& value : List()) numbers.push_back(value.Number());
  return numbers;
}

std::vector<double> YamlValue::Numbers(size_t size) const {
  List(size);
  return Numbers();
}

Eigen::Vector3d YamlValue::Vector3() const { return Eigen::Map<const Eigen::Vector3d>(Numbers(3).data()); }

Eigen::Quaterniond YamlValue::Rotation() const {
  const std::vector<double> xyzw = Numbers(4);
  const Eigen::Quaterniond rotation(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  const double norm = rotation.norm();
  if (std::abs(norm - 1) > kLargestNormError) {
    Fail(fmt::format("is a quaternion of norm {:.6g}", norm), "give a unit quaternion, x y z w");
  }
  return std::abs(norm - 1) > kRoundingOfNorm ? rotation.normalized() : rotation;
}

Rigid3 YamlValue::Rigid() const {
  constexpr double kFarthest_m = 100;  // beyond any robot and camera, and short of one in millimetres
  AllowKeys({"rotation_xyzw", "translation_m"});
  const YamlValue translation = Get("translation_m");
  Rigid3 transform{Get("rotation_xyzw").Rotation(), translation.Vector3()};
  if (transform.translation.norm() > kFarthest_m)
    translation.Fail(fmt::format("is {:.4g} m long", transform.translation.norm()),
                     "give lengths in metres, not in millimetres");
  return transform;
}

std::string NumberText(double value) {
  if (!std::isfinite(value)) throw std::invalid_argument("a value to be written is not finite");
  return fmt::format("{}", value);
}

std::string ListText(const double* values, size_t size) {
  std::vector<std::string> texts;
  for (size_t i = 0; i < size; ++i) texts.push_back(NumberText(values[i]));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

std::string ListText(const Eigen::Vector3d& values) { return ListText(values.data(), 3); }

std::string RigidText(const Rigid3& b_from_a) {
  return fmt::format("{{rotation_xyzw: {}, translation_m: {}}}",
                     ListText(b_from_a.rotation.coeffs().data(), 4), ListText(b_from_a.translation));
}

std::string QuotedText(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += {'\\', c};
    } else if (static_cast<unsigned char>(c) < 0x20) {
      quoted += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

std::string Indented(std::string_view text) {
  std::string indented;
  for (size_t i = 0; i < text.size(); ++i) {
    if (i == 0 || text[i - 1] == '\n') indented += "  ";
    indented += text[i];
  }
  return indented;
}

}  // namespace legible
