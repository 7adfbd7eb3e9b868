#include "core/vision/edge_profile.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/vision/blurred_powers.h"

namespace legible {
namespace {

constexpr int kMaxColumns = 16;
constexpr int kMaxSteps = 12;
constexpr double kLongestStep_px = 0.5;
constexpr double kSteady_px = 1e-4;
constexpr double kOutsideSlope = 0.3;    // grey levels per px: prior of the background's slope
constexpr double kFirstKink_rad = 0.55;  // surface angle
constexpr double kKinkStep_rad = 0.1;
constexpr double kKink = 28.6;  // grey levels per rad: prior of a kink in brightness over surface angle
// By which the squares must fall for a stretch to count as shaded in its own way.
constexpr double kEvidenceOfChange = 25;
constexpr double kCoefficientsOfKinks = 2.5;  // that a kinked profile counts for beyond the angular one's
constexpr double kPixelVariance = 1.0 / 12;   // of a pixel's own extent
constexpr double kStrictness = 2;             // times the BIC's price of a coefficient

using Columns = Eigen::Matrix<double, kMaxColumns, 1>;

// The model's linear part at one distance: basis functions and their slopes.
class Basis {
 public:
  Basis(ShadingModel model, const ProfileFitOptions& options)
      : model_(model),
        s_(std::sqrt(options.blur_px * options.blur_px + kPixelVariance)),
        w_(options.half_width_px) {
    size_ = model == ShadingModel::kFlat ? 2 : 4;
    if (model != ShadingModel::kKinked) return;
    for (double psi = kFirstKink_rad; size_ < kMaxColumns; psi += kKinkStep_rad) {
      const double x = w_ * (1 - std::cos(psi));
      if (x > options.inside_px + 1.5) break;
      kinks_.push_back({x, 1 / (w_ * std::sin(psi))});
      ++size_;
    }
  }

  int size() const { return size_; }

  void Evaluate(double x, Columns& value, Columns& slope) const {
    const double z = x / s_;
    const BlurredPower step = BlurredStep(z);
    value[0] = 1 - step.value;
    slope[0] = -step.derivative / s_;
    if (model_ == ShadingModel::kFlat) {
      value[1] = step.value;
      slope[1] = -slope[0];
      return;
    }
    const BlurredPower ramp = BlurredRamp(z);
    value[1] = x - s_ * ramp.value;  // x for x < 0, blurred
    slope[1] = 1 - ramp.derivative;
    value[2] = step.value;
    slope[2] = -slope[0];
    EvaluateAngle(z, value[3], slope[3]);
    for (size_t k = 0; k < kinks_.size(); ++k) {
      const BlurredPower kink = BlurredRamp((x - kinks_[k].place_px) / s_);
      value[static_cast<Eigen::Index>(4 + k)] = s_ * kink.value * kinks_[k].rad_per_px;
      slope[static_cast<Eigen::Index>(4 + k)] = kink.derivative * kinks_[k].rad_per_px;
    }
  }

 private:
  // psi = acos(1 - x/w) = sqrt(2 x/w) (1 + x/(12 w) + 3 x^2/(160 w^2) + …), blurred term by term.
  void EvaluateAngle(double z, double& value, double& slope) const {
    const double ratio = s_ / w_;
    const double factor = std::sqrt(2 * ratio);
    const BlurredPower a = BlurredHalfPower(HalfPower::kOneHalf, z);
    const BlurredPower b = BlurredHalfPower(HalfPower::kThreeHalves, z);
    const BlurredPower c = BlurredHalfPower(HalfPower::kFiveHalves, z);
    const double of_b = ratio / 12, of_c = 3 * ratio * ratio / 160;
    value = factor * (a.value + of_b * b.value + of_c * c.value);
    slope = factor / s_ * (a.derivative + of_b * b.derivative + of_c * c.derivative);
  }

  struct Kink {
    double place_px;    // inside the edge
    double rad_per_px;  // of the surface angle there: coefficients are in grey levels per rad
  };

  ShadingModel model_;
  double s_, w_;
  int size_;
  std::vector<Kink> kinks_;
};

// What the coefficients are expected to be.
struct CoefficientPrior {
  Eigen::VectorXd mean;
  Eigen::VectorXd inverse_sigma;  // 0: free
};

// Background slope and kinks about zero, levels and the line in psi free.
CoefficientPrior PriorOf(const Basis& basis) {
  CoefficientPrior prior{Eigen::VectorXd::Zero(basis.size()), Eigen::VectorXd::Zero(basis.size())};
  if (basis.size() < 4) return prior;
  prior.inverse_sigma[1] = 1 / kOutsideSlope;
  prior.inverse_sigma.tail(basis.size() - 4).setConstant(1 / kKink);
  return prior;
}

// How far a stretch's shading may be from the whole edge's, grey levels per rad: of the line in psi, of each
// kink.
struct StretchScatter {
  double angle;
  double kink;
};
constexpr StretchScatter kAlikeAlongLeg{3, 1};
constexpr StretchScatter kChangingAlongLeg{20, 20};

// About the coefficients of the whole edge; levels free.
CoefficientPrior PriorAbout(const ProfileFit& whole, const StretchScatter& scatter, const Basis& basis) {
  CoefficientPrior prior = PriorOf(basis);
  if (basis.size() < 4) return prior;
  const Eigen::Index common = std::min<Eigen::Index>(basis.size(), whole.coefficients.size());
  prior.mean.head(common) = whole.coefficients.head(common);
  prior.inverse_sigma[3] = 1 / scatter.angle;
  prior.inverse_sigma.tail(basis.size() - 4).setConstant(1 / scatter.kink);
  return prior;
}

// Normal equations of the coefficients and the place together.
struct NormalEquations {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right;
  double data_squares = 0;  // of the residuals at the given coefficients
  double prior_squares = 0;
  int bins = 0;
};

NormalEquations Accumulate(const EdgeProfile& profile, const Basis& basis, const CoefficientPrior& prior,
                           const Eigen::VectorXd& coefficients, double place,
                           const ProfileFitOptions& options) {
  const int n = basis.size();
  Eigen::Matrix<double, kMaxColumns + 1, kMaxColumns + 1> matrix =
      Eigen::Matrix<double, kMaxColumns + 1, kMaxColumns + 1>::Zero();
  Eigen::Matrix<double, kMaxColumns + 1, 1> right = Eigen::Matrix<double, kMaxColumns + 1, 1>::Zero();
  NormalEquations equations;
  const double inverse_variance = 1 / (options.grey_noise * options.grey_noise);
  Columns value = Columns::Zero(), slope = Columns::Zero();
  Eigen::Matrix<double, kMaxColumns + 1, 1> row;
  for (const ProfileBin& bin : profile) {
    const double x = bin.inside_px - place;
    if (bin.count == 0 || x < -options.outside_px || x > options.inside_px) continue;
    basis.Evaluate(x, value, slope);
    row.head(n) = value.head(n);
    row[n] = -slope.head(n).dot(coefficients);
    const double weight = bin.count * inverse_variance;
    const double residual = bin.brightness - value.head(n).dot(coefficients);
    equations.data_squares += weight * residual * residual;
    matrix.topLeftCorner(n + 1, n + 1).selfadjointView<Eigen::Lower>().rankUpdate(row.head(n + 1), weight);
    right.head(n + 1) += weight * residual * row.head(n + 1);
    ++equations.bins;
  }
  for (int i = 0; i < n; ++i) {
    const double information = prior.inverse_sigma[i] * prior.inverse_sigma[i];
    const double off = coefficients[i] - prior.mean[i];
    matrix(i, i) += information;
    right[i] -= information * off;
    equations.prior_squares += information * off * off;
  }
  equations.matrix = matrix.topLeftCorner(n + 1, n + 1).selfadjointView<Eigen::Lower>();
  equations.right = right.head(n + 1);
  return equations;
}

// Coefficients at a fixed place.
Eigen::VectorXd SolveCoefficients(const NormalEquations& equations) {
  const Eigen::Index n = equations.right.size() - 1;
  return equations.matrix.topLeftCorner(n, n).ldlt().solve(equations.right.head(n));
}

ProfileFit Summarise(const NormalEquations& equations, ShadingModel model, double place,
                     const Eigen::VectorXd& coefficients) {
  ProfileFit fit;
  fit.model = model;
  fit.place_px = place;
  fit.coefficients = coefficients;
  fit.contrast =
      model == ShadingModel::kFlat ? coefficients[1] - coefficients[0] : coefficients[2] - coefficients[0];
  fit.squares = equations.data_squares + equations.prior_squares;
  const double freedom = equations.bins - (model == ShadingModel::kFlat ? 3.0 : 5.0);
  fit.chi2_per_bin = freedom > 0 ? equations.data_squares / freedom : 0;
  const Eigen::Index last = equations.right.size() - 1;
  const Eigen::VectorXd unit = Eigen::VectorXd::Unit(last + 1, last);
  const double variance = equations.matrix.ldlt().solve(unit)[last];
  fit.sigma_px = std::sqrt(variance * std::max(fit.chi2_per_bin, 1.0));
  return fit;
}

// Gauss-Newton on place and coefficients together, from a start of the place.
std::optional<ProfileFit> Fit(const EdgeProfile& profile, ShadingModel model, const Basis& basis,
                              const CoefficientPrior& prior, double start_px,
                              const ProfileFitOptions& options) {
  const auto accumulate = [&](const Eigen::VectorXd& coefficients, double place) {
    return Accumulate(profile, basis, prior, coefficients, place, options);
  };
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(basis.size());
  double place = start_px;
  NormalEquations equations = accumulate(zero, place);
  if (equations.bins < basis.size() + 4) return std::nullopt;
  Eigen::VectorXd coefficients = SolveCoefficients(equations);
  for (int step = 0; step < kMaxSteps; ++step) {
    equations = accumulate(coefficients, place);
    const Eigen::VectorXd change = equations.matrix.ldlt().solve(equations.right);
    if (!change.allFinite()) return std::nullopt;
    const double wanted = change[basis.size()];
    const double moved = std::clamp(wanted, -kLongestStep_px, kLongestStep_px);
    place += moved;
    if (std::abs(place - start_px) > options.inside_px / 2) return std::nullopt;
    if (moved == wanted)
      coefficients += change.head(basis.size());
    else
      coefficients = SolveCoefficients(accumulate(zero, place));
    if (std::abs(moved) < kSteady_px)
      return Summarise(accumulate(coefficients, place), model, place, coefficients);
  }
  return std::nullopt;
}

double PriceOf(ShadingModel model) {
  switch (model) {
    case ShadingModel::kFlat:
      return 2;
    case ShadingModel::kAngular:
      return 4;
    case ShadingModel::kKinked:
      return 4 + kCoefficientsOfKinks;
  }
  return 0;
}

}  // namespace

std::optional<ProfileFit> FitProfile(const EdgeProfile& profile, ShadingModel model, double start_px,
                                     const ProfileFitOptions& options) {
  const Basis basis(model, options);
  return Fit(profile, model, basis, PriorOf(basis), start_px, options);
}

std::optional<ProfileFit> FitStretch(const EdgeProfile& profile, const ProfileFit& whole,
                                     const ProfileFitOptions& options) {
  const Basis basis(whole.model, options);
  const auto fit = [&](const StretchScatter& scatter) {
    return Fit(profile, whole.model, basis, PriorAbout(whole, scatter, basis), whole.place_px, options);
  };
  const auto alike = fit(kAlikeAlongLeg);
  const auto changing = fit(kChangingAlongLeg);
  if (!alike || !changing) return alike ? alike : changing;
  const double evidence = (alike->squares - changing->squares) / std::max(changing->chi2_per_bin, 1.0);
  return evidence > kEvidenceOfChange ? changing : alike;
}

std::optional<ProfileFit> FitSimplestModel(const EdgeProfile& profile, double start_px,
                                           const ProfileFitOptions& options) {
  const auto flat = FitProfile(profile, ShadingModel::kFlat, start_px, options);
  const double start = flat ? flat->place_px : start_px;
  const auto angular = FitProfile(profile, ShadingModel::kAngular, start, options);
  const auto kinked = FitProfile(profile, ShadingModel::kKinked, start, options);
  const double misfit = std::max(kinked ? kinked->chi2_per_bin : 1.0, 1.0);
  const double price = kStrictness * std::log(static_cast<double>(std::max<size_t>(profile.size(), 2)));
  const std::optional<ProfileFit>* best = nullptr;
  double best_score = 0;
  for (const std::optional<ProfileFit>* fit : {&flat, &angular, &kinked}) {
    if (!*fit) continue;
    const double score = (*fit)->squares / misfit + price * PriceOf((*fit)->model);
    if (best != nullptr && score >= best_score) continue;
    best = fit;
    best_score = score;
  }
  return best != nullptr ? *best : std::nullopt;
}

PredictedBrightness Predict(const ProfileFit& fit, double inside_px, const ProfileFitOptions& options) {
  const Basis basis(fit.model, options);
  Columns value = Columns::Zero(), slope = Columns::Zero();
  basis.Evaluate(inside_px - fit.place_px, value, slope);
  const Eigen::Index n = basis.size();
  return {value.head(n).dot(fit.coefficients), slope.head(n).dot(fit.coefficients)};
}

}  // namespace legible
