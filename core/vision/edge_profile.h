// Where the edge of a lit cylinder lies in the brightness profile across it.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/vision/shading_basis.h"

namespace legible {

// Mean brightness of the pixels at a signed distance from a line near the edge; `inside_px` grows into the
// leg.
struct ProfileBin {
  double inside_px = 0;   // mean distance of the bin's pixels
  double brightness = 0;  // their mean, grey levels
  double count = 0;       // of pixels; 0: empty
};
using EdgeProfile = std::vector<ProfileBin>;

struct ProfileFit {
  ShadingModel model = ShadingModel::kFlat;
  double place_px = 0;      // x0
  double sigma_px = 0;      // of x0: grey noise through the model, enlarged where the model does not fit
  double contrast = 0;      // inside minus outside at the edge, grey levels
  double chi2_per_bin = 0;  // of the residuals, against the grey noise
  double squares = 0;       // weighted sum of squared residuals and priors, in noise variances
  Eigen::VectorXd coefficients;
};

struct ProfileFitOptions {
  double blur_px = 0.7;       // Gaussian, of the image (the pixels' own extent is added)
  double half_width_px = 12;  // w
  double grey_noise = 2;      // standard deviation of a pixel
  double outside_px = 8;      // window
  double inside_px = 6;
};

// Fits one model from a start, by Gauss-Newton on the place with the linear coefficients solved for. The
// background's slope and kinks are held near zero, and light from everywhere near 25 grey levels, by priors
// of the size that lit scenes show. Nothing where the profile does not cover the edge or the place runs out
// of the window.
std::optional<ProfileFit> FitProfile(const EdgeProfile& profile, ShadingModel model, double start_px,
                                     const ProfileFitOptions& options);

// Fits the profile of a stretch of an edge, from the fit of the whole edge: the shading's coefficients are
// expected near the whole's, levels are free. Where the profile speaks clearly against that (a shadow's
// border runs slantwise along the leg) the coefficients may differ more, and the place is that much less
// certain.
std::optional<ProfileFit> FitStretch(const EdgeProfile& profile, const ProfileFit& whole,
                                     const ProfileFitOptions& options);

// The fit's own model once more, from where it stands, at the options' blur.
std::optional<ProfileFit> Refit(const EdgeProfile& profile, const ProfileFit& fit,
                                const ProfileFitOptions& options);

// What a profile says of the blur once place and coefficients follow it: the squares fall by moment^2 /
// information (in noise variances, or in those that the misfit shows where it is larger) with a step of
// moment / information px.
struct BlurEvidence {
  double information = 0, moment = 0;
};
BlurEvidence EvidenceOnBlur(const EdgeProfile& profile, const ProfileFit& fit,
                            const ProfileFitOptions& options);

// The simplest model that explains the profile: flat first, then the others from there; a richer model must
// lower the squares (relative to the richest's misfit) by more than the Bayesian information criterion asks
// for its coefficients.
std::optional<ProfileFit> FitSimplestModel(const EdgeProfile& profile, double start_px,
                                           const ProfileFitOptions& options);

// What of the brightness that a fit predicts is the background's and what the leg's, grey levels: their sum
// is the profile.
struct BrightnessParts {
  double background;
  double leg;
};
// At distances inside_px from the line that the fit's profile was taken along.
std::vector<BrightnessParts> PredictParts(const ProfileFit& fit, const std::vector<double>& inside_px,
                                          const ProfileFitOptions& options);

}  // namespace legible
