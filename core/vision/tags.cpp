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

#include <algorithm>
#include <cstdlib>
#include <map>
#include <opencv2/aruco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
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

// libapriltag 3.3 reads one-bit borders only; cv::aruco has the square families with any border.
cv::Ptr<cv::aruco::Dictionary> ArucoDictionary(const std::string& family) {
  static const std::map<std::string, cv::aruco::PREDEFINED_DICTIONARY_NAME> names = {
      {"tag16h5", cv::aruco::DICT_APRILTAG_16h5},
      {"tag25h9", cv::aruco::DICT_APRILTAG_25h9},
      {"tag36h10", cv::aruco::DICT_APRILTAG_36h10},
      {"tag36h11", cv::aruco::DICT_APRILTAG_36h11},
  };
  const auto found = names.find(family);
  if (found == names.end())
    throw std::invalid_argument("tags of family '" + family + "' have borders of one bit only");
  return cv::aruco::getPredefinedDictionary(found->second);
}

std::string KnownFamilies() {
  std::string known;
  for (const auto& [name, functions] : Families()) known += (known.empty() ? "" : ", ") + name;
  return known;
}

using Aruco = cv::Ptr<cv::aruco::Dictionary>;

std::vector<TagDetection> DetectByAruco(const Aruco& dictionary, int border_bits, const cv::Mat& image) {
  const auto parameters = cv::aruco::DetectorParameters::create();
  parameters->markerBorderBits = border_bits;
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
  cv::aruco::detectMarkers(image, dictionary, corners, ids, parameters);
  std::vector<TagDetection> detections;
  for (size_t i = 0; i < ids.size(); ++i) {
    TagDetection tag{ids[i], {}};
    // Clockwise there from the top-left of a picture that is turned by 180 degrees against libapriltag's.
    for (size_t corner = 0; corner < 4; ++corner) {
      const cv::Point2f& place = corners[i][(5 - corner) % 4];
      tag.corners_px[corner] = {place.x, place.y};
    }
    detections.push_back(tag);
  }
  return detections;
}

// Modules of less than some 3 px are read from a larger image only.
std::vector<TagDetection> DetectByAruco(const Aruco& dictionary, int border_bits, const GrayImage& image) {
  const cv::Mat view(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.pixels.data()));
  std::vector<TagDetection> detections = DetectByAruco(dictionary, border_bits, view);
  if (!detections.empty()) return detections;
  cv::Mat larger;
  constexpr double kScale = 2;
  cv::resize(view, larger, {}, kScale, kScale, cv::INTER_CUBIC);
  detections = DetectByAruco(dictionary, border_bits, larger);
  for (TagDetection& tag : detections)
    for (Eigen::Vector2d& corner : tag.corners_px) corner = (corner.array() + 0.5) / kScale - 0.5;
  return detections;
}

}  // namespace

struct TagDetector::Library {
  FamilyFunctions functions;
  apriltag_family_t* family;
  apriltag_detector_t* detector;
  TagDetectorOptions options;
  Aruco aruco;  // for wider borders
};

TagDetector::TagDetector(const std::string& family, const TagDetectorOptions& options) {
  const auto found = Families().find(family);
  if (found == Families().end())
    throw std::invalid_argument("tag family '" + family + "' is not one of " + KnownFamilies());
  const Aruco aruco = options.border_bits == 1 ? Aruco() : ArucoDictionary(family);
  library_ = new Library{found->second, found->second.create(), apriltag_detector_create(), options, aruco};
  library_->detector->quad_decimate = static_cast<float>(options.decimation);
  apriltag_detector_add_family(library_->detector, library_->family);
}

TagDetector::~TagDetector() {
  apriltag_detector_destroy(library_->detector);
  library_->functions.destroy(library_->family);
  delete library_;
}

std::vector<TagDetection> TagDetector::Detect(const GrayImage& image) const {
  constexpr int kSmallest_px = 16;  // libapriltag crashes on images of few pixels
  if (image.width < kSmallest_px || image.height < kSmallest_px) return {};
  if (library_->aruco) return DetectByAruco(library_->aruco, library_->options.border_bits, image);
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

TagPicture TagDetector::PictureOf(int id) const {
  apriltag_family_t* const family = library_->family;
  if (id < 0 || id >= static_cast<int>(family->ncodes))
    throw std::invalid_argument("TagDetector: the family has no tag " + std::to_string(id));
  image_u8_t* const image = apriltag_to_image(family, static_cast<uint32_t>(id));
  const int drawn_ring = (image->width - family->width_at_border) / 2;
  const int widening = library_->options.border_bits - 1;  // of the border, which libapriltag does not draw
  TagPicture picture;
  picture.ring = widening > 0 ? 0 : drawn_ring;
  picture.modules = family->width_at_border + 2 * (picture.ring + widening);
  const int first = drawn_ring - picture.ring - widening;
  const auto is_drawn = [&](int at) {
    return widening == 0 || (at >= drawn_ring && at < drawn_ring + family->width_at_border);
  };
  for (int row = first; row < first + picture.modules; ++row)
    for (int column = first; column < first + picture.modules; ++column)
      picture.is_light.push_back(is_drawn(row) && is_drawn(column) &&
                                 image->buf[row * image->stride + column] > 0);
  std::free(image->buf);  // the library does not export image_u8_destroy
  std::free(image);
  return picture;
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
