#include "datasets/synthetic_session.h"

#include <cmath>
#include <functional>
#include <numbers>

#include "core/geometry/cylinder_outline.h"
#include "core/geometry/plucker_line.h"
#include "tests/testing/matrices.h"

namespace legible {
namespace {

using Observations = std::vector<ImageObservation>;

// Calls visit(image index, edge, sample index) for each sample.
void ForEachSample(const Observations& observations,
                   const std::function<void(size_t, const EdgeObservation&, size_t)>& visit) {
  for (size_t image = 0; image < observations.size(); ++image) {
    for (const EdgeObservation& edge : observations[image].edges) {
      for (size_t i = 0; i < edge.samples.size(); ++i) visit(image, edge, i);
    }
  }
}

Eigen::VectorXd Flattened(const Observations& observations) {
  std::vector<double> values;
  for (const ImageObservation& observation : observations) {
    values.insert(values.end(), observation.joint_readings_m->begin(), observation.joint_readings_m->end());
  }
  ForEachSample(observations, [&](size_t, const EdgeObservation& edge, size_t i) {
    values.insert(values.end(), edge.samples[i].point_px.begin(), edge.samples[i].point_px.end());
  });
  return Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// Displacement of each sample along its normal, px.
std::vector<double> Displacements(const Observations& observations, const Observations& exact) {
  std::vector<double> displacements;
  ForEachSample(observations, [&](size_t image, const EdgeObservation& edge, size_t i) {
    const EdgeObservation& exact_edge = exact[image].edges[static_cast<size_t>(2 * edge.leg + edge.edge)];
    const Eigen::Vector2d moved_px = edge.samples[i].point_px - exact_edge.samples[i].point_px;
    displacements.push_back(moved_px.dot(exact_edge.samples[i].normal_px));
    EXPECT_NEAR(moved_px.norm(), std::abs(displacements.back()), 1e-9);
  });
  return displacements;
}

double Rms(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

SyntheticOptions DistortedOptions() {
  SyntheticOptions options;
  options.camera = DesktopCamera(true);
  return options;
}

// The axis of a leg in the camera frame.
std::array<Eigen::Vector3d, 2> AxisEnds(const SyntheticSession& session, size_t image, int leg) {
  const Leg& true_leg = session.true_robot.legs[leg];
  return {
      session.true_camera_from_base * true_leg.base_joint_m,
      session.true_camera_from_base * (session.true_base_from_platform[image] * true_leg.platform_joint_m)};
}

// Shortest distance between the axis and the sight ray (a line through the camera centre).
double SightRayDistance(const std::array<Eigen::Vector3d, 2>& axis, const Eigen::Vector3d& ray) {
  const Eigen::Vector3d across = (axis[1] - axis[0]).cross(ray).normalized();
  return std::abs(axis[0].dot(across));
}

TEST(SyntheticSession, SightRaysOfExactSamplesTouchTheCylinder) {
  for (const bool is_distorted : {false, true}) {
    SyntheticOptions options;
    options.camera = DesktopCamera(is_distorted);
    const SyntheticSession session = GenerateSession(options);
    ForEachSample(session.exact_observations, [&](size_t image, const EdgeObservation& edge, size_t i) {
      const auto point = Unproject(session.true_camera, edge.samples[i].point_px);
      ASSERT_TRUE(point.has_value());
      const double radius_m = session.true_robot.legs[edge.leg].radius_m;
      const double distance_m = SightRayDistance(AxisEnds(session, image, edge.leg), point->homogeneous());
      EXPECT_NEAR(distance_m / radius_m, 1, 1e-12);
    });
  }
}

TEST(SyntheticSession, EdgesCarryTheNumberOfTheirOutlineNormal) {
  const SyntheticSession session = GenerateSession(DistortedOptions());
  ForEachSample(session.exact_observations, [&](size_t image, const EdgeObservation& edge, size_t i) {
    const auto [a, b] = AxisEnds(session, image, edge.leg);
    const auto normals = CylinderOutline(LineThrough(a, b), session.true_robot.legs[edge.leg].radius_m);
    const auto point = Unproject(session.true_camera, edge.samples[i].point_px);
    EXPECT_NEAR(normals[edge.edge].dot(point->homogeneous()), 0, 1e-13);
  });
}

TEST(SyntheticSession, NormalsStandAcrossTheDistortedEdgeAndPointAwayFromTheLeg) {
  const SyntheticSession session = GenerateSession(DistortedOptions());
  ForEachSample(session.exact_observations, [&](size_t image, const EdgeObservation& edge, size_t i) {
    const auto [a, b] = AxisEnds(session, image, edge.leg);
    const Eigen::Vector3d normal =
        CylinderOutline(LineThrough(a, b), session.true_robot.legs[edge.leg].radius_m)[edge.edge];
    const EdgeSample& sample = edge.samples[i];
    const Eigen::Vector2d point = *Unproject(session.true_camera, sample.point_px);
    // Central difference along the straight edge, seen through the lens.
    const Eigen::Vector2d step = 1e-4 * Eigen::Vector2d(-normal.y(), normal.x()).normalized();
    const Eigen::Vector2d tangent_px = (ProjectNormalised(session.true_camera, point + step) -
                                        ProjectNormalised(session.true_camera, point - step))
                                           .normalized();
    EXPECT_NEAR(sample.normal_px.norm(), 1, 1e-14);
    EXPECT_NEAR(sample.normal_px.dot(tangent_px), 0, 1e-8);
    const auto outside = Unproject(session.true_camera, sample.point_px + sample.normal_px);
    EXPECT_GT(normal.dot(outside->homogeneous()), 0);
  });
}

TEST(SyntheticSession, SamplesLieNearestToEqualStepsOfTheAxis) {
  SyntheticOptions options;
  options.image_count = 3;
  const SyntheticSession session = GenerateSession(options);
  ForEachSample(session.exact_observations, [&](size_t image, const EdgeObservation& edge, size_t i) {
    const auto [a, b] = AxisEnds(session, image, edge.leg);
    const double fraction = 0.08 + 0.84 * static_cast<double>(i) / 19;
    const Eigen::Vector3d axis_point = a + fraction * (b - a);
    const Eigen::Vector2d offset =
        *Unproject(session.true_camera, edge.samples[i].point_px) - axis_point.hnormalized();
    const Eigen::Vector3d normal =
        CylinderOutline(LineThrough(a, b), session.true_robot.legs[edge.leg].radius_m)[edge.edge];
    const Eigen::Vector2d along = Eigen::Vector2d(-normal.y(), normal.x()).normalized();
    EXPECT_NEAR(offset.dot(along), 0, 1e-13);
  });
}

TEST(SyntheticSession, EdgesAreTwelveOfTwentySamplesAnImage) {
  const SyntheticSession session = GenerateSession({});
  ASSERT_EQ(session.observations.size(), 40u);
  for (const ImageObservation& observation : session.observations) {
    ASSERT_EQ(observation.edges.size(), 12u);
    for (size_t i = 0; i < 12; ++i) {
      EXPECT_EQ(observation.edges[i].leg, static_cast<int>(i / 2));
      EXPECT_EQ(observation.edges[i].edge, static_cast<int>(i % 2));
      EXPECT_EQ(observation.edges[i].samples.size(), 20u);
      EXPECT_EQ(observation.edges[i].samples[0].sigma_px, 0.3);
    }
  }
}

TEST(SyntheticSession, PosesStayInTheJointRangesAndTheImage) {
  const SyntheticSession session = GenerateSession(DistortedOptions());
  for (size_t image = 0; image < session.true_base_from_platform.size(); ++image) {
    const Vector6d readings_m = InverseKinematics(session.true_robot, session.true_base_from_platform[image]);
    EXPECT_EQ(readings_m, *session.exact_observations[image].joint_readings_m);
    EXPECT_GE(readings_m.minCoeff(), 0.345);
    EXPECT_LE(readings_m.maxCoeff(), 0.485);
    for (int leg = 0; leg < kLegCount; ++leg) {
      for (const Eigen::Vector3d& end : AxisEnds(session, image, leg)) {
        const Eigen::Array2d pixel = Project(session.true_camera, end);
        EXPECT_TRUE((pixel >= 0).all() && (pixel <= Eigen::Array2d(1279, 959)).all());
      }
    }
  }
}

TEST(SyntheticSession, TheTruthLiesWithinTheStatedErrorsOfTheDrawingAndUsesThem) {
  const SyntheticOptions options = DistortedOptions();
  const SyntheticSession session = GenerateSession(options);
  double largest_m = 0;
  for (int i = 0; i < kLegCount; ++i) {
    const Leg &drawn = session.nominal_robot.legs[i], &real = session.true_robot.legs[i];
    EXPECT_TRUE(AreNear(drawn.base_joint_m, real.base_joint_m, options.geometry_error_m));
    EXPECT_TRUE(AreNear(drawn.platform_joint_m, real.platform_joint_m, options.geometry_error_m));
    EXPECT_NEAR(drawn.joint_offset_m, real.joint_offset_m, options.joint_offset_error_m);
    EXPECT_NEAR(drawn.radius_m, real.radius_m, options.radius_error_m);
    largest_m = std::max(largest_m, (drawn.base_joint_m - real.base_joint_m).cwiseAbs().maxCoeff());
  }
  EXPECT_GT(largest_m, 0.5 * options.geometry_error_m);
  EXPECT_NE(session.nominal_camera.fx_px, session.true_camera.fx_px);
  EXPECT_NEAR(session.nominal_camera.fx_px, session.true_camera.fx_px, options.camera_error_px);
  EXPECT_EQ(session.nominal_camera.distortion, Distortion::Zero());
  EXPECT_EQ(session.nominal_camera.lens, LensModel::kBrownConrady);
  const Vector6d moved = Displacement(session.true_camera_from_base, session.nominal_camera_from_base);
  EXPECT_LE(moved.head<3>().cwiseAbs().maxCoeff(), options.camera_position_error_m);
  EXPECT_LE(moved.tail<3>().cwiseAbs().maxCoeff(), options.camera_rotation_error_rad + 1e-12);
  EXPECT_GT(moved.norm(), 0.01);
}

TEST(SyntheticSession, NoiseHasItsSigmaAndMovesSamplesAlongTheirNormalsOnly) {
  const SyntheticOptions options = DistortedOptions();
  const SyntheticSession session = GenerateSession(options);
  const std::vector<double> moved_px = Displacements(session.observations, session.exact_observations);
  ASSERT_EQ(moved_px.size(), 9600u);
  // Five times the scatter of a sample standard deviation, sigma/sqrt(2 n).
  EXPECT_NEAR(Rms(moved_px), 0.3, 5 * 0.3 / std::sqrt(2 * 9600.0));
}

TEST(SyntheticSession, JointNoiseHasItsSigma) {
  const SyntheticSession session = GenerateSession({});
  std::vector<double> errors_m;
  for (size_t i = 0; i < session.observations.size(); ++i) {
    const Vector6d error_m =
        *session.observations[i].joint_readings_m - *session.exact_observations[i].joint_readings_m;
    errors_m.insert(errors_m.end(), error_m.begin(), error_m.end());
  }
  ASSERT_EQ(errors_m.size(), 240u);
  EXPECT_NEAR(Rms(errors_m), 2e-5, 5 * 2e-5 / std::sqrt(2 * 240.0));
}

TEST(SyntheticSession, OutliersHaveTheirShareAndWidthAndLeaveTheOthersAlone) {
  SyntheticOptions options = DistortedOptions();
  const SyntheticSession clean = GenerateSession(options);
  options.outlier_fraction = 0.2;
  const SyntheticSession session = GenerateSession(options);
  const std::vector<double> clean_px = Displacements(clean.observations, clean.exact_observations);
  const std::vector<double> moved_px = Displacements(session.observations, session.exact_observations);
  ASSERT_EQ(session.is_outlier.size(), moved_px.size());
  std::vector<double> outliers_px;
  for (size_t i = 0; i < moved_px.size(); ++i) {
    if (session.is_outlier[i]) {
      outliers_px.push_back(moved_px[i]);
      EXPECT_LE(std::abs(moved_px[i]), 20 + 1e-9);
    } else {
      EXPECT_EQ(moved_px[i], clean_px[i]);
    }
  }
  const double count = static_cast<double>(moved_px.size());
  EXPECT_NEAR(static_cast<double>(outliers_px.size()) / count, 0.2, 5 * std::sqrt(0.2 * 0.8 / count));
  // The variance of a uniform value within w is w^2 / 3, that of its square 4 w^4 / 45.
  EXPECT_NEAR(Rms(outliers_px), 20 / std::sqrt(3.0),
              5 * 20 / std::sqrt(15.0 * static_cast<double>(outliers_px.size())));
  EXPECT_EQ(std::count(clean.is_outlier.begin(), clean.is_outlier.end(), true), 0);
}

TEST(SyntheticSession, OcclusionTakesOneStretchOfEachEdgeWhereNoiseHasNoSay) {
  SyntheticOptions options = DistortedOptions();
  const SyntheticSession whole = GenerateSession(options);
  options.occlusion_fraction = 0.3;
  const SyntheticSession session = GenerateSession(options);
  std::vector<size_t> places;
  for (size_t image = 0; image < 40; ++image) {
    for (size_t i = 0; i < 12; ++i) {
      const auto& all = whole.exact_observations[image].edges[i].samples;
      const auto& left = session.exact_observations[image].edges[i].samples;
      ASSERT_EQ(left.size(), 14u);
      size_t place = 0;
      while (place < 14 && left[place].point_px == all[place].point_px) ++place;
      for (size_t k = place; k < 14; ++k) EXPECT_EQ(left[k].point_px, all[k + 6].point_px);
      places.push_back(place);
    }
  }
  EXPECT_EQ(*std::min_element(places.begin(), places.end()), 0u);
  EXPECT_EQ(*std::max_element(places.begin(), places.end()), 14u);
  options.noise_seed = 2;
  EXPECT_EQ(Flattened(GenerateSession(options).exact_observations), Flattened(session.exact_observations));
}

TEST(SyntheticSession, IsDeterminedByItsSeeds) {
  SyntheticOptions options = DistortedOptions();
  options.outlier_fraction = 0.1;
  options.occlusion_fraction = 0.2;
  const SyntheticSession first = GenerateSession(options), again = GenerateSession(options);
  EXPECT_EQ(Flattened(first.observations), Flattened(again.observations));
  EXPECT_EQ(first.is_outlier, again.is_outlier);
  EXPECT_EQ(first.nominal_camera.fx_px, again.nominal_camera.fx_px);
  options.seed = 2;
  const SyntheticSession other = GenerateSession(options);
  EXPECT_NE(Flattened(other.exact_observations), Flattened(first.exact_observations));
  EXPECT_NE(other.true_robot.legs[0].radius_m, first.true_robot.legs[0].radius_m);
  EXPECT_NE(other.nominal_camera.fx_px, first.nominal_camera.fx_px);
}

TEST(SyntheticSession, TheNoiseSeedLeavesRobotCameraAndPosesAlone) {
  SyntheticOptions options = DistortedOptions();
  const SyntheticSession first = GenerateSession(options);
  options.noise_seed = 2;
  const SyntheticSession other = GenerateSession(options);
  EXPECT_EQ(Flattened(other.exact_observations), Flattened(first.exact_observations));
  EXPECT_EQ(other.true_robot.legs[0].radius_m, first.true_robot.legs[0].radius_m);
  EXPECT_EQ(other.nominal_camera.fx_px, first.nominal_camera.fx_px);
  for (size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(other.true_base_from_platform[i].translation, first.true_base_from_platform[i].translation);
    EXPECT_EQ(other.true_base_from_platform[i].rotation.coeffs(),
              first.true_base_from_platform[i].rotation.coeffs());
  }
  EXPECT_NE(Flattened(other.observations), Flattened(first.observations));
}

TEST(SyntheticSession, TheFirstImagesDoNotDependOnHowManyFollow) {
  SyntheticOptions options = DistortedOptions();
  const SyntheticSession many = GenerateSession(options);
  options.image_count = 5;
  const SyntheticSession few = GenerateSession(options);
  EXPECT_EQ(Flattened(few.observations),
            Flattened({many.observations.begin(), many.observations.begin() + 5}));
}

TEST(SyntheticSession, RedrawnObservationsAreThoseOfANewSessionWithThatNoiseSeed) {
  SyntheticOptions options = DistortedOptions();
  options.outlier_fraction = 0.1;
  const SyntheticSession session = GenerateSession(options);
  EXPECT_EQ(Flattened(DrawObservations(session, options, options.noise_seed)),
            Flattened(session.observations));
  options.noise_seed = 77;
  EXPECT_EQ(Flattened(DrawObservations(session, options, 77)),
            Flattened(GenerateSession(options).observations));
}

TEST(SyntheticSession, OptionsOutOfRangeAreRefusedByName) {
  const auto complaint = [](const std::function<void(SyntheticOptions&)>& change) -> std::string {
    SyntheticOptions options;
    change(options);
    try {
      GenerateSession(options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string name = "SyntheticOptions: ";
  EXPECT_EQ(complaint([](auto& o) { o.image_count = 0; }), name + "image_count must be 1 or more");
  EXPECT_EQ(complaint([](auto& o) { o.edge_sigma_px = 0; }), name + "edge_sigma_px must be greater than 0");
  EXPECT_EQ(complaint([](auto& o) { o.edge_sigma_px = std::nan(""); }),
            name + "edge_sigma_px must be greater than 0");
  EXPECT_EQ(complaint([](auto& o) { o.samples_per_edge = 1; }), name + "samples_per_edge must be 2 or more");
  EXPECT_EQ(complaint([](auto& o) { o.outlier_fraction = 1.1; }),
            name + "outlier_fraction must be in [0, 1]");
  EXPECT_EQ(complaint([](auto& o) { o.occlusion_fraction = 0.95; }),
            name + "occlusion_fraction must leave 2 samples an edge");
  EXPECT_EQ(complaint([](auto& o) { o.lowest_position_m.z() = 1; }),
            name + "lowest_position_m must not exceed highest_position_m");
  EXPECT_EQ(complaint([](auto& o) { o.radius_error_m = 0.01; }),
            name + "radius_m of each leg must be greater than radius_error_m");
}

TEST(SyntheticSession, RangesThatHoldHardlyAnyPoseAreRefused) {
  SyntheticOptions options;
  options.lowest_position_m.z() = options.highest_position_m.z() = 1;
  EXPECT_THROW(GenerateSession(options), std::invalid_argument);
  options = {};
  options.camera_from_base = LookAt({0.94, 0.074, 0.285}, {2, 0, 0.13});
  EXPECT_THROW(GenerateSession(options), std::invalid_argument);
}

TEST(DesktopHexapod, IsTheClosedFormAtHome) {
  const GoughStewart robot = DesktopHexapod();
  for (int i = 0; i < kLegCount; ++i) {
    EXPECT_NEAR(robot.legs[i].base_joint_m.norm(), 0.27, 1e-15);
    EXPECT_NEAR(robot.legs[i].platform_joint_m.norm(), 0.195, 1e-15);
    // Turning the robot by a third brings each leg onto the next but one.
    const Eigen::AngleAxisd third(2 * std::numbers::pi / 3, Eigen::Vector3d::UnitZ());
    EXPECT_TRUE(AreNear(third * robot.legs[i].base_joint_m, robot.legs[(i + 2) % 6].base_joint_m, 1e-15));
    EXPECT_TRUE(
        AreNear(third * robot.legs[i].platform_joint_m, robot.legs[(i + 2) % 6].platform_joint_m, 1e-15));
  }
  EXPECT_TRUE(AreNear(InverseKinematics(robot, robot.home), Vector6d::Constant(0.375), 1e-15));
  // Pairs are close at the base and at the platform, with another partner there.
  EXPECT_LT((robot.legs[0].base_joint_m - robot.legs[1].base_joint_m).norm(), 0.05);
  EXPECT_LT((robot.legs[0].platform_joint_m - robot.legs[3].platform_joint_m).norm(), 0.05);
}

TEST(LookAt, PutsTheTargetOnTheAxisAndTheCameraUpright) {
  const Eigen::Vector3d position(0.94, 0.074, 0.285), target(0.01, 0.02, 0.13);
  const Rigid3 camera_from_base = LookAt(position, target);
  EXPECT_TRUE(AreNear(camera_from_base * position, Eigen::Vector3d::Zero(), 1e-15));
  EXPECT_TRUE(AreNear(camera_from_base * target, Eigen::Vector3d(0, 0, (target - position).norm()), 1e-15));
  const Eigen::Vector3d up_in_camera = camera_from_base.rotation * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(up_in_camera.x(), 0, 1e-15);
  EXPECT_LT(up_in_camera.y(), 0);
  EXPECT_THROW(LookAt({0, 0, 1}, {0, 0, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace legible
