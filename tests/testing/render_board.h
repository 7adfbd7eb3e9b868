// Images of calibration boards whose corners are known exactly.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/geometry/camera.h"
#include "core/geometry/rigid3.h"
#include "core/session/board.h"
#include "tests/testing/render_scene.h"

namespace legible {

struct BoardLook {
  double dark = 30, light = 220;  // grey levels of the print
  double around = 120;            // grey levels of what is behind the board
  double blur_px = 0.8;  // standard deviation of the lens's Gaussian; the pixels' own extent is added
};

// The board, flat and lying in its z = 0, with a light margin. Tags are drawn as libapriltag draws them, with
// two-bit borders as cv::aruco does; corner squares are as large as the gap to the nearest tag.
CleanImage RenderBoard(const Board& board, const Camera& camera, const Rigid3& camera_from_board,
                       const BoardLook& look = {});

// tags of side tag_m in rows from the top-left, gap_m apart, the board's middle at the origin.
TagBoard TagGrid(const std::string& family, int columns, int rows, double tag_m, double gap_m);
// The same with two-bit borders and corner squares, counted from the bottom-left as Kalibr does.
TagBoard KalibrGrid(int columns, int rows, double tag_m, double gap_m);

// camera_from_board: turned by tilt_rad about an axis of the board's plane at direction_rad and by roll_rad
// about the normal, then at `middle_in_camera` (m). Without turns the board faces the camera upright.
Rigid3 BoardPose(double tilt_rad, double direction_rad, double roll_rad,
                 const Eigen::Vector3d& middle_in_camera);

}  // namespace legible
