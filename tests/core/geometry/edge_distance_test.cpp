#include "core/geometry/edge_distance.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "tests/testing/derivatives.h"
#include "tests/testing/edge_distance_by_newton.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

constexpr int kRandomCases = 50;
constexpr double kSolved_px = 2e-10;  // the foot is found to 1e-13 of the focal length, and rounding beyond

Camera CameraOf(LensModel lens, std::initializer_list<double> coefficients) {
  Camera camera{1280, 960, 1246.83, 1249.57, 654.12, 467.63, lens, Distortion::Zero()};
  std::copy(coefficients.begin(), coefficients.end(), camera.distortion.begin());
  return camera;
}

const Camera kPinhole = CameraOf(LensModel::kPinhole, {});
const Camera kBrownConrady = CameraOf(LensModel::kBrownConrady, {-0.25, 0.09, 0.0008, -0.0006, -0.01});
const Camera kRational = CameraOf(LensModel::kRational, {0.6, 0.04, 0.0008, -0.0006, 0.002, 0.9, 0.1, 0.005});
const Camera kFisheye = CameraOf(LensModel::kFisheye, {-0.05, 0.02, -0.01, 0.003});

// An edge through the image, a point some pixels beside it and a direction up to 40 degrees off the edge's
// normal.
struct Case {
  Eigen::Vector3d normal;
  Eigen::Vector2d point_px;
  Eigen::Vector2d direction_px;
  double offset_px;
};

Case RandomCase(std::mt19937_64& generator, const Camera& camera, double largest_offset_px) {
  const double angle = Uniform(generator, -M_PI, M_PI);
  const Eigen::Vector2d line(std::cos(angle), std::sin(angle));
  const Eigen::Vector2d on_edge = UniformVector(generator, -0.35, 0.35).head<2>();
  Case random;
  random.normal << line, -line.dot(on_edge);
  random.normal.normalize();
  const double turned = angle + Uniform(generator, -0.7, 0.7);
  random.direction_px << std::cos(turned), std::sin(turned);
  random.offset_px = Uniform(generator, -largest_offset_px, largest_offset_px);
  random.point_px = ProjectNormalised(camera, on_edge) + random.offset_px * random.direction_px;
  return random;
}

// Walks along the distorted edge and intersects it, piece by piece, with the line along the direction.
double DistanceByWalking(const Camera& camera, const Case& c) {
  const Eigen::Vector2d line = c.normal.head<2>();
  const Eigen::Vector2d along(-line.y(), line.x());
  const Eigen::Vector2d nearest_centre = -line * c.normal.z() / line.squaredNorm();
  const Eigen::Vector2d across_px(-c.direction_px.y(), c.direction_px.x());
  double best = std::numeric_limits<double>::infinity();
  constexpr int kSteps = 200000;
  Eigen::Vector2d before;
  for (int i = 0; i <= kSteps; ++i) {
    const Eigen::Vector2d x = nearest_centre + along.normalized() * (1.2 * i / kSteps - 0.6);
    const Eigen::Vector2d from_point = ProjectNormalised(camera, x) - c.point_px;
    const double side = across_px.dot(from_point), side_before = across_px.dot(before);
    if (i > 0 && side * side_before <= 0 && side != side_before) {
      const Eigen::Vector2d crossing = before + (from_point - before) * side_before / (side_before - side);
      const double distance = -c.direction_px.dot(crossing);
      if (std::abs(distance) < std::abs(best)) best = distance;
    }
    before = from_point;
  }
  return best;
}

class EdgeDistanceOfLens : public testing::TestWithParam<Camera> {};

TEST_P(EdgeDistanceOfLens, IsWhatWalkingAlongTheDistortedEdgeFinds) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 10; ++i) {
    const Case c = RandomCase(generator, GetParam(), 20);
    const auto found = DistanceToEdge(GetParam(), c.normal, c.point_px, c.direction_px);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->distance_px, DistanceByWalking(GetParam(), c), 1e-8);
  }
}

TEST_P(EdgeDistanceOfLens, IsTheOffsetGivenToAPointOfTheEdge) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < kRandomCases; ++i) {
    const Case c = RandomCase(generator, GetParam(), 20);
    const auto found = DistanceToEdge(GetParam(), c.normal, c.point_px, c.direction_px);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->distance_px, c.offset_px, kSolved_px);
  }
}

TEST_P(EdgeDistanceOfLens, VanishesOnTheEdge) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < kRandomCases; ++i) {
    const Case c = RandomCase(generator, GetParam(), 0);
    const auto found = DistanceToEdge(GetParam(), c.normal, c.point_px, c.direction_px);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->distance_px, 0, kSolved_px);
  }
}

TEST_P(EdgeDistanceOfLens, IsPositiveOutsideTheLeg) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < kRandomCases; ++i) {
    const Case c = RandomCase(generator, GetParam(), 20);
    const auto found = DistanceToEdge(GetParam(), c.normal, c.point_px, c.direction_px);
    ASSERT_TRUE(found);
    const auto x = Unproject(GetParam(), c.point_px);
    ASSERT_TRUE(x);
    EXPECT_GT(found->distance_px * c.normal.dot(x->homogeneous()), 0);
  }
}

// Camera (12) and normal (3) in one vector.
using Unknowns = Eigen::Matrix<double, kCameraParameterCount + 3, 1>;

TEST_P(EdgeDistanceOfLens, DerivativesAgreeWithNumericOnesAndWithJets) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < kRandomCases; ++i) {
    const Case c = RandomCase(generator, GetParam(), 5);
    const auto found = DistanceToEdge(GetParam(), c.normal, c.point_px, c.direction_px);
    ASSERT_TRUE(found);
    Eigen::Matrix<double, 1, kCameraParameterCount + 3> derivative;
    derivative << found->d_distance_d_camera, found->d_distance_d_normal;

    Unknowns at;
    at << ParametersOf(GetParam()), c.normal;
    const auto numeric = NumericJacobian(
        [&](const Unknowns& u) {
          const auto moved = DistanceToEdge(WithParameters(GetParam(), u.head<kCameraParameterCount>()),
                                            u.tail<3>(), c.point_px, c.direction_px);
          return Eigen::Matrix<double, 1, 1>(moved.value().distance_px);
        },
        at);
    const auto exact = JetJacobian(
        [&](const auto& u) {
          using T = typename std::decay_t<decltype(u)>::Scalar;
          return Eigen::Matrix<T, 1, 1>(
              DistanceByNewton<T>(GetParam(), u.template head<kCameraParameterCount>(), u.template tail<3>(),
                                  c.point_px, c.direction_px, c.normal));
        },
        at);
    // Derivatives reach some 1e3 px per unit of the normal: relative to that, rounding leaves 1e-13.
    EXPECT_TRUE(AreNear(derivative, exact, 1e-9));
    EXPECT_TRUE(AreNear(derivative, numeric, 1e-5));
  }
}

std::string NameOfLens(const testing::TestParamInfo<Camera>& lens) {
  const std::array<std::string, 4> names = {"Pinhole", "BrownConrady", "Rational", "Fisheye"};
  return names[lens.index];
}

INSTANTIATE_TEST_SUITE_P(Lenses, EdgeDistanceOfLens,
                         testing::Values(kPinhole, kBrownConrady, kRational, kFisheye), NameOfLens);

TEST(EdgeDistance, HasNoValueAlongTheEdge) {
  const Eigen::Vector3d normal(1, 0, 0);
  EXPECT_FALSE(DistanceToEdge(kPinhole, normal, {700, 400}, {0, 1}));
}

TEST(EdgeDistance, CameraAndItsParametersAgree) {
  CameraParameters parameters;
  parameters << 1246.83, 1249.57, 654.12, 467.63, kRational.distortion;
  EXPECT_EQ(ParametersOf(kRational), parameters);
  const Camera camera = WithParameters(kFisheye, parameters);
  EXPECT_EQ(ParametersOf(camera), parameters);
  EXPECT_EQ(camera.lens, LensModel::kFisheye);
}

}  // namespace
}  // namespace legible
