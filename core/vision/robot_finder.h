// Finds the robot in an image, wherever its platform is.
#pragma once

#include <cstdint>
#include <string>

#include "core/vision/edge_tracker.h"

namespace legible {

struct RobotFinderOptions {
  // How wrong the model's camera and legs may be. Tried first: those of a calibrated model, then those of a
  // drawing with a guessed camera. The less the model is known the more edges must agree.
  struct Knowledge {
    double camera_m, camera_rad;  // as ViewErrors has them
    double leg_m;                 // as EdgeTrackerOptions has it
    double lock_range_px;         // how far all legs together may be off, at a width of 1280 px
    size_t least_edges;           // that must agree with one pose
    double least_share;           // the same, of those in sight
  };
  Knowledge calibrated{1e-3, 1e-3, 1.5e-4, 30, 10, 0.85};
  Knowledge drawing{0.03, 0.05, 1.2e-3, 60, 12, 0.9};
  bool tries_drawing = true;
  int candidates = 20000;  // poses, spread over the joint ranges
  int climbs = 60;         // of the best of them, improved by the image's gradients
  int looks = 10;          // of the best of those, measured

  void Check() const;  // throws std::invalid_argument
};

enum class RobotFinderStatus {
  kFound,
  kNoRobot,    // no pose has edges where the image has them
  kAmbiguous,  // several have
};

struct FoundRobot {
  RobotFinderStatus status = RobotFinderStatus::kNoRobot;
  std::string reason;  // in words, where it is not found
  Rigid3 base_from_platform;
  Rigid3 camera_from_base;  // the model's, displaced as far as its errors allow
  SeenEdges seen;           // as measured: they do not depend on the pose
  int candidates_looked_at = 0;
};

// Poses of readings spread over the joint ranges (Halton's sequence) are scored by the gradients of the
// blurred image across their legs' edges, of legs brighter or darker than what is behind them; the best are
// improved, and looked at as EdgeTracker does. Throws std::invalid_argument for an image of another size than
// the camera's, and options that cannot be. Depends on nothing but its arguments.
FoundRobot FindRobot(const GrayImage& image, const GoughStewart& robot, const Camera& camera,
                     const Rigid3& camera_from_base, const RobotFinderOptions& options);

}  // namespace legible
