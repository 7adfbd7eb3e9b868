#include "datasets/tag_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "datasets/atomic_file.h"
#include "datasets/tag_yaml.h"
#include "datasets/yaml_value.h"

namespace legible {
namespace {

const char* CarrierName(TagCarrier carrier) { return carrier == TagCarrier::kBase ? "base" : "platform"; }

std::string PlacementKey(TagCarrier carrier) { return fmt::format("{}_from_group", CarrierName(carrier)); }

TagCarrier CarrierFromYaml(const YamlValue& value) {
  const std::string name = value.Text();
  if (name == "base") return TagCarrier::kBase;
  if (name != "platform") value.Fail(fmt::format("is \"{}\"", name), "give base or platform");
  return TagCarrier::kPlatform;
}

Tag TagFromYaml(const YamlValue& section, const TagFamily& family) {
  section.AllowKeys({"id", "corners_m"});
  Tag tag;
  tag.id = TagIdFromYaml(section, family);
  const YamlValue corners = section.Get("corners_m");
  const std::vector<YamlValue> list = corners.List(4);
  for (size_t i = 0; i < 4; ++i) tag.corners_m[i] = list[i].Vector3();
  DemandSquare(corners, tag.corners_m);
  return tag;
}

TagGroup GroupFromYaml(const YamlValue& section, const TagFamily& family) {
  TagGroup group;
  group.carrier = CarrierFromYaml(section.Get("on"));
  const std::string placement = PlacementKey(group.carrier);
  section.AllowKeys({"name", "on", placement, "known", "tags"});
  group.name = section.Get("name").Text();
  group.carrier_from_group = section.Get(placement).Rigid();
  const YamlValue known = section.Get("known");
  known.AllowKeys({"translation_m", "rotation_rad"});
  group.translation_sigma_m = known.Get("translation_m").PositiveNumber();
  group.rotation_sigma_rad = known.Get("rotation_rad").PositiveNumber();
  for (const YamlValue& tag : section.Get("tags").List()) group.tags.push_back(TagFromYaml(tag, family));
  return group;
}

std::string TagToYaml(const Tag& tag) {
  std::vector<std::string> corners;
  for (const Eigen::Vector3d& corner : tag.corners_m) corners.push_back(ListText(corner));
  return fmt::format("      - {{id: {}, corners_m: [{}]}}\n", tag.id, fmt::join(corners, ", "));
}

std::string GroupToYaml(const TagGroup& group) {
  std::string text = fmt::format(
      "  - name: {}\n"
      "    on: {}\n"
      "    {}: {}\n"
      "    known: {{translation_m: {}, rotation_rad: {}}}  # 1-sigma of that placement\n"
      "    tags:\n",
      QuotedText(group.name), CarrierName(group.carrier), PlacementKey(group.carrier),
      RigidText(group.carrier_from_group), NumberText(group.translation_sigma_m),
      NumberText(group.rotation_sigma_rad));
  for (const Tag& tag : group.tags) text += TagToYaml(tag);
  return text;
}

}  // namespace

TagLayout ReadTags(const std::filesystem::path& file) {
  const YamlValue root = YamlValue::LoadFile(file);
  root.AllowKeys({"family", "groups"});
  TagLayout layout;
  const TagFamily& family = FamilyFromYaml(root.Get("family"));
  layout.family = family.name;
  Once names_and_ids;
  for (const YamlValue& section : root.Get("groups").List()) {
    layout.groups.push_back(GroupFromYaml(section, family));
    names_and_ids.Demand(section, fmt::format("the name \"{}\"", layout.groups.back().name));
    for (const YamlValue& tag : section.Get("tags").List()) {
      names_and_ids.Demand(tag, fmt::format("the id {}", tag.Get("id").Integer()));
    }
  }
  return layout;
}

void WriteTags(const std::filesystem::path& file, const TagLayout& tags) {
  std::string text = fmt::format(
      "family: {}\n"
      "# corners_m: the black border's bottom-left, bottom-right, top-right, top-left\n"
      "groups:\n",
      tags.family);
  for (const TagGroup& group : tags.groups) text += GroupToYaml(group);
  WriteFileAtomically(file, text);
}

}  // namespace legible
