#include "tests/testing/render_board.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h10.h>
#include <apriltag/tag36h11.h>
#include <apriltag/tagCircle21h7.h>
#include <apriltag/tagCustom48h12.h>
#include <apriltag/tagStandard41h12.h>
#include <apriltag/tagStandard52h13.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <opencv2/aruco.hpp>
#include <stdexcept>

namespace legible {
namespace {

// Of one pixel a module, row by row from the top; the black (or white) border's outer edge is `ring` modules
// inside the picture.
struct TagPicture {
  int modules = 0, ring = 0;
  std::vector<bool> is_light;

  int ModulesOfBorder() const { return modules - 2 * ring; }
};

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
      {"tagCustom48h12", {tagCustom48h12_create, tagCustom48h12_destroy}},
      {"tagStandard41h12", {tagStandard41h12_create, tagStandard41h12_destroy}},
      {"tagStandard52h13", {tagStandard52h13_create, tagStandard52h13_destroy}},
  };
  return families;
}

TagPicture DrawnByLibapriltag(const std::string& family_name, int id) {
  const FamilyFunctions& functions = Families().at(family_name);
  apriltag_family_t* family = functions.create();
  image_u8_t* image = apriltag_to_image(family, static_cast<uint32_t>(id));
  TagPicture picture{image->width, (image->width - family->width_at_border) / 2, {}};
  for (int row = 0; row < image->height; ++row)
    for (int column = 0; column < image->width; ++column)
      picture.is_light.push_back(image->buf[row * image->stride + column] > 0);
  std::free(image->buf);  // the library does not export image_u8_destroy
  std::free(image);
  functions.destroy(family);
  return picture;
}

TagPicture DrawnByAruco(int id, int border_bits) {
  const int modules = 6 + 2 * border_bits;
  cv::Mat image;
  cv::aruco::drawMarker(cv::aruco::getPredefinedDictionary(cv::aruco::DICT_APRILTAG_36h11), id, modules,
                        image, border_bits);
  TagPicture picture{modules, 0, {}};
  for (int row = modules - 1; row >= 0; --row)  // upside down, compared with libapriltag and Kalibr
    for (int column = modules - 1; column >= 0; --column)
      picture.is_light.push_back(image.at<std::uint8_t>(row, column) > 0);
  return picture;
}

// What is printed at places of the board's plane (m): light or dark, or nothing beyond its margin.
class Print {
 public:
  virtual ~Print() = default;
  virtual bool IsLight(const Eigen::Vector2d& place_m) const = 0;
};

class TagPrint : public Print {
 public:
  explicit TagPrint(const TagBoard& board) {
    for (const Tag& tag : board.tags) {
      const Eigen::Vector2d corner = tag.corners_m[0].head<2>();
      Eigen::Matrix2d sides;
      sides << tag.corners_m[1].head<2>() - corner, tag.corners_m[3].head<2>() - corner;
      tags_.push_back({corner, sides.inverse(),
                       board.border_bits == 1 ? DrawnByLibapriltag(board.family, tag.id)
                                              : DrawnByAruco(tag.id, board.border_bits)});
      bucket_m_ = std::max(bucket_m_, 2 * sides.colwise().norm().maxCoeff());
    }
    if (board.has_corner_squares) square_ = SmallestGap(board);
    for (size_t i = 0; i < tags_.size(); ++i) {
      const Eigen::Vector2d middle = (board.tags[i].corners_m[0] + board.tags[i].corners_m[2]).head<2>() / 2;
      for (int dx = -1; dx <= 1; ++dx)
        for (int dy = -1; dy <= 1; ++dy)
          near_[BucketOf(middle + bucket_m_ / 2 * Eigen::Vector2d(dx, dy))].push_back(i);
    }
  }

  bool IsLight(const Eigen::Vector2d& place_m) const override {
    const auto bucket = near_.find(BucketOf(place_m));
    if (bucket == near_.end()) return true;
    return std::all_of(bucket->second.begin(), bucket->second.end(),
                       [&](size_t i) { return IsLight(tags_[i], place_m); });
  }

 private:
  struct PlacedTag {
    Eigen::Vector2d corner_m;  // bottom-left
    Eigen::Matrix2d sides_from_m;
    TagPicture picture;
  };

  static double SmallestGap(const TagBoard& board) {
    const double side_m = (board.tags[0].corners_m[1] - board.tags[0].corners_m[0]).norm();
    double nearest_m = std::numeric_limits<double>::infinity();
    for (size_t i = 1; i < board.tags.size(); ++i)
      nearest_m = std::min(nearest_m, (board.tags[i].corners_m[0] - board.tags[0].corners_m[0]).norm());
    return nearest_m / side_m - 1;
  }

  std::pair<int, int> BucketOf(const Eigen::Vector2d& place_m) const {
    return {static_cast<int>(std::floor(place_m.x() / bucket_m_)),
            static_cast<int>(std::floor(place_m.y() / bucket_m_))};
  }

  bool IsLight(const PlacedTag& tag, const Eigen::Vector2d& place_m) const {
    const Eigen::Vector2d sides = tag.sides_from_m * (place_m - tag.corner_m);
    const Eigen::Vector2d outside = (-sides).cwiseMax(sides - Eigen::Vector2d::Ones());
    if (outside.minCoeff() > 0 && outside.maxCoeff() < square_) return false;
    const int border = tag.picture.ModulesOfBorder();
    const double column = sides.x() * border + tag.picture.ring,
                 row = (1 - sides.y()) * border + tag.picture.ring;
    if (std::min(column, row) < 0 || std::max(column, row) >= tag.picture.modules) return true;
    return tag.picture.is_light[static_cast<size_t>(row) * static_cast<size_t>(tag.picture.modules) +
                                static_cast<size_t>(column)];
  }

  std::vector<PlacedTag> tags_;
  double square_ = 0;  // side of the corner squares over the tags'
  double bucket_m_ = 0;
  std::map<std::pair<int, int>, std::vector<size_t>> near_;  // tags that may cover a bucket
};

class ChessboardPrint : public Print {
 public:
  explicit ChessboardPrint(const Chessboard& board) : board_(board) {}

  bool IsLight(const Eigen::Vector2d& place_m) const override {
    const double column = place_m.x() / board_.column_step_m + 0.5 * (board_.columns + 1),
                 row = 0.5 * (board_.rows + 1) - place_m.y() / board_.row_step_m;
    if (std::min(column, row) < 0 || column >= board_.columns + 1 || row >= board_.rows + 1) return true;
    return (static_cast<int>(column) + static_cast<int>(row)) % 2 == 1;
  }

 private:
  Chessboard board_;
};

class BoardScene : public RenderedScene {
 public:
  BoardScene(const Board& board, const Rigid3& camera_from_board, const BoardLook& look)
      : board_from_camera_(Inverse(camera_from_board)), look_(look) {
    if (board.tags)
      print_ = std::make_unique<TagPrint>(*board.tags);
    else
      print_ = std::make_unique<ChessboardPrint>(board.chessboard.value());
    for (const Eigen::Vector3d& point : PointsOf(board)) extent_m_.extend(point.head<2>());
    const Eigen::Vector2d margin = Margin_m(board);
    extent_m_ = {extent_m_.min() - margin, extent_m_.max() + margin};
  }

  double Brightness(const Eigen::Vector2d& x) const override {
    const Eigen::Vector3d direction = board_from_camera_.rotation * x.homogeneous();
    const double depth = -board_from_camera_.translation.z() / direction.z();
    if (!(depth > 0)) return look_.around;
    const Eigen::Vector2d place_m = (board_from_camera_.translation + depth * direction).head<2>();
    if (!extent_m_.contains(place_m)) return look_.around;
    return print_->IsLight(place_m) ? look_.light : look_.dark;
  }

  // Looks along an outline half as large again as the pixel: what is printed there is larger than a pixel.
  bool VariesInPixel(const Eigen::Vector2d& x, double pixel) const override {
    constexpr int kSteps = 4;
    const double middle = Brightness(x), step = 1.5 * pixel / kSteps, half = 0.75 * pixel;
    for (int i = 0; i < kSteps; ++i) {
      const double along = i * step - half;
      for (const Eigen::Vector2d& offset : {Eigen::Vector2d(along, -half), Eigen::Vector2d(half, along),
                                            Eigen::Vector2d(-along, half), Eigen::Vector2d(-half, -along)})
        if (Brightness(x + offset) != middle) return true;
    }
    return false;
  }

 private:
  // As wide as a square of a chessboard besides the outer ones, or half a tag.
  static Eigen::Vector2d Margin_m(const Board& board) {
    if (board.chessboard)
      return 1.7 * Eigen::Vector2d(board.chessboard->column_step_m, board.chessboard->row_step_m);
    const Tag& tag = board.tags->tags[0];
    return Eigen::Vector2d::Constant((tag.corners_m[1] - tag.corners_m[0]).norm() / 2);
  }

  Rigid3 board_from_camera_;
  BoardLook look_;
  std::unique_ptr<Print> print_;
  Eigen::AlignedBox2d extent_m_;
};

Tag SquareTag(int id, double left_m, double bottom_m, double side_m) {
  const double right_m = left_m + side_m, top_m = bottom_m + side_m;
  return {id,
          {Eigen::Vector3d(left_m, bottom_m, 0),
           {right_m, bottom_m, 0},
           {right_m, top_m, 0},
           {left_m, top_m, 0}}};
}

}  // namespace

CleanImage RenderBoard(const Board& board, const Camera& camera, const Rigid3& camera_from_board,
                       const BoardLook& look) {
  return RenderScene(BoardScene(board, camera_from_board, look), camera, look.around, look.blur_px);
}

TagBoard TagGrid(const std::string& family, int columns, int rows, double tag_m, double gap_m) {
  TagBoard board;
  board.family = family;
  const double step_m = tag_m + gap_m;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      board.tags.push_back(SquareTag(row * columns + column, (column - 0.5 * columns) * step_m + gap_m / 2,
                                     (0.5 * rows - row - 1) * step_m + gap_m / 2, tag_m));
  return board;
}

TagBoard KalibrGrid(int columns, int rows, double tag_m, double gap_m) {
  TagBoard board = TagGrid("tag36h11", columns, rows, tag_m, gap_m);
  board.border_bits = 2;
  board.has_corner_squares = true;
  for (Tag& tag : board.tags) tag.id = (rows - 1 - tag.id / columns) * columns + tag.id % columns;
  return board;
}

Rigid3 BoardPose(double tilt_rad, double direction_rad, double roll_rad,
                 const Eigen::Vector3d& middle_in_camera) {
  const Eigen::Quaterniond facing(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  const Eigen::Vector3d axis(std::cos(direction_rad), std::sin(direction_rad), 0);
  return {RotationFromVector(tilt_rad * axis) * facing * RotationFromVector({0, 0, roll_rad}),
          middle_in_camera};
}

}  // namespace legible
