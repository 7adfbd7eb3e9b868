#include "calib/board/next_view.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

namespace legible {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kPlaces = 5;                          // along each side of the image
constexpr double kSizes[] = {0.3, 0.5, 0.75, 1.0};  // of the board, of the image's shorter side
constexpr double kTilts_rad[] = {0, kPi / 7, kPi / 4};
constexpr int kTiltDirections = 8;
constexpr size_t kMostPoints = 60;     // that stand for all of the board's
constexpr double kLeastShare = 0.6;    // of a board of tags, to be seen
constexpr double kMostOblique = 0.45;  // least cosine between the board's normal and the line of sight

// Some of the board's points, and for how many each of them stands.
struct Sample {
  std::vector<Eigen::Vector3d> points_m;
  double each = 1;
};

Sample SampleOf(const std::vector<Eigen::Vector3d>& points_m) {
  const size_t stride = std::max<size_t>(1, points_m.size() / kMostPoints) | 1;  // odd: not always one corner
  Sample sample;
  for (size_t i = 0; i < points_m.size(); i += stride) sample.points_m.push_back(points_m[i]);
  sample.each = static_cast<double>(points_m.size()) / static_cast<double>(sample.points_m.size());
  return sample;
}

bool IsInImage(const Camera& camera, const Eigen::Vector2d& pixel) {
  constexpr double kMargin = 0.01;  // of the image's width
  const double margin_px = kMargin * camera.width_px;
  return pixel.x() >= margin_px && pixel.y() >= margin_px && pixel.x() <= camera.width_px - 1 - margin_px &&
         pixel.y() <= camera.height_px - 1 - margin_px;
}

// Facing the camera, tilted by `angle` so that the part towards `direction` in the image is farther, its
// middle on a line of sight.
Rigid3 PoseAt(const Eigen::Vector3d& middle_in_camera, const Eigen::Vector3d& middle_in_board,
              const BoardTilt& tilt) {
  const Eigen::Quaterniond facing(Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()));
  const Eigen::Vector3d axis(std::sin(tilt.direction_rad), -std::cos(tilt.direction_rad), 0);
  const Eigen::Quaterniond rotation = Eigen::Quaterniond(Eigen::AngleAxisd(tilt.angle_rad, axis)) * facing;
  return {rotation, middle_in_camera - rotation * middle_in_board};
}

class Proposer {
 public:
  Proposer(const BoardCalibrationInput& input, const BoardCalibration& calibration,
           const NextViewOptions& options)
      : calibration_(calibration),
        options_(options),
        sample_(SampleOf(input.points_in_board_m)),
        extent_(FlatOver(input.points_in_board_m)) {
    problem_.camera = calibration.camera;
    problem_.warp = calibration.warp;
    const std::vector<GridPoint> points = PointsOver(calibration.camera, options.grid);
    const std::vector<double> ones(points.size(), 1.0);
    lens_rows_ = WithoutMotion(Stack(points, ones)) / std::sqrt(static_cast<double>(points.size()));
  }

  std::optional<NextView> Best() {
    const double now_px = SigmaAfter(Eigen::MatrixXd::Zero(calibration_.information.information.rows(),
                                                           calibration_.information.information.cols()));
    std::optional<NextView> best;
    for (int row = 0; row < kPlaces; ++row)
      for (int column = 0; column < kPlaces; ++column)
        for (double size : kSizes)
          for (double angle_rad : kTilts_rad)
            for (int direction = 0; direction < (angle_rad == 0 ? 1 : kTiltDirections); ++direction) {
              const auto candidate =
                  At(row, column, size, {angle_rad, 2 * kPi * direction / kTiltDirections});
              if (candidate && (!best || candidate->then_px < best->then_px)) best = candidate;
            }
    if (best) best->now_px = now_px;
    return best;
  }

 private:
  // The uncertainty of the lens over the image, rms, with that information added.
  double SigmaAfter(const Eigen::MatrixXd& added) const {
    const Eigen::LLT<Eigen::MatrixXd> root(calibration_.information.information + added);
    return root.matrixL().solve(lens_rows_.transpose()).norm();
  }

  std::optional<NextView> At(int row, int column, double size, const BoardTilt& tilt) const {
    const Camera& camera = calibration_.camera;
    const Eigen::Vector2d centre_px((column + 0.5) / kPlaces * camera.width_px,
                                    (row + 0.5) / kPlaces * camera.height_px);
    const auto sight = Unproject(camera, centre_px);
    if (!sight) return std::nullopt;
    const double shorter_px = std::min(camera.width_px, camera.height_px);
    const double depth_m = 2 * extent_.half_size_m.maxCoeff() * camera.fx_px / (size * shorter_px);
    const Eigen::Vector3d middle_in_board(extent_.centre_m.x(), extent_.centre_m.y(), 0);
    NextView view;
    view.camera_from_board = PoseAt(depth_m * sight->homogeneous(), middle_in_board, tilt);
    view.tilt = tilt;
    view.centre_px = centre_px;
    view.distance_m = depth_m * sight->homogeneous().norm();
    const ViewObservation seen = Observe(view.camera_from_board);
    const double share =
        static_cast<double>(seen.pixels.size()) / static_cast<double>(sample_.points_m.size());
    if (share < (options_.needs_whole_board ? 1 : kLeastShare)) return std::nullopt;
    view.then_px = SigmaAfter(ViewInformation(problem_, seen));
    view.outline_px = OutlineOf(view.camera_from_board);
    return view;
  }

  // What the camera would see of the board there, with the noise that it has had so far.
  ViewObservation Observe(const Rigid3& camera_from_board) const {
    ViewObservation seen{camera_from_board, {}, {}, {}};
    const double sigma_px = calibration_.widening * calibration_.corner_sigma_px;
    const Eigen::Vector3d normal = camera_from_board.rotation * Eigen::Vector3d::UnitZ();
    const double reach = MonotonicRadius(calibration_.camera.lens, calibration_.camera.distortion);
    for (const Eigen::Vector3d& point : sample_.points_m) {
      const Eigen::Vector3d x = camera_from_board * point;
      if (!(x.z() > 0) || x.head<2>().norm() >= reach * x.z()) continue;
      if (std::abs(normal.dot(x.normalized())) < kMostOblique) continue;
      const Eigen::Vector2d pixel = Project(calibration_.camera, x);
      if (!IsInImage(calibration_.camera, pixel)) continue;
      seen.points_in_board_m.push_back(point);
      seen.pixels.push_back(pixel);
      seen.whitening_per_px.emplace_back(std::sqrt(sample_.each) / sigma_px * Eigen::Matrix2d::Identity());
    }
    return seen;
  }

  std::vector<Eigen::Vector2d> OutlineOf(const Rigid3& camera_from_board) const {
    constexpr int kSteps = 8;  // a side, for the lens bends it
    const Eigen::Vector2d around[] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
    std::vector<Eigen::Vector2d> outline;
    for (int side = 0; side < 4; ++side)
      for (int step = 0; step < kSteps; ++step) {
        const double share = static_cast<double>(step) / kSteps;
        const Eigen::Vector2d place = (1 - share) * around[side] + share * around[side + 1];
        const Eigen::Vector2d on_board = extent_.centre_m + place.cwiseProduct(extent_.half_size_m);
        const Eigen::Vector3d x = camera_from_board * Eigen::Vector3d(on_board.x(), on_board.y(), 0);
        if (x.z() > 0) outline.push_back(Project(calibration_.camera, x));
      }
    return outline;
  }

  const BoardCalibration& calibration_;
  const NextViewOptions& options_;
  Sample sample_;
  BoardWarp extent_;
  BoardProblem problem_;
  Eigen::MatrixXd lens_rows_;
};

}  // namespace

std::optional<NextView> ProposeView(const BoardCalibrationInput& input, const BoardCalibration& calibration,
                                    const NextViewOptions& options) {
  return Proposer(input, calibration, options).Best();
}

}  // namespace legible
