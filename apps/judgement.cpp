#include "apps/judgement.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "apps/intrinsics_judgement.h"
#include "apps/prior_pulls.h"
#include "apps/wording.h"
#include "core/vision/median.h"

namespace legible {
namespace {

constexpr int kFewImages = 10;         // below, a pose or two decide; forty are a good number
constexpr double kHeldOutRatio = 1.5;  // of the error in images held out to that of the fit
constexpr double kMisfit = 1.4;        // where what is held is right, edges of all kinds stay below 1
constexpr double kPoorlyKnown = 0.05;  // of its size
// Their scatter about what the images predict is 0.8 to 0.95 where sigmas are right.
constexpr double kReadingsWorse = 1.2, kReadingsBetter = 0.4;
constexpr double kTagMisfit_px = 1;   // detectors are ten times better
constexpr double kOutlyingImage = 5;  // times the median of all
constexpr size_t kNamesShown = 6;

constexpr int kTooFewImages = 4;  // whatever is open, more of them come first
constexpr char kLegsNotFound[] =
    "the legs were not found where the session puts them. Usual causes: camera_from_base or camera_matrix in "
    "camera.yaml far off (tags on the base help), legs in another order in joints.csv than in robot.yaml, "
    "radii or rows of joints.csv that are wrong, lengths not in metres, little contrast between legs and "
    "background";

using Sentences = std::vector<std::string>;

// "a, b, c and 4 more"
std::string Few(const std::vector<std::string>& names) {
  const size_t shown = std::min(names.size(), kNamesShown);
  std::string text =
      fmt::format("{}", fmt::join(names.begin(), names.begin() + static_cast<long>(shown), ", "));
  if (names.size() > shown) text += fmt::format(" and {} more", names.size() - shown);
  return text;
}

std::string ByHowMuch(const std::string& name, double sigmas) {
  return fmt::format("{} by {:.1f} σ", name, std::abs(sigmas));
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
    sentences.push_back(
        fmt::format("{} of the session's folder without a row in joints.csv took no part ({})",
                    Plural(static_cast<int>(unlisted.size()), "image"), Few(unlisted)));
}

bool SeesATag(const CalibrationRun& run) {
  const std::vector<TagGroup>& groups = run.session.tags->groups;
  return std::any_of(groups.begin(), groups.end(),
                     [&](const TagGroup& group) { return IsSeen(group, run.result.images); });
}

void AddStart(const CalibrationRun& run, Sentences& sentences) {
  sentences.insert(sentences.end(), run.session.warnings.begin(), run.session.warnings.end());
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
  const LegCalibration& calibration = run.result.calibration;
  for (const std::string& sentence : OutlyingReadingSentences(run))
    sentences.push_back(fmt::format("joints.csv: {}", sentence));
  if (!run.options.estimation.use_joint_readings || CountUsedImages(run.result) < kFewImages) return;
  if (calibration.reading_scatter > kReadingsWorse && run.result.held_differences.empty())
    sentences.push_back(
        fmt::format("the joint readings disagree with the images {:.1f} times as much as joint_reading_m "
                    "allows: give a larger σ, or look for play in the joints and legs that bend",
                    calibration.reading_scatter));
  if (calibration.reading_scatter < kReadingsBetter)
    sentences.push_back(
        fmt::format("the joint readings agree with the images to {:.2g} of what joint_reading_m allows: give "
                    "a smaller σ, and they will tell more",
                    calibration.reading_scatter));
}

void AddExtent(const CalibrationRun& run, Sentences& sentences) {
  if (const int images = CountUsedImages(run.result); images < kFewImages)
    sentences.push_back(
        fmt::format("only {} {} used: the model may be worse than the drawing in other poses; forty in "
                    "clearly different ones are a good number",
                    Plural(images, "image"), images == 1 ? "was" : "were"));
  if (const EdgeCounts edges = CountEdges(run.result); 2 * edges.used < edges.in_sight)
    sentences.push_back(
        fmt::format("only {} of {} edges in sight could be used: the report shows which, and why not",
                    edges.used, edges.in_sight));
}

void AddMisfit(const CalibrationRun& run, Sentences& sentences) {
  const LegCalibration& calibration = run.result.calibration;
  if (const double misfit = calibration.Misfit(); misfit > kMisfit)
    sentences.push_back(
        fmt::format("the edges lie {:.1f} times as far from the model as their own scatter allows: something "
                    "held or known beforehand is wrong, the lens model too poor, or legs bend",
                    misfit));
}

// Of images that the rest of the session, and their joint readings, predict far worse than the others. True
// if any.
bool AddOutlyingImages(const CalibrationRun& run, Sentences& sentences) {
  std::vector<double> errors_px;
  for (const ImageOutcome& image : run.result.images)
    if (image.held_out_rms_px) errors_px.push_back(*image.held_out_rms_px);
  if (errors_px.empty()) return false;
  const double usual_px = MedianOf(errors_px);
  const size_t before = sentences.size();
  for (const ImageOutcome& image : run.result.images)
    if (image.held_out_rms_px && *image.held_out_rms_px > kOutlyingImage * usual_px)
      sentences.push_back(
          fmt::format("{}: held out, its edges are predicted {:.2f} px off, the other images' {:.2f} px: its "
                      "joint readings may be wrong, or the robot moved",
                      image.name, *image.held_out_rms_px, usual_px));
  return sentences.size() > before;
}

void AddHeldOut(const CalibrationRun& run, Sentences& sentences) {
  const SessionCalibration& result = run.result;
  if (CountUsedImages(result) < kFewImages) return;  // which says the same
  const bool has_outlying = AddOutlyingImages(run, sentences);
  const double ratio = result.held_out_rms_px.value_or(0) / result.calibration.rms_px;
  if (ratio > kHeldOutRatio && !has_outlying)
    sentences.push_back(fmt::format(
        "the error in images held out is {:.1f} times that of the fit: images too few or too much alike, "
        "joint readings worse than said, or something held or known beforehand that is wrong",
        ratio));
  if (result.held_out_folds_failed > 0)
    sentences.push_back(
        fmt::format("in {} of {} turns the other images alone did not lead to a model: the figure for images "
                    "held out is without those of these turns",
                    result.held_out_folds_failed, result.held_out_folds));
}

void AddTags(const CalibrationRun& run, Sentences& sentences) {
  for (const TagCheck& check : run.result.tag_checks)
    if (check.rms_px > kTagMisfit_px)
      sentences.push_back(
          fmt::format("the tags {} lie {:.1f} px ({:.2f} mm) from where the model has them: check their "
                      "corners in tags.yaml, and the model",
                      check.group, check.rms_px, 1e3 * check.rms_m));
  for (const TagGroupFit& fit : run.result.calibration.tags)
    if (fit.placement_sigmas > kContradicting_sigma)
      sentences.push_back(
          fmt::format("the tags {} are {:.1f} σ from where tags.yaml places them: check that place and its σ",
                      fit.group, fit.placement_sigmas));
}

void AddPoorlyKnown(const CalibrationRun& run, Sentences& sentences) {
  for (const WeakDirection& weak : run.result.calibration.observability.weak)
    if (weak.relative_sigma > kPoorlyKnown)
      sentences.push_back(
          fmt::format("known only to {:.0f} % of its size: {}", 100 * weak.relative_sigma, weak.description));
}

void AddContradictions(const CalibrationRun& run, const FoundParameters& found, Sentences& sentences) {
  std::vector<PriorPull> pulls = PriorPulls(run, found);
  std::erase_if(pulls, [](const PriorPull& one) { return std::abs(one.pull) <= kContradicting_sigma; });
  std::sort(pulls.begin(), pulls.end(),
            [](const PriorPull& a, const PriorPull& b) { return std::abs(a.pull) > std::abs(b.pull); });
  std::vector<std::string> said, held;
  for (const PriorPull& one : pulls) said.push_back(ByHowMuch(one.name, one.pull));
  for (const HeldDifference& one : run.result.held_differences)
    held.push_back(ByHowMuch(one.parameter, one.sigmas));
  if (!said.empty())
    sentences.push_back(fmt::format(
        "the images contradict what was said beforehand: {}: check these values and their σ", Few(said)));
  if (!held.empty())
    sentences.push_back(fmt::format(
        "the images contradict what is held: {}: let it be estimated, or give a value that is right",
        Few(held)));
}

// Next to no edge near its prediction, although there was enough to look at.
bool WereLegsNotFound(const CalibrationRun& run) {
  constexpr int kHardlyAny = 4;  // one of so many
  const EdgeCounts edges = CountEdges(run.result);
  return edges.in_sight >= kTooFewImages * kLegCount && kHardlyAny * edges.used < edges.in_sight;
}

}  // namespace

std::vector<std::string> Warnings(const CalibrationRun& run, const FoundParameters& found) {
  Sentences sentences;
  AddImagesLeftOut(run, sentences);
  AddStart(run, sentences);
  if (run.result.calibration.status != CalibrationStatus::kConverged) return sentences;
  AddReadings(run, sentences);
  AddExtent(run, sentences);
  AddContradictions(run, found, sentences);
  AddMisfit(run, sentences);
  AddHeldOut(run, sentences);
  AddTags(run, sentences);
  if (run.board)
    for (const std::string& sentence : Warnings(*run.board)) sentences.push_back("the board: " + sentence);
  AddPoorlyKnown(run, sentences);
  return sentences;
}

std::string WhyThereIsNoModel(const CalibrationRun& run) {
  const LegCalibration& calibration = run.result.calibration;
  if (calibration.status == CalibrationStatus::kConverged) return "";
  const int used = CountUsedImages(run.result);
  if (WereLegsNotFound(run)) return kLegsNotFound;
  if (used < kTooFewImages)
    return fmt::format(
        "{} could be used, too few to determine the parameters; give some forty in clearly different poses",
        used == 0 ? "no image" : "only " + Plural(used, "image"));
  if (calibration.status == CalibrationStatus::kUnobservable) return kParametersOpen;
  return calibration.message;
}

}  // namespace legible
