#include "accuracy/error_sets.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <stdexcept>

#include "accuracy/maximal_errors.h"
#include "accuracy/zonotope.h"

namespace legible {
namespace {

Ellipsoid EllipsoidOf(const Eigen::Matrix3Xd& generators) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(generators, Eigen::ComputeFullU);
  Ellipsoid ellipsoid;
  ellipsoid.semi_axes.head(svd.singularValues().size()) = svd.singularValues();
  ellipsoid.directions = svd.matrixU();
  return ellipsoid;
}

ErrorSet SetOf(const Eigen::Matrix3Xd& generators) {
  return {ConvexHull(SignVertices(generators)), EllipsoidOf(generators)};
}

}  // namespace

ErrorSets ErrorSetsOf(const PlatformJacobian& jacobian, const Eigen::VectorXd& bounds) {
  if (jacobian.status == PoseStatus::kSingular || bounds.size() != jacobian.matrix.cols())
    throw std::invalid_argument("ErrorSetsOf: a singular pose, or bounds that do not fit");
  const Eigen::MatrixXd generators = jacobian.matrix * bounds.asDiagonal();
  ErrorSets sets{SetOf(LinearPart(generators, jacobian.linear)),
                 SetOf(AngularPart(generators, jacobian.linear))};
  if (generators.rows() == generators.cols())
    sets.volume_6d =
        std::abs(generators.determinant()) * std::pow(2.0, static_cast<double>(generators.cols()));
  return sets;
}

}  // namespace legible
