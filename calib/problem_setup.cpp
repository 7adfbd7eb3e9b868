#include "calib/problem_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "calib/image_information.h"
#include "calib/tag_weights.h"

namespace legible {
namespace {

constexpr double kHeldJointSigma_m = 1e-6;  // by which base joints that are held may leave the drawing

LegPoints DrawnJoints(const GoughStewart& robot, Eigen::Vector3d Leg::*joint) {
  LegPoints joints;
  for (size_t i = 0; i < kLegCount; ++i) joints[i] = robot.legs[i].*joint;
  return joints;
}

SharedParameters ParametersOf(const Camera& camera, const GoughStewart& robot,
                              const Rigid3& camera_from_base) {
  SharedParameters shared;
  shared.camera = ParametersOf(camera);
  for (size_t i = 0; i < kLegCount; ++i) {
    const Leg& leg = robot.legs[i];
    shared.legs[i] << camera_from_base * leg.base_joint_m, leg.platform_joint_m, leg.radius_m,
        leg.joint_offset_m, Eigen::Vector4d::Zero();
  }
  return shared;
}

std::bitset<kSharedParameterCount> FreeParameters(const LegCalibrationInput& input,
                                                  const LegCalibrationOptions& options) {
  std::bitset<kSharedParameterCount> free;
  const HeldParameters& hold = options.hold;
  for (size_t i = 0; i < 4; ++i) free[i] = i < 2 ? !hold.focal_length : !hold.principal_point;
  for (size_t i = 0; i < static_cast<size_t>(input.camera.lens); ++i) free[4 + i] = !hold.distortion;
  for (int leg = 0; leg < kLegCount; ++leg) {
    const auto set = [&](int entry, int count, bool value) {
      for (int i = 0; i < count; ++i) free[static_cast<size_t>(FirstParameterOfLeg(leg) + entry + i)] = value;
    };
    set(leg_parameter::kBaseJoint, 3, !(hold.base_joints && hold.camera_pose));
    set(leg_parameter::kPlatformJoint, 3, !hold.platform_joints && options.rigid_platform);
    set(leg_parameter::kRadius, 1, !hold.radii);
    set(leg_parameter::kJointOffset, 1,
        !hold.joint_offsets && options.rigid_platform && options.use_joint_readings);
  }
  return free;
}

// How far shading may move each leg's edge in all images alike.
double LastingShading(const LegCalibrationInput& input, const LegCalibrationOptions& options, int leg,
                      int edge) {
  double squares = 0, count = 0;
  for (const ImageObservation& image : input.images)
    for (const EdgeObservation& observation : image.edges) {
      if (observation.leg != leg || observation.edge != edge) continue;
      squares += observation.common_sigma_px * observation.common_sigma_px;
      count += 1;
    }
  return count > 0 ? options.lasting_shading * std::sqrt(squares / count) : 0;
}

CameraPrior CameraPriorOf(const CameraParameters& value, const Eigen::MatrixXd& information) {
  CameraPrior prior;
  prior.value = value;
  const Eigen::MatrixXd root = information.size() > 0 ? RootOf(information) : Eigen::MatrixXd();
  prior.root.setZero(root.rows(), kCameraParameterCount);
  prior.root.leftCols(root.cols()) = root;
  return prior;
}

// Adds what is known beforehand to the problem, about the drawing's and the guessed camera's values.
void AddPriors(const LegCalibrationInput& input, const LegCalibrationOptions& options,
               EstimationProblem& problem) {
  const SharedParameters nominal = ParametersOf(input.camera, input.drawing, input.camera_from_base);
  const auto add = [&](int parameter, const std::optional<double>& sigma) {
    if (sigma && problem.free[static_cast<size_t>(parameter)])
      problem.priors.push_back({parameter, Parameter(nominal, parameter), *sigma});
  };
  const PriorKnowledge& known = input.known;
  problem.camera_prior = CameraPriorOf(nominal.camera, known.camera_information);
  problem.board = input.board;
  for (int i = 0; i < 2; ++i) add(i, known.focal_length_px);
  for (int i = 2; i < 4; ++i) add(i, known.principal_point_px);
  for (int i = 4; i < kCameraParameterCount; ++i) add(i, known.distortion);
  for (int leg = 0; leg < kLegCount; ++leg) {
    const int at = FirstParameterOfLeg(leg);
    for (int i = 0; i < 3; ++i) add(at + leg_parameter::kPlatformJoint + i, known.platform_joint_m);
    add(at + leg_parameter::kRadius, known.radius_m);
    add(at + leg_parameter::kJointOffset, known.joint_offset_m);
    for (int i = 0; i < 4; ++i) {
      const double sigma_px = LastingShading(input, options, leg, i / 2);
      const int parameter = at + leg_parameter::kShading + i;
      problem.free[static_cast<size_t>(parameter)] = sigma_px > 0;
      if (sigma_px > 0) add(parameter, sigma_px);
    }
  }
  const double drawn_sigma_m = options.hold.base_joints ? kHeldJointSigma_m : known.base_joint_m.value_or(0);
  if (problem.free[static_cast<size_t>(FirstParameterOfLeg(0))]) problem.base_joint_sigma_m = drawn_sigma_m;
}

TagPlacement PlacementOf(const TagGroup& group, const Rigid3& camera_from_base) {
  const bool on_base = group.carrier == TagCarrier::kBase;
  return {group.carrier, on_base ? camera_from_base * group.carrier_from_group : group.carrier_from_group,
          group.carrier_from_group, group.translation_sigma_m, group.rotation_sigma_rad};
}

// Each tag of a group on the base once, where the images have it in the median.
void AppendBaseTags(const ObservedTagGroup& observed, size_t group, std::vector<TagObservation>& tags) {
  for (const Tag& tag : observed.group.tags) {
    std::vector<TagDetection> seen;
    for (const auto& image : observed.detections)
      std::copy_if(image.begin(), image.end(), std::back_inserter(seen),
                   [&](const TagDetection& detection) { return detection.id == tag.id; });
    if (seen.empty()) continue;
    const TagCorners median = MedianCorners(seen);
    tags.push_back({group, tag.corners_m, median.corners_px, median.covariances_px2});
  }
}

void AppendPlatformTags(const ObservedTagGroup& observed, size_t group, PoseUnit& unit) {
  for (const Tag& tag : observed.group.tags)
    for (const TagDetection& detection : observed.detections[static_cast<size_t>(unit.image)])
      if (detection.id == tag.id)
        unit.tags.push_back({group, tag.corners_m, detection.corners_px, detection.covariances_px2});
}

// The poses of one image that has edges, with the joint readings.
void AddUnits(const LegCalibrationInput& input, const LegCalibrationOptions& options, size_t image,
              const Rigid3& camera_from_platform, EstimationProblem& problem) {
  const ImageObservation& observation = input.images[image];
  PoseUnit whole{static_cast<int>(image), options.rigid_platform, camera_from_platform, {}, {}};
  for (int leg = 0; leg < kLegCount; ++leg) {
    LegObservation of_leg{leg, {}, {}, 1};
    if (options.use_joint_readings && options.rigid_platform && observation.joint_readings_m) {
      of_leg.reading_m = (*observation.joint_readings_m)[leg];
      of_leg.reading_sigma_m = input.known.joint_reading_m.value_or(options.default_joint_reading_sigma_m);
    }
    whole.legs.push_back(of_leg);
  }
  if (options.rigid_platform) {
    problem.units.push_back(std::move(whole));
    return;
  }
  for (const LegObservation& of_leg : whole.legs) {
    const LegParameters& leg = problem.shared.legs[static_cast<size_t>(of_leg.leg)];
    const Eigen::Vector3d tip = camera_from_platform * leg.segment<3>(leg_parameter::kPlatformJoint);
    problem.units.push_back(
        {static_cast<int>(image), false, {}, tip - leg.segment<3>(leg_parameter::kBaseJoint), {of_leg}});
  }
}

void CheckTags(const LegCalibrationInput& input, const LegCalibrationOptions& options) {
  for (const ObservedTagGroup& tags : input.tags) {
    if (tags.detections.size() != input.images.size())
      throw std::invalid_argument("CalibrateLegs: a tag group must hold the detections of each image");
    if (tags.group.carrier == TagCarrier::kPlatform && !options.rigid_platform)
      throw std::invalid_argument(fmt::format(
          "CalibrateLegs: the tags {} are on the platform, which is not taken to be rigid", tags.group.name));
    if (!(tags.group.translation_sigma_m > 0 && tags.group.rotation_sigma_rad > 0))
      throw std::invalid_argument(
          fmt::format("CalibrateLegs: the place of the tags {} needs sigmas", tags.group.name));
  }
}

}  // namespace

void CheckInput(const LegCalibrationInput& input, const LegCalibrationOptions& options) {
  if (input.start && input.start->camera_from_platform.size() != input.images.size())
    throw std::invalid_argument("CalibrateLegs: the start must hold a pose for each image");
  for (const ImageObservation& image : input.images)
    for (const EdgeObservation& edge : image.edges) {
      if (edge.leg < 0 || edge.leg >= kLegCount || edge.edge < 0 || edge.edge > 1)
        throw std::invalid_argument(fmt::format("CalibrateLegs: image {} names leg {}, edge {}", image.name,
                                                edge.leg + 1, edge.edge + 1));
      for (const EdgeSample& sample : edge.samples)
        if (!(sample.sigma_px > 0) || !std::isfinite(sample.sigma_px))
          throw std::invalid_argument(
              fmt::format("CalibrateLegs: image {} has a sample of sigma {} px on leg {}", image.name,
                          sample.sigma_px, edge.leg + 1));
    }
  CheckTags(input, options);
  if (input.board && input.board->camera.lens != input.camera.lens)
    throw std::invalid_argument("CalibrateLegs: the board was seen through another lens model");
}

CalibrationStart StartOf(const LegCalibrationInput& input) {
  if (input.start) return *input.start;
  CalibrationStart start{input.camera, input.drawing, input.camera_from_base, {}};
  for (const ImageObservation& image : input.images) {
    Rigid3 base_from_platform = input.drawing.home;
    if (image.joint_readings_m) {
      const auto fk = ForwardKinematics(input.drawing, *image.joint_readings_m, input.drawing.home);
      if (fk.status == ForwardKinematicsStatus::kConverged) base_from_platform = fk.base_from_platform;
    }
    start.camera_from_platform.push_back(input.camera_from_base * base_from_platform);
  }
  return start;
}

EstimationProblem ProblemOf(const LegCalibrationInput& input, const LegCalibrationOptions& options,
                            const CalibrationStart& start) {
  EstimationProblem problem;
  problem.camera = input.camera;
  problem.shared = ParametersOf(start.camera, start.robot, start.camera_from_base);
  problem.free = FreeParameters(input, options);
  AddPriors(input, options, problem);
  // What is held keeps the drawing's and the guessed camera's values, wherever the iterations start.
  const SharedParameters nominal = ParametersOf(input.camera, input.drawing, start.camera_from_base);
  for (int i = 0; i < kSharedParameterCount; ++i)
    if (!problem.free[static_cast<size_t>(i)]) Parameter(problem.shared, i) = Parameter(nominal, i);
  problem.drawn_base_joints = DrawnJoints(input.drawing, &Leg::base_joint_m);
  problem.drawn_platform_joints = DrawnJoints(input.drawing, &Leg::platform_joint_m);
  for (size_t image = 0; image < input.images.size(); ++image)
    if (!input.images[image].edges.empty())
      AddUnits(input, options, image, start.camera_from_platform[image], problem);
  AddTags(input.tags, start.camera_from_base, problem);
  return problem;
}

void AddTags(const std::vector<ObservedTagGroup>& groups, const Rigid3& camera_from_base,
             EstimationProblem& problem) {
  for (size_t group = 0; group < groups.size(); ++group) {
    problem.tag_placements.push_back(PlacementOf(groups[group].group, camera_from_base));
    if (groups[group].group.carrier == TagCarrier::kBase) {
      AppendBaseTags(groups[group], group, problem.base_tags);
      continue;
    }
    for (PoseUnit& unit : problem.units) AppendPlatformTags(groups[group], group, unit);
  }
}

}  // namespace legible
