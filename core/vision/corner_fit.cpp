#include "core/vision/corner_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <boost/math/special_functions/owens_t.hpp>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace legible {
namespace {

constexpr double kLeastPitchUnknown_px = 4, kLeastPitchKnown_px = 2;
// So far keeps the window off the next lines: three times the blur of a sharp image, twice where it is known
// what comes behind them.
constexpr double kKeptOffUnknown_px = 2.5, kKeptOffKnown_px = 1.7;
constexpr double kLeastHalfWidth_px = 2, kLargestHalfWidth_px = 7;
constexpr double kLargestRadius_px = 10;  // of the window's pixels, where the edges are oblique
constexpr double kFarInSigma = 6;         // from a line, its blur is over
constexpr double kReach_px = 4;           // beyond the window, within which lines matter
constexpr double kLeastBlur_px = 0.3;     // that of a pixel alone
constexpr double kLargestBlur_px = 3;
constexpr double kLeastContrast = 10;    // grey levels
constexpr double kLargestMisfit = 0.15;  // rms over contrast
constexpr double kRecentred_px = 0.3;    // so far may the corner be from its window's middle
constexpr int kMaxWindows = 4, kMaxSteps = 40;
constexpr double kSteady_px = 1e-4;

constexpr int kPlaceAndBlur = 5;  // parameters of the model; then dark and contrast
constexpr int kUnknowns = kPlaceAndBlur + 2;
enum { kX, kY, kDirection1, kDirection2, kBlur, kDark, kContrast };
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using NormalMatrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;

double NormalDistribution(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }
double NormalDensity(double z) {
  return std::exp(-0.5 * z * z) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
}

double OwensT(double h, double a) {
  // Boost would compute it in 80 bits.
  constexpr boost::math::policies::policy<boost::math::policies::promote_double<false>> kInDouble;
  return boost::math::owens_t(h, a, kInDouble);
}

// P(X < h, Y < k) of standard normal X and Y with correlation rho, |rho| < 1; by Owen's T.
double BivariateNormal(double h, double k, double rho) {
  if (h < -kFarInSigma || k < -kFarInSigma) return 0;
  if (h > kFarInSigma) return NormalDistribution(k);
  if (k > kFarInSigma) return NormalDistribution(h);
  constexpr double kNoZero = 1e-12;  // Owen's form has a removable singularity on the axes
  if (std::abs(h) < kNoZero) h = kNoZero;
  if (std::abs(k) < kNoZero) k = kNoZero;
  const double root = std::sqrt(1 - rho * rho);
  const double t = OwensT(h, (k / h - rho) / root) + OwensT(k, (h / k - rho) / root);
  return 0.5 * (NormalDistribution(h) + NormalDistribution(k)) - t - (h * k > 0 ? 0 : 0.5);
}

// Its derivatives by h, k and rho.
Eigen::Vector3d BivariateNormalGradient(double h, double k, double rho) {
  if (std::min(h, k) < -kFarInSigma) return Eigen::Vector3d::Zero();
  const double root = std::sqrt(1 - rho * rho);
  return {NormalDensity(h) * NormalDistribution((k - rho * h) / root),
          NormalDensity(k) * NormalDistribution((h - rho * k) / root),
          NormalDensity(h) * NormalDensity((k - rho * h) / root) / root};
}

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Distances of the next lines from the lines through the corner: those of edge 1, of edge 2.
Eigen::Vector2d Pitches_px(const CornerSite& site) {
  const double area = std::abs(Cross(site.edges_px[0], site.edges_px[1]));
  return {area / site.edges_px[0].norm(), area / site.edges_px[1].norm()};
}

Eigen::Vector2d HalfWidths_px(const CornerSite& site) {
  const double kept_off_px = site.knows_beyond ? kKeptOffKnown_px : kKeptOffUnknown_px;
  return (Pitches_px(site).array() - kept_off_px).max(kLeastHalfWidth_px).min(kLargestHalfWidth_px);
}

// Parallel edges too.
bool IsTooSmall(const CornerSite& site) {
  const double least_px = site.knows_beyond ? kLeastPitchKnown_px : kLeastPitchUnknown_px;
  return !(Pitches_px(site).array() >= least_px).all();
}

struct WindowPixel {
  Eigen::Vector2d place;
  double grey;
};

// The pixels within the half widths of both edges; nothing where a part of them is outside the image.
std::optional<std::vector<WindowPixel>> Window(const GrayImage& image, const CornerSite& site,
                                               const Eigen::Vector2d& middle) {
  const Eigen::Vector2d half = HalfWidths_px(site);
  const Eigen::Vector2d e1 = site.edges_px[0].normalized(), e2 = site.edges_px[1].normalized();
  std::vector<WindowPixel> pixels;
  const auto reach = static_cast<int>(kLargestRadius_px) + 1;
  const int x0 = static_cast<int>(std::lround(middle.x())), y0 = static_cast<int>(std::lround(middle.y()));
  for (int y = y0 - reach; y <= y0 + reach; ++y)
    for (int x = x0 - reach; x <= x0 + reach; ++x) {
      const Eigen::Vector2d from_middle = Eigen::Vector2d(x, y) - middle;
      if (std::abs(Cross(e1, from_middle)) > half[0] || std::abs(Cross(e2, from_middle)) > half[1] ||
          from_middle.norm() > kLargestRadius_px)
        continue;
      if (x < 0 || y < 0 || x >= image.width || y >= image.height) return std::nullopt;
      pixels.push_back({{x, y}, static_cast<double>(image(x, y))});
    }
  return pixels;
}

// What is expected of an unknown: a residual of it, in grey levels.
struct Expectation {
  int unknown;
  double value;
  double weight;  // grey levels per unit of the unknown
};

// What the unknowns have to agree with.
struct Problem {
  CornerModel model;
  std::vector<WindowPixel> window;
  std::vector<Expectation> expectations;

  double Freedoms() const { return static_cast<double>(window.size() + expectations.size()) - kUnknowns; }
};

std::vector<Expectation> ExpectationsOf(const CornerExpectations& expected, const Unknowns& start) {
  std::vector<Expectation> expectations;
  const auto expect = [&](int unknown, double sigma) {
    if (std::isfinite(sigma)) expectations.push_back({unknown, start[unknown], expected.noise / sigma});
  };
  expect(kDirection1, expected.direction_sigma_rad);
  expect(kDirection2, expected.direction_sigma_rad);
  expect(kBlur, expected.blur_sigma_px);
  return expectations;
}

// Sums over the residuals of a set of unknowns.
struct Sums {
  double squares = 0;
  NormalMatrix matrix = NormalMatrix::Zero();
  Unknowns gradient = Unknowns::Zero();

  void Add(double residual, const Unknowns& row) {
    squares += residual * residual;
    matrix.selfadjointView<Eigen::Lower>().rankUpdate(row);
    gradient += residual * row;
  }
};

Sums SumOver(const Problem& problem, const Unknowns& unknowns) {
  Sums sums;
  for (const WindowPixel& pixel : problem.window) {
    const CornerModel::Value value = problem.model.At(pixel.place, unknowns.head<kPlaceAndBlur>());
    Unknowns row;
    row << unknowns[kContrast] * value.d_parameters.transpose(), 1, value.brightness;
    sums.Add(unknowns[kDark] + unknowns[kContrast] * value.brightness - pixel.grey, row);
  }
  for (const Expectation& expectation : problem.expectations)
    sums.Add(expectation.weight * (unknowns[expectation.unknown] - expectation.value),
             expectation.weight * Unknowns::Unit(expectation.unknown));
  sums.matrix = NormalMatrix(sums.matrix.selfadjointView<Eigen::Lower>());
  return sums;
}

// A blur at its bound is held there.
void Hold(int unknown, NormalMatrix& matrix) {
  matrix.row(unknown).setZero();
  matrix.col(unknown).setZero();
  matrix(unknown, unknown) = 1;
}

bool IsAtBound(const Unknowns& unknowns) {
  return unknowns[kBlur] <= kLeastBlur_px || unknowns[kBlur] >= kLargestBlur_px;
}

// Dark and contrast that fit the window best with all else as it is.
Eigen::Vector2d LevelsOf(const Problem& problem, const Unknowns& unknowns) {
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (const WindowPixel& pixel : problem.window) {
    const Eigen::Vector2d row(1, problem.model.At(pixel.place, unknowns.head<kPlaceAndBlur>()).brightness);
    matrix += row * row.transpose();
    right += pixel.grey * row;
  }
  return matrix.ldlt().solve(right);
}

struct Minimum {
  bool has_converged = false;
  Unknowns unknowns;
  Sums sums;
};

Minimum Minimise(const Problem& problem, const Unknowns& start) {
  Minimum best{false, start, SumOver(problem, start)};
  double damping = 1e-3;
  for (int step = 0; step < kMaxSteps && !best.has_converged; ++step) {
    NormalMatrix damped = best.sums.matrix;
    damped.diagonal() *= 1 + damping;
    const Unknowns move = -damped.ldlt().solve(best.sums.gradient);
    if (!move.allFinite() || move.head<2>().norm() > kLargestRadius_px) break;
    Unknowns next = best.unknowns + move;
    next[kBlur] = std::clamp(next[kBlur], kLeastBlur_px, kLargestBlur_px);
    const Sums sums = SumOver(problem, next);
    best.has_converged = move.head<2>().norm() < kSteady_px;
    if (sums.squares <= best.sums.squares) {
      best.unknowns = next;
      best.sums = sums;
      damping /= 10;
    } else {
      damping *= 10;
    }
  }
  return best;
}

double DirectionOf(const Eigen::Vector2d& edge) { return std::atan2(edge.y(), edge.x()); }

CornerFit FitOf(const Minimum& minimum, const Problem& problem, const CornerExpectations& expected) {
  CornerFit fit;
  fit.pixel = minimum.unknowns.head<2>();
  fit.blur_px = minimum.unknowns[kBlur];
  fit.contrast = minimum.unknowns[kContrast];
  fit.pixels = static_cast<int>(problem.window.size());
  NormalMatrix matrix = minimum.sums.matrix;
  if (IsAtBound(minimum.unknowns)) Hold(kBlur, matrix);
  const double squares = minimum.sums.squares, freedoms = problem.Freedoms();
  fit.rms = std::sqrt(squares / freedoms);
  const double variance = (squares + expected.noise_freedoms * expected.noise * expected.noise) /
                          (freedoms + expected.noise_freedoms);
  fit.covariance_px2 = variance * matrix.inverse().topLeftCorner<2, 2>();
  return fit;
}

CornerStatus StatusOf(const CornerFit& fit, const CornerSite& site, bool has_converged) {
  const double nearest_px = Pitches_px(site).minCoeff();
  if (std::abs(fit.contrast) < kLeastContrast) return CornerStatus::kNoContrast;
  if (!has_converged || !((fit.pixel - site.pixel).norm() < 0.6 * nearest_px) ||
      !fit.covariance_px2.allFinite())
    return CornerStatus::kNotConverged;
  if (fit.rms > kLargestMisfit * std::abs(fit.contrast)) return CornerStatus::kUnlike;
  return CornerStatus::kFitted;
}

}  // namespace

CornerCells DarkWedge() {
  CornerCells cells = CornerCells::Ones();
  cells.bottomRightCorner<2, 2>().setZero();
  return cells;
}

CornerCells DarkSaddle() {
  CornerCells cells = DarkWedge();
  cells.topLeftCorner<2, 2>().setZero();
  return cells;
}

const char* ToString(CornerStatus status) {
  switch (status) {
    case CornerStatus::kFitted:
      return "fitted";
    case CornerStatus::kTooSmall:
      return "what is printed beside it is too near in the image";
    case CornerStatus::kOutsideImage:
      return "a part of what surrounds it is outside the image";
    case CornerStatus::kNoContrast:
      return "it has no contrast";
    case CornerStatus::kUnlike:
      return "the image there is not like the board";
    case CornerStatus::kNotConverged:
      return "the fit of its edges found no place near the expected one";
  }
  return "";
}

CornerModel::CornerModel(const CornerSite& site, double half_width_px) : constant_(site.cells(0, 0)) {
  const double sine = Pitches_px(site)[0] / site.edges_px[1].norm();
  const double l1 = site.edges_px[0].norm(), l2 = site.edges_px[1].norm();
  const auto is_seen = [&](double along_px) { return std::abs(along_px) * sine < half_width_px + kReach_px; };
  const CornerCells& cells = site.cells;
  // Cells before a line that is not seen are those behind it.
  CornerCells seen = cells;
  if (!is_seen(l1)) seen.col(0) = seen.col(1), seen.col(3) = seen.col(2);
  if (!is_seen(l2)) seen.row(0) = seen.row(1), seen.row(3) = seen.row(2);
  constant_ = seen(0, 0);
  for (int i = 0; i < 3; ++i) {
    const double step_1 = seen(0, i + 1) - seen(0, i), step_2 = seen(i + 1, 0) - seen(i, 0);
    if (step_1 != 0) across_1_.push_back({(i - 1) * l1, step_1});
    if (step_2 != 0) across_2_.push_back({(i - 1) * l2, step_2});
    for (int j = 0; j < 3; ++j) {
      const double weight = seen(j + 1, i + 1) - seen(j + 1, i) - seen(j, i + 1) + seen(j, i);
      if (weight != 0) quarters_.push_back({(i - 1) * l1, (j - 1) * l2, weight});
    }
  }
}

CornerModel::Value CornerModel::At(const Eigen::Vector2d& pixel, const Parameters& parameters) const {
  const Eigen::Vector2d e1(std::cos(parameters[kDirection1]), std::sin(parameters[kDirection1]));
  const Eigen::Vector2d e2(std::cos(parameters[kDirection2]), std::sin(parameters[kDirection2]));
  const double side = Cross(e1, e2) > 0 ? 1 : -1, sine = side * Cross(e1, e2), cosine = e1.dot(e2);
  // Normals of edges 1 and 2 towards the other edge.
  const Eigen::Vector2d n1 = side * Eigen::Vector2d(-e1.y(), e1.x()),
                        n2 = side * Eigen::Vector2d(e2.y(), -e2.x());
  const Eigen::Vector2d from_corner = pixel - parameters.head<2>();
  const double from_1 = n1.dot(from_corner), from_2 = n2.dot(from_corner), blur = parameters[kBlur];
  double value = constant_, by_1 = 0, by_2 = 0, by_sine = 0, by_rho = 0, by_blur = 0;
  const auto add_half = [&](const HalfPlane& half, double from, double& by_distance) {
    const double z = (from - half.along_px * sine) / blur, slope = half.weight * NormalDensity(z) / blur;
    value += half.weight * NormalDistribution(z);
    by_distance += slope;
    by_sine -= slope * half.along_px;
    by_blur -= slope * z;
  };
  for (const HalfPlane& half : across_1_) add_half(half, from_2, by_2);
  for (const HalfPlane& half : across_2_) add_half(half, from_1, by_1);
  for (const QuarterPlane& quarter : quarters_) {
    const double h = (from_2 - quarter.along_1_px * sine) / blur,
                 k = (from_1 - quarter.along_2_px * sine) / blur;
    value += quarter.weight * BivariateNormal(h, k, -cosine);
    const Eigen::Vector3d slope = quarter.weight * BivariateNormalGradient(h, k, -cosine);
    by_2 += slope[0] / blur;
    by_1 += slope[1] / blur;
    by_rho += slope[2];
    by_sine -= (slope[0] * quarter.along_1_px + slope[1] * quarter.along_2_px) / blur;
    by_blur -= (slope[0] * h + slope[1] * k) / blur;
  }
  // The sine and the correlation, -cosine, grow with direction 2 - direction 1 by these.
  const double by_angle = side * (by_sine * cosine + by_rho * sine);
  Value result{value, {}};
  result.d_parameters.head<2>() = -(by_1 * n1 + by_2 * n2).transpose();
  result.d_parameters[kDirection1] = -side * by_1 * e1.dot(from_corner) - by_angle;
  result.d_parameters[kDirection2] = side * by_2 * e2.dot(from_corner) + by_angle;
  result.d_parameters[kBlur] = by_blur;
  return result;
}

CornerFit FitCorner(const GrayImage& image, const CornerSite& site, const CornerExpectations& expected) {
  CornerFit fit;
  fit.pixel = site.pixel;
  fit.status = CornerStatus::kTooSmall;
  if (IsTooSmall(site)) return fit;
  Unknowns unknowns;
  unknowns << site.pixel, DirectionOf(site.edges_px[0]), DirectionOf(site.edges_px[1]), expected.blur_px, 0,
      0;
  Problem problem{CornerModel(site, HalfWidths_px(site).maxCoeff()), {}, ExpectationsOf(expected, unknowns)};
  for (int i = 0; i < kMaxWindows; ++i) {
    const Eigen::Vector2d middle = unknowns.head<2>();
    auto window = Window(image, site, middle);
    fit.status = CornerStatus::kOutsideImage;
    if (!window) return fit;
    problem.window = std::move(*window);
    if (i == 0) unknowns.tail<2>() = LevelsOf(problem, unknowns);
    const Minimum minimum = Minimise(problem, unknowns);
    unknowns = minimum.unknowns;
    fit = FitOf(minimum, problem, expected);
    fit.status = StatusOf(fit, site, minimum.has_converged);
    const bool is_in_middle = (unknowns.head<2>() - middle).norm() < kRecentred_px;
    if (is_in_middle || fit.status != CornerStatus::kFitted) break;
  }
  return fit;
}

}  // namespace legible
