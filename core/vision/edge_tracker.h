// Follows the edges of the legs from image to image.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/vision/leg_edges.h"
#include "core/vision/model_correction.h"
#include "core/vision/seen_edges.h"

namespace legible {

// Edges for a control law: also those whose places are too uncertain for a calibration.
LegEdgeOptions EdgesToTrack();

struct EdgeTrackerOptions {
  // Of the first look; `lock` says how far off the model may be then.
  LegEdgeOptions first_look = EdgesToTrack();
  double search_px = 5;  // how far from where it is expected an edge is looked for later on
  // How far from there it may be found at most, at either end of what is seen of it, while it is followed.
  // Farther off it is something else's.
  double gate_px = 2.5;
  double rough_gate_px = 1;  // the same of an edge whose place is a rough one
  // How wrong the model may be, and how fast that changes from image to image.
  ViewErrors model_errors;
  ViewErrors drift{1e-3, 1e-3, 5e-4, 2.5e-3};
  double leg_m = 1.2e-3;  // of the legs, 1 sigma: what neither camera nor platform explains
  // How far an edge may lie from where the others say that it is, in sigmas: of leg_m, or of what is usual
  // in the images so far, where that is less.
  double leg_gate_sigmas = 4;
  // Of the edges that are in sight, so many must agree with one place of the robot for the first look to
  // count.
  size_t least_first_edges = 6;
  double least_first_share = 0.75;
  // An edge that has not been seen for so long is looked for where the others say that it is.
  double forget_s = 0.5;

  void Check() const;  // throws std::invalid_argument
};

// Of one image.
struct TrackedEdges {
  SeenEdges seen;
  // Why each edge that is missing is: [leg][edge]; empty for those seen.
  std::array<std::array<std::string, 2>, kLegCount> missing;
  std::array<std::array<bool, 2>, kLegCount> is_rough = {};  // of those seen: LegEdge::is_rough
  double blur_px = 0;
};

// The model may be wrong by whatever changes slowly, a drawing and a guessed camera too: camera and platform
// are displaced such that the model's edges agree with those seen (CorrectView), and each edge is then
// expected as far beside them as it was seen last. What disagrees with the others is no edge of the robot.
class EdgeTracker {
 public:
  // Throws std::invalid_argument where the options are wrong.
  EdgeTracker(const GoughStewart& robot, const Camera& camera, const Rigid3& camera_from_base,
              const EdgeTrackerOptions& options);

  // Throws std::invalid_argument for an image of another size than the camera's.
  TrackedEdges Track(const GrayImage& image, double time_s, const Rigid3& predicted_base_from_platform);

  // The model with its platform there, as far as the edges so far have corrected it.
  ModelledView Corrected(const Rigid3& base_from_platform) const;

 private:
  // Where an edge was seen last, beside the corrected model's.
  struct Place {
    OffModel off;
    double time_s = 0;
  };
  using Places = std::array<std::array<std::optional<Place>, 2>, kLegCount>;

  ModelledView ModelAt(const Rigid3& base_from_platform) const;
  bool IsFresh(size_t leg, size_t edge, double time_s) const;
  LegEdges LookFirst(const GrayImage& image, const ModelledView& model);
  LegEdges LookAgain(const GrayImage& image, const ModelledView& view, double time_s) const;
  void DropJumps(const ModelledView& view, double time_s, LegEdges& edges) const;
  void DropOpposite(LegEdges& edges);
  void Correct(const ModelledView& model, LegEdges& edges);
  TrackedEdges Keep(const ModelledView& model, double time_s, const LegEdges& edges);

  GoughStewart robot_;
  Camera camera_;
  Rigid3 camera_from_base_;
  EdgeTrackerOptions options_;
  // What was found of the model's errors; none before the first look.
  struct Correction {
    Vector6d camera, platform;  // displacements of camera_from_base, in camera, and of base_from_platform
    double leg_m = 0;           // root mean square of how far edges are off all the same
  };
  std::optional<Correction> correction_;
  std::optional<double> blur_px_;
  double polarity_ = 0;  // 1: legs are brighter than what is behind them, -1: darker, 0: not known yet
  Places places_;
};

// An edge as measured in an image, for a control law: its covariance holds what all its samples share too.
SeenEdge ToSeenEdge(const Camera& camera, const LegEdge& edge);

}  // namespace legible
