#include "core/hidden/hidden_leg.h"

#include <algorithm>

namespace legible {
namespace {

bool HasSphericalEnd(JointType type) {
  return type == JointType::kSpherical || type == JointType::kParallelRodsUS;
}

JointType WithUniversalEnd(JointType type) {
  return type == JointType::kSpherical ? JointType::kUniversal : JointType::kParallelRodsUU;
}

// The joint that turns the seen segment: the last one before the platform's joint that is not prismatic, or
// parallel rods.
size_t DirectingJoint(const LegChain& chain) {
  for (size_t i = chain.size(); i-- > 0;) {
    const bool is_rods =
        chain[i].type == JointType::kParallelRodsUS || chain[i].type == JointType::kParallelRodsUU;
    if (is_rods) return i;
    if (i + 1 < chain.size() && chain[i].type != JointType::kPrismatic) return i;
  }
  return 0;
}

}  // namespace

HiddenLeg HiddenLegOf(const LegChain& chain, PlatformMotion motion) {
  const SeenSegment segment = SeenSegmentOf(chain);
  HiddenLeg hidden;
  if (segment.direction == DirectionOf::kConstant) {
    hidden.why_not_controllable = "the direction of its last segment is constant";
    return hidden;
  }
  hidden.chain = chain;
  const size_t directing = DirectingJoint(chain);
  for (size_t i = 0; i < chain.size(); ++i) {
    ChainJoint& joint = hidden.chain[i];
    joint.is_actuated = i == directing;
    if (i < directing && joint.type == JointType::kRevolute) joint.type = JointType::kParallelogram;
  }
  JointType& last = hidden.chain.back().type;
  if (motion != PlatformMotion::kSpatial && HasSphericalEnd(last)) last = WithUniversalEnd(last);
  const bool is_planar = IsPlanar(chain) || chain[directing].type == JointType::kRevolute;
  hidden.actuated_coordinates = is_planar ? 1 : 2;
  if (segment.direction == DirectionOf::kPlatform)
    hidden.why_not_controllable =
        "the direction of its last segment is fixed in the platform: it tells the "
        "platform's orientation and nothing else";
  return hidden;
}

}  // namespace legible
