#include "core/hidden/controllability.h"

#include <Eigen/Dense>
#include <algorithm>
#include <optional>
#include <random>

#include "core/hidden/hidden_leg.h"
#include "core/hidden/singularity_conditions.h"
#include "core/robots/platform_motion.h"

namespace legible {
namespace {

// Of the largest singular value; lengths are made comparable to directions by the robot's size.
constexpr double kLeastSingularValue = 1e-9;
constexpr int kOtherPoses = 8;
constexpr double kOtherPoseStep = 0.1;
// Of poses nearer than that rounding hides what more is seen there.
constexpr double kLeastPoseStep = 1e-5;
constexpr unsigned kSeed = 20160715;

struct Rank {
  int seen = 0, freedoms = 0;
  Eigen::Matrix<double, 6, Eigen::Dynamic> unseen_twists;

  int unseen() const { return freedoms - seen; }
};

// With angles in radians and lengths in the robot's size; nothing where a leg does not reach.
std::optional<Rank> RankAt(const ParallelRobot& robot, const std::vector<int>& legs, const Rigid3& pose,
                           SeenFeature feature) {
  auto interaction = FeatureInteraction(robot, legs, pose, feature);
  if (!interaction) return std::nullopt;
  const double size_m = SizeOf_m(robot, pose);
  if (feature == SeenFeature::kLines)
    for (Eigen::Index row = 3; row < interaction->rows(); row += 6) interaction->middleRows<3>(row) /= size_m;
  const auto basis = MotionBasisInSize(robot, pose, size_m);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(*interaction * basis, Eigen::ComputeFullV);
  const auto& values = svd.singularValues();
  Rank rank;
  rank.freedoms = static_cast<int>(basis.cols());
  const double least = kLeastSingularValue * std::max(values[0], 1.0);
  rank.seen = static_cast<int>((values.array() > least).count());
  rank.unseen_twists = (basis * svd.matrixV().rightCols(rank.unseen())).colwise().normalized();
  return rank;
}

// A pose around the given one that the robot can take; the step in rad and in the robot's size.
Rigid3 Nearby(const ParallelRobot& robot, const Rigid3& pose, double step, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto basis = MotionBasis(robot, pose);
  Eigen::VectorXd coordinates(basis.cols());
  for (double& coordinate : coordinates) coordinate = uniform(random);
  Vector6d twist = step * (basis * coordinates);
  twist.head<3>() *= SizeOf_m(robot, pose);
  return BackToMotion(robot, Displaced(pose, twist));
}

// The fewest freedoms that are not seen at poses around; nothing where none is reached.
std::optional<int> FewestUnseenAround(const ParallelRobot& robot, const std::vector<int>& legs,
                                      const Rigid3& pose, SeenFeature feature) {
  std::mt19937 random(kSeed);
  double step = kOtherPoseStep;
  std::optional<int> fewest;
  for (int reached = 0; reached < kOtherPoses && step > kLeastPoseStep;) {
    const auto rank = RankAt(robot, legs, Nearby(robot, pose, step, random), feature);
    if (!rank) {
      step /= 2;
      continue;
    }
    fewest = std::min(fewest.value_or(rank->unseen()), rank->unseen());
    ++reached;
  }
  return fewest;
}

std::string AboutUnseen(const Rank& rank) {
  if (rank.unseen_twists.cols() > 1)
    return std::to_string(rank.unseen_twists.cols()) +
           " motions of the platform leave all that is seen as it is";
  const bool is_translation = rank.unseen_twists.bottomRows<3>().norm() < kLeastSingularValue;
  return is_translation ? "a translation of the platform leaves all that is seen as it is"
                        : "a motion that turns the platform leaves all that is seen as it is";
}

bool HaveParallelRails(const ParallelRobot& robot, const std::vector<int>& legs) {
  const Eigen::Vector3d& first = robot.legs[static_cast<size_t>(legs.front())].first_axis;
  return std::all_of(legs.begin(), legs.end(), [&](int leg) {
    const RobotLeg& it = robot.legs[static_cast<size_t>(leg)];
    return SeenSegmentOf(it.chain).carrier == Carrier::kLine &&
           it.first_axis.cross(first).norm() < kLeastSingularValue;
  });
}

// What the legs' chains and places say before any matrix.
std::string StructuralReason(const ParallelRobot& robot, const std::vector<int>& legs, int freedoms) {
  int coordinates = 0;
  std::string of_leg;
  for (const int leg : legs) {
    const HiddenLeg hidden = HiddenLegOf(robot.legs[static_cast<size_t>(leg)].chain, robot.motion);
    if (hidden.why_not_controllable.empty())
      coordinates += hidden.actuated_coordinates;
    else
      of_leg = hidden.why_not_controllable;
  }
  if (!of_leg.empty() && coordinates < freedoms) return of_leg;
  if (coordinates < freedoms)
    return "the seen directions have " + std::to_string(coordinates) + " coordinates for the platform's " +
           std::to_string(freedoms) + " freedoms";
  if (HaveParallelRails(robot, legs))
    return "the rails of the P joints are parallel: along them the platform translates with every direction "
           "unchanged";
  return "";
}

}  // namespace

const char* ToString(ControllabilityStatus status) {
  switch (status) {
    case ControllabilityStatus::kControllable:
      return "controllable";
    case ControllabilityStatus::kSingularPose:
      return "singular-pose";
    case ControllabilityStatus::kUncontrollable:
      return "uncontrollable";
    case ControllabilityStatus::kUnreachable:
      break;
  }
  return "unreachable";
}

Controllability ControllabilityOf(const ParallelRobot& robot, const std::vector<int>& legs,
                                  const Rigid3& base_from_platform, SeenFeature feature) {
  const auto rank = RankAt(robot, legs, base_from_platform, feature);
  if (!rank) {
    Controllability unreachable;
    unreachable.why = "a seen leg does not reach the pose";
    return unreachable;
  }
  Controllability result{ControllabilityStatus::kControllable,
                         rank->freedoms,
                         rank->seen,
                         rank->unseen_twists,
                         std::nullopt,
                         ""};
  if (rank->unseen() == 0) return result;
  result.fewest_unseen_around = FewestUnseenAround(robot, legs, base_from_platform, feature);
  if (result.fewest_unseen_around.value_or(0) == 0) {
    result.status = ControllabilityStatus::kSingularPose;
    result.why = (result.fewest_unseen_around ? "at this pose, though not elsewhere, "
                                              : "at this pose, and whether elsewhere is not known, ") +
                 AboutUnseen(*rank);
    return result;
  }
  result.status = ControllabilityStatus::kUncontrollable;
  if (feature == SeenFeature::kDirections) result.why = StructuralReason(robot, legs, rank->freedoms);
  if (result.why.empty()) result.why = AboutUnseen(*rank);
  return result;
}

}  // namespace legible
