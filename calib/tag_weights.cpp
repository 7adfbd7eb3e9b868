#include "calib/tag_weights.h"

#include <algorithm>
#include <cmath>

#include "calib/robust_weights.h"
#include "core/vision/median.h"

namespace legible {
namespace {

constexpr double kUsualScale = 1;
constexpr double kLeastScale = 0.05;

std::vector<double> Coordinates(const std::vector<TagDetection>& seen, size_t corner, Eigen::Index axis) {
  std::vector<double> values(seen.size());
  std::transform(seen.begin(), seen.end(), values.begin(),
                 [&](const TagDetection& tag) { return tag.corners_px[corner][axis]; });
  return values;
}

Eigen::Matrix2d MedianCovariance(const std::vector<TagDetection>& seen, size_t corner) {
  std::vector<Eigen::Matrix2d> covariances(seen.size());
  std::transform(seen.begin(), seen.end(), covariances.begin(),
                 [&](const TagDetection& tag) { return tag.covariances_px2[corner]; });
  const auto middle = covariances.begin() + static_cast<std::ptrdiff_t>(covariances.size() / 2);
  std::nth_element(covariances.begin(), middle, covariances.end(),
                   [](const Eigen::Matrix2d& a, const Eigen::Matrix2d& b) { return a.trace() < b.trace(); });
  return *middle;
}

}  // namespace

double MedianTagScale(const std::vector<TagErrors>& tags) {
  std::vector<double> sizes;
  sizes.reserve(kTagRows * tags.size());
  for (const TagErrors& tag : tags)
    for (const double error : tag.error) sizes.push_back(std::abs(error));
  if (sizes.empty()) return kUsualScale;
  return std::max(kSigmaOfMedian * MedianOf(std::move(sizes)), kLeastScale);
}

double TagScale(const std::vector<TagErrors>& tags, size_t groups) {
  double squares = kTagRows * kUsualScale * kUsualScale;
  double freedom = kTagRows - 6.0 * static_cast<double>(groups);
  for (const TagErrors& tag : tags) {
    squares += tag.weight * tag.error.squaredNorm();
    freedom += kTagRows * tag.weight;
  }
  return std::max(std::sqrt(squares / std::max(freedom, 2.0)), kLeastScale);
}

void WeighTags(std::vector<TagErrors>& tags, double scale) {
  for (TagErrors& tag : tags)
    tag.weight = RobustWeight(tag.error.norm() / std::sqrt(static_cast<double>(kTagRows)) / scale);
}

TagCorners MedianCorners(const std::vector<TagDetection>& seen) {
  TagCorners medians;
  for (size_t corner = 0; corner < 4; ++corner) {
    for (Eigen::Index axis = 0; axis < 2; ++axis)
      medians.corners_px[corner][axis] = MedianOf(Coordinates(seen, corner, axis));
    medians.covariances_px2[corner] = MedianCovariance(seen, corner);
  }
  return medians;
}

}  // namespace legible
