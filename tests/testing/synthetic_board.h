// Views of a board as a camera would see them, without images.
#pragma once

#include <random>
#include <vector>

#include "core/geometry/camera.h"
#include "core/geometry/rigid3.h"
#include "core/session/board.h"

namespace legible {

struct SyntheticBoardViews {
  std::vector<BoardView> views;
  std::vector<Rigid3> camera_from_board;  // the truth
};

struct SyntheticBoardOptions {
  int views = 20;
  double noise_px = 0;       // 1 sigma of each coordinate of each corner
  double outlier_share = 0;  // of the corners, anywhere within 50 px
  double largest_tilt_rad = 0.7;
  double distance_sizes =
      1.6;  // of the board from the camera, in sizes of the board, for fx = the image's width
};

// Boards about the middle of the image, tilted and turned at random; corners outside the image are not seen.
SyntheticBoardViews SeeBoard(std::mt19937_64& generator, const Camera& camera,
                             const std::vector<Eigen::Vector3d>& points_in_board_m,
                             const SyntheticBoardOptions& options);

// 1280 x 960, fx 1250, with coefficients that suit the lens.
Camera BoardCamera(LensModel lens);

// A chessboard of 9 x 7 inner corners, 30 mm apart.
Board DeskChessboard();

}  // namespace legible
