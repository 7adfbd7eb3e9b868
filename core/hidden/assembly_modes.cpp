#include "core/hidden/assembly_modes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "core/algebra/ball.h"
#include "core/hidden/controllability.h"
#include "core/hidden/mode_candidates.h"
#include "core/robots/leg_geometry.h"
#include "core/robots/leg_state.h"
#include "core/robots/platform_motion.h"

namespace legible {
namespace {

// A mode's directions agree this well once its pose is polished; candidates are that far off at most before.
constexpr double kSameDirection = 1e-9;
constexpr double kNearDirection = 1e-5;
constexpr double kNearPose = 1e-7;    // m, rad: of a candidate from the pose that it stands for
constexpr double kMostPolish = 1e-3;  // m, rad: farther away it is another pose
constexpr double kSamePose = 1e-8;    // m, rad
constexpr double kLeastSine = 1e-9;   // of two directions that are not parallel
constexpr int kPolishSteps = 10;

// A seen leg: of both working modes, for the hidden robot's arm turns freely.
struct SeenLeg {
  RobotLeg leg;
  Eigen::Vector3d direction;  // wanted
  bool tells_place = false;   // of its platform joint, and not of the platform's rotation alone
  bool is_held = false;       // candidates are poses that put its platform joint where the direction allows
};

size_t FewestLegs(PlatformMotion motion) {
  return motion == PlatformMotion::kPlanar || motion == PlatformMotion::kSpatial ? 3 : 2;
}

// Why the poses of joints held in these spaces are not solved for; nothing where they are.
const char* WhyNotSolved(PlatformMotion motion, const std::vector<HeldJoint>& held) {
  const auto circles =
      std::count_if(held.begin(), held.end(), [](const HeldJoint& joint) { return joint.space.is_circle; });
  if (motion == PlatformMotion::kSpatial && circles > 0 && circles < 3)
    return "legs that hold their platform joints on lines and on circles are not solved for";
  return nullptr;
}

// Lines alone, along which the platform translates with its joints on them.
bool AreParallelLines(const std::vector<HeldJoint>& held) {
  return std::all_of(held.begin(), held.end(), [&](const HeldJoint& joint) {
    return !joint.space.is_circle && !held[0].space.is_circle &&
           joint.space.along.cross(held[0].space.along).norm() < kLeastSine;
  });
}

ModeCandidates CandidatesOf(PlatformMotion motion, const std::vector<HeldJoint>& held, const Rigid3& home) {
  if (const char* why = WhyNotSolved(motion, held)) {
    ModeCandidates none;
    none.why = why;
    return none;
  }
  if (AreParallelLines(held)) {
    ModeCandidates infinite;
    infinite.is_infinite = true;
    infinite.why = "the lines along which the seen legs leave the platform free are parallel";
    return infinite;
  }
  switch (motion) {
    case PlatformMotion::kPlanarPoint:
      return PlanarPointCandidates(held, home);
    case PlatformMotion::kPlanar:
      return PlanarCandidates(held, home);
    case PlatformMotion::kTranslation:
      return TranslationCandidates(held, home);
    case PlatformMotion::kSchoenflies:
      return SchoenfliesCandidates(held, home);
    case PlatformMotion::kSpatial:
      break;
  }
  return SpatialCandidates(held, home);
}

void CheckLegs(const ParallelRobot& robot, const std::vector<int>& legs) {
  std::set<int> seen;
  for (const int leg : legs) {
    if (leg < 0 || leg >= static_cast<int>(robot.legs.size()))
      throw std::invalid_argument("there is no leg " + std::to_string(leg + 1) + ": the robot has " +
                                  std::to_string(robot.legs.size()));
    if (!seen.insert(leg).second)
      throw std::invalid_argument("leg " + std::to_string(leg + 1) + " is named twice");
  }
}

HeldJoint HeldJointOf(const SeenLeg& seen) {
  return {seen.leg.platform_joint_m, seen.leg.carried_offset_m, VertexSpaceOf(seen.leg, seen.direction)};
}

// The leg at the pose with the working mode whose direction is nearer to the wanted one.
struct NearestState {
  LegState state;
  bool is_own_mode = true;
  double error = 0;
};
std::optional<NearestState> NearestStateOf(const SeenLeg& seen, const Rigid3& pose) {
  std::optional<NearestState> nearest;
  for (const int sign : {1, -1}) {
    RobotLeg leg = seen.leg;
    leg.working_mode *= sign;
    const auto state = StateOf(leg, pose);
    if (!state) continue;
    const double error = (state->direction - seen.direction).norm();
    if (!nearest || error < nearest->error) nearest = NearestState{*state, sign == 1, error};
  }
  return nearest;
}

double Distance(const Rigid3& a, const Rigid3& b) { return Displacement(a, b).norm(); }

// Gauss-Newton on the directions, to rounding.
Rigid3 Polished(const ParallelRobot& robot, const std::vector<SeenLeg>& seen, Rigid3 pose) {
  for (int step = 0; step < kPolishSteps; ++step) {
    const auto basis = MotionBasis(robot, pose);
    const auto rows = static_cast<Eigen::Index>(3 * seen.size());
    Eigen::MatrixXd interaction(rows, 6);
    Eigen::VectorXd errors(rows);
    for (size_t i = 0; i < seen.size(); ++i) {
      const auto nearest = NearestStateOf(seen[i], pose);
      if (!nearest) return pose;
      const auto at = static_cast<Eigen::Index>(3 * i);
      interaction.middleRows<3>(at) = DirectionInteraction(seen[i].leg, nearest->state, pose);
      errors.segment<3>(at) = seen[i].direction - nearest->state.direction;
    }
    const Eigen::MatrixXd matrix = interaction * basis;
    const Vector6d twist = basis * matrix.completeOrthogonalDecomposition().solve(errors);
    pose = BackToMotion(robot, Displaced(pose, twist));
    if (twist.norm() < 1e-15) break;
  }
  return pose;
}

enum class Judged {
  kMode,
  kReversed,
  kOther,     // some seen leg points elsewhere
  kDoubtful,  // too near a stretched or folded leg, or what RPS legs allow, to tell
};

struct JudgedPose {
  Judged as = Judged::kOther;
  AssemblyMode mode;
};

// Whether the leg is stretched or folded, or may be, somewhere as near to the candidate as the pose is that
// this stands for.
bool IsJustReached(const RobotLeg& leg, const Rigid3& candidate) {
  const auto near = [](double x) { return RealBall(x, kNearPose); };
  const Eigen::Matrix3d rotation = candidate.rotation.toRotationMatrix();
  const auto placed =
      leg_geometry::Placed<RealBall>(leg, {candidate.translation.unaryExpr(near), rotation.unaryExpr(near)});
  return Contains(placed.reached.reach, 0);
}

// Before it is polished.
Judged JudgeDirections(const std::vector<SeenLeg>& seen, const Rigid3& candidate) {
  bool is_doubtful = false, is_reversed = false;
  for (const SeenLeg& leg : seen) {
    const auto nearest = NearestStateOf(leg, candidate);
    const double against = nearest ? (nearest->state.direction + leg.direction).norm() : 0;
    is_reversed = is_reversed || (nearest && against < kNearDirection);
    if (nearest && std::min(nearest->error, against) < kNearDirection) continue;
    // A leg that was held there can but be so near to stretched or folded that rounding turns it.
    if (!leg.is_held && !IsJustReached(leg.leg, candidate)) return Judged::kOther;
    is_doubtful = true;
  }
  return is_doubtful ? Judged::kDoubtful : is_reversed ? Judged::kReversed : Judged::kMode;
}

// Whether the candidate, once polished, is a mode.
JudgedPose Judge(const ParallelRobot& robot, const std::vector<SeenLeg>& seen, const Rigid3& candidate) {
  JudgedPose judged{Judged::kOther, {candidate, 0, true}};
  if (!CanTake(robot, candidate, kNearPose)) return judged;  // a leg that is not seen, of RPS, forbids it
  judged.as = JudgeDirections(seen, candidate);
  if (judged.as != Judged::kMode) return judged;
  judged.as = Judged::kDoubtful;
  const Rigid3 polished = Polished(robot, seen, BackToMotion(robot, candidate));
  if (!CanTake(robot, polished) || Distance(candidate, polished) > kMostPolish) return judged;
  judged.mode.base_from_platform = polished;
  for (const SeenLeg& leg : seen) {
    const auto nearest = NearestStateOf(leg, judged.mode.base_from_platform);
    if (!nearest) return judged;
    judged.mode.largest_direction_error = std::max(judged.mode.largest_direction_error, nearest->error);
    judged.mode.has_own_working_modes = judged.mode.has_own_working_modes && nearest->is_own_mode;
  }
  if (judged.mode.largest_direction_error < kSameDirection) judged.as = Judged::kMode;
  return judged;
}

// As indices into `seen`.
std::vector<size_t> LegsThatTellPlaces(const std::vector<SeenLeg>& seen) {
  std::vector<size_t> legs;
  for (size_t i = 0; i < seen.size(); ++i)
    if (seen[i].tells_place) legs.push_back(i);
  return legs;
}

std::vector<HeldJoint> HeldJointsOf(const std::vector<SeenLeg>& seen, const std::vector<size_t>& legs) {
  std::vector<HeldJoint> held;
  held.reserve(legs.size());
  for (const size_t i : legs) held.push_back(HeldJointOf(seen[i]));
  return held;
}

// Every subset of the fewest of these legs, indices into `seen`, that whose hidden robot is farthest from a
// singularity at the pose first.
std::vector<std::vector<size_t>> SubsetsByConditioning(const ParallelRobot& robot,
                                                       const std::vector<SeenLeg>& seen,
                                                       const std::vector<size_t>& legs, const Rigid3& pose) {
  const size_t fewest = FewestLegs(robot.motion);
  const auto basis = MotionBasis(robot, pose);
  std::vector<bool> is_in(legs.size(), false);
  std::fill_n(is_in.begin(), fewest, true);
  std::vector<std::pair<double, std::vector<size_t>>> subsets;
  do {
    std::vector<size_t> chosen;
    for (size_t i = 0; i < legs.size(); ++i)
      if (is_in[i]) chosen.push_back(legs[i]);
    Eigen::MatrixXd matrix(3 * fewest, basis.cols());
    for (size_t k = 0; k < fewest; ++k) {
      const SeenLeg& leg = seen[chosen[k]];
      matrix.middleRows<3>(static_cast<Eigen::Index>(3 * k)) =
          DirectionInteraction(leg.leg, *StateOf(leg.leg, pose), pose) * basis;
    }
    subsets.emplace_back(matrix.jacobiSvd().singularValues().tail<1>()[0], std::move(chosen));
  } while (std::prev_permutation(is_in.begin(), is_in.end()));
  std::stable_sort(subsets.begin(), subsets.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::vector<size_t>> ordered;
  ordered.reserve(subsets.size());
  for (auto& [value, subset] : subsets) ordered.push_back(std::move(subset));
  return ordered;
}

// By the first subset that is solved for and does not leave the platform free by itself; where there is none,
// what is wrong with the first.
struct FewestSolved {
  ModeCandidates candidates;
  std::vector<size_t> legs;  // of the subset, as indices into those seen
};
FewestSolved CandidatesOfFewest(const ParallelRobot& robot, const std::vector<SeenLeg>& seen,
                                const Rigid3& pose) {
  FewestSolved first;
  const std::vector<size_t> legs = LegsThatTellPlaces(seen);
  if (legs.size() < FewestLegs(robot.motion)) {
    first.candidates.why = "fewer legs whose directions tell their places than " +
                           std::to_string(FewestLegs(robot.motion)) + " are not solved for";
    return first;
  }
  for (const std::vector<size_t>& subset : SubsetsByConditioning(robot, seen, legs, pose)) {
    ModeCandidates candidates = CandidatesOf(robot.motion, HeldJointsOf(seen, subset), robot.home);
    if (candidates.most_possible > 0 && !candidates.is_infinite) return {std::move(candidates), subset};
    if (first.legs.empty()) first = {std::move(candidates), subset};
  }
  return first;
}

// Whether legs of which every subset leaves the platform free leave it so together, at a singular pose: by
// the same motion if there is one subset alone or all lines are parallel, and no RPS leg forbids it.
bool AreFreeTogether(const ParallelRobot& robot, const std::vector<int>& legs,
                     const std::vector<SeenLeg>& seen, const Rigid3& pose) {
  if (robot.motion == PlatformMotion::kSpatial && MotionBasis(robot, pose).cols() < 6) return false;
  return legs.size() == FewestLegs(robot.motion) ||
         AreParallelLines(HeldJointsOf(seen, LegsThatTellPlaces(seen)));
}

AssemblyModes WithoutModes(AssemblyModesStatus status, std::string why) {
  AssemblyModes modes;
  modes.status = status;
  modes.why = std::move(why);
  return modes;
}

void TakeCandidates(const ParallelRobot& robot, const std::vector<SeenLeg>& seen, const Rigid3& pose,
                    const std::vector<Rigid3>& candidates, AssemblyModes& modes) {
  for (const Rigid3& candidate : candidates) {
    const JudgedPose judged = Judge(robot, seen, candidate);
    if (judged.as == Judged::kReversed) modes.reversed.push_back(candidate);
    if (judged.as == Judged::kDoubtful) {
      modes.status = AssemblyModesStatus::kIncomplete;
      modes.why =
          "a pose where a seen leg is all but stretched or folded, or that RPS legs all but allow, could not "
          "be "
          "told from a mode";
    }
    if (judged.as != Judged::kMode) continue;
    const bool is_known = std::any_of(modes.modes.begin(), modes.modes.end(), [&](const AssemblyMode& known) {
      return Distance(known.base_from_platform, judged.mode.base_from_platform) < kSamePose;
    });
    if (!is_known) modes.modes.push_back(judged.mode);
  }
  std::stable_sort(modes.modes.begin(), modes.modes.end(), [&](const AssemblyMode& a, const AssemblyMode& b) {
    return Distance(pose, a.base_from_platform) < Distance(pose, b.base_from_platform);
  });
}

// Whether from the pose the platform moves with every direction held: by the constant rank theorem, where
// they tell of as many of its motions around the pose as at the pose.
bool LeaveFree(const Controllability& control) {
  return control.status == ControllabilityStatus::kUncontrollable &&
         control.fewest_unseen_around == control.unseen_twists.cols();
}

// Legs whose direction tells something of where the platform is; all reach the pose.
std::vector<SeenLeg> TellingLegs(const ParallelRobot& robot, const std::vector<int>& legs,
                                 const Rigid3& pose) {
  std::vector<SeenLeg> seen;
  for (const int leg : legs) {
    const RobotLeg& it = robot.legs[static_cast<size_t>(leg)];
    const DirectionOf direction = SeenSegmentOf(it.chain).direction;
    if (direction != DirectionOf::kConstant)
      seen.push_back({it, StateOf(it, pose)->direction, direction == DirectionOf::kLeg, false});
  }
  return seen;
}

}  // namespace

const char* ToString(AssemblyModesStatus status) {
  switch (status) {
    case AssemblyModesStatus::kComplete:
      return "complete";
    case AssemblyModesStatus::kIncomplete:
      return "incomplete";
    case AssemblyModesStatus::kInfinite:
      return "infinite";
    case AssemblyModesStatus::kUnreachable:
      break;
  }
  return "unreachable";
}

AssemblyModes AssemblyModesOf(const ParallelRobot& robot, const std::vector<int>& legs,
                              const Rigid3& base_from_platform) {
  CheckLegs(robot, legs);
  if (legs.empty()) return WithoutModes(AssemblyModesStatus::kInfinite, "no leg is seen");
  const Controllability control =
      ControllabilityOf(robot, legs, base_from_platform, SeenFeature::kDirections);
  if (control.status == ControllabilityStatus::kUnreachable)
    return WithoutModes(AssemblyModesStatus::kUnreachable, control.why);
  if (LeaveFree(control)) return WithoutModes(AssemblyModesStatus::kInfinite, control.why);
  std::vector<SeenLeg> seen = TellingLegs(robot, legs, base_from_platform);
  const auto [candidates, held] = CandidatesOfFewest(robot, seen, base_from_platform);
  if (candidates.is_infinite && control.status != ControllabilityStatus::kControllable &&
      AreFreeTogether(robot, legs, seen, base_from_platform))
    return WithoutModes(AssemblyModesStatus::kInfinite, candidates.why);
  // Two directions over-determine a translation: its candidates are near at best.
  for (const size_t i : held) seen[i].is_held = robot.motion != PlatformMotion::kTranslation;
  AssemblyModes modes;
  modes.most_possible = candidates.most_possible;
  modes.status = candidates.is_complete ? AssemblyModesStatus::kComplete : AssemblyModesStatus::kIncomplete;
  modes.why = candidates.why;
  if (control.status == ControllabilityStatus::kUncontrollable) {
    modes.status = AssemblyModesStatus::kIncomplete;
    modes.why =
        "the directions do not hold the platform around the pose; whether they do at the pose, which is "
        "singular besides, is not known";
  }
  std::vector<Rigid3> poses = candidates.poses;
  poses.push_back(base_from_platform);
  TakeCandidates(robot, seen, base_from_platform, poses, modes);
  return modes;
}

}  // namespace legible
