// All there is to say of a robot's accuracy at one pose.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/conditioning.h"
#include "accuracy/error_sets.h"
#include "accuracy/error_sources.h"
#include "accuracy/maximal_errors.h"
#include "accuracy/platform_jacobian.h"
#include "accuracy/three_point.h"
#include "accuracy/vertex_check.h"
#include "core/geometry/camera.h"
#include "core/robots/mechanism.h"

namespace legible {

// What is judged: a mechanism, and what is known of how well its model is.
struct JudgedRobot {
  Mechanism mechanism;
  std::optional<Camera> camera;  // both needed for errors of vision
  std::optional<Rigid3> camera_from_base;
  std::optional<Eigen::MatrixXd> geometry_covariance;  // of GeometryNames, m^2; of a hexapod
};

struct PoseAccuracyOptions {
  Eigen::VectorXd joint_error_bounds;  // of each joint, m, positive
  std::optional<double>
      geometry_bound_m;  // of each coordinate of A and B and each offset, instead of the covariance
  std::optional<double> edge_sigma_px;  // noise of an edge at each of its ends
  std::vector<std::vector<int>> leg_sets = {
      {0, 1, 2, 3, 4, 5}};                        // whose edges are seen: a source of vision each
  std::optional<double> characteristic_length_m;  // else the natural lengths of each pose
  double length_unit_m = 1;                       // that the indices are computed in

  void Check(const JudgedRobot& robot) const;  // throws std::invalid_argument
};

// A source that could not be computed, and why.
struct MissingSource {
  std::string name, reason;
};

struct Indices {
  double determinant = 0, manipulability = 0;
  ConditionNumbers plain, normalized;
  CharacteristicLengths lengths;                    // in the unit
  std::optional<ThreePointConditions> three_point;  // of a hexapod
};

// Members without a value have none at this pose or for this robot.
struct PoseAccuracy {
  Eigen::VectorXd joint_readings_m;
  FullInverseJacobian inverse_jacobian;  // SI
  PlatformJacobian jacobian;             // with the pose's status
  std::optional<MaximalErrors> max_error;
  std::optional<ErrorSets> sets;
  std::optional<Indices> indices;
  std::optional<VertexCheck> vertex_check;
  std::vector<SourceErrors> sources;
  std::vector<MissingSource> missing_sources;
  std::optional<SourceErrors> together;  // of all sources
};

// At a pose that the mechanism can take; where it is singular there is a status, the motions that are free,
// and the determinant only.
PoseAccuracy AccuracyAt(const JudgedRobot& robot, const Rigid3& base_from_platform,
                        const PoseAccuracyOptions& options);

// The same without what takes long and only a single pose needs: sets, vertex check, sources.
PoseAccuracy QuickAccuracyAt(const JudgedRobot& robot, const Rigid3& base_from_platform,
                             const PoseAccuracyOptions& options);

}  // namespace legible
