#include "core/geometry/nearest_camera.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace legible {
namespace {

constexpr int kGridSteps = 40;  // along each side of the image
constexpr int kMaxIterations = 200;
constexpr double kFirstDamping = 1e-3, kLargestDamping = 1e12;
constexpr double kLeastProgress = 1e-12;  // of the sum of squares

struct SightLine {
  Eigen::Vector2d pixel;
  Eigen::Vector2d undistorted;
};

std::vector<SightLine> SightLinesOf(const Camera& camera) {
  if (camera.width_px < 1 || camera.height_px < 1)
    throw std::invalid_argument("FindNearestCamera: the camera has no image size");
  std::vector<SightLine> lines;
  for (int row = 0; row <= kGridSteps; ++row)
    for (int column = 0; column <= kGridSteps; ++column) {
      const Eigen::Vector2d pixel(column * (camera.width_px - 1.0) / kGridSteps,
                                  row * (camera.height_px - 1.0) / kGridSteps);
      if (const auto x = Unproject(camera, pixel)) lines.push_back({pixel, *x});
    }
  if (lines.empty()) throw std::invalid_argument("FindNearestCamera: the camera sees nothing");
  return lines;
}

Eigen::VectorXd Residuals(const Camera& camera, const std::vector<SightLine>& lines) {
  Eigen::VectorXd residuals(2 * static_cast<Eigen::Index>(lines.size()));
  for (size_t i = 0; i < lines.size(); ++i)
    residuals.segment<2>(2 * static_cast<Eigen::Index>(i)) =
        ProjectNormalised(camera, lines[i].undistorted) - lines[i].pixel;
  return residuals;
}

Eigen::MatrixXd Derivatives(const Camera& camera, const std::vector<SightLine>& lines,
                            const std::vector<int>& free) {
  Eigen::MatrixXd derivatives(2 * static_cast<Eigen::Index>(lines.size()),
                              static_cast<Eigen::Index>(free.size()));
  for (size_t i = 0; i < lines.size(); ++i)
    derivatives.middleRows<2>(2 * static_cast<Eigen::Index>(i)) =
        ProjectWithJacobians(camera, lines[i].undistorted.homogeneous()).d_camera(Eigen::all, free);
  return derivatives;
}

// What solves J step = -residuals best, large steps held back by the damping (Marquardt's scaling).
Eigen::VectorXd DampedStep(const Eigen::MatrixXd& derivatives, const Eigen::VectorXd& residuals,
                           double damping) {
  const Eigen::Index rows = derivatives.rows(), columns = derivatives.cols();
  Eigen::MatrixXd system(rows + columns, columns);
  system << derivatives, Eigen::MatrixXd((std::sqrt(damping) * derivatives.colwise().norm()).asDiagonal());
  Eigen::VectorXd right = Eigen::VectorXd::Zero(rows + columns);
  right.head(rows) = -residuals;
  return system.colPivHouseholderQr().solve(right);
}

Camera Moved(const Camera& camera, const std::vector<int>& free, const Eigen::VectorXd& step) {
  CameraParameters parameters = ParametersOf(camera);
  parameters(free) += step;
  return WithParameters(camera, parameters);
}

// From `start` to the least sum of squares.
Camera Minimise(const Camera& start, const std::vector<SightLine>& lines, const std::vector<int>& free) {
  Camera best = start;
  Eigen::VectorXd residuals = Residuals(best, lines);
  double damping = kFirstDamping;
  for (int iteration = 0; iteration < kMaxIterations && damping < kLargestDamping; ++iteration) {
    const double squares = residuals.squaredNorm();
    const Camera moved = Moved(best, free, DampedStep(Derivatives(best, lines, free), residuals, damping));
    const Eigen::VectorXd moved_residuals = Residuals(moved, lines);
    if (!(moved_residuals.squaredNorm() < squares)) {
      damping *= 10;
      continue;
    }
    best = moved;
    residuals = moved_residuals;
    damping /= 10;
    if (residuals.squaredNorm() > (1 - kLeastProgress) * squares) break;
  }
  return best;
}

bool MeanTheSame(LensModel a, LensModel b) {
  return (a == LensModel::kFisheye) == (b == LensModel::kFisheye);
}

NearestCamera Judged(const Camera& camera, const std::vector<SightLine>& lines) {
  NearestCamera result{camera, 0, 0};
  const double fold = MonotonicRadius(camera.lens, camera.distortion);
  for (const SightLine& line : lines) {
    const double distance = line.undistorted.norm() < fold
                                ? (ProjectNormalised(camera, line.undistorted) - line.pixel).norm()
                                : std::numeric_limits<double>::infinity();
    result.rms_px += distance * distance;
    result.max_px = std::max(result.max_px, distance);
  }
  result.rms_px = std::sqrt(result.rms_px / static_cast<double>(lines.size()));
  return result;
}

}  // namespace

std::bitset<kCameraParameterCount> AllParametersOf(LensModel lens) {
  std::bitset<kCameraParameterCount> all;
  for (size_t i = 0; i < 4 + static_cast<size_t>(lens); ++i) all.set(i);
  return all;
}

NearestCamera FindNearestCamera(const Camera& camera, LensModel lens,
                                const std::bitset<kCameraParameterCount>& free) {
  std::vector<int> indices;
  Camera start = camera;
  start.lens = lens;
  for (int i = 0; i < kCameraParameterCount; ++i) {
    const bool is_free = free[static_cast<size_t>(i)];
    if (is_free) indices.push_back(i);
    if (i >= 4 && !(is_free && MeanTheSame(camera.lens, lens))) start.distortion[i - 4] = 0;
  }
  if (MeanTheSame(camera.lens, lens) && start.distortion == camera.distortion) return {start, 0, 0};
  const std::vector<SightLine> lines = SightLinesOf(camera);
  return Judged(indices.empty() ? start : Minimise(start, lines, indices), lines);
}

}  // namespace legible
