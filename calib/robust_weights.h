// Weights that take outliers out of the estimate, and the noise that the residuals show.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calib/edge_residuals.h"

namespace legible {

// Weight of a residual of `normalised` standard deviations: 1 up to 3, falling smoothly to 0 at 6 (a Hampel
// weight with a cosine flank). Costs 0.1 % of efficiency on normal noise.
double RobustWeight(double normalised);

// By what a sigma is multiplied so that its observation counts with `weight`; finite where that is 0.
double SigmaFactor(double weight);

// Residuals of one edge in one image.
struct EdgeResidualSet {
  int image = 0;
  int leg = 0;
  int edge = 0;
  Eigen::VectorXd place;        // along the edge, -1 … 1
  Eigen::VectorXd sigma_px;     // of each sample, as measured
  Eigen::VectorXd residual_px;  // distances from the modelled edge, outward
  Eigen::VectorXd weight;       // robust, [0, 1]
  double common_sigma_px = 0;
  double common_weight = 1;  // of the information on shift and tilt
  double trust = 1;          // robust, [0, 1]: of the edge as a whole

  // What each sample counts in sums over many edges.
  Eigen::VectorXd CountedWeight() const { return trust * weight; }
};

// Standard deviation of normal noise over the median of its absolute values.
inline constexpr double kSigmaOfMedian = 1.4826;

// kSigmaOfMedian x median |residual / sigma_px|: a scale that half the samples being wrong does not move.
double MedianScale(const std::vector<EdgeResidualSet>& edges);

// Noise that the weighted residuals show; `parameters` unknowns were fitted to them. The scale is corrected
// for the flanks that RobustWeight cuts off normal noise. Where edges have a common_sigma_px, what is common
// along them is told apart by a line through each edge's residuals (method of moments), for each edge of each
// leg, drawn towards the mean of all where there are few images; otherwise shift and tilt stay 1 and all
// share one sample noise.
NoiseByEdge EstimateNoise(const std::vector<EdgeResidualSet>& edges, double parameters);

// Sets every weight for the given noise, after the part of each edge's residual that shift and tilt explain.
void UpdateWeights(std::vector<EdgeResidualSet>& edges, const NoiseByEdge& noise);

// The same noise for every edge; the mean square of all edges' noise.
NoiseByEdge UniformNoise(const EdgeNoise& noise);
EdgeNoise MeanNoise(const NoiseByEdge& noise);

}  // namespace legible
