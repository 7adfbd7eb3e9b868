#include "calib/pose_candidates.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <utility>

namespace legible {
namespace {

constexpr int kStepsFromHome = 4;     // of the joints' way, short enough for Newton
constexpr int kMostDrawsAPose = 200;  // of readings, before the search for a candidate is given up
constexpr double kAsFarAsAtHome = 0.99;
constexpr double kSamePose_m = 1e-6;  // poses found on two ways; other assemblies are centimetres off

double LeastSingularValue(const GoughStewart& robot, const Rigid3& base_from_platform) {
  Matrix6d jacobian = InverseJacobian(robot, base_from_platform);
  jacobian.rightCols<3>() /= PlatformRadius(robot);
  return Eigen::JacobiSVD<Matrix6d>(jacobian).singularValues()[5];
}

// Shortest distance between two segments, each from `a` to `b`: inside both where the common normal meets
// both, otherwise at an end of one.
struct Segment {
  Eigen::Vector3d a, b;

  double DistanceTo(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d along = b - a;
    const double share = std::clamp((x - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (a + share * along - x).norm();
  }
};
double Distance(const Segment& first, const Segment& second) {
  const Eigen::Vector3d u = first.b - first.a, v = second.b - second.a;
  const Eigen::Vector3d normal = u.cross(v), between = second.a - first.a;
  const double squared = normal.squaredNorm();
  if (squared > 1e-12 * u.squaredNorm() * v.squaredNorm()) {
    const double on_first = between.cross(v).dot(normal) / squared;
    const double on_second = between.cross(u).dot(normal) / squared;
    if (on_first >= 0 && on_first <= 1 && on_second >= 0 && on_second <= 1)
      return std::abs(between.dot(normal)) / std::sqrt(squared);
  }
  return std::min({first.DistanceTo(second.a), first.DistanceTo(second.b), second.DistanceTo(first.a),
                   second.DistanceTo(first.b)});
}

// Joints of two legs may be so close (or one) that their legs never are that far apart: as far as at home,
// then.
bool LegsKeepClear(const GoughStewart& robot, const Rigid3& base_from_platform, double clearance_m) {
  const auto axis = [&](size_t i, const Rigid3& pose) -> Segment {
    return {robot.legs[i].base_joint_m, pose * robot.legs[i].platform_joint_m};
  };
  for (size_t i = 0; i < kLegCount; ++i)
    for (size_t j = i + 1; j < kLegCount; ++j) {
      const double at_home_m = Distance(axis(i, robot.home), axis(j, robot.home));
      const double least_m =
          std::min(robot.legs[i].radius_m + robot.legs[j].radius_m + clearance_m, kAsFarAsAtHome * at_home_m);
      if (Distance(axis(i, base_from_platform), axis(j, base_from_platform)) < least_m) return false;
    }
  return true;
}

// Uniform in [0, 1), the same with every standard library.
double Uniform(std::mt19937_64& generator) { return static_cast<double>(generator() >> 11) * 0x1p-53; }

Vector6d DrawReadings(const GoughStewart& robot, double margin_m, std::mt19937_64& generator) {
  Vector6d readings_m;
  for (int i = 0; i < kLegCount; ++i) {
    const auto [shortest_m, longest_m] = robot.legs[static_cast<size_t>(i)].joint_range_m;
    readings_m[i] = shortest_m + margin_m + (longest_m - shortest_m - 2 * margin_m) * Uniform(generator);
  }
  return readings_m;
}

std::optional<Rigid3> DrawReachable(const GoughStewart& robot, const ReachOptions& options,
                                    std::mt19937_64& generator) {
  // A hair more, which rounding may take a pose by when its readings are computed again.
  const Vector6d readings_m = DrawReadings(robot, options.joint_margin_m + 1e-9, generator);
  const auto pose = PoseFromHome(robot, readings_m, options.least_regularity);
  return pose && MayBeSentTo(robot, *pose, options) ? pose : std::nullopt;
}

}  // namespace

void ReachOptions::Check() const {
  if (!(joint_margin_m >= 0)) throw std::invalid_argument("joint_margin_m must not be negative");
  if (!(largest_turn_rad > 0)) throw std::invalid_argument("largest_turn_rad must be positive");
  if (!(least_regularity > 0 && least_regularity < 1))
    throw std::invalid_argument("least_regularity must be between 0 and 1");
}

void PoseCandidateOptions::Check() const {
  reach.Check();
  edges.Check();
  if (count < 1) throw std::invalid_argument("PoseCandidateOptions: count must be at least 1");
  if (least_edges < 1 || least_edges > 2 * kLegCount)
    throw std::invalid_argument("PoseCandidateOptions: least_edges must be 1 to 12");
}

std::optional<Rigid3> PoseFromHome(const GoughStewart& robot, const Vector6d& readings_m,
                                   double least_regularity) {
  const Vector6d home_m = InverseKinematics(robot, robot.home);
  const double least = least_regularity * LeastSingularValue(robot, robot.home);
  Rigid3 pose = robot.home;
  for (int step = 1; step <= kStepsFromHome; ++step) {
    const Vector6d on_the_way_m = home_m + (readings_m - home_m) * step / kStepsFromHome;
    const auto found = ForwardKinematics(robot, on_the_way_m, pose);
    if (found.status != ForwardKinematicsStatus::kConverged) return std::nullopt;
    pose = found.base_from_platform;
    if (!(LeastSingularValue(robot, pose) >= least)) return std::nullopt;
  }
  const auto at_once = ForwardKinematics(robot, readings_m, robot.home);
  if (at_once.status != ForwardKinematicsStatus::kConverged) return std::nullopt;
  const Rigid3& other = at_once.base_from_platform;
  const double apart_m = (other.translation - pose.translation).norm() +
                         PlatformRadius(robot) * other.rotation.angularDistance(pose.rotation);
  return apart_m < kSamePose_m ? std::optional(pose) : std::nullopt;
}

bool MayBeSentTo(const GoughStewart& robot, const Rigid3& base_from_platform, const ReachOptions& options) {
  const Vector6d readings_m = InverseKinematics(robot, base_from_platform);
  for (int i = 0; i < kLegCount; ++i) {
    const auto [shortest_m, longest_m] = robot.legs[static_cast<size_t>(i)].joint_range_m;
    if (readings_m[i] < shortest_m + options.joint_margin_m ||
        readings_m[i] > longest_m - options.joint_margin_m)
      return false;
  }
  return base_from_platform.rotation.angularDistance(robot.home.rotation) <= options.largest_turn_rad &&
         LegsKeepClear(robot, base_from_platform, options.least_clearance_m);
}

std::vector<Rigid3> DrawReachablePoses(const GoughStewart& robot, int count, std::uint64_t seed,
                                       const ReachOptions& options) {
  options.Check();
  std::mt19937_64 generator(seed);
  std::vector<Rigid3> poses;
  for (int drawn = 0; static_cast<int>(poses.size()) < count && drawn < kMostDrawsAPose * count; ++drawn)
    if (const auto pose = DrawReachable(robot, options, generator)) poses.push_back(*pose);
  return poses;
}

PoseCandidates DrawPoseCandidates(const RigModel& model, const PoseCandidateOptions& options) {
  options.Check();
  std::mt19937_64 generator(options.seed);
  PoseCandidates candidates;
  const auto count = static_cast<size_t>(options.count);
  while (candidates.poses.size() < count && candidates.drawn < kMostDrawsAPose * options.count) {
    ++candidates.drawn;
    const auto pose = DrawReachable(model.robot, options.reach, generator);
    if (!pose) {
      ++candidates.out_of_reach;
      continue;
    }
    ImageObservation expected = ExpectObservation(model, *pose, options.edges);
    if (expected.edges.size() < static_cast<size_t>(options.least_edges)) {
      ++candidates.out_of_sight;
      continue;
    }
    candidates.poses.push_back({*pose, std::move(expected)});
  }
  return candidates;
}

}  // namespace legible
