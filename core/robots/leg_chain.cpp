#include "core/robots/leg_chain.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace legible {
namespace {

// The longer of two spellings that begin alike comes first; the first of a type is the one written.
constexpr std::array<std::pair<std::string_view, JointType>, 8> kSpellings = {{
    {"{2-US}", JointType::kParallelRodsUS},
    {"{2-UU}", JointType::kParallelRodsUU},
    {"Π", JointType::kParallelogram},
    {"Pi", JointType::kParallelogram},
    {"R", JointType::kRevolute},
    {"P", JointType::kPrismatic},
    {"U", JointType::kUniversal},
    {"S", JointType::kSpherical},
}};

bool AreRods(JointType type) {
  return type == JointType::kParallelRodsUS || type == JointType::kParallelRodsUU;
}

bool IsRevoluteOrPrismatic(JointType type) {
  return type == JointType::kRevolute || type == JointType::kPrismatic;
}

[[noreturn]] void ThrowUnknownChain(const LegChain& chain, const char* what) {
  throw std::invalid_argument("the leg " + ToText(chain) + " " + what);
}

// Types of the joints, parallel rods as the two joints at their ends.
std::vector<JointType> WithRodsOpened(const LegChain& chain) {
  std::vector<JointType> types;
  for (const ChainJoint& joint : chain) {
    if (!AreRods(joint.type)) {
      types.push_back(joint.type);
      continue;
    }
    types.push_back(JointType::kUniversal);
    types.push_back(joint.type == JointType::kParallelRodsUS ? JointType::kSpherical : JointType::kUniversal);
  }
  return types;
}

void CheckActuation(const LegChain& chain) {
  const auto actuated =
      std::count_if(chain.begin(), chain.end(), [](const auto& j) { return j.is_actuated; });
  if (actuated != 1) ThrowUnknownChain(chain, "needs exactly one actuated joint: mark it by an underscore");
  const ChainJoint& last = chain.back();
  if (last.is_actuated)
    ThrowUnknownChain(chain, "has its actuated joint at the platform: mark one before it");
  for (const ChainJoint& joint : chain)
    if (joint.is_actuated && joint.type != JointType::kRevolute && joint.type != JointType::kPrismatic)
      ThrowUnknownChain(chain, "has an actuated joint that is neither R nor P");
}

}  // namespace

bool operator==(const ChainJoint& a, const ChainJoint& b) {
  return a.type == b.type && a.is_actuated == b.is_actuated;
}

LegChain ChainFromText(std::string_view text) {
  LegChain chain;
  bool is_actuated = false;
  for (std::string_view rest = text; !rest.empty();) {
    const char first = rest.front();
    if (first == '_' || first == '-' || first == ' ') {
      is_actuated = is_actuated || first == '_';
      rest.remove_prefix(1);
      continue;
    }
    const auto* spelling = std::find_if(kSpellings.begin(), kSpellings.end(),
                                        [&](const auto& s) { return rest.starts_with(s.first); });
    if (spelling == kSpellings.end())
      throw std::invalid_argument("\"" + std::string(rest) + "\" in the leg \"" + std::string(text) +
                                  "\" begins with no joint: R, P, U, S, Π, {2-US} and {2-UU} are known");
    chain.push_back({spelling->second, std::exchange(is_actuated, false)});
    rest.remove_prefix(spelling->first.size());
  }
  if (is_actuated)
    throw std::invalid_argument("the underscore at the end of the leg \"" + std::string(text) +
                                "\" marks no joint: it stands before the actuated one");
  return chain;
}

std::string ToText(const LegChain& chain) {
  std::string text;
  for (const ChainJoint& joint : chain) {
    if (AreRods(joint.type) && !text.empty()) text += '-';
    if (joint.is_actuated) text += '_';
    const auto* spelling = std::find_if(kSpellings.begin(), kSpellings.end(),
                                        [&](const auto& s) { return s.second == joint.type; });
    text += spelling->first;
  }
  return text;
}

SeenSegment SeenSegmentOf(const LegChain& chain) {
  const std::vector<JointType> joints = WithRodsOpened(chain);
  if (joints.size() != 3)
    ThrowUnknownChain(chain, "has not three joints, as all legs whose kinematics are known");
  CheckActuation(chain);
  const auto [first, second, last] = std::array{joints[0], joints[1], joints[2]};
  const bool starts_on_rail = first == JointType::kPrismatic;
  const bool starts_on_arm = first == JointType::kRevolute;
  const Carrier carrier = starts_on_rail ? Carrier::kLine : Carrier::kCircle;

  if (starts_on_rail && second == JointType::kPrismatic && last == JointType::kRevolute)
    return {Carrier::kLine, true, DirectionOf::kConstant};
  const bool is_planar =
      IsRevoluteOrPrismatic(first) && IsRevoluteOrPrismatic(second) && IsRevoluteOrPrismatic(last);
  const bool ends_freely = last == JointType::kUniversal || last == JointType::kSpherical;
  const bool ends_in_rotation = is_planar ? last == JointType::kRevolute : ends_freely;
  if ((first == JointType::kRevolute || first == JointType::kUniversal) && second == JointType::kPrismatic &&
      ends_in_rotation)
    return {Carrier::kFixed, true, DirectionOf::kLeg};
  if ((starts_on_rail || starts_on_arm) && second == JointType::kRevolute && last == JointType::kPrismatic)
    return {carrier, true, DirectionOf::kPlatform};
  const bool turns_freely = is_planar ? second == JointType::kRevolute : second == JointType::kUniversal;
  if ((starts_on_rail || starts_on_arm) && turns_freely && ends_in_rotation)
    return {carrier, false, DirectionOf::kLeg};
  ThrowUnknownChain(chain,
                    "is none of those known: UPS, UPU, RPS, RPR, RRR, PRR, RUU, RUS, PUU, PUS, R-{2-US}, "
                    "P-{2-US}, PPR, PRP, RRP");
}

bool IsPlanar(const LegChain& chain) {
  return std::all_of(chain.begin(), chain.end(),
                     [](const ChainJoint& joint) { return IsRevoluteOrPrismatic(joint.type); });
}

bool ReadsAngle(const LegChain& chain) {
  return std::any_of(chain.begin(), chain.end(), [](const ChainJoint& joint) {
    return joint.is_actuated && joint.type == JointType::kRevolute;
  });
}

}  // namespace legible
