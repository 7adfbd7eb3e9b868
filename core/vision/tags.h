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

// Of a coordinate of a corner as libapriltag has it: 0.05 px in clean images, more where light is uneven.
inline constexpr double kLibraryCornerSigma_px = 0.1;

struct TagDetection {
  int id = 0;
  // px, centre of the top-left pixel at (0, 0): bottom-left, bottom-right, top-right, top-left of the black
  // border.
  std::array<Eigen::Vector2d, 4> corners_px;
  // Of each corner; up to a factor that all corners share.
  std::array<Eigen::Matrix2d, 4> covariances_px2 = LibraryCovariances_px2();

  static std::array<Eigen::Matrix2d, 4> LibraryCovariances_px2() {
    std::array<Eigen::Matrix2d, 4> covariances;
    covariances.fill(kLibraryCornerSigma_px * kLibraryCornerSigma_px * Eigen::Matrix2d::Identity());
    return covariances;
  }
};

struct TagDetectorOptions {
  double decimation =
      2;  // outlines are looked for in an image that is smaller by this; 1 finds the smallest tags
  int border_bits = 1;  // width of the border in the tag's own bits
};

// What is printed of a tag, module by module, row by row from the top, with the ring of modules outside the
// border that belong to it.
struct TagPicture {
  int modules = 0;  // across the picture
  int ring = 0;     // modules outside the border's outer edge
  std::vector<bool> is_light;
};

// Finds tags of one family. Holds the library's detector, which is costly to make; not for use by two
// threads. Corners are the library's own; see LayoutTagDetector for better ones.
class TagDetector {
 public:
  // Throws std::invalid_argument for a family that libapriltag does not have, and for wider borders about
  // other tags than those of tag16h5, tag25h9, tag36h10 and tag36h11.
  explicit TagDetector(const std::string& family, const TagDetectorOptions& options = {});
  ~TagDetector();
  TagDetector(const TagDetector&) = delete;
  TagDetector& operator=(const TagDetector&) = delete;

  std::vector<TagDetection> Detect(const GrayImage& image) const;

  // Throws std::invalid_argument for an id that the family does not have.
  TagPicture PictureOf(int id) const;

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
