#include "tests/testing/synthetic_board.h"

#include <cmath>

#include "tests/testing/random.h"

namespace legible {
namespace {

// Facing the camera, then tilted and turned about its normal; its middle where the sight line of a pixel is.
Rigid3 RandomPose(std::mt19937_64& generator, const Camera& camera, double size_m,
                  const SyntheticBoardOptions& options) {
  const Eigen::Vector2d pixel(Uniform(generator, 0.2, 0.8) * camera.width_px,
                              Uniform(generator, 0.2, 0.8) * camera.height_px);
  const double nearness = Uniform(generator, 0.8, 1.6);
  const double depth_m = options.distance_sizes * size_m * camera.fx_px / camera.width_px * nearness;
  const double direction = Uniform(generator, 0, 2 * M_PI);
  const double tilt = options.largest_tilt_rad * std::sqrt(Uniform(generator, 0, 1));
  const Eigen::Vector3d axis(std::cos(direction), std::sin(direction), 0);
  const Eigen::Quaterniond facing(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(Uniform(generator, -0.6, 0.6), Eigen::Vector3d::UnitZ()));
  const Eigen::Vector2d x = Unproject(camera, pixel).value();
  return {RotationFromVector(tilt * axis) * facing * turned, depth_m * x.homogeneous()};
}

bool IsInside(const Camera& camera, const Eigen::Vector2d& pixel) {
  return pixel.x() > 5 && pixel.y() > 5 && pixel.x() < camera.width_px - 6 &&
         pixel.y() < camera.height_px - 6;
}

double SizeOf(const std::vector<Eigen::Vector3d>& points) {
  double size = 0;
  for (const Eigen::Vector3d& point : points) size = std::max(size, 2 * point.norm());
  return size;
}

}  // namespace

SyntheticBoardViews SeeBoard(std::mt19937_64& generator, const Camera& camera,
                             const std::vector<Eigen::Vector3d>& points_in_board_m,
                             const SyntheticBoardOptions& options) {
  std::normal_distribution<double> normal;
  const double size_m = SizeOf(points_in_board_m);
  SyntheticBoardViews result;
  while (static_cast<int>(result.views.size()) < options.views) {
    const Rigid3 pose = RandomPose(generator, camera, size_m, options);
    BoardView view;
    view.name = "view " + std::to_string(result.views.size());
    for (size_t i = 0; i < points_in_board_m.size(); ++i) {
      const Eigen::Vector3d x = pose * points_in_board_m[i];
      if (!(x.z() > 0)) continue;
      BoardCorner corner;
      corner.point = static_cast<int>(i);
      corner.pixel = Project(camera, x);
      if (!IsInside(camera, corner.pixel)) continue;
      if (Uniform(generator, 0, 1) < options.outlier_share)
        corner.pixel += UniformVector(generator, -50, 50).head<2>();
      corner.pixel += options.noise_px * Eigen::Vector2d(normal(generator), normal(generator));
      view.corners.push_back(corner);
    }
    if (view.corners.size() < points_in_board_m.size() / 2) continue;
    result.views.push_back(view);
    result.camera_from_board.push_back(pose);
  }
  return result;
}

Camera BoardCamera(LensModel lens) {
  Camera camera{1280, 960, 1250, 1245, 652, 470, lens, Distortion::Zero()};
  if (lens == LensModel::kBrownConrady) camera.distortion.head<5>() << -0.21, 0.08, 0.0006, -0.0004, -0.01;
  if (lens == LensModel::kRational)
    camera.distortion << -0.1, 0.03, 0.0006, -0.0004, 0.002, 0.11, 0.01, 0.004;
  if (lens == LensModel::kFisheye) camera.distortion.head<4>() << -0.03, 0.008, -0.004, 0.001;
  return camera;
}

Board DeskChessboard() { return {"desk", std::nullopt, Chessboard{9, 7, 0.03, 0.03}}; }

}  // namespace legible
