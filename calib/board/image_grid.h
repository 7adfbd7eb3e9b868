// Points all over the image, and how their pixels follow the camera's unknowns and a motion before it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/geometry/camera_parameters.h"
#include "core/geometry/rigid3.h"

namespace legible {

struct ImageGrid {
  int columns = 0, rows = 0;
  double distance_m = 0;  // of the points from the camera's centre; may be infinite
};

// One place of the grid. What is infinitely far away has the unit vector towards it as x_in_camera, which a
// translation does not move.
struct GridPoint {
  int column = 0, row = 0;
  Eigen::Vector2d pixel;
  Eigen::Vector3d x_in_camera;
  Eigen::MatrixXd d_unknowns;            // 2 x (4 + coefficients of the lens)
  Eigen::Matrix<double, 2, 6> d_motion;  // (v, omega): the point moves by v + omega x x
};

// Places in the middles of columns x rows equal cells of the image, row by row; without those that the lens
// model does not reach.
std::vector<GridPoint> PointsOver(const Camera& camera, const ImageGrid& grid);

// Where the point is seen by `camera` after the motion: rotation Exp(omega), then translation v.
Eigen::Vector2d PixelAfter(const Camera& camera, const GridPoint& point, const ImageGrid& grid,
                           const Vector6d& motion);

// The rows of all points, each divided by its sigma_px: derivatives by the camera's unknowns, and by the
// motion.
struct StackedRows {
  Eigen::MatrixXd by_unknowns, by_motion;
};
StackedRows Stack(const std::vector<GridPoint>& points, const std::vector<double>& sigma_px);

// What is left of the derivatives by the camera's unknowns once each is made up for, as far as can be, by a
// motion of what stands before the camera: what no estimate of poses by this camera can absorb.
Eigen::MatrixXd WithoutMotion(const StackedRows& rows);

}  // namespace legible
