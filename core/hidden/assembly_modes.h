// Every pose at which the observed legs have the same directions: the assembly modes of the hidden robot
// (Briot et al. 2016, sections 3.3 and 4).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/robots/parallel_robot.h"

namespace legible {

struct AssemblyMode {
  Rigid3 base_from_platform;
  // Largest difference of a seen direction, unit vectors, from what was asked for.
  double largest_direction_error = 0;
  // Every seen leg has the working mode that it has at home, and no extending leg points the other way: only
  // such modes are reached without passing a Type 1 singularity.
  bool has_own_working_modes = true;
};

enum class AssemblyModesStatus {
  kComplete,     // proved: there are no others
  kIncomplete,   // others are not excluded, see `why`
  kInfinite,     // the directions do not hold the platform, see `why`
  kUnreachable,  // a seen leg does not reach the pose that the directions are of
};
const char* ToString(AssemblyModesStatus status);

struct AssemblyModes {
  AssemblyModesStatus status = AssemblyModesStatus::kIncomplete;
  std::vector<AssemblyMode> modes;  // by increasing distance from the pose asked for, which comes first
  // Poses at which an extending leg points exactly against its direction: e = u x u* is zero there too.
  std::vector<Rigid3> reversed;
  int most_possible = 0;  // that the family has by theory: 16 to 2; 0 where it is not solved for
  std::string why;        // in words, where not complete
};

// The modes of the hidden robot whose seen legs (from 0) have the directions that they have at the pose,
// among poses that the platform can take. More legs than the platform needs are sieved from those of the
// fewest that are solved for. Not solved for, and incomplete, are spatial platforms with joints on circles
// (RUS) and on lines, and fewer legs that tell their place than three (planar and spatial platforms) or two,
// where RPS legs or a direction fixed in the platform hold the rest. Infinite is said where the legs tell of
// as many motions of the platform at the pose as around it, and not of all (ControllabilityOf), and of
// singular poses where the fewest legs there can be leave it free, or parallel lines. Throws
// std::invalid_argument for a leg that is not there or named twice.
AssemblyModes AssemblyModesOf(const ParallelRobot& robot, const std::vector<int>& legs,
                              const Rigid3& base_from_platform);

}  // namespace legible
