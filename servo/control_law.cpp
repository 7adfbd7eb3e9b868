#include "servo/control_law.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/geometry/tangents.h"
#include "servo/image_errors.h"
#include "servo/interaction.h"

namespace legible {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
// Two numbers say where an edge or a direction is; where no noise is given they weigh as if it were this, in
// half image widths or rad.
constexpr double kLeastSigma = 1e-6;
// An edge says one number of the platform's six, for its leg turns about A, and a leg two at most.
constexpr int kLeastEdges = 6, kLeastLegs = 3;

// Rows of a task, gathered.
struct Task {
  bool is_weighted;
  TaskMatrix interaction;  // by the paper's twist
  TaskVector error;
  int rows = 0;
  Matrix6d noise = Matrix6d::Zero();  // covariance of interaction^T error where all count alike

  explicit Task(bool weighted) : is_weighted(weighted), interaction(kMostTaskRows, 6), error(kMostTaskRows) {}

  // Two rows with the covariance of the value: divided by its square root if they are weighted.
  void Add(Eigen::Matrix<double, 2, 6> derivative, Eigen::Vector2d value, const Eigen::Matrix2d& covariance) {
    if (is_weighted) {
      const Eigen::LLT<Eigen::Matrix2d> root(covariance +
                                             kLeastSigma * kLeastSigma * Eigen::Matrix2d::Identity());
      derivative = root.matrixL().solve(derivative).eval();
      value = root.matrixL().solve(value).eval();
    } else {
      noise += derivative.transpose() * covariance * derivative;
    }
    interaction.middleRows<2>(rows) = derivative;
    error.segment<2>(rows) = value;
    rows += 2;
  }
};

// What a law knows of the robot at the moment.
struct Situation {
  const ServoModel& model;
  const ServoGoal& goal;
  const ControlLawOptions& options;
  EdgesByLeg seen;  // of the legs that are looked at
  Vector6d length_m;
  LegDirections directions;  // for the interaction matrices
};

EdgesByLeg OfLegs(const SeenEdges& seen, const std::bitset<kLegCount>& legs) {
  EdgesByLeg edges = ByLeg(seen);
  for (size_t leg = 0; leg < kLegCount; ++leg)
    if (!legs[leg]) edges[leg] = {};
  return edges;
}

// Which of the goal's legs are not seen, or by half.
void NoteUnseen(const Situation& now, LawResult& result) {
  for (size_t leg = 0; leg < kLegCount; ++leg) {
    int wanted = 0, seen = 0;
    for (size_t edge = 0; edge < 2; ++edge) {
      // The pose is fitted to whatever is seen.
      const bool is_wanted = now.options.mode == ControlMode::kPose || now.goal.edges[leg][edge];
      wanted += is_wanted;
      seen += is_wanted && now.seen[leg][edge];
    }
    result.unseen[leg] = now.options.legs[leg] && seen == 0 && wanted > 0;
    result.half_seen[leg] = now.options.legs[leg] && seen == 1 && wanted == 2;
  }
}

LegDirections DirectionsOf(const ServoModel& model, const Rigid3& base_from_platform) {
  LegDirections directions;
  for (size_t i = 0; i < kLegCount; ++i)
    directions.col(static_cast<Eigen::Index>(i)) =
        (model.camera_from_base * (base_from_platform * model.robot.legs[i].platform_joint_m) -
         model.base_joint_in_camera_m[i])
            .normalized();
  return directions;
}

void UseSeenDirections(Situation& now) {
  for (size_t leg = 0; leg < kLegCount; ++leg) {
    const auto& [edge_1, edge_2] = now.seen[leg];
    if (edge_1 && edge_2)
      now.directions.col(static_cast<Eigen::Index>(leg)) = DirectionFromEdges(edge_1->normal, edge_2->normal);
  }
}

// e = seen x goal of one edge in the pixel frame and its interaction (eq. 37-39), in the two directions
// across the goal's line, where all of it lies.
void AddEdge(const Situation& now, const SeenEdge& seen, const SeenEdge& goal, Task& task) {
  const auto leg = static_cast<size_t>(seen.leg);
  // The interaction matrix takes the direction to lie in the edge's plane.
  const Eigen::Vector3d u = now.directions.col(seen.leg);
  const Eigen::Vector3d in_plane = (u - seen.normal * seen.normal.dot(u)).normalized();
  const Eigen::Vector3d& a = now.model.base_joint_in_camera_m[leg];
  const ImageLine line = ToImage(now.model, seen.normal), goal_line = ToImage(now.model, goal.normal);
  const Eigen::Matrix<double, 3, 2> across = TangentsOf(goal_line.line);
  const Eigen::Matrix<double, 2, 3> by_normal = -across.transpose() * Skew(goal_line.line) * line.d_normal;
  task.Add(by_normal * EdgeByDirection(a, in_plane, seen.normal) *
               DirectionInteraction(a, in_plane, now.length_m[seen.leg]),
           across.transpose() * line.line.cross(goal_line.line),
           by_normal * seen.normal_covariance * by_normal.transpose());
}

// e = u x u* of one leg (section 3.1.1), likewise.
void AddDirection(const Situation& now, const SeenEdge& edge_1, const SeenEdge& edge_2,
                  const Eigen::Vector3d& goal, Task& task) {
  const auto leg = static_cast<size_t>(edge_1.leg);
  const Eigen::Vector3d seen = DirectionFromEdges(edge_1.normal, edge_2.normal);
  const Eigen::Matrix<double, 3, 2> across = TangentsOf(goal);
  const Eigen::Matrix<double, 2, 3> by_direction = -across.transpose() * Skew(goal);
  task.Add(by_direction * DirectionInteraction(now.model.base_joint_in_camera_m[leg],
                                               now.directions.col(edge_1.leg), now.length_m[edge_1.leg]),
           across.transpose() * seen.cross(goal),
           by_direction * DirectionCovariance(edge_1, edge_2) * by_direction.transpose());
}

Task TaskOf(const Situation& now, LawResult& result) {
  Task task(now.options.is_weighted);
  const bool by_edges = now.options.mode == ControlMode::kEdges;
  for (size_t leg = 0; leg < kLegCount; ++leg) {
    const auto& seen = now.seen[leg];
    const int rows_before = task.rows;
    if (by_edges) {
      for (size_t edge = 0; edge < 2; ++edge)
        if (seen[edge] && now.goal.edges[leg][edge])
          AddEdge(now, *seen[edge], *now.goal.edges[leg][edge], task);
      result.edges += (task.rows - rows_before) / 2;
    } else if (seen[0] && seen[1] && now.goal.directions[leg]) {
      AddDirection(now, *seen[0], *seen[1], *now.goal.directions[leg], task);
      result.edges += 2;
    }
    result.legs += task.rows > rows_before;
  }
  task.interaction.conservativeResize(task.rows, 6);
  task.error.conservativeResize(task.rows);
  return task;
}

// The paper's twist by one whose v is that at the platform's origin, in these units: singular values then do
// not depend on where the camera stands.
Matrix6d TwistByPlatformMotion(const ServoModel& model, const Rigid3& base_from_platform) {
  const Eigen::Vector3d origin_in_camera = model.camera_from_base * base_from_platform.translation;
  Matrix6d twist = Matrix6d::Identity();
  twist.topRightCorner<3, 3>() = Skew(origin_in_camera);
  return twist * RotationsByRadius(model).asDiagonal();
}

// Of the motion that the errors tell worst, by the noise of these; infinite where one is not told at all.
double LargestMotionSigma(const Task& task, const Matrix6d& twist, const LeastSquares& squares) {
  if (task.is_weighted) return 1 / squares.singular_values[5];
  // The covariance is (L^T L)^-1 L^T S L (L^T L)^-1, and L^T L = R^T R.
  const auto normal_solve = [&squares](const Matrix6d& right) -> Matrix6d {
    const auto triangle = squares.triangle.triangularView<Eigen::Upper>();
    return triangle.solve(triangle.transpose().solve(right).eval());
  };
  const Matrix6d half = normal_solve(twist.transpose() * task.noise * twist);
  const Matrix6d covariance = normal_solve(half.transpose());
  if (!covariance.allFinite()) return std::numeric_limits<double>::infinity();
  return std::sqrt(
      Eigen::SelfAdjointEigenSolver<Matrix6d>(covariance, Eigen::EigenvaluesOnly).eigenvalues()[5]);
}

// Whether what is seen is ground to move on.
bool IsCertainEnough(const ControlLawOptions& options, const LawResult& result) {
  return result.Conditioning() >= options.least_conditioning &&
         result.motion_sigma_m <= result.most_motion_sigma_m;
}

// The twist that the features ask for, as joint motion: -J L^+ e.
void ServoFeatures(const Situation& now, LawResult& result) {
  Task task = TaskOf(now, result);
  if (result.edges < kLeastEdges || result.legs < kLeastLegs) {
    result.status = LawStatus::kTooFewEdges;
    return;
  }
  const Matrix6d twist = TwistByPlatformMotion(now.model, result.base_from_platform);
  task.interaction *= twist;
  const LeastSquares squares = SolveLeastSquares(task.interaction, task.error, now.options.inverse);
  result.singular_values = squares.singular_values;
  result.rank = squares.rank;
  result.motion_sigma_m = LargestMotionSigma(task, twist, squares);
  if (!IsCertainEnough(now.options, result)) {
    result.status = LawStatus::kIllConditionedEdges;
    return;
  }
  const Matrix6d inverse_jacobian = CameraInverseJacobian(now.model, now.directions) * twist;
  result.to_go_m = -inverse_jacobian * squares.solution;
  result.metric = squares.triangle * inverse_jacobian.inverse();
}

void ServoPose(const Situation& now, const Rigid3& base_from_platform, LawResult& result) {
  const Vector6d scale = RotationsByRadius(now.model);
  const Vector6d to_go =
      scale.cwiseInverse().cwiseProduct(Displacement(base_from_platform, *now.goal.base_from_platform));
  const Matrix6d jacobian = InverseJacobian(now.model.robot, base_from_platform) * scale.asDiagonal();
  result.to_go_m = jacobian * to_go;
  result.metric = jacobian.inverse();
  result.error = to_go.norm();
}

void ServoPoseFromEdges(const Situation& now, const LawInput& input, LawResult& result) {
  SeenEdges seen;
  std::bitset<kLegCount> legs;
  for (const SeenEdge& edge : input.seen.edges) {
    const auto leg = static_cast<size_t>(edge.leg);
    if (!now.options.legs[leg]) continue;
    seen.edges.push_back(edge);
    legs.set(leg);
  }
  result.edges = static_cast<int>(seen.edges.size());
  result.legs = static_cast<int>(legs.count());
  const EdgePose pose =
      FitPoseToEdges(now.model.robot, now.model.camera_from_base, seen, result.base_from_platform);
  if (pose.status == EdgePoseStatus::kConverged) {
    const Vector6d scale = RotationsByRadius(now.model).cwiseInverse();
    const Matrix6d covariance = scale.asDiagonal() * pose.covariance * scale.asDiagonal();
    result.error_noise = std::sqrt(covariance.trace());
    // As of the edges' whitened interaction matrix.
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(covariance, Eigen::EigenvaluesOnly);
    result.singular_values = eigen.eigenvalues().cwiseSqrt().cwiseInverse();
    result.motion_sigma_m = 1 / result.singular_values[5];
    if (!IsCertainEnough(now.options, result))
      result.status = LawStatus::kIllConditionedEdges;
    else
      ServoPose(now, pose.base_from_platform, result);
    return;
  }
  result.singular_values.setConstant(kNan);
  const bool are_enough = result.edges >= kLeastEdges && result.legs >= kLeastLegs;
  if (pose.status == EdgePoseStatus::kNotConverged)
    result.status = LawStatus::kNoPoseFromEdges;
  else
    result.status = are_enough ? LawStatus::kIllConditionedEdges : LawStatus::kTooFewEdges;
}

// How far the robot is from a singularity, and where it is; false where it cannot be driven from there.
bool JudgeRobot(const ServoModel& model, const LawInput& input, const ControlLawOptions& options,
                LawResult& result) {
  result.base_from_platform = input.guess_base_from_platform;
  if (!input.joint_readings_m.allFinite()) {
    result.status = LawStatus::kBadReadings;
    return false;
  }
  const auto forward = ForwardKinematics(model.robot, input.joint_readings_m, input.guess_base_from_platform);
  if (forward.status != ForwardKinematicsStatus::kConverged) {
    result.status =
        forward.status == ForwardKinematicsStatus::kSingular ? LawStatus::kRobotSingular : LawStatus::kNoPose;
    return false;
  }
  result.base_from_platform = forward.base_from_platform;
  result.singular_values = RobotSingularValues(model, forward.base_from_platform);
  result.robot_conditioning = result.Conditioning();
  if (result.robot_conditioning >= options.least_robot_conditioning) return true;
  result.status = LawStatus::kRobotSingular;
  return false;
}

}  // namespace

const char* ToString(ControlMode mode) {
  switch (mode) {
    case ControlMode::kEdges:
      return "edges";
    case ControlMode::kDirections:
      return "directions";
    case ControlMode::kPose:
      return "pose";
    case ControlMode::kJoints:
      return "joints";
  }
  throw std::invalid_argument("ToString: not a ControlMode");
}

const char* UnitOf(ControlMode mode) {
  if (mode == ControlMode::kEdges) return "px";
  return mode == ControlMode::kDirections ? "rad" : "m";
}

void ControlLawOptions::Check() const {
  inverse.Check();
  if (legs.none()) throw std::invalid_argument("ControlLawOptions: no leg is looked at");
  if (!(least_conditioning >= 0 && least_conditioning < 1) ||
      !(least_robot_conditioning >= 0 && least_robot_conditioning < 1))
    throw std::invalid_argument("ControlLawOptions: the least conditioning must be in [0, 1)");
  if (!(most_motion_sigma > 0))
    throw std::invalid_argument("ControlLawOptions: most_motion_sigma must be positive");
}

bool LooksAtImages(const ControlLawOptions& options) {
  const bool by_readings =
      options.mode == ControlMode::kJoints ||
      (options.mode == ControlMode::kPose && options.pose_source == PoseSource::kReadings);
  return !by_readings;
}

void DemandGoal(const ServoGoal& goal, const ControlLawOptions& options) {
  const auto demand = [](bool is_there, const char* what) {
    if (!is_there) throw std::invalid_argument(what);
  };
  if (options.mode == ControlMode::kPose)
    demand(goal.base_from_platform.has_value(),
           "the goal's edges lead to no pose, which the mode pose needs");
  if (options.mode == ControlMode::kJoints)
    demand(goal.joint_readings_m.has_value(),
           "the goal's edges lead to no joint readings, which the mode joints needs");
  int legs = 0;
  for (size_t leg = 0; leg < kLegCount; ++leg) {
    const bool has_edges = goal.edges[leg][0] || goal.edges[leg][1];
    const bool counts =
        options.mode == ControlMode::kDirections ? goal.directions[leg].has_value() : has_edges;
    legs += options.legs[leg] && counts;
  }
  const bool looks = options.mode == ControlMode::kEdges || options.mode == ControlMode::kDirections;
  if (looks) demand(legs >= kLeastLegs, "the goal shows fewer than three of the legs that are looked at");
}

LawResult EvaluateLaw(const ServoModel& model, const ServoGoal& goal, const LawInput& input,
                      const ControlLawOptions& options) {
  LawResult result;
  result.most_motion_sigma_m = options.most_motion_sigma * model.platform_radius_m;
  Situation now{model, goal, options, OfLegs(input.seen, options.legs), {}, {}};
  const ImageErrors errors = MeasureImageErrors(model, now.seen, goal);
  result.edge_error_px = errors.edge_px;
  result.direction_error_rad = errors.direction_rad;
  if (LooksAtImages(options)) NoteUnseen(now, result);
  result.error = kNan;
  if (!JudgeRobot(model, input, options, result)) return result;
  now.length_m = LegLengths(model.robot, input.joint_readings_m);
  now.directions = DirectionsOf(model, result.base_from_platform);
  if (options.direction_source == DirectionSource::kEdges) UseSeenDirections(now);
  switch (options.mode) {
    case ControlMode::kEdges:
      result.error = errors.edge_px;
      result.error_noise = errors.edge_noise_px;
      ServoFeatures(now, result);
      break;
    case ControlMode::kDirections:
      result.error = errors.direction_rad;
      result.error_noise = errors.direction_noise_rad;
      ServoFeatures(now, result);
      break;
    case ControlMode::kPose:
      if (options.pose_source == PoseSource::kReadings)
        ServoPose(now, result.base_from_platform, result);
      else
        ServoPoseFromEdges(now, input, result);
      break;
    case ControlMode::kJoints:
      result.to_go_m = *goal.joint_readings_m - input.joint_readings_m;
      result.error = result.to_go_m.cwiseAbs().maxCoeff();
      break;
  }
  return result;
}

}  // namespace legible
