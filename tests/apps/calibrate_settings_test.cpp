#include "apps/calibrate_settings.h"

#include <gmock/gmock.h>

namespace legible {
namespace {

PriorKnowledge KnownRadius() {
  PriorKnowledge known;
  known.radius_m = 5e-4;
  return known;
}

TEST(CalibrateSettings, KnowledgeIsParsedAsNameAndSigma) {
  EXPECT_EQ(ParseKnown("radius_m=2e-5"), std::make_pair(std::string("radius_m"), std::optional(2e-5)));
  EXPECT_EQ(ParseKnown("distortion=none"),
            std::make_pair(std::string("distortion"), std::optional<double>()));
  for (const char* wrong : {"", "=", "radius", "radius=1", "radius_m", "radius_m=", "radius_m=0",
                            "radius_m=-1", "radius_m=nan", "radius_m=inf", "radius_m=1 mm"})
    EXPECT_THROW(ParseKnown(wrong), std::invalid_argument) << wrong;
}

TEST(CalibrateSettings, KnowledgeGivenOverridesAddsAndForgetsTheSessions) {
  CalibrateSettings settings;
  settings.known = {{"radius_m", std::nullopt}, {"focal_length_px", 2.0}};
  PriorKnowledge session = KnownRadius();
  session.joint_reading_m = 2e-5;
  const PriorKnowledge known = WithSettings(session, settings);
  EXPECT_EQ(known.radius_m, std::nullopt);
  EXPECT_EQ(known.focal_length_px, 2.0);
  EXPECT_EQ(known.joint_reading_m, 2e-5);
}

TEST(CalibrateSettings, WithFreeLegsOnlyTheKnowledgeGivenCounts) {
  CalibrateSettings settings;
  settings.free_legs = true;
  EXPECT_EQ(WithSettings(KnownRadius(), settings).radius_m, std::nullopt);
  settings.known = {{"radius_m", 1e-5}};
  EXPECT_EQ(WithSettings(KnownRadius(), settings).radius_m, 1e-5);
}

TEST(CalibrateSettings, ThePlatformIsRigidAsLongAsSomethingSetsTheScale) {
  CalibrateSettings settings;
  EXPECT_TRUE(AssumesRigidPlatform(settings, {}));  // the readings
  settings.use_readings = false;
  EXPECT_TRUE(AssumesRigidPlatform(settings, KnownRadius()));
  EXPECT_FALSE(AssumesRigidPlatform(settings, {}));
  for (const char* size : {"radii", "base-joints", "platform-joints"}) {
    settings.hold = {size};
    EXPECT_TRUE(AssumesRigidPlatform(settings, {})) << size;
  }
  for (const char* no_size : {"focal-length", "principal-point", "distortion", "joint-offsets"}) {
    settings.hold = {no_size};
    EXPECT_FALSE(AssumesRigidPlatform(settings, {})) << no_size;
  }
}

TEST(CalibrateSettings, WithFreeLegsNeitherReadingsNorPlatformCount) {
  CalibrateSettings settings;
  settings.free_legs = true;
  settings.hold = {"radii"};
  Session session;
  session.known = KnownRadius();
  const SessionCalibrationOptions options = ToOptions(settings, session);
  EXPECT_FALSE(options.estimation.use_joint_readings);
  EXPECT_FALSE(options.estimation.rigid_platform);
  EXPECT_TRUE(options.estimation.hold.radii);
}

Session SessionWithTags() {
  Session session;
  session.tags = TagLayout{"tag36h11", {TagGroup(), TagGroup()}};
  session.tags->groups[0].name = "board";
  session.tags->groups[1].name = "top";
  session.tags->groups[1].carrier = TagCarrier::kPlatform;
  return session;
}

TEST(CalibrateSettings, TagsTakePartWhereNamed) {
  const Session session = SessionWithTags();
  CalibrateSettings settings;
  EXPECT_TRUE(TagGroupsOf(settings, session).empty());
  settings.tags = {"top"};
  EXPECT_EQ(TagGroupsOf(settings, session), std::set<std::string>{"top"});
  settings.tags = {"all"};
  EXPECT_EQ(TagGroupsOf(settings, session), (std::set<std::string>{"board", "top"}));
  settings.free_legs = true;
  EXPECT_EQ(TagGroupsOf(settings, session), std::set<std::string>{"board"});
}

TEST(CalibrateSettings, TagsThatAreNotThereOrOfNoUseAreRefused) {
  CalibrateSettings settings;
  settings.tags = {"botom"};
  EXPECT_THROW(TagGroupsOf(settings, SessionWithTags()), std::invalid_argument);
  settings.tags = {"all"};
  EXPECT_THROW(TagGroupsOf(settings, Session()), std::invalid_argument);
  settings.tags = {"top"};
  settings.free_legs = true;
  EXPECT_THROW(TagGroupsOf(settings, SessionWithTags()), std::invalid_argument);
}

TEST(CalibrateSettings, TagsSetTheScaleOfARigidPlatform) {
  CalibrateSettings settings;
  settings.use_readings = false;
  EXPECT_FALSE(AssumesRigidPlatform(settings, {}));
  settings.tags = {"all"};
  EXPECT_TRUE(AssumesRigidPlatform(settings, {}));
}

TEST(CalibrateSettings, EveryNameOfAThingToHoldHoldsAnother) {
  for (const std::string& name : HoldNames()) {
    CalibrateSettings settings;
    settings.hold = {name};
    const HeldParameters held = ToOptions(settings, {}).estimation.hold;
    EXPECT_EQ(held.focal_length + held.principal_point + held.distortion + held.base_joints +
                  held.platform_joints + held.radii + held.joint_offsets,
              1)
        << name;
  }
}

TEST(CalibrateSettings, OptionsAreToldAsTheyWouldBeTyped) {
  EXPECT_EQ(OptionsText({}), "none");
  CalibrateSettings settings;
  settings.lens = LensModel::kRational;
  settings.hold = {"radii", "distortion"};
  settings.known = {{"radius_m", 2e-5}, {"distortion", std::nullopt}};
  settings.use_readings = false;
  settings.folds = 0;
  settings.seed = 7;
  EXPECT_EQ(
      OptionsText(settings),
      "--lens rational --hold radii,distortion --known radius_m=2e-05 --known distortion=none --no-readings "
      "--folds 0 --seed 7");
}

TEST(CalibrateSettings, OptionsOfTheBoardAreWordedWithIt) {
  CalibrateSettings settings;
  settings.board_fit.estimates_warp = settings.board_fit.trusts_all = true;
  EXPECT_EQ(OptionsText(settings), "none");  // without a board they change nothing
  settings.board = "board.yaml";
  settings.board_images = {"a", "b.png"};
  EXPECT_EQ(OptionsText(settings), "--with-board a b.png --board board.yaml --board-warp --all-corners");
}

TEST(CalibrateSettings, LensNamesNameLenses) {
  for (const std::string& name : LensNames()) EXPECT_EQ(LensName(LensFromName(name).value()), name);
  EXPECT_EQ(LensFromName("plumb_bob"), std::nullopt);
}

}  // namespace
}  // namespace legible
