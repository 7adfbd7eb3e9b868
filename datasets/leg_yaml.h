// What the legs of every robot's file have in common; for this folder's own .cpp files.
#pragma once

#include <Eigen/Core>
#include <array>

#include "datasets/yaml_value.h"

namespace legible {

// A joint's place (m); throws InputError where it is so far away that it must be in millimetres.
Eigen::Vector3d JointFromYaml(const YamlValue& section);

// A direction of any length, made a unit vector; throws InputError where it has none.
Eigen::Vector3d AxisFromYaml(const YamlValue& section);

// [least, largest], m or rad.
std::array<double, 2> JointRangeFromYaml(const YamlValue& section);

// Throws the InputError of a leg section whose shortest length is not more than its radius.
void DemandLongerThanThick(const YamlValue& section, double shortest_m, double radius_m);

}  // namespace legible
