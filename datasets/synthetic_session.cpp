#include "datasets/synthetic_session.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <stdexcept>

#include "core/geometry/cylinder_outline.h"
#include "core/geometry/plucker_line.h"

namespace legible {
namespace {

using Generator = std::mt19937_64;

constexpr int kMostTriesAPose = 10000;

// Separate streams, so that what one draws leaves the others alone.
enum class Stream : std::uint32_t { kTruth, kGuess, kPoses, kOcclusions, kNoise, kShading, kLastingShading };

Generator MakeGenerator(std::uint64_t seed, Stream stream) {
  std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                         static_cast<std::uint32_t>(stream)};
  return Generator(sequence);
}

double Uniform(Generator& generator, double low, double high) {
  return low + (high - low) * std::generate_canonical<double, 53>(generator);
}

double Within(Generator& generator, double half_width) { return Uniform(generator, -half_width, half_width); }

Eigen::Vector3d VectorWithin(Generator& generator, double half_width) {
  Eigen::Vector3d vector;
  for (double& coordinate : vector) coordinate = Within(generator, half_width);
  return vector;
}

GoughStewart DrawTruth(const SyntheticOptions& options) {
  Generator generator = MakeGenerator(options.seed, Stream::kTruth);
  GoughStewart robot = options.drawing;
  for (Leg& leg : robot.legs) {
    leg.base_joint_m += VectorWithin(generator, options.geometry_error_m);
    leg.platform_joint_m += VectorWithin(generator, options.geometry_error_m);
    leg.joint_offset_m += Within(generator, options.joint_offset_error_m);
    leg.radius_m += Within(generator, options.radius_error_m);
  }
  return robot;
}

void DrawGuess(const SyntheticOptions& options, SyntheticRig& rig) {
  Generator generator = MakeGenerator(options.seed, Stream::kGuess);
  Camera& camera = rig.nominal_camera;
  camera = options.camera;
  camera.distortion.setZero();
  for (double* value : {&camera.fx_px, &camera.fy_px, &camera.cx_px, &camera.cy_px}) {
    *value += Within(generator, options.camera_error_px);
  }
  Vector6d displacement;
  displacement.head<3>() = VectorWithin(generator, options.camera_position_error_m);
  displacement.tail<3>() = VectorWithin(generator, options.camera_rotation_error_rad);
  rig.nominal_camera_from_base = Displaced(options.camera_from_base, displacement);
}

Rigid3 DrawPose(const SyntheticOptions& options, Generator& generator) {
  Rigid3 base_from_platform;
  for (int i = 0; i < 3; ++i) {
    base_from_platform.translation[i] =
        Uniform(generator, options.lowest_position_m[i], options.highest_position_m[i]);
  }
  std::normal_distribution<double> normal(0, 1);
  Eigen::Vector3d rotation_vector;
  for (double& coordinate : rotation_vector) coordinate = options.rotation_sigma_rad * normal(generator);
  base_from_platform.rotation =
      (RotationFromVector(rotation_vector) * options.drawing.home.rotation).normalized();
  return base_from_platform;
}

// A camera together with how far from its axis it has an image.
struct View {
  Camera camera;
  Rigid3 camera_from_base;
  double largest_radius = 0;  // normalised: where the distortion folds over

  bool Sees(const Eigen::Vector2d& pixel) const {
    return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= camera.width_px - 1 &&
           pixel.y() <= camera.height_px - 1;
  }
  bool Sees(const Eigen::Vector3d& x_in_camera) const {
    return x_in_camera.z() > 0 && x_in_camera.hnormalized().norm() < largest_radius &&
           Sees(Project(camera, x_in_camera));
  }
};

bool ReadingsAreInRange(const GoughStewart& robot, const Vector6d& readings_m) {
  for (int i = 0; i < kLegCount; ++i) {
    const auto [shortest, longest] = robot.legs[i].joint_range_m;
    if (readings_m[i] < shortest || readings_m[i] > longest) return false;
  }
  return true;
}

// The point of the outline line of `normal` nearest to the axis point's projection, with the distorted
// outline's normal there: the undistorted normal times the inverse transpose of the projection's derivative.
EdgeSample SampleAt(const Camera& camera, const Eigen::Vector3d& axis_point_in_camera,
                    const Eigen::Vector3d& normal, double sigma_px) {
  const Eigen::Vector2d projection = axis_point_in_camera.hnormalized();
  const Eigen::Vector2d n = normal.head<2>();
  const Eigen::Vector2d nearest = projection - n * normal.dot(projection.homogeneous()) / n.squaredNorm();
  const DistortedPoint distorted = DistortWithJacobians(camera.lens, camera.distortion, nearest);
  const Eigen::Matrix2d d_pixel_d_nearest =
      Eigen::Vector2d(camera.fx_px, camera.fy_px).asDiagonal() * distorted.d_point_d_undistorted;
  EdgeSample sample;
  sample.point_px = ProjectNormalised(camera, nearest);
  sample.normal_px = (d_pixel_d_nearest.inverse().transpose() * n).normalized();
  sample.sigma_px = sigma_px;
  return sample;
}

// Both edges of one leg; nothing if the camera does not see all of them.
std::optional<std::array<EdgeObservation, 2>> ExactEdges(const SyntheticOptions& options, const View& view,
                                                         int leg, const Eigen::Vector3d& a_in_camera,
                                                         const Eigen::Vector3d& b_in_camera,
                                                         double radius_m) {
  const PluckerLine<double> axis = LineThrough<double>(a_in_camera, b_in_camera);
  if (!view.Sees(a_in_camera) || !view.Sees(b_in_camera) || !CameraIsOutside(axis, radius_m))
    return std::nullopt;
  const auto normals = CylinderOutline(axis, radius_m);
  const double step = (options.last_sample - options.first_sample) / (options.samples_per_edge - 1);
  std::array<EdgeObservation, 2> edges;
  for (int edge = 0; edge < 2; ++edge) {
    edges[edge].leg = leg;
    edges[edge].edge = edge;
    edges[edge].common_sigma_px = options.common_edge_sigma_px;
    for (int i = 0; i < options.samples_per_edge; ++i) {
      const Eigen::Vector3d point =
          a_in_camera + (options.first_sample + i * step) * (b_in_camera - a_in_camera);
      edges[edge].samples.push_back(SampleAt(view.camera, point, normals[edge], options.edge_sigma_px));
      if (!view.Sees(edges[edge].samples.back().point_px)) return std::nullopt;
    }
  }
  return edges;
}

// What the camera sees of the robot in a pose; nothing if the pose breaks a joint range or leaves the image.
std::optional<ImageObservation> ExactObservation(const SyntheticOptions& options, const View& view,
                                                 const GoughStewart& robot,
                                                 const Rigid3& base_from_platform) {
  ImageObservation observation;
  observation.joint_readings_m = InverseKinematics(robot, base_from_platform);
  if (!ReadingsAreInRange(robot, *observation.joint_readings_m)) return std::nullopt;
  const Rigid3 camera_from_platform = view.camera_from_base * base_from_platform;
  for (int i = 0; i < kLegCount; ++i) {
    const Leg& leg = robot.legs[i];
    const auto edges = ExactEdges(options, view, i, view.camera_from_base * leg.base_joint_m,
                                  camera_from_platform * leg.platform_joint_m, leg.radius_m);
    if (!edges) return std::nullopt;
    observation.edges.insert(observation.edges.end(), edges->begin(), edges->end());
  }
  return observation;
}

void DrawImages(const SyntheticOptions& options, SyntheticSession& session) {
  Generator generator = MakeGenerator(options.seed, Stream::kPoses);
  const View view{session.true_camera, session.true_camera_from_base,
                  MonotonicRadius(options.camera.lens, options.camera.distortion)};
  int tries = 0;
  while (static_cast<int>(session.exact_observations.size()) < options.image_count) {
    const Rigid3 pose = DrawPose(options, generator);
    auto observation = ExactObservation(options, view, session.true_robot, pose);
    if (!observation) {
      if (++tries < kMostTriesAPose) continue;
      throw std::invalid_argument(
          fmt::format("SyntheticOptions: of {} poses none keeps the joint ranges and the image; widen these "
                      "or aim the camera",
                      kMostTriesAPose));
    }
    tries = 0;
    observation->name = fmt::format("{:03}", session.exact_observations.size());
    session.true_base_from_platform.push_back(pose);
    session.exact_observations.push_back(*std::move(observation));
  }
}

int OccludedCount(const SyntheticOptions& options) {
  return static_cast<int>(std::lround(options.occlusion_fraction * options.samples_per_edge));
}

void Occlude(const SyntheticOptions& options, std::vector<ImageObservation>& observations) {
  Generator generator = MakeGenerator(options.seed, Stream::kOcclusions);
  const int count = OccludedCount(options);
  for (ImageObservation& observation : observations) {
    for (EdgeObservation& edge : observation.edges) {
      const int places = static_cast<int>(edge.samples.size()) - count + 1;
      const auto begin = edge.samples.begin() + static_cast<int>(Uniform(generator, 0, places));
      edge.samples.erase(begin, begin + count);
    }
  }
}

Eigen::Vector4d NormalVector4(Generator& generator, double sigma) {
  std::normal_distribution<double> normal(0, sigma);
  Eigen::Vector4d vector;
  for (double& entry : vector) entry = sigma > 0 ? normal(generator) : 0;
  return vector;
}

// Moves whole edges, as shading does.
void Shade(const SyntheticOptions& options, std::uint64_t noise_seed,
           std::vector<ImageObservation>& observations) {
  const auto lasting = DrawLastingShading(options, noise_seed);
  Generator generator = MakeGenerator(noise_seed, Stream::kShading);
  for (ImageObservation& observation : observations)
    for (EdgeObservation& edge : observation.edges) {
      const Eigen::Vector2d moved = NormalVector4(generator, options.common_edge_sigma_px).head<2>() +
                                    lasting[static_cast<size_t>(edge.leg)].segment<2>(2 * edge.edge);
      const Eigen::VectorXd place = PlacesAlong(edge);
      for (size_t i = 0; i < edge.samples.size(); ++i)
        edge.samples[i].point_px +=
            (moved[0] + moved[1] * place[static_cast<Eigen::Index>(i)]) * edge.samples[i].normal_px;
    }
}

struct Draw {
  std::vector<ImageObservation> observations;
  std::vector<bool> is_outlier;
};

// The same numbers are drawn whether or not a sample is an outlier: the others keep their noise.
Draw DrawNoise(const std::vector<ImageObservation>& exact, const SyntheticOptions& options,
               std::uint64_t noise_seed) {
  Generator generator = MakeGenerator(noise_seed, Stream::kNoise);
  std::normal_distribution<double> normal(0, 1);
  Draw draw;
  draw.observations = exact;
  for (ImageObservation& observation : draw.observations) {
    for (double& reading : *observation.joint_readings_m)
      reading += options.joint_reading_sigma_m * normal(generator);
    for (EdgeObservation& edge : observation.edges) {
      for (EdgeSample& sample : edge.samples) {
        const double noise_px = options.edge_sigma_px * normal(generator);
        const double outlier_px = Within(generator, options.outlier_half_width_px);
        draw.is_outlier.push_back(Uniform(generator, 0, 1) < options.outlier_fraction);
        sample.point_px += (draw.is_outlier.back() ? outlier_px : noise_px) * sample.normal_px;
      }
    }
  }
  Shade(options, noise_seed, draw.observations);
  return draw;
}

void Demand(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(fmt::format("SyntheticOptions: {}", what));
}

void CheckGeometry(const SyntheticOptions& options) {
  Demand(options.geometry_error_m >= 0, "geometry_error_m must be 0 or more");
  Demand(options.joint_offset_error_m >= 0, "joint_offset_error_m must be 0 or more");
  Demand(options.radius_error_m >= 0, "radius_error_m must be 0 or more");
  for (const Leg& leg : options.drawing.legs) {
    Demand(leg.radius_m > options.radius_error_m, "radius_m of each leg must be greater than radius_error_m");
    Demand(leg.joint_range_m[0] < leg.joint_range_m[1],
           "joint_range_m of each leg must be [shortest, longest]");
  }
}

void CheckCamera(const SyntheticOptions& options) {
  const Camera& camera = options.camera;
  Demand(camera.width_px > 0 && camera.height_px > 0, "camera must have a width and a height");
  Demand(camera.fx_px > options.camera_error_px && camera.fy_px > options.camera_error_px,
         "the camera's focal lengths must be greater than camera_error_px");
  Demand(options.camera_error_px >= 0, "camera_error_px must be 0 or more");
  Demand(options.camera_position_error_m >= 0, "camera_position_error_m must be 0 or more");
  Demand(options.camera_rotation_error_rad >= 0, "camera_rotation_error_rad must be 0 or more");
}

void CheckSamples(const SyntheticOptions& options) {
  Demand(options.samples_per_edge >= 2, "samples_per_edge must be 2 or more");
  Demand(options.first_sample >= 0 && options.first_sample < options.last_sample && options.last_sample <= 1,
         "0 <= first_sample < last_sample <= 1 must hold");
  Demand(options.occlusion_fraction >= 0 && options.occlusion_fraction < 1,
         "occlusion_fraction must be in [0, 1)");
  Demand(options.samples_per_edge - OccludedCount(options) >= 2,
         "occlusion_fraction must leave 2 samples an edge");
  Demand(options.edge_sigma_px > 0, "edge_sigma_px must be greater than 0");
  Demand(options.common_edge_sigma_px >= 0, "common_edge_sigma_px must be 0 or more");
  Demand(options.lasting_shading_px >= 0, "lasting_shading_px must be 0 or more");
  Demand(options.joint_reading_sigma_m >= 0, "joint_reading_sigma_m must be 0 or more");
  Demand(options.outlier_fraction >= 0 && options.outlier_fraction <= 1,
         "outlier_fraction must be in [0, 1]");
  Demand(options.outlier_half_width_px >= 0, "outlier_half_width_px must be 0 or more");
}

}  // namespace

GoughStewart DesktopHexapod() {
  constexpr double kDegree = std::numbers::pi / 180;
  constexpr double kAlpha = 4.25 * kDegree, kBeta = 5.885 * kDegree;
  constexpr double kBaseRadius = 0.27, kPlatformRadius = 0.195, kHomeLength = 0.375;  // m
  GoughStewart robot;
  robot.name = "desktop hexapod";
  for (int i = 0; i < kLegCount; ++i) {
    const int pair = i / 2;
    const double centre = pair * 2 * std::numbers::pi / 3;
    const double side = i % 2 == 0 ? 1 : -1;
    const double base_angle = centre + side * kAlpha;
    const double platform_angle = centre + side * (std::numbers::pi / 3 - kBeta);
    Leg& leg = robot.legs[i];
    leg.base_joint_m = kBaseRadius * Eigen::Vector3d(std::cos(base_angle), std::sin(base_angle), 0);
    leg.platform_joint_m =
        kPlatformRadius * Eigen::Vector3d(std::cos(platform_angle), std::sin(platform_angle), 0);
    leg.radius_m = 0.01;
    leg.joint_range_m = {0.345, 0.485};
  }
  const double across = (robot.legs[0].base_joint_m - robot.legs[0].platform_joint_m).norm();
  robot.home.translation.z() = std::sqrt(kHomeLength * kHomeLength - across * across);
  return robot;
}

Camera DesktopCamera(bool is_distorted) {
  Camera camera;
  camera.width_px = 1280;
  camera.height_px = 960;
  camera.fx_px = 1246.83;
  camera.fy_px = 1249.57;
  camera.cx_px = 654.12;
  camera.cy_px = 467.63;
  if (is_distorted) camera.distortion.head<4>() << -0.18, 0.06, 0.0007, -0.0004;
  return camera;
}

Camera DesktopFisheye() {
  Camera camera = DesktopCamera(false);
  camera.lens = LensModel::kFisheye;
  camera.fx_px = 668.31;
  camera.fy_px = 669.77;
  camera.distortion.head<4>() << -0.021, 0.012, -0.009, 0.0021;
  return camera;
}

Rigid3 LookAt(const Eigen::Vector3d& position_in_base, const Eigen::Vector3d& target_in_base) {
  const Eigen::Vector3d forward = (target_in_base - position_in_base).normalized();
  const Eigen::Vector3d sideways = forward.cross(Eigen::Vector3d::UnitZ());
  if (!(sideways.norm() > 1e-9))
    throw std::invalid_argument("LookAt: the target is above or below the camera");
  Eigen::Matrix3d base_from_camera;
  base_from_camera.col(0) = sideways.normalized();
  base_from_camera.col(1) = forward.cross(base_from_camera.col(0));
  base_from_camera.col(2) = forward;
  return Inverse({Eigen::Quaterniond(base_from_camera).normalized(), position_in_base});
}

void SyntheticOptions::Check() const {
  Demand(image_count >= 1, "image_count must be 1 or more");
  Demand((lowest_position_m.array() <= highest_position_m.array()).all(),
         "lowest_position_m must not exceed highest_position_m");
  Demand(rotation_sigma_rad >= 0, "rotation_sigma_rad must be 0 or more");
  CheckGeometry(*this);
  CheckCamera(*this);
  CheckSamples(*this);
}

SyntheticRig GenerateRig(const SyntheticOptions& options) {
  options.Check();
  SyntheticRig rig;
  rig.nominal_robot = options.drawing;
  rig.true_robot = DrawTruth(options);
  rig.true_camera = options.camera;
  rig.true_camera_from_base = options.camera_from_base;
  DrawGuess(options, rig);
  return rig;
}

SyntheticSession GenerateSession(const SyntheticOptions& options) {
  SyntheticSession session{GenerateRig(options), {}, {}, {}, {}};
  DrawImages(options, session);
  Occlude(options, session.exact_observations);
  Draw draw = DrawNoise(session.exact_observations, options, options.noise_seed);
  session.observations = std::move(draw.observations);
  session.is_outlier = std::move(draw.is_outlier);
  return session;
}

std::vector<ImageObservation> DrawObservations(const SyntheticSession& session,
                                               const SyntheticOptions& options, std::uint64_t noise_seed) {
  return DrawNoise(session.exact_observations, options, noise_seed).observations;
}

std::array<Eigen::Vector4d, kLegCount> DrawLastingShading(const SyntheticOptions& options,
                                                          std::uint64_t noise_seed) {
  Generator generator = MakeGenerator(noise_seed, Stream::kLastingShading);
  std::array<Eigen::Vector4d, kLegCount> shading;
  for (Eigen::Vector4d& of_leg : shading) of_leg = NormalVector4(generator, options.lasting_shading_px);
  return shading;
}

}  // namespace legible
