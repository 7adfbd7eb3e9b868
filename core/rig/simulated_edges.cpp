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

// The sight plane of the edge touches the cylinder at P + R n.
EdgeEnd EndAt(const LegInCamera& leg, const Camera& camera, const Eigen::Vector3d& normal, double share) {
  const Eigen::Vector3d on_edge = leg.AxisPoint(share) + leg.radius_m * normal;
  const Eigen::Array2d focal_px(camera.fx_px, camera.fy_px);
  const Eigen::Vector2d normal_px = (normal.head<2>().array() / focal_px).matrix().normalized();
  return {on_edge.hnormalized(), normal_px.array() / focal_px};
}

// The edge through both ends after they have moved by noise_px; n = (x1 x x2) / |x1 x x2| up to its sign.
SeenEdge Seen(const std::array<EdgeEnd, 2>& ends, const Eigen::Vector3d& true_normal,
              const Eigen::Vector2d& noise_px, double sigma_px) {
  SeenEdge seen;
  std::array<Eigen::Vector3d, 2> moved, across;
  for (size_t i = 0; i < 2; ++i) {
    seen.ends[i] = ends[i].point + noise_px[static_cast<Eigen::Index>(i)] * ends[i].across_per_px;
    moved[i] = seen.ends[i].homogeneous();
    across[i] << ends[i].across_per_px, 0;
  }
  const Eigen::Vector3d product = moved[0].cross(moved[1]);
  const double size = product.dot(true_normal) < 0 ? -product.norm() : product.norm();
  seen.normal = product / size;
  Eigen::Matrix<double, 3, 2> d_normal_d_px;
  d_normal_d_px << across[0].cross(moved[1]) / size, moved[0].cross(across[1]) / size;
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

}  // namespace

SimulatedEdges::SimulatedEdges(SimulatedRig& rig) : rig_(rig) {
  visibility_.step_px = kStep_px;
  const Camera& camera = rig.truth().camera;
  if (camera.width_px <= 0 || camera.height_px <= 0 || !(camera.fx_px > 0) || !(camera.fy_px > 0))
    throw std::invalid_argument("SimulatedEdges: the rig's truth has no camera");
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
      const std::array<EdgeEnd, 2> ends = {EndAt(legs[leg], truth.camera, edge.normal, stretch.begin),
                                           EndAt(legs[leg], truth.camera, edge.normal, stretch.end)};
      seen.edges.push_back(
          Seen(ends, edge.normal, noise_px * noise[leg][j], std::max(noise_px, kLeastNoise_px)));
      seen.edges.back().leg = i;
      seen.edges.back().edge = static_cast<int>(j);
    }
  }
  return seen;
}

}  // namespace legible
