// A leg of a parallel robot as its chain of joints: from this the real leg's kinematics and the hidden leg
// (Briot et al. 2016, section 3.2) both follow.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace legible {

enum class JointType {
  kRevolute,        // R
  kPrismatic,       // P
  kUniversal,       // U
  kSpherical,       // S
  kParallelogram,   // Π, planar: its far link only translates, on a circle
  kParallelRodsUS,  // {2-US}, two parallel rods as long as each other
  kParallelRodsUU,  // {2-UU}
};

struct ChainJoint {
  JointType type = JointType::kRevolute;
  bool is_actuated = false;
};
bool operator==(const ChainJoint& a, const ChainJoint& b);

// Joints from the base to the platform. Segment k is what joint k leads (both from 0); parallel rods are the
// segment of their own joint.
using LegChain = std::vector<ChainJoint>;

// "R_RR", "U_PS", "_R-{2-US}": letters as in the papers, an underscore before each actuated joint, a planar
// parallelogram as "Π" or "Pi". Dashes and blanks between joints mean nothing.
// Throws std::invalid_argument that quotes what is no joint.
LegChain ChainFromText(std::string_view text);
std::string ToText(const LegChain& chain);

// How the first joints carry the start of the seen segment.
enum class Carrier {
  kFixed,   // it does not move
  kLine,    // along the direction of a prismatic joint
  kCircle,  // about the axis of a revolute joint
};

// What the direction of the seen segment depends on.
enum class DirectionOf {
  kConstant,  // on nothing: only prismatic joints lead it
  kLeg,       // on the leg's own rotational joint
  kPlatform,  // on the platform's orientation alone: it is a prismatic joint's rod, fixed in the platform
};

// What the seen segment, the last one before the platform's joint, does.
struct SeenSegment {
  Carrier carrier = Carrier::kFixed;
  bool extends = false;  // its length is that of a prismatic joint; else it is constant
  DirectionOf direction = DirectionOf::kLeg;
};

// Throws std::invalid_argument, which quotes the chain, unless it is one of those whose kinematics are known:
// RPR, RRR, PRR, PPR, PRP and RRP in the plane; UPX, RPX, RUX, PUX with X a U or S, or parallel rods for UX,
// with one actuated joint among the joints that lead the seen segment.
SeenSegment SeenSegmentOf(const LegChain& chain);

// Whether it has no joints but R and P: a leg of a planar robot.
bool IsPlanar(const LegChain& chain);

// Whether the actuated joint's reading is an angle (rad); else it is a length or position (m).
bool ReadsAngle(const LegChain& chain);

}  // namespace legible
