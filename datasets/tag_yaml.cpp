#include "datasets/tag_yaml.h"

#include <fmt/format.h>

#include <algorithm>

#include "datasets/text.h"

namespace legible {
namespace {

// The smallest triangle of three neighbouring corners over the half of what the diagonals span: 1 for a
// square, 0 where corners coincide or three of them lie on a line.
double Fullness(const std::array<Eigen::Vector3d, 4>& corners_m) {
  const double whole = (corners_m[2] - corners_m[0]).cross(corners_m[3] - corners_m[1]).norm();
  double least = whole;
  for (size_t i = 0; i < 4; ++i)
    least = std::min(
        least, (corners_m[(i + 1) % 4] - corners_m[i]).cross(corners_m[(i + 2) % 4] - corners_m[i]).norm());
  return whole > 0 ? 2 * least / whole : 0;
}

}  // namespace

const TagFamily& FamilyFromYaml(const YamlValue& value) {
  const std::string name = value.Text();
  std::vector<std::string> names;
  for (const TagFamily& family : kTagFamilies) {
    if (family.name == name) return family;
    names.push_back(family.name);
  }
  value.Fail(fmt::format("is \"{}\", which libapriltag does not have", name),
             fmt::format("the nearest that it has is {}", NearestName(name, names)));
}

int TagIdFromYaml(const YamlValue& section, const TagFamily& family) {
  const int id = section.Get("id").Integer();
  if (id < 0 || id >= family.tags)
    section.Fail(fmt::format("has the id {}", id),
                 fmt::format("{} has the ids 0 to {}", family.name, family.tags - 1));
  return id;
}

void DemandSquare(const YamlValue& corners, const std::array<Eigen::Vector3d, 4>& corners_m) {
  constexpr double kLeastFullness = 0.1;
  if (Fullness(corners_m) < kLeastFullness) {
    corners.Fail("are not those of a square",
                 "give bottom-left, bottom-right, top-right, top-left of the black border");
  }
}

void Once::Demand(const YamlValue& section, const std::string& what) {
  if (!seen_.insert(what).second)
    section.Fail(fmt::format("has {}, which is there already", what), "keep one");
}

}  // namespace legible
