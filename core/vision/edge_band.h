// The pixels along an edge, by their distance from it.
#pragma once

#include <Eigen/Core>
#include <optional>
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
  // Grey levels by which the background and the leg are brighter here than along the whole band
  // (MeasureLevels).
  double background = 0, leg = 0;
  std::optional<double> background_variance =
      {};  // of the background's pixels about their mean; none: too few
};

// Every pixel whose centre lies within a window about the visible stretches of a curve, each once and as it
// is: nothing is interpolated, so that the noise stays independent from pixel to pixel.
struct EdgeBand {
  std::vector<BandPixel> pixels;
  std::vector<BandCell> cells;
};

// The window reaches from outside_px outside the curve to inside_px into the leg; its points stand in
// order along the leg, and between two of which one has an obstacle there is no cell.
EdgeBand CollectBand(const GrayImage& image, const std::vector<PredictedEdgePoint>& curve, double outside_px,
                     double inside_px);

// Finds how the background and the leg change along the edge (texture, shadows, light falling off), each
// about its own mean. Cells whose contrast is missing or reversed, or whose brightness jumps to a neighbour's
// (something unforeseen covers the leg) are dropped.
void MeasureLevels(EdgeBand& band);

// Standard deviation of a pixel's grey noise, from the background's scatter about each cell's own mean; 0 if
// there are too few pixels. After MeasureLevels.
double GreyNoise(const EdgeBand& band);

// Equal bins of the distance from the curve.
struct BinGrid {
  double outside_px, inside_px, width_px;

  size_t size() const;
  double Middle(size_t bin) const { return (static_cast<double>(bin) + 0.5) * width_px - outside_px; }
};

// Sums over the pixels of each bin of a grid.
struct BandBin {
  Eigen::Array4f sums =
      Eigen::Array4f::Zero();  // of inside_px and brightness, and of background and leg of their cells
  float count = 0;
};
using BandBins = std::vector<BandBin, Eigen::aligned_allocator<BandBin>>;

// Of the cells [first_cell, last_cell).
BandBins BinBand(const EdgeBand& band, size_t first_cell, size_t last_cell, const BinGrid& grid);

// Adds another stretch of the same grid.
void Add(const BandBins& bins, BandBins& to);

// How strongly a change of the background's or the leg's mean level shows in each bin.
struct LevelShares {
  double background, leg;
};
using LevelShape = std::vector<LevelShares>;

// A soft step at 0: nothing is known of the edge yet.
LevelShape SoftStep(const BinGrid& grid);
// As the fit has it: brightness changes in proportion, so a leg's level changes less where it is dark.
LevelShape ShapeOf(const ProfileFit& fit, const ProfileFitOptions& options, const BinGrid& grid);

// Mean brightness in each bin, less what MeasureLevels found to change along the edge: what is left changes
// across it only. Bins more than `fine_px` from the curve are put together to half a pixel: shading is
// smooth there.
EdgeProfile FlatProfile(const BandBins& bins, const LevelShape& shape, const BinGrid& grid, double fine_px);

// Groups of neighbouring cells, [first, last): each run of cells that follow each other in equal parts of
// about `length_px`.
std::vector<std::pair<size_t, size_t>> Stretches(const EdgeBand& band, double length_px, double step_px);

}  // namespace legible
