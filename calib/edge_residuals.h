// Residuals of the edges of one leg in one image, with derivatives, whitened by what is known of their noise.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "core/geometry/edge_distance.h"
#include "core/geometry/rigid3.h"
#include "core/robots/gough_stewart.h"
#include "core/vision/edge_observation.h"

namespace legible {

// By what factors the noise of the edges differs from what each edge's own sigmas say.
struct EdgeNoise {
  double sample = 1;  // of EdgeSample::sigma_px
  double shift = 1;   // of EdgeObservation::common_sigma_px, for an error that is the same along the edge
  double tilt = 1;    // of the same, for an error that grows along the edge from -1 to 1
};
// Each leg's edges have a lighting, and so a noise, of their own.
using NoiseByEdge = std::array<std::array<EdgeNoise, 2>, kLegCount>;

// An edge's samples with the linear map that whitens their residuals: rows are divided by their sigma, then
// the common shift and tilt, unknown with their variances, are projected out as far as those say: W = (I - V
// diag(1 - 1/sqrt(1 + l^2)) V^T) S^-1/2 with S^-1/2 [shift, tilt] = V diag(l) Q^T.
class WhitenedEdge {
 public:
  // robust_weights: one in [0, 1] for each sample (1 = fully trusted); throws std::invalid_argument on
  // another number of them.
  WhitenedEdge(const EdgeObservation& observation, const EdgeNoise& noise,
               const Eigen::VectorXd& robust_weights);

  const EdgeObservation& observation() const { return *observation_; }
  Eigen::Index rows() const { return scale_.size(); }
  // W M for M with a row for each sample.
  void Whiten(Eigen::Ref<Eigen::MatrixXd> rows_px) const;

 private:
  const EdgeObservation* observation_;
  Eigen::VectorXd scale_;
  Eigen::MatrixXd common_;          // V, n x 2
  Eigen::Vector2d common_damping_;  // 1 - 1/sqrt(1 + l^2)
};

// Distances (px, outward) of an edge's samples from the projected, distorted outline of the cylinder of
// radius_m about the axis from a_in_camera to b_in_camera; nothing where there is no such outline.
std::optional<Eigen::VectorXd> EdgeDistances(const Camera& camera, const Eigen::Vector3d& a_in_camera,
                                             const Eigen::Vector3d& b_in_camera, double radius_m,
                                             const EdgeObservation& edge);

// Edge residuals of one leg (px / sigma after whitening), one row a sample, and their derivatives.
struct EdgeResiduals {
  Eigen::VectorXd residual;
  Eigen::Matrix<double, Eigen::Dynamic, kCameraParameterCount> d_camera;
  Eigen::Matrix<double, Eigen::Dynamic, 7> d_axis;  // A (3), b = B in camera (3), R
  Eigen::Matrix<double, Eigen::Dynamic, 4> d_shading;
};

// Distances of the samples of `edges` (all of one leg) from the projected, distorted outline of the cylinder
// of radius_m about the axis from a_in_camera to b_in_camera, moved outward as `shading` says. Nothing where
// the camera centre lies in the cylinder or an outline cannot be reached.
std::optional<EdgeResiduals> EvaluateEdges(const Camera& camera, const Eigen::Vector3d& a_in_camera,
                                           const Eigen::Vector3d& b_in_camera, double radius_m,
                                           const Eigen::Vector4d& shading_px,
                                           const std::vector<WhitenedEdge>& edges);

}  // namespace legible
