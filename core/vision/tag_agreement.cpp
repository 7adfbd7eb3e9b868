#include "core/vision/tag_agreement.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <numeric>

namespace legible {
namespace {

constexpr size_t kNeighbours = 8;
constexpr double kTolerance = 0.25;  // of the distance between two tags

Eigen::Vector2d MiddleOf(const Tag& tag) {
  return (tag.corners_m[0] + tag.corners_m[1] + tag.corners_m[2] + tag.corners_m[3]).head<2>() / 4;
}
Eigen::Vector2d MiddleOf(const ReadTag& read) {
  return (read.corners_px[0] + read.corners_px[1] + read.corners_px[2] + read.corners_px[3]) / 4;
}

// Whether a's plane predicts b's corners.
bool Predicts(const std::vector<Tag>& tags, const ReadTag& a, const ReadTag& b) {
  const TagPlane plane(tags[a.tag].corners_m, a.corners_px);
  const double tolerance_px = kTolerance * (MiddleOf(a) - MiddleOf(b)).norm();
  for (size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d predicted = plane * tags[b.tag].corners_m[i].head<2>();
    if (!((predicted - b.corners_px[i]).norm() < tolerance_px)) return false;
  }
  return true;
}

// The read tags that are nearest to one on the board.
std::vector<size_t> NeighboursOf(size_t one, const std::vector<Tag>& tags, const std::vector<ReadTag>& read) {
  std::vector<std::pair<double, size_t>> by_distance;
  for (size_t i = 0; i < read.size(); ++i)
    if (i != one)
      by_distance.emplace_back((MiddleOf(tags[read[i].tag]) - MiddleOf(tags[read[one].tag])).norm(), i);
  const size_t count = std::min(kNeighbours, by_distance.size());
  std::partial_sort(by_distance.begin(), by_distance.begin() + static_cast<std::ptrdiff_t>(count),
                    by_distance.end());
  std::vector<size_t> neighbours;
  for (size_t i = 0; i < count; ++i) neighbours.push_back(by_distance[i].second);
  return neighbours;
}

// Sets that grow together.
class Sets {
 public:
  explicit Sets(size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), size_t{0}); }
  size_t RootOf(size_t i) const {
    while (parent_[i] != i) i = parent_[i];
    return i;
  }
  void Join(size_t a, size_t b) { parent_[RootOf(a)] = RootOf(b); }

 private:
  std::vector<size_t> parent_;
};

}  // namespace

TagPlane::TagPlane(const std::array<Eigen::Vector3d, 4>& corners_m,
                   const std::array<Eigen::Vector2d, 4>& corners_px) {
  Eigen::Matrix<double, 8, 8> equations;
  Eigen::Matrix<double, 8, 1> right;
  // In units of the tag about its first corner, for the equations' sake.
  const Eigen::Vector2d origin = corners_m[0].head<2>();
  const double size_m = (corners_m[2].head<2>() - origin).norm();
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector2d x = (corners_m[static_cast<size_t>(i)].head<2>() - origin) / size_m;
    const Eigen::Vector2d& p = corners_px[static_cast<size_t>(i)];
    equations.row(2 * i) << x.x(), x.y(), 1, 0, 0, 0, -p.x() * x.x(), -p.x() * x.y();
    equations.row(2 * i + 1) << 0, 0, 0, x.x(), x.y(), 1, -p.y() * x.x(), -p.y() * x.y();
    right.segment<2>(2 * i) = p;
  }
  const Eigen::Matrix<double, 8, 1> h = equations.partialPivLu().solve(right);
  Eigen::Matrix3d from_tag, tag_from_board;
  from_tag << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], 1;
  tag_from_board << 1 / size_m, 0, -origin.x() / size_m, 0, 1 / size_m, -origin.y() / size_m, 0, 0, 1;
  image_from_board_ = from_tag * tag_from_board;
}

Eigen::Vector2d TagPlane::operator*(const Eigen::Vector2d& place_m) const {
  const Eigen::Vector3d p = image_from_board_ * place_m.homogeneous();
  if (!(p.z() > 0)) return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  return p.hnormalized();
}

std::vector<size_t> AgreeingTags(const std::vector<Tag>& tags, const std::vector<ReadTag>& read) {
  Sets sets(read.size());
  for (size_t i = 0; i < read.size(); ++i)
    for (const size_t j : NeighboursOf(i, tags, read))
      if (sets.RootOf(i) != sets.RootOf(j) && Predicts(tags, read[i], read[j]) &&
          Predicts(tags, read[j], read[i]))
        sets.Join(i, j);
  std::vector<size_t> largest;
  for (size_t root = 0; root < read.size(); ++root) {
    std::vector<size_t> members;
    for (size_t i = 0; i < read.size(); ++i)
      if (sets.RootOf(i) == root) members.push_back(i);
    if (members.size() > largest.size()) largest = members;
  }
  if (largest.size() == 1 && read.size() > 1) return {};
  return largest;
}

}  // namespace legible
