// How far the corners of tags are trusted: their noise, as the residuals show it, and weights that take
// misread tags out.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calib/tag_model.h"
#include "core/vision/tags.h"

namespace legible {

// One tag's residuals: predicted less observed x and y of its corners, in the corners' own sigmas and in px.
struct TagErrors {
  Eigen::Matrix<double, kTagRows, 1> error;
  Eigen::Matrix<double, kTagRows, 1> error_px;
  double weight = 1;  // robust, [0, 1]
};

// kSigmaOfMedian x median |error|: a scale that half the corners being wrong does not move.
double MedianTagScale(const std::vector<TagErrors>& tags);

// By how much the corners scatter more than their own sigmas say: the weighted errors' root mean square after
// `groups` placements were fitted to them, drawn towards 1 as if that had been seen of one more tag: a single
// tag on the base leaves but two degrees of freedom.
double TagScale(const std::vector<TagErrors>& tags, size_t groups);

// Sets every weight: a tag counts whole while the root mean square of its errors is up to 3 scales, not at
// all from 6 on.
void WeighTags(std::vector<TagErrors>& tags, double scale);

// Corners of a tag that stands still, from where each image has them: the median of each coordinate, with the
// covariance of a single corner (of those of the images the one of median trace). What is left of print and
// detector is the same in every image, so that they count once.
struct TagCorners {
  std::array<Eigen::Vector2d, 4> corners_px;
  std::array<Eigen::Matrix2d, 4> covariances_px2;
};
TagCorners MedianCorners(const std::vector<TagDetection>& seen);

}  // namespace legible
