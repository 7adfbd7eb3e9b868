#include "core/vision/edge_profile.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace legible {
namespace {

constexpr int kMaxSteps = 12;
constexpr double kLongestStep_px = 0.5;
constexpr double kSteady_px = 1e-3;    // the step after it would be a tenth of that
constexpr double kOutsideSlope = 0.3;  // grey levels per px: prior of the background's slope
constexpr double kKink = 28.6;  // grey levels per rad: prior of a kink in brightness over surface angle
// By which the squares must fall for a stretch to count as shaded in its own way.
constexpr double kEvidenceOfChange = 25;
constexpr double kCoefficientsOfKinks = 2.5;  // that a kinked profile counts for beyond the angular one's
constexpr double kAmbientLevel = 25, kAmbientScatter = 5;  // grey levels: prior of the light from everywhere
constexpr double kHeld = 100;                              // inverse sigma of what keeps its expected value
constexpr double kStrictness = 2;                          // times the BIC's price of a coefficient

using Columns = ShadingBasis::Columns;
constexpr int kMaxColumns = ShadingBasis::kMaxColumns;
using Coefficients = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxColumns, 1>;
// The coefficients, then the place.
using Unknowns = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxColumns + 1, 1>;
using NormalMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxColumns + 1, kMaxColumns + 1>;

ShadingBasis BasisOf(ShadingModel model, const ProfileFitOptions& options) {
  return {model, options.blur_px, options.half_width_px, options.inside_px};
}

// What the coefficients are expected to be.
struct CoefficientPrior {
  Coefficients mean;
  Coefficients inverse_sigma;  // 0: free
};

// Background slope and kinks about zero, levels and the line in psi free.
CoefficientPrior PriorOf(const ShadingBasis& basis) {
  CoefficientPrior prior{Coefficients::Zero(basis.size()), Coefficients::Zero(basis.size())};
  if (basis.size() < ShadingBasis::kFirstKink) return prior;
  prior.inverse_sigma[ShadingBasis::kOutside] = 1 / kOutsideSlope;
  prior.mean[ShadingBasis::kAmbient] = kAmbientLevel;
  prior.inverse_sigma[ShadingBasis::kAmbient] = 1 / kAmbientScatter;
  prior.inverse_sigma.tail(basis.size() - ShadingBasis::kFirstKink).setConstant(1 / kKink);
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

// A nearer stretch shows fewer kinks within the window, a farther one more.
Coefficients Resized(const Eigen::VectorXd& coefficients, Eigen::Index size) {
  Coefficients resized = Coefficients::Zero(size);
  const Eigen::Index common = std::min(size, coefficients.size());
  resized.head(common) = coefficients.head(common);
  return resized;
}

// About the coefficients of the whole edge; levels free.
CoefficientPrior PriorAbout(const ProfileFit& whole, const StretchScatter& scatter,
                            const ShadingBasis& basis) {
  CoefficientPrior prior = PriorOf(basis);
  if (basis.size() < ShadingBasis::kFirstKink) return prior;
  prior.mean = Resized(whole.coefficients, basis.size());
  prior.inverse_sigma[ShadingBasis::kAngle] = 1 / scatter.angle;
  prior.inverse_sigma[ShadingBasis::kAmbient] = kHeld;
  prior.inverse_sigma.tail(basis.size() - ShadingBasis::kFirstKink).setConstant(1 / scatter.kink);
  return prior;
}

// A profile's residuals about a place and coefficients, with their derivatives, each divided by its standard
// deviation. Places, coefficients and priors come apart: the basis functions are evaluated once a place.
class Linearisation {
 public:
  Linearisation(const EdgeProfile& profile, const ShadingBasis& basis, const ProfileFitOptions& options)
      : basis_(basis), options_(options) {
    const auto bins = static_cast<Eigen::Index>(profile.size());
    values_.resize(bins, basis.size());
    slopes_.resize(bins, basis.size());
    brightness_.resize(bins);
    for (const ProfileBin& bin : profile)
      if (bin.count > 0)
        weighed_.push_back({bin.inside_px, bin.brightness, std::sqrt(bin.count) / options.grey_noise});
  }

  void MoveTo(double place_px) {
    const int n = basis_.size();
    bins_ = 0;
    Columns value, slope;
    for (const Weighed& bin : weighed_) {
      const double x = bin.inside_px - place_px;
      if (x < -options_.outside_px || x > options_.inside_px) continue;
      basis_.Evaluate(x, value, slope);
      values_.row(bins_) = bin.weight * value.head(n).transpose();
      slopes_.row(bins_) = bin.weight * slope.head(n).transpose();
      brightness_[bins_] = bin.weight * bin.brightness;
      ++bins_;
    }
    matrix_.setZero(n + 1, n + 1);
    const auto values = values_.topRows(bins_);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= i; ++j) matrix_(i, j) = values.col(i).dot(values.col(j));
  }

  int bins() const { return bins_; }

  Coefficients BestCoefficients(const CoefficientPrior& prior) const {
    const Eigen::Index n = basis_.size();
    const Coefficients information = prior.inverse_sigma.cwiseAbs2();
    NormalMatrix matrix = matrix_.topLeftCorner(n, n);
    matrix.diagonal() += information;
    const Coefficients right =
        values_.topRows(bins_).transpose() * brightness_.head(bins_) + information.cwiseProduct(prior.mean);
    return Eigen::LDLT<NormalMatrix>(matrix).solve(right);
  }

  // The step from the coefficients to the least squares, as the linearisation sees it, and what is left
  // there.
  struct Step {
    Unknowns change;      // coefficients, place
    double data_squares;  // of the residuals, in noise variances
    double squares;       // and of the prior
    double place_variance;
  };

  Step StepFrom(const Coefficients& coefficients, const CoefficientPrior& prior) const {
    const Eigen::Index n = basis_.size();
    const auto values = values_.topRows(bins_);
    const Eigen::VectorXd residual = brightness_.head(bins_) - values * coefficients;
    const Eigen::VectorXd by_place = -slopes_.topRows(bins_) * coefficients;
    const Coefficients information = prior.inverse_sigma.cwiseAbs2();
    const Coefficients off = coefficients - prior.mean;
    NormalMatrix matrix = matrix_;
    matrix.diagonal().head(n) += information;
    for (Eigen::Index i = 0; i < n; ++i) matrix(n, i) = by_place.dot(values.col(i));
    matrix(n, n) = by_place.squaredNorm();
    Unknowns right(n + 1);
    right.head(n) = values.transpose() * residual - information.cwiseProduct(off);
    right[n] = by_place.dot(residual);
    const Eigen::LDLT<NormalMatrix> factor(matrix);
    Step step;
    step.change = factor.solve(right);
    step.data_squares = (residual - values * step.change.head(n) - by_place * step.change[n]).squaredNorm();
    step.squares =
        step.data_squares + prior.inverse_sigma.cwiseProduct(off + step.change.head(n)).squaredNorm();
    step.place_variance = factor.solve(Unknowns::Unit(n + 1, n))[n];
    return step;
  }

 private:
  struct Weighed {
    double inside_px, brightness, weight;
  };

  const ShadingBasis& basis_;
  const ProfileFitOptions& options_;
  std::vector<Weighed> weighed_;
  Eigen::MatrixXd values_, slopes_;
  Eigen::VectorXd brightness_;
  int bins_ = 0;
  NormalMatrix matrix_;  // of the coefficients: lower triangle
};

ProfileFit Summarise(const Linearisation::Step& step, int bins, ShadingModel model, double place_px,
                     const Coefficients& coefficients) {
  const bool flat = model == ShadingModel::kFlat;
  ProfileFit fit;
  fit.model = model;
  fit.place_px = place_px;
  fit.coefficients = coefficients;
  fit.contrast = coefficients[flat ? 1 : ShadingBasis::kLevel] - coefficients[0];
  fit.squares = step.squares;
  const double freedom = bins - (flat ? 3.0 : 5.0);
  fit.chi2_per_bin = freedom > 0 ? step.data_squares / freedom : 0;
  fit.sigma_px = std::sqrt(step.place_variance * std::max(fit.chi2_per_bin, 1.0));
  return fit;
}

// Where a fit begins: at a place, with coefficients or without.
struct FitStart {
  double place_px;
  std::optional<Coefficients> coefficients;
};

// Gauss-Newton on place and coefficients together; leaves `at` at the last place but one step.
std::optional<ProfileFit> Fit(Linearisation& at, ShadingModel model, const CoefficientPrior& prior,
                              const FitStart& start, const ProfileFitOptions& options) {
  const Eigen::Index n = prior.mean.size();
  double place = start.place_px;
  std::optional<Coefficients> coefficients = start.coefficients;
  for (int round = 0; round < kMaxSteps; ++round) {
    at.MoveTo(place);
    if (at.bins() < n + 4) return std::nullopt;
    if (!coefficients) coefficients = at.BestCoefficients(prior);
    const Linearisation::Step step = at.StepFrom(*coefficients, prior);
    if (!step.change.allFinite() || !(step.place_variance > 0)) return std::nullopt;
    const double moved = std::clamp(step.change[n], -kLongestStep_px, kLongestStep_px);
    place += moved;
    if (std::abs(place - start.place_px) > options.inside_px / 2) return std::nullopt;
    if (moved != step.change[n]) {
      coefficients.reset();
      continue;
    }
    *coefficients += step.change.head(n);
    if (std::abs(moved) < kSteady_px) return Summarise(step, at.bins(), model, place, *coefficients);
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
  const ShadingBasis basis = BasisOf(model, options);
  Linearisation at(profile, basis, options);
  return Fit(at, model, PriorOf(basis), {start_px, std::nullopt}, options);
}

std::optional<ProfileFit> FitStretch(const EdgeProfile& profile, const ProfileFit& whole,
                                     const ProfileFitOptions& options) {
  const ShadingBasis basis = BasisOf(whole.model, options);
  Linearisation at(profile, basis, options);
  const auto fit = [&](const StretchScatter& scatter, const ProfileFit& start) {
    const CoefficientPrior prior = PriorAbout(whole, scatter, basis);
    return Fit(at, whole.model, prior, {start.place_px, Resized(start.coefficients, basis.size())}, options);
  };
  auto alike = fit(kAlikeAlongLeg, whole);
  if (!alike) return fit(kChangingAlongLeg, whole);
  if (whole.model == ShadingModel::kFlat) return alike;
  const Linearisation::Step changed =
      at.StepFrom(alike->coefficients, PriorAbout(whole, kChangingAlongLeg, basis));
  const double misfit = std::max(changed.data_squares / std::max(at.bins() - 5, 1), 1.0);
  if ((alike->squares - changed.squares) / misfit <= kEvidenceOfChange) return alike;
  const auto changing = fit(kChangingAlongLeg, *alike);
  return changing ? changing : alike;
}

double SquaresAtBlur(const EdgeProfile& profile, const ProfileFit& fit, const ProfileFitOptions& options) {
  const ShadingBasis basis = BasisOf(fit.model, options);
  Linearisation at(profile, basis, options);
  at.MoveTo(fit.place_px);
  return at.StepFrom(Resized(fit.coefficients, basis.size()), PriorOf(basis)).squares;
}

std::optional<ProfileFit> FitSimplestModel(const EdgeProfile& profile, double start_px,
                                           const ProfileFitOptions& options) {
  const auto flat = FitProfile(profile, ShadingModel::kFlat, start_px, options);
  const double start = flat ? flat->place_px : start_px;
  const auto angular = FitProfile(profile, ShadingModel::kAngular, start, options);
  const double price = kStrictness * std::log(static_cast<double>(std::max<size_t>(profile.size(), 2)));
  const auto simpler = [&](double misfit) {
    const auto score = [&](const std::optional<ProfileFit>& fit) {
      return fit ? fit->squares / misfit + price * PriceOf(fit->model) : HUGE_VAL;
    };
    return score(flat) <= score(angular) ? std::pair(flat, score(flat)) : std::pair(angular, score(angular));
  };
  const auto [plain, of_plain] = simpler(1);
  // Where noise alone leaves as much, kinks have nothing to explain.
  if (plain && plain->squares < static_cast<double>(profile.size())) return plain;
  const auto kinked = FitProfile(profile, ShadingModel::kKinked, start, options);
  if (!kinked) return plain;
  const double misfit = std::max(kinked->chi2_per_bin, 1.0);
  const auto [best, of_best] = simpler(misfit);
  return kinked->squares / misfit + price * PriceOf(kinked->model) < of_best ? kinked : best;
}

std::vector<BrightnessParts> PredictParts(const ProfileFit& fit, const std::vector<double>& inside_px,
                                          const ProfileFitOptions& options) {
  const ShadingBasis basis = BasisOf(fit.model, options);
  const Eigen::Index outer = fit.model == ShadingModel::kFlat ? 1 : ShadingBasis::kLevel,
                     inner = basis.size() - outer;
  std::vector<BrightnessParts> parts;
  parts.reserve(inside_px.size());
  Columns value = Columns::Zero(), slope = Columns::Zero();
  for (const double x : inside_px) {
    basis.Evaluate(x - fit.place_px, value, slope);
    parts.push_back({value.head(outer).dot(fit.coefficients.head(outer)),
                     value.segment(outer, inner).dot(fit.coefficients.tail(inner))});
  }
  return parts;
}

}  // namespace legible
