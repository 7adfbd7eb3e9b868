// Follows the edges of the legs from image to image.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/vision/leg_edges.h"
#include "core/vision/seen_edges.h"

namespace legible {

// Edges for a control law: also those whose places are too uncertain for a calibration.
LegEdgeOptions EdgesToTrack();

struct EdgeTrackerOptions {
  // Of the first look; `lock` says how far off the model may be then.
  LegEdgeOptions first_look = EdgesToTrack();
  double search_px = 5;  // how far from where it is expected an edge is looked for later on
  // How far from there it may be found at most, at either end of its leg, while it is followed. Farther off
  // it is something else's.
  double gate_px = 2.5;
  double width_gate_px = 4;  // how much wider or narrower than the model's a leg may be found, at either end
  // An edge that has not been seen for so long is looked for where the others have moved, as far as
  // search_px.
  double forget_s = 0.5;

  void Check() const;  // throws std::invalid_argument
};

// Of one image.
struct TrackedEdges {
  SeenEdges seen;
  // Why each edge that is missing is: [leg][edge]; empty for those seen.
  std::array<std::array<std::string, 2>, kLegCount> missing;
  double blur_px = 0;
};

// Edges are expected where the model has them in the predicted pose, moved by as much as they lay beside it
// when they were seen last: the model may be wrong by whatever changes slowly, a drawing and a guessed camera
// too.
class EdgeTracker {
 public:
  // Throws std::invalid_argument where the options are wrong.
  EdgeTracker(const GoughStewart& robot, const Camera& camera, const Rigid3& camera_from_base,
              const EdgeTrackerOptions& options);

  // Throws std::invalid_argument for an image of another size than the camera's.
  TrackedEdges Track(const GrayImage& image, double time_s, const Rigid3& predicted_base_from_platform);

 private:
  // Where an edge was seen last, beside the model's.
  struct Place {
    EndShifts shifts;
    double time_s = 0;
  };

  bool HasSeenAny() const;
  bool IsFresh(size_t leg, size_t edge, double time_s) const;
  EdgeShifts ExpectedShifts(const LegsInCamera& legs, double time_s) const;
  LegEdges Look(const GrayImage& image, const LegsInCamera& legs, const EdgeShifts& expected);
  EdgeShifts ShiftsOf(const LegsInCamera& legs, LegEdges& edges) const;
  void DropJumps(const EdgeShifts& found, double time_s, LegEdges& edges) const;
  void DropWrongWidths(const EdgeShifts& found, LegEdges& edges) const;

  GoughStewart robot_;
  Camera camera_;
  Rigid3 camera_from_base_;
  EdgeTrackerOptions options_;
  std::optional<double> blur_px_;
  std::array<std::array<std::optional<Place>, 2>, kLegCount> places_;
};

// An edge as measured in an image, for a control law: its covariance holds what all its samples share too.
SeenEdge ToSeenEdge(const Camera& camera, const LegEdge& edge);

}  // namespace legible
