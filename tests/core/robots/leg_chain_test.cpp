#include "core/robots/leg_chain.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace legible {
namespace {

// What the exception says; empty where there is none.
template <typename Action>
std::string RefusalOf(const Action& action) {
  try {
    action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(LegChain, ReadsJointsInOrderWithWhatIsActuated) {
  const LegChain expected = {
      {JointType::kUniversal, false}, {JointType::kPrismatic, true}, {JointType::kSpherical, false}};
  EXPECT_EQ(ChainFromText("U_PS"), expected);
  EXPECT_EQ(ChainFromText("U-_P-S"), expected);
  EXPECT_EQ(ChainFromText("U _P S"), expected);
  const LegChain delta = {{JointType::kRevolute, true}, {JointType::kParallelRodsUS, false}};
  EXPECT_EQ(ChainFromText("_R-{2-US}"), delta);
  EXPECT_EQ(ChainFromText("PiRR"), ChainFromText("ΠRR"));
  EXPECT_EQ(ChainFromText("PiRR")[0].type, JointType::kParallelogram);
}

TEST(LegChain, TextReadsBackAsTheSame) {
  for (const char* text :
       {"_RRR", "R_RR", "_RPR", "R_PR", "_PRR",      "P_RR",      "_PPR", "P_PR", "_PRP", "P_RP",     "_RRP",
        "R_RP", "U_PS", "U_PU", "R_PS", "_R-{2-US}", "_P-{2-UU}", "_RUU", "_PUS", "Π_RR", "Π-_{2-UU}"})
    EXPECT_EQ(ToText(ChainFromText(text)), text);
}

TEST(LegChain, RefusesWhatIsNoJointByQuotingIt) {
  EXPECT_THAT(RefusalOf([] { ChainFromText("RXR"); }), testing::HasSubstr("\"XR\" in the leg \"RXR\""));
  EXPECT_THAT(RefusalOf([] { ChainFromText("_R-{3-US}"); }), testing::HasSubstr("\"{3-US}\""));
  EXPECT_THAT(RefusalOf([] { ChainFromText("RRR_"); }), testing::HasSubstr("\"RRR_\""));
}

TEST(SeenSegment, IsCarriedByTheFirstJointAndTurnsOrExtends) {
  const auto expect = [](const char* text, Carrier carrier, bool extends, DirectionOf direction) {
    const SeenSegment segment = SeenSegmentOf(ChainFromText(text));
    EXPECT_EQ(segment.carrier, carrier) << text;
    EXPECT_EQ(segment.extends, extends) << text;
    EXPECT_EQ(segment.direction, direction) << text;
  };
  for (const char* text : {"_RRR", "R_RR", "_R-{2-US}", "_R-{2-UU}", "_RUU", "_RUS"})
    expect(text, Carrier::kCircle, false, DirectionOf::kLeg);
  for (const char* text : {"_PRR", "P_RR", "_P-{2-US}", "_PUU", "_PUS"})
    expect(text, Carrier::kLine, false, DirectionOf::kLeg);
  for (const char* text : {"_RPR", "R_PR", "U_PS", "U_PU", "R_PS"})
    expect(text, Carrier::kFixed, true, DirectionOf::kLeg);
  for (const char* text : {"_PPR", "P_PR"}) expect(text, Carrier::kLine, true, DirectionOf::kConstant);
  for (const char* text : {"_PRP", "P_RP"}) expect(text, Carrier::kLine, true, DirectionOf::kPlatform);
  for (const char* text : {"_RRP", "R_RP"}) expect(text, Carrier::kCircle, true, DirectionOf::kPlatform);
}

TEST(SeenSegment, IsRefusedWithTheChainWhereKinematicsAreNotKnown) {
  const auto refusal = [](const char* text) {
    return RefusalOf([text] { SeenSegmentOf(ChainFromText(text)); });
  };
  EXPECT_THAT(refusal(""), testing::HasSubstr("three joints"));
  EXPECT_THAT(refusal("_RR"), testing::HasSubstr("_RR has not three joints"));
  EXPECT_THAT(refusal("RRR"), testing::HasSubstr("RRR needs exactly one actuated joint"));
  EXPECT_THAT(refusal("_R_RR"), testing::HasSubstr("_R_RR needs exactly one actuated joint"));
  EXPECT_THAT(refusal("RR_R"), testing::HasSubstr("RR_R has its actuated joint at the platform"));
  EXPECT_THAT(refusal("_UPS"), testing::HasSubstr("_UPS has an actuated joint that is neither R nor P"));
  EXPECT_THAT(refusal("_PPP"), testing::HasSubstr("_PPP is none of those known"));
  EXPECT_THAT(refusal("_RSS"), testing::HasSubstr("_RSS is none of those known"));
}

}  // namespace
}  // namespace legible
