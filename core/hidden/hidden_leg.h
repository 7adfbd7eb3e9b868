// The leg of the robot hidden in a servo of leg directions (Briot et al. 2016, section 3.2, Table 1): that
// whose actuated joint is the direction of the seen segment.
#pragma once

#include <string>

#include "core/robots/leg_chain.h"
#include "core/robots/parallel_robot.h"

namespace legible {

struct HiddenLeg {
  // Its chain, actuated where the direction is held; empty where the direction is constant.
  LegChain chain;
  int actuated_coordinates = 0;  // that the direction holds: 1 of a planar leg, 2 of others, 0 if constant
  // Why robots of such legs alone cannot be controlled by their directions; empty where they can.
  std::string why_not_controllable;
};

// By the rules of section 3.2: the joints that lead the seen segment keep its virtual actuator, R or U, in a
// constant orientation (a revolute before it becomes a parallelogram), what was actuated becomes passive, and
// the platform's joint becomes U where a platform of less than six freedoms needs its legs to hold the rest.
// Throws as SeenSegmentOf does.
HiddenLeg HiddenLegOf(const LegChain& chain, PlatformMotion motion);

}  // namespace legible
