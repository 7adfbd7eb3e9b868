#include "calib/board/neighbour_scatter.h"

#include <Eigen/QR>
#include <cmath>

#include "calib/board/corner_noise.h"

namespace legible {
namespace {

constexpr Eigen::Index kTerms = 10;   // of a cubic in two variables
constexpr double kLeastFreedom = 10;  // corners beyond these

struct Scatter {
  double squares = 0, freedom = 0;
};

Eigen::Matrix<double, 1, kTerms> CubicTerms(const Eigen::Vector2d& p) {
  const double x = p.x(), y = p.y();
  Eigen::Matrix<double, 1, kTerms> terms;
  terms << 1, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y;
  return terms;
}

// Of the corners that count, in their own sigmas.
Scatter ScatterOf(const BoardWarp& extent, const std::vector<Eigen::Vector3d>& points_in_board_m,
                  const BoardView& seen, const ViewFit& fit) {
  const Eigen::Index rows = 2 * static_cast<Eigen::Index>(seen.corners.size());
  Eigen::MatrixXd terms = Eigen::MatrixXd::Zero(rows, 2 * kTerms);
  Eigen::VectorXd errors(rows);
  double count = 0;
  for (size_t k = 0; k < seen.corners.size(); ++k) {
    const BoardCorner& corner = seen.corners[k];
    const Eigen::Index row = 2 * static_cast<Eigen::Index>(k);
    const Eigen::Matrix2d whitening = std::sqrt(fit.weight[k]) * WhiteningOf(corner.covariance_px2);
    const auto cubic = CubicTerms(extent.Across(points_in_board_m[static_cast<size_t>(corner.point)]));
    terms.block<2, kTerms>(row, 0) = whitening.col(0) * cubic;
    terms.block<2, kTerms>(row, kTerms) = whitening.col(1) * cubic;
    errors.segment<2>(row) = whitening * fit.residual_px[k];
    count += fit.weight[k];
  }
  if (count < kTerms + kLeastFreedom) return {};
  const auto solver = terms.colPivHouseholderQr();
  return {(errors - terms * solver.solve(errors)).squaredNorm(),
          2 * count - static_cast<double>(solver.rank())};
}

}  // namespace

std::optional<double> NeighbourScatter(const BoardCalibrationInput& input,
                                       const BoardCalibration& calibration, bool trusts_all) {
  const BoardWarp extent = FlatOver(input.points_in_board_m);
  Scatter all;
  for (size_t i = 0; i < input.views.size(); ++i) {
    if (!calibration.views[i].left_out.empty()) continue;
    const Scatter one = ScatterOf(extent, input.points_in_board_m, input.views[i], calibration.views[i]);
    all.squares += one.squares;
    all.freedom += one.freedom;
  }
  if (!(all.freedom > 0)) return std::nullopt;
  return std::sqrt(all.squares / all.freedom / (trusts_all ? 1 : CutOffInPlane()));
}

}  // namespace legible
