#include "apps/prior_pulls.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "calib/board/board_information.h"

namespace legible {
namespace {

constexpr const char* kAxes[] = {"x", "y", "z"};
constexpr double kLeastVarianceShare = 1e-6;  // of what was given, that the images must tell beyond rounding

class PullList {
 public:
  // `left`: the share of what was said's variance that is left where a frame is fitted to it.
  void Add(const std::string& name, double value, const std::optional<double>& sigma, double found,
           double found_sigma, double left = 1) {
    if (!sigma || !(found_sigma > 0)) return;  // nothing said; held, or not known
    const double said = left * *sigma * *sigma;
    const double variance = std::max(said - found_sigma * found_sigma, kLeastVarianceShare * said);
    list_.push_back({name, value, *sigma, found, (found - value) / std::sqrt(variance)});
  }
  void AddPoint(const std::string& name, const Eigen::Vector3d& value, const std::optional<double>& sigma,
                const Eigen::Vector3d& found, const Eigen::Vector3d& found_sigma,
                const Eigen::Vector3d& left) {
    for (int i = 0; i < 3; ++i)
      Add(name + "." + kAxes[i], value[i], sigma, found[i], found_sigma[i], left[i]);
  }
  std::vector<PriorPull> Take() { return std::move(list_); }

 private:
  std::vector<PriorPull> list_;
};

void AddCamera(const CalibrationRun& run, const FoundParameters& found, PullList& pulls) {
  const PriorKnowledge& known = run.session.known;
  const Camera& camera = run.result.guessed_camera;
  const CameraParameters guess = ParametersOf(camera);
  const Eigen::MatrixXd& information = known.camera_information;
  const Eigen::MatrixXd by_board = information.size() > 0 ? CovarianceOf(information) : information;
  for (int i = 0; i < kCameraParameterCount; ++i) {
    auto sigma = i < 2 ? known.focal_length_px : i < 4 ? known.principal_point_px : known.distortion;
    if (i < by_board.rows()) sigma = std::sqrt(by_board(i, i));
    pulls.Add(ParameterName(camera.lens, i), guess[i], sigma, found.camera[i], found.camera_sigma[i]);
  }
}

// What a rigid fit to these joints leaves of the variance of each of their coordinates, if all are alike.
Eigen::Matrix<double, 18, 1> LeftByRigidFit(const LegPoints& joints) {
  const Eigen::Matrix<double, 6, 18> motions = PlatformGauge(joints);
  const Eigen::Matrix<double, 6, 6> gram = motions * motions.transpose();
  return Eigen::Matrix<double, 18, 1>::Ones() - (motions.transpose() * gram.ldlt().solve(motions)).diagonal();
}

}  // namespace

// The base joints are known up to where the base as a whole is, and the base frame is the rigid fit to the
// drawing: in that frame found minus drawn is what is compared with what is left of their sigma. The same
// holds for the platform.
std::vector<PriorPull> PriorPulls(const CalibrationRun& run, const FoundParameters& found) {
  PullList pulls;
  AddCamera(run, found, pulls);
  const PriorKnowledge& known = run.session.known;
  LegPoints base, platform;
  for (size_t i = 0; i < kLegCount; ++i) {
    base[i] = run.session.robot.legs[i].base_joint_m;
    platform[i] = run.session.robot.legs[i].platform_joint_m;
  }
  const Eigen::Matrix<double, 18, 1> left_of_base = LeftByRigidFit(base),
                                     left_of_platform = LeftByRigidFit(platform);
  for (size_t i = 0; i < kLegCount; ++i) {
    const Leg& drawn = run.session.robot.legs[i];
    const FoundLeg& leg = found.legs[i];
    const std::string name = fmt::format("legs[{}].", i + 1);
    const Eigen::Index first = 3 * static_cast<Eigen::Index>(i);
    pulls.AddPoint(name + "base_joint_m", drawn.base_joint_m, known.base_joint_m, leg.base_joint_m,
                   leg.sigma.base_joint_m, left_of_base.segment<3>(first));
    pulls.AddPoint(name + "platform_joint_m", drawn.platform_joint_m, known.platform_joint_m,
                   leg.platform_joint_m, leg.sigma.platform_joint_m, left_of_platform.segment<3>(first));
    pulls.Add(name + "radius_m", drawn.radius_m, known.radius_m, leg.radius_m, leg.sigma.radius_m);
    pulls.Add(name + "joint_offset_m", drawn.joint_offset_m, known.joint_offset_m, leg.joint_offset_m,
              leg.sigma.joint_offset_m);
  }
  return pulls.Take();
}

}  // namespace legible
