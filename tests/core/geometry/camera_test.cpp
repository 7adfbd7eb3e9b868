#include "core/geometry/camera.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "tests/testing/derivatives.h"
#include "tests/testing/matrices.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

using Eigen::Vector2d;

Distortion Coefficients(std::initializer_list<double> values) {
  Distortion k = Distortion::Zero();
  std::copy(values.begin(), values.end(), k.begin());
  return k;
}

Camera TestCamera(LensModel lens, const Distortion& k) {
  Camera camera{.width_px = 1280, .height_px = 960, .fx_px = 1250, .fy_px = 1247, .cx_px = 652, .cy_px = 467};
  camera.lens = lens;
  camera.distortion = k;
  return camera;
}

// Lenses as they are calibrated in practice, from nearly none to a wide angle.
const Distortion kBarrelCoefficients = Coefficients({-0.35, 0.14, 1e-3, -5e-4, -0.025});
const Camera kMild = TestCamera(LensModel::kBrownConrady, Coefficients({-0.12, 0.05, 4e-4, -3e-4, -0.01}));
const Camera kBarrel = TestCamera(LensModel::kBrownConrady, kBarrelCoefficients);
const Camera kPincushion = TestCamera(LensModel::kBrownConrady, Coefficients({0.2, 0.05, -1e-3, 2e-3, 0.01}));
const Camera kRational =
    TestCamera(LensModel::kRational, Coefficients({0.6, 0.04, 5e-4, -7e-4, 0.002, 0.9, 0.1, 0.005}));
const Camera kFisheye = TestCamera(LensModel::kFisheye, Coefficients({-0.013, 0.011, -0.009, 0.002}));
const Camera kStrongFisheye = TestCamera(LensModel::kFisheye, Coefficients({0.08, -0.04, 0.02, -0.006}));
const std::vector<Camera> kLenses = {kMild, kBarrel, kPincushion, kRational, kFisheye, kStrongFisheye};
const std::vector<LensModel> kModels = {LensModel::kPinhole, LensModel::kFisheye, LensModel::kBrownConrady,
                                        LensModel::kRational};

// Any lens: large radial terms, with folds and poles at any radius, tangential ones up to ten times the
// usual.
Distortion RandomDistortion(std::mt19937_64& generator, LensModel lens) {
  Distortion k = Distortion::Zero();
  for (double& coefficient : k) coefficient = Uniform(generator, -0.6, 0.6);
  const double others = lens == LensModel::kFisheye ? 0.6 : 0.01;
  k[2] = Uniform(generator, -others, others);
  k[3] = Uniform(generator, -others, others);
  for (int i = static_cast<int>(lens); i < k.size(); ++i) k[i] = 0;
  return k;
}

Vector2d RandomPoint(std::mt19937_64& generator, double largest_radius) {
  return largest_radius * Uniform(generator, 0, 1) * UniformVector(generator, -1, 1).head<2>().normalized();
}

// The camera-frame point of depth 1 with the given normalised coordinates.
Eigen::Vector3d InFront(const Vector2d& x) { return x.homogeneous(); }

// --- Agreement with OpenCV. ------------------------------------------------------------------------------

cv::Mat1d OpenCvMatrix(const Camera& camera) {
  return (cv::Mat1d(3, 3) << camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
}

cv::Mat1d OpenCvCoefficients(const Camera& camera) {
  cv::Mat1d coefficients(1, static_cast<int>(camera.lens));
  for (int i = 0; i < coefficients.cols; ++i) coefficients(0, i) = camera.distortion[i];
  return coefficients;
}

Vector2d ProjectByOpenCv(const Camera& camera, const Eigen::Vector3d& x) {
  const std::vector<cv::Point3d> points = {{x[0], x[1], x[2]}};
  const cv::Vec3d zero(0, 0, 0);
  std::vector<cv::Point2d> pixels;
  if (camera.lens == LensModel::kFisheye)
    cv::fisheye::projectPoints(points, pixels, zero, zero, OpenCvMatrix(camera), OpenCvCoefficients(camera));
  else
    cv::projectPoints(points, zero, zero, OpenCvMatrix(camera), OpenCvCoefficients(camera), pixels);
  return {pixels[0].x, pixels[0].y};
}

Vector2d UnprojectByOpenCv(const Camera& camera, const Vector2d& pixel) {
  const cv::TermCriteria to_the_end(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 1000, 1e-14);
  const std::vector<cv::Point2d> pixels = {{pixel[0], pixel[1]}};
  std::vector<cv::Point2d> points;
  if (camera.lens == LensModel::kFisheye)
    cv::fisheye::undistortPoints(pixels, points, OpenCvMatrix(camera), OpenCvCoefficients(camera));
  else
    cv::undistortPoints(pixels, points, OpenCvMatrix(camera), OpenCvCoefficients(camera), cv::noArray(),
                        cv::noArray(), to_the_end);
  return {points[0].x, points[0].y};
}

TEST(Camera, ProjectAgreesWithOpenCv) {
  std::mt19937_64 generator = TestGenerator();
  for (const Camera& camera : kLenses) {
    const double reach = camera.lens == LensModel::kFisheye ? 5 : 0.8;
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3d x = Uniform(generator, 0.3, 3) * InFront(RandomPoint(generator, reach));
      EXPECT_TRUE(AreNear(Project(camera, x), ProjectByOpenCv(camera, x), 1e-11));
    }
  }
}

TEST(Camera, UnprojectAgreesWithOpenCv) {
  std::mt19937_64 generator = TestGenerator();
  for (const Camera& camera : kLenses) {
    // cv::fisheye stops where a step in theta is below 1e-8; Newton's steps square the error.
    for (int i = 0; i < 100; ++i) {
      const Vector2d pixel(Uniform(generator, 0, camera.width_px), Uniform(generator, 0, camera.height_px));
      const std::optional<Vector2d> found = Unproject(camera, pixel);
      ASSERT_TRUE(found.has_value());
      EXPECT_TRUE(AreNear(*found, UnprojectByOpenCv(camera, pixel), 1e-12));
    }
  }
}

// --- Projection and its inverse. -------------------------------------------------------------------------

TEST(Camera, PinholeProjectsByFocalLengthOverDepth) {
  const Camera camera = TestCamera(LensModel::kPinhole, Distortion::Zero());
  EXPECT_TRUE(AreNear(Project(camera, {0.2, -0.1, 2}), Vector2d(652 + 125, 467 - 62.35), 1e-12));
}

TEST(Camera, UnprojectInvertsProject) {
  std::mt19937_64 generator = TestGenerator();
  for (const Camera& camera : kLenses) {
    for (int i = 0; i < 100; ++i) {
      const Vector2d x = RandomPoint(generator, 0.8);
      const std::optional<Vector2d> found = Unproject(camera, Project(camera, 1.7 * InFront(x)));
      ASSERT_TRUE(found.has_value());
      EXPECT_TRUE(AreNear(*found, x, 1e-14));
    }
  }
}

TEST(Camera, ProjectRefusesPointsThatAreNotInFront) {
  EXPECT_THROW(Project(kMild, {0.1, 0.1, 0}), std::invalid_argument);
  EXPECT_THROW(Project(kMild, {0.1, 0.1, -1}), std::invalid_argument);
  EXPECT_THROW(Project(kMild, {0.1, 0.1, NAN}), std::invalid_argument);
}

// --- Derivatives. ----------------------------------------------------------------------------------------

TEST(DistortWithJacobians, MatchesJetsAndCentralDifferences) {
  std::mt19937_64 generator = TestGenerator();
  for (const LensModel lens : {LensModel::kRational, LensModel::kFisheye})
    for (int i = 0; i < 200; ++i) {
      const Distortion k = 0.1 * RandomDistortion(generator, lens);
      const Vector2d x = RandomPoint(generator, 1);
      const DistortedPoint found = DistortWithJacobians(lens, k, x);
      const auto by_point = [&](const auto& point) { return Distort(lens, k, point); };
      const auto by_coefficients = [&]<typename T>(const Eigen::Matrix<T, 8, 1>& coefficients) {
        return Distort(lens, coefficients, Eigen::Matrix<T, 2, 1>(x.cast<T>()));
      };
      EXPECT_EQ(found.point, by_point(x));
      EXPECT_TRUE(AreNear(found.d_point_d_undistorted, JetJacobian(by_point, x), 1e-14));
      EXPECT_TRUE(AreNear(found.d_point_d_undistorted, NumericJacobian(by_point, x), 1e-11));
      EXPECT_TRUE(AreNear(found.d_point_d_coefficients, JetJacobian(by_coefficients, k), 1e-14));
      EXPECT_TRUE(AreNear(found.d_point_d_coefficients, NumericJacobian(by_coefficients, k), 1e-11));
    }
}

// --- The fisheye's quotients near the axis. --------------------------------------------------------------

TEST(Fisheye, IsTheAngleTimesThePolynomialInTheDirectionOfThePoint) {
  const Distortion& k = kStrongFisheye.distortion;
  for (const double theta : {1e-12, 1e-8, 1e-4, 0.01, 0.2449, 0.245, 0.5, 1.0, 1.4}) {
    const double t2 = theta * theta;
    const double theta_d =
        theta * (1 + k[0] * t2 + k[1] * t2 * t2 + k[2] * t2 * t2 * t2 + k[3] * t2 * t2 * t2 * t2);
    const Vector2d direction(0.6, -0.8);
    const Vector2d found = Distort<double>(LensModel::kFisheye, k, std::tan(theta) * direction);
    EXPECT_TRUE(AreNear(found / theta_d, direction, 1e-15)) << theta;
  }
}

TEST(Fisheye, IsTheIdentityOnTheAxisWithDerivativesThatGoOverIntoTheirNeighbours) {
  const Distortion& k = kStrongFisheye.distortion;
  const DistortedPoint on_axis = DistortWithJacobians(LensModel::kFisheye, k, {0, 0});
  EXPECT_EQ(on_axis.point, Vector2d(0, 0));
  EXPECT_EQ(on_axis.d_point_d_undistorted, Eigen::Matrix2d::Identity());
  for (const double r : {1e-160, 1e-9, 1e-6}) {
    const DistortedPoint beside = DistortWithJacobians(LensModel::kFisheye, k, r * Vector2d(0.6, 0.8));
    EXPECT_TRUE(AreNear(beside.d_point_d_undistorted, Eigen::Matrix2d::Identity(), r * r + 1e-15)) << r;
  }
}

// Where the code goes from one to the other, with the slope's closed form.
TEST(Fisheye, SeriesAndQuotientMeet) {
  for (const double k1 : {0.0, 0.3}) {
    const Distortion k = Coefficients({k1});
    const double edge = 0.25;
    const DistortedPoint below = DistortWithJacobians(LensModel::kFisheye, k, {edge, 0});
    const DistortedPoint above = DistortWithJacobians(LensModel::kFisheye, k, {std::nextafter(edge, 1), 0});
    EXPECT_NEAR(below.point.x(), above.point.x(), 2e-16);
    EXPECT_TRUE(AreNear(below.d_point_d_undistorted, above.d_point_d_undistorted, 2e-15));
    EXPECT_NEAR(below.d_point_d_undistorted(0, 0),
                (1 + 3 * k1 * std::pow(std::atan(edge), 2)) / (1 + edge * edge), 2e-15);
  }
}

// --- The monotonic radius. -------------------------------------------------------------------------------

// Smallest radius at which the distorted radius stops rising or the denominator reaches zero, by a fine scan.
double RadialFoldByScan(const Distortion& k, double step) {
  double last = 0;
  for (double r = step; r < 10; r += step) {
    const double r2 = r * r;
    const double denominator = 1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7]));
    const double distorted = r * (1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / denominator;
    if (denominator <= 0 || distorted <= last) return r;
    last = distorted;
  }
  return 10;
}

TEST(MonotonicRadius, IsWhereTheRadialPartStopsRising) {
  std::mt19937_64 generator = TestGenerator();
  constexpr double kStep = 1e-4;
  for (const LensModel lens : {LensModel::kBrownConrady, LensModel::kRational}) {
    for (int i = 0; i < 200; ++i) {
      Distortion k = RandomDistortion(generator, lens) * std::pow(10, Uniform(generator, -3, 0));
      k.segment<2>(2).setZero();
      EXPECT_NEAR(MonotonicRadius(lens, k), RadialFoldByScan(k, kStep), 2 * kStep) << k.transpose();
    }
  }
}

double SmallestSlope(LensModel lens, const Distortion& k, const Vector2d& x) {
  const Eigen::Matrix2d jacobian = DistortWithJacobians(lens, k, x).d_point_d_undistorted;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(jacobian).eigenvalues()[0];
}

TEST(MonotonicRadius, HasNoFoldWithinWhateverTheCoefficients) {
  std::mt19937_64 generator = TestGenerator();
  for (const LensModel lens : kModels) {
    for (int i = 0; i < 300; ++i) {
      const Distortion k = RandomDistortion(generator, lens);
      const double radius = MonotonicRadius(lens, k);
      for (int j = 0; j < 100; ++j) {
        EXPECT_GT(SmallestSlope(lens, k, RandomPoint(generator, radius)), 0) << k.transpose();
      }
    }
  }
}

// The tangential terms take up to 6 |(p1, p2)| r from the slope, at the point opposite (p2, p1).
TEST(MonotonicRadius, EndsWithinTheReachOfTheTangentialTermsOfTheFold) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 300; ++i) {
    const Distortion k = RandomDistortion(generator, LensModel::kBrownConrady);
    const double radius = MonotonicRadius(LensModel::kBrownConrady, k),
                 reach = k.segment<2>(2).norm() * radius;
    if (radius > 3) continue;  // farther out the terms cancel too much for the digits asked for below
    const Vector2d worst = -radius * Vector2d(k[3], k[2]).normalized();
    EXPECT_NEAR(SmallestSlope(LensModel::kBrownConrady, k, worst), 0.4 * reach, 1e-12) << k.transpose();
  }
}

TEST(MonotonicRadius, IsExactWhereItHasAClosedForm) {
  const auto radius = [](std::initializer_list<double> k) {
    return MonotonicRadius(LensModel::kRational, Coefficients(k));
  };
  EXPECT_EQ(radius({}), 10);
  EXPECT_NEAR(radius({-0.3}), std::sqrt(1 / 0.9), 1e-15);    // 1 + 3 k1 r2 = 0
  EXPECT_NEAR(radius({0, -0.1}), std::pow(2, 0.25), 1e-15);  // 1 + 5 k2 r4 = 0
  EXPECT_NEAR(radius({0, 0, 0, 0, 0, -0.25}), 2, 1e-15);     // pole: 1 + k4 r2 = 0
  EXPECT_NEAR(radius({0, 0, 0, 0, 0, 0.25}), 2, 1e-15);      // r / (1 + r2 / 4) turns
  EXPECT_EQ(radius({-2, 2}), 10);                            // 1 - 6 r2 + 10 r4 > 0: dips, but never falls
}

TEST(MonotonicRadius, OfTheFisheyeIsTheTangentOfTheAngleWhereItTurns) {
  const auto radius = [](std::initializer_list<double> k) {
    return MonotonicRadius(LensModel::kFisheye, Coefficients(k));
  };
  EXPECT_EQ(radius({}), 10);
  EXPECT_NEAR(radius({-1}), std::tan(std::sqrt(1 / 3.0)), 1e-15);              // 1 + 3 k1 theta^2 = 0
  EXPECT_NEAR(radius({0, -1}), std::tan(std::pow(5, -0.25)), 1e-15);           // 1 + 5 k2 theta^4 = 0
  EXPECT_NEAR(radius({0, 0, -1}), std::tan(std::pow(7, -1 / 6.0)), 1e-15);     // 1 + 7 k3 theta^6 = 0
  EXPECT_NEAR(radius({0, 0, 0, -1}), std::tan(std::pow(9, -1 / 8.0)), 1e-15);  // 1 + 9 k4 theta^8 = 0
}

// --- The inverse of the distortion. ----------------------------------------------------------------------

TEST(Undistort, InvertsDistortInsideTheMonotonicRadius) {
  std::mt19937_64 generator = TestGenerator();
  for (const LensModel lens : kModels) {
    for (int i = 0; i < 3000; ++i) {
      const Distortion k = RandomDistortion(generator, lens);
      const Vector2d x = RandomPoint(generator, MonotonicRadius(lens, k));
      const Vector2d distorted = Distort<double>(lens, k, x);
      if (distorted.norm() > 100)
        continue;  // so near a pole rounding of x alone moves it by more than asked for
      const std::optional<Vector2d> found = Undistort(lens, k, distorted);
      ASSERT_TRUE(found.has_value()) << k.transpose() << "  x " << x.transpose();
      const double rounding = 1e-14 * (1 + distorted.norm());
      EXPECT_TRUE(AreNear(*found, x, rounding * (1 + 1 / SmallestSlope(lens, k, x)))) << k.transpose();
    }
  }
}

TEST(Undistort, ReachesTheFold) {
  const Distortion k = Coefficients({-0.3});
  const double fold = MonotonicRadius(LensModel::kBrownConrady, k);
  for (const double gap : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5}) {
    const Vector2d x = (fold - gap) * Vector2d(0.6, 0.8);
    const std::optional<Vector2d> found =
        Undistort(LensModel::kBrownConrady, k, Distort<double>(LensModel::kBrownConrady, k, x));
    ASSERT_TRUE(found.has_value()) << "gap " << gap;
    EXPECT_TRUE(AreNear(*found, x, 1e-15 / gap + 1e-15)) << "gap " << gap;  // the slope there is some 2 gap
  }
}

TEST(Undistort, FindsNothingBeyondTheFold) {
  const Distortion k = Coefficients({-0.3});
  const Vector2d fold = Distort<double>(LensModel::kBrownConrady, k,
                                        MonotonicRadius(LensModel::kBrownConrady, k) * Vector2d(0.6, 0.8));
  EXPECT_TRUE(Undistort(LensModel::kBrownConrady, k, fold * (1 - 1e-9)).has_value());
  EXPECT_FALSE(Undistort(LensModel::kBrownConrady, k, fold * (1 + 1e-9)).has_value());
  EXPECT_FALSE(Undistort(LensModel::kBrownConrady, k, fold * 3).has_value());
}

TEST(Undistort, NeverAnswersWithAPointBeyondTheMonotonicRadius) {
  std::mt19937_64 generator = TestGenerator();
  for (const LensModel lens : kModels) {
    for (int i = 0; i < 3000; ++i) {
      const Distortion k = RandomDistortion(generator, lens);
      const double radius = MonotonicRadius(lens, k);
      const Vector2d distorted = RandomPoint(generator, 3);
      const std::optional<Vector2d> found = Undistort(lens, k, distorted);
      if (!found) continue;
      EXPECT_TRUE(radius == 10 || found->norm() <= radius) << k.transpose();
      EXPECT_TRUE(AreNear(Distort<double>(lens, k, *found), distorted, 1e-11)) << k.transpose();
    }
  }
}

// r (1 - 3 r2 + 3 r4) takes r = 1 to 1 again, but folds at 0.38 already.
TEST(Undistort, IsNotFooledByALensThatUnfoldsAgain) {
  const Distortion k = Coefficients({-3, 3});
  EXPECT_FALSE(Undistort(LensModel::kBrownConrady, k, {1, 0}).has_value());
  const Vector2d x(0.2, -0.1);
  ASSERT_TRUE(
      Undistort(LensModel::kBrownConrady, k, Distort<double>(LensModel::kBrownConrady, k, x)).has_value());
  EXPECT_TRUE(AreNear(
      *Undistort(LensModel::kBrownConrady, k, Distort<double>(LensModel::kBrownConrady, k, x)), x, 1e-14));
}

TEST(Undistort, ReachesAsFarOutAsThereIsALens) {
  EXPECT_TRUE(
      AreNear(*Undistort(LensModel::kBrownConrady, Distortion::Zero(), {30, -40}), Vector2d(30, -40), 0));
}

TEST(Undistort, FindsNothingForWhatIsNotANumber) {
  EXPECT_FALSE(Undistort(LensModel::kBrownConrady, kBarrelCoefficients, {NAN, 0}).has_value());
  EXPECT_FALSE(Undistort(LensModel::kBrownConrady, kBarrelCoefficients, {0, INFINITY}).has_value());
  EXPECT_FALSE(Undistort(LensModel::kBrownConrady, Coefficients({NAN}), {0.1, 0.1}).has_value());
}

}  // namespace
}  // namespace legible
