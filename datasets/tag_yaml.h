// What files of tags have in common; for this folder's own .cpp files.
#pragma once

#include <Eigen/Core>
#include <array>
#include <set>
#include <string>

#include "core/session/session.h"
#include "datasets/yaml_value.h"

namespace legible {

const TagFamily& FamilyFromYaml(const YamlValue& value);

// The `id` of a tag's section, one of the family's.
int TagIdFromYaml(const YamlValue& section, const TagFamily& family);

// Throws the InputError of corners that coincide, or of which three lie on a line.
void DemandSquare(const YamlValue& corners, const std::array<Eigen::Vector3d, 4>& corners_m);

// A name or an id that is there already means that the file contradicts itself.
class Once {
 public:
  // Throws the InputError of a section that has what another one had.
  void Demand(const YamlValue& section, const std::string& what);

 private:
  std::set<std::string> seen_;
};

}  // namespace legible
