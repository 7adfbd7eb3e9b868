#include "core/rig/simulated_edges.h"

#include <algorithm>
#include <optional>
#include <random>
#include <stdexcept>

#include "core/rig/keyed_random.h"

namespace legible {
namespace {

// A third of what is usual takes a third of the time, and the ends are that much coarser.
constexpr double kStep_px = 18;

// The stretch of an edge that is seen, in shares of its leg's axis.
struct Stretch {
  double begin = 0, end = 0, length_px = 0;
};

Stretch LongestVisible(const PredictedEdge& edge) {
  Stretch longest, now;
  bool is_open = false;
  for (const PredictedEdgePoint& point : edge.points) {
    const bool is_visible = point.obstacle == EdgeObstacle::kNone;
    if (is_visible && is_open) {
      const PredictedEdgePoint& last = *(&point - 1);
      now.end = point.share;
      now.length_px += (point.point_px - last.point_px).norm();
      if (now.length_px > longest.length_px) longest = now;
    } else if (is_visible) {
      now = {point.share, point.share, 0};
    }
    is_open = is_visible;
  }
  return longest;
}

// A point of the undistorted image, and by how much a pixel across the edge moves it; normalised coordinates.
struct EdgeEnd {
  Eigen::Vector2d point, across_per_px;
};
using EdgeEnds = std::array<EdgeEnd, 2>;

Eigen::Vector2d AcrossPerPx(const Camera& camera, const Eigen::Vector3d& normal) {
  const Eigen::Array2d focal_px(camera.fx_px, camera.fy_px);
  const Eigen::Vector2d normal_px = (normal.head<2>().array() / focal_px).matrix().normalized();
  return normal_px.array() / focal_px;
}

// The sight plane of the edge touches the cylinder at P + R n.
EdgeEnd EndAt(const LegInCamera& leg, const Camera& camera, const Eigen::Vector3d& normal, double share) {
  const Eigen::Vector3d on_edge = leg.AxisPoint(share) + leg.radius_m * normal;
  return {on_edge.hnormalized(), AcrossPerPx(camera, normal)};
}

void Move(EdgeEnds& ends, const Eigen::Vector2d& noise_px) {
  for (size_t i = 0; i < 2; ++i)
    ends[i].point += noise_px[static_cast<Eigen::Index>(i)] * ends[i].across_per_px;
}

// The line through both points, n = (x1 x x2) / |x1 x x2|, on the side of another normal.
Eigen::Vector3d NormalThrough(const EdgeEnds& ends, const Eigen::Vector3d& side) {
  const Eigen::Vector3d product = ends[0].point.homogeneous().cross(ends[1].point.homogeneous());
  return (product.dot(side) < 0 ? -1 : 1) / product.norm() * product;
}

// The ends' pixels, looked at through another camera; nothing where its lens does not reach.
std::optional<EdgeEnds> ThroughModel(const EdgeEnds& ends, const Eigen::Vector3d& normal,
                                     const Camera& camera, const Camera& model) {
  EdgeEnds through;
  for (size_t i = 0; i < 2; ++i) {
    const auto point = Unproject(model, ProjectNormalised(camera, ends[i].point));
    if (!point) return std::nullopt;
    through[i].point = *point;
  }
  const Eigen::Vector2d across = AcrossPerPx(model, NormalThrough(through, normal));
  for (EdgeEnd& end : through) end.across_per_px = across;
  return through;
}

// The edge through both ends, to which the noise has been done.
SeenEdge Seen(const EdgeEnds& ends, const Eigen::Vector3d& side, double sigma_px) {
  SeenEdge seen;
  std::array<Eigen::Vector3d, 2> point, across;
  for (size_t i = 0; i < 2; ++i) {
    seen.ends[i] = ends[i].point;
    point[i] = ends[i].point.homogeneous();
    across[i] << ends[i].across_per_px, 0;
  }
  seen.normal = NormalThrough(ends, side);
  const double size = point[0].cross(point[1]).dot(seen.normal);
  Eigen::Matrix<double, 3, 2> d_normal_d_px;
  d_normal_d_px << across[0].cross(point[1]) / size, point[0].cross(across[1]) / size;
  d_normal_d_px -= (seen.normal * (seen.normal.transpose() * d_normal_d_px)).eval();
  seen.normal_covariance = sigma_px * sigma_px * d_normal_d_px * d_normal_d_px.transpose();
  return seen;
}

// Standard normal deviates of both ends of both edges of each leg, drawn whether an edge is seen or not.
using EdgeNoise = std::array<std::array<Eigen::Vector2d, 2>, kLegCount>;

EdgeNoise DrawNoise(std::uint64_t seed, std::uint64_t frame) {
  KeyedRandom random(seed, RandomUse::kEdgeNoise, frame);
  std::normal_distribution<double> normal;
  EdgeNoise noise;
  for (auto& of_leg : noise)
    for (Eigen::Vector2d& of_edge : of_leg)
      for (double& of_end : of_edge) of_end = normal(random);
  return noise;
}

bool IsCovered(const Frame& frame, int leg) {
  return std::binary_search(frame.covered_legs.begin(), frame.covered_legs.end(), leg);
}

bool IsCamera(const Camera& camera) {
  return camera.width_px > 0 && camera.height_px > 0 && camera.fx_px > 0 && camera.fy_px > 0;
}

}  // namespace

SimulatedEdges::SimulatedEdges(SimulatedRig& rig, const std::optional<Camera>& model_camera)
    : rig_(rig), model_camera_(model_camera) {
  visibility_.step_px = kStep_px;
  if (!IsCamera(rig.truth().camera))
    throw std::invalid_argument("SimulatedEdges: the rig's truth has no camera");
  if (model_camera && !IsCamera(*model_camera))
    throw std::invalid_argument("SimulatedEdges: the model is no camera");
}

SeenEdges SimulatedEdges::See(const MotionNow& /*motion*/) {
  const Frame& frame = rig_.NewestFrame();
  const SimulationTruth& truth = rig_.truth();
  const LegsInCamera legs = PlaceLegs(truth.robot, truth.camera_from_base, frame.base_from_platform);
  const PredictedEdges predicted = PredictEdges(legs, truth.camera, visibility_);
  const EdgeNoise noise = DrawNoise(rig_.options().seed, frame.number);
  const double noise_px = rig_.options().edge_noise_px;
  SeenEdges seen;
  seen.time_s = frame.time_s;
  for (int i = 0; i < kLegCount; ++i) {
    if (IsCovered(frame, i)) continue;
    const auto leg = static_cast<size_t>(i);
    for (size_t j = 0; j < 2; ++j) {
      const PredictedEdge& edge = predicted[leg][j];
      const Stretch stretch = LongestVisible(edge);
      if (stretch.length_px < kShortestSeen_px) continue;
      std::optional<EdgeEnds> ends{{EndAt(legs[leg], truth.camera, edge.normal, stretch.begin),
                                    EndAt(legs[leg], truth.camera, edge.normal, stretch.end)}};
      Move(*ends, noise_px * noise[leg][j]);
      if (model_camera_) ends = ThroughModel(*ends, edge.normal, truth.camera, *model_camera_);
      if (!ends) continue;
      seen.edges.push_back(Seen(*ends, edge.normal, std::max(noise_px, kLeastNoise_px)));
      seen.edges.back().leg = i;
      seen.edges.back().edge = static_cast<int>(j);
    }
  }
  return seen;
}

}  // namespace legible
