// Synthetic sessions: exact edges of a known robot plus chosen noise, outliers and occlusions; no images.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/camera.h"
#include "core/geometry/rigid3.h"
#include "core/robots/gough_stewart.h"
#include "core/vision/edge_observation.h"

namespace legible {

// A hexapod of the size of a desk. Its platform frame is parallel to the base's at home, and legs 2k+1 and
// 2k+2 (k = 0, 1, 2) go from the base joints at 2k pi/3 +- 4.25 deg on a circle of 0.27 m to the platform
// joints at 2k pi/3 +- (pi/3 - 5.885 deg) on one of 0.195 m, so that each pair spreads and meets its
// neighbours at the platform.
GoughStewart DesktopHexapod();

// A camera of 1280 x 960 px with a focal length of about 1247 px, with the barrel distortion of a simple lens
// or none. Its model is Brown-Conrady either way.
Camera DesktopCamera(bool is_distorted);

// A camera of 1280 x 960 px whose fisheye lens shows 137 degrees from corner to corner.
Camera DesktopFisheye();

// The camera frame at a point of the base frame (m), looking at another, its x axis horizontal. Returns
// camera_from_base. Throws std::invalid_argument if one is above the other.
Rigid3 LookAt(const Eigen::Vector3d& position_in_base, const Eigen::Vector3d& target_in_base);

struct SyntheticOptions {
  int image_count = 40;
  GoughStewart drawing = DesktopHexapod();
  // The truth lies off the drawing by up to this, uniformly: each coordinate of each joint, each offset, each
  // radius.
  double geometry_error_m = 0.002;
  double joint_offset_error_m = 0.0015;
  double radius_error_m = 0.0006;

  Camera camera = DesktopCamera(false);  // the truth
  Rigid3 camera_from_base = LookAt({0.94, 0.074, 0.285}, {0, 0, 0.13});
  // The first guess of the camera has no distortion and is off by up to this, uniformly: fx, fy, cx and cy
  // each; each coordinate of its place and of its rotation vector.
  double camera_error_px = 8;
  double camera_position_error_m = 0.03;
  double camera_rotation_error_rad = 0.05;

  // Where the platform goes: uniform in position, a normal rotation vector before the home rotation. A pose
  // in which a joint reading leaves its range, or a joint or an edge sample the image, is drawn again.
  Eigen::Vector3d lowest_position_m{-0.05, -0.05, 0.28};
  Eigen::Vector3d highest_position_m{0.05, 0.05, 0.40};
  double rotation_sigma_rad = 0.12;

  // Samples stand at equal steps between these fractions of the leg's axis from A to B.
  int samples_per_edge = 20;
  double first_sample = 0.08;
  double last_sample = 0.92;
  double occlusion_fraction = 0;  // of each edge's samples: a contiguous stretch of them is missing

  double edge_sigma_px = 0.3;  // along the edge's normal; > 0, for it is the samples' weight too
  // What shading does to whole edges: a shift, and a tilt (at the edge's ends), of each edge in each image,
  // and of each leg's edges the same in all images.
  double common_edge_sigma_px = 0;
  double lasting_shading_px = 0;
  double joint_reading_sigma_m = 2.0e-5;  // 0 gives exact readings
  double outlier_fraction = 0;            // chance of a sample to be an outlier
  double outlier_half_width_px = 20;      // outliers: uniform within this along the normal

  std::uint64_t seed = 1;        // of the truth, the first guess, the poses and the occlusions
  std::uint64_t noise_seed = 1;  // of the noise, the shading and the outliers

  // Throws std::invalid_argument that names the field out of its range.
  void Check() const;
};

// A robot and a camera as they are, and as drawing and tape measure have them.
struct SyntheticRig {
  GoughStewart true_robot, nominal_robot;
  Camera true_camera, nominal_camera;
  Rigid3 true_camera_from_base, nominal_camera_from_base;
};

struct SyntheticSession : SyntheticRig {
  std::vector<Rigid3> true_base_from_platform;  // of each image
  std::vector<ImageObservation>
      exact_observations;                      // without noise and outliers; occluded samples are missing
  std::vector<ImageObservation> observations;  // the same samples with both
  std::vector<bool> is_outlier;                // of each sample of `observations`, in their order
};

// Draws the rig of a session only: the same that GenerateSession draws. Throws std::invalid_argument if the
// options do not pass Check.
SyntheticRig GenerateRig(const SyntheticOptions& options);

// Draws a session. The first n images do not depend on how many follow. Throws std::invalid_argument if the
// options do not pass Check or hardly any pose of theirs keeps its joint ranges and the image.
SyntheticSession GenerateSession(const SyntheticOptions& options);

// Draws new noise and outliers on a session's exact observations; DrawObservations(session, options,
// options.noise_seed) are the observations that GenerateSession(options) drew.
std::vector<ImageObservation> DrawObservations(const SyntheticSession& session,
                                               const SyntheticOptions& options, std::uint64_t noise_seed);

// Shift and tilt of edge 1, of edge 2 of each leg in all images alike (px, outward; the tilt at the end
// towards B), as DrawObservations has them.
std::array<Eigen::Vector4d, kLegCount> DrawLastingShading(const SyntheticOptions& options,
                                                          std::uint64_t noise_seed);

}  // namespace legible
