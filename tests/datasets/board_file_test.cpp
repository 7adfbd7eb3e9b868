#include "datasets/board_file.h"

#include "tests/datasets/files.h"
#include "tests/testing/matrices.h"

namespace legible {
namespace {

constexpr char kGrid[] = R"(board: tags
family: tag36h11
columns: 3
rows: 2
tag_size_m: 0.04
spacing_m: 0.01
)";

constexpr char kListed[] = R"(board: tags
name: corner of the lab
family: tag25h9
border_bits: 2
corner_squares: true
tags:
  - {id: 4, corners_m: [[0, 0], [0.03, 0], [0.03, 0.03], [0, 0.03]]}
  - {id: 2, corners_m: [[0.05, 0, 0], [0.08, 0, 0], [0.08, 0.03, 0.001], [0.05, 0.03, 0]]}
)";

constexpr char kChessboard[] = R"(board: chessboard
columns: 9
rows: 6
square_m: 0.025
)";

// As in Kalibr's own documentation, comments and all.
constexpr char kAprilgrid[] = R"(target_type: 'aprilgrid' #gridtype
tagCols: 6               #number of apriltags
tagRows: 5               #number of apriltags
tagSize: 0.088           #size of apriltag, edge to edge [m]
tagSpacing: 0.3          #ratio of space between tags to tagSize
)";

constexpr char kCheckerboard[] = R"(target_type: 'checkerboard' #gridtype
targetCols: 6               #number of internal chessboard corners
targetRows: 7               #number of internal chessboard corners
rowSpacingMeters: 0.06      #size of one chessboard square [m]
colSpacingMeters: 0.05      #size of one chessboard square [m]
)";

const Tag& TagWithId(const Board& board, int id) {
  for (const Tag& tag : board.tags->tags)
    if (tag.id == id) return tag;
  throw std::logic_error("no tag " + std::to_string(id));
}

TEST(BoardFile, CountsTagsRowByRowFromTheTopLeft) {
  const TemporaryFolder folder;
  const Board board = ReadBoard(folder.Write("wall.yaml", kGrid));
  EXPECT_EQ(board.name, "wall");
  ASSERT_TRUE(board.tags);
  EXPECT_FALSE(board.chessboard);
  EXPECT_EQ(board.tags->family, "tag36h11");
  EXPECT_EQ(board.tags->border_bits, 1);
  EXPECT_FALSE(board.tags->has_corner_squares);
  ASSERT_EQ(board.tags->tags.size(), 6u);
  const auto& first = TagWithId(board, 0).corners_m;
  EXPECT_TRUE(AreNear(first[0], Eigen::Vector3d(-0.07, 0.005, 0), 1e-12));
  EXPECT_TRUE(AreNear(first[1], Eigen::Vector3d(-0.03, 0.005, 0), 1e-12));
  EXPECT_TRUE(AreNear(first[2], Eigen::Vector3d(-0.03, 0.045, 0), 1e-12));
  EXPECT_TRUE(AreNear(first[3], Eigen::Vector3d(-0.07, 0.045, 0), 1e-12));
  EXPECT_TRUE(AreNear(TagWithId(board, 1).corners_m[0] - first[0], Eigen::Vector3d(0.05, 0, 0), 1e-12));
  EXPECT_TRUE(AreNear(TagWithId(board, 3).corners_m[0] - first[0], Eigen::Vector3d(0, -0.05, 0), 1e-12));
}

TEST(BoardFile, CountsFromTheFirstId) {
  const TemporaryFolder folder;
  const Board board = ReadBoard(folder.Write("b.yaml", std::string(kGrid) + "first_id: 581\n"));
  EXPECT_EQ(board.tags->tags.front().id, 581);
  EXPECT_EQ(board.tags->tags.back().id, 586);
}

TEST(BoardFile, ReadsListedTagsInThePlaneOrInSpace) {
  const TemporaryFolder folder;
  const Board board = ReadBoard(folder.Write("b.yaml", kListed));
  EXPECT_EQ(board.name, "corner of the lab");
  EXPECT_EQ(board.tags->border_bits, 2);
  EXPECT_TRUE(board.tags->has_corner_squares);
  ASSERT_EQ(board.tags->tags.size(), 2u);
  EXPECT_EQ(board.tags->tags[0].id, 4);
  EXPECT_EQ(board.tags->tags[0].corners_m[2], Eigen::Vector3d(0.03, 0.03, 0));
  EXPECT_EQ(board.tags->tags[1].corners_m[2], Eigen::Vector3d(0.08, 0.03, 0.001));
}

TEST(BoardFile, ReadsAChessboard) {
  const TemporaryFolder folder;
  const Board board = ReadBoard(folder.Write("b.yaml", kChessboard));
  ASSERT_TRUE(board.chessboard);
  EXPECT_FALSE(board.tags);
  EXPECT_EQ(board.chessboard->columns, 9);
  EXPECT_EQ(board.chessboard->rows, 6);
  EXPECT_EQ(board.chessboard->column_step_m, 0.025);
  EXPECT_EQ(board.chessboard->row_step_m, 0.025);
  const Board oblong = ReadBoard(folder.Write(
      "c.yaml", Replaced(kChessboard, "square_m: 0.025", "column_step_m: 0.02\nrow_step_m: 0.03")));
  EXPECT_EQ(oblong.chessboard->column_step_m, 0.02);
  EXPECT_EQ(oblong.chessboard->row_step_m, 0.03);
}

// Kalibr's origin is the bottom-left corner of tag 0, tags follow to the right and then upwards, a step is
// (1 + tagSpacing) tagSize.
TEST(BoardFile, ReadsKalibrsAprilgrid) {
  const TemporaryFolder folder;
  const Board board = ReadBoard(folder.Write("target.yaml", kAprilgrid));
  ASSERT_TRUE(board.tags);
  EXPECT_EQ(board.tags->family, "tag36h11");
  EXPECT_EQ(board.tags->border_bits, 2);
  EXPECT_TRUE(board.tags->has_corner_squares);
  ASSERT_EQ(board.tags->tags.size(), 30u);
  const Eigen::Vector3d origin = TagWithId(board, 0).corners_m[0];
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 6; ++column) {
      const Tag& tag = TagWithId(board, 6 * row + column);
      const Eigen::Vector3d expected(1.3 * 0.088 * column, 1.3 * 0.088 * row, 0);
      EXPECT_TRUE(AreNear(tag.corners_m[0] - origin, expected, 1e-12));
      EXPECT_TRUE(AreNear(tag.corners_m[2] - tag.corners_m[0], Eigen::Vector3d(0.088, 0.088, 0), 1e-12));
    }
}

TEST(BoardFile, ReadsKalibrsCheckerboard) {
  const TemporaryFolder folder;
  const Board board = ReadBoard(folder.Write("target.yaml", kCheckerboard));
  ASSERT_TRUE(board.chessboard);
  EXPECT_EQ(board.chessboard->columns, 6);
  EXPECT_EQ(board.chessboard->rows, 7);
  EXPECT_EQ(board.chessboard->column_step_m, 0.05);
  EXPECT_EQ(board.chessboard->row_step_m, 0.06);
}

std::string ComplaintOf(const TemporaryFolder& folder, const std::string& text) {
  const auto file = folder.Write("board.yaml", text);
  return InputErrorOf([&] { ReadBoard(file); });
}

TEST(BoardFile, WhatIsNoBoardIsRefused) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "board.yaml";
  EXPECT_EQ(ComplaintOf(folder, Replaced(kGrid, "board: tags", "board: circles")),
            Complaint(file, 1, "board is \"circles\"; give tags or chessboard"));
  EXPECT_EQ(
      ComplaintOf(folder, Replaced(kGrid, "family: tag36h11", "family: 36h11")),
      Complaint(file, 2,
                "family is \"36h11\", which libapriltag does not have; the nearest that it has is tag36h11"));
  EXPECT_EQ(ComplaintOf(folder, Replaced(kGrid, "spacing_m", "spacing")),
            Complaint(file, 6,
                      "the file has the unknown key \"spacing\"; the nearest known key is \"spacing_m\": "
                      "rename it or take it out"));
  EXPECT_EQ(
      ComplaintOf(folder, Replaced(kAprilgrid, "'aprilgrid'", "'circlegrid'")),
      Complaint(file, 1,
                "target_type is \"circlegrid\", which cannot be read; use an aprilgrid or a checkerboard"));
}

TEST(BoardFile, MillimetresAreRefused) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "board.yaml";
  EXPECT_EQ(ComplaintOf(folder, Replaced(kGrid, "tag_size_m: 0.04", "tag_size_m: 40")),
            Complaint(file, 5, "tag_size_m is 40 m; give metres, at most 2: it is usually in millimetres"));
  EXPECT_EQ(ComplaintOf(folder, Replaced(kChessboard, "0.025", "25")),
            Complaint(file, 4, "square_m is 25 m; give metres, at most 2: it is usually in millimetres"));
  EXPECT_EQ(ComplaintOf(folder, Replaced(kAprilgrid, "0.088", "88")),
            Complaint(file, 4, "tagSize is 88 m; give metres, at most 2: it is usually in millimetres"));
  EXPECT_EQ(
      ComplaintOf(folder,
                  Replaced(kListed, "[0.03, 0], [0.03, 0.03], [0, 0.03]", "[30, 0], [30, 30], [0, 30]")),
      Complaint(file, 7, "tags[1].corners_m are 30 m apart; give metres: they are usually in millimetres"));
}

TEST(BoardFile, ImpossibleNumbersAreRefused) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "board.yaml";
  EXPECT_EQ(ComplaintOf(folder, Replaced(kGrid, "spacing_m: 0.01", "spacing_m: 0")),
            Complaint(file, 6, "spacing_m is 0; give a number greater than 0"));
  EXPECT_EQ(ComplaintOf(folder, Replaced(kGrid, "columns: 3", "columns: 300")),
            Complaint(file, 1, "the file asks for the ids 0 to 599; tag36h11 has the ids 0 to 586"));
  EXPECT_EQ(ComplaintOf(folder, std::string(kGrid) + "border_bits: 7\n"),
            Complaint(file, 7, "border_bits is 7; give 1 to 4"));
  EXPECT_EQ(ComplaintOf(folder, Replaced(kListed, "family: tag25h9", "family: tagStandard41h12")),
            Complaint(file, 4,
                      "border_bits is 2; borders of more than a bit are for tag36h11, tag36h10, tag25h9, "
                      "tag16h5"));
  EXPECT_EQ(ComplaintOf(folder, Replaced(kChessboard, "columns: 9", "columns: 2")),
            Complaint(file, 2, "columns is 2; count the inner corners, where four squares meet: at least 3"));
  EXPECT_EQ(ComplaintOf(folder, Replaced(kChessboard, "square_m: 0.025\n", "column_step_m: 0.025\n")),
            Complaint(file, 1, "the file does not say how large a square is; give square_m"));
  EXPECT_EQ(ComplaintOf(folder, Replaced(kAprilgrid, "0.3 ", "26 ")),
            Complaint(file, 5, "tagSpacing is 26; give the gap between tags over their size, at most 1"));
}

TEST(BoardFile, ImpossibleListsAreRefused) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "board.yaml";
  EXPECT_EQ(ComplaintOf(folder, Replaced(kListed, "id: 2", "id: 4")),
            Complaint(file, 8, "tags[2] has the id 4, which is there already; keep one"));
  EXPECT_EQ(ComplaintOf(folder, Replaced(kListed, "id: 2", "id: 35")),
            Complaint(file, 8, "tags[2] has the id 35; tag25h9 has the ids 0 to 34"));
  EXPECT_EQ(ComplaintOf(folder,
                        Replaced(kListed, "[0.05, 0, 0], [0.08, 0, 0], [0.08, 0.03, 0.001], [0.05, 0.03, 0]",
                                 "[0.01, 0], [0.04, 0], [0.04, 0.03], [0.01, 0.03]")),
            Complaint(file, 8, "tags[2] overlaps the tag 4; give each tag its own place"));
  EXPECT_EQ(ComplaintOf(folder, Replaced(kListed, "[[0, 0], [0.03, 0], [0.03, 0.03], [0, 0.03]]",
                                         "[[0, 0.03], [0.03, 0.03], [0.03, 0], [0, 0]]")),
            Complaint(file, 7,
                      "tags[1].corners_m are those of a tag that is seen from behind; give bottom-left, "
                      "bottom-right, top-right, top-left of the black border, x right and y up"));
  EXPECT_EQ(ComplaintOf(folder, Replaced(kListed, "0.001]", "0.01]")),
            Complaint(file, 8, "tags[2].corners_m are 0.01 m off the plane z = 0; a board is flat"));
  EXPECT_EQ(ComplaintOf(folder, Replaced(kListed, "[0.05, 0, 0]", "[0.05]")),
            Complaint(file, 8, "tags[2].corners_m[1] has 1 values; give [x, y] or [x, y, z]"));
}

}  // namespace
}  // namespace legible
