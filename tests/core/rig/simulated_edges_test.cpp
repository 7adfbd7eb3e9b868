#include "core/rig/simulated_edges.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "tests/core/rig/desktop_rig.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

LegsInCamera LegsOf(const SimulatedRig& rig) {
  return PlaceLegs(rig.truth().robot, rig.truth().camera_from_base, rig.true_motion().base_from_platform);
}

Eigen::Vector3d TrueNormal(const SimulatedRig& rig, const SeenEdge& edge) {
  const LegInCamera leg = LegsOf(rig)[static_cast<size_t>(edge.leg)];
  return CylinderOutline(LineThrough<double>(leg.a_in_camera, leg.b_in_camera),
                         leg.radius_m)[static_cast<size_t>(edge.edge)];
}

// Somewhere about home, within the joints' ranges.
SimulationOptions SomewhereElse(std::mt19937_64& generator) {
  SimulationOptions options;
  for (;;) {
    options.start = DesktopHexapod().home;
    options.start->translation += UniformVector(generator, -0.06, 0.06);
    options.start->rotation = RotationFromVector(UniformVector(generator, -0.3, 0.3));
    const Vector6d readings_m = InverseKinematics(DesktopHexapod(), *options.start);
    if (readings_m.minCoeff() > 0.345 && readings_m.maxCoeff() < 0.485) return options;
  }
}

bool AreSame(const SeenEdge& a, const SeenEdge& b) {
  return a.leg == b.leg && a.edge == b.edge && a.normal == b.normal &&
         a.normal_covariance == b.normal_covariance && a.ends == b.ends;
}

bool AreSame(const SeenEdges& a, const SeenEdges& b) {
  return std::equal(a.edges.begin(), a.edges.end(), b.edges.begin(), b.edges.end(),
                    [](const SeenEdge& x, const SeenEdge& y) { return AreSame(x, y); });
}

TEST(SimulatedEdges, WithoutNoiseAreTheTrueOutlines) {
  std::mt19937_64 generator = TestGenerator();
  size_t count = 0;
  for (int i = 0; i < 100; ++i) {
    SimulationOptions options = SomewhereElse(generator);
    options.edge_noise_px = 0;
    SimulatedRig rig(DesktopTruth(), options);
    const SeenEdges seen = SimulatedEdges(rig).See({});
    count += seen.edges.size();
    for (const SeenEdge& edge : seen.edges) {
      EXPECT_TRUE(AreNear(edge.normal, TrueNormal(rig, edge), 1e-12));
      const LegInCamera leg = LegsOf(rig)[static_cast<size_t>(edge.leg)];
      EXPECT_NEAR(edge.normal.dot(leg.a_in_camera), -leg.radius_m, 1e-12);
      EXPECT_LT((edge.ends[0] - leg.a_in_camera.hnormalized()).norm(),
                (edge.ends[1] - leg.a_in_camera.hnormalized()).norm());
    }
    for (size_t k = 1; k < seen.edges.size(); ++k)
      EXPECT_LT(2 * seen.edges[k - 1].leg + seen.edges[k - 1].edge,
                2 * seen.edges[k].leg + seen.edges[k].edge);
  }
  EXPECT_GT(count, 900U);
}

// Ends that noise has moved lie on the edge that was seen; what is between them is nowhere hidden, but for
// the step between the points that were looked at.
TEST(SimulatedEdges, EndWhereTheEdgeIsHidden) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 50; ++i) {
    SimulatedRig rig(DesktopTruth(), SomewhereElse(generator));
    const Camera& camera = rig.truth().camera;
    VisibilityOptions fine;
    fine.step_px = 1;
    const PredictedEdges predicted = PredictEdges(LegsOf(rig), camera, fine);
    for (const SeenEdge& edge : SimulatedEdges(rig).See({}).edges) {
      for (const Eigen::Vector2d& end : edge.ends) EXPECT_NEAR(edge.normal.dot(end.homogeneous()), 0, 1e-14);
      const Eigen::Vector2d begin_px = ProjectNormalised(camera, edge.ends[0]);
      const Eigen::Vector2d along_px = ProjectNormalised(camera, edge.ends[1]) - begin_px;
      EXPECT_GE(along_px.norm(), SimulatedEdges::kShortestSeen_px - 1);
      int hidden = 0;
      for (const auto& point :
           predicted[static_cast<size_t>(edge.leg)][static_cast<size_t>(edge.edge)].points) {
        const double share = (point.point_px - begin_px).dot(along_px) / along_px.squaredNorm();
        hidden += share > 0.01 && share < 0.99 && point.obstacle != EdgeObstacle::kNone;
      }
      EXPECT_LE(hidden, 18);
    }
  }
}

TEST(SimulatedEdges, AnEdgeOfWhichLittleIsVisibleIsNotSeen) {
  SimulationTruth truth = DesktopTruth();
  truth.camera.width_px = 640;  // the right half of the robot is outside
  SimulatedRig rig(truth, {}), whole(DesktopTruth(), {});
  const SeenEdges half = SimulatedEdges(rig).See({}), all = SimulatedEdges(whole).See({});
  EXPECT_EQ(all.edges.size(), 12U);
  EXPECT_LT(half.edges.size(), 10U);
  EXPECT_GT(half.edges.size(), 2U);
}

// Whitened by the covariance that was said, what each edge scatters by in many frames is the identity.
TEST(SimulatedEdges, ScatterByTheirCovariance) {
  SimulationOptions options;
  options.edge_noise_px = 0.2;
  SimulatedRig rig(DesktopTruth(), options);
  SimulatedEdges source(rig);
  constexpr int kFrames = 10000;
  std::vector<Eigen::Vector2d> mean(12, Eigen::Vector2d::Zero());
  std::vector<Eigen::Matrix2d> scatter(12, Eigen::Matrix2d::Zero());
  for (int frame = 0; frame < kFrames; ++frame) {
    rig.WaitUntil(frame * options.period_s);
    const SeenEdges seen = source.See({});
    ASSERT_EQ(seen.edges.size(), 12U);
    for (size_t i = 0; i < 12; ++i) {
      const SeenEdge& edge = seen.edges[i];
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(edge.normal_covariance);
      EXPECT_LT(std::abs(axes.eigenvalues()[0]), 1e-12 * axes.eigenvalues()[2]);
      EXPECT_NEAR(edge.normal.norm(), 1, 1e-14);
      const Eigen::Vector3d error = edge.normal - TrueNormal(rig, edge);
      Eigen::Vector2d whitened = axes.eigenvectors().rightCols<2>().transpose() * error;
      whitened.array() /= axes.eigenvalues().tail<2>().array().sqrt();
      // The sign of an eigenvector is arbitrary; the edge's own normal settles nothing, a fixed vector does.
      for (int k = 0; k < 2; ++k)
        if (axes.eigenvectors().col(k + 1).sum() < 0) whitened[k] = -whitened[k];
      mean[i] += whitened / kFrames;
      scatter[i] += whitened * whitened.transpose() / kFrames;
    }
  }
  // Five standard deviations; the rest of second order is a thousandth of that.
  for (size_t i = 0; i < 12; ++i) {
    EXPECT_TRUE(AreNear(mean[i], Eigen::Vector2d::Zero(), 5 / std::sqrt(kFrames)));
    EXPECT_TRUE(AreNear(scatter[i], Eigen::Matrix2d::Identity(), 5 * std::sqrt(2.0 / kFrames)));
  }
}

TEST(SimulatedEdges, KeepACovarianceOfRankTwoWithoutNoise) {
  SimulationOptions options;
  options.edge_noise_px = 0;
  SimulatedRig rig(DesktopTruth(), options);
  for (const SeenEdge& edge : SimulatedEdges(rig).See({}).edges) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(edge.normal_covariance);
    EXPECT_GT(axes.eigenvalues()[1], 0);
  }
}

TEST(SimulatedEdges, AreTheSameAgainUntilANewFrameCame) {
  SimulatedRig rig(DesktopTruth(), {});
  SimulatedEdges source(rig), other(rig);
  rig.WaitUntil(0.1);
  const SeenEdges first = source.See({});
  EXPECT_DOUBLE_EQ(first.time_s, 0.1);
  rig.WaitUntil(0.11);
  EXPECT_TRUE(AreSame(source.See({}), first));
  EXPECT_TRUE(AreSame(other.See({}), first));
  rig.WaitUntil(0.12);
  EXPECT_FALSE(AreSame(source.See({}), first));
  SimulationOptions options;
  options.seed = 2;
  SimulatedRig reseeded(DesktopTruth(), options);
  reseeded.WaitUntil(0.1);
  EXPECT_FALSE(AreSame(SimulatedEdges(reseeded).See({}), first));
}

TEST(SimulatedEdges, OfACoveredLegVanishAndLeaveTheOthersAsTheyAre) {
  SimulatedRig rig(DesktopTruth(), WithFault({FaultKind::kLegCovered, 0, 1, 2}));
  SimulatedRig healthy(DesktopTruth(), {});
  const SeenEdges seen = SimulatedEdges(rig).See({});
  SeenEdges expected = SimulatedEdges(healthy).See({});
  EXPECT_EQ(std::erase_if(expected.edges, [](const SeenEdge& edge) { return edge.leg == 2; }), 2U);
  EXPECT_TRUE(AreSame(seen, expected));
}

TEST(SimulatedEdges, HaveTheFaultsOfTheFrames) {
  SimulationOptions options;
  options.faults = {{FaultKind::kFramesDropped, 0.1, 0.2}, {FaultKind::kFramesFrozen, 0.3, 0.4}};
  SimulatedRig rig(DesktopTruth(), options);
  SimulatedEdges source(rig);
  CommandUntil(rig, Rising(0.02), 0.18);
  EXPECT_DOUBLE_EQ(source.See({}).time_s, 0.08);
  CommandUntil(rig, Rising(0.02), 0.28);
  const SeenEdges before = source.See({});
  CommandUntil(rig, Rising(0.02), 0.36);
  EXPECT_DOUBLE_EQ(source.See({}).time_s, 0.36);
  EXPECT_TRUE(AreSame(source.See({}), before));

  SimulatedRig lost(DesktopTruth(), WithFault({FaultKind::kLinkLost, 0, 1}));
  EXPECT_THROW(SimulatedEdges(lost).See({}), RigError);
}

Camera OffBy(std::mt19937_64& generator, Camera camera) {
  for (double* value : {&camera.fx_px, &camera.fy_px, &camera.cx_px, &camera.cy_px})
    *value += Uniform(generator, -8, 8);
  camera.distortion.head<2>() << Uniform(generator, -0.2, 0), Uniform(generator, 0, 0.05);
  return camera;
}

TEST(SimulatedEdges, ThroughTheTrueCameraAsModelAreTheSame) {
  SimulatedRig rig(DesktopTruth(), {});
  const SeenEdges plain = SimulatedEdges(rig).See({}),
                  modelled = SimulatedEdges(rig, rig.truth().camera).See({});
  ASSERT_EQ(plain.edges.size(), modelled.edges.size());
  for (size_t i = 0; i < plain.edges.size(); ++i) {
    EXPECT_TRUE(AreNear(modelled.edges[i].normal, plain.edges[i].normal, 1e-12));
    // Its noise is across the edge as seen, not as it is.
    const Eigen::Matrix3d& covariance = plain.edges[i].normal_covariance;
    EXPECT_TRUE(AreNear(modelled.edges[i].normal_covariance, covariance, 1e-3 * covariance.trace()));
  }
}

// A model of the camera is wrong about sight lines, never about pixels.
TEST(SimulatedEdges, ThroughAModelLieAtTheSamePixels) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 50; ++i) {
    SimulationOptions options = SomewhereElse(generator);
    options.edge_noise_px = 0.3;
    SimulatedRig rig(DesktopTruth(), options);
    const Camera model = OffBy(generator, rig.truth().camera);
    const SeenEdges plain = SimulatedEdges(rig).See({}), modelled = SimulatedEdges(rig, model).See({});
    ASSERT_EQ(plain.edges.size(), modelled.edges.size());
    for (size_t k = 0; k < plain.edges.size(); ++k) {
      const SeenEdge &edge = modelled.edges[k], &truly = plain.edges[k];
      EXPECT_EQ(edge.leg, truly.leg);
      EXPECT_EQ(edge.edge, truly.edge);
      EXPECT_GT(edge.normal.dot(truly.normal), 0.99);
      for (size_t end = 0; end < 2; ++end) {
        EXPECT_TRUE(AreNear(ProjectNormalised(model, edge.ends[end]),
                            ProjectNormalised(rig.truth().camera, truly.ends[end]), 1e-9));
        EXPECT_NEAR(edge.normal.dot(edge.ends[end].homogeneous()), 0, 1e-14);
        // What a model says of an end's noise, across the edge in its undistorted image.
        const Eigen::Vector3d x = edge.ends[end].homogeneous();
        const Eigen::Vector2d by_px =
            edge.normal.head<2>().cwiseProduct(Eigen::Vector2d(model.fx_px, model.fy_px).cwiseInverse());
        EXPECT_NEAR(std::sqrt(x.dot(edge.normal_covariance * x)), 0.3 * by_px.norm(), 1e-6);
      }
    }
  }
}

TEST(SimulatedEdges, NeedACamera) {
  SimulationTruth truth = DesktopTruth();
  truth.camera = {};
  SimulatedRig rig(truth, {});
  EXPECT_THROW(SimulatedEdges{rig}, std::invalid_argument);
  SimulatedRig whole(DesktopTruth(), {});
  EXPECT_THROW(SimulatedEdges(whole, Camera{}), std::invalid_argument);
}

}  // namespace
}  // namespace legible
