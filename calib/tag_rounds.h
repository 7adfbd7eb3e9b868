// The tags of a problem through the rounds of solving and re-weighting.
#pragma once

#include <optional>
#include <vector>

#include "calib/estimation_problem.h"
#include "calib/leg_calibration.h"
#include "calib/tag_weights.h"

namespace legible {

// Holds on to the problem's units and tags, whose number and places must stay.
class TagRounds {
 public:
  explicit TagRounds(EstimationProblem& problem);

  int rows() const { return kTagRows * static_cast<int>(errors_.size()); }
  double scale() const { return scale_; }  // by which the corners' own sigmas fall short; 0 without tags
  double Sigma_px() const;                 // of a coordinate of a corner in the median; 0 without tags
  size_t SeenGroups() const;               // groups with a tag that has weight

  // Finds the residuals where the problem stands. Returns the group of a tag that lies behind the camera
  // there, if any.
  std::optional<size_t> Evaluate();
  // From the residuals: the first scale, by their median, all weights still 1.
  void Start();
  // From the residuals: the weights, then the scale. Returns by how much the weights changed, in all rows.
  double Reweight(bool by_median);
  // Gives each tag of the problem the scale of sigma that its weight leaves it.
  void SetScales();

  // What became of each group.
  std::vector<TagGroupFit> Fits(const std::vector<ObservedTagGroup>& groups) const;

 private:
  struct Source {
    TagObservation* tag;
    const PoseUnit* unit;  // that carries it; none on the base
  };

  EstimationProblem& problem_;
  std::vector<Source> sources_;
  std::vector<TagErrors> errors_;  // of the same tags
  double scale_ = 0;
};

}  // namespace legible
