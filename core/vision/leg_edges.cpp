#include "core/vision/leg_edges.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/vision/edge_band.h"
#include "core/vision/edge_curve.h"
#include "core/vision/edge_line.h"
#include "core/vision/edge_profile.h"
#include "core/vision/median.h"
#include "core/vision/rough_trace.h"

namespace legible {
namespace {

constexpr double kOutside_px = 6.5, kInside_px = 6;  // the fine band
// A little wider than the window of the fit, whose centre moves with the place.
constexpr BinGrid kGrid{kOutside_px + 1, kInside_px + 1, 0.25};
constexpr double kFineBins_px = 2.5;
constexpr double kLargestStretchSigma_px = 0.15;  // beyond, something else than shading disturbs the stretch
constexpr double kLargestRelativeSigma = 3;       // of a stretch, against the median stretch's
// What the fit of a stretch may leave, in noise variances a bin, and as a share of the contrast: both
// exceeded, something other than shading crosses the band.
constexpr double kLargestMisfit = 8, kLargestMisfitShare = 0.02;
constexpr double kLeastStretchContrast = 12;  // grey levels, of the same sign as the whole edge's
constexpr double kLeastGreyNoise = 0.5;       // quantisation alone leaves 0.3
// Shading that no model here follows, as a step in brightness beside the edge (grey levels): it moves the
// place by its share of the contrast.
constexpr double kStretchMisfit = 1.5, kEdgeMisfit = 1.0;
constexpr double kFirstBlur_px = 0.75, kLeastBlur_px = 0.3, kMostBlur_px = 4;
constexpr double kLongestBlurStep_px = 0.25, kSteadyBlur_px = 0.01;
constexpr double kSameBlur_px = 0.02;  // at which the same models fit
constexpr int kMostBlurSteps = 20, kMostModelRounds = 6;
// A curve this far off its edge at an end, by its two halves, is moved; not where the halves say it is
// absurdly far.
constexpr double kOffEdge_px = 0.25, kAbsurdlyOff_px = 2;
constexpr int kMostMoves = 3;
constexpr size_t kFewestSamples = 3;
constexpr double kRoughSigma_px = 0.3;  // of a whole edge whose place is a rough one
constexpr const char* kNoEdge = "no edge in the brightness across it";

// One edge on its way through the stages.
struct Work {
  Work(LegEdge& edge, const LegInCamera& of_leg, PredictedEdge prediction)
      : result(&edge), leg(&of_leg), predicted(std::move(prediction)) {}

  LegEdge* result;
  const LegInCamera* leg;
  PredictedEdge predicted;  // its points follow `normal`
  EdgeBand band;
  std::vector<std::pair<size_t, size_t>> stretches;  // of the band's cells: one sample each
  std::vector<BandBins> bins;                        // of each stretch
  BandBins whole;                                    // of all of them
  LevelShape shape;
  EdgeProfile profile;
  ProfileFitOptions fit_options;
  std::optional<ProfileFit> fit;
  std::vector<EdgeSample> rough;
  double rough_contrast = 0;

  bool Dropped() const { return !result->left_out.empty(); }
};

// ---- The fine stage: one profile of the whole edge, one blur of the whole image.

void CollectProfile(const GrayImage& image, const LegEdgeOptions& options, Work& work) {
  work.band = CollectBand(image, work.predicted.points, kGrid.outside_px, kGrid.inside_px);
  MeasureLevels(work.band);
  work.stretches = Stretches(work.band, options.sample_length_px, options.visibility.step_px);
  work.bins.clear();
  work.whole.assign(kGrid.size(), BandBin());
  for (const auto& [first, last] : work.stretches) {
    work.bins.push_back(BinBand(work.band, first, last, kGrid));
    Add(work.bins.back(), work.whole);
  }
}

// The profile of the whole edge, its levels flattened by the shape.
void FlattenBy(LevelShape shape, Work& work) {
  work.shape = std::move(shape);
  work.profile = FlatProfile(work.whole, work.shape, kGrid, kFineBins_px);
}

// Both keep the fit where there is none at the new blur, for blurs differ little; its misfit enlarges its
// sigma.
void FitAt(double blur_px, Work& work) {
  work.fit_options.blur_px = blur_px;
  if (auto fit = FitSimplestModel(work.profile, 0, work.fit_options)) work.fit = std::move(fit);
}

void RefitAt(double blur_px, Work& work) {
  work.fit_options.blur_px = blur_px;
  if (const auto fit = Refit(work.profile, *work.fit, work.fit_options)) work.fit = fit;
}

// The mean place of the stretches [first, last), and where along the leg that is.
struct PlaceOfPart {
  double share, place_px;
};
std::optional<PlaceOfPart> PlaceOf(size_t first, size_t last, const Work& work) {
  BandBins bins = work.bins[first];
  for (size_t i = first + 1; i < last; ++i) Add(work.bins[i], bins);
  const auto fit =
      FitStretch(FlatProfile(bins, work.shape, kGrid, kFineBins_px), *work.fit, work.fit_options);
  if (!fit) return std::nullopt;
  double share = 0, cells = 0;
  for (size_t cell = work.stretches[first].first; cell < work.stretches[last - 1].second; ++cell, ++cells)
    share += work.band.cells[cell].share;
  return PlaceOfPart{share / cells, fit->place_px};
}

// ---- Samples: the place of each stretch, from its own profile.

bool IsDisturbed(const EdgeProfile& profile, const ProfileFit& fit, double grey_noise) {
  if (fit.chi2_per_bin <= kLargestMisfit) return false;
  double pixels = 0;
  for (const ProfileBin& bin : profile) pixels += bin.count;
  const double pixels_a_bin = pixels / static_cast<double>(profile.size());
  const double left = grey_noise * std::sqrt((fit.chi2_per_bin - 1) / pixels_a_bin);
  return left > kLargestMisfitShare * std::abs(fit.contrast);
}

// One stretch's place, with coefficients of its own: shading changes along a leg.
void SampleStretch(size_t stretch, Work& work) {
  const auto [first, last] = work.stretches[stretch];
  const BandCell& cell = work.band.cells[(first + last) / 2];
  const EdgeProfile profile = FlatProfile(work.bins[stretch], work.shape, kGrid, kFineBins_px);
  ProfileFitOptions options = work.fit_options;
  options.half_width_px *= work.leg->AxisPoint(0.5).z() / work.leg->AxisPoint(cell.share).z();
  const auto fit = FitStretch(profile, *work.fit, options);
  if (!fit || fit->contrast * work.fit->contrast < kLeastStretchContrast * std::abs(work.fit->contrast))
    return;
  if (IsDisturbed(profile, *fit, options.grey_noise)) return;
  Eigen::Vector2d centre = cell.centre_px;
  if ((last - first) % 2 == 0)  // an even number of cells: their middle is the end of a cell
    centre = (centre + work.band.cells[(first + last) / 2 - 1].centre_px) / 2;
  const double sigma_px = std::hypot(fit->sigma_px, kStretchMisfit / fit->contrast);
  if (!(sigma_px <= kLargestStretchSigma_px)) return;
  work.result->observation.samples.push_back(
      {centre - fit->place_px * cell.normal_px, cell.normal_px, sigma_px});
}

// A stretch far less certain than the others is disturbed by something that no model here knows.
void DropDisturbedSamples(std::vector<EdgeSample>& samples) {
  if (samples.empty()) return;
  std::vector<double> sigmas;
  sigmas.reserve(samples.size());
  for (const EdgeSample& sample : samples) sigmas.push_back(sample.sigma_px);
  const double largest = kLargestRelativeSigma * MedianOf(std::move(sigmas));
  std::erase_if(samples, [&](const EdgeSample& sample) { return sample.sigma_px > largest; });
}

void Sample(Work& work) {
  work.result->observation = {work.result->leg, work.result->edge, {}, 0};
  for (size_t stretch = 0; stretch < work.stretches.size(); ++stretch) SampleStretch(stretch, work);
  DropDisturbedSamples(work.result->observation.samples);
  work.result->observation.common_sigma_px = std::hypot(work.fit->sigma_px, kEdgeMisfit / work.fit->contrast);
  work.result->contrast = work.fit->contrast;
}

void FitLine(const Camera& camera, Work& work) {
  EdgeLine line = FitEdgeLine(camera, work.predicted.normal, work.result->observation.samples);
  work.result->normal = line.normal;
  work.result->normal_covariance = line.normal_covariance;
  work.result->observation.samples = std::move(line.samples);
  work.result->rms_px = line.rms_px;
  // Shading that moves the stretches unlike each other moves their mean by as much.
  double& common_sigma_px = work.result->observation.common_sigma_px;
  common_sigma_px = std::hypot(common_sigma_px, line.rms_px);
}

void Judge(const LegEdgeOptions& options, Work& work) {
  LegEdge& edge = *work.result;
  if (std::abs(edge.contrast) < options.least_contrast)
    edge.left_out = fmt::format("contrast of only {:.0f} grey levels", std::abs(edge.contrast));
  else if (!(edge.observation.common_sigma_px <= options.largest_common_sigma_px))
    edge.left_out =
        fmt::format("its place is open by {:.2f} px: shading, or stretches that do not lie on one line",
                    edge.observation.common_sigma_px);
  else if (edge.observation.samples.size() < kFewestSamples)
    edge.left_out = "fewer than three stretches lie on one line";
}

class Measurement {
 public:
  Measurement(const GrayImage& image, const LegsInCamera& legs, const Camera& camera,
              const LegEdgeOptions& options)
      : image_(image), legs_(legs), camera_(camera), options_(options) {
    result_.edges.resize(2 * kLegCount);
    const PredictedEdges predicted = PredictEdges(legs, camera, options.visibility);
    for (int i = 0; i < 2 * kLegCount; ++i) {
      LegEdge& edge = result_.edges[static_cast<size_t>(i)];
      edge.leg = i / 2;
      edge.edge = i % 2;
      const auto leg = static_cast<size_t>(edge.leg), side = static_cast<size_t>(edge.edge);
      works_.emplace_back(edge, legs_[leg], predicted[leg][side]);
    }
    if (options.lock)
      Lock(predicted);
    else
      Shift();
    for (Work& work : works_) CheckLength(work);
  }

  LegEdges Run() {
    for (Work& work : works_)
      if (!work.Dropped()) Trace(work);
    if (options_.rough_only) return std::move(result_);
    for (Work& work : works_)
      if (!work.Dropped()) CollectProfile(image_, options_, work);
    result_.grey_noise = CommonGreyNoise();
    for (Work& work : works_) FitFirst(work);
    result_.blur_px = AnyLeft() ? FindBlur() : 0;
    for (Work& work : works_) {
      if (!work.Dropped()) Finish(work);
      if (work.Dropped() && work.rough.size() >= kFewestSamples) FallBack(work);
    }
    return std::move(result_);
  }

 private:
  void Lock(const PredictedEdges& predicted) {
    const auto locks = LockOnLegs(image_, predicted, *options_.lock);
    for (Work& work : works_) {
      const auto& lock = locks[static_cast<size_t>(work.result->leg)];
      if (!lock) {
        work.result->left_out = "no leg found near the prediction";
        continue;
      }
      // The lock's shift is towards edge 2: outward for that one, inward for edge 1.
      const double sign = work.result->edge == 1 ? 1 : -1;
      ShiftEnds(camera_, *work.leg, sign * lock->shift_at_a_px, sign * lock->shift_at_b_px, work.predicted);
    }
  }

  void Shift() {
    for (Work& work : works_) {
      const auto& shifts =
          options_.shifts[static_cast<size_t>(work.result->leg)][static_cast<size_t>(work.result->edge)];
      if (shifts && !work.predicted.points.empty())
        ShiftEnds(camera_, *work.leg, shifts->at_a_px, shifts->at_b_px, work.predicted);
    }
  }

  void Trace(Work& work) const {
    const auto trace = TraceRoughly(
        image_, work.predicted, {options_.search_px, options_.rough_bend_px, options_.visibility.step_px});
    if (!trace)
      work.result->left_out = "no straight edge near the prediction";
    else if (options_.rough_only)
      work.result->observation = {work.result->leg, work.result->edge, trace->samples, 0};
    else
      ShiftEnds(camera_, *work.leg, trace->at_a_px, trace->at_b_px, work.predicted);
    if (!trace || !options_.keeps_rough) return;
    work.rough = trace->samples;
    work.rough_contrast = trace->contrast;
  }

  void CheckLength(Work& work) const {
    if (work.Dropped()) return;
    if (work.predicted.points.empty())
      work.result->left_out = "not in front of the camera";
    else if (VisibleLength(work.predicted) < options_.least_length_px)
      work.result->left_out = MainObstacle(work.predicted);
    work.result->in_sight = !work.Dropped();
  }

  double CommonGreyNoise() const {
    std::vector<double> noises;
    for (const Work& work : works_) {
      const double noise = work.Dropped() ? 0 : GreyNoise(work.band);
      if (noise > 0) noises.push_back(noise);
    }
    if (noises.empty()) return kLeastGreyNoise;
    return std::max(MedianOf(std::move(noises)), kLeastGreyNoise);
  }

  // As if nothing were shaded, which finds the place from afar.
  void FitFirst(Work& work) const {
    if (work.Dropped()) return;
    work.fit_options.half_width_px = std::max(work.predicted.half_width_px, 2.0);
    work.fit_options.grey_noise = result_.grey_noise;
    work.fit_options.outside_px = kOutside_px;
    work.fit_options.inside_px = std::min(kInside_px, 0.6 * work.fit_options.half_width_px);
    FlattenBy(SoftStep(kGrid), work);
    work.fit_options.blur_px = options_.blur_px.value_or(kFirstBlur_px);
    work.fit = FitProfile(work.profile, ShadingModel::kFlat, 0, work.fit_options);
    if (!work.fit) work.fit = FitProfile(work.profile, ShadingModel::kAngular, 0, work.fit_options);
    if (!work.fit) work.result->left_out = kNoEdge;
  }

  // Each edge's model at the blur, its levels flattened as that has them.
  void ChooseModels(double blur) {
    ForEachFit([&](Work& work) {
      FitAt(blur, work);
      FlattenBy(ShapeOf(*work.fit, work.fit_options, kGrid), work);
    });
  }

  // A band that lies askew to its edge looks blurred, and its shading is not that of the distance from the
  // edge. Lays it along the line through the places of its two halves; true where that took a move.
  bool LayAlongEdge(const LegEdgeOptions& options, Work& work) const {
    const size_t middle = work.stretches.size() / 2;
    if (middle == 0) return false;
    const auto a = PlaceOf(0, middle, work), b = PlaceOf(middle, work.stretches.size(), work);
    if (!a || !b) return false;
    const double slope_px = (b->place_px - a->place_px) / (b->share - a->share);
    const auto at = [&](double share) { return a->place_px + slope_px * (share - a->share); };
    const double off_px =
        std::max(std::abs(at(work.band.cells.front().share)), std::abs(at(work.band.cells.back().share)));
    if (off_px < kOffEdge_px || off_px > kAbsurdlyOff_px) return false;
    ShiftEnds(camera_, *work.leg, -at(0), -at(1), work.predicted);
    CollectProfile(image_, options, work);
    FlattenBy(work.shape, work);
    work.fit->place_px = 0;
    return true;
  }

  template <typename F>
  void ForEachFit(F refit) {
    for (Work& work : works_)
      if (!work.Dropped()) refit(work);
  }

  void Recentre(double blur) {
    ForEachFit([&](Work& work) {
      for (int move = 0; move < kMostMoves && LayAlongEdge(options_, work); ++move) FitAt(blur, work);
      FlattenBy(ShapeOf(*work.fit, work.fit_options, kGrid), work);
    });
  }

  // The blur, one for all edges, at which they fit best with the models that they have: Gauss-Newton in which
  // each edge's place and coefficients follow the blur. Leaves the fits there.
  double SettleBlur(double blur) {
    for (int round = 0; round < kMostBlurSteps; ++round) {
      BlurEvidence all;
      ForEachFit([&](Work& work) {
        const BlurEvidence evidence = EvidenceOnBlur(work.profile, *work.fit, work.fit_options);
        all.information += evidence.information;
        all.moment += evidence.moment;
      });
      if (!(all.information > 0)) return blur;
      const double step = std::clamp(all.moment / all.information, -kLongestBlurStep_px, kLongestBlurStep_px);
      const double before = blur;
      blur = std::clamp(blur + step, kLeastBlur_px, kMostBlur_px);
      ForEachFit([&](Work& work) { RefitAt(blur, work); });
      if (std::abs(blur - before) < kSteadyBlur_px) break;
    }
    return blur;
  }

  // In turn with the edges' models, for at a wrong blur a plain edge looks shaded; as if all were plain to
  // begin with, for a shaded edge's model would follow a wrong blur.
  double FindBlur() {
    if (options_.blur_px) {
      ChooseModels(*options_.blur_px);
      Recentre(*options_.blur_px);
      ForEachFit([&](Work& work) { RefitAt(*options_.blur_px, work); });
      return *options_.blur_px;
    }
    double blur = SettleBlur(kFirstBlur_px);
    for (int round = 0; round < kMostModelRounds; ++round) {
      ChooseModels(blur);
      if (round == 0) Recentre(blur);
      const double before = blur;
      blur = SettleBlur(blur);
      if (std::abs(blur - before) < kSameBlur_px) break;
    }
    return blur;
  }

  bool AnyLeft() const {
    return std::any_of(works_.begin(), works_.end(), [](const Work& work) { return !work.Dropped(); });
  }

  void Finish(Work& work) const {
    Sample(work);
    FitLine(camera_, work);
    Judge(options_, work);
  }

  void FallBack(Work& work) const {
    LegEdge& edge = *work.result;
    const EdgeLine line = FitEdgeLine(camera_, work.predicted.normal, work.rough);
    if (line.samples.size() < kFewestSamples) return;
    edge.left_out.clear();
    edge.is_rough = true;
    edge.contrast = work.rough_contrast;
    edge.normal = line.normal;
    edge.normal_covariance = line.normal_covariance;
    edge.observation = {edge.leg, edge.edge, line.samples, kRoughSigma_px};
    edge.rms_px = line.rms_px;
  }

  const GrayImage& image_;
  const LegsInCamera& legs_;
  const Camera& camera_;
  const LegEdgeOptions& options_;
  LegEdges result_;
  std::vector<Work> works_;
};

}  // namespace

void LegEdgeOptions::Check() const {
  if (!(search_px > 0) || !(least_length_px > 0) || !(sample_length_px > 0) || !(visibility.step_px > 0))
    throw std::invalid_argument("LegEdgeOptions: lengths must be positive");
  if (!(rough_bend_px >= 0))
    throw std::invalid_argument("LegEdgeOptions: rough_bend_px must not be negative");
  if (blur_px && !(*blur_px > 0)) throw std::invalid_argument("LegEdgeOptions: blur_px must be positive");
  if (lock) lock->Check();
}

LegEdges MeasureLegEdges(const GrayImage& image, const LegsInCamera& legs, const Camera& camera,
                         const LegEdgeOptions& options) {
  options.Check();
  return Measurement(image, legs, camera, options).Run();
}

ImageObservation ToObservation(const std::string& name, const std::optional<Vector6d>& joint_readings_m,
                               const LegEdges& edges) {
  ImageObservation observation{name, joint_readings_m, {}};
  for (const LegEdge& edge : edges.edges)
    if (edge.left_out.empty()) observation.edges.push_back(edge.observation);
  return observation;
}

}  // namespace legible
