#include "calib/board/image_grid.h"

#include <Eigen/QR>
#include <cmath>

namespace legible {

std::vector<GridPoint> PointsOver(const Camera& camera, const ImageGrid& grid) {
  const bool is_finite = std::isfinite(grid.distance_m);
  std::vector<GridPoint> points;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      GridPoint point;
      point.column = column;
      point.row = row;
      point.pixel = {(column + 0.5) / grid.columns * camera.width_px - 0.5,
                     (row + 0.5) / grid.rows * camera.height_px - 0.5};
      const auto x = Unproject(camera, point.pixel);
      if (!x) continue;
      point.x_in_camera = (is_finite ? grid.distance_m : 1.0) * x->homogeneous().normalized();
      const ProjectedPoint projected = ProjectWithJacobians(camera, point.x_in_camera);
      point.d_unknowns = projected.d_camera.leftCols(4 + static_cast<Eigen::Index>(camera.lens));
      point.d_motion << (is_finite ? 1.0 : 0.0) * projected.d_x, -projected.d_x * Skew(point.x_in_camera);
      points.push_back(point);
    }
  return points;
}

Eigen::Vector2d PixelAfter(const Camera& camera, const GridPoint& point, const ImageGrid& grid,
                           const Vector6d& motion) {
  const Eigen::Vector3d turned = RotationFromVector(motion.tail<3>()) * point.x_in_camera;
  return Project(camera, std::isfinite(grid.distance_m) ? turned + motion.head<3>() : turned);
}

StackedRows Stack(const std::vector<GridPoint>& points, const std::vector<double>& sigma_px) {
  const Eigen::Index rows = 2 * static_cast<Eigen::Index>(points.size());
  StackedRows stacked{{}, Eigen::MatrixXd(rows, 6)};
  if (!points.empty()) stacked.by_unknowns.resize(rows, points.front().d_unknowns.cols());
  for (size_t i = 0; i < points.size(); ++i) {
    const Eigen::Index row = 2 * static_cast<Eigen::Index>(i);
    stacked.by_unknowns.middleRows<2>(row) = points[i].d_unknowns / sigma_px[i];
    stacked.by_motion.middleRows<2>(row) = points[i].d_motion / sigma_px[i];
  }
  return stacked;
}

Eigen::MatrixXd WithoutMotion(const StackedRows& rows) {
  return rows.by_unknowns -
         rows.by_motion * rows.by_motion.completeOrthogonalDecomposition().solve(rows.by_unknowns);
}

}  // namespace legible
