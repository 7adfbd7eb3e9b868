// From a session's images to a calibrated model: finds the edges, identifies, checks on images held out.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "calib/held_values.h"
#include "calib/leg_calibration.h"
#include "core/session/session.h"
#include "core/vision/leg_edges.h"
#include "core/vision/tags.h"

namespace legible {

// What was said or held beforehand is contradicted by the images where it is more sigmas off than this.
inline constexpr double kContradicting_sigma = 4;

struct SessionCalibrationOptions {
  LegCalibrationOptions estimation;
  LegEdgeOptions edges;
  std::optional<LensModel> lens;           // instead of the session camera's
  std::optional<BoardProblem> board = {};  // as LegCalibrationInput has it
  std::set<std::string> tag_groups;        // that count as observations; the others check the model only
  int scouts = 12;                         // images that the camera's first pose is refined on
  int folds = 5;                           // of the cross-validation; 0: none
  std::optional<std::uint64_t> seed;       // of which images are held out together; none: every folds-th
  int threads = 2;
  // stage: "reading", "finding tags", "looking for the legs", "finding edges", "solving", "checking"; done of
  // total. Called from several threads, at times at once.
  std::function<void(const std::string& stage, int done, int total)> progress;

  void Check() const;  // throws std::invalid_argument
};

// What became of one image of the session.
struct ImageOutcome {
  std::string name;
  std::string left_out;  // why the image was not used; empty: used
  LegEdges edges;
  std::vector<TagDetection> tags;
  double rms_px = 0;                      // of the used samples, in the final estimate
  std::optional<double> held_out_rms_px;  // of the samples, predicted by a model that has not seen the image
};

// Whether any of the images shows a tag of the group.
bool IsSeen(const TagGroup& group, const std::vector<ImageOutcome>& images);

// Tags on the base or platform, predicted by the calibrated model, against where they were seen.
struct TagCheck {
  std::string group;
  bool took_part = false;    // as an observation: no independent check
  bool by_readings = false;  // the platform's poses came from the joint readings alone, not from the fit
  bool held_out = false;     // in images that neither the model nor the group's place has seen
  int images = 0;
  double rms_px = 0;  // corners, after the group's own place on its carrier was fitted
  double rms_m = 0;   // the same, across the line of sight at the tags' distance
};

struct StageTimes {
  double read_s = 0, detect_s = 0, solve_s = 0, covariance_s = 0, held_out_s = 0, total_s = 0;
};

struct SessionCalibration {
  LegCalibration calibration;
  Camera guessed_camera;  // the session's, through the lens that is estimated: what is held or known refers
                          // to it
  std::vector<ImageOutcome> images;
  std::vector<size_t>
      estimated;  // positions in `images` of those that the estimation was given, in its order
  // Edges of images held out in turn, predicted from their joint readings alone (or, without readings, after
  // their pose was fitted): root mean square over all of them.
  std::optional<double> held_out_rms_px;
  int held_out_folds = 0;                        // turns, of which some image was held out in each
  int held_out_folds_failed = 0;                 // in which the other images alone did not lead to a model
  std::vector<HeldDifference> held_differences;  // of more than kContradicting_sigma
  std::vector<TagCheck> tag_checks;
  std::string first_pose_from;           // "tags base_board" or "camera.yaml"
  std::vector<std::string> misfit_tags;  // groups on the base that were not used to place the camera, and why
  std::string first_look;                // why the camera's first pose could not be refined; empty: it was
  StageTimes times;
};

// Over all images: edges of which enough is in sight as predicted, and those that were measured.
struct EdgeCounts {
  int in_sight = 0, used = 0;
};
EdgeCounts CountEdges(const SessionCalibration& result);

// Runs the whole chain. Throws std::invalid_argument for a session that does not say where the camera is (no
// camera_from_base and no tags on the base that are seen); an image that cannot be read, or whose joint
// readings lead to no pose of the platform, is left out with its reason. A model that the edges contradict
// grossly counts as not converged, whatever the estimation says. The readings say where to look for
// the legs even where the estimation leaves them out.
SessionCalibration CalibrateSession(const Session& session, const SessionCalibrationOptions& options);

}  // namespace legible
