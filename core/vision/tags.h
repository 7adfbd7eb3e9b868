// AprilTags in images, and the camera's pose from a group of them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/camera.h"
#include "core/geometry/rigid3.h"
#include "core/session/session.h"
#include "core/vision/gray_image.h"

namespace legible {

struct TagDetection {
  int id = 0;
  // px, centre of the top-left pixel at (0, 0): bottom-left, bottom-right, top-right, top-left of the black
  // border.
  std::array<Eigen::Vector2d, 4> corners_px;
};

// Finds tags of one family. Holds the library's detector, which is costly to make; not for use by two
// threads.
class TagDetector {
 public:
  // Throws std::invalid_argument for a family that libapriltag does not have.
  explicit TagDetector(const std::string& family);
  ~TagDetector();
  TagDetector(const TagDetector&) = delete;
  TagDetector& operator=(const TagDetector&) = delete;

  std::vector<TagDetection> Detect(const GrayImage& image) const;

 private:
  struct Library;
  Library* library_;
};

// Corners of a group's tags that were seen in one image.
struct GroupSighting {
  std::vector<Eigen::Vector3d> corners_in_group_m;
  std::vector<Eigen::Vector2d> corners_px;
};
// The group's tags among the detections of one image, by id; corners in the order of the drawing.
GroupSighting Match(const TagGroup& group, const std::vector<TagDetection>& detections);

struct GroupPose {
  Rigid3 camera_from_group;
  double rms_px = 0;
};
// The pose that minimises the corners' reprojection error; nothing with fewer than four corners.
std::optional<GroupPose> LocateGroup(const Camera& camera, const GroupSighting& sighting);

}  // namespace legible
