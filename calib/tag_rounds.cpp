#include "calib/tag_rounds.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "calib/robust_weights.h"
#include "core/vision/median.h"

namespace legible {

TagRounds::TagRounds(EstimationProblem& problem) : problem_(problem) {
  for (TagObservation& tag : problem.base_tags) sources_.push_back({&tag, nullptr});
  for (PoseUnit& unit : problem.units)
    for (TagObservation& tag : unit.tags) sources_.push_back({&tag, &unit});
  errors_.resize(sources_.size());
}

size_t TagRounds::SeenGroups() const {
  std::set<size_t> seen;
  for (size_t i = 0; i < errors_.size(); ++i)
    if (errors_[i].weight > 0) seen.insert(sources_[i].tag->group);
  return seen.size();
}

std::optional<size_t> TagRounds::Evaluate() {
  std::optional<size_t> behind;
  for (size_t i = 0; i < sources_.size(); ++i) {
    const TagObservation& tag = *sources_[i].tag;
    const Rigid3 camera_from_platform =
        sources_[i].unit != nullptr ? sources_[i].unit->camera_from_platform : Rigid3();
    const auto r = EvaluateTag(CameraOf(problem_), problem_.tag_placements[tag.group], Vector6d::Zero(),
                               camera_from_platform, Vector6d::Zero(), tag);
    if (r) {
      errors_[i].error = r->residual * tag.sigma_scale;
      errors_[i].error_px = r->error_px;
    } else if (!behind) {
      behind = tag.group;
    }
  }
  return behind;
}

void TagRounds::Start() {
  if (!errors_.empty()) scale_ = MedianTagScale(errors_);
}

double TagRounds::Reweight(bool by_median) {
  if (errors_.empty()) return 0;
  const std::vector<TagErrors> before = errors_;
  WeighTags(errors_, scale_);
  double change = 0;
  for (size_t i = 0; i < before.size(); ++i)
    change += kTagRows * std::abs(errors_[i].weight - before[i].weight);
  scale_ = by_median ? MedianTagScale(errors_) : TagScale(errors_, SeenGroups());
  return change;
}

void TagRounds::SetScales() {
  for (size_t i = 0; i < sources_.size(); ++i)
    sources_[i].tag->sigma_scale = scale_ * SigmaFactor(errors_[i].weight);
}

double TagRounds::Sigma_px() const {
  if (sources_.empty()) return 0;
  std::vector<double> variances;
  variances.reserve(4 * sources_.size());
  for (const Source& source : sources_)
    for (const Eigen::Matrix2d& covariance_px2 : source.tag->covariances_px2)
      variances.push_back(covariance_px2.trace() / 2);
  return scale_ * std::sqrt(MedianOf(std::move(variances)));
}

std::vector<TagGroupFit> TagRounds::Fits(const std::vector<ObservedTagGroup>& groups) const {
  const Rigid3 base_from_camera =
      Inverse(FitBaseFrame(BaseJointsInCamera(problem_.shared), problem_.drawn_base_joints).camera_from_base);
  const std::vector<PlacementResiduals> placements = EvaluatePlacements(problem_);
  std::vector<TagGroupFit> fits;
  fits.reserve(groups.size());
  for (size_t group = 0; group < groups.size(); ++group) {
    const TagPlacement& placement = problem_.tag_placements[group];
    TagGroupFit fit{groups[group].group.name, placement.parent_from_group};
    if (placement.carrier == TagCarrier::kBase)
      fit.carrier_from_group = base_from_camera * placement.parent_from_group;
    fit.placement_sigmas = placements[group].residual.norm() / std::sqrt(6.0);
    double squares = 0, weights = 0;
    for (size_t i = 0; i < errors_.size(); ++i) {
      if (sources_[i].tag->group != group) continue;
      ++fit.tags;
      if (errors_[i].weight == 0) ++fit.tags_left_out;
      squares += errors_[i].weight * errors_[i].error_px.squaredNorm();
      weights += kTagRows * errors_[i].weight;
    }
    if (weights > 0) fit.rms_px = std::sqrt(2 * squares / weights);  // two coordinates a corner
    fits.push_back(fit);
  }
  return fits;
}

}  // namespace legible
