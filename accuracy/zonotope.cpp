#include "accuracy/zonotope.h"

#include <Eigen/Geometry>
#include <array>
#include <stdexcept>

namespace legible {
namespace {

constexpr int kMostGeneratorsOfAllCorners = 12;
constexpr double kCoplanar = 1e-12;  // sine of an angle

// The vertex farthest along the first of the three directions; among those equally far, along the second,
// then along the third. The columns of `unit` are the generators' directions.
Eigen::Vector3d VertexAlong(const Eigen::Matrix3Xd& generators, const Eigen::Matrix3Xd& unit,
                            const std::array<Eigen::Vector3d, 3>& directions) {
  Eigen::Vector3d vertex = Eigen::Vector3d::Zero();
  for (Eigen::Index k = 0; k < generators.cols(); ++k) {
    for (const Eigen::Vector3d& direction : directions) {
      const double along = unit.col(k).dot(direction);
      if (std::abs(along) <= kCoplanar) continue;
      vertex += along > 0 ? generators.col(k) : Eigen::Vector3d(-generators.col(k));
      break;
    }
  }
  return vertex;
}

Eigen::Matrix3Xd WithoutZeros(const Eigen::Matrix3Xd& generators) {
  Eigen::Matrix3Xd kept(3, generators.cols());
  Eigen::Index count = 0;
  for (Eigen::Index k = 0; k < generators.cols(); ++k)
    if (generators.col(k).squaredNorm() > 0) kept.col(count++) = generators.col(k);
  return kept.leftCols(count);
}

}  // namespace

Eigen::Matrix3Xd SignVertices(const Eigen::Matrix3Xd& generators) {
  const Eigen::Index m = generators.cols();
  if (m > kMostGeneratorsOfAllCorners) throw std::invalid_argument("SignVertices: too many generators");
  Eigen::Matrix3Xd vertices = Eigen::Matrix3Xd::Zero(3, Eigen::Index{1} << m);
  for (Eigen::Index corner = 0; corner < vertices.cols(); ++corner)
    for (Eigen::Index k = 0; k < m; ++k)
      vertices.col(corner) += ((corner >> k & 1) != 0 ? 1.0 : -1.0) * generators.col(k);
  return vertices;
}

// Every facet of a zonotope is spanned by two generators at least and its edges are parallel to one: the
// vertex at one end of an edge is the farthest across the facet, then within the facet across the edge, then
// along the edge. The centre is symmetric, so half the facets do.
Eigen::Vector3d FarthestPoint(const Eigen::Matrix3Xd& all_generators) {
  const Eigen::Matrix3Xd generators = WithoutZeros(all_generators);
  const Eigen::Matrix3Xd unit = generators.colwise().normalized();
  Eigen::Vector3d farthest = Eigen::Vector3d::Zero();
  const auto take = [&](const Eigen::Vector3d& vertex) {
    if (vertex.squaredNorm() > farthest.squaredNorm()) farthest = vertex;
  };
  for (Eigen::Index i = 0; i < generators.cols(); ++i) {
    const Eigen::Vector3d along = unit.col(i);
    take(VertexAlong(generators, unit, {along, along, along}));
    for (Eigen::Index j = 0; j < generators.cols(); ++j) {
      const Eigen::Vector3d normal = along.cross(unit.col(j));
      if (normal.norm() <= kCoplanar) continue;
      const Eigen::Vector3d across = normal.normalized(), within = across.cross(along);
      for (const double side : {1.0, -1.0})
        for (const double end : {1.0, -1.0})
          take(VertexAlong(generators, unit, {across, side * within, end * along}));
    }
  }
  return farthest;
}

}  // namespace legible
