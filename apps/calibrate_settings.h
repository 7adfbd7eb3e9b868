// What the user of `legible calibrate` asks for, and what follows from it for the estimation.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "apps/board_fit_settings.h"
#include "calib/session_calibration.h"
#include "core/session/session.h"

namespace legible {

struct CalibrateSettings {
  std::filesystem::path session;
  std::filesystem::path out = "calibration";
  bool prints_json = false;
  std::optional<LensModel> lens;                                     // none: the session camera's
  std::vector<std::string> hold;                                     // names of HoldNames()
  std::vector<std::pair<std::string, std::optional<double>>> known;  // names of KnownNames(); none: forgotten
  std::vector<std::string> tags;  // groups of tags.yaml that count as observations, or "all"
  std::vector<std::filesystem::path> board_images;  // to be solved together with the legs
  std::optional<std::filesystem::path> board;       // that they show
  BoardFitSettings board_fit;
  bool use_readings = true;
  bool free_legs = false;  // edges only
  int folds = 5;
  std::optional<std::uint64_t> seed;
  int threads = 2;
  bool embeds_pictures = true;
};

// "pinhole", "brown-conrady", "rational".
std::vector<std::string> LensNames();
std::string LensName(LensModel lens);
std::optional<LensModel> LensFromName(const std::string& name);

// What can be held: "focal-length", …; what can be known: "radius_m", …, as session.yaml names it.
std::vector<std::string> HoldNames();
std::vector<std::string> KnownNames();

// "radius_m=0.0005" or "radius_m=none" taken apart. Throws std::invalid_argument with a message for the user.
std::pair<std::string, std::optional<double>> ParseKnown(const std::string& text);

// Whether "camera=none" is among them: what a board told of the camera is to be left out.
bool ForgetsCamera(const std::vector<std::pair<std::string, std::optional<double>>>& known);

// What is known beforehand: what the session says (with free legs, nothing), and over it what the settings
// say.
PriorKnowledge WithSettings(const PriorKnowledge& session, const CalibrateSettings& settings);

// By KnownNames(), without what is not known.
std::vector<std::pair<std::string, double>> NamedKnowledge(const PriorKnowledge& known);

// The session's tag groups that count as observations. Throws std::invalid_argument with a message for the
// user where one is not there, or with free legs is on the platform ("all": those on the base only).
std::set<std::string> TagGroupsOf(const CalibrateSettings& settings, const Session& session);

// Joint readings, or a size that is known beforehand, held or shown by tags, set the scale of a robot whose
// legs hang on one rigid platform. Where nothing does, the platform's rigidity is not assumed either ("edges
// only"): the answer then names the scale of each leg that is open, which is what the user has to supply,
// instead of one for the whole.
bool AssumesRigidPlatform(const CalibrateSettings& settings, const PriorKnowledge& known);

// What ties the legs to one another, in a sentence.
std::string AssumptionText(const CalibrateSettings& settings, const PriorKnowledge& known);

// The library's options for the session, its `known` as WithSettings has it; progress is left to the caller.
// Throws as TagGroupsOf does.
SessionCalibrationOptions ToOptions(const CalibrateSettings& settings, const Session& session);

// The options that change the result, as they would be typed: "--hold radii --folds 0"; "none" if all are
// default.
std::string OptionsText(const CalibrateSettings& settings);

}  // namespace legible
