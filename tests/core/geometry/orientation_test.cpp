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

std::vector<std::string> AllNames() {
  std::vector<std::string> names = {"rotation-vector"};
  for (const std::string letters : {"xyz", "XYZ"})
    for (const char a : letters)
      for (const char b : letters)
        for (const char c : letters)
          if (a != b && b != c) names.push_back({a, b, c});
  return names;
}

TEST(Orientation, EveryConventionGivesBackTheRotation) {
  std::mt19937_64 generator = TestGenerator();
  const std::vector<std::string> names = AllNames();
  ASSERT_EQ(names.size(), 25u);
  for (const std::string& name : names) {
    const OrientationConvention convention = Named(name);
    for (int n = 0; n < 50; ++n) {
      const Eigen::Quaterniond rotation = UniformRotation(generator);
      EXPECT_LT(convention.ToRotation(convention.FromRotation(rotation)).angularDistance(rotation), 1e-6)
          << name;
    }
    // Quarter and half turns lock the gimbal of one or another convention.
    for (const Vector3d& axis : {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1)})
      for (const double turn : {0.0, std::numbers::pi / 2, -std::numbers::pi / 2, std::numbers::pi}) {
        const Eigen::Quaterniond rotation(AngleAxisd(turn, axis));
        EXPECT_LT(convention.ToRotation(convention.FromRotation(rotation)).angularDistance(rotation), 1e-6)
            << name;
      }
  }
}

TEST(Orientation, SmallTurnsHaveSmallAnglesOfEitherSign) {
  std::mt19937_64 generator = TestGenerator();
  for (const std::string& name : AllNames()) {
    if (name.size() == 3 && name[0] == name[2]) continue;  // there only the sum of the outer angles is small
    for (int n = 0; n < 20; ++n) {
      const Eigen::Quaterniond rotation = RotationFromVector(UniformVector(generator, -0.2, 0.2));
      EXPECT_LT(Named(name).FromRotation(rotation).cwiseAbs().maxCoeff(), 0.3) << name;
    }
  }
}

TEST(Orientation, NamesThatAreNoConventionHaveNone) {
  for (const std::string name : {"", "Z", "ZZX", "XYY", "ZYx", "abc", "ZYXZ", "rotation vector"})
    EXPECT_FALSE(OrientationConvention::FromName(name)) << name;
}

}  // namespace
}  // namespace legible
