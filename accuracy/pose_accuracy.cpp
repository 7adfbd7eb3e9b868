#include "accuracy/pose_accuracy.h"

#include <stdexcept>

namespace legible {
namespace {

Indices IndicesOf(const JudgedRobot& robot, const Rigid3& base_from_platform,
                  const FullInverseJacobian& in_metres, const PoseAccuracyOptions& options) {
  const FullInverseJacobian jacobian = InLengthUnit(in_metres, options.length_unit_m);
  Indices indices;
  indices.determinant = DeterminantOf(jacobian);
  indices.manipulability = ManipulabilityOf(jacobian);
  indices.plain = ConditionNumbersOf(jacobian.matrix);
  if (options.characteristic_length_m) {
    const double length = *options.characteristic_length_m / options.length_unit_m;
    indices.lengths = {length, length, length};
  } else {
    indices.lengths = NaturalLengths(jacobian);
  }
  indices.normalized = NormalizedConditionNumbers(jacobian, indices.lengths);
  if (const auto* hexapod = std::get_if<GoughStewart>(&robot.mechanism))
    indices.three_point = ThreePointConditionsOf(*hexapod, base_from_platform);
  return indices;
}

std::vector<std::string> ReadingNames(int joints) {
  std::vector<std::string> names;
  for (int i = 1; i <= joints; ++i) names.push_back("leg " + std::to_string(i) + " joint reading");
  return names;
}

std::optional<ErrorSource> GeometrySource(const JudgedRobot& robot, const Rigid3& base_from_platform,
                                          const PlatformJacobian& jacobian,
                                          const PoseAccuracyOptions& options) {
  const auto* hexapod = std::get_if<GoughStewart>(&robot.mechanism);
  if (hexapod == nullptr || (!options.geometry_bound_m && !robot.geometry_covariance)) return std::nullopt;
  const Eigen::MatrixXd sensitivity = PlatformByGeometry(*hexapod, base_from_platform, jacobian);
  const std::vector<std::string> names(GeometryNames().begin(), GeometryNames().end());
  if (options.geometry_bound_m)
    return BoundedSource("geometry", names, sensitivity,
                         Eigen::VectorXd::Constant(kGeometryCount, *options.geometry_bound_m));
  return NormalSource("geometry", names, sensitivity, *robot.geometry_covariance);
}

std::string VisionName(const std::vector<int>& legs) {
  std::string name = "vision, legs";
  for (const int leg : legs) name += " " + std::to_string(leg + 1);
  return name;
}

// One source a set of legs; sets that do not determine the pose are named.
std::vector<ErrorSource> VisionSources(const JudgedRobot& robot, const Rigid3& base_from_platform,
                                       const PoseAccuracyOptions& options, PoseAccuracy& result) {
  std::vector<ErrorSource> sources;
  if (!options.edge_sigma_px) return sources;
  for (const std::vector<int>& legs : options.leg_sets) {
    auto source = VisionSource(std::get<GoughStewart>(robot.mechanism), *robot.camera,
                               *robot.camera_from_base, base_from_platform, legs, *options.edge_sigma_px);
    if (!source) {
      result.missing_sources.push_back(
          {VisionName(legs), "these legs are not all seen, or their edges do not determine the pose"});
      continue;
    }
    source->name = VisionName(legs);
    sources.push_back(std::move(*source));
  }
  return sources;
}

// Joints, geometry, and vision by the first set of legs make up the whole; further sets are there to compare.
void AddSources(const JudgedRobot& robot, const Rigid3& base_from_platform,
                const PoseAccuracyOptions& options, PoseAccuracy& result) {
  const int linear = result.jacobian.linear;
  std::vector<ErrorSource> all = {BoundedSource("joints", ReadingNames(JointCountOf(robot.mechanism)),
                                                result.jacobian.matrix, options.joint_error_bounds)};
  if (auto geometry = GeometrySource(robot, base_from_platform, result.jacobian, options))
    all.push_back(std::move(*geometry));
  for (const ErrorSource& source : all) result.sources.push_back(ErrorsOf(source, linear));
  const std::vector<ErrorSource> vision = VisionSources(robot, base_from_platform, options, result);
  for (const ErrorSource& source : vision) result.sources.push_back(ErrorsOf(source, linear));
  if (!vision.empty()) all.push_back(vision.front());
  result.together = ErrorsTogether(all, linear);
  result.together->name.clear();
  for (const ErrorSource& source : all)
    result.together->name += (result.together->name.empty() ? "" : " + ") + source.name;
}

}  // namespace

void PoseAccuracyOptions::Check(const JudgedRobot& robot) const {
  if (joint_error_bounds.size() != JointCountOf(robot.mechanism) || !(joint_error_bounds.minCoeff() > 0) ||
      !joint_error_bounds.allFinite())
    throw std::invalid_argument("PoseAccuracyOptions: give one positive joint error for each joint");
  const bool needs_hexapod = geometry_bound_m || edge_sigma_px;
  if (needs_hexapod && !std::holds_alternative<GoughStewart>(robot.mechanism))
    throw std::invalid_argument("PoseAccuracyOptions: errors of geometry and vision are those of a hexapod");
  if (edge_sigma_px && !(robot.camera && robot.camera_from_base))
    throw std::invalid_argument("PoseAccuracyOptions: errors of vision need a model with a camera");
}

PoseAccuracy QuickAccuracyAt(const JudgedRobot& robot, const Rigid3& base_from_platform,
                             const PoseAccuracyOptions& options) {
  PoseAccuracy result;
  result.joint_readings_m = JointReadingsOf(robot.mechanism, base_from_platform);
  result.inverse_jacobian = FullInverseJacobianOf(robot.mechanism, base_from_platform);
  result.jacobian = Invert(result.inverse_jacobian);
  if (result.jacobian.status == PoseStatus::kSingular) return result;
  result.max_error = MaximalErrorsOf(result.jacobian, options.joint_error_bounds);
  result.indices = IndicesOf(robot, base_from_platform, result.inverse_jacobian, options);
  return result;
}

PoseAccuracy AccuracyAt(const JudgedRobot& robot, const Rigid3& base_from_platform,
                        const PoseAccuracyOptions& options) {
  options.Check(robot);
  PoseAccuracy result = QuickAccuracyAt(robot, base_from_platform, options);
  if (!result.max_error) return result;
  result.sets = ErrorSetsOf(result.jacobian, options.joint_error_bounds);
  if (const auto* hexapod = std::get_if<GoughStewart>(&robot.mechanism))
    result.vertex_check = CheckAtVertices(*hexapod, base_from_platform, options.joint_error_bounds);
  AddSources(robot, base_from_platform, options, result);
  return result;
}

}  // namespace legible
