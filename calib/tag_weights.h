// How far the corners of tags are trusted: their noise, as the residuals show it, and weights that take
// misread tags out.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calib/tag_model.h"

namespace legible {

// One tag's residuals: predicted less observed x and y of its corners, px.
struct TagErrors {
  Eigen::Matrix<double, kTagRows, 1> error_px;
  double weight = 1;  // robust, [0, 1]
};

// kSigmaOfMedian x median |error|: a scale that half the corners being wrong does not move.
double MedianTagSigma(const std::vector<TagErrors>& tags);

// Noise of one coordinate of a corner, px: the weighted errors' root mean square after `groups` placements
// were fitted to them, drawn towards a tenth of a pixel as if that had been seen of one more tag: a single
// tag on the base leaves but two degrees of freedom.
double TagSigma(const std::vector<TagErrors>& tags, size_t groups);

// Sets every weight: a tag counts whole while the root mean square of its errors is up to 3 sigma, not at all
// from 6 on.
void WeighTags(std::vector<TagErrors>& tags, double sigma_px);

// Corners of a tag that stands still, from where each image has them: the median of each coordinate. What is
// left is mostly the detector's own error, which is the same in every image, so that they count once.
std::array<Eigen::Vector2d, 4> MedianCorners(const std::vector<std::array<Eigen::Vector2d, 4>>& corners_px);

}  // namespace legible
