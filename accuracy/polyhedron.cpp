#include "accuracy/polyhedron.h"

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

namespace legible {
namespace {

constexpr double kFlat = 1e-9;  // smallest over largest extent of points that span no volume

bool SpansVolume(const Eigen::MatrixXd& points) {
  if (points.cols() <= points.rows() || !points.allFinite()) return false;
  const Eigen::MatrixXd centred = points.colwise() - points.rowwise().mean();
  const Eigen::VectorXd extents = Eigen::JacobiSVD<Eigen::MatrixXd>(centred).singularValues();
  return extents[extents.size() - 1] > kFlat * extents[0];
}

// Sorts a facet's vertices about its normal.
void SortAround(const Eigen::Vector3d& normal, const Eigen::MatrixXd& vertices, std::vector<int>& facet) {
  const Eigen::Vector3d across = normal.unitOrthogonal(), up = normal.cross(across);
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const int vertex : facet) centre += vertices.col(vertex) / static_cast<double>(facet.size());
  const auto angle = [&](int vertex) {
    const Eigen::Vector3d from_centre = vertices.col(vertex) - centre;
    return std::atan2(up.dot(from_centre), across.dot(from_centre));
  };
  std::sort(facet.begin(), facet.end(), [&](int a, int b) { return angle(a) < angle(b); });
}

// A run of Qhull, whose C++ classes are not C++20.
class HullRun {
 public:
  // Points a column each; throws std::runtime_error if Qhull gives up.
  explicit HullRun(const Eigen::MatrixXd& points) : coordinates_(points) {
    QHULL_LIB_CHECK
    qh_zero(&qh_, nullptr);
    std::string command = "qhull";
    if (qh_new_qhull(&qh_, static_cast<int>(points.rows()), static_cast<int>(points.cols()),
                     coordinates_.data(), False, command.data(), nullptr, nullptr) != 0) {
      Free();
      throw std::runtime_error("ConvexHull: Qhull finds no hull of these points");
    }
  }
  ~HullRun() { Free(); }
  HullRun(const HullRun&) = delete;
  HullRun& operator=(const HullRun&) = delete;

  double Volume() {
    qh_getarea(&qh_, qh_.facet_list);
    return qh_.totvol;
  }

  // Qhull's numbers of points become those of vertices, in the order in which facets name them.
  Polyhedron ToPolyhedron() {
    Polyhedron polyhedron;
    std::map<int, int> vertex_of_point;
    polyhedron.normals.resize(coordinates_.rows(), qh_.num_facets);
    polyhedron.offsets.resize(qh_.num_facets);
    Eigen::Index column = 0;
    for (facetT* facet = qh_.facet_list; facet != nullptr && facet->next != nullptr;
         facet = facet->next, ++column) {
      polyhedron.normals.col(column) = Eigen::Map<const Eigen::VectorXd>(facet->normal, coordinates_.rows());
      polyhedron.offsets[column] = -facet->offset;
      polyhedron.facets.push_back(VerticesOf(*facet, vertex_of_point));
    }
    polyhedron.vertices.resize(coordinates_.rows(), static_cast<Eigen::Index>(vertex_of_point.size()));
    for (const auto& [point, vertex] : vertex_of_point)
      polyhedron.vertices.col(vertex) = coordinates_.col(point);
    return polyhedron;
  }

 private:
  std::vector<int> VerticesOf(const facetT& facet, std::map<int, int>& vertex_of_point) {
    std::vector<int> vertices;
    for (int i = 0; i < qh_setsize(&qh_, facet.vertices); ++i) {
      const auto* vertex = static_cast<const vertexT*>(facet.vertices->e[i].p);
      const int next = static_cast<int>(vertex_of_point.size());
      vertices.push_back(vertex_of_point.emplace(qh_pointid(&qh_, vertex->point), next).first->second);
    }
    return vertices;
  }

  void Free() {
    qh_freeqhull(&qh_, !qh_ALL);
    int still_used = 0, bytes = 0;
    qh_memfreeshort(&qh_, &still_used, &bytes);
  }

  Eigen::MatrixXd coordinates_;
  qhT qh_;
};

// Back from coordinates that were divided by `scale`.
void Rescale(const Eigen::VectorXd& scale, Polyhedron& polyhedron) {
  polyhedron.vertices = (scale.asDiagonal() * polyhedron.vertices).eval();
  polyhedron.normals = (scale.cwiseInverse().asDiagonal() * polyhedron.normals).eval();
  const Eigen::VectorXd lengths = polyhedron.normals.colwise().norm();
  polyhedron.normals = (polyhedron.normals * lengths.cwiseInverse().asDiagonal()).eval();
  polyhedron.offsets = polyhedron.offsets.cwiseQuotient(lengths).eval();
  polyhedron.volume *= scale.prod();
}

// The dual of a polyhedron that holds the origin inside: a point n / offset for each facet.
Eigen::MatrixXd DualPoints(const Polyhedron& polyhedron) {
  if (!(polyhedron.offsets.size() > 0 && polyhedron.offsets.minCoeff() > 0))
    throw std::invalid_argument("Intersection: a polyhedron does not hold the origin inside");
  return polyhedron.normals * polyhedron.offsets.cwiseInverse().asDiagonal();
}

}  // namespace

std::optional<Polyhedron> ConvexHull(const Eigen::MatrixXd& points) {
  const Eigen::VectorXd scale = points.cwiseAbs().rowwise().maxCoeff();
  if (points.cols() == 0 || !(scale.minCoeff() > 0)) return std::nullopt;
  const Eigen::MatrixXd scaled =
      scale.cwiseInverse().asDiagonal() * points;  // Qhull's tolerances are absolute
  if (!SpansVolume(scaled)) return std::nullopt;
  HullRun run(scaled);
  Polyhedron polyhedron = run.ToPolyhedron();
  polyhedron.volume = run.Volume();
  Rescale(scale, polyhedron);
  if (points.rows() == 3)
    for (size_t i = 0; i < polyhedron.facets.size(); ++i)
      SortAround(polyhedron.normals.col(static_cast<Eigen::Index>(i)), polyhedron.vertices,
                 polyhedron.facets[i]);
  return polyhedron;
}

// Half-spaces n.x <= d become points n / d; the facets of their hull, m.y <= c, become the vertices m / c.
Polyhedron Intersection(const Polyhedron& a, const Polyhedron& b) {
  if (a.vertices.rows() != b.vertices.rows())
    throw std::invalid_argument("Intersection: the polyhedra have different dimensions");
  Eigen::MatrixXd dual(a.vertices.rows(), a.normals.cols() + b.normals.cols());
  dual << DualPoints(a), DualPoints(b);
  const std::optional<Polyhedron> dual_hull = ConvexHull(dual);
  if (!dual_hull) throw std::invalid_argument("Intersection: the polyhedra are flat");
  const std::optional<Polyhedron> common = ConvexHull(DualPoints(*dual_hull));
  if (!common) throw std::invalid_argument("Intersection: the polyhedra are flat");
  return *common;
}

}  // namespace legible
