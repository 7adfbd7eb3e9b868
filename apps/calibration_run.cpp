#include "apps/calibration_run.h"

#include <fmt/format.h>

#include <algorithm>

namespace legible {
std::string SessionPath(const CalibrationRun& run) {
  return std::filesystem::absolute(run.settings.session).lexically_normal().string();
}

int CountUsedImages(const SessionCalibration& result) {
  return static_cast<int>(std::count_if(result.images.begin(), result.images.end(),
                                        [](const ImageOutcome& image) { return image.left_out.empty(); }));
}

std::vector<std::vector<const EdgeResidualSet*>> ResidualsByImage(const SessionCalibration& result) {
  std::vector<std::vector<const EdgeResidualSet*>> residuals(result.images.size());
  for (const EdgeResidualSet& edge : result.calibration.edges)
    residuals[result.estimated.at(static_cast<size_t>(edge.image))].push_back(&edge);
  return residuals;
}

std::vector<std::optional<Rigid3>> PlatformByImage(const CalibrationRun& run) {
  const std::vector<Rigid3>& found = run.result.calibration.camera_from_platform;
  std::vector<std::optional<Rigid3>> poses(run.result.images.size());
  if (!run.options.estimation.rigid_platform || found.empty()) return poses;
  const std::vector<size_t>& images = run.result.estimated;
  for (size_t k = 0; k < images.size(); ++k)
    if (run.result.images[images[k]].left_out.empty()) poses[images[k]] = found.at(k);
  return poses;
}

std::vector<std::string> OutlyingReadingSentences(const CalibrationRun& run) {
  std::vector<std::string> sentences;
  for (const OutlyingReading& reading : run.result.calibration.outlying_readings)
    sentences.push_back(fmt::format(
        "{}: the joint readings did not count: that of leg {} is {:.3f} mm {} than the image's edges have it",
        run.result.images[run.result.estimated[static_cast<size_t>(reading.image)]].name, reading.leg + 1,
        1e3 * std::abs(reading.off_m), reading.off_m > 0 ? "longer" : "shorter"));
  return sentences;
}

std::string TagSentence(const Session& session, const TagCheck& check) {
  bool on_platform = false;
  for (const TagGroup& group : session.tags->groups)
    if (group.name == check.group) on_platform = group.carrier == TagCarrier::kPlatform;
  const std::string predicted =
      check.by_readings ? "the joint readings alone and the model put them" : "the model puts them";
  return fmt::format(
      "tags {} on the {}, seen in {} images{}, lie within {:.3f} mm ({:.3f} px) rms of where {}, their own "
      "place on it fitted{}{}",
      check.group, on_platform ? "platform" : "base", check.images, check.held_out ? " held out" : "",
      1e3 * check.rms_m, check.rms_px, predicted, check.held_out ? " to the others" : "",
      check.took_part ? " (they took part in the estimate)"
      : !on_platform  ? " (they and the camera stand still: that tells how well they are found)"
                      : "");
}

std::string TagFitSentence(const LegCalibration& calibration, const TagGroupFit& fit) {
  return fmt::format(
      "tags {} as observations: {} seen{}, corners {:.3f} px rms from where the model has them (all tags "
      "show a σ of {:.3f} px in x and in y); placed {:.1f} σ from where tags.yaml has them",
      fit.group, fit.tags,
      fit.tags_left_out > 0 ? fmt::format(" ({} misread, left out)", fit.tags_left_out) : "", fit.rms_px,
      calibration.tag_sigma_px, fit.placement_sigmas);
}

}  // namespace legible
