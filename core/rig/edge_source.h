// Where the edges of a moment come from: a camera's images, or a simulation that needs none.
#pragma once

#include "core/geometry/rigid3.h"
#include "core/vision/seen_edges.h"

namespace legible {

// What is known of the robot when an image is looked at: where its legs should be by the readings.
struct MotionNow {
  double time_s = 0;  // of the readings
  Vector6d joint_readings_m = Vector6d::Zero();
  Vector6d joint_speeds_m_per_s = Vector6d::Zero();  // commanded since then
};

class EdgeSource {
 public:
  virtual ~EdgeSource() = default;
  // The edges of the newest image there is: the same again, with the same stamp, where no newer one has
  // come. May throw RigError, NoImageYet among them.
  virtual SeenEdges See(const MotionNow& motion) = 0;
};

}  // namespace legible
