#include "calib/image_information.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "calib/shared_information.h"

namespace legible {
namespace {

constexpr double kNumericalZero = 1e-13;  // pivot of a matrix with ones on its diagonal

}  // namespace

Eigen::MatrixXd ImageInformation(const EstimationProblem& problem, const ImageObservation& image,
                                 const Rigid3& camera_from_platform,
                                 const std::optional<double>& reading_sigma_m, const EdgeNoise& noise) {
  EstimationProblem alone;
  alone.camera = problem.camera;
  alone.shared = problem.shared;
  alone.free = problem.free;
  PoseUnit unit{0, true, camera_from_platform, Eigen::Vector3d::Zero(), {}};
  for (int leg = 0; leg < kLegCount; ++leg) {
    LegObservation observation{leg, {}, {}, reading_sigma_m.value_or(1)};
    if (reading_sigma_m && image.joint_readings_m) observation.reading_m = (*image.joint_readings_m)[leg];
    for (const EdgeObservation& edge : image.edges)
      if (edge.leg == leg)
        observation.edges.emplace_back(edge, noise,
                                       Eigen::VectorXd::Ones(static_cast<Eigen::Index>(edge.samples.size())));
    unit.legs.push_back(std::move(observation));
  }
  alone.units.push_back(std::move(unit));
  return SharedInformation(alone);
}

// Cholesky's method that always takes the largest remaining pivot and ends at rounding (Higham, Analysis of
// the Cholesky decomposition of a semi-definite matrix, 1990), with the diagonal scaled to ones before.
// Eigen's LDLT chooses pivots without what earlier ones took away.
Eigen::MatrixXd RootOf(const Eigen::MatrixXd& matrix) {
  const Eigen::VectorXd scale = matrix.diagonal().cwiseMax(0).cwiseSqrt();
  const Eigen::VectorXd inverse = scale.unaryExpr([](double x) { return x > 0 ? 1 / x : 0.0; });
  Eigen::MatrixXd rest = inverse.asDiagonal() * matrix * inverse.asDiagonal();
  Eigen::MatrixXd columns(rest.rows(), rest.cols());
  Eigen::Index rank = 0, pivot = 0;
  while (rank < rest.cols() && rest.diagonal().maxCoeff(&pivot) > kNumericalZero) {
    columns.col(rank) = rest.col(pivot) / std::sqrt(rest(pivot, pivot));
    rest.noalias() -= columns.col(rank) * columns.col(rank).transpose();
    rest.row(pivot).setZero();
    rest.col(pivot).setZero();
    ++rank;
  }
  return columns.leftCols(rank).transpose() * scale.asDiagonal();
}

double GainOf(const Eigen::MatrixXd& root, const Eigen::MatrixXd& covariance,
              const Eigen::MatrixXd& q_covariance) {
  Eigen::MatrixXd expected = root * covariance * root.transpose();
  expected.diagonal().array() += 1;
  return expected.llt().matrixL().solve(root * q_covariance.transpose()).squaredNorm();
}

}  // namespace legible
