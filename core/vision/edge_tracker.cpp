#include "core/vision/edge_tracker.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace legible {
namespace {

// What moves all edges alike in the image: a camera that is elsewhere than the model has it. Displacement of
// the image point p: move + turn_and_scale * (p - middle).
class CommonMotion {
 public:
  explicit CommonMotion(const Camera& camera) : middle_px_(camera.width_px / 2.0, camera.height_px / 2.0) {}

  void Add(const ImagePointOnEdge& end, double shift_px) {
    const Eigen::RowVector4d row = RowAt(end);
    information_ += row.transpose() * row;
    moment_ += row.transpose() * shift_px;
  }

  // Outward at that point.
  double ShiftAt(const ImagePointOnEdge& end) const {
    return RowAt(end).dot(information_.ldlt().solve(moment_));
  }

 private:
  Eigen::RowVector4d RowAt(const ImagePointOnEdge& end) const {
    const Eigen::Vector2d arm = (end.point_px - middle_px_) / middle_px_.norm();
    return {end.normal_px.x(), end.normal_px.y(), end.normal_px.dot(arm),
            end.normal_px.dot(Eigen::Vector2d(-arm.y(), arm.x()))};
  }

  Eigen::Vector2d middle_px_;
  // Nothing is known without edges: no motion then.
  Eigen::Matrix4d information_ = 1e-3 * Eigen::Matrix4d::Identity();
  Eigen::Vector4d moment_ = Eigen::Vector4d::Zero();
};

using Normals = std::array<Eigen::Vector3d, 2>;

// The model's normals of both edges of a leg; nothing where it has none.
std::optional<Normals> ModelNormals(const LegInCamera& leg) {
  const auto axis = LineThrough<double>(leg.a_in_camera, leg.b_in_camera);
  if (!CameraIsOutside(axis, leg.radius_m)) return std::nullopt;
  return CylinderOutline(axis, leg.radius_m);
}

// Where an edge with that normal passes its leg's two joints as the model has them; nothing where it has no
// image.
using EdgeEndsInImage = std::array<ImagePointOnEdge, 2>;
std::optional<EdgeEndsInImage> EndsInImage(const Camera& camera, const LegInCamera& leg,
                                           const Eigen::Vector3d& model_normal,
                                           const Eigen::Vector3d& normal) {
  const Eigen::Vector3d aside = leg.radius_m * model_normal;
  const auto a = EdgePointNear(camera, normal, leg.a_in_camera + aside);
  const auto b = EdgePointNear(camera, normal, leg.b_in_camera + aside);
  if (!a || !b) return std::nullopt;
  return EdgeEndsInImage{*a, *b};
}

std::optional<EndShifts> ShiftsBetween(const Camera& camera, const LegInCamera& leg,
                                       const Eigen::Vector3d& model_normal, const Eigen::Vector3d& normal) {
  const auto model = EndsInImage(camera, leg, model_normal, model_normal);
  const auto found = EndsInImage(camera, leg, model_normal, normal);
  if (!model || !found) return std::nullopt;
  const auto shift_px = [&](size_t end) {
    return (*model)[end].normal_px.dot((*found)[end].point_px - (*model)[end].point_px);
  };
  return EndShifts{shift_px(0), shift_px(1)};
}

// The larger of both ends' differences.
double LargestDifference(const EndShifts& a, const EndShifts& b) {
  return std::max(std::abs(a.at_a_px - b.at_a_px), std::abs(a.at_b_px - b.at_b_px));
}

// An error that is the same along the whole edge: its line shifted outward, as a covariance of the normal.
Eigen::Matrix3d CovarianceOfShift(const Camera& camera, const Eigen::Vector3d& normal, double sigma_px) {
  const double focal_px = (camera.fx_px + camera.fy_px) / 2;
  Eigen::Vector3d change(0, 0, -normal.head<2>().norm() / focal_px);
  change -= normal * normal.dot(change);
  return sigma_px * sigma_px * change * change.transpose();
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
  if (!(search_px > 0) || !(gate_px > 0) || !(width_gate_px > 0) || !(forget_s > 0))
    throw std::invalid_argument("EdgeTrackerOptions: lengths and times must be positive");
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
  const LegsInCamera legs = PlaceLegs(robot_, camera_from_base_, predicted_base_from_platform);
  LegEdges edges = Look(image, legs, ExpectedShifts(legs, time_s));
  const EdgeShifts found = ShiftsOf(legs, edges);
  DropJumps(found, time_s, edges);
  DropWrongWidths(found, edges);
  TrackedEdges tracked;
  tracked.seen.time_s = time_s;
  tracked.blur_px = edges.blur_px;
  for (const LegEdge& edge : edges.edges) {
    const auto leg = static_cast<size_t>(edge.leg), side = static_cast<size_t>(edge.edge);
    tracked.missing[leg][side] = edge.left_out;
    if (!edge.left_out.empty()) continue;
    places_[leg][side] = Place{*found[leg][side], time_s};
    tracked.seen.edges.push_back(ToSeenEdge(camera_, edge));
  }
  return tracked;
}

bool EdgeTracker::HasSeenAny() const {
  return std::any_of(places_.begin(), places_.end(), [](const auto& leg) { return leg[0] || leg[1]; });
}

bool EdgeTracker::IsFresh(size_t leg, size_t edge, double time_s) const {
  const auto& place = places_[leg][edge];
  return place && time_s - place->time_s <= options_.forget_s;
}

// Each edge's own last place while that is fresh, else where the fresh ones say that all have moved.
EdgeShifts EdgeTracker::ExpectedShifts(const LegsInCamera& legs, double time_s) const {
  CommonMotion common(camera_);
  EdgeShifts expected;
  std::array<std::array<std::optional<EdgeEndsInImage>, 2>, kLegCount> ends;
  for (size_t leg = 0; leg < kLegCount; ++leg) {
    const auto normals = ModelNormals(legs[leg]);
    for (size_t edge = 0; normals && edge < 2; ++edge) {
      ends[leg][edge] = EndsInImage(camera_, legs[leg], (*normals)[edge], (*normals)[edge]);
      if (!ends[leg][edge] || !IsFresh(leg, edge, time_s)) continue;
      expected[leg][edge] = places_[leg][edge]->shifts;
      common.Add((*ends[leg][edge])[0], expected[leg][edge]->at_a_px);
      common.Add((*ends[leg][edge])[1], expected[leg][edge]->at_b_px);
    }
  }
  for (size_t leg = 0; leg < kLegCount; ++leg)
    for (size_t edge = 0; edge < 2; ++edge)
      if (ends[leg][edge] && !expected[leg][edge])
        expected[leg][edge] =
            EndShifts{common.ShiftAt((*ends[leg][edge])[0]), common.ShiftAt((*ends[leg][edge])[1])};
  return expected;
}

LegEdges EdgeTracker::Look(const GrayImage& image, const LegsInCamera& legs, const EdgeShifts& expected) {
  LegEdgeOptions options = options_.first_look;
  if (HasSeenAny()) {
    options.lock.reset();
    options.shifts = expected;
    options.search_px = options_.search_px;
    options.blur_px = blur_px_;
  }
  LegEdges edges = MeasureLegEdges(image, legs, camera_, options);
  if (!blur_px_ && edges.blur_px > 0) blur_px_ = edges.blur_px;  // it does not change from image to image
  return edges;
}

// Of those that were measured.
EdgeShifts EdgeTracker::ShiftsOf(const LegsInCamera& legs, LegEdges& edges) const {
  EdgeShifts shifts;
  for (LegEdge& edge : edges.edges) {
    if (!edge.left_out.empty()) continue;
    const auto leg = static_cast<size_t>(edge.leg), side = static_cast<size_t>(edge.edge);
    const auto normals = ModelNormals(legs[leg]);
    if (normals) shifts[leg][side] = ShiftsBetween(camera_, legs[leg], (*normals)[side], edge.normal);
    if (!shifts[leg][side]) edge.left_out = "not in front of the camera";
  }
  return shifts;
}

// What is farther from where it was than anything moves from one image to the next.
void EdgeTracker::DropJumps(const EdgeShifts& found, double time_s, LegEdges& edges) const {
  for (LegEdge& edge : edges.edges) {
    const auto leg = static_cast<size_t>(edge.leg), side = static_cast<size_t>(edge.edge);
    if (!edge.left_out.empty() || !IsFresh(leg, side, time_s)) continue;
    const double jump_px = LargestDifference(*found[leg][side], places_[leg][side]->shifts);
    if (jump_px > options_.gate_px)
      edge.left_out = fmt::format("found {:.1f} px from where it is expected", jump_px);
  }
}

// A leg is as wide as the model has it, nearly: where its two edges are not, one of them is something else's.
void EdgeTracker::DropWrongWidths(const EdgeShifts& found, LegEdges& edges) const {
  for (size_t leg = 0; leg < kLegCount; ++leg) {
    LegEdge &edge_1 = edges.edges[2 * leg], &edge_2 = edges.edges[2 * leg + 1];
    if (!edge_1.left_out.empty() || !edge_2.left_out.empty()) continue;
    const EndShifts &shifts_1 = *found[leg][0], &shifts_2 = *found[leg][1];
    const double wider_px = std::max(std::abs(shifts_1.at_a_px + shifts_2.at_a_px),
                                     std::abs(shifts_1.at_b_px + shifts_2.at_b_px));
    if (wider_px <= options_.width_gate_px) continue;
    const std::string reason = fmt::format("the leg's edges are {:.1f} px from its width apart", wider_px);
    // A rough one is the likelier to be wrong.
    if (edge_1.is_rough || !edge_2.is_rough) edge_1.left_out = reason;
    if (edge_2.is_rough || !edge_1.is_rough) edge_2.left_out = reason;
  }
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
