#include "core/vision/rough_trace.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/vision/edge_band.h"

namespace legible {
namespace {

constexpr double kBin_px = 0.5, kStretch_px = 18;
constexpr double kTolerance_px = 0.9;  // of a stretch from the curve through the others
constexpr double kBendStep_px = 3;
constexpr int kFewestPlaces = 3;
constexpr double kLeastShare = 0.4;  // of the stretches that lie on the curve

struct RoughPlace {
  double share = 0;
  Eigen::Vector2d centre_px, normal_px;  // of the predicted curve there
  double outward_px = 0;
  double step = 0;    // grey levels over two bins, signed: positive where the leg is brighter
  double weight = 0;  // its square root
};

// Grey levels by which the two bins from i on are brighter than the two before, nothing beside an empty bin.
std::optional<double> StepBefore(const BandBins& bins, size_t i) {
  const auto mean = [&](size_t at) { return bins[at].MeanBrightness(); };
  for (size_t at = i - 2; at < i + 2; ++at)
    if (bins[at].count == 0) return std::nullopt;
  return (mean(i) + mean(i + 1) - mean(i - 1) - mean(i - 2)) / 2;
}

// The strongest step, between bins by the parabola through its neighbours.
std::optional<RoughPlace> StrongestStep(const BandBins& bins, const BinGrid& grid, const BandCell& middle) {
  RoughPlace best{middle.share, middle.centre_px, middle.normal_px, 0, 0, 0};
  std::vector<double> steps(bins.size(), 0);
  size_t at = 0;
  for (size_t i = 2; i + 2 < bins.size(); ++i) {
    steps[i] = StepBefore(bins, i).value_or(0);
    if (std::abs(steps[i]) > std::abs(steps[at])) at = i;
  }
  if (at == 0) return std::nullopt;
  best.step = steps[at];
  best.weight = std::sqrt(std::abs(best.step));
  const double before = std::abs(steps[at - 1]), after = std::abs(steps[at + 1]), peak = std::abs(best.step);
  const double curvature = 2 * peak - before - after;
  const double between = curvature > 0 ? std::clamp((after - before) / (2 * curvature), -0.5, 0.5) : 0;
  best.outward_px = -(grid.Middle(at) + (between - 0.5) * grid.width_px);
  return best;
}

// outward_px = at_a + slope * share + bend * share * (share - 1): the prediction's error along the leg.
struct RoughCurve {
  double at_a_px = 0, slope_px = 0, bend_px = 0;
  double polarity = 0;
  double support = 0;  // sum over the agreeing stretches of their step's square root
  int count = 0;

  double At(double share) const { return at_a_px + slope_px * share + bend_px * share * (share - 1); }
  bool Agrees(const RoughPlace& place) const {
    return place.step * polarity > 0 && std::abs(place.outward_px - At(place.share)) <= kTolerance_px;
  }
};

RoughCurve CurveThrough(const RoughPlace& a, const RoughPlace& b, double bend_px) {
  const auto straight = [&](const RoughPlace& p) { return p.outward_px - bend_px * p.share * (p.share - 1); };
  const double slope = (straight(b) - straight(a)) / (b.share - a.share);
  return {straight(a) - slope * a.share, slope, bend_px, a.step, 0, 0};
}

// The curve through two of the places, with a bend up to largest_bend_px, on which most of the contrast of
// one sign lies.
RoughCurve Consensus(const std::vector<RoughPlace>& places, double largest_bend_px) {
  RoughCurve best;
  for (size_t i = 0; i < places.size(); ++i)
    for (size_t j = i + 1; j < places.size(); ++j) {
      const RoughPlace &a = places[i], &b = places[j];
      if (b.share - a.share < 0.1 || a.step * b.step < 0) continue;
      for (double bend = -largest_bend_px; bend <= largest_bend_px; bend += kBendStep_px) {
        RoughCurve curve = CurveThrough(a, b, bend);
        for (const RoughPlace& place : places) {
          if (!curve.Agrees(place)) continue;
          curve.support += place.weight;
          ++curve.count;
        }
        if (curve.support > best.support) best = curve;
        if (best.count == static_cast<int>(places.size())) return best;
      }
    }
  return best;
}

// The curve of the same bend that lies closest to the places that agree with it, a strong step counting for
// more.
RoughCurve Settled(RoughCurve curve, const std::vector<RoughPlace>& places) {
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  for (const RoughPlace& place : places) {
    if (!curve.Agrees(place)) continue;
    const Eigen::Vector2d row(1, place.share);
    information += std::abs(place.step) * row * row.transpose();
    moment += std::abs(place.step) * row * (place.outward_px - curve.At(place.share));
  }
  const Eigen::Vector2d change = information.inverse() * moment;
  curve.at_a_px += change[0];
  curve.slope_px += change[1];
  return curve;
}

}  // namespace

std::optional<RoughTrace> TraceRoughly(const GrayImage& image, const PredictedEdge& edge,
                                       const RoughTraceOptions& options) {
  const double reach = options.search_px + 2;
  const EdgeBand band = CollectBand(image, edge.points, reach, reach);
  const BinGrid grid{reach, reach, kBin_px};
  std::vector<RoughPlace> places;
  for (const auto& [first, last] : Stretches(band, kStretch_px, options.step_px)) {
    const BandBins bins = BinBand(band, first, last, grid);
    if (const auto place = StrongestStep(bins, grid, band.cells[(first + last) / 2]))
      places.push_back(*place);
  }
  const RoughCurve curve = Consensus(places, options.bend_px);
  if (curve.count < kFewestPlaces || curve.count < kLeastShare * static_cast<double>(places.size()))
    return std::nullopt;
  const RoughCurve settled = Settled(curve, places);
  RoughTrace trace{settled.At(0), settled.At(1), {}};
  for (const RoughPlace& place : places)
    if (curve.Agrees(place))
      trace.samples.push_back(
          {place.centre_px + place.outward_px * place.normal_px, place.normal_px, kTolerance_px / 2});
  return trace;
}

}  // namespace legible
