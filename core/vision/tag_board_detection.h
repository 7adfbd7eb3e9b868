// A board of tags in images.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/session/board.h"
#include "core/vision/board_corners.h"
#include "core/vision/gray_image.h"
#include "core/vision/tag_agreement.h"
#include "core/vision/tag_corners.h"
#include "core/vision/tags.h"

namespace legible {

// See BoardDetector.
class TagBoardDetector {
 public:
  // Throws std::invalid_argument as BoardDetector does.
  explicit TagBoardDetector(const TagBoard& board);

  BoardSighting Detect(const GrayImage& image) const;

 private:
  // Tags, and what is left out besides.
  struct Reading {
    std::vector<ReadTag> tags;
    std::vector<LeftOut> left_out;
  };

  Reading OwnTags(const std::vector<TagDetection>& detections) const;
  std::string WhyNotFound(const Reading& own) const;
  Reading Agreeing(const std::vector<ReadTag>& read) const;
  Reading WithOthers(const GrayImage& image, std::vector<ReadTag> whole, const std::vector<ReadTag>& partial,
                     const CornerExpectations& expected) const;
  std::optional<ReadTag> LookFor(const GrayImage& image, const ReadTag& predicted,
                                 const CornerExpectations& expected) const;
  std::array<Eigen::Vector2d, 4> PredictedByNearest(size_t tag, const std::vector<ReadTag>& read) const;
  double Likeness(const GrayImage& image, const ReadTag& read) const;
  std::vector<ExpectedCorner> Expected(const std::vector<ReadTag>& read) const;
  LeftOut Named(const ReadTag& read, const std::string& reason) const;

  TagBoard board_;
  TagDetector detector_;
  std::map<int, size_t> index_by_id_;
  std::vector<TagPattern> patterns_;  // of the board's tags
};

}  // namespace legible
