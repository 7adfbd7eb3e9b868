// Poses that the platform can be driven to and in which the camera sees enough of the legs.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "calib/expected_observation.h"

namespace legible {

// Where the platform may be sent, judged by the drawing.
struct ReachOptions {
  double joint_margin_m = 0.005;     // that every reading keeps from the ends of its range
  double largest_turn_rad = 0.5;     // from home: what ball joints allow
  double least_clearance_m = 0.005;  // between any two legs
  // The least singular value of the inverse Jacobian (lengths in platform radii), relative to that at home,
  // that is kept on the straight way of the joints from home: singular poses are kept away from.
  double least_regularity = 0.25;

  void Check() const;  // throws std::invalid_argument
};

// The pose of the readings (m) that the platform comes to when its joints move there from home, all together;
// nothing where the way leads through a pose too near a singular one, or forward kinematics that starts at
// home, as a calibration's does, would find another pose.
std::optional<Rigid3> PoseFromHome(const GoughStewart& robot, const Vector6d& readings_m,
                                   double least_regularity);

// Whether the platform may be sent there.
bool MayBeSentTo(const GoughStewart& robot, const Rigid3& base_from_platform, const ReachOptions& options);

// Poses in reach over the whole workspace, uniform in the joint readings. Fewer than `count` where hardly any
// readings lead to one.
std::vector<Rigid3> DrawReachablePoses(const GoughStewart& robot, int count, std::uint64_t seed,
                                       const ReachOptions& options);

struct PoseCandidateOptions {
  int count = 500;
  std::uint64_t seed = 1;
  ReachOptions reach;
  ExpectedEdgeOptions edges;
  int least_edges = 8;  // of twelve that must be in sight

  void Check() const;  // throws std::invalid_argument
};

struct PoseCandidate {
  Rigid3 base_from_platform;
  ImageObservation expected;
};

// Poses as DrawReachablePoses draws them that show enough of the legs. Fewer than `count` where they are
// rare; then what the drawn ones were lost to says why.
struct PoseCandidates {
  std::vector<PoseCandidate> poses;
  int drawn = 0, out_of_reach = 0, out_of_sight = 0;
};
PoseCandidates DrawPoseCandidates(const RigModel& model, const PoseCandidateOptions& options);

}  // namespace legible
