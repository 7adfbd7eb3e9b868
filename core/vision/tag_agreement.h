// Which of the tags read in an image can be where they are, on a board of known layout.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/session/session.h"
#include "core/vision/tags.h"

namespace legible {

// The plane of a board as one tag shows it: image_from_board, px from m.
class TagPlane {
 public:
  // From the corners of a tag; the board is flat in z = 0.
  TagPlane(const std::array<Eigen::Vector3d, 4>& corners_m, const std::array<Eigen::Vector2d, 4>& corners_px);

  // Where the plane is behind the camera, coordinates are NaN.
  Eigen::Vector2d operator*(const Eigen::Vector2d& place_m) const;

 private:
  Eigen::Matrix3d image_from_board_;
};

// A tag of the board that was read.
struct ReadTag {
  size_t tag = 0;  // index in the board's tags
  std::array<Eigen::Vector2d, 4> corners_px;
};

// The largest set of read tags that are where the others predict them to be, each by its nearest ones: the
// plane of either predicts the other's corners to a quarter of their distance, which leaves room for any
// lens, but not for a tag in another's place. Indices into `read`, ascending; a single one counts only if it
// is alone.
std::vector<size_t> AgreeingTags(const std::vector<Tag>& tags, const std::vector<ReadTag>& read);

}  // namespace legible
