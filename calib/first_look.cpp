#include "calib/first_look.h"

#include <algorithm>
#include <utility>

#include "core/geometry/camera_parameters.h"

namespace legible {
namespace {

constexpr double kDrawingSigma_m = 2e-3;
constexpr double kGuessedFocalShare = 0.03;   // of the focal length
constexpr double kGuessedCentreShare = 0.02;  // of the image width
constexpr double kGuessedDistortion = 0.2;    // each coefficient, but not more than what
constexpr double kGuessedBend = 0.15;         // of its distance from the centre moves the image corner by
constexpr double kUnknownLensBend_px = 12;
constexpr double kTapePose_rad = 0.1, kLargestRange_px = 120;

// Of the coefficients that the lens has.
double SmallestSize(const Camera& camera) {
  const int count = static_cast<int>(camera.lens);
  return count > 0 ? CoefficientSizes(camera).head(count).minCoeff() : 1;
}

}  // namespace

double TapePoseRange_px(const Camera& camera) {
  return std::min(kLargestRange_px, kTapePose_rad * camera.fx_px);
}

LegEdgeOptions FirstLookEdges(const LegEdgeOptions& usual, double range_px) {
  LegEdgeOptions rough = usual;
  rough.lock = LegLockOptions();
  rough.lock->range_px = range_px;
  rough.rough_only = true;
  rough.rough_bend_px = kUnknownLensBend_px;
  rough.search_px = kUnknownLensBend_px;
  return rough;
}

LegCalibration FirstLook(LegCalibrationInput input, const HeldParameters& hold, int threads) {
  PriorKnowledge& known = input.known;
  known.base_joint_m = kDrawingSigma_m;
  known.platform_joint_m = kDrawingSigma_m;
  known.joint_offset_m = kDrawingSigma_m;
  known.joint_reading_m = kDrawingSigma_m / 10;
  const double guessed = std::min(kGuessedDistortion, kGuessedBend * SmallestSize(input.camera));
  known.distortion = std::min(known.distortion.value_or(guessed), guessed);
  known.focal_length_px = kGuessedFocalShare * input.camera.fx_px;
  known.principal_point_px = kGuessedCentreShare * input.camera.width_px;
  if (!known.radius_m) known.radius_m = 0.1 * input.drawing.legs[0].radius_m;
  LegCalibrationOptions rough;
  rough.threads = threads;
  rough.hold = hold;
  return CalibrateLegs(input, rough);
}

}  // namespace legible
