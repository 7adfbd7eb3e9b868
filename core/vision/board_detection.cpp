#include "core/vision/board_detection.h"

#include <optional>
#include <stdexcept>

#include "core/vision/chessboard_detection.h"
#include "core/vision/tag_board_detection.h"

namespace legible {

// Exactly one of the two is there.
struct BoardDetector::Kinds {
  explicit Kinds(const Board& board) {
    if (board.tags.has_value() == board.chessboard.has_value())
      throw std::invalid_argument("BoardDetector: a board has either tags or a chessboard");
    if (board.tags) tags.emplace(*board.tags);
    if (board.chessboard) chessboard.emplace(*board.chessboard);
  }

  std::optional<TagBoardDetector> tags;
  std::optional<ChessboardDetector> chessboard;
};

BoardDetector::BoardDetector(const Board& board) : kinds_(std::make_unique<const Kinds>(board)) {}

BoardDetector::~BoardDetector() = default;

BoardSighting BoardDetector::Detect(const GrayImage& image) const {
  return kinds_->tags ? kinds_->tags->Detect(image) : kinds_->chessboard->Detect(image);
}

}  // namespace legible
