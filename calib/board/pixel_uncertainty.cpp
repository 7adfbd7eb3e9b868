#include "calib/board/pixel_uncertainty.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace legible {

UncertaintyMap PixelUncertainty(const Camera& camera, const BoardInformation& information,
                                const ImageGrid& grid) {
  UncertaintyMap map{grid, std::vector<std::optional<double>>(static_cast<size_t>(grid.columns * grid.rows))};
  double squares = 0;
  const std::vector<GridPoint> points = PointsOver(camera, grid);
  for (const GridPoint& point : points) {
    Eigen::MatrixXd by_all(2, information.covariance.cols());
    by_all << point.d_unknowns, point.d_motion;
    const Eigen::Matrix2d covariance = by_all * information.covariance * by_all.transpose();
    const double sigma_px = std::sqrt(
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance, Eigen::EigenvaluesOnly).eigenvalues()[1]);
    map.sigma_px[static_cast<size_t>(point.row * grid.columns + point.column)] = sigma_px;
    squares += sigma_px * sigma_px;
    map.worst_px = std::max(map.worst_px, sigma_px);
  }
  if (!points.empty()) map.rms_px = std::sqrt(squares / static_cast<double>(points.size()));
  return map;
}

}  // namespace legible
