#include "calib/observability.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "calib/shared_information.h"

namespace legible {
namespace {

constexpr double kUnknown = 1.0 / 3;  // relative sigma from which a combination counts as not known
// Where a combination is not known, relative sigma from which no number is given for what is known better
// than it: the analysis is linear, about a place that is arbitrary along what is open.
constexpr double kPoorlyKnown = 0.05;
constexpr double kShadingSize_px = 100;  // so large that shading never counts as unknown: it has its prior
constexpr double kNumericalZero =
    1e-13;                         // of the largest eigenvalue: below it there is no information at all
constexpr double kTouched = 1e-3;  // share of an unobservable direction that spoils a parameter
constexpr int kWeakDirectionsReported = 3;

// A direction with a name: entries relative to the parameters' natural sizes.
struct NamedDirection {
  std::string description;
  Eigen::VectorXd direction;
};

// The size of the thing that each parameter describes, so that a relative sigma of 1 means "not known at
// all".
Eigen::VectorXd NaturalSizes(const EstimationProblem& problem) {
  const SharedParameters& shared = problem.shared;
  Eigen::VectorXd sizes(kSharedParameterCount);
  sizes.head<4>().setConstant(shared.camera[0]);
  sizes.segment<8>(4) = CoefficientSizes(CameraOf(problem));
  for (int i = 0; i < kLegCount; ++i) {
    const LegParameters& leg = shared.legs[static_cast<size_t>(i)];
    auto of_leg = sizes.segment<kLegParameterCount>(FirstParameterOfLeg(i));
    of_leg.segment<3>(leg_parameter::kBaseJoint)
        .setConstant(leg.segment<3>(leg_parameter::kBaseJoint).norm());
    of_leg.segment<3>(leg_parameter::kPlatformJoint)
        .setConstant(leg.segment<3>(leg_parameter::kPlatformJoint).norm());
    of_leg[leg_parameter::kRadius] = leg[leg_parameter::kRadius];
    of_leg[leg_parameter::kJointOffset] = leg.segment<3>(leg_parameter::kPlatformJoint).norm();
    of_leg.segment<4>(leg_parameter::kShading).setConstant(kShadingSize_px);
  }
  return sizes;
}

// The leg's base joint and radius grow together: its image stays as it is.
void ScaleLeg(const EstimationProblem& problem, int leg, Eigen::VectorXd& direction) {
  const LegParameters& values = problem.shared.legs[static_cast<size_t>(leg)];
  auto of_leg = direction.segment<kLegParameterCount>(FirstParameterOfLeg(leg));
  of_leg.segment<3>(leg_parameter::kBaseJoint) = values.segment<3>(leg_parameter::kBaseJoint);
  of_leg[leg_parameter::kRadius] = values[leg_parameter::kRadius];
}

std::vector<NamedDirection> KnownFreedoms(const EstimationProblem& problem, const Eigen::VectorXd& sizes) {
  const char* mend = "give joint readings, a radius, or a tag";
  std::vector<NamedDirection> named;
  Eigen::VectorXd whole = Eigen::VectorXd::Zero(kSharedParameterCount);
  for (int leg = 0; leg < kLegCount; ++leg) {
    Eigen::VectorXd one = Eigen::VectorXd::Zero(kSharedParameterCount);
    ScaleLeg(problem, leg, one);
    ScaleLeg(problem, leg, whole);
    whole.segment<3>(FirstParameterOfLeg(leg) + leg_parameter::kPlatformJoint) =
        problem.shared.legs[static_cast<size_t>(leg)].segment<3>(leg_parameter::kPlatformJoint);
    named.push_back(
        {fmt::format("the scale of leg {} is free (its base joint's distance from the camera and its "
                     "radius grow together unseen): {}",
                     leg + 1, mend),
         one.cwiseQuotient(sizes)});
  }
  named.push_back(
      {fmt::format("the scale of the whole robot is free: {}", mend), whole.cwiseQuotient(sizes)});
  return named;
}

// Orthonormal columns that span the directions the analysis is about: free parameters, gauge taken out.
Eigen::MatrixXd FreeDirections(const EstimationProblem& problem, const Eigen::VectorXd& sizes) {
  std::vector<int> free;
  for (int i = 0; i < kSharedParameterCount; ++i)
    if (problem.free[static_cast<size_t>(i)]) free.push_back(i);
  Eigen::MatrixXd basis =
      Eigen::MatrixXd::Zero(kSharedParameterCount, static_cast<Eigen::Index>(free.size()));
  for (size_t i = 0; i < free.size(); ++i) basis(free[i], static_cast<Eigen::Index>(i)) = 1;
  if (!problem.HasPlatformGauge()) return basis;

  Eigen::MatrixXd gauge = Eigen::MatrixXd::Zero(6, kSharedParameterCount);
  const auto of_joints = PlatformGauge(problem.drawn_platform_joints);
  for (int leg = 0; leg < kLegCount; ++leg)
    gauge.middleCols<3>(FirstParameterOfLeg(leg) + leg_parameter::kPlatformJoint) =
        of_joints.middleCols<3>(3 * leg);
  const Eigen::MatrixXd constraint = (gauge * sizes.asDiagonal() * basis).transpose();
  const Eigen::MatrixXd q =
      constraint.householderQr().householderQ() * Eigen::MatrixXd::Identity(basis.cols(), basis.cols());
  return basis * q.rightCols(basis.cols() - 6);
}

// "camera.fx_px (+), legs[1].radius_m (-) …": the parameters that the direction moves most.
std::string LargestEntries(LensModel lens, const Eigen::VectorXd& direction) {
  std::vector<int> order(static_cast<size_t>(direction.size()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return std::abs(direction[a]) > std::abs(direction[b]); });
  const double largest = std::abs(direction[order[0]]);
  std::string text;
  for (size_t i = 0; i < 4 && std::abs(direction[order[i]]) > 0.3 * largest; ++i)
    text += fmt::format("{}{} ({})", i == 0 ? "" : ", ", ParameterName(lens, order[i]),
                        direction[order[i]] > 0 ? '+' : '-');
  return text;
}

// What shading does to the edges is there for the sake of the other parameters' uncertainty; nobody asks for
// it.
bool IsMostlyShading(const Eigen::VectorXd& direction) {
  Eigen::Index largest = 0;
  direction.cwiseAbs().maxCoeff(&largest);
  return largest >= kCameraParameterCount &&
         (largest - kCameraParameterCount) % kLegParameterCount >= leg_parameter::kShading;
}

WeakDirection Describe(const std::string& text, double relative_sigma, const Eigen::VectorXd& relative,
                       const Eigen::VectorXd& sizes) {
  const Eigen::VectorXd normalised = relative / relative.cwiseAbs().maxCoeff();
  return {text, relative_sigma, normalised.cwiseProduct(sizes)};
}

// Relative sigma along a direction, given the information in natural units.
double SigmaAlong(const Eigen::VectorXd& direction, const Eigen::MatrixXd& relative, double zero) {
  const Eigen::VectorXd unit = direction.normalized();
  const double information = unit.dot(relative * unit);
  return information > zero ? 1 / std::sqrt(information) : std::numeric_limits<double>::infinity();
}

bool IsOfDistortionAlone(const Eigen::VectorXd& direction) {
  constexpr int kFirst = 4;
  return direction.segment(kFirst, kCameraParameterCount - kFirst).norm() > 0.99 * direction.norm();
}

// A board has said all that is said of the camera beforehand.
bool HasBoard(const EstimationProblem& problem) {
  return problem.board || problem.camera_prior.root.rows() > 0;
}

const char* MendOf(const EstimationProblem& problem, const Eigen::VectorXd& direction) {
  if (!IsOfDistortionAlone(direction)) return "hold one of them fixed or say how well it is known";
  if (HasBoard(problem))
    return "the board does not tell these coefficients apart either; calibrate the camera with a lens model "
           "of "
           "fewer";
  return "say how well the distortion is known, or take a lens model with fewer coefficients";
}

std::string DescribeUnnamed(const EstimationProblem& problem, const Eigen::VectorXd& direction,
                            double relative_sigma) {
  return fmt::format("a combination of {} is {}: {}", LargestEntries(problem.camera.lens, direction),
                     relative_sigma < 1
                         ? fmt::format("known only to {:.0f} % of its size", 100 * relative_sigma)
                         : "not determined",
                     MendOf(problem, direction));
}

// Names the null space: first the freedoms that have a name, then what is left of it by its largest entries.
std::vector<WeakDirection> NameUnobservable(const EstimationProblem& problem, const Eigen::VectorXd& sizes,
                                            const Eigen::MatrixXd& relative, double zero,
                                            Eigen::MatrixXd space) {
  std::vector<WeakDirection> result;
  const auto add = [&](const std::string& text, const Eigen::VectorXd& direction) {
    result.push_back(Describe(text, SigmaAlong(direction, relative, zero), direction, sizes));
  };
  for (const NamedDirection& named : KnownFreedoms(problem, sizes)) {
    if (space.cols() == 0) break;
    const Eigen::VectorXd inside = space.transpose() * named.direction;
    if (inside.norm() < 0.99 * named.direction.norm()) continue;
    add(named.description, named.direction);
    // What is left of the space: its directions orthogonal to the one just named.
    const Eigen::MatrixXd q = Eigen::MatrixXd(inside).householderQr().householderQ() *
                              Eigen::MatrixXd::Identity(inside.size(), inside.size());
    space = space * q.rightCols(inside.size() - 1);
  }
  if (space.cols() > 0)  // what was named is taken out of it: its own axes again
    space *=
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(space.transpose() * relative * space).eigenvectors();
  for (Eigen::Index i = 0; i < space.cols(); ++i)
    add(DescribeUnnamed(problem, space.col(i), SigmaAlong(space.col(i), relative, zero)), space.col(i));
  return result;
}

// A joint of which one coordinate is open is open: that another one is next to 0, and does not grow with the
// leg's scale, is the camera's place, not knowledge.
void KnowPointsAsWholes(std::vector<bool>& known) {
  for (int leg = 0; leg < kLegCount; ++leg)
    for (const int entry : {leg_parameter::kBaseJoint, leg_parameter::kPlatformJoint}) {
      const auto first = known.begin() + FirstParameterOfLeg(leg) + entry;
      std::fill_n(first, 3, std::all_of(first, first + 3, [](bool one) { return one; }));
    }
}

Observability WhereAllIsHeld() {
  return {{},
          {},
          Eigen::MatrixXd::Zero(kSharedParameterCount, kSharedParameterCount),
          std::vector<bool>(kSharedParameterCount, true)};
}

}  // namespace

Eigen::MatrixXd AnalysedDirections(const EstimationProblem& problem) {
  const Eigen::VectorXd sizes = NaturalSizes(problem);
  return sizes.asDiagonal() * FreeDirections(problem, sizes);
}

Observability AnalyseObservability(const EstimationProblem& problem) {
  return AnalyseObservability(problem, SharedInformation(problem));
}

Observability AnalyseObservability(const EstimationProblem& problem, const Eigen::MatrixXd& information) {
  const Eigen::VectorXd sizes = NaturalSizes(problem);
  const Eigen::MatrixXd directions = FreeDirections(problem, sizes);
  if (directions.cols() == 0) return WhereAllIsHeld();
  const Eigen::MatrixXd relative = sizes.asDiagonal() * information * sizes.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(directions.transpose() * relative * directions);
  const Eigen::VectorXd& values = eigen.eigenvalues();  // ascending
  const Eigen::MatrixXd vectors = directions * eigen.eigenvectors();

  Observability result;
  const Eigen::Index count = values.size();
  const double zero = count > 0 ? kNumericalZero * values[count - 1] : 0;
  const auto sigma = [&](Eigen::Index i) {
    return values[i] > zero ? 1 / std::sqrt(values[i]) : std::numeric_limits<double>::infinity();
  };
  Eigen::Index unknown = 0;
  while (unknown < count && sigma(unknown) > kUnknown) ++unknown;
  result.unobservable = NameUnobservable(problem, sizes, relative, zero, vectors.leftCols(unknown));
  for (Eigen::Index i = unknown; i < count && result.weak.size() < kWeakDirectionsReported; ++i)
    if (!IsMostlyShading(vectors.col(i)))
      result.weak.push_back(
          Describe(LargestEntries(problem.camera.lens, vectors.col(i)), sigma(i), vectors.col(i), sizes));

  const Eigen::MatrixXd known = sizes.asDiagonal() * vectors.rightCols(count - unknown);
  result.covariance = known * values.tail(count - unknown).cwiseInverse().asDiagonal() * known.transpose();
  result.known.resize(kSharedParameterCount);
  Eigen::Index withheld = unknown;
  while (unknown > 0 && withheld < count && sigma(withheld) > kPoorlyKnown) ++withheld;
  for (int i = 0; i < kSharedParameterCount; ++i)
    result.known[static_cast<size_t>(i)] = vectors.row(i).head(withheld).norm() < kTouched;
  KnowPointsAsWholes(result.known);
  return result;
}

}  // namespace legible
