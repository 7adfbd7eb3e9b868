// Where a platform's error comes from: joints, geometry, vision; each alone and together, as bounds and as 95
// % values.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/platform_jacobian.h"
#include "core/geometry/camera.h"
#include "core/robots/gough_stewart.h"

namespace legible {

// One cause: parameters, what they do to the platform, and how well they are known. Either each parameter has
// a bound of its own (its error is then taken as uniform within it for 95 % values), or all are normal.
struct ErrorSource {
  std::string name;
  std::vector<std::string> parameters;
  Eigen::MatrixXd sensitivity;  // twist of the platform by parameter, a column each
  Eigen::VectorXd bounds;       // of each parameter; empty where they are normal
  Eigen::MatrixXd covariance;   // of the parameters

  bool IsBounded() const { return bounds.size() > 0; }
};

ErrorSource BoundedSource(const std::string& name, const std::vector<std::string>& parameters,
                          const Eigen::MatrixXd& sensitivity, const Eigen::VectorXd& bounds);
ErrorSource NormalSource(const std::string& name, const std::vector<std::string>& parameters,
                         const Eigen::MatrixXd& sensitivity, const Eigen::MatrixXd& covariance);

// d(platform twist) / d(geometry) at constant joint readings, 6 x 42, in the order of GeometryNames.
Eigen::MatrixXd PlatformByGeometry(const GoughStewart& robot, const Rigid3& base_from_platform,
                                   const PlatformJacobian& jacobian);

// The covariance of the 42 parameters in the order of GeometryNames from that of a model, by name; what the
// model does not list is exact.
Eigen::MatrixXd GeometryCovariance(const std::vector<std::string>& parameter_names,
                                   const Eigen::MatrixXd& covariance);

// The pose as the legs' edges show it, by least squares on their shifts in the image: noise of sigma_px at
// each end of each edge goes through the pseudo-inverse of EdgeInteraction. `legs` count from 0. Nothing
// where these legs are not seen, or do not determine the pose.
std::optional<ErrorSource> VisionSource(const GoughStewart& robot, const Camera& camera,
                                        const Rigid3& camera_from_base, const Rigid3& base_from_platform,
                                        const std::vector<int>& legs, double sigma_px);

struct ErrorFigures {
  Eigen::VectorXd of_coordinate;  // m, rad, in the order of a twist
  double position_m = 0, rotation_rad = 0;
};

// What one parameter adds: its share of the variance (of the squared position or rotation error's mean) times
// the 95 % value, so that the parts of a source add up to it. Correlations are split evenly; a part is
// negative where they cancel more than the parameter adds.
struct Contribution {
  std::string parameter;
  double position_m = 0, rotation_rad = 0;
};

struct SourceErrors {
  std::string name;
  // No error is larger. Normal parameters have no bound: 3 sigma stand for it (99.73 %; of position and
  // rotation the radius that holds as much).
  ErrorFigures bound;
  // 95 % of all errors are smaller: 1.96 sigma of a coordinate, for position and rotation the radius that
  // holds 95 % of a normal distribution with their covariance; never above the bound.
  ErrorFigures value_95;
  Eigen::MatrixXd covariance;               // of the twist
  std::vector<Contribution> contributions;  // most important (for the position) first
};

SourceErrors ErrorsOf(const ErrorSource& source, int linear);

// Of all sources at once, taken as independent. Bounds of bounded sources add up exactly (one zonotope),
// normal ones are added to that.
SourceErrors ErrorsTogether(const std::vector<ErrorSource>& sources, int linear);

// The radius r of a ball about the mean that holds the given part of a normal distribution in three
// dimensions.
double RadiusHolding(double part, const Eigen::Matrix3d& covariance);

// Of the chi-squared distribution with 6 degrees of freedom, the 95 % quantile: a pose error e with
// covariance C lies in the region e^T C^-1 e <= this with 95 %.
inline constexpr double kChiSquared95Of6 = 12.591587243743977;

}  // namespace legible
