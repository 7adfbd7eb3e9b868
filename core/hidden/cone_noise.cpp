#include "core/hidden/cone_noise.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <queue>

#include "core/hidden/seen_features.h"
#include "core/hidden/singularity_conditions.h"
#include "core/robots/platform_motion.h"

namespace legible {
namespace {

// Of the bound over the largest extent found, at which the search ends.
constexpr double kRelativeGap = 1e-3;
constexpr int kMostAscents = 200;
constexpr double kSameExtent = 1e-12;
constexpr double kLeastSingularValue = 1e-10;

// sum_i |P_i^T w|, the extent in direction w of the sum of the ellipses P_i d, |d| <= 1. Convex, and as long
// as w.
class Extent {
 public:
  explicit Extent(const Eigen::Matrix<double, 3, Eigen::Dynamic>& columns) : columns_(columns) {}

  double operator()(const Eigen::Vector3d& w) const {
    double sum = 0;
    for (Eigen::Index at = 0; at < columns_.cols(); at += 3)
      sum += (columns_.middleCols<3>(at).transpose() * w).norm();
    return sum;
  }

  Eigen::Vector3d Gradient(const Eigen::Vector3d& w) const {
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    for (Eigen::Index at = 0; at < columns_.cols(); at += 3) {
      const Eigen::Vector3d side = columns_.middleCols<3>(at).transpose() * w;
      if (side.norm() > 0) gradient += columns_.middleCols<3>(at) * side.normalized();
    }
    return gradient;
  }

 private:
  const Eigen::Matrix<double, 3, Eigen::Dynamic>& columns_;
};

// From w uphill to a local maximum: of a convex function that is as long as w the next w, its gradient's
// direction, is never lower.
double LocalMaximum(const Extent& extent, Eigen::Vector3d w) {
  double value = extent(w.normalized());
  for (int i = 0; i < kMostAscents; ++i) {
    const Eigen::Vector3d gradient = extent.Gradient(w);
    if (!(gradient.norm() > 0)) break;
    w = gradient.normalized();
    const double next = extent(w);
    if (next <= value * (1 + kSameExtent)) break;
    value = next;
  }
  return value;
}

// A cell of a face of the cube [-1, 1]^3, from whose directions the extent is at most `most`: a direction w
// of the cell is a sum of its corners' directions c_k times numbers a_k >= 0, so that the extent in w is at
// most sum a_k extent(c_k), and with the middle's direction m, sum a_k <= 1 / min (c_k . m) for |w| = 1.
struct Cell {
  Eigen::Vector3d corner, first, second;  // the corner and the two edges
  double most = 0;
};

bool operator<(const Cell& a, const Cell& b) { return a.most < b.most; }

Eigen::Vector3d Middle(const Cell& cell) { return cell.corner + 0.5 * (cell.first + cell.second); }

double MostOf(const Extent& extent, const Cell& cell) {
  const Eigen::Vector3d middle = Middle(cell).normalized();
  double at_corners = 0, least_cosine = 1;
  for (const int i : {0, 1})
    for (const int j : {0, 1}) {
      const Eigen::Vector3d corner = (cell.corner + i * cell.first + j * cell.second).normalized();
      at_corners = std::max(at_corners, extent(corner));
      least_cosine = std::min(least_cosine, corner.dot(middle));
    }
  return at_corners / least_cosine;
}

// The largest extent over all directions: those of half a cube's surface, for w and -w are alike.
double LargestExtent(const Extent& extent) {
  std::priority_queue<Cell> cells;
  double best = 0;
  const auto add = [&](Cell cell) {
    cell.most = MostOf(extent, cell);
    if (cell.most <= best * (1 + kRelativeGap)) return;
    if (extent(Middle(cell).normalized()) > best) best = LocalMaximum(extent, Middle(cell));
    cells.push(cell);
  };
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    Cell face;
    face.corner.setConstant(-1);
    face.corner[axis] = 1;
    face.first = 2 * Eigen::Vector3d::Unit((axis + 1) % 3);
    face.second = 2 * Eigen::Vector3d::Unit((axis + 2) % 3);
    add(face);
  }
  while (!cells.empty()) {
    const Cell cell = cells.top();
    cells.pop();
    if (cell.most <= best * (1 + kRelativeGap)) break;
    for (const int i : {0, 1})
      for (const int j : {0, 1})
        add({cell.corner + 0.5 * (i * cell.first + j * cell.second), 0.5 * cell.first, 0.5 * cell.second, 0});
  }
  return best;
}

}  // namespace

std::optional<LargestPoseError> LargestErrorByConeNoise(const ParallelRobot& robot,
                                                        const std::vector<int>& legs,
                                                        const Rigid3& base_from_platform,
                                                        double half_angle_rad) {
  const auto interaction = FeatureInteraction(robot, legs, base_from_platform, SeenFeature::kDirections);
  if (!interaction) return std::nullopt;
  const auto basis = MotionBasisInSize(robot, base_from_platform, SizeOf_m(robot, base_from_platform));
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(*interaction * basis,
                                              Eigen::ComputeThinU | Eigen::ComputeThinV);
  const auto& values = svd.singularValues();
  if (interaction->rows() < basis.cols() || !(values[basis.cols() - 1] > kLeastSingularValue * values[0]))
    return std::nullopt;
  const Eigen::MatrixXd twists =
      half_angle_rad * basis * svd.solve(Eigen::MatrixXd::Identity(interaction->rows(), interaction->rows()));
  const Eigen::Matrix<double, 3, Eigen::Dynamic> position = twists.topRows<3>(),
                                                 rotation = twists.bottomRows<3>();
  return LargestPoseError{LargestExtent(Extent(position)), LargestExtent(Extent(rotation))};
}

}  // namespace legible
