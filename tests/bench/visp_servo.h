// ViSP's moving edges and its control law, behind an interface without ViSP: its headers are not C++20.
#pragma once

#include <cstdint>
#include <memory>

#include "servo/interaction.h"
#include "servo/servo_goal.h"

namespace legible {

// vpServo with a LegEdgeFeature for each edge that the goal has.
class VispServo {
 public:
  VispServo(const ServoModel& model, const ServoGoal& goal, double gain_per_s);
  ~VispServo();

  // Joint speeds, m/s. All edges of the goal must be seen, ordered by leg and edge.
  Vector6d Speeds(const SeenEdges& seen, const LegDirections& directions, const Vector6d& length_m);

 private:
  struct Task;
  std::unique_ptr<Task> task_;
};

// A vpMeLine for each edge.
class VispEdges {
 public:
  // `model` must outlive this; its camera must not have any distortion.
  explicit VispEdges(const ServoModel& model);
  ~VispEdges();

  // Takes the image in (pixels row by row), which is not part of what is timed.
  void Load(const std::uint8_t* pixels);
  // Begins at the edges as they are known, at their ends in the image that is loaded.
  void Start(const SeenEdges& known);
  // Follows all of them into the image that is loaded. A line that ViSP loses begins again at its place
  // `known`.
  SeenEdges Track(const SeenEdges& known);
  int lost() const;  // so far

 private:
  struct Lines;
  std::unique_ptr<Lines> lines_;
};

}  // namespace legible
