// The least-squares problem of a calibration: unknowns, observations, what is known beforehand.
#pragma once

#include <Eigen/Core>
#include <array>
#include <bitset>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "calib/base_frame.h"
#include "calib/board/board_problem.h"
#include "calib/leg_model.h"
#include "calib/tag_model.h"

namespace legible {

// The unknowns that belong to one image alone, eliminated before the shared ones are solved for: the
// platform's pose with all legs that hang on it, or, where no rigid platform is assumed, the direction of a
// single leg.
struct PoseUnit {
  int image = 0;
  bool rigid = true;
  Rigid3 camera_from_platform;     // rigid
  Eigen::Vector3d axis_in_camera;  // not rigid: from A along the leg
  std::vector<LegObservation> legs;
  std::vector<TagObservation> tags = {};  // rigid: of the groups on the platform

  int size() const { return rigid ? 6 : 2; }
};

// The leg's tip at the unit's pose moved by `displacement` (size() numbers).
LegTip TipOf(const PoseUnit& unit, const LegParameters& leg, const double* displacement);
// The unit with its pose moved by `displacement`.
void Displace(PoseUnit& unit, const double* displacement);

// A shared parameter is known to be `value` with standard deviation `sigma`.
struct ParameterPrior {
  int parameter = 0;  // index into the shared parameters
  double value = 0;
  double sigma = 1;
};

// The camera's parameters are known to be `value` with the inverse covariance rootᵀ root.
struct CameraPrior {
  CameraParameters value = CameraParameters::Zero();
  Eigen::Matrix<double, Eigen::Dynamic, kCameraParameterCount> root;  // no rows: not known

  Eigen::VectorXd Residual(const CameraParameters& camera) const { return root * (camera - value); }
};

struct EstimationProblem {
  Camera camera;  // says lens and size; what is estimated of it stands in `shared`
  SharedParameters shared;
  std::vector<PoseUnit> units;
  std::bitset<kSharedParameterCount> free;
  std::vector<ParameterPrior> priors;
  CameraPrior camera_prior = {};
  // Views of a board by the same camera, whitened: their poses, and the board's bend where it is estimated,
  // are unknowns of this problem too. Its camera is the shared parameters', not its own.
  std::optional<BoardProblem> board = {};
  std::vector<TagPlacement> tag_placements = {};  // unknowns of all images, each with what is known of it
  std::vector<TagObservation> base_tags;          // of the groups on the base
  // Drawing of the base joints, known to sigma (each coordinate) up to where the base as a whole is; 0:
  // unknown.
  LegPoints drawn_base_joints;
  double base_joint_sigma_m = 0;
  // The platform frame is the rigid fit of B to these, where B is free and the platform rigid.
  LegPoints drawn_platform_joints;

  bool HasPlatformGauge() const;
};

// Where the problem stands.
Camera CameraOf(const EstimationProblem& problem);

double& Parameter(SharedParameters& shared, int index);
double Parameter(const SharedParameters& shared, int index);
// "camera.fx_px", …, "legs[1].base_joint_m.x" (in camera), …, as model.yaml and the messages name them.
std::string ParameterName(LensModel lens, int index);

// Six rows that vanish in first order where the platform frame is the rigid fit of B to the drawn joints, per
// m: sum (B - B0) / sqrt(6) and sum (B0 - centroid) x (B - B0), normalised. Columns: B of leg 0, …, 5.
Eigen::Matrix<double, 6, 18> PlatformGauge(const LegPoints& drawn_platform_joints);

// Residual of the drawn base after the best rigid fit to A (in camera), m, and its derivative by A.
struct DrawnBaseResidual {
  Eigen::Matrix<double, 18, 1> residual_m;
  Eigen::Matrix<double, 18, 18> d_base_joints;
};
DrawnBaseResidual EvaluateDrawnBase(const EstimationProblem& problem, const SharedParameters& shared);

// The base joints A of all legs, in the camera frame, m.
LegPoints BaseJointsInCamera(const SharedParameters& shared);

// Of each of the problem's tag placements, where the problem stands.
std::vector<PlacementResiduals> EvaluatePlacements(const EstimationProblem& problem);

// Minimises the sum of squares from where the problem stands (Levenberg-Marquardt, the image poses eliminated
// by Schur's complement) and leaves the result in it.
struct SolveOptions {
  int max_iterations = 50;
  double relative_tolerance = 1e-12;  // of the cost
  int threads = 2;
  std::function<void(int iteration, double cost)> progress;  // after each iteration
};
struct SolveSummary {
  bool converged = false;
  int iterations = 0;
  double cost = 0;  // half the sum of squares
};
SolveSummary Solve(EstimationProblem& problem, const SolveOptions& options);

}  // namespace legible
