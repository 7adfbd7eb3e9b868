#include "core/vision/tags.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h10.h>
#include <apriltag/tag36h11.h>
#include <apriltag/tagCircle21h7.h>
#include <apriltag/tagCircle49h12.h>
#include <apriltag/tagCustom48h12.h>
#include <apriltag/tagStandard41h12.h>
#include <apriltag/tagStandard52h13.h>

#include <map>
#include <opencv2/calib3d.hpp>
#include <stdexcept>

namespace legible {
namespace {

struct FamilyFunctions {
  apriltag_family_t* (*create)();
  void (*destroy)(apriltag_family_t*);
};

const std::map<std::string, FamilyFunctions>& Families() {
  static const std::map<std::string, FamilyFunctions> families = {
      {"tag16h5", {tag16h5_create, tag16h5_destroy}},
      {"tag25h9", {tag25h9_create, tag25h9_destroy}},
      {"tag36h10", {tag36h10_create, tag36h10_destroy}},
      {"tag36h11", {tag36h11_create, tag36h11_destroy}},
      {"tagCircle21h7", {tagCircle21h7_create, tagCircle21h7_destroy}},
      {"tagCircle49h12", {tagCircle49h12_create, tagCircle49h12_destroy}},
      {"tagCustom48h12", {tagCustom48h12_create, tagCustom48h12_destroy}},
      {"tagStandard41h12", {tagStandard41h12_create, tagStandard41h12_destroy}},
      {"tagStandard52h13", {tagStandard52h13_create, tagStandard52h13_destroy}},
  };
  return families;
}

// libapriltag puts the centre of the top-left pixel at (0.5, 0.5).
constexpr double kLibraryPixelOffset_px = 0.5;

}  // namespace

struct TagDetector::Library {
  FamilyFunctions functions;
  apriltag_family_t* family;
  apriltag_detector_t* detector;
};

TagDetector::TagDetector(const std::string& family) {
  const auto found = Families().find(family);
  if (found == Families().end()) {
    std::string known;
    for (const auto& [name, functions] : Families()) known += (known.empty() ? "" : ", ") + name;
    throw std::invalid_argument("tag family '" + family + "' is not one of " + known);
  }
  library_ = new Library{found->second, found->second.create(), apriltag_detector_create()};
  apriltag_detector_add_family(library_->detector, library_->family);
}

TagDetector::~TagDetector() {
  apriltag_detector_destroy(library_->detector);
  library_->functions.destroy(library_->family);
  delete library_;
}

std::vector<TagDetection> TagDetector::Detect(const GrayImage& image) const {
  image_u8_t view{image.width, image.height, image.width, const_cast<std::uint8_t*>(image.pixels.data())};
  zarray_t* found = apriltag_detector_detect(library_->detector, &view);
  std::vector<TagDetection> detections;
  for (int i = 0; i < zarray_size(found); ++i) {
    apriltag_detection_t* detection = nullptr;
    zarray_get(found, i, &detection);
    TagDetection tag{detection->id, {}};
    for (size_t corner = 0; corner < 4; ++corner)
      tag.corners_px[corner] =
          Eigen::Vector2d(detection->p[corner][0], detection->p[corner][1]).array() - kLibraryPixelOffset_px;
    detections.push_back(tag);
  }
  apriltag_detections_destroy(found);
  return detections;
}

GroupSighting Match(const TagGroup& group, const std::vector<TagDetection>& detections) {
  GroupSighting sighting;
  for (const Tag& tag : group.tags)
    for (const TagDetection& detection : detections) {
      if (detection.id != tag.id) continue;
      sighting.corners_in_group_m.insert(sighting.corners_in_group_m.end(), tag.corners_m.begin(),
                                         tag.corners_m.end());
      sighting.corners_px.insert(sighting.corners_px.end(), detection.corners_px.begin(),
                                 detection.corners_px.end());
    }
  return sighting;
}

std::optional<GroupPose> LocateGroup(const Camera& camera, const GroupSighting& sighting) {
  if (sighting.corners_px.size() < 4) return std::nullopt;
  std::vector<cv::Point3d> object;
  std::vector<cv::Point2d> image;
  for (size_t i = 0; i < sighting.corners_px.size(); ++i) {
    const auto x = Unproject(camera, sighting.corners_px[i]);
    if (!x) continue;
    const Eigen::Vector3d& corner = sighting.corners_in_group_m[i];
    object.emplace_back(corner.x(), corner.y(), corner.z());
    image.emplace_back(x->x(), x->y());
  }
  if (object.size() < 4) return std::nullopt;
  std::vector<cv::Mat> rotations, translations;
  std::vector<double> errors;
  // Normalised coordinates: the identity camera.
  cv::solvePnPGeneric(object, image, cv::Matx33d::eye(), cv::noArray(), rotations, translations, false,
                      cv::SOLVEPNP_SQPNP, cv::noArray(), cv::noArray(), errors);
  if (rotations.empty()) return std::nullopt;
  cv::solvePnPRefineLM(object, image, cv::Matx33d::eye(), cv::noArray(), rotations[0], translations[0]);
  const auto vector = [](const cv::Mat& m) {
    return Eigen::Vector3d(m.at<double>(0), m.at<double>(1), m.at<double>(2));
  };
  GroupPose pose{{RotationFromVector(vector(rotations[0])), vector(translations[0])}, 0};
  double squares = 0;
  for (size_t i = 0; i < sighting.corners_px.size(); ++i) {
    const Eigen::Vector3d corner = pose.camera_from_group * sighting.corners_in_group_m[i];
    if (!(corner.z() > 0)) return std::nullopt;
    squares += (Project(camera, corner) - sighting.corners_px[i]).squaredNorm();
  }
  pose.rms_px = std::sqrt(squares / static_cast<double>(sighting.corners_px.size()));
  return pose;
}

}  // namespace legible
