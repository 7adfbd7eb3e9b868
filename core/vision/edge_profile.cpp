#include "core/vision/edge_profile.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace legible {
namespace {

constexpr int kMaxSteps = 12;
constexpr double kLongestStep_px = 0.5;
constexpr double kFarthestFlat_px =
    1;                               // from the start, for the other models to begin at the flat one's place
constexpr double kSteady_px = 3e-3;  // the step after it would be a tenth of that
constexpr double kOutsideSlope = 0.3;  // grey levels per px: prior of the background's slope
constexpr double kKink = 28.6;  // grey levels per rad: prior of a kink in brightness over surface angle
// By which the squares must fall for a stretch to count as shaded in its own way.
constexpr double kEvidenceOfChange = 25;
constexpr double kCoefficientsOfKinks = 2.5;  // that a kinked profile counts for beyond the angular one's
constexpr double kAmbientLevel = 25, kAmbientScatter = 5;  // grey levels: prior of the light from everywhere
constexpr double kDarkest = -10;   // grey levels: a leg darker than nothing at its edge is a wrong fit
constexpr double kHeld = 100;      // inverse sigma of what keeps its expected value
constexpr double kStrictness = 2;  // times the BIC's price of a coefficient

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
    columns_.resize(static_cast<Eigen::Index>(profile.size()), 2 * basis.size() + kOtherColumns);
    weighed_.reserve(profile.size());
    for (const ProfileBin& bin : profile)
      if (bin.count > 0)
        weighed_.push_back({bin.inside_px, bin.brightness, std::sqrt(bin.count) / options.grey_noise});
  }

  void MoveTo(double place_px) {
    const int n = basis_.size();
    const Eigen::Index rows = columns_.rows();
    double* const first = columns_.data();
    double* row = first;
    Columns value, slope;
    for (const Weighed& bin : weighed_) {
      const double x = bin.inside_px - place_px;
      if (x < -options_.outside_px || x > options_.inside_px) continue;
      basis_.Evaluate(x, value, slope);
      double* column = row;
      for (int i = 0; i < n; ++i, column += rows) *column = bin.weight * value[i];
      for (int i = 0; i < n; ++i, column += rows) *column = bin.weight * slope[i];
      column[kBrightness * rows] = bin.weight * bin.brightness;
      column[kWeight * rows] = bin.weight;
      column[kPlace * rows] = x;
      ++row;
    }
    bins_ = static_cast<int>(row - first);
    matrix_.setZero(n + 1, n + 1);
    const auto values = Values();
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= i; ++j) matrix_(i, j) = values.col(i).dot(values.col(j));
  }

  int bins() const { return bins_; }

  Coefficients BestCoefficients(const CoefficientPrior& prior) {
    const Eigen::Index n = basis_.size();
    const Coefficients information = prior.inverse_sigma.cwiseAbs2();
    NormalMatrix matrix = matrix_.topLeftCorner(n, n);
    matrix.diagonal() += information;
    const Coefficients right =
        Values().transpose() * Column(kBrightness) + information.cwiseProduct(prior.mean);
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

  Step StepFrom(const Coefficients& coefficients, const CoefficientPrior& prior) {
    const Eigen::Index n = basis_.size();
    const Equations equations = EquationsAt(coefficients, prior);
    auto residual = Column(kResidual);
    Step step;
    step.change = equations.factor.solve(equations.right);
    residual.noalias() -= Values() * step.change.head(n);
    residual -= Column(kByPlace) * step.change[n];
    step.data_squares = residual.squaredNorm();
    step.squares =
        step.data_squares +
        prior.inverse_sigma.cwiseProduct(coefficients - prior.mean + step.change.head(n)).squaredNorm();
    step.place_variance = equations.factor.solve(Unknowns::Unit(n + 1, n))[n];
    return step;
  }

  BlurEvidence OnBlur(const Coefficients& coefficients, const CoefficientPrior& prior) {
    const Eigen::Index n = basis_.size();
    const Equations equations = EquationsAt(coefficients, prior);
    Eigen::VectorXd by_blur(bins_);
    for (int i = 0; i < bins_; ++i)
      by_blur[i] = Column(kWeight)[i] * basis_.SlopeByBlur(Column(kPlace)[i], coefficients);
    Unknowns cross(n + 1);
    for (Eigen::Index i = 0; i < n; ++i) cross[i] = Values().col(i).dot(by_blur);
    cross[n] = Column(kByPlace).dot(by_blur);
    const Unknowns followed = equations.factor.solve(cross);
    return {by_blur.squaredNorm() - cross.dot(followed),
            by_blur.dot(Column(kResidual)) - followed.dot(equations.right)};
  }

 private:
  // Of the bins within the window: the functions, their slopes, and then these.
  enum OtherColumn { kBrightness, kWeight, kPlace, kResidual, kByPlace, kOtherColumns };
  Eigen::Block<Eigen::MatrixXd> Values() { return columns_.topLeftCorner(bins_, basis_.size()); }
  Eigen::Block<Eigen::MatrixXd> Slopes() { return columns_.block(0, basis_.size(), bins_, basis_.size()); }
  auto Column(OtherColumn column) -> Eigen::VectorBlock<Eigen::MatrixXd::ColXpr> {
    return columns_.col(2 * basis_.size() + column).head(bins_);
  }

  // Normal equations of coefficients and place; leaves kResidual and kByPlace at the coefficients.
  struct Equations {
    Eigen::LDLT<NormalMatrix> factor;
    Unknowns right;
  };
  Equations EquationsAt(const Coefficients& coefficients, const CoefficientPrior& prior) {
    const Eigen::Index n = basis_.size();
    const auto values = Values();
    auto residual = Column(kResidual), by_place = Column(kByPlace);
    residual = Column(kBrightness);
    residual.noalias() -= values * coefficients;
    by_place.noalias() = Slopes() * -coefficients;
    const Coefficients information = prior.inverse_sigma.cwiseAbs2();
    NormalMatrix matrix = matrix_;
    matrix.diagonal().head(n) += information;
    for (Eigen::Index i = 0; i < n; ++i) matrix(n, i) = by_place.dot(values.col(i));
    matrix(n, n) = by_place.squaredNorm();
    Unknowns right(n + 1);
    for (Eigen::Index i = 0; i < n; ++i) right[i] = values.col(i).dot(residual);
    right.head(n) -= information.cwiseProduct(coefficients - prior.mean);
    right[n] = by_place.dot(residual);
    return {Eigen::LDLT<NormalMatrix>(matrix), right};
  }

  struct Weighed {
    double inside_px, brightness, weight;
  };

  const ShadingBasis& basis_;
  const ProfileFitOptions& options_;
  std::vector<Weighed> weighed_;
  Eigen::MatrixXd columns_;
  int bins_ = 0;
  NormalMatrix matrix_;  // of the coefficients: lower triangle
};

// Of the leg at its edge, grey levels.
double LegLevel(ShadingModel model, const Coefficients& coefficients) {
  return coefficients[model == ShadingModel::kFlat ? 1 : ShadingBasis::kLevel];
}

ProfileFit Summarise(const Linearisation::Step& step, int bins, ShadingModel model, double place_px,
                     const Coefficients& coefficients) {
  const bool flat = model == ShadingModel::kFlat;
  ProfileFit fit;
  fit.model = model;
  fit.place_px = place_px;
  fit.coefficients = coefficients;
  fit.contrast = LegLevel(model, coefficients) - coefficients[0];
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
    if (std::abs(moved) < kSteady_px) {
      if (LegLevel(model, *coefficients) < kDarkest) return std::nullopt;
      return Summarise(step, at.bins(), model, place, *coefficients);
    }
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

std::optional<ProfileFit> Refit(const EdgeProfile& profile, const ProfileFit& fit,
                                const ProfileFitOptions& options) {
  const ShadingBasis basis = BasisOf(fit.model, options);
  Linearisation at(profile, basis, options);
  return Fit(at, fit.model, PriorOf(basis), {fit.place_px, Resized(fit.coefficients, basis.size())}, options);
}

BlurEvidence EvidenceOnBlur(const EdgeProfile& profile, const ProfileFit& fit,
                            const ProfileFitOptions& options) {
  const ShadingBasis basis = BasisOf(fit.model, options);
  Linearisation at(profile, basis, options);
  at.MoveTo(fit.place_px);
  const BlurEvidence evidence = at.OnBlur(Resized(fit.coefficients, basis.size()), PriorOf(basis));
  const double misfit = std::max(fit.chi2_per_bin, 1.0);
  return {evidence.information / misfit, evidence.moment / misfit};
}

std::optional<ProfileFit> FitSimplestModel(const EdgeProfile& profile, double start_px,
                                           const ProfileFitOptions& options) {
  const auto flat = FitProfile(profile, ShadingModel::kFlat, start_px, options);
  // A shaded leg can draw the flat model's step far inside, where it grows bright.
  const bool is_near = flat && std::abs(flat->place_px - start_px) < kFarthestFlat_px;
  const double start = is_near ? flat->place_px : start_px;
  const auto angular = FitProfile(profile, ShadingModel::kAngular, start, options);
  const double price = kStrictness * std::log(static_cast<double>(std::max<size_t>(profile.size(), 2)));
  const auto simpler = [&](double misfit) {
    const auto score = [&](const std::optional<ProfileFit>& fit) {
      return fit ? fit->squares / misfit + price * PriceOf(fit->model) : HUGE_VAL;
    };
    return score(flat) <= score(angular) ? std::pair(flat, score(flat)) : std::pair(angular, score(angular));
  };
  const auto [plain, of_plain] = simpler(1);
  // Where noise alone leaves as much, give or take its own scatter, kinks have nothing to explain.
  const auto bins =
      static_cast<double>(std::count_if(profile.begin(), profile.end(), [&](const ProfileBin& bin) {
        return bin.inside_px - start >= -options.outside_px && bin.inside_px - start <= options.inside_px;
      }));
  if (plain && plain->squares < bins + std::sqrt(2 * bins)) return plain;
  auto kinked = FitProfile(profile, ShadingModel::kKinked, start, options);
  if (!kinked && is_near) kinked = FitProfile(profile, ShadingModel::kKinked, start_px, options);
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
