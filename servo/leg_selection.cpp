#include "servo/leg_selection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <tuple>

#include "core/robots/leg_state.h"
#include "core/robots/straight_path.h"

namespace legible {
namespace {

// A servo that ends this near to the goal, m and rad, has reached it.
constexpr double kAtGoal = 1e-4;
// Poses of a simulated way between which it is taken as straight, at most.
constexpr size_t kMostWaypoints = 200;

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
      : robot_(robot),
        from_(from),
        to_(to),
        options_(options),
        way_(StraightPath(robot, from, to).Poses(options.path_samples)) {}

  JudgedLegSet Judged(const std::vector<int>& legs) const {
    JudgedLegSet set;
    set.legs = legs;
    if (IsRuledOut(set)) return set;
    set.modes = AssemblyModesOf(robot_, legs, to_);
    set.path = CertifyStraightPath(robot_, RobotKind::kHidden, legs, from_, to_);
    PredictErrors(set, *way_);
    if (set.path.verdict == PathVerdict::kFree) {
      set.verdict = LegSetVerdict::kPossible;
    } else if (set.path.verdict == PathVerdict::kSingular || set.path.verdict == PathVerdict::kOutOfReach) {
      set.verdict = set.path.verdict == PathVerdict::kSingular ? LegSetVerdict::kOtherAspect
                                                               : LegSetVerdict::kOutOfReach;
      set.why = set.path.why;
    } else {
      JudgeBySimulation(set);
    }
    return set;
  }

  // And rules the set out where the simulated servo ends elsewhere, or a leg does not show all along its way.
  void Simulate(JudgedLegSet& set) const {
    if (!set.simulated) {
      std::mt19937 no_noise(0);
      DirectionServoOptions servo = options_.servo;
      servo.cone_half_angle_rad = 0;
      set.simulated = SimulateDirectionServo(robot_, set.legs, from_, to_, servo, no_noise);
    }
    if (IsAtGoal(*set.simulated, to_)) {
      IsRuledOutAlong(Waypoints(*set.simulated, to_), set);
      return;
    }
    set.verdict = LegSetVerdict::kMisled;
    set.why = std::string("simulated, the servo ends elsewhere: ") + ToString(set.simulated->end);
  }

 private:
  bool IsRuledOut(JudgedLegSet& set) const {
    const auto rule_out = [&](LegSetVerdict verdict, std::string why) {
      set.verdict = verdict;
      set.why = std::move(why);
      return true;
    };
    set.controllability = ControllabilityOf(robot_, set.legs, to_, SeenFeature::kDirections);
    if (set.controllability.status != ControllabilityStatus::kControllable)
      return rule_out(VerdictOf(set.controllability.status), set.controllability.why);
    if (!way_) return rule_out(LegSetVerdict::kOutOfReach, "RPS legs allow no straight way");
    return IsRuledOutAlong(*way_, set);
  }

  // By a leg that does not reach the way or does not show all along it.
  bool IsRuledOutAlong(const std::vector<Rigid3>& way, JudgedLegSet& set) const {
    for (const Rigid3& pose : way)
      for (const int leg : set.legs) {
        const bool reaches = StateOf(robot_.legs[static_cast<size_t>(leg)], pose).has_value();
        if (reaches && (!options_.is_visible || options_.is_visible(leg, pose))) continue;
        set.verdict = reaches ? LegSetVerdict::kInvisible : LegSetVerdict::kOutOfReach;
        set.why = "leg " + std::to_string(leg + 1) +
                  (reaches ? " does not show all the way" : " does not reach the way");
        return true;
      }
    return false;
  }

  static LegSetVerdict VerdictOf(ControllabilityStatus status) {
    if (status == ControllabilityStatus::kUnreachable) return LegSetVerdict::kOutOfReach;
    return status == ControllabilityStatus::kSingularPose ? LegSetVerdict::kSingularGoal
                                                          : LegSetVerdict::kUncontrollable;
  }

  // At the goal and along a way.
  void PredictErrors(JudgedLegSet& set, const std::vector<Rigid3>& way) const {
    const auto at = [&](const Rigid3& pose) {
      return LargestErrorByConeNoise(robot_, set.legs, pose, options_.cone_half_angle_rad);
    };
    set.error_at_goal = at(to_);
    set.error_on_path = set.error_at_goal;
    for (const Rigid3& pose : way) set.error_on_path = Larger(set.error_on_path, at(pose));
  }

  // The straight path may pass a singularity that the servo's own way does not.
  void JudgeBySimulation(JudgedLegSet& set) const {
    set.verdict = LegSetVerdict::kArrives;
    Simulate(set);
    if (set.verdict == LegSetVerdict::kMisled) {
      set.verdict = LegSetVerdict::kUndecided;
      set.why = set.path.why + "; simulated, the servo ends elsewhere";
    }
    if (set.verdict != LegSetVerdict::kArrives) return;
    const std::vector<Rigid3> waypoints = Waypoints(*set.simulated, to_);
    const PathCertificate own_way = CertifyPath(robot_, RobotKind::kHidden, set.legs, waypoints);
    if (own_way.verdict != PathVerdict::kFree) {
      set.why = set.path.why + "; simulated, the servo arrives, which is no proof";
      return;
    }
    set.path = own_way;
    set.is_path_simulated = true;
    PredictErrors(set, waypoints);
    set.verdict = LegSetVerdict::kPossible;
  }

  const ParallelRobot& robot_;
  const Rigid3& from_;
  const Rigid3& to_;
  const LegSelectionOptions& options_;
  std::optional<std::vector<Rigid3>> way_;  // straight; nothing where RPS legs allow none
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
  if (options.path_samples < 2) throw std::invalid_argument("a way needs two samples or more");
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
  while (LeadsToGoal(selection.sets.front())) {
    judge.Simulate(selection.sets.front());
    selection.has_choice =
        LeadsToGoal(selection.sets.front()) && selection.robot_path.verdict != PathVerdict::kSingular;
    if (LeadsToGoal(selection.sets.front())) break;
    Rank(robot, selection.sets);
  }
  return selection;
}

}  // namespace legible
