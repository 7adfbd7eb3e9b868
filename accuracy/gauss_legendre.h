// Gauss-Legendre nodes on [0, 1].
#pragma once

#include <Eigen/Core>

namespace legible {

// `panels` equal panels of ten nodes each; weights add up to 1.
struct GaussLegendre {
  Eigen::VectorXd nodes, weights;
};
GaussLegendre GaussLegendrePanels(int panels);

inline constexpr int kNodesPerPanel = 10;

}  // namespace legible
