// Where exactly two straight edges of a printed pattern cross, and how well an image tells.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <vector>

#include "core/vision/gray_image.h"

namespace legible {

// What is printed about a corner: cells of a grid whose lines run along the corner's two edges, 0 for dark
// and 1 for light. Cell (row, column) reaches from line row - 2 to row - 1 along edge 2 and from line column
// - 2 to column - 1 along edge 1; the lines 0 cross at the corner, lines -1 and 1 are one pitch off, the
// outermost cells are taken to go on.
using CornerCells = Eigen::Matrix4d;
CornerCells DarkWedge();   // one dark sector, between the two edges
CornerCells DarkSaddle();  // that one and the opposite one

// Where a corner is expected.
struct CornerSite {
  Eigen::Vector2d pixel;
  std::array<Eigen::Vector2d, 2>
      edges_px;  // from the corner along edges 1 and 2 to the next lines of the grid
  CornerCells cells;
  bool knows_beyond = false;  // whether the cells are right beyond the next lines, too
};

// What is known of a corner besides its window: in a small one, little is to be seen of the directions and
// the blur.
struct CornerExpectations {
  static constexpr double kUnknown = std::numeric_limits<double>::infinity();
  double direction_sigma_rad = kUnknown;  // of the site's edges
  double blur_px = 0.85, blur_sigma_px = kUnknown;
  double noise = 2;           // grey levels
  double noise_freedoms = 0;  // of the residuals from which the noise is known
};

enum class CornerStatus {
  kFitted,
  kTooSmall,      // the next lines are less than 4 px away, 2 px where it is known what is beyond
  kOutsideImage,  // a part of the window is
  kNoContrast,    // of at least 10 grey levels
  kUnlike,        // the image is not like the cells
  kNotConverged,  // or far from where it was expected
};
const char* ToString(CornerStatus status);

struct CornerFit {
  CornerStatus status = CornerStatus::kNotConverged;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  // From the scatter of the residuals, together with the noise as far as that is known.
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Zero();
  double blur_px = 0;   // standard deviation of lens and pixel together
  double contrast = 0;  // grey levels, light minus dark: below 0 where the image is the cells' negative
  double rms = 0;       // grey levels, of the residuals
  int pixels = 0;       // in the window
};

// The brightness of the cells, 0 to 1, through a Gaussian blur, at a pixel. In an affine image of the cells,
// each corner of a cell adds a quarter plane, whose blurred brightness is the bivariate normal distribution
// function of the signed distances to its two lines over the blur, with the normals' cosine as correlation
// (D. B. Owen, Tables for computing bivariate normal probabilities, 1956).
class CornerModel {
 public:
  // x, y of the corner (px), the directions of edges 1 and 2 (rad, in the image, from x towards y), the blur
  // (px).
  using Parameters = Eigen::Matrix<double, 5, 1>;

  // Of the site, the cells and the lengths of the edges are taken. Lines that a window of that half width
  // (px) cannot see are left out.
  CornerModel(const CornerSite& site, double half_width_px);

  struct Value {
    double brightness;
    Eigen::Matrix<double, 1, 5> d_parameters;
  };
  Value At(const Eigen::Vector2d& pixel, const Parameters& parameters) const;

 private:
  struct QuarterPlane {
    double along_1_px, along_2_px;  // its tip, along the edges
    double weight;
  };
  struct HalfPlane {
    double along_px;  // where its border crosses the other edge
    double weight;
  };
  double constant_ = 0;
  std::vector<HalfPlane> across_1_, across_2_;  // bordered by lines across edge 1, and across edge 2
  std::vector<QuarterPlane> quarters_;
};

// Fits place, directions, blur, dark and light (Levenberg-Marquardt) in a window that keeps off the next
// lines of the grid, of at most 7 px half width.
CornerFit FitCorner(const GrayImage& image, const CornerSite& site, const CornerExpectations& expected = {});

}  // namespace legible
