// Where the camera and the platform must be for a model's edges to lie where an image shows them.
#pragma once

#include <array>
#include <optional>

#include "core/geometry/camera.h"
#include "core/vision/predicted_legs.h"
#include "core/vision/seen_edges.h"

namespace legible {

// A robot before a camera, as a model has both.
struct ModelledView {
  GoughStewart robot;
  Camera camera;
  Rigid3 camera_from_base, base_from_platform;
};
LegsInCamera PlaceLegs(const ModelledView& view);

// How far an edge, where it was seen, lies outward of its leg's outline; px, without distortion.
struct OffModel {
  struct End {
    double share = 0;  // along the leg, 0 at A, 1 at B
    double off_px = 0;
    double off_m = 0;  // the same at the leg
  };
  std::array<End, 2> ends;

  // The line through both ends, elsewhere along the leg.
  double OffAt_px(double share) const;
  double Largest_m() const;
};
// Nothing where the camera sees no outline of the leg, or one of another direction.
std::optional<OffModel> OffOf(const ModelledView& view, const SeenEdge& edge);

// How wrong a view may be, 1 sigma.
struct ViewErrors {
  double camera_m = 0.03, camera_rad = 0.05;       // the camera's place
  double platform_m = 0.004, platform_rad = 0.02;  // the platform's
};

struct CorrectionOptions {
  ViewErrors errors;                // of the model
  std::optional<ViewErrors> drift;  // by how much what was found before may have changed; none: by anything
  // How far the legs may be from where the right camera and platform would have them, m, 1 sigma: drawing
  // errors. Edges much farther off are taken to be something else's.
  double leg_m = 1.5e-3;
  int iterations = 2;
};

// Displaces the camera and the platform of `before` such that its outlines agree with the seen edges, as far
// as it is likely that `model`, and `before`, are off by as much: least squares in which edges that disagree
// with the others count little (Geman-McClure).
ModelledView CorrectView(const ModelledView& model, const ModelledView& before, const SeenEdges& seen,
                         const CorrectionOptions& options);

// The same where whole legs may have been taken for something else: without any one or two legs, or with all,
// the correction that leaves the least of all edges unexplained.
ModelledView CorrectViewByMost(const ModelledView& model, const SeenEdges& seen,
                               const CorrectionOptions& options);

}  // namespace legible
