#include "accuracy/error_sources.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>

#include "accuracy/gauss_legendre.h"
#include "accuracy/maximal_errors.h"
#include "core/robots/leg_interaction.h"

namespace legible {
namespace {

constexpr double kNormal95 = 1.959963984540054;
constexpr double kSigmasOfBound = 3;
constexpr double kPartInBound = 0.9973002039367398;  // within 3 sigma of a normal variable

void Check(const ErrorSource& source) {
  const auto count = static_cast<Eigen::Index>(source.parameters.size());
  if (source.sensitivity.cols() != count || source.covariance.rows() != count ||
      source.covariance.cols() != count)
    throw std::invalid_argument("ErrorSource " + source.name + ": sizes do not fit its parameters");
}

double ChiSquaredCdfOf3(double x) {
  return std::erf(std::sqrt(x / 2)) - std::sqrt(2 * x / std::numbers::pi) * std::exp(-x / 2);
}

// Average of f(x^2, y^2, z^2) over the unit sphere, by Gauss' rule over an octant.
template <typename F>
double OverSphere(const F& f) {
  static const GaussLegendre rule = GaussLegendrePanels(2);
  double sum = 0;
  for (Eigen::Index i = 0; i < rule.nodes.size(); ++i) {
    const double z2 = rule.nodes[i] * rule.nodes[i];
    for (Eigen::Index j = 0; j < rule.nodes.size(); ++j) {
      const double c = std::cos(std::numbers::pi / 2 * rule.nodes[j]);
      sum += rule.weights[i] * rule.weights[j] * f((1 - z2) * c * c, (1 - z2) * (1 - c * c), z2);
    }
  }
  return sum;
}

// A direction d of the unit sphere is left within r by the part of chi-squared with 3 degrees of freedom up
// to r^2 / (d^T covariance d).
double PartWithin(double radius, const Eigen::Vector3d& variances) {
  return OverSphere([&](double x2, double y2, double z2) {
    const double variance = x2 * variances[2] + y2 * variances[1] + z2 * variances[0];
    return variance > 0 ? ChiSquaredCdfOf3(radius * radius / variance) : 1.0;
  });
}

ErrorFigures FiguresFromCovariance(const Eigen::MatrixXd& covariance, int linear, double sigmas,
                                   double part) {
  const Eigen::MatrixXd position = LinearPart(LinearPart(covariance, linear).transpose(), linear);
  const Eigen::MatrixXd rotation = AngularPart(AngularPart(covariance, linear).transpose(), linear);
  return {sigmas * covariance.diagonal().cwiseMax(0).cwiseSqrt(), RadiusHolding(part, position),
          RadiusHolding(part, rotation)};
}

ErrorFigures Sum(const ErrorFigures& a, const ErrorFigures& b) {
  return {a.of_coordinate + b.of_coordinate, a.position_m + b.position_m, a.rotation_rad + b.rotation_rad};
}

ErrorFigures Least(const ErrorFigures& a, const ErrorFigures& b) {
  return {a.of_coordinate.cwiseMin(b.of_coordinate), std::min(a.position_m, b.position_m),
          std::min(a.rotation_rad, b.rotation_rad)};
}

// Parts of the traces of the covariance's linear and angular blocks.
std::vector<Contribution> Contributions(const std::vector<ErrorSource>& sources, const SourceErrors& errors,
                                        int linear) {
  const Eigen::Index angular = errors.covariance.rows() - linear;
  const double position_variance = errors.covariance.diagonal().head(linear).sum();
  const double rotation_variance = errors.covariance.diagonal().tail(angular).sum();
  std::vector<Contribution> contributions;
  for (const ErrorSource& source : sources) {
    const Eigen::MatrixXd by_parameter =
        source.sensitivity.cwiseProduct(source.sensitivity * source.covariance);
    for (Eigen::Index i = 0; i < by_parameter.cols(); ++i) {
      const double position = by_parameter.col(i).head(linear).sum();
      const double rotation = by_parameter.col(i).tail(angular).sum();
      contributions.push_back(
          {source.parameters[static_cast<size_t>(i)],
           position_variance > 0 ? position / position_variance * errors.value_95.position_m : 0,
           rotation_variance > 0 ? rotation / rotation_variance * errors.value_95.rotation_rad : 0});
    }
  }
  std::stable_sort(contributions.begin(), contributions.end(),
                   [](const Contribution& a, const Contribution& b) { return a.position_m > b.position_m; });
  return contributions;
}

// Generators of all bounded sources.
Eigen::MatrixXd BoundedGenerators(const std::vector<ErrorSource>& sources, Eigen::Index rows) {
  Eigen::MatrixXd generators(rows, 0);
  for (const ErrorSource& source : sources) {
    if (!source.IsBounded()) continue;
    const Eigen::Index before = generators.cols();
    generators.conservativeResize(Eigen::NoChange, before + source.bounds.size());
    generators.rightCols(source.bounds.size()) = source.sensitivity * source.bounds.asDiagonal();
  }
  return generators;
}

}  // namespace

ErrorSource BoundedSource(const std::string& name, const std::vector<std::string>& parameters,
                          const Eigen::MatrixXd& sensitivity, const Eigen::VectorXd& bounds) {
  ErrorSource source{name, parameters, sensitivity, bounds, (bounds.cwiseAbs2() / 3).asDiagonal()};
  Check(source);
  return source;
}

ErrorSource NormalSource(const std::string& name, const std::vector<std::string>& parameters,
                         const Eigen::MatrixXd& sensitivity, const Eigen::MatrixXd& covariance) {
  ErrorSource source{name, parameters, sensitivity, {}, covariance};
  Check(source);
  return source;
}

Eigen::MatrixXd PlatformByGeometry(const GoughStewart& robot, const Rigid3& base_from_platform,
                                   const PlatformJacobian& jacobian) {
  return -jacobian.matrix * ReadingsByGeometry(robot, base_from_platform);
}

Eigen::MatrixXd GeometryCovariance(const std::vector<std::string>& parameter_names,
                                   const Eigen::MatrixXd& covariance) {
  const auto& names = GeometryNames();
  std::vector<Eigen::Index> from, to;
  for (size_t i = 0; i < parameter_names.size(); ++i) {
    const auto found = std::find(names.begin(), names.end(), parameter_names[i]);
    if (found == names.end()) continue;
    from.push_back(static_cast<Eigen::Index>(i));
    to.push_back(found - names.begin());
  }
  Eigen::MatrixXd geometry = Eigen::MatrixXd::Zero(kGeometryCount, kGeometryCount);
  geometry(to, to) = covariance(from, from);
  return geometry;
}

std::optional<ErrorSource> VisionSource(const GoughStewart& robot, const Camera& camera,
                                        const Rigid3& camera_from_base, const Rigid3& base_from_platform,
                                        const std::vector<int>& legs, double sigma_px) {
  const auto interaction = EdgeInteraction(robot, camera, camera_from_base, base_from_platform, legs);
  if (!interaction || interaction->rows() < 6) return std::nullopt;
  // Columns of equal length: whether the pose is determined must not depend on the unit of length.
  const Vector6d scale = interaction->colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(*interaction * scale.asDiagonal(),
                                              Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd& values = svd.singularValues();
  if (!(values[5] > kSingularRatio * values[0])) return std::nullopt;
  const Eigen::MatrixXd pose_by_shifts =
      scale.asDiagonal() * svd.matrixV() * values.cwiseInverse().asDiagonal() * svd.matrixU().transpose();
  std::vector<std::string> names;
  for (const EdgeEnd& end : EdgeEnds(legs))
    names.push_back("leg " + std::to_string(end.leg + 1) + " edge " + std::to_string(end.edge + 1) +
                    (end.is_at_platform ? " at the platform" : " at the base"));
  const Eigen::Index count = pose_by_shifts.cols();
  return NormalSource("vision", names, pose_by_shifts,
                      sigma_px * sigma_px * Eigen::MatrixXd::Identity(count, count));
}

SourceErrors ErrorsOf(const ErrorSource& source, int linear) {
  SourceErrors errors = ErrorsTogether({source}, linear);
  errors.name = source.name;
  return errors;
}

SourceErrors ErrorsTogether(const std::vector<ErrorSource>& sources, int linear) {
  if (sources.empty()) throw std::invalid_argument("ErrorsTogether: no source");
  const Eigen::Index rows = sources.front().sensitivity.rows();
  SourceErrors errors;
  errors.name = "together";
  errors.covariance = Eigen::MatrixXd::Zero(rows, rows);
  Eigen::MatrixXd normal = errors.covariance;
  for (const ErrorSource& source : sources) {
    const Eigen::MatrixXd covariance =
        source.sensitivity * source.covariance * source.sensitivity.transpose();
    errors.covariance += covariance;
    if (!source.IsBounded()) normal += covariance;
  }
  const MaximalErrors bounded = MaximalErrorsOf(BoundedGenerators(sources, rows), linear);
  errors.bound = Sum({bounded.of_coordinate, bounded.position_m(), bounded.rotation_rad()},
                     FiguresFromCovariance(normal, linear, kSigmasOfBound, kPartInBound));
  errors.value_95 = Least(FiguresFromCovariance(errors.covariance, linear, kNormal95, 0.95), errors.bound);
  errors.contributions = Contributions(sources, errors, linear);
  return errors;
}

double RadiusHolding(double part, const Eigen::Matrix3d& covariance) {
  const Eigen::Vector3d variances =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly)
          .eigenvalues()
          .cwiseMax(0);
  if (!(variances[2] > 0)) return 0;
  const auto excess = [&](double radius) { return PartWithin(radius, variances) - part; };
  const double farthest = 20 * std::sqrt(variances.sum());
  std::uintmax_t steps = 60;
  const auto [low, high] = boost::math::tools::toms748_solve(
      excess, 0.0, farthest, boost::math::tools::eps_tolerance<double>(40), steps);
  return (low + high) / 2;
}

}  // namespace legible
