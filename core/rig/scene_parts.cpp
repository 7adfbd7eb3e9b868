#include "core/rig/scene_parts.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/vision/predicted_legs.h"

namespace legible {
namespace {

// In leg radii.
constexpr double kBallRadii = 1.45, kPostRadii = 0.8;
constexpr double kPlateGapRadii = 0.8;  // from the outermost joint to the plate
constexpr double kPlatformThicknessRadii = 0.5;
constexpr double kBoardHalfWidthRadii = 4, kBoardBeforeRadii = 4, kBoardBeyondRadii = 1;

constexpr double kPlatformMargin_m = 0.003, kBaseMargin_m = 0.035, kBaseThickness_m = 0.02;
constexpr double kLeastRoomRadius_m = 3, kGroundBelowCamera_m = 0.3;

using Points = std::vector<Eigen::Vector3d>;
using Triangle = std::array<Eigen::Vector3d, 3>;

Eigen::Vector3d Centre(const Points& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

double LargestRadius(const LegsInCamera& legs) {
  double radius_m = 0;
  for (const LegInCamera& leg : legs) radius_m = std::max(radius_m, leg.radius_m);
  return radius_m;
}

// The mean plane of joints; `up` points to the side on which the plate lies.
struct JointPlane {
  Eigen::Vector3d centre, up;
  Eigen::Matrix<double, 3, 2> along;

  double Height(const Eigen::Vector3d& x) const { return up.dot(x - centre); }
  Eigen::Vector3d Lifted(const Eigen::Vector2d& x, double height_m) const {
    return centre + along * x + height_m * up;
  }
};

JointPlane PlaneOf(const Points& joints, const Eigen::Vector3d& away_from) {
  JointPlane plane;
  plane.centre = Centre(joints);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& joint : joints)
    scatter += (joint - plane.centre) * (joint - plane.centre).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter);
  plane.up = axes.eigenvectors().col(0);
  plane.along = axes.eigenvectors().rightCols<2>();
  if (plane.Height(away_from) > 0) plane.up = -plane.up;
  return plane;
}

// The corners of the outline through the joints, each moved outward, in angular order.
std::vector<Eigen::Vector2d> Outline(const JointPlane& plane, const Points& joints, double margin_m) {
  std::vector<Eigen::Vector2d> corners;
  for (const Eigen::Vector3d& joint : joints) {
    const Eigen::Vector2d corner = plane.along.transpose() * (joint - plane.centre);
    corners.push_back(corner + margin_m * corner.normalized());
  }
  std::sort(corners.begin(), corners.end(), [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return std::atan2(a.y(), a.x()) < std::atan2(b.y(), b.x());
  });
  return corners;
}

// A plate whose joints stick to it, on the far side from `away_from`.
struct Plate {
  JointPlane plane;
  double near_m, far_m;  // heights of its faces over the joints' plane
};

Plate PlateOver(const Points& joints, const Eigen::Vector3d& away_from, double gap_m, double thickness_m) {
  const JointPlane plane = PlaneOf(joints, away_from);
  double outermost_m = 0;
  for (const Eigen::Vector3d& joint : joints) outermost_m = std::max(outermost_m, plane.Height(joint));
  return {plane, outermost_m + gap_m, outermost_m + gap_m + thickness_m};
}

void AddPlate(const Plate& plate, const std::vector<Eigen::Vector2d>& outline, const Paint& paint,
              SceneParts& parts) {
  Face near_face{{}, paint}, far_face{{}, paint};
  for (size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d &a = outline[i], &b = outline[(i + 1) % outline.size()];
    const auto at = [&](const Eigen::Vector2d& x, double height_m) {
      return plate.plane.Lifted(x, height_m);
    };
    const Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    near_face.triangles_in_camera.push_back(
        Triangle{at(middle, plate.near_m), at(a, plate.near_m), at(b, plate.near_m)});
    far_face.triangles_in_camera.push_back(
        Triangle{at(middle, plate.far_m), at(a, plate.far_m), at(b, plate.far_m)});
    parts.faces.push_back({{Triangle{at(a, plate.near_m), at(b, plate.near_m), at(a, plate.far_m)},
                            Triangle{at(b, plate.near_m), at(b, plate.far_m), at(a, plate.far_m)}},
                           paint});
  }
  parts.faces.push_back(near_face);
  parts.faces.push_back(far_face);
}

// The ball at a leg's end, and the post that holds it to the plate.
void AddJoint(const Eigen::Vector3d& joint, double leg_radius_m, const Plate& plate, const Paint& paint,
              SceneParts& parts) {
  parts.balls.push_back({joint, kBallRadii * leg_radius_m, paint});
  const Eigen::Vector3d foot = joint + (plate.near_m - plate.plane.Height(joint)) * plate.plane.up;
  parts.cylinders.push_back({joint, foot, kPostRadii * leg_radius_m, paint});
}

void AddSquare(const Eigen::Vector3d& centre, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
               const Paint& paint, SceneParts& parts) {
  parts.faces.push_back({{Triangle{centre - a - b, centre + a - b, centre - a + b},
                          Triangle{centre + a + b, centre + a - b, centre - a + b}},
                         paint});
}

// A board before a leg, as seen from the camera.
void AddBoard(const LegInCamera& leg, const Paint& paint, SceneParts& parts) {
  const Eigen::Vector3d middle = leg.AxisPoint(0.5), axis = leg.b_in_camera - leg.a_in_camera;
  const Eigen::Vector3d across = axis.cross(middle).normalized();
  const Eigen::Vector3d before = across.cross(axis).normalized();  // towards the camera, or away from it
  const double side = before.dot(middle) > 0 ? -1 : 1;
  const Eigen::Vector3d half_length = 0.5 * axis + kBoardBeyondRadii * leg.radius_m * axis.normalized();
  AddSquare(middle + side * kBoardBeforeRadii * leg.radius_m * before, half_length,
            kBoardHalfWidthRadii * leg.radius_m * across, paint, parts);
}

Points BaseJoints(const LegsInCamera& legs) {
  Points joints;
  for (const LegInCamera& leg : legs) joints.push_back(leg.a_in_camera);
  return joints;
}

Points PlatformJoints(const LegsInCamera& legs) {
  Points joints;
  for (const LegInCamera& leg : legs) joints.push_back(leg.b_in_camera);
  return joints;
}

Plate BasePlate(const LegsInCamera& legs) {
  return PlateOver(BaseJoints(legs), Centre(PlatformJoints(legs)), kPlateGapRadii * LargestRadius(legs),
                   kBaseThickness_m);
}

}  // namespace

SceneParts RoomParts(const SimulationTruth& truth, const SceneOptions& options) {
  const Plate base = BasePlate(PlaceLegs(truth.robot, truth.camera_from_base, truth.robot.home));
  const Eigen::Vector3d camera = Eigen::Vector3d::Zero();
  const double depth_m = std::max(base.far_m, base.plane.Height(camera) + kGroundBelowCamera_m);
  const double radius_m = std::max(kLeastRoomRadius_m, 1.5 * base.plane.centre.norm() + 1);
  const Paint paint{options.ground_grey, true};
  SceneParts parts;
  AddSquare(base.plane.Lifted(Eigen::Vector2d::Zero(), depth_m), radius_m * base.plane.along.col(0),
            radius_m * base.plane.along.col(1), paint, parts);
  parts.balls.push_back({base.plane.centre, radius_m, paint});
  return parts;
}

SceneParts BaseParts(const SimulationTruth& truth, const SceneOptions& options) {
  const LegsInCamera legs = PlaceLegs(truth.robot, truth.camera_from_base, truth.robot.home);
  const Plate base = BasePlate(legs);
  SceneParts parts;
  AddPlate(base, Outline(base.plane, BaseJoints(legs), kBaseMargin_m), {options.plate_grey}, parts);
  for (const LegInCamera& leg : legs)
    AddJoint(leg.a_in_camera, leg.radius_m, base, {options.joint_grey}, parts);
  return parts;
}

SceneParts MovingParts(const SimulationTruth& truth, const SceneOptions& options,
                       const Rigid3& base_from_platform, const std::vector<int>& covered_legs) {
  const LegsInCamera legs = PlaceLegs(truth.robot, truth.camera_from_base, base_from_platform);
  const Points joints = PlatformJoints(legs);
  const double radius_m = LargestRadius(legs);
  const Plate plate = PlateOver(joints, Centre(BaseJoints(legs)), kPlateGapRadii * radius_m,
                                kPlatformThicknessRadii * radius_m);
  SceneParts parts;
  AddPlate(plate, Outline(plate.plane, joints, kPlatformMargin_m), {options.plate_grey}, parts);
  for (const LegInCamera& leg : legs) {
    parts.cylinders.push_back({leg.a_in_camera, leg.b_in_camera, leg.radius_m, {options.leg_grey}});
    AddJoint(leg.b_in_camera, leg.radius_m, plate, {options.joint_grey}, parts);
  }
  for (const int leg : covered_legs) {
    if (leg < 0 || leg >= kLegCount)
      throw std::invalid_argument("a covered leg must be 0 to 5, not " + std::to_string(leg));
    AddBoard(legs[static_cast<size_t>(leg)], {options.plate_grey}, parts);
  }
  return parts;
}

}  // namespace legible
