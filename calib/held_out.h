// Errors on what the estimate has not seen: images left out in turn, and tags.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "calib/leg_calibration.h"
#include "core/vision/tags.h"

namespace legible {

// Tags that check the calibration: a group, and its corners in each image of the input (empty: not seen).
struct CheckedGroup {
  TagGroup group;
  std::vector<GroupSighting> sightings;
};

// How far corners of a group are from where the model puts them.
struct GroupCheck {
  int images = 0;
  double rms_px = 0;  // of the corners' distances
  double rms_m = 0;   // across the line of sight, at each corner's depth
};

struct HeldOut {
  std::optional<double> rms_px;                     // over all samples of all images that have a figure
  std::vector<std::optional<double>> image_rms_px;  // by image of the input
  int folds = 0;                                    // turns, of which some image was held out in each
  int folds_failed = 0;                             // in which the rest did not converge
  // Of each checked group, in images held out: the group's place on its carrier was fitted to the others, and
  // the platform's pose comes from the joint readings alone. None where it was seen too rarely, or is on the
  // platform and readings take no part.
  std::vector<std::optional<GroupCheck>> groups;
};

// Which images are left out together: every folds-th, or, with a seed, as many at random. folds > 0.
std::vector<int> FoldsOf(size_t images, int folds, std::optional<std::uint64_t> seed);

// Leaves the images of one fold after the other out, calibrates on the rest from `solution`, predicts the
// edges of those left out and compares, all samples alike: there is no weight that takes an outlier out. The
// platform's pose in them comes from the joint readings alone; where the estimation uses none it, or the
// direction of each leg that is free, is fitted to the image's edges, all else held. An image has no figure
// where a joint reading of it did not count in the solution, where its readings lead to no pose, and where
// the rest did not converge.
HeldOut CrossValidate(const LegCalibrationInput& input, const LegCalibration& solution,
                      const LegCalibrationOptions& options, const std::vector<int>& fold_of_image,
                      const std::vector<CheckedGroup>& groups = {});

// How far a group's corners are from where the model puts them. The group's place on its carrier is known
// roughly at best: the one that suits all images together is found first (camera_from_carrier: of each image,
// as the model predicts it). Nothing unless the group was seen in two images, and where the
// model puts a corner behind the camera.
std::optional<GroupCheck> CheckGroup(const TagGroup& group, const Camera& camera,
                                     const std::vector<GroupSighting>& sightings,
                                     const std::vector<Rigid3>& camera_from_carrier);

}  // namespace legible
