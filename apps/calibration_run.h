// All there is to say about one calibration: what went in, what came out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/calibrate_settings.h"
#include "apps/intrinsics_run.h"
#include "calib/session_calibration.h"
#include "core/session/session.h"

namespace legible {

struct CalibrationRun {
  CalibrateSettings settings;
  Session session;  // its `known` as the settings left it
  SessionCalibrationOptions options;
  std::string content_hash;
  std::optional<IntrinsicsRun> board;  // where board images are solved together with the legs
  SessionCalibration result;           // `times` of the whole command up to the writing of files
  double report_s = 0;                 // time that the report took
};

// The session's folder as an absolute path, for those who read the results elsewhere.
std::string SessionPath(const CalibrationRun& run);

int CountUsedImages(const SessionCalibration& result);

// The residuals of each image's edges, by image of the result; an image that took no part has none.
std::vector<std::vector<const EdgeResidualSet*>> ResidualsByImage(const SessionCalibration& result);

// The platform's pose in the camera of each image of the result, as fitted to its edges; nothing for images
// that took no part, and where no rigid platform was assumed.
std::vector<std::optional<Rigid3>> PlatformByImage(const CalibrationRun& run);

// Each image whose joint readings did not count, in a sentence without full stop.
std::vector<std::string> OutlyingReadingSentences(const CalibrationRun& run);

// What a check by tags says, in a clause.
std::string TagSentence(const Session& session, const TagCheck& check);

// What became of tags that counted as observations, in a clause.
std::string TagFitSentence(const LegCalibration& calibration, const TagGroupFit& fit);

}  // namespace legible
