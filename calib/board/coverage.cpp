#include "calib/board/coverage.h"

#include <algorithm>
#include <cmath>

namespace legible {

BoardTilt TiltOf(const Rigid3& camera_from_board) {
  // Away from the camera, whichever side of the board is seen.
  Eigen::Vector3d normal = camera_from_board.rotation * Eigen::Vector3d::UnitZ();
  if (normal.z() < 0) normal = -normal;
  // In the plane normal . x = const the depth rises towards where the normal's lateral part points from.
  return {std::acos(std::min(normal.z(), 1.0)), std::atan2(-normal.y(), -normal.x())};
}

double Coverage::Share() const {
  const auto seen = std::count_if(corners.begin(), corners.end(), [](int count) { return count > 0; });
  return corners.empty() ? 0 : static_cast<double>(seen) / static_cast<double>(corners.size());
}

double Coverage::LargestTilt() const {
  double largest = 0;
  for (const auto& tilt : tilts)
    if (tilt) largest = std::max(largest, tilt->angle_rad);
  return largest;
}

Coverage CoverageOf(const BoardCalibrationInput& input, const BoardCalibration& calibration, int columns,
                    int rows) {
  Coverage coverage{columns, rows, std::vector<int>(static_cast<size_t>(columns * rows)), {}};
  const auto cell = [](double pixel, int size_px, int cells) {
    return std::clamp(static_cast<int>((pixel + 0.5) / size_px * cells), 0, cells - 1);
  };
  for (size_t i = 0; i < input.views.size(); ++i) {
    const ViewFit& fit = calibration.views[i];
    coverage.tilts.emplace_back();
    if (!fit.left_out.empty()) continue;
    coverage.tilts.back() = TiltOf(fit.camera_from_board);
    for (size_t k = 0; k < input.views[i].corners.size(); ++k) {
      if (fit.weight[k] == 0) continue;
      const Eigen::Vector2d& pixel = input.views[i].corners[k].pixel;
      const int column = cell(pixel.x(), input.width_px, columns);
      const int row = cell(pixel.y(), input.height_px, rows);
      ++coverage.corners[static_cast<size_t>(row * columns + column)];
    }
  }
  return coverage;
}

}  // namespace legible
