#include "calib/tag_weights.h"

#include <algorithm>
#include <cmath>

#include "calib/robust_weights.h"
#include "core/vision/median.h"

namespace legible {
namespace {

constexpr double kUsualSigma_px = 0.1;  // of a corner of libapriltag's
constexpr double kLeastSigma_px = 0.005;

}  // namespace

double MedianTagSigma(const std::vector<TagErrors>& tags) {
  std::vector<double> sizes;
  sizes.reserve(kTagRows * tags.size());
  for (const TagErrors& tag : tags)
    for (const double error_px : tag.error_px) sizes.push_back(std::abs(error_px));
  if (sizes.empty()) return kUsualSigma_px;
  return std::max(kSigmaOfMedian * MedianOf(std::move(sizes)), kLeastSigma_px);
}

double TagSigma(const std::vector<TagErrors>& tags, size_t groups) {
  double squares = kTagRows * kUsualSigma_px * kUsualSigma_px;
  double freedom = kTagRows - 6.0 * static_cast<double>(groups);
  for (const TagErrors& tag : tags) {
    squares += tag.weight * tag.error_px.squaredNorm();
    freedom += kTagRows * tag.weight;
  }
  return std::max(std::sqrt(squares / std::max(freedom, 2.0)), kLeastSigma_px);
}

void WeighTags(std::vector<TagErrors>& tags, double sigma_px) {
  for (TagErrors& tag : tags)
    tag.weight = RobustWeight(tag.error_px.norm() / std::sqrt(static_cast<double>(kTagRows)) / sigma_px);
}

std::array<Eigen::Vector2d, 4> MedianCorners(const std::vector<std::array<Eigen::Vector2d, 4>>& corners_px) {
  std::array<Eigen::Vector2d, 4> medians;
  for (size_t corner = 0; corner < 4; ++corner)
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      std::vector<double> values;
      values.reserve(corners_px.size());
      for (const auto& seen : corners_px) values.push_back(seen[corner][axis]);
      medians[corner][axis] = MedianOf(std::move(values));
    }
  return medians;
}

}  // namespace legible
