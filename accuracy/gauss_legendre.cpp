#include "accuracy/gauss_legendre.h"

#include <boost/math/quadrature/gauss.hpp>

namespace legible {

GaussLegendre GaussLegendrePanels(int panels) {
  using Rule = boost::math::quadrature::gauss<double, kNodesPerPanel>;
  const auto& places = Rule::abscissa();  // the positive half of those on [-1, 1]
  const auto& weights = Rule::weights();
  GaussLegendre rule{Eigen::VectorXd(panels * kNodesPerPanel), Eigen::VectorXd(panels * kNodesPerPanel)};
  Eigen::Index next = 0;
  for (int panel = 0; panel < panels; ++panel)
    for (size_t i = 0; i < places.size(); ++i)
      for (const double side : {-1.0, 1.0}) {
        rule.nodes[next] = (panel + (1 + side * places[i]) / 2) / panels;
        rule.weights[next++] = weights[i] / (2 * panels);
      }
  return rule;
}

}  // namespace legible
