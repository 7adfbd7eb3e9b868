#include "apps/judgement.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "apps/prior_pulls.h"

namespace legible {
namespace {

constexpr int kFewImages = 10;          // below, a pose or two decide; forty are a good number
constexpr double kHeldOutRatio = 1.5;   // of the error in images held out to that of the fit
constexpr double kMostEdges = 0.5;      // share that must have been measured
constexpr double kMisfit = 1.4;         // where what is held is right, edges of all kinds stay below 1
constexpr double kPoorlyKnown = 0.05;   // of its size
constexpr double kReadingMisfit = 1.5;  // of their sigma
constexpr size_t kNamesShown = 6;

using Sentences = std::vector<std::string>;

// "a, b, c and 4 more"
std::string Few(const std::vector<std::string>& names) {
  const size_t shown = std::min(names.size(), kNamesShown);
  std::string text =
      fmt::format("{}", fmt::join(names.begin(), names.begin() + static_cast<long>(shown), ", "));
  if (names.size() > shown) text += fmt::format(" and {} more", names.size() - shown);
  return text;
}

// Images with the same reason together.
void AddImagesLeftOut(const CalibrationRun& run, Sentences& sentences) {
  std::map<std::string, std::vector<std::string>> by_reason;
  for (const ImageOutcome& image : run.result.images)
    if (!image.left_out.empty()) by_reason[image.left_out].push_back(image.name);
  for (const auto& [reason, names] : by_reason)
    sentences.push_back(names.size() == 1 ? fmt::format("{}: left out: {}", names.front(), reason)
                                          : fmt::format("{} of {} images left out: {} ({})", names.size(),
                                                        run.result.images.size(), reason, Few(names)));
  if (const auto& unlisted = run.session.unlisted_images; !unlisted.empty())
    sentences.push_back(fmt::format(
        "{} of the session's folder without a row in joints.csv took no part ({})",
        unlisted.size() == 1 ? "1 image" : fmt::format("{} images", unlisted.size()), Few(unlisted)));
}

bool SeesATag(const CalibrationRun& run) {
  for (const TagGroup& group : run.session.tags->groups)
    for (const ImageOutcome& image : run.result.images)
      if (!Match(group, image.tags).corners_px.empty()) return true;
  return false;
}

void AddStart(const CalibrationRun& run, Sentences& sentences) {
  if (run.session.tags && !SeesATag(run))
    sentences.push_back(fmt::format("no image shows a tag of tags.yaml: check its family ({}) and ids",
                                    run.session.tags->family));
  for (const std::string& sentence : run.result.misfit_tags) sentences.push_back(sentence);
  if (!run.result.first_look.empty())
    sentences.push_back(
        fmt::format("a first look at the legs did not refine where the camera is ({}): the edges were "
                    "searched from {} as it stands",
                    run.result.first_look, run.result.first_pose_from));
}

void AddReadings(const CalibrationRun& run, Sentences& sentences) {
  for (const std::string& sentence : OutlyingReadingSentences(run))
    sentences.push_back(fmt::format("joints.csv: {}", sentence));
  if (const double rms = run.result.calibration.reading_rms; rms > kReadingMisfit)
    sentences.push_back(
        fmt::format("the joint readings miss the model's leg lengths by {:.1f} of their σ: the readings are "
                    "worse than said, or legs bend",
                    rms));
}

void AddExtent(const CalibrationRun& run, Sentences& sentences) {
  if (const int images = CountUsedImages(run.result); images < kFewImages)
    sentences.push_back(
        fmt::format("only {} image{} used: too few to see from the residuals alone that the model holds in "
                    "other poses; forty in clearly different poses are a good number",
                    images, images == 1 ? " was" : "s were"));
  size_t edges = 0;
  for (const ImageOutcome& image : run.result.images) edges += image.edges.edges.size();
  if (const int used = CountUsedEdges(run.result); used < kMostEdges * static_cast<double>(edges))
    sentences.push_back(
        fmt::format("only {} of {} edges could be used: the pictures of the report show which, and why not",
                    used, edges));
}

void AddMisfit(const CalibrationRun& run, Sentences& sentences) {
  const LegCalibration& calibration = run.result.calibration;
  if (const double misfit = calibration.Misfit(); misfit > kMisfit)
    sentences.push_back(
        fmt::format("the edges lie {:.1f} times as far from the model as their own scatter allows: something "
                    "held or known beforehand is wrong, the lens model too poor, or legs bend",
                    misfit));
  if (!calibration.weights_steady)
    sentences.emplace_back(
        "the weights of outlying edge points had not come to rest when the rounds were used up");
}

void AddHeldOut(const CalibrationRun& run, Sentences& sentences) {
  const SessionCalibration& result = run.result;
  const double ratio = result.held_out_rms_px.value_or(0) / result.calibration.rms_px;
  if (ratio > kHeldOutRatio)
    sentences.push_back(
        fmt::format("the error in images held out is {:.1f} times that of the fit: more images, or more "
                    "varied poses, would make the model more reliable in new ones",
                    ratio));
  if (result.held_out_folds_failed > 0)
    sentences.push_back(
        fmt::format("in {} of {} turns the other images alone did not lead to a model: the figure for images "
                    "held out is without those of these turns",
                    result.held_out_folds_failed, run.options.folds));
}

void AddPoorlyKnown(const CalibrationRun& run, Sentences& sentences) {
  for (const WeakDirection& weak : run.result.calibration.observability.weak)
    if (weak.relative_sigma > kPoorlyKnown)
      sentences.push_back(
          fmt::format("known only to {:.0f} % of its size: {}", 100 * weak.relative_sigma, weak.description));
}

void AddContradictions(const CalibrationRun& run, const FoundParameters& found, Sentences& sentences) {
  std::vector<PriorPull> pulls = PriorPulls(run, found);
  std::erase_if(pulls, [](const PriorPull& one) { return std::abs(one.pull) <= kContradictingPull; });
  std::sort(pulls.begin(), pulls.end(),
            [](const PriorPull& a, const PriorPull& b) { return std::abs(a.pull) > std::abs(b.pull); });
  std::vector<std::string> names;
  for (const PriorPull& one : pulls)
    names.push_back(fmt::format("{} by {:.1f} σ", one.name, std::abs(one.pull)));
  if (!names.empty())
    sentences.push_back(fmt::format(
        "the images contradict what was said beforehand: {}: check these values and their σ", Few(names)));
}

}  // namespace

std::vector<std::string> Warnings(const CalibrationRun& run, const FoundParameters& found) {
  Sentences sentences;
  AddImagesLeftOut(run, sentences);
  AddStart(run, sentences);
  AddReadings(run, sentences);
  if (run.result.calibration.status != CalibrationStatus::kConverged) return sentences;
  AddExtent(run, sentences);
  AddMisfit(run, sentences);
  AddHeldOut(run, sentences);
  AddPoorlyKnown(run, sentences);
  AddContradictions(run, found, sentences);
  return sentences;
}

}  // namespace legible
