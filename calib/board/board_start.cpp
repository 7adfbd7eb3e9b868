#include "calib/board/board_start.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "core/vision/median.h"

namespace legible {
namespace {

// Of the division model, in units of half the image's diagonal; at -1 the corner of the image is 90 degrees
// off the axis.
constexpr double kMostBarrel = -0.96, kMostPincushion = 0.4, kCoarseStep = 0.04;

Eigen::Vector2d Straightened(double lambda, const Eigen::Vector2d& p) {
  return p / (1 + lambda * p.squaredNorm());
}

Eigen::Vector2d Bent(double lambda, const Eigen::Vector2d& x) {
  const double root = 1 - 4 * lambda * x.squaredNorm();
  return x * (2 / (1 + std::sqrt(std::max(root, 0.0))));
}

struct PlanarPoints {
  std::vector<Eigen::Vector2d> on_board;  // about their mean, of mean distance 1
  std::vector<Eigen::Vector2d> in_image;  // units of half the diagonal
  Eigen::Matrix3d normalised_from_board;
};

PlanarPoints PointsOf(const ViewObservation& view, const Eigen::Vector2d& centre_px, double unit_px) {
  PlanarPoints points;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector3d& x : view.points_in_board_m) mean += x.head<2>();
  mean /= static_cast<double>(view.pixels.size());
  double size_m = 0;
  for (const Eigen::Vector3d& x : view.points_in_board_m) size_m += (x.head<2>() - mean).norm();
  size_m /= static_cast<double>(view.pixels.size());
  for (size_t k = 0; k < view.pixels.size(); ++k) {
    points.on_board.emplace_back((view.points_in_board_m[k].head<2>() - mean) / size_m);
    points.in_image.emplace_back((view.pixels[k] - centre_px) / unit_px);
  }
  points.normalised_from_board << 1 / size_m, 0, -mean.x() / size_m, 0, 1 / size_m, -mean.y() / size_m, 0, 0,
      1;
  return points;
}

// The direct linear transform: the eigenvector of the least eigenvalue; nothing where the points leave more
// than one.
std::optional<Eigen::Matrix3d> FitHomography(const std::vector<Eigen::Vector2d>& from,
                                             const std::vector<Eigen::Vector2d>& to,
                                             const std::vector<double>& weights) {
  Eigen::Matrix<double, 9, 9> moment = Eigen::Matrix<double, 9, 9>::Zero();
  for (size_t i = 0; i < from.size(); ++i) {
    const Eigen::RowVector3d x = from[i].homogeneous().transpose();
    Eigen::Matrix<double, 2, 9> rows;
    rows << x, Eigen::RowVector3d::Zero(), -to[i].x() * x,  //
        Eigen::RowVector3d::Zero(), x, -to[i].y() * x;
    moment += weights[i] * rows.transpose() * rows;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> solver(moment);
  constexpr double kLeastGap = 1e-12;
  if (!(solver.eigenvalues()[1] > kLeastGap * solver.eigenvalues()[8])) return std::nullopt;
  const Eigen::Matrix<double, 9, 1> h = solver.eigenvectors().col(0);
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(h.data());
}

std::vector<double> ErrorsOf(const PlanarPoints& points, const Eigen::Matrix3d& homography, double lambda) {
  std::vector<double> errors;
  errors.reserve(points.on_board.size());
  for (size_t i = 0; i < points.on_board.size(); ++i) {
    const Eigen::Vector3d x = homography * points.on_board[i].homogeneous();
    errors.push_back((Bent(lambda, x.hnormalized()) - points.in_image[i]).norm());
  }
  return errors;
}

// Re-weighted so that what is far off by the median's measure counts for little (Cauchy).
std::optional<ViewHomography> HomographyOf(const PlanarPoints& points, double lambda) {
  constexpr int kRounds = 4;
  if (points.on_board.size() < 4) return std::nullopt;
  std::vector<Eigen::Vector2d> straight;
  for (const Eigen::Vector2d& p : points.in_image) straight.push_back(Straightened(lambda, p));
  std::vector<double> weights(points.on_board.size(), 1.0);
  std::optional<ViewHomography> found;
  for (int round = 0; round < kRounds; ++round) {
    const auto homography = FitHomography(points.on_board, straight, weights);
    if (!homography) return std::nullopt;
    const std::vector<double> errors = ErrorsOf(points, *homography, lambda);
    const double scale = std::max(MedianOf(errors), 1e-9);
    found = {*homography * points.normalised_from_board, scale};
    for (size_t i = 0; i < weights.size(); ++i) weights[i] = 1 / (1 + std::pow(errors[i] / (3 * scale), 2));
  }
  return found;
}

// How far from flat the boards are under that lambda: the median of the views' medians.
double Unevenness(const std::vector<PlanarPoints>& views, double lambda) {
  std::vector<double> errors;
  for (const PlanarPoints& points : views)
    if (const auto homography = HomographyOf(points, lambda)) errors.push_back(homography->median_error);
  return errors.empty() ? 0 : MedianOf(errors);
}

double BestLambda(const std::vector<PlanarPoints>& views) {
  double best = 0, least = Unevenness(views, 0);
  const auto consider = [&](double lambda) {
    const double unevenness = Unevenness(views, lambda);
    if (unevenness < least) {
      least = unevenness;
      best = lambda;
    }
  };
  for (double lambda = kMostBarrel; lambda <= kMostPincushion; lambda += kCoarseStep) consider(lambda);
  for (double step = kCoarseStep / 2; step > 1e-3; step /= 2) {
    const double middle = best;
    consider(middle - step);
    consider(middle + step);
  }
  return best;
}

// Where the board stands of whose plane H is the mapping to normalised coordinates, in front of the camera.
Rigid3 PoseOf(Eigen::Matrix3d homography) {
  if (homography(2, 2) < 0) homography = -homography;
  const double scale = 2 / (homography.col(0).norm() + homography.col(1).norm());
  Eigen::Matrix3d axes;
  axes << scale * homography.leftCols<2>(), scale * scale * homography.col(0).cross(homography.col(1));
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(axes, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d rotation = svd.matrixU() * svd.matrixV().transpose();
  return {Eigen::Quaterniond(rotation), scale * homography.col(2)};
}

// Coefficients of the lens whose radial part is nearest to the division model, by least squares weighted as
// pixels; focal length in the image's unit.
Distortion NearestCoefficients(LensModel lens, double lambda, double focal_length) {
  constexpr int kPlaces = 40;
  const int count = lens == LensModel::kFisheye ? 4 : 2;
  Eigen::MatrixXd rows(kPlaces, count);
  Eigen::VectorXd values(kPlaces);
  for (int i = 0; i < kPlaces; ++i) {
    const double place = (i + 0.5) / kPlaces;  // in the image, up to its corner
    const double bent = place / focal_length, straight = bent / (1 + lambda * place * place);
    const double ideal = lens == LensModel::kFisheye ? std::atan(straight) : straight;
    values[i] = bent - ideal;
    for (int k = 0; k < count; ++k) rows(i, k) = std::pow(ideal, 2 * k + 3);
  }
  const Eigen::VectorXd k = rows.colPivHouseholderQr().solve(values);
  Distortion coefficients = Distortion::Zero();
  if (lens != LensModel::kPinhole) coefficients.head(count) = k;
  return coefficients;
}

}  // namespace

StraightenedViews Straighten(const std::vector<ViewObservation>& views, int width_px, int height_px,
                             bool may_bend) {
  StraightenedViews result;
  result.unit_px = 0.5 * std::hypot(width_px, height_px);
  result.centre_px = Eigen::Vector2d(width_px - 1, height_px - 1) / 2;
  std::vector<PlanarPoints> points;
  points.reserve(views.size());
  for (const ViewObservation& view : views)
    points.push_back(PointsOf(view, result.centre_px, result.unit_px));
  if (may_bend) {
    std::vector<PlanarPoints> some;
    for (const size_t i : ViewsWithMostCorners(views)) some.push_back(points[i]);
    result.lambda = BestLambda(some);
  }
  for (const PlanarPoints& one : points) result.views.push_back(HomographyOf(one, result.lambda));
  return result;
}

std::vector<size_t> ViewsWithMostCorners(const std::vector<ViewObservation>& views) {
  constexpr size_t kMost = 24;
  std::vector<size_t> order;
  const size_t stride = std::max<size_t>(1, views.size() / kMost);
  for (size_t first = 0; first < stride; ++first)
    for (size_t i = first; i < views.size(); i += stride) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return views[a].pixels.size() > views[b].pixels.size(); });
  order.resize(std::min(order.size(), kMost));
  return order;
}

double NeighbourDistance_px(const ViewObservation& view) {
  std::vector<double> distances;
  for (size_t k = 1; k < view.pixels.size(); ++k)
    distances.push_back((view.pixels[k] - view.pixels[k - 1]).norm());
  return MedianOf(distances);
}

std::optional<double> FocalLengthOf(const StraightenedViews& straightened) {
  double left = 0, right = 0;
  for (const auto& view : straightened.views) {
    if (!view) continue;
    Eigen::Matrix<double, 3, 2> h = view->image_from_board.leftCols<2>();
    h /= h.topRows<2>().norm();
    const Eigen::Vector2d a = h.col(0).head<2>(), b = h.col(1).head<2>();
    const Eigen::Vector2d by_image(a.dot(b), (a.squaredNorm() - b.squaredNorm()) / 2);
    const Eigen::Vector2d by_depth(h(2, 0) * h(2, 1), (h(2, 0) * h(2, 0) - h(2, 1) * h(2, 1)) / 2);
    left += by_image.squaredNorm();
    right -= by_image.dot(by_depth);
  }
  const double inverse_square = right / left;
  if (!(inverse_square > 0)) return std::nullopt;
  return 1 / std::sqrt(inverse_square);
}

BoardProblem ProblemAt(const StraightenedViews& straightened, double focal_length, LensModel lens,
                       int width_px, int height_px, const std::vector<ViewObservation>& views) {
  BoardProblem problem;
  problem.camera = {width_px,
                    height_px,
                    focal_length * straightened.unit_px,
                    focal_length * straightened.unit_px,
                    straightened.centre_px.x(),
                    straightened.centre_px.y(),
                    lens,
                    NearestCoefficients(lens, straightened.lambda, focal_length)};
  problem.views = views;
  const Eigen::Vector3d to_normalised(1 / focal_length, 1 / focal_length, 1);
  for (size_t i = 0; i < views.size(); ++i)
    if (const auto& view = straightened.views[i])
      problem.views[i].camera_from_board = PoseOf(to_normalised.asDiagonal() * view->image_from_board);
  return problem;
}

}  // namespace legible
