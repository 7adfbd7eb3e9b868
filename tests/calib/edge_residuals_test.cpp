#include "calib/edge_residuals.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>
#include <stdexcept>

#include "core/geometry/cylinder_outline.h"
#include "tests/testing/derivatives.h"
#include "tests/testing/edge_distance_by_newton.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

constexpr int kSamples = 4;  // of each edge
constexpr int kUnknowns = kCameraParameterCount + 7 + 4;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;  // camera, A, b, R, shading
using Residuals = Eigen::Matrix<double, 2 * kSamples, 1>;

Camera DistortedCamera() {
  Camera camera{1280, 960, 1246.83, 1249.57, 654.12, 467.63, LensModel::kRational, {}};
  camera.distortion << -0.25, 0.09, 0.0008, -0.0006, -0.01, 0.02, 0.01, 0.001;
  return camera;
}

Camera CameraOf(const Unknowns& u) { return WithParameters(DistortedCamera(), u.head<12>()); }

Unknowns RandomUnknowns(std::mt19937_64& generator) {
  Unknowns u;
  u << ParametersOf(DistortedCamera()), Eigen::Vector3d(0, 0, 0.9) + UniformVector(generator, -0.2, 0.2),
      Eigen::Vector3d(0.1, -0.2, 0.8) + UniformVector(generator, -0.1, 0.1), Uniform(generator, 0.005, 0.03),
      0.1, -0.05, -0.08, 0.03;
  return u;
}

// Samples a few pixels beside the edges of the leg, measured across them.
std::vector<EdgeObservation> RandomEdges(std::mt19937_64& generator, const Unknowns& u) {
  const Eigen::Vector3d a = u.segment<3>(12), b = u.segment<3>(15);
  const auto normals = CylinderOutline(LineThrough<double>(a, b), u[18]);
  std::vector<EdgeObservation> edges;
  for (int edge = 0; edge < 2; ++edge) {
    EdgeObservation observation{0, edge, {}, 0.02};
    const Eigen::Vector3d& normal = normals[static_cast<size_t>(edge)];
    for (int i = 0; i < kSamples; ++i) {
      const Eigen::Vector2d on_axis = (a + (0.2 + 0.2 * i) * (b - a)).hnormalized();
      const Eigen::Vector2d line = normal.head<2>();
      const Eigen::Vector2d foot = on_axis - line * normal.dot(on_axis.homogeneous()) / line.squaredNorm();
      const Eigen::Vector2d direction = (line + UniformVector(generator, -0.2, 0.2).head<2>()).normalized();
      const Eigen::Vector2d point =
          ProjectNormalised(DistortedCamera(), foot) + Uniform(generator, -3, 3) * direction;
      observation.samples.push_back({point, direction, Uniform(generator, 0.1, 0.5)});
    }
    edges.push_back(observation);
  }
  return edges;
}

std::vector<WhitenedEdge> Whitened(const std::vector<EdgeObservation>& edges) {
  std::vector<WhitenedEdge> whitened;
  whitened.reserve(edges.size());
  for (const EdgeObservation& edge : edges)
    whitened.emplace_back(edge, EdgeNoise{1.3, 2, 0.5}, Eigen::VectorXd::LinSpaced(kSamples, 0.2, 1));
  return whitened;
}

std::optional<EdgeResiduals> Evaluate(const Unknowns& u, const std::vector<WhitenedEdge>& edges) {
  return EvaluateEdges(CameraOf(u), u.segment<3>(12), u.segment<3>(15), u[18], u.tail<4>(), edges);
}

Eigen::Matrix<double, 2 * kSamples, kUnknowns> Derivatives(const EdgeResiduals& residuals) {
  Eigen::Matrix<double, 2 * kSamples, kUnknowns> all;
  all << residuals.d_camera, residuals.d_axis, residuals.d_shading;
  return all;
}

TEST(EdgeResiduals, DerivativesAgreeWithNumericOnes) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 20; ++i) {
    const Unknowns at = RandomUnknowns(generator);
    const std::vector<EdgeObservation> observations = RandomEdges(generator, at);
    const std::vector<WhitenedEdge> edges = Whitened(observations);
    const auto found = Evaluate(at, edges);
    ASSERT_TRUE(found);
    const auto numeric = NumericJacobian(
        [&](const Unknowns& u) -> Residuals { return Evaluate(u, edges).value().residual; }, at, 1e-4);
    // They reach some 1e4 per m; the numeric ones are good to some 1e-9 of that.
    EXPECT_TRUE(AreNear(Derivatives(*found), numeric, 1e-4));
  }
}

TEST(EdgeResiduals, ValuesAndDerivativesAgreeWithJetsThroughTheOutline) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 20; ++i) {
    const Unknowns at = RandomUnknowns(generator);
    const std::vector<EdgeObservation> observations = RandomEdges(generator, at);
    const std::array<Eigen::Vector3d, 2> normal_values =
        CylinderOutline(LineThrough<double>(at.segment<3>(12), at.segment<3>(15)), at[18]);
    const auto distances = [&](const auto& u) {
      using T = typename std::decay_t<decltype(u)>::Scalar;
      const Eigen::Matrix<T, 3, 1> a = u.template segment<3>(12), b = u.template segment<3>(15);
      const auto normals = CylinderOutline<T>(LineThrough<T>(a, b), u[18]);
      Eigen::Matrix<T, 2 * kSamples, 1> result;
      for (size_t edge = 0; edge < 2; ++edge)
        for (size_t s = 0; s < kSamples; ++s) {
          const EdgeSample& sample = observations[edge].samples[s];
          result[static_cast<Eigen::Index>(edge * kSamples + s)] =
              DistanceByNewton<T>(DistortedCamera(), u.template head<12>(), normals[edge], sample.point_px,
                                  sample.normal_px, normal_values[edge]) -
              u[19 + 2 * static_cast<Eigen::Index>(edge)] -
              u[20 + 2 * static_cast<Eigen::Index>(edge)] *
                  T(PlacesAlong(observations[edge])[static_cast<int>(s)]);
        }
      return result;
    };
    Eigen::MatrixXd value = distances(at), derivative = JetJacobian(distances, at);
    const std::vector<WhitenedEdge> whitened = Whitened(observations);
    for (Eigen::Index edge = 0; edge < 2; ++edge) {
      whitened[static_cast<size_t>(edge)].Whiten(value.middleRows(edge * kSamples, kSamples));
      whitened[static_cast<size_t>(edge)].Whiten(derivative.middleRows(edge * kSamples, kSamples));
    }
    const auto found = Evaluate(at, whitened);
    ASSERT_TRUE(found);
    EXPECT_TRUE(AreNear(found->residual, value, 1e-8));
    EXPECT_TRUE(AreNear(Derivatives(*found), derivative, 1e-7));
  }
}

TEST(EdgeResiduals, EdgeDistancesAreTheUnwhitenedResidualsWithoutShading) {
  std::mt19937_64 generator = TestGenerator();
  Unknowns at = RandomUnknowns(generator);
  at.tail<4>().setZero();
  std::vector<EdgeObservation> observations = RandomEdges(generator, at);
  for (EdgeObservation& observation : observations) {
    observation.common_sigma_px = 0;
    for (EdgeSample& sample : observation.samples) sample.sigma_px = 1;
    const std::vector<WhitenedEdge> edges = {{observation, {}, Eigen::VectorXd::Ones(kSamples)}};
    const auto distances =
        EdgeDistances(CameraOf(at), at.segment<3>(12), at.segment<3>(15), at[18], observation);
    ASSERT_TRUE(distances);
    EXPECT_TRUE(AreNear(*distances, Evaluate(at, edges).value().residual, 1e-12));
  }
}

TEST(EdgeResiduals, HaveNoValueWithTheCameraInsideTheLeg) {
  std::mt19937_64 generator = TestGenerator();
  Unknowns at = RandomUnknowns(generator);
  const std::vector<EdgeObservation> observations = RandomEdges(generator, at);
  at[18] = 2;
  EXPECT_FALSE(Evaluate(at, Whitened(observations)));
  EXPECT_FALSE(EdgeDistances(CameraOf(at), at.segment<3>(12), at.segment<3>(15), at[18], observations[0]));
}

TEST(WhitenedEdge, IsASquareRootOfTheInverseCovariance) {
  std::mt19937_64 generator = TestGenerator();
  for (const double common_sigma_px : {0.0, 0.001, 0.03, 3.0}) {
    EdgeObservation observation = RandomEdges(generator, RandomUnknowns(generator))[0];
    observation.common_sigma_px = common_sigma_px;
    const EdgeNoise noise{1.3, 2, 0.5};
    const Eigen::VectorXd weights = Eigen::VectorXd::LinSpaced(kSamples, 0.2, 1);
    Eigen::MatrixXd whitening = Eigen::MatrixXd::Identity(kSamples, kSamples);
    WhitenedEdge(observation, noise, weights).Whiten(whitening);

    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(kSamples, kSamples);
    for (Eigen::Index i = 0; i < kSamples; ++i) {
      const double sigma_px = noise.sample * observation.samples[static_cast<size_t>(i)].sigma_px;
      covariance(i, i) = sigma_px * sigma_px / weights[i];
    }
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(kSamples), places = PlacesAlong(observation);
    const double shift_px = noise.shift * common_sigma_px, tilt_px = noise.tilt * common_sigma_px;
    covariance +=
        shift_px * shift_px * ones * ones.transpose() + tilt_px * tilt_px * places * places.transpose();
    EXPECT_TRUE(AreNear(whitening.transpose() * whitening, covariance.inverse(), 1e-9));
  }
}

TEST(WhitenedEdge, GivesNothingToASampleWithoutWeight) {
  std::mt19937_64 generator = TestGenerator();
  const EdgeObservation observation = RandomEdges(generator, RandomUnknowns(generator))[0];
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(kSamples);
  weights[1] = 0;
  Eigen::MatrixXd whitening = Eigen::MatrixXd::Identity(kSamples, kSamples);
  WhitenedEdge(observation, {}, weights).Whiten(whitening);
  EXPECT_TRUE(AreNear(whitening.col(1), Eigen::VectorXd::Zero(kSamples), 1e-15));
}

TEST(WhitenedEdge, DemandsAWeightForEachSample) {
  std::mt19937_64 generator = TestGenerator();
  const EdgeObservation observation = RandomEdges(generator, RandomUnknowns(generator))[0];
  EXPECT_THROW(WhitenedEdge(observation, {}, Eigen::VectorXd::Ones(kSamples - 1)), std::invalid_argument);
}

TEST(PlacesAlong, GoFromMinusOneToOne) {
  EdgeObservation edge;
  for (const double x : {10.0, 15.0, 30.0}) edge.samples.push_back({{x, 5 + x}, {0, 1}, 1});
  EXPECT_TRUE(AreNear(PlacesAlong(edge), Eigen::Vector3d(-1, -0.5, 1), 1e-15));
}

}  // namespace
}  // namespace legible
