// The tags of a session's layout in images.
#pragma once

#include <map>
#include <vector>

#include "core/session/session.h"
#include "core/vision/tag_corners.h"
#include "core/vision/tags.h"

namespace legible {

// Finds the tags of a layout and fits their corners as those of a board. It needs no camera: how far a lens
// may bend the edges of a tag is allowed for. A corner that cannot be fitted (of modules less than 2 px wide,
// blurred, partly hidden, too near to the image's border) is where libapriltag has it, with the larger
// covariance of such a corner; so are those of tags of the family that the layout does not have.
// Not for use by two threads.
class LayoutTagDetector {
 public:
  // Throws std::invalid_argument for a family or an id that libapriltag does not have.
  explicit LayoutTagDetector(const TagLayout& layout);

  std::vector<TagDetection> Detect(const GrayImage& image) const;

 private:
  std::vector<ExpectedCorner> Expected(const std::vector<TagDetection>& detections) const;

  TagDetector detector_;
  std::map<int, TagPattern> patterns_;  // by id
};

}  // namespace legible
