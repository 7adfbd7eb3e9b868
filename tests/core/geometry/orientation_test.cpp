#include "core/geometry/orientation.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/testing/random.h"

namespace legible {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

OrientationConvention Named(const std::string& name) { return *OrientationConvention::FromName(name); }

TEST(Orientation, IsARotationVectorUnlessNamed) {
  const OrientationConvention convention;
  EXPECT_TRUE(convention.IsRotationVector());
  EXPECT_NEAR(convention.ToRotation({0, 0, 0.3})
                  .angularDistance(Eigen::Quaterniond(AngleAxisd(0.3, Vector3d::UnitZ()))),
              0, 1e-15);
}

TEST(Orientation, CapitalsTurnAboutMovingAxesAndSmallLettersAboutFixedOnes) {
  const Vector3d angles(0.3, -0.2, 0.5);
  const Eigen::Quaterniond about_z(AngleAxisd(0.3, Vector3d::UnitZ())),
      about_y(AngleAxisd(-0.2, Vector3d::UnitY())), about_x(AngleAxisd(0.5, Vector3d::UnitX()));
  EXPECT_NEAR(Named("ZYX").ToRotation(angles).angularDistance(about_z * about_y * about_x), 0, 1e-7);
  EXPECT_NEAR(Named("zyx").ToRotation(angles).angularDistance(about_x * about_y * about_z), 0, 1e-7);
}

TEST(Orientation, EveryConventionGivesBackTheRotation) {
  std::mt19937_64 generator = TestGenerator();
  for (const std::string name :
       {"rotation-vector", "ZYX", "XYZ", "ZXZ", "ZYZ", "YXY", "xyz", "zyx", "zxz", "yzx"})
    for (int n = 0; n < 20; ++n) {
      const Eigen::Quaterniond rotation = UniformRotation(generator);
      const OrientationConvention convention = Named(name);
      EXPECT_LT(convention.ToRotation(convention.FromRotation(rotation)).angularDistance(rotation), 1e-6)
          << name;
    }
}

TEST(Orientation, NamesThatAreNoConventionHaveNone) {
  for (const std::string name : {"", "Z", "ZZX", "XYY", "ZYx", "abc", "ZYXZ", "rotation vector"})
    EXPECT_FALSE(OrientationConvention::FromName(name)) << name;
}

}  // namespace
}  // namespace legible
