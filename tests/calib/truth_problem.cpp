#include "tests/calib/truth_problem.h"

namespace legible {
namespace {

std::bitset<kSharedParameterCount> FreeParameters(LensModel lens, const TruthProblemOptions& options) {
  std::bitset<kSharedParameterCount> free;
  for (size_t i = 0; i < 4 + static_cast<size_t>(lens); ++i) free.set(i);
  for (int leg = 0; leg < kLegCount; ++leg) {
    const size_t first = static_cast<size_t>(FirstParameterOfLeg(leg));
    for (size_t i = 0; i < 3; ++i) {
      free.set(first + leg_parameter::kBaseJoint + i);
      free.set(first + leg_parameter::kPlatformJoint + i, options.rigid_platform);
    }
    free.set(first + leg_parameter::kRadius);
    for (size_t i = 0; i < 4; ++i)
      free.set(first + leg_parameter::kShading + i, options.lasting_shading_px > 0);
    free.set(first + leg_parameter::kJointOffset, options.rigid_platform && options.joint_readings);
  }
  return free;
}

LegObservation ObserveLeg(const ImageObservation& image, int leg, const TruthProblemOptions& options) {
  LegObservation observation{leg, {}, {}, options.joint_reading_sigma_m};
  for (const EdgeObservation& edge : image.edges) {
    if (edge.leg != leg) continue;
    const Eigen::Index samples = static_cast<Eigen::Index>(edge.samples.size());
    observation.edges.emplace_back(edge, options.noise, Eigen::VectorXd::Ones(samples));
  }
  if (options.rigid_platform && options.joint_readings)
    observation.reading_m = (*image.joint_readings_m)[leg];
  return observation;
}

}  // namespace

SyntheticSession SmallSession() {
  SyntheticOptions options;
  options.image_count = 3;
  options.samples_per_edge = 5;
  options.camera = DesktopCamera(true);
  SyntheticSession session = GenerateSession(options);
  for (ImageObservation& image : session.observations)
    for (EdgeObservation& edge : image.edges) edge.common_sigma_px = 0.05;
  return session;
}

Rigid3 GaugeFromPlatform(const SyntheticSession& session) {
  std::vector<Eigen::Vector3d> truth, drawn;
  for (size_t i = 0; i < kLegCount; ++i) {
    truth.push_back(session.true_robot.legs[i].platform_joint_m);
    drawn.push_back(session.nominal_robot.legs[i].platform_joint_m);
  }
  return FitRigid(truth, drawn);
}

SharedParameters TrueParameters(const SyntheticSession& session) {
  const Rigid3 gauge_from_platform = GaugeFromPlatform(session);
  SharedParameters shared;
  shared.camera = ParametersOf(session.true_camera);
  for (size_t i = 0; i < kLegCount; ++i) {
    const Leg& leg = session.true_robot.legs[i];
    shared.legs[i] << session.true_camera_from_base * leg.base_joint_m,
        gauge_from_platform * leg.platform_joint_m, leg.radius_m, leg.joint_offset_m, Eigen::Vector4d::Zero();
  }
  return shared;
}

EstimationProblem ProblemAtTruth(const SyntheticSession& session,
                                 const std::vector<ImageObservation>& observations,
                                 const TruthProblemOptions& options) {
  EstimationProblem problem;
  problem.camera = session.true_camera;
  problem.shared = TrueParameters(session);
  problem.free = FreeParameters(session.true_camera.lens, options);
  for (size_t i = 0; i < kLegCount; ++i) {
    problem.drawn_base_joints[i] = session.nominal_robot.legs[i].base_joint_m;
    problem.drawn_platform_joints[i] = session.nominal_robot.legs[i].platform_joint_m;
  }
  for (int leg = 0; leg < kLegCount && options.lasting_shading_px > 0; ++leg)
    for (int i = 0; i < 4; ++i)
      problem.priors.push_back(
          {FirstParameterOfLeg(leg) + leg_parameter::kShading + i, 0, options.lasting_shading_px});
  const Rigid3 platform_from_gauge = Inverse(GaugeFromPlatform(session));
  for (size_t image = 0; image < observations.size(); ++image) {
    PoseUnit whole{
        static_cast<int>(image),
        options.rigid_platform,
        session.true_camera_from_base * session.true_base_from_platform[image] * platform_from_gauge,
        Eigen::Vector3d::Zero(),
        {}};
    for (int leg = 0; leg < kLegCount; ++leg)
      whole.legs.push_back(ObserveLeg(observations[image], leg, options));
    if (options.rigid_platform) {
      problem.units.push_back(std::move(whole));
      continue;
    }
    for (const LegObservation& of_leg : whole.legs) {
      const LegParameters& leg = problem.shared.legs[static_cast<size_t>(of_leg.leg)];
      const Eigen::Vector3d tip = whole.camera_from_platform * leg.segment<3>(leg_parameter::kPlatformJoint);
      const Eigen::Vector3d axis = tip - leg.segment<3>(leg_parameter::kBaseJoint);
      problem.units.push_back({static_cast<int>(image), false, {}, axis, {of_leg}});
    }
  }
  return problem;
}

std::vector<int> FreeIndices(const EstimationProblem& problem) {
  std::vector<int> indices;
  for (int i = 0; i < kSharedParameterCount; ++i)
    if (problem.free[static_cast<size_t>(i)]) indices.push_back(i);
  return indices;
}

}  // namespace legible
