// Where the estimate of a camera begins when nothing is known of it: from views of a flat board alone.
#pragma once

#include <optional>
#include <vector>

#include "calib/board/board_problem.h"

namespace legible {

// The mapping of a board's plane to image coordinates that a lens of division model has straightened:
// x (m, homogeneous) to p = H x, with the image's centre as origin and half its diagonal as unit.
struct ViewHomography {
  Eigen::Matrix3d image_from_board;
  double median_error = 0;  // of the corners in the image as it is, same unit; half of them are nearer
};

// The division model: a point at p in the image stands where p / (1 + lambda p^2) would be without the lens
// (Fitzgibbon 2001, "Simultaneous linear estimation of multiple view geometry and lens distortion").
struct StraightenedViews {
  double lambda = 0;
  double unit_px = 1;  // half the image's diagonal
  Eigen::Vector2d centre_px;
  // Where a pixel would be without the lens.
  Eigen::Vector2d StraightPlace(const Eigen::Vector2d& pixel) const {
    const Eigen::Vector2d p = (pixel - centre_px) / unit_px;
    return p / (1 + lambda * p.squaredNorm());
  }
  std::vector<std::optional<ViewHomography>> views;  // none where fewer than four corners or all on one line
};

// The lambda under which the boards are flattest, by a search; 0 where `may_bend` is false. Half of a view's
// corners being wrong moves it little.
StraightenedViews Straighten(const std::vector<ViewObservation>& views, int width_px, int height_px,
                             bool may_bend);

// Some views for what would take long with all: those with the most corners, equal ones from all over the
// sequence. Indices into `views`.
std::vector<size_t> ViewsWithMostCorners(const std::vector<ViewObservation>& views);

// How far neighbouring corners of a view's list are from each other in the image, the median.
double NeighbourDistance_px(const ViewObservation& view);

// The focal length in units of half the diagonal that makes the columns of the homographies orthogonal and
// of equal length (Zhang 2000), with the principal point in the image's centre. Nothing where the boards are
// so nearly parallel to the image that they say nothing of it.
std::optional<double> FocalLengthOf(const StraightenedViews& straightened);

// The camera of the given lens that is nearest to a focal length and the division model over the image, and
// where it puts the boards; views without a homography keep the identity.
BoardProblem ProblemAt(const StraightenedViews& straightened, double focal_length, LensModel lens,
                       int width_px, int height_px, const std::vector<ViewObservation>& views);

}  // namespace legible
