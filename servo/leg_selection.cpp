#include "servo/leg_selection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "core/robots/leg_state.h"
#include "core/robots/parallel_kinematics.h"

namespace legible {
namespace {

// A servo that ends this near to the goal, m and rad, has reached it.
constexpr double kAtGoal = 1e-4;
// Poses of a simulated way between which it is taken as straight, at most.
constexpr size_t kMostWaypoints = 60;

std::vector<std::vector<int>> SetsOfLegs(const ParallelRobot& robot) {
  const int count = static_cast<int>(robot.legs.size());
  std::vector<std::vector<int>> sets;
  for (unsigned bits = 1; bits < (1u << count); ++bits) {
    std::vector<int> legs;
    for (int leg = 0; leg < count; ++leg)
      if ((bits >> leg & 1u) != 0) legs.push_back(leg);
    sets.push_back(legs);
  }
  std::stable_sort(sets.begin(), sets.end(),
                   [](const auto& a, const auto& b) { return a.size() < b.size(); });
  return sets;
}

// How far the platform joints are from the origin that they turn about, at most.
double PlatformRadius_m(const ParallelRobot& robot) {
  double radius_m = 0;
  for (const RobotLeg& leg : robot.legs) radius_m = std::max(radius_m, leg.platform_joint_m.norm());
  return radius_m;
}

std::optional<LargestPoseError> Larger(const std::optional<LargestPoseError>& a,
                                       const std::optional<LargestPoseError>& b) {
  if (!a || !b) return std::nullopt;
  return LargestPoseError{std::max(a->position_m, b->position_m), std::max(a->rotation_rad, b->rotation_rad)};
}

bool IsAtGoal(const DirectionServoRun& run, const Rigid3& goal) {
  return Displacement(run.samples.back().base_from_platform, goal).norm() < kAtGoal;
}

// Of the simulated poses as many, about equally far from each other, both ends included: time alone would
// leave out most of where the servo is fast.
std::vector<Rigid3> Waypoints(const DirectionServoRun& run, const Rigid3& goal) {
  std::vector<double> way = {0};
  for (size_t i = 1; i < run.samples.size(); ++i)
    way.push_back(
        way.back() +
        Displacement(run.samples[i - 1].base_from_platform, run.samples[i].base_from_platform).norm());
  std::vector<Rigid3> poses;
  double next = 0;
  for (size_t i = 0; i < run.samples.size(); ++i) {
    if (way[i] < next) continue;
    poses.push_back(run.samples[i].base_from_platform);
    next = way[i] + way.back() / kMostWaypoints;
  }
  poses.push_back(goal);
  return poses;
}

class Judge {
 public:
  Judge(const ParallelRobot& robot, const Rigid3& from, const Rigid3& to, const LegSelectionOptions& options)
      : robot_(robot), from_(from), to_(to), options_(options) {}

  JudgedLegSet Judged(const std::vector<int>& legs) const {
    JudgedLegSet set;
    set.legs = legs;
    set.controllability = ControllabilityOf(robot_, legs, to_, SeenFeature::kDirections);
    if (set.controllability.status != ControllabilityStatus::kControllable) {
      RuleOut(set, VerdictOf(set.controllability.status), set.controllability.why);
    } else if (!IsRuledOutAlong({from_, to_}, "start or goal", set)) {
      set.modes = AssemblyModesOf(robot_, legs, to_);
      set.path = CertifyStraightPath(robot_, RobotKind::kHidden, legs, from_, to_);
      set.error_at_goal = ErrorAt(set, to_);
      if (set.path.verdict == PathVerdict::kSingular)
        RuleOut(set, LegSetVerdict::kOtherAspect, set.path.why);
      else
        JudgeBySimulation(set);
    }
    return set;
  }

 private:
  static void RuleOut(JudgedLegSet& set, LegSetVerdict verdict, std::string why) {
    set.verdict = verdict;
    set.why = std::move(why);
  }

  static LegSetVerdict VerdictOf(ControllabilityStatus status) {
    if (status == ControllabilityStatus::kUnreachable) return LegSetVerdict::kOutOfReach;
    return status == ControllabilityStatus::kSingularPose ? LegSetVerdict::kSingularGoal
                                                          : LegSetVerdict::kUncontrollable;
  }

  // By a leg of the robot that does not reach a pose or would leave its joint range there, or one of the set
  // that does not show.
  bool IsRuledOutAlong(const std::vector<Rigid3>& poses, const char* where, JudgedLegSet& set) const {
    for (const Rigid3& pose : poses)
      for (size_t i = 0; i < robot_.legs.size(); ++i) {
        const RobotLeg& leg = robot_.legs[i];
        const auto state = StateOf(leg, pose);
        const bool is_seen =
            std::find(set.legs.begin(), set.legs.end(), static_cast<int>(i)) != set.legs.end();
        const auto rule_out = [&](LegSetVerdict verdict, const char* what) {
          RuleOut(set, verdict, "leg " + std::to_string(i + 1) + what + where);
          return true;
        };
        if (!state) return rule_out(LegSetVerdict::kOutOfReach, " does not reach ");
        if (!IsWithinJointRange(leg, state->reading))
          return rule_out(LegSetVerdict::kOutOfReach, " leaves its joint range on ");
        if (is_seen && options_.is_visible && !options_.is_visible(static_cast<int>(i), pose))
          return rule_out(LegSetVerdict::kInvisible, " does not show on ");
      }
    return false;
  }

  std::optional<LargestPoseError> ErrorAt(const JudgedLegSet& set, const Rigid3& pose) const {
    return LargestErrorByConeNoise(robot_, set.legs, pose, options_.cone_half_angle_rad);
  }

  // An aspect may hold several assembly modes, and the straight path may pass a singularity that the servo's
  // own way does not: only the servo tells where it ends.
  void JudgeBySimulation(JudgedLegSet& set) const {
    std::mt19937 no_noise(0);
    DirectionServoOptions servo = options_.servo;
    servo.cone_half_angle_rad = 0;
    set.simulated = SimulateDirectionServo(robot_, set.legs, from_, to_, servo, no_noise);
    const bool is_free = set.path.verdict == PathVerdict::kFree;
    if (!IsAtGoal(*set.simulated, to_)) {
      const std::string elsewhere =
          std::string("simulated, the servo ends elsewhere: ") + ToString(set.simulated->end);
      return is_free ? RuleOut(set, LegSetVerdict::kMisled, elsewhere)
                     : RuleOut(set, LegSetVerdict::kUndecided, set.path.why + "; " + elsewhere);
    }
    const std::vector<Rigid3> way = Waypoints(*set.simulated, to_);
    if (IsRuledOutAlong(way, "the simulated way", set)) return;
    set.error_on_path = set.error_at_goal;
    for (const Rigid3& pose : way) set.error_on_path = Larger(set.error_on_path, ErrorAt(set, pose));
    CertifyOwnWay(way, set);
  }

  // The steps of a servo that passes near to a singularity can leap over it, and where it ends then depends
  // on little: what is proved free all along does not.
  void CertifyOwnWay(const std::vector<Rigid3>& way, JudgedLegSet& set) const {
    const PathCertificate own_way = CertifyPath(robot_, RobotKind::kHidden, set.legs, way);
    if (own_way.verdict != PathVerdict::kFree)
      return RuleOut(set, LegSetVerdict::kArrives,
                     "simulated, the servo arrives, but its way is not proved free: " + own_way.why);
    set.verdict = LegSetVerdict::kPossible;
    set.path = own_way;
    set.is_path_simulated = true;
  }

  const ParallelRobot& robot_;
  const Rigid3& from_;
  const Rigid3& to_;
  const LegSelectionOptions& options_;
};

void Rank(const ParallelRobot& robot, std::vector<JudgedLegSet>& sets) {
  const double radius_m = PlatformRadius_m(robot);
  const auto displacement_m = [&](const std::optional<LargestPoseError>& error) {
    return error ? error->position_m + radius_m * error->rotation_rad
                 : std::numeric_limits<double>::infinity();
  };
  const auto key = [&](const JudgedLegSet& set) {
    return std::tuple(set.verdict, displacement_m(set.error_at_goal), displacement_m(set.error_on_path));
  };
  std::stable_sort(sets.begin(), sets.end(),
                   [&](const JudgedLegSet& a, const JudgedLegSet& b) { return key(a) < key(b); });
}

void CheckOptions(const ParallelRobot& robot, const LegSelectionOptions& options) {
  if (options.leg_sets.empty() && static_cast<int>(robot.legs.size()) > kMostLegsToChooseFrom)
    throw std::invalid_argument("of more than " + std::to_string(kMostLegsToChooseFrom) +
                                " legs there are too many sets: name some");
}

}  // namespace

const char* ToString(LegSetVerdict verdict) {
  switch (verdict) {
    case LegSetVerdict::kPossible:
      return "possible";
    case LegSetVerdict::kArrives:
      return "arrives";
    case LegSetVerdict::kUndecided:
      return "undecided";
    case LegSetVerdict::kInvisible:
      return "invisible";
    case LegSetVerdict::kUncontrollable:
      return "uncontrollable";
    case LegSetVerdict::kSingularGoal:
      return "singular-goal";
    case LegSetVerdict::kOtherAspect:
      return "other-aspect";
    case LegSetVerdict::kOutOfReach:
      return "out-of-reach";
    case LegSetVerdict::kMisled:
      break;
  }
  return "misled";
}

bool LeadsToGoal(const JudgedLegSet& set) {
  return set.verdict == LegSetVerdict::kPossible || set.verdict == LegSetVerdict::kArrives;
}

LegSelection SelectLegs(const ParallelRobot& robot, const Rigid3& from, const Rigid3& to,
                        const LegSelectionOptions& options,
                        const std::function<void(int judged, int of)>& progress) {
  CheckOptions(robot, options);
  const Judge judge(robot, from, to, options);
  LegSelection selection;
  std::vector<int> every(robot.legs.size());
  std::iota(every.begin(), every.end(), 0);
  selection.robot_path = CertifyStraightPath(robot, RobotKind::kReal, every, from, to);
  const std::vector<std::vector<int>> all = options.leg_sets.empty() ? SetsOfLegs(robot) : options.leg_sets;
  for (size_t i = 0; i < all.size(); ++i) {
    selection.sets.push_back(judge.Judged(all[i]));
    if (progress) progress(static_cast<int>(i) + 1, static_cast<int>(all.size()));
  }
  Rank(robot, selection.sets);
  selection.has_choice =
      LeadsToGoal(selection.sets.front()) && selection.robot_path.verdict != PathVerdict::kSingular;
  return selection;
}

}  // namespace legible
