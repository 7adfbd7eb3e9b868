#include "calib/edge_residuals.h"

#include <Eigen/Eigenvalues>
#include <stdexcept>

#include "core/geometry/cylinder_outline.h"

namespace legible {
std::optional<Eigen::VectorXd> EdgeDistances(const Camera& camera, const Eigen::Vector3d& a_in_camera,
                                             const Eigen::Vector3d& b_in_camera, double radius_m,
                                             const EdgeObservation& edge) {
  const PluckerLine<double> axis = LineThrough<double>(a_in_camera, b_in_camera);
  if (!CameraIsOutside(axis, radius_m)) return std::nullopt;
  const Eigen::Vector3d normal = CylinderOutline(axis, radius_m)[static_cast<size_t>(edge.edge)];
  Eigen::VectorXd distances(static_cast<Eigen::Index>(edge.samples.size()));
  for (size_t i = 0; i < edge.samples.size(); ++i) {
    const auto distance = DistanceToEdge(camera, normal, edge.samples[i].point_px, edge.samples[i].normal_px);
    if (!distance) return std::nullopt;
    distances[static_cast<Eigen::Index>(i)] = distance->distance_px;
  }
  return distances;
}

WhitenedEdge::WhitenedEdge(const EdgeObservation& observation, const EdgeNoise& noise,
                           const Eigen::VectorXd& robust_weights)
    : observation_(&observation), scale_(robust_weights.size()), common_damping_(Eigen::Vector2d::Zero()) {
  if (robust_weights.size() != static_cast<Eigen::Index>(observation.samples.size()))
    throw std::invalid_argument("WhitenedEdge: one robust weight for each sample is needed");
  for (Eigen::Index i = 0; i < scale_.size(); ++i)
    scale_[i] =
        std::sqrt(robust_weights[i]) / (noise.sample * observation.samples[static_cast<size_t>(i)].sigma_px);
  if (scale_.size() == 0 || observation.common_sigma_px == 0) return;

  Eigen::MatrixXd common(scale_.size(), 2);
  common << noise.shift * scale_, noise.tilt * scale_.cwiseProduct(PlacesAlong(observation));
  common *= observation.common_sigma_px;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> gram(common.transpose() * common);
  common_ = common * gram.eigenvectors();
  for (int i = 0; i < 2; ++i) {
    const double squared = std::max(gram.eigenvalues()[i], 0.0);
    if (squared <= 0) continue;
    common_.col(i) /= std::sqrt(squared);
    common_damping_[i] = 1 - 1 / std::sqrt(1 + squared);
  }
}

void WhitenedEdge::Whiten(Eigen::Ref<Eigen::MatrixXd> rows_px) const {
  rows_px = scale_.asDiagonal() * rows_px;
  if (common_.size() == 0) return;
  rows_px -= common_ * (common_damping_.asDiagonal() * (common_.transpose() * rows_px)).eval();
}

std::optional<EdgeResiduals> EvaluateEdges(const Camera& camera, const Eigen::Vector3d& a_in_camera,
                                           const Eigen::Vector3d& b_in_camera, double radius_m,
                                           const Eigen::Vector4d& shading_px,
                                           const std::vector<WhitenedEdge>& edges) {
  const PluckerLine<double> axis = LineThrough<double>(a_in_camera, b_in_camera);
  if (!CameraIsOutside(axis, radius_m)) return std::nullopt;
  const auto normals = CylinderOutline(axis, radius_m);

  Eigen::Index rows = 0;
  for (const WhitenedEdge& edge : edges) rows += edge.rows();
  // residual, camera, A b R, shading side by side, so that one call whitens them all.
  constexpr int kColumns = 1 + kCameraParameterCount + 7 + 4;
  Eigen::MatrixXd all(rows, kColumns);
  Eigen::Index row = 0;
  for (const WhitenedEdge& edge : edges) {
    const int which = edge.observation().edge;
    const Eigen::Vector3d& normal = normals[static_cast<size_t>(which)];
    const Eigen::VectorXd places = PlacesAlong(edge.observation());
    const Eigen::Matrix<double, 3, 7> d_normal = OutlineJacobian(a_in_camera, b_in_camera, normal);
    const Eigen::Index first = row;
    for (const EdgeSample& sample : edge.observation().samples) {
      const auto distance = DistanceToEdge(camera, normal, sample.point_px, sample.normal_px);
      if (!distance) return std::nullopt;
      Eigen::RowVector4d d_shading = Eigen::RowVector4d::Zero();
      d_shading.segment<2>(2 * which) << -1, -places[row - first];
      all.row(row++) << distance->distance_px + d_shading.dot(shading_px), distance->d_distance_d_camera,
          distance->d_distance_d_normal * d_normal, d_shading;
    }
    edge.Whiten(all.middleRows(first, row - first));
  }
  return EdgeResiduals{all.col(0), all.middleCols<kCameraParameterCount>(1),
                       all.middleCols<7>(1 + kCameraParameterCount), all.rightCols<4>()};
}

}  // namespace legible
