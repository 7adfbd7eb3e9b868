#include "datasets/corner_file.h"

#include <fmt/format.h>

#include "tests/datasets/files.h"

namespace legible {
namespace {

using testing::HasSubstr;

Board Chessboard3x2() { return {"board", std::nullopt, Chessboard{3, 2, 0.02, 0.02}}; }

Board TwoTags() {
  TagBoard tags;
  tags.family = "tag36h11";
  tags.tags = {Tag{7, {}}, Tag{9, {}}};
  return {"board", tags, std::nullopt};
}

class CornerFile : public testing::Test {
 protected:
  std::vector<ReadView> Read(const std::string& text, const Board& board = Chessboard3x2(),
                             bool counts_alike = false) const {
    return ReadCorners(folder_.Write("corners.csv", text), board, counts_alike);
  }
  void ExpectRefusal(const std::string& text, const std::string& message,
                     const Board& board = Chessboard3x2()) const {
    try {
      Read(text, board);
      ADD_FAILURE() << "taken: " << text;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(message));
    }
  }
  TemporaryFolder folder_;
};

TEST_F(CornerFile, HoldsViewsInTheOrderOfTheirFirstRows) {
  const auto views = Read("view,column,row,x_px,y_px\nb,0,0,10,20\na,2,1,30,40\nb,1,0,11,21\n");
  ASSERT_EQ(views.size(), 2u);
  EXPECT_EQ(views[0].view.name, "b");
  ASSERT_EQ(views[0].view.corners.size(), 2u);
  EXPECT_EQ(views[0].view.corners[1].point, 1);
  EXPECT_EQ(views[1].view.corners[0].point, 5);
  EXPECT_EQ(views[1].view.corners[0].pixel, Eigen::Vector2d(30, 40));
}

TEST_F(CornerFile, HasTheCornersOfAViewByPointWhateverTheOrderOfItsRows) {
  const auto views = Read("view,column,row,x_px,y_px\na,1,1,4,4\na,2,0,2,2\na,0,1,3,3\na,0,0,0,0\n");
  std::vector<int> points;
  for (const BoardCorner& corner : views[0].view.corners) points.push_back(corner.point);
  EXPECT_EQ(points, (std::vector<int>{0, 2, 3, 4}));
  EXPECT_EQ(views[0].view.corners[2].pixel, Eigen::Vector2d(3, 3));
}

TEST_F(CornerFile, NamesTagsByTheirIds) {
  const auto views = Read("view,tag,corner,x_px,y_px\na,9,2,1,2\n", TwoTags());
  EXPECT_EQ(views[0].view.corners[0].point, 6);
}

TEST_F(CornerFile, GivesSigmaOrWeightAndLeavesOutWhatIsMarked) {
  const std::string text = "view,column,row,x_px,y_px,weight\na,0,0,1,1,0.5\na,1,0,2,2,-1\n";
  const auto views = Read(text);
  ASSERT_EQ(views[0].view.corners.size(), 1u);
  EXPECT_EQ(views[0].view.corners[0].covariance_px2(0, 0), 4);
  ASSERT_EQ(views[0].left_out.size(), 1u);
  EXPECT_EQ(views[0].left_out[0].points, std::vector<int>{1});
  EXPECT_EQ(Read(text, Chessboard3x2(), true)[0].view.corners.size(), 2u);
  const auto sigmas = Read("view,column,row,x_px,y_px,sigma_px\na,0,0,1,1,0.2\n");
  EXPECT_NEAR(sigmas[0].view.corners[0].covariance_px2(1, 1), 0.04, 1e-15);
}

TEST_F(CornerFile, RefusesWhatIsNoTableOfCornersOfThisBoard) {
  ExpectRefusal("view,column,row,x_px\na,0,0,1\n", "corners.csv:1: column y_px is missing");
  ExpectRefusal("view,column,row,x_px,y_px\n", "no corner");
  ExpectRefusal("view,column,row,x_px,y_px\na,3,0,1,1\n",
                "corners.csv:2: column is 3, and the board has column 0 to 2");
  ExpectRefusal("view,column,row,x_px,y_px\na,0,2,1,1\n", "row is 2, and the board has row 0 to 1");
  ExpectRefusal("view,column,row,x_px,y_px\na,0,0,nan,1\n", "x_px is \"nan\"");
  ExpectRefusal("view,column,row,x_px,y_px\na,0,0,1,1\na,0,0,2,2\n",
                "corners.csv:3: is a corner that this view has already");
  ExpectRefusal("view,column,row,x_px,y_px,sigma_px\na,0,0,1,1,0\n", "sigma_px is 0");
  ExpectRefusal("view,column,row,x_px,y_px,weight\na,0,0,1,1,1e-200\n", "corners.csv:2: weight is 1e-200");
  ExpectRefusal("view,column,row,x_px,y_px\n,0,0,1,1\n", "view is empty");
  ExpectRefusal("view,tag,corner,x_px,y_px\na,8,0,1,1\n", "tag is 8, which the board does not have",
                TwoTags());
}

}  // namespace
}  // namespace legible
