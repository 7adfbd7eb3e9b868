#include "core/vision/board_detection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <stdexcept>

#include "tests/testing/random.h"
#include "tests/testing/render_board.h"

namespace legible {
namespace {

using testing::HasSubstr;

// focal_length: over the width.
Camera DistortedCamera(int width_px, int height_px, double focal_length = 0.86) {
  Camera camera;
  camera.width_px = width_px;
  camera.height_px = height_px;
  camera.fx_px = camera.fy_px = focal_length * width_px;
  camera.cx_px = 0.49 * width_px;
  camera.cy_px = 0.51 * height_px;
  camera.distortion << -0.22, 0.08, 0.0006, -0.0004, 0, 0, 0, 0;
  return camera;
}

Board BoardOf(TagBoard tags) { return {"tags", std::move(tags), std::nullopt}; }
Board BoardOf(const Chessboard& chessboard) { return {"chessboard", std::nullopt, chessboard}; }

// 36 tags of 40 mm.
Board PlainBoard() { return BoardOf(TagGrid("tag36h11", 6, 6, 0.04, 0.012)); }
Board KalibrBoard() { return BoardOf(KalibrGrid(6, 6, 0.04, 0.012)); }

// Tilted by up to 50 degrees, partly outside the image more often than not.
Rigid3 RandomPose(std::mt19937_64& generator, double near_m, double far_m, double spread) {
  const double depth_m = Uniform(generator, near_m, far_m);
  return BoardPose(Uniform(generator, 0, 50 * M_PI / 180), Uniform(generator, -M_PI, M_PI),
                   Uniform(generator, -M_PI, M_PI),
                   {depth_m * Uniform(generator, -spread, spread),
                    depth_m * Uniform(generator, -spread, spread), depth_m});
}

// Where the board's points are in the image.
std::vector<Eigen::Vector2d> TruePixels(const Board& board, const Camera& camera, const Rigid3& pose) {
  const std::vector<Eigen::Vector3d> points = PointsOf(board);
  std::vector<Eigen::Vector2d> pixels(points.size());
  std::transform(points.begin(), points.end(), pixels.begin(),
                 [&](const Eigen::Vector3d& point) { return Project(camera, pose * point); });
  return pixels;
}

// With the light margin that its border is seen against, a module wide.
bool IsVisible(const std::vector<Eigen::Vector2d>& pixels, size_t tag, const Camera& camera) {
  const double margin_px = (pixels[4 * tag] - pixels[4 * tag + 2]).norm() / 11 + 1;
  const Eigen::Array2d largest(camera.width_px - 1 - margin_px, camera.height_px - 1 - margin_px);
  for (size_t i = 4 * tag; i < 4 * tag + 4; ++i)
    if ((pixels[i].array() < margin_px).any() || (pixels[i].array() > largest).any()) return false;
  return true;
}

struct Statistics {
  int visible_tags = 0, found_tags = 0, points_without_a_word = 0;  // of visible tags
  int corners = 0, wrong = 0;
  double squares_px2 = 0, normalised_squares = 0;
  std::map<std::string, int> reasons;

  double Rms_px() const { return std::sqrt(squares_px2 / (2 * corners)); }
  double Normalised() const { return normalised_squares / (2 * corners); }
};

void AddErrors(const std::vector<Eigen::Vector2d>& truth, const BoardSighting& sighting,
               Statistics& statistics) {
  for (const BoardCorner& corner : sighting.corners) {
    const Eigen::Vector2d error = corner.pixel - truth[static_cast<size_t>(corner.point)];
    statistics.wrong += error.norm() > 1;
    statistics.squares_px2 += error.squaredNorm();
    statistics.normalised_squares += error.dot(corner.covariance_px2.inverse() * error);
    ++statistics.corners;
  }
}

void AddTags(const std::vector<Eigen::Vector2d>& truth, const Camera& camera, const BoardSighting& sighting,
             Statistics& statistics) {
  std::set<int> found, named;
  for (const BoardCorner& corner : sighting.corners) found.insert(corner.point);
  for (const LeftOut& left_out : sighting.left_out) {
    named.insert(left_out.points.begin(), left_out.points.end());
    ++statistics.reasons[left_out.reason];
  }
  for (size_t tag = 0; 4 * tag < truth.size(); ++tag) {
    if (!IsVisible(truth, tag, camera)) continue;
    int corners = 0;
    for (int point = static_cast<int>(4 * tag); point < static_cast<int>(4 * tag + 4); ++point) {
      corners += static_cast<int>(found.count(point));
      statistics.points_without_a_word += !found.contains(point) && !named.contains(point);
    }
    ++statistics.visible_tags;
    statistics.found_tags += corners == 4;
  }
}

std::ostream& operator<<(std::ostream& stream, const Statistics& statistics) {
  stream << "tags " << statistics.found_tags << " of " << statistics.visible_tags << ", corners "
         << statistics.corners << ", rms " << statistics.Rms_px() << " px, normalised squares "
         << statistics.Normalised() << ", wrong " << statistics.wrong;
  for (const auto& [reason, count] : statistics.reasons) stream << "\n  " << count << " times: " << reason;
  return stream;
}

// In images of 1280 x 960 at a blur of 0.8 px and a noise of 2 grey levels.
void ExpectTagsAreFound(const Board& board, double largest_rms_px) {
  constexpr int kImages = 10;  // a distance
  std::mt19937_64 generator = TestGenerator();
  const BoardDetector detector(board);
  Statistics all;
  // Tags of some 110, 60 and 50 px, tilted ones half as high: modules of no less than the 2 px that it
  // takes.
  for (const double distance_m : {0.47, 0.82, 1.0}) {  // for a lens as long as the image is wide
    Statistics statistics;
    for (int i = 0; i < kImages; ++i) {
      const double focal_length = i % 2 == 0 ? 0.86 : 0.6;  // every second lens is a wide one
      const double depth_m = focal_length * distance_m;
      const Camera camera = DistortedCamera(1280, 960, focal_length);
      const Rigid3 pose = RandomPose(generator, 0.9 * depth_m, 1.1 * depth_m, 0.3 / focal_length);
      const GrayImage image = WithNoise(RenderBoard(board, camera, pose), 2, generator);
      const BoardSighting sighting = detector.Detect(image);
      const std::vector<Eigen::Vector2d> truth = TruePixels(board, camera, pose);
      for (Statistics* one : {&statistics, &all}) {
        AddErrors(truth, sighting, *one);
        AddTags(truth, camera, sighting, *one);
      }
    }
    std::cout << distance_m << ": " << statistics << std::endl;
  }
  std::cout << "all: " << all << std::endl;
  EXPECT_GE(all.found_tags, 0.99 * all.visible_tags);
  EXPECT_EQ(all.points_without_a_word, 0);
  EXPECT_EQ(all.wrong, 0);
  EXPECT_LT(all.Rms_px(), largest_rms_px);
  EXPECT_GT(all.Normalised(), 0.9);
  EXPECT_LT(all.Normalised(), 1.15);
}

TEST(BoardDetector, FindsPlainTagsWithTheirErrors) { ExpectTagsAreFound(PlainBoard(), 0.03); }

TEST(BoardDetector, FindsKalibrsTagsWithTheirErrors) { ExpectTagsAreFound(KalibrBoard(), 0.015); }

TEST(BoardDetector, FindsChessboardsWithTheirErrors) {
  std::mt19937_64 generator = TestGenerator();
  const Camera camera = DistortedCamera(1280, 960);
  const Board board = BoardOf(Chessboard{9, 6, 0.03, 0.025});
  const BoardDetector detector(board);
  Statistics statistics;
  constexpr int kImages = 16;
  for (int i = 0; i < kImages; ++i) {
    const Rigid3 pose = RandomPose(generator, 0.5, 1.6, 0.08);
    const BoardSighting sighting = detector.Detect(WithNoise(RenderBoard(board, camera, pose), 2, generator));
    AddErrors(TruePixels(board, camera, pose), sighting, statistics);
  }
  std::cout << statistics << std::endl;
  EXPECT_GE(statistics.corners, 0.99 * kImages * 54);
  EXPECT_EQ(statistics.wrong, 0);  // however the board is rolled: 9 + 6 is odd
  EXPECT_LT(statistics.Rms_px(), 0.015);
  EXPECT_GT(statistics.Normalised(), 0.85);
  EXPECT_LT(statistics.Normalised(), 1.2);
}

// A small image of a board, and what is found in it.
struct View {
  Camera camera = DistortedCamera(640, 480);
  Rigid3 pose = BoardPose(0.4, 0.7, 0.3, {0.005, -0.005, 0.5});
  GrayImage image;

  View(const Board& printed, std::mt19937_64& generator)
      : image(WithNoise(RenderBoard(printed, camera, pose), 2, generator)) {}

  // Paints over the surroundings of a place of the board.
  void Cover(const Eigen::Vector3d& place_m, int half_px) {
    const Eigen::Vector2d middle = Project(camera, pose * place_m);
    for (int y = static_cast<int>(middle.y()) - half_px; y <= middle.y() + half_px; ++y)
      for (int x = static_cast<int>(middle.x()) - half_px; x <= middle.x() + half_px; ++x)
        image.pixels[static_cast<size_t>(y * image.width + x)] = 90;
  }
};

std::set<int> PointsOf(const BoardSighting& sighting) {
  std::set<int> points;
  for (const BoardCorner& corner : sighting.corners) points.insert(corner.point);
  return points;
}

// The reason for which something was left out, or none.
std::string ReasonFor(const std::string& what, const BoardSighting& sighting) {
  for (const LeftOut& left_out : sighting.left_out)
    if (left_out.what == what) return left_out.reason;
  return "";
}

double LargestError_px(const Board& board, const View& view, const BoardSighting& sighting) {
  const std::vector<Eigen::Vector2d> truth = TruePixels(board, view.camera, view.pose);
  double largest = 0;
  for (const BoardCorner& corner : sighting.corners)
    largest = std::max(largest, (corner.pixel - truth[static_cast<size_t>(corner.point)]).norm());
  return largest;
}

Board SmallBoard() { return BoardOf(TagGrid("tag36h11", 4, 3, 0.05, 0.015)); }

TEST(BoardDetector, FindsEveryFamily) {
  std::mt19937_64 generator = TestGenerator();
  for (const char* family :
       {"tag16h5", "tag25h9", "tag36h10", "tag36h11", "tagCircle21h7", "tagStandard41h12"}) {
    const Board board = BoardOf(TagGrid(family, 3, 2, 0.06, 0.06));
    const View view(board, generator);
    const BoardSighting sighting = BoardDetector(board).Detect(view.image);
    EXPECT_EQ(sighting.corners.size(), 24u) << family;
    EXPECT_LT(LargestError_px(board, view, sighting), 0.1) << family;
  }
}

TEST(BoardDetector, FindsTagsOfAnySizeAndTurn) {
  std::mt19937_64 generator = TestGenerator();
  TagBoard tags = TagGrid("tag36h11", 3, 2, 0.06, 0.05);
  for (size_t i = 0; i < tags.tags.size(); ++i) {
    const Eigen::Vector3d middle = (tags.tags[i].corners_m[0] + tags.tags[i].corners_m[2]) / 2;
    const Eigen::Quaterniond turn = RotationFromVector({0, 0, 1.1 * static_cast<double>(i)});
    for (Eigen::Vector3d& corner : tags.tags[i].corners_m)
      corner = middle + (1 - 0.08 * static_cast<double>(i)) * (turn * (corner - middle));
  }
  const Board board = BoardOf(tags);
  const View view(board, generator);
  const BoardSighting sighting = BoardDetector(board).Detect(view.image);
  EXPECT_EQ(sighting.corners.size(), 24u);
  EXPECT_LT(LargestError_px(board, view, sighting), 0.1);
}

TEST(BoardDetector, LeavesOutTagsInEachOthersPlaces) {
  std::mt19937_64 generator = TestGenerator();
  TagBoard printed = *SmallBoard().tags;
  std::swap(printed.tags[1].id, printed.tags[10].id);
  const View view(BoardOf(printed), generator);
  const Board board = SmallBoard();
  const BoardSighting sighting = BoardDetector(board).Detect(view.image);
  EXPECT_EQ(sighting.corners.size(), 40u);
  EXPECT_LT(LargestError_px(board, view, sighting), 0.15);
  EXPECT_THAT(ReasonFor("tag 1", sighting), HasSubstr("contradicts"));
  EXPECT_THAT(ReasonFor("tag 10", sighting), HasSubstr("contradicts"));
}

TEST(BoardDetector, NamesTagsOfAnotherBoard) {
  std::mt19937_64 generator = TestGenerator();
  const View view(SmallBoard(), generator);
  TagBoard board = *SmallBoard().tags;
  board.tags.erase(board.tags.begin() + 5);
  const BoardSighting sighting = BoardDetector(BoardOf(board)).Detect(view.image);
  EXPECT_EQ(sighting.corners.size(), 44u);
  EXPECT_THAT(ReasonFor("tag 5", sighting), HasSubstr("not among the board's tags"));
}

TEST(BoardDetector, NamesACoveredTag) {
  std::mt19937_64 generator = TestGenerator();
  const Board board = SmallBoard();
  View view(board, generator);
  const auto& corners_m = board.tags->tags[6].corners_m;
  view.Cover((corners_m[0] + corners_m[2]) / 2, 30);
  const BoardSighting sighting = BoardDetector(board).Detect(view.image);
  EXPECT_EQ(sighting.corners.size(), 44u);
  EXPECT_THAT(ReasonFor("tag 6", sighting), HasSubstr("was not found"));
  EXPECT_TRUE(PointsOf(sighting).contains(4 * 5));
  EXPECT_FALSE(PointsOf(sighting).contains(4 * 6));
}

// A smudge at the corner that the detector of tags does not mind.
TEST(BoardDetector, NamesADirtyCorner) {
  std::mt19937_64 generator = TestGenerator();
  const Board board = SmallBoard();
  View view(board, generator);
  view.Cover(board.tags->tags[6].corners_m[1], 2);
  const BoardSighting sighting = BoardDetector(board).Detect(view.image);
  EXPECT_FALSE(PointsOf(sighting).contains(4 * 6 + 1));
  EXPECT_FALSE(ReasonFor("the bottom-right corner of tag 6", sighting).empty() &&
               ReasonFor("tag 6", sighting).empty());
  EXPECT_GE(sighting.corners.size(), 44u);
}

TEST(BoardDetector, SaysThatThereIsNoBoard) {
  const GrayImage grey{320, 240, std::vector<std::uint8_t>(320 * 240, 100)};
  for (const Board& board : {SmallBoard(), KalibrBoard(), BoardOf(Chessboard{5, 4, 0.03, 0.03})}) {
    const BoardSighting sighting = BoardDetector(board).Detect(grey);
    EXPECT_TRUE(sighting.corners.empty());
    ASSERT_EQ(sighting.left_out.size(), 1u);
    EXPECT_EQ(sighting.left_out[0].what, "the board");
    EXPECT_EQ(sighting.left_out[0].points.size(), PointsOf(board).size());
  }
}

TEST(BoardDetector, AChessboardCountsOnlyAsAWhole) {
  std::mt19937_64 generator = TestGenerator();
  const Board board = BoardOf(Chessboard{6, 5, 0.03, 0.03});
  View view(board, generator);
  EXPECT_EQ(BoardDetector(board).Detect(view.image).corners.size(), 30u);
  view.Cover(PointsOf(board)[0], 30);
  const BoardSighting sighting = BoardDetector(board).Detect(view.image);
  EXPECT_TRUE(sighting.corners.empty());
  EXPECT_THAT(ReasonFor("the board", sighting), HasSubstr("only as a whole"));
}

// Nothing tells one end of such a board from the other: the points are right, or those of the board turned by
// half.
TEST(BoardDetector, AChessboardWithoutAnEndIsRightUpToHalfATurn) {
  std::mt19937_64 generator = TestGenerator();
  const Board board = BoardOf(Chessboard{6, 4, 0.03, 0.03});
  View view(board, generator);
  const BoardSighting sighting = BoardDetector(board).Detect(view.image);
  ASSERT_EQ(sighting.corners.size(), 24u);
  const double error_px = LargestError_px(board, view, sighting);
  view.pose = view.pose * Rigid3{RotationFromVector({0, 0, M_PI}), Eigen::Vector3d::Zero()};
  EXPECT_LT(std::min(error_px, LargestError_px(board, view, sighting)), 0.1);
}

TEST(BoardDetector, RejectsWhatIsNoBoard) {
  EXPECT_THROW(BoardDetector(Board{}), std::invalid_argument);
  EXPECT_THROW(BoardDetector(BoardOf(TagBoard{"tag36h11", 1, false, {}})), std::invalid_argument);
  EXPECT_THROW(BoardDetector(BoardOf(TagBoard{"tagStandard41h12", 2, false, SmallBoard().tags->tags})),
               std::invalid_argument);
  EXPECT_THROW(BoardDetector(BoardOf(Chessboard{2, 5, 0.03, 0.03})), std::invalid_argument);
}

}  // namespace
}  // namespace legible
