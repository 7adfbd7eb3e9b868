#include "core/hidden/hidden_leg.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/hidden/vertex_space.h"
#include "core/robots/leg_state.h"
#include "tests/testing/random.h"
#include "tests/testing/random_robots.h"

namespace legible {
namespace {

std::string HiddenOf(const char* real, PlatformMotion motion) {
  return ToText(HiddenLegOf(ChainFromText(real), motion).chain);
}

// Briot et al. (2016), Table 1 and section 4.1.1. For RRP the text prints ΠRRP: three joints of the real leg
// with a passive parallelogram before them, where the table's drawing has it in place of the first R.
TEST(HiddenLeg, OfPlanarLegsIsThatOfTable1) {
  struct Row {
    const char* real;
    const char* hidden;
    bool is_controllable;
  };
  for (const Row& row :
       {Row{"_RRR", "Π_RR", true}, Row{"R_RR", "Π_RR", true}, Row{"_RPR", "_RPR", true},
        Row{"R_PR", "_RPR", true}, Row{"_PRR", "P_RR", true}, Row{"P_RR", "P_RR", true},
        Row{"_PPR", "", false}, Row{"P_PR", "", false}, Row{"_PRP", "P_RP", false},
        Row{"P_RP", "P_RP", false}, Row{"_RRP", "Π_RP", false}, Row{"R_RP", "Π_RP", false}}) {
    const HiddenLeg hidden = HiddenLegOf(ChainFromText(row.real), PlatformMotion::kPlanar);
    EXPECT_EQ(ToText(hidden.chain), row.hidden) << row.real;
    EXPECT_EQ(hidden.why_not_controllable.empty(), row.is_controllable) << row.real;
    EXPECT_EQ(hidden.actuated_coordinates, hidden.chain.empty() ? 0 : 1) << row.real;
  }
  const auto why = [](const char* real) {
    return HiddenLegOf(ChainFromText(real), PlatformMotion::kPlanar).why_not_controllable;
  };
  EXPECT_THAT(why("_PPR"), testing::HasSubstr("constant"));
  EXPECT_THAT(why("_PRP"), testing::HasSubstr("orientation"));
}

// Section 4.2.1.
TEST(HiddenLeg, OfPodsHasItsBaseJointActuated) {
  EXPECT_EQ(HiddenOf("U_PS", PlatformMotion::kSpatial), "_UPS");
  EXPECT_EQ(HiddenOf("U_PU", PlatformMotion::kTranslation), "_UPU");
  EXPECT_EQ(HiddenOf("R_PS", PlatformMotion::kSpatial), "_RPS");
}

// Section 4.2.2: lower mobility takes the leg with a U at the platform.
TEST(HiddenLeg, OfDeltaLikeRobotsHasItsRodsActuated) {
  EXPECT_EQ(HiddenOf("_R-{2-US}", PlatformMotion::kSpatial), "Π-_{2-US}");
  EXPECT_EQ(HiddenOf("_R-{2-US}", PlatformMotion::kTranslation), "Π-_{2-UU}");
  EXPECT_EQ(HiddenOf("_R-{2-US}", PlatformMotion::kSchoenflies), "Π-_{2-UU}");
  EXPECT_EQ(HiddenOf("_P-{2-US}", PlatformMotion::kTranslation), "P-_{2-UU}");
  EXPECT_EQ(HiddenOf("_RUU", PlatformMotion::kTranslation), "Π_UU");
  EXPECT_EQ(HiddenOf("_PUU", PlatformMotion::kTranslation), "P_UU");
  EXPECT_EQ(HiddenOf("_RUS", PlatformMotion::kSpatial), "Π_US");
  EXPECT_EQ(HiddenOf("_PUS", PlatformMotion::kSpatial), "P_US");
}

TEST(HiddenLeg, HoldsTwoCoordinatesInSpaceAndOneWhereItTurnsInAPlane) {
  const auto coordinates = [](const char* real, PlatformMotion motion) {
    return HiddenLegOf(ChainFromText(real), motion).actuated_coordinates;
  };
  for (const char* real : {"U_PS", "_RUS", "_PUS", "_R-{2-US}"})
    EXPECT_EQ(coordinates(real, PlatformMotion::kSpatial), 2) << real;
  EXPECT_EQ(coordinates("R_PS", PlatformMotion::kSpatial), 1);
  EXPECT_EQ(coordinates("_RRR", PlatformMotion::kPlanarPoint), 1);
}

// How far C is from the space, relative to the space's size where that is a circle.
double DistanceFrom(const VertexSpace& space, const Eigen::Vector3d& c) {
  const Eigen::Vector3d from_point = c - space.point_m;
  if (!space.is_circle) return from_point.cross(space.along).norm();
  const Eigen::Vector3d normal = space.along.cross(space.second_radius);
  return std::hypot(from_point.dot(normal), from_point.norm() - space.radius_m);
}

// With the direction held, C goes along the circle or line, and starts out along the free direction.
TEST(VertexSpace, ContainsThePlatformJointAndLeavesItAlongTheFreeDirection) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 50; ++n)
    for (const RobotAtPose& random : {RandomSpatialRobot(generator, {"U_PS", "_PUS", "_RUS", "R_PS"}),
                                      RandomPlanarRobot(generator, {"_RRR", "R_PR", "P_RR"}),
                                      RandomSchoenfliesRobot(generator, "_R-{2-US}")})
      for (const RobotLeg& leg : random.robot.legs) {
        const LegState state = StateOf(leg, random.pose).value();
        const VertexSpace space = VertexSpaceOf(leg, state.direction);
        EXPECT_EQ(space.is_circle, SeenSegmentOf(leg.chain).carrier == Carrier::kCircle);
        EXPECT_LT(DistanceFrom(space, state.platform_joint_m), 1e-12) << ToText(leg.chain);
        const Eigen::Vector3d beside = state.platform_joint_m + 1e-6 * state.free_direction;
        EXPECT_LT(DistanceFrom(space, beside), 1e-11) << ToText(leg.chain);
      }
}

// Of axes that are unit and across each other to 1e-6 alone, as robots may have them.
TEST(VertexSpace, OfACircleHasRadiiThatAreUnitAndAcrossEachOther) {
  std::mt19937_64 generator = TestGenerator();
  for (int n = 0; n < 50; ++n) {
    RobotAtPose random = RandomSpatialRobot(generator, {"_RUS", "_RUS", "_RUS"});
    for (RobotLeg& leg : random.robot.legs) {
      leg.first_axis += UniformVector(generator, -4e-7, 4e-7);
      leg.zero_direction += UniformVector(generator, -4e-7, 4e-7);
      const VertexSpace space = VertexSpaceOf(leg, RandomDirection(generator));
      EXPECT_NEAR(space.along.norm(), 1, 5e-16);
      EXPECT_NEAR(space.second_radius.norm(), 1, 5e-16);
      EXPECT_NEAR(space.along.dot(space.second_radius), 0, 5e-16);
      EXPECT_LT((space.along - leg.zero_direction).norm(), 2e-6);
    }
  }
}

}  // namespace
}  // namespace legible
