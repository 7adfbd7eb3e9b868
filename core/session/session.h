// What a calibration session holds, and the model that comes out of it.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/camera.h"
#include "core/robots/gough_stewart.h"

namespace legible {

// 1-sigma of what is known beforehand about the values in the session's robot and camera; empty = unknown.
struct PriorKnowledge {
  std::optional<double> joint_reading_m;
  std::optional<double> radius_m;
  std::optional<double> joint_offset_m;
  std::optional<double> base_joint_m;      // each coordinate, up to where the base as a whole is
  std::optional<double> platform_joint_m;  // each coordinate, up to where the platform as a whole is
  std::optional<double> focal_length_px;
  std::optional<double> principal_point_px;
  std::optional<double> distortion;  // each coefficient
  // The inverse covariance of fx fy cx cy and the coefficients of the camera's lens, as a board told them;
  // empty: unknown.
  Eigen::MatrixXd camera_information = {};
};
// The smallest sigma that may be said of anything: what is known better is held.
inline constexpr double kLeastKnownSigma = 1e-9;
// By the names that files and options give them.
using KnownField = std::optional<double> PriorKnowledge::*;
inline const std::vector<std::pair<std::string, KnownField>> kKnownFields = {
    {"joint_reading_m", &PriorKnowledge::joint_reading_m},
    {"radius_m", &PriorKnowledge::radius_m},
    {"joint_offset_m", &PriorKnowledge::joint_offset_m},
    {"base_joint_m", &PriorKnowledge::base_joint_m},
    {"platform_joint_m", &PriorKnowledge::platform_joint_m},
    {"focal_length_px", &PriorKnowledge::focal_length_px},
    {"principal_point_px", &PriorKnowledge::principal_point_px},
    {"distortion", &PriorKnowledge::distortion},
};

enum class TagCarrier { kBase, kPlatform };

struct Tag {
  int id = 0;
  // In the group's frame, m: bottom-left, bottom-right, top-right, top-left of the black border.
  std::array<Eigen::Vector3d, 4> corners_m;
};

// Tags that are rigid to one another, on the base or on the platform.
struct TagGroup {
  std::string name;
  TagCarrier carrier = TagCarrier::kBase;
  Rigid3 carrier_from_group;       // base_from_group or platform_from_group
  double translation_sigma_m = 0;  // 1-sigma of that placement, each coordinate
  double rotation_sigma_rad = 0;
  std::vector<Tag> tags;
};

// A family of tags as libapriltag has it.
struct TagFamily {
  std::string name;
  int tags;  // ids are 0 … tags - 1
};
inline const std::vector<TagFamily> kTagFamilies = {{"tag36h11", 587},
                                                    {"tag36h10", 2320},
                                                    {"tag25h9", 35},
                                                    {"tag16h5", 30},
                                                    {"tagCircle21h7", 38},
                                                    {"tagCircle49h12", 65535},
                                                    {"tagStandard41h12", 2115},
                                                    {"tagStandard52h13", 48714},
                                                    {"tagCustom48h12", 42211}};

struct TagLayout {
  std::string family;  // of kTagFamilies
  std::vector<TagGroup> groups;
};

struct SessionImage {
  std::string name;  // as in joints.csv
  std::filesystem::path file;
  Vector6d joint_readings_m;
};

struct Session {
  std::filesystem::path folder;
  GoughStewart robot;                      // the drawing
  Camera camera;                           // the first guess
  std::optional<Rigid3> camera_from_base;  // by tape measure, where given
  std::vector<SessionImage> images;        // in the order of joints.csv
  std::optional<TagLayout> tags;
  PriorKnowledge known;
  std::vector<std::filesystem::path>
      files;  // what it was read from but the images: session.yaml, robot, camera, …
  std::vector<std::string> unlisted_images;  // in the image folder but not in joints.csv: not used
  std::vector<std::string> warnings;         // what a user has to know of how its files were understood
};

// What a calibration found, and what everything else starts from.
struct CalibratedModel {
  GoughStewart robot;
  std::optional<Camera> camera;
  std::optional<Rigid3> camera_from_base;
  std::vector<std::string> parameter_names;       // row order of `covariance`, e.g. "legs[1].base_joint_m.x"
  Eigen::MatrixXd covariance;                     // of the named parameters, SI units; empty for a drawing
  std::map<std::string, std::string> provenance;  // session, content_hash, program_version, options
};

}  // namespace legible
