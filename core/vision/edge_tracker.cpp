#include "core/vision/edge_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace legible {
namespace {

constexpr int kFirstIterations = 12, kFirstLooks = 3;
const LegLockOptions kSecondLock = {.range_px = 12, .roll_range_rad = 0.02, .scale_range = 0.02};
constexpr size_t kFewestEdges = 6;  // from which the legs' own errors are judged
// No legs are known better than this, whatever a few images say.
constexpr double kLeastLeg_m = 3e-4;
constexpr double kLegMemory = 0.95;  // of an image, for the next

// An error that is the same along the whole edge: its line shifted outward, as a covariance of the normal.
Eigen::Matrix3d CovarianceOfShift(const Camera& camera, const Eigen::Vector3d& normal, double sigma_px) {
  const double focal_px = (camera.fx_px + camera.fy_px) / 2;
  Eigen::Vector3d change(0, 0, -normal.head<2>().norm() / focal_px);
  change -= normal * normal.dot(change);
  return sigma_px * sigma_px * change * change.transpose();
}

bool IsMeasured(const LegEdge& edge) { return edge.left_out.empty(); }

SeenEdges MeasuredOf(const Camera& camera, const LegEdges& edges) {
  SeenEdges seen;
  for (const LegEdge& edge : edges.edges)
    if (IsMeasured(edge)) seen.edges.push_back(ToSeenEdge(camera, edge));
  return seen;
}

// Leaves out what is farther than gate_m from the view's outlines.
void DropBeyond(const ModelledView& view, double gate_m, LegEdges& edges) {
  for (LegEdge& edge : edges.edges) {
    if (!IsMeasured(edge)) continue;
    const auto off = OffOf(view, ToSeenEdge(view.camera, edge));
    if (off && off->Largest_m() <= gate_m) continue;
    edge.left_out =
        off ? fmt::format("found {:.1f} mm from where the other edges say that it is", 1e3 * off->Largest_m())
            : "not in front of the camera";
  }
}

size_t CountMeasured(const LegEdges& edges) {
  return static_cast<size_t>(std::count_if(edges.edges.begin(), edges.edges.end(), IsMeasured));
}
size_t CountInSight(const LegEdges& edges) {
  return static_cast<size_t>(std::count_if(edges.edges.begin(), edges.edges.end(),
                                           [](const LegEdge& edge) { return edge.in_sight; }));
}

}  // namespace

LegEdgeOptions EdgesToTrack() {
  LegEdgeOptions options;
  options.keeps_rough = true;
  options.least_length_px = 30;
  options.least_contrast = 8;
  options.largest_common_sigma_px = 0.4;
  options.sample_length_px = 20;
  return options;
}

void EdgeTrackerOptions::Check() const {
  first_look.Check();
  if (!(search_px > 0) || !(gate_px > 0) || !(rough_gate_px > 0) || !(leg_m > 0) || !(leg_gate_sigmas > 0) ||
      !(forget_s > 0))
    throw std::invalid_argument("EdgeTrackerOptions: lengths, times and gates must be positive");
}

EdgeTracker::EdgeTracker(const GoughStewart& robot, const Camera& camera, const Rigid3& camera_from_base,
                         const EdgeTrackerOptions& options)
    : robot_(robot), camera_(camera), camera_from_base_(camera_from_base), options_(options) {
  options.Check();
}

TrackedEdges EdgeTracker::Track(const GrayImage& image, double time_s,
                                const Rigid3& predicted_base_from_platform) {
  if (image.width != camera_.width_px || image.height != camera_.height_px)
    throw std::invalid_argument(fmt::format("EdgeTracker: an image of {} x {} px for a camera of {} x {} px",
                                            image.width, image.height, camera_.width_px, camera_.height_px));
  const ModelledView model = ModelAt(predicted_base_from_platform);
  if (!correction_) return Keep(model, time_s, LookFirst(image, model));
  const ModelledView expected = Corrected(model.base_from_platform);
  LegEdges edges = LookAgain(image, expected, time_s);
  DropOpposite(edges);
  DropJumps(expected, time_s, edges);
  Correct(model, edges);
  return Keep(model, time_s, edges);
}

ModelledView EdgeTracker::ModelAt(const Rigid3& base_from_platform) const {
  return {robot_, camera_, camera_from_base_, base_from_platform};
}

ModelledView EdgeTracker::Corrected(const Rigid3& base_from_platform) const {
  ModelledView view = ModelAt(base_from_platform);
  if (!correction_) return view;
  view.camera_from_base = Displaced(view.camera_from_base, correction_->camera);
  view.base_from_platform = Displaced(view.base_from_platform, correction_->platform);
  return view;
}

bool EdgeTracker::IsFresh(size_t leg, size_t edge, double time_s) const {
  const auto& place = places_[leg][edge];
  return place && time_s - place->time_s <= options_.forget_s;
}

// Locks on to the legs, then looks at the edges where those that agree say that all are.
LegEdges EdgeTracker::LookFirst(const GrayImage& image, const ModelledView& model) {
  LegEdgeOptions look = options_.first_look;
  CorrectionOptions correction{options_.model_errors, std::nullopt, options_.leg_m, kFirstIterations};
  ModelledView view = model;
  LegEdges edges = MeasureLegEdges(image, PlaceLegs(model), camera_, look);
  polarity_ = 0;
  DropOpposite(edges);
  const double gate_m = options_.leg_gate_sigmas * options_.leg_m;
  for (int again = 1; again < kFirstLooks; ++again) {
    view = CorrectViewByMost(model, MeasuredOf(camera_, edges), correction);
    // Once more near there: a leg that was taken for another is found now.
    look.lock = again == 1 ? std::optional(kSecondLock) : std::nullopt;
    edges = MeasureLegEdges(image, PlaceLegs(view), camera_, look);
    DropOpposite(edges);
  }
  view = CorrectViewByMost(model, MeasuredOf(camera_, edges), correction);
  DropBeyond(view, gate_m, edges);
  const size_t agreeing = CountMeasured(edges);
  if (agreeing < options_.least_first_edges ||
      static_cast<double>(agreeing) < options_.least_first_share * static_cast<double>(CountInSight(edges))) {
    for (LegEdge& edge : edges.edges)
      if (IsMeasured(edge)) edge.left_out = "too few edges agree with one place of the robot";
    return edges;
  }
  correction_ = Correction{Displacement(model.camera_from_base, view.camera_from_base),
                           Displacement(model.base_from_platform, view.base_from_platform), options_.leg_m};
  if (edges.blur_px > 0) blur_px_ = edges.blur_px;  // it does not change from image to image
  return edges;
}

LegEdges EdgeTracker::LookAgain(const GrayImage& image, const ModelledView& view, double time_s) const {
  LegEdgeOptions look = options_.first_look;
  look.lock.reset();
  look.search_px = options_.search_px;
  look.blur_px = blur_px_;
  for (size_t leg = 0; leg < kLegCount; ++leg)
    for (size_t edge = 0; edge < 2; ++edge)
      if (IsFresh(leg, edge, time_s)) {
        const OffModel& off = places_[leg][edge]->off;
        look.shifts[leg][edge] = EndShifts{off.OffAt_px(0), off.OffAt_px(1)};
      }
  return MeasureLegEdges(image, PlaceLegs(view), camera_, look);
}

// An edge from bright to dark where the others lead from dark to bright: the far side of the leg, a shadow.
void EdgeTracker::DropOpposite(LegEdges& edges) {
  if (polarity_ == 0) {
    double sum = 0;
    for (const LegEdge& edge : edges.edges)
      if (IsMeasured(edge)) sum += edge.contrast;
    polarity_ = sum < 0 ? -1 : 1;
  }
  for (LegEdge& edge : edges.edges)
    if (IsMeasured(edge) && edge.contrast * polarity_ < 0)
      edge.left_out = "brightness changes the other way than at the other edges";
}

// What is farther from where it was than anything moves from one image to the next.
void EdgeTracker::DropJumps(const ModelledView& view, double time_s, LegEdges& edges) const {
  for (LegEdge& edge : edges.edges) {
    const auto leg = static_cast<size_t>(edge.leg), side = static_cast<size_t>(edge.edge);
    if (!IsMeasured(edge) || !IsFresh(leg, side, time_s)) continue;
    const auto off = OffOf(view, ToSeenEdge(camera_, edge));
    if (!off) continue;
    double jump_px = 0;
    for (const OffModel::End& end : off->ends)
      jump_px = std::max(jump_px, std::abs(end.off_px - places_[leg][side]->off.OffAt_px(end.share)));
    if (jump_px > (edge.is_rough ? options_.rough_gate_px : options_.gate_px))
      edge.left_out = fmt::format("found {:.1f} px from where it is expected", jump_px);
  }
}

// Leaves out what disagrees with the others.
void EdgeTracker::Correct(const ModelledView& model, LegEdges& edges) {
  const ModelledView view =
      CorrectView(model, Corrected(model.base_from_platform), MeasuredOf(camera_, edges),
                  {options_.model_errors, options_.drift, correction_->leg_m, 2});
  correction_->camera = Displacement(model.camera_from_base, view.camera_from_base);
  correction_->platform = Displacement(model.base_from_platform, view.base_from_platform);
  DropBeyond(view, options_.leg_gate_sigmas * correction_->leg_m, edges);
}

TrackedEdges EdgeTracker::Keep(const ModelledView& model, double time_s, const LegEdges& edges) {
  TrackedEdges tracked;
  tracked.seen.time_s = time_s;
  tracked.blur_px = edges.blur_px;
  const ModelledView view = Corrected(model.base_from_platform);
  double squares = 0;
  for (const LegEdge& edge : edges.edges) {
    const auto leg = static_cast<size_t>(edge.leg), side = static_cast<size_t>(edge.edge);
    tracked.missing[leg][side] = edge.left_out;
    if (!IsMeasured(edge)) continue;
    const SeenEdge seen = ToSeenEdge(camera_, edge);
    if (const auto off = OffOf(view, seen)) {
      places_[leg][side] = Place{*off, time_s};
      squares += off->ends[0].off_m * off->ends[0].off_m + off->ends[1].off_m * off->ends[1].off_m;
    }
    tracked.is_rough[leg][side] = edge.is_rough;
    tracked.seen.edges.push_back(seen);
  }
  if (tracked.seen.edges.size() >= kFewestEdges) {
    const double leg_m = std::sqrt(squares / (2 * static_cast<double>(tracked.seen.edges.size())));
    correction_->leg_m =
        std::clamp(kLegMemory * correction_->leg_m + (1 - kLegMemory) * leg_m, kLeastLeg_m, options_.leg_m);
  }
  return tracked;
}

SeenEdge ToSeenEdge(const Camera& camera, const LegEdge& edge) {
  SeenEdge seen;
  seen.leg = edge.leg;
  seen.edge = edge.edge;
  seen.normal = edge.normal;
  seen.normal_covariance =
      edge.normal_covariance + CovarianceOfShift(camera, edge.normal, edge.observation.common_sigma_px);
  const auto& samples = edge.observation.samples;
  const auto first = Unproject(camera, samples.front().point_px),
             last = Unproject(camera, samples.back().point_px);
  if (first && last) seen.ends = {*first, *last};
  return seen;
}

}  // namespace legible
