// A robot on the move before the simulated camera, and how well its edges are followed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "core/robots/mechanism.h"
#include "core/vision/edge_tracker.h"
#include "tests/core/rig/rig_scene.h"

namespace legible {

// What the program believes of the robot.
struct BelievedRobot {
  GoughStewart robot;
  Camera camera;
  Rigid3 camera_from_base;
};

// A robot that differs from its drawing, its camera from a tape measure's guess, by as much as the defaults
// of SyntheticOptions say.
struct RobotAndDrawing {
  SimulationTruth truth;
  BelievedRobot drawing;

  BelievedRobot Perfect() const { return {truth.robot, truth.camera, truth.camera_from_base}; }
};

inline RobotAndDrawing DrawRobot(std::uint64_t seed, bool is_half_size) {
  SyntheticOptions options;
  options.camera = DesktopCamera(true);
  options.image_count = 1;
  options.seed = seed;
  const SyntheticSession session = GenerateSession(options);
  const auto sized = [&](const Camera& camera) { return is_half_size ? Halved(camera) : camera; };
  return {{session.true_robot, sized(session.true_camera), session.true_camera_from_base},
          {session.nominal_robot, sized(session.nominal_camera), session.nominal_camera_from_base}};
}

// From another side: the camera goes around the base's vertical axis.
inline RobotAndDrawing SeenFrom(RobotAndDrawing robot, double azimuth_rad) {
  const Rigid3 turn{RotationFromVector({0, 0, azimuth_rad}), Eigen::Vector3d::Zero()};
  robot.truth.camera_from_base = robot.truth.camera_from_base * turn;
  robot.drawing.camera_from_base = robot.drawing.camera_from_base * turn;
  return robot;
}

// About home, smooth: each coordinate a sum of two slow oscillations; where a joint would leave its range,
// less of them.
class Wandering {
 public:
  // At `speed` 1 the joints go at up to some 0.1 m/s.
  Wandering(const GoughStewart& robot, double speed, std::mt19937_64& generator) : robot_(robot) {
    for (auto& of_coordinate : waves_)
      for (Wave& wave : of_coordinate)
        wave = {Uniform(generator, 0, 2 * std::numbers::pi), speed * Uniform(generator, 0.5, 1.5)};
  }

  Rigid3 At(double time_s) const {
    Vector6d displacement;
    const Vector6d reach = (Vector6d() << 0.035, 0.035, 0.035, 0.12, 0.12, 0.15).finished();
    for (Eigen::Index i = 0; i < 6; ++i) {
      const auto& [a, b] = waves_[static_cast<size_t>(i)];
      displacement[i] =
          reach[i] * (std::sin(a.phase + a.rate * time_s) + std::sin(b.phase + b.rate * time_s)) / 1.3;
    }
    for (double share = 1; share > 0; share -= 0.05) {
      Rigid3 pose = Displaced(robot_.home, share * displacement);
      if (JointsOutOfRange(robot_, InverseKinematics(robot_, pose)).empty()) return pose;
    }
    return robot_.home;
  }

 private:
  struct Wave {
    double phase = 0, rate = 0;
  };
  GoughStewart robot_;
  std::array<std::array<Wave, 2>, 6> waves_;
};

// By how much an edge, as seen through the believed camera, is off the true one in the image at the ends of
// its stretch, px; the larger one.
inline double LargestOff(const SimulationTruth& truth, const Rigid3& base_from_platform,
                         const Camera& believed, const SeenEdge& seen) {
  const LegInCamera leg = LegsOf(truth, base_from_platform)[static_cast<size_t>(seen.leg)];
  const Eigen::Vector3d normal = CylinderOutline(LineThrough<double>(leg.a_in_camera, leg.b_in_camera),
                                                 leg.radius_m)[static_cast<size_t>(seen.edge)];
  const Eigen::Vector2d across = seen.normal.head<2>() / seen.normal.head<2>().norm();
  double largest_px = 0;
  for (const Eigen::Vector2d& end : seen.ends) {
    const double beside = seen.normal.dot(end.homogeneous()) / seen.normal.head<2>().norm();
    const Eigen::Vector3d on_line = (end - beside * across).homogeneous();
    const Eigen::Vector2d in_truth = Unproject(truth.camera, Project(believed, on_line)).value();
    const double off = normal.dot(in_truth.homogeneous()) / normal.head<2>().norm();
    largest_px = std::max(largest_px, truth.camera.fx_px * std::abs(off));
  }
  return largest_px;
}

// How often, and how well, edges were seen.
struct FollowingScore {
  static constexpr double kFalse_px = 1;  // at 640 x 480: farther off is another edge's

  int in_sight = 0, seen = 0, rough = 0, wrong = 0, longest_wrong = 0;
  double fine_squares_px2 = 0, rough_squares_px2 = 0;  // of the edges that are not wrong

  double FineRms_px() const { return std::sqrt(fine_squares_px2 / std::max(1, seen - rough - wrong)); }
  double RoughRms_px() const { return std::sqrt(rough_squares_px2 / std::max(1, rough)); }
  void Print(const char* what) const {
    std::printf(
        "%s: %d of %d edges in sight seen, %d of them roughly; rms %.3f px, rough ones %.3f px; %d wrong, "
        "for %d frames in a row at most\n",
        what, seen, in_sight, rough, FineRms_px(), RoughRms_px(), wrong, longest_wrong);
  }
};

// Follows the edges of one robot, frame by frame.
class Follower {
 public:
  Follower(const RobotAndDrawing& robot, const BelievedRobot& believed, std::uint64_t seed)
      : truth_(robot.truth),
        believed_(believed),
        scene_(robot.truth, {}, seed),
        tracker_(believed.robot, believed.camera, believed.camera_from_base, Options()),
        predicted_(believed.robot.home) {}

  // Where the legs are to be expected follows from the readings.
  TrackedEdges Follow(const Rigid3& base_from_platform, FollowingScore& score) {
    const Vector6d readings_m = InverseKinematics(truth_.robot, base_from_platform);
    const auto forward = ForwardKinematics(believed_.robot, readings_m, predicted_);
    if (forward.status == ForwardKinematicsStatus::kConverged) predicted_ = forward.base_from_platform;
    TrackedEdges tracked =
        tracker_.Track(scene_.Take(base_from_platform, {}, static_cast<std::uint64_t>(frame_)),
                       kPeriod_s * frame_, predicted_);
    ++frame_;
    Judge(base_from_platform, tracked, score);
    return tracked;
  }

  static constexpr double kPeriod_s = 0.02;
  int frame() const { return frame_; }

 private:
  static EdgeTrackerOptions Options() {
    EdgeTrackerOptions options;
    options.first_look.lock->range_px = 120;  // a tape measure's camera
    return options;
  }

  void Judge(const Rigid3& base_from_platform, const TrackedEdges& tracked, FollowingScore& score) {
    for (const auto& of_leg : PredictEdges(LegsOf(truth_, base_from_platform), truth_.camera, {}))
      for (const PredictedEdge& edge : of_leg) score.in_sight += Length_px(edge) >= 30 ? 1 : 0;
    std::array<std::array<int, 2>, kLegCount> wrong_for = {};
    for (const SeenEdge& edge : tracked.seen.edges) {
      const auto leg = static_cast<size_t>(edge.leg), side = static_cast<size_t>(edge.edge);
      const double off_px = LargestOff(truth_, base_from_platform, believed_.camera, edge);
      ++score.seen;
      if (off_px > FollowingScore::kFalse_px) {
        ++score.wrong;
        wrong_for[leg][side] = wrong_for_[leg][side] + 1;
        score.longest_wrong = std::max(score.longest_wrong, wrong_for[leg][side]);
        continue;
      }
      score.rough += tracked.is_rough[leg][side] ? 1 : 0;
      (tracked.is_rough[leg][side] ? score.rough_squares_px2 : score.fine_squares_px2) += off_px * off_px;
    }
    wrong_for_ = wrong_for;
  }

  static double Length_px(const PredictedEdge& edge) {
    double length_px = 0;
    for (size_t i = 1; i < edge.points.size(); ++i)
      if (edge.points[i].obstacle == EdgeObstacle::kNone &&
          edge.points[i - 1].obstacle == EdgeObstacle::kNone)
        length_px += (edge.points[i].point_px - edge.points[i - 1].point_px).norm();
    return length_px;
  }

  SimulationTruth truth_;
  BelievedRobot believed_;
  SceneCamera scene_;
  EdgeTracker tracker_;
  Rigid3 predicted_;
  int frame_ = 0;
  std::array<std::array<int, 2>, kLegCount> wrong_for_ = {};
};

}  // namespace legible
