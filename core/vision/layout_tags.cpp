#include "core/vision/layout_tags.h"

#include <algorithm>

namespace legible {

LayoutTagDetector::LayoutTagDetector(const TagLayout& layout) : detector_(layout.family) {
  for (const TagGroup& group : layout.groups)
    for (const Tag& tag : group.tags)
      patterns_[tag.id] = PatternOf(tag, group.tags, detector_.PictureOf(tag.id), {});
}

std::vector<TagDetection> LayoutTagDetector::Detect(const GrayImage& image) const {
  std::vector<TagDetection> detections = detector_.Detect(image);
  const auto foreign =
      std::stable_partition(detections.begin(), detections.end(),
                            [&](const TagDetection& one) { return patterns_.contains(one.id); });
  std::vector<TagDetection> own(detections.begin(), foreign);
  // Fitted corners say better where the next lines are, and all of them what the blur is.
  const std::vector<CornerFit> rough = FitCorners(image, Expected(own), kDetectedSigma_px, {});
  for (size_t i = 0; i < own.size(); ++i) own[i].corners_px = Refined(own[i].corners_px, &rough[4 * i]);
  const std::vector<ExpectedCorner> expected = Expected(own);
  const std::vector<CornerFit> fits = FitCorners(image, expected, kFittedSigma_px, ExpectationsFrom(rough));
  for (const BoardCorner& corner : SightingOf(expected, fits, [](int) { return ""; }).corners) {
    TagDetection& detection = detections[static_cast<size_t>(corner.point) / 4];
    detection.corners_px[static_cast<size_t>(corner.point) % 4] = corner.pixel;
    detection.covariances_px2[static_cast<size_t>(corner.point) % 4] = corner.covariance_px2;
  }
  return detections;
}

// Point 4 i + c is corner c of detection i.
std::vector<ExpectedCorner> LayoutTagDetector::Expected(const std::vector<TagDetection>& detections) const {
  std::vector<ExpectedCorner> expected;
  expected.reserve(4 * detections.size());
  for (const TagDetection& one : detections)
    for (const ExpectedCorner& corner :
         ExpectedCornersOf(patterns_.at(one.id), one.corners_px, static_cast<int>(expected.size())))
      expected.push_back(corner);
  return expected;
}

}  // namespace legible
