// The pixels along an edge, by their distance from it.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "core/vision/edge_profile.h"
#include "core/vision/gray_image.h"
#include "core/vision/predicted_legs.h"

namespace legible {

struct BandPixel {
  float inside_px;   // distance from the curve, growing into the leg
  float brightness;  // grey levels
};

// A stretch of the band between two neighbouring points of the curve.
struct BandCell {
  double share = 0;               // of its middle, along the leg
  Eigen::Vector2d centre_px;      // on the curve
  Eigen::Vector2d normal_px;      // unit, away from the leg
  bool follows_previous = false;  // shares an end with the cell before it
  size_t first = 0, last = 0;     // its pixels
};

// Every pixel whose centre lies within a window about the visible stretches of a curve, each once and as it
// is: nothing is interpolated, so that the noise stays independent from pixel to pixel.
struct EdgeBand {
  std::vector<BandPixel> pixels;
  std::vector<BandCell> cells;

  // Length of all cells, px.
  double length_px = 0;
};

EdgeBand CollectBand(const GrayImage& image, const std::vector<PredictedEdgePoint>& curve, double outside_px,
                     double inside_px);

// How strongly a change of the background's or the leg's mean level shows at a distance from the edge.
class LevelShape {
 public:
  LevelShape();  // a soft step at 0: nothing is known of the edge yet
  // As the fit has it: brightness changes in proportion, so a leg's level changes less where it is dark.
  LevelShape(const ProfileFit& fit, const ProfileFitOptions& options);

  struct Shares {
    float background, leg;
  };
  Shares At(float inside_px) const;

 private:
  std::vector<Shares> table_;
};

// Takes out of the band how the background and the leg change along the edge (texture, shadows, light falling
// off), each about its own mean: what is left changes across the edge only. `place_px`: the edge in the band.
// Cells whose contrast is missing or reversed (something unforeseen covers the leg) are dropped.
void Flatten(EdgeBand& band, double place_px, const LevelShape& shape);

// Mean brightness in bins of `width_px` over the cells [first_cell, last_cell).
EdgeProfile BinProfile(const EdgeBand& band, size_t first_cell, size_t last_cell, double outside_px,
                       double inside_px, double width_px);

// The same profile with groups of bins that begin more than `fine_px` from the curve put together: shading is
// smooth there.
EdgeProfile CoarserFarFromTheEdge(const EdgeProfile& profile, double fine_px);

// Groups of neighbouring cells, [first, last): each run of cells that follow each other in equal parts of
// about `length_px`.
std::vector<std::pair<size_t, size_t>> Stretches(const EdgeBand& band, double length_px, double step_px);

// Standard deviation of a pixel's grey noise, from the background's scatter about each cell's own mean; 0 if
// there are too few pixels.
double GreyNoise(const EdgeBand& band);

}  // namespace legible
