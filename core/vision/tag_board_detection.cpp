#include "core/vision/tag_board_detection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

namespace legible {
namespace {

constexpr std::array<const char*, 4> kCornerNames = {"bottom-left", "bottom-right", "top-right", "top-left"};
constexpr double kLeastLikeness = 0.7;  // correlation of a tag's code with the image

double DistanceFromTag_m(const Eigen::Vector3d& point, const Tag& tag) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& corner : tag.corners_m) nearest = std::min(nearest, (corner - point).norm());
  return nearest;
}

Eigen::Vector2d MiddleOf(const std::array<Eigen::Vector2d, 4>& corners_px) {
  return (corners_px[0] + corners_px[1] + corners_px[2] + corners_px[3]) / 4;
}

// Paper is light.
double LevelAt(const TagPicture& picture, const Eigen::Vector2d& place) {
  if (place.minCoeff() < 0 || place.maxCoeff() > picture.modules) return 1;
  const auto column = static_cast<size_t>(place.x()), row = static_cast<size_t>(place.y());
  return picture.is_light[row * static_cast<size_t>(picture.modules) + column] ? 1 : 0;
}

// The modules about a corner, along its edges to the next corner and to the one before.
CornerCells CellsOf(const TagPicture& picture, size_t corner) {
  const int low = picture.ring, high = picture.modules - picture.ring;
  const Eigen::Vector2d at(corner == 1 || corner == 2 ? high : low, corner >= 2 ? low : high);  // column, row
  const std::array<Eigen::Vector2d, 4> along = {Eigen::Vector2d(1, 0), {0, -1}, {-1, 0}, {0, 1}};
  const Eigen::Vector2d& edge_1 = along[corner];
  const Eigen::Vector2d edge_2 = -along[(corner + 3) % 4];
  CornerCells cells;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      cells(row, column) = LevelAt(picture, at + (column - 1.5) * edge_1 + (row - 1.5) * edge_2);
  return cells;
}

double Correlation(const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) {
  const Eigen::ArrayXd from_a = a - a.mean(), from_b = b - b.mean();
  const double scale = std::sqrt(from_a.square().sum() * from_b.square().sum());
  return scale > 0 ? (from_a * from_b).sum() / scale : 0;
}

// Bilinear.
double GreyAt(const GrayImage& image, const Eigen::Vector2d& place) {
  const int x = std::clamp(static_cast<int>(place.x()), 0, image.width - 2),
            y = std::clamp(static_cast<int>(place.y()), 0, image.height - 2);
  const double right = place.x() - x, down = place.y() - y;
  return (1 - down) * ((1 - right) * image(x, y) + right * image(x + 1, y)) +
         down * ((1 - right) * image(x, y + 1) + right * image(x + 1, y + 1));
}

// With room for the light margin about it.
bool IsInside(const std::array<Eigen::Vector2d, 4>& corners_px, const GrayImage& image) {
  constexpr double kMargin_px = 4;
  const Eigen::Array2d largest(image.width - 1 - kMargin_px, image.height - 1 - kMargin_px);
  return std::all_of(corners_px.begin(), corners_px.end(), [&](const Eigen::Vector2d& corner) {
    return corner.allFinite() && (corner.array() > kMargin_px).all() && (corner.array() < largest).all();
  });
}

// The tag with the corners that were fitted where those were; `fits` begins with its own.
ReadTag Refined(ReadTag read, const CornerFit* fits) {
  for (size_t i = 0; i < 4; ++i)
    if (fits[i].status == CornerStatus::kFitted) read.corners_px[i] = fits[i].pixel;
  return read;
}

bool IsFittedWhole(const CornerFit* fits) {
  return std::all_of(fits, fits + 4, [](const CornerFit& fit) {
    return fit.status == CornerStatus::kFitted && fit.contrast > 0;
  });
}

// What both left out.
std::vector<LeftOut> Joined(std::vector<LeftOut> a, const std::vector<LeftOut>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

TagBoardDetector::TagBoardDetector(const TagBoard& board)
    : board_(board), detector_(board.family, {.decimation = 1, .border_bits = board.border_bits}) {
  if (board.tags.empty()) throw std::invalid_argument("BoardDetector: the board has no tags");
  for (size_t tag = 0; tag < board.tags.size(); ++tag) {
    index_by_id_[board.tags[tag].id] = tag;
    patterns_.push_back({PatternOf(tag, 0), PatternOf(tag, 1), PatternOf(tag, 2), PatternOf(tag, 3)});
  }
}

BoardSighting TagBoardDetector::Detect(const GrayImage& image) const {
  const Reading own = OwnTags(detector_.Detect(image));
  const Reading agreeing = Agreeing(own.tags);
  std::vector<LeftOut> left_out = Joined(own.left_out, agreeing.left_out);
  if (agreeing.tags.empty()) {
    const LeftOut board = WholeBoard(4 * static_cast<int>(board_.tags.size()),
                                     "was not found: no two of its tags were read where they belong");
    return {{}, Joined(std::move(left_out), {board})};
  }
  // Fitted corners say better where the next lines are, and other tags.
  const std::vector<CornerFit> rough = FitCorners(image, Expected(agreeing.tags), kDetectedSigma_px, {});
  const CornerExpectations expectations = ExpectationsFrom(rough);
  std::vector<ReadTag> whole, partial;
  for (size_t i = 0; i < agreeing.tags.size(); ++i) {
    const CornerFit* const fits = &rough[4 * i];
    (IsFittedWhole(fits) ? whole : partial).push_back(Refined(agreeing.tags[i], fits));
  }
  const Reading all = WithOthers(image, whole, partial, expectations);
  const std::vector<ExpectedCorner> expected = Expected(all.tags);
  BoardSighting sighting =
      SightingOf(expected, FitCorners(image, expected, kFittedSigma_px, expectations), [&](int point) {
        const size_t tag = static_cast<size_t>(point) / 4, corner = static_cast<size_t>(point) % 4;
        return fmt::format("the {} corner of tag {}", kCornerNames[corner], board_.tags[tag].id);
      });
  sighting.left_out = Joined(Joined(std::move(left_out), all.left_out), sighting.left_out);
  return sighting;
}

TagBoardDetector::CornerPattern TagBoardDetector::PatternOf(size_t tag, size_t corner) const {
  const std::array<Eigen::Vector3d, 4>& corners_m = board_.tags[tag].corners_m;
  const TagPicture picture = detector_.PictureOf(board_.tags[tag].id);
  const bool is_wide = board_.border_bits > 1;
  CornerPattern pattern{{}, is_wide ? DarkWedge() : CellsOf(picture, corner), false};
  if (board_.has_corner_squares) pattern.cells.topLeftCorner<2, 2>().setZero();
  pattern.knows_beyond = !is_wide && !board_.has_corner_squares;
  const double border = board_.border_bits / static_cast<double>(picture.modules - 2 * picture.ring);
  for (size_t edge = 0; edge < 2; ++edge) {
    const Eigen::Vector3d side_m = corners_m[(corner + (edge == 0 ? 1 : 3)) % 4] - corners_m[corner];
    pattern.edges_m[edge] = side_m.head<2>() * std::min(border, Gap_m(tag, corner) / side_m.norm());
  }
  return pattern;
}

// From a corner to the nearest other tag.
double TagBoardDetector::Gap_m(size_t tag, size_t corner) const {
  double gap_m = std::numeric_limits<double>::infinity();
  for (size_t other = 0; other < board_.tags.size(); ++other)
    if (other != tag)
      gap_m = std::min(gap_m, DistanceFromTag_m(board_.tags[tag].corners_m[corner], board_.tags[other]));
  return gap_m;
}

TagBoardDetector::Reading TagBoardDetector::OwnTags(const std::vector<TagDetection>& detections) const {
  Reading reading;
  for (const TagDetection& detection : detections) {
    const auto found = index_by_id_.find(detection.id);
    if (found != index_by_id_.end())
      reading.tags.push_back({found->second, detection.corners_px});
    else
      reading.left_out.push_back({fmt::format("tag {}", detection.id),
                                  "is not among the board's tags",
                                  {},
                                  MiddleOf(detection.corners_px)});
  }
  return reading;
}

TagBoardDetector::Reading TagBoardDetector::Agreeing(const std::vector<ReadTag>& read) const {
  Reading reading;
  std::set<size_t> tags;
  const std::vector<size_t> agreeing = AgreeingTags(board_.tags, read);
  for (const size_t i : agreeing)
    if (tags.insert(read[i].tag).second) reading.tags.push_back(read[i]);
  for (size_t i = 0; i < read.size(); ++i)
    if (!std::binary_search(agreeing.begin(), agreeing.end(), i)) {
      reading.left_out.push_back(Named(
          read[i], "contradicts where the other tags predict it: another tag or pattern was read as it"));
      reading.left_out.back().contradicts = true;
    }
  return reading;
}

// Looks for each tag but the whole ones where the nearest of those predicts it to be wholly inside the image;
// what is not found so is as it was read, in part.
TagBoardDetector::Reading TagBoardDetector::WithOthers(const GrayImage& image, std::vector<ReadTag> whole,
                                                       const std::vector<ReadTag>& partial,
                                                       const CornerExpectations& expected) const {
  std::vector<ReadTag> missing;
  std::set<size_t> found;
  for (const ReadTag& read : whole) found.insert(read.tag);
  for (bool is_growing = !whole.empty(); is_growing;) {
    is_growing = false;
    missing.clear();
    for (size_t tag = 0; tag < board_.tags.size(); ++tag) {
      if (found.contains(tag)) continue;
      const ReadTag predicted{tag, PredictedByNearest(tag, whole)};
      if (!IsInside(predicted.corners_px, image)) continue;
      if (const std::optional<ReadTag> seen = LookFor(image, predicted, expected)) {
        whole.push_back(*seen);
        is_growing = found.insert(tag).second;
      } else {
        missing.push_back(predicted);
      }
    }
  }
  Reading reading{std::move(whole), {}};
  for (const ReadTag& read : partial)
    if (found.insert(read.tag).second) reading.tags.push_back(read);
  for (const ReadTag& read : missing)
    if (!found.contains(read.tag))
      reading.left_out.push_back(
          Named(read, "was not found, although the other tags predict it to be inside the image"));
  return reading;
}

// The tag, if its corners fit and its code is seen between them.
std::optional<ReadTag> TagBoardDetector::LookFor(const GrayImage& image, const ReadTag& predicted,
                                                 const CornerExpectations& expected) const {
  const std::vector<CornerFit> fits = FitCorners(image, Expected({predicted}), kDetectedSigma_px, expected);
  if (!IsFittedWhole(fits.data())) return std::nullopt;
  const ReadTag seen = Refined(predicted, fits.data());
  if (Likeness(image, seen) < kLeastLikeness) return std::nullopt;
  return seen;
}

std::array<Eigen::Vector2d, 4> TagBoardDetector::PredictedByNearest(size_t tag,
                                                                    const std::vector<ReadTag>& read) const {
  const auto distance_m = [&](const ReadTag& one) {
    return (board_.tags[one.tag].corners_m[0] - board_.tags[tag].corners_m[0]).norm();
  };
  const ReadTag& nearest =
      *std::min_element(read.begin(), read.end(),
                        [&](const ReadTag& a, const ReadTag& b) { return distance_m(a) < distance_m(b); });
  const TagPlane plane(board_.tags[nearest.tag].corners_m, nearest.corners_px);
  std::array<Eigen::Vector2d, 4> corners_px;
  for (size_t i = 0; i < 4; ++i) corners_px[i] = plane * board_.tags[tag].corners_m[i].head<2>();
  return corners_px;
}

// Correlation of the tag's code with the image at the middles of its modules.
double TagBoardDetector::Likeness(const GrayImage& image, const ReadTag& read) const {
  const std::array<Eigen::Vector3d, 4>& corners_m = board_.tags[read.tag].corners_m;
  const TagPicture picture = detector_.PictureOf(board_.tags[read.tag].id);
  const TagPlane plane(corners_m, read.corners_px);
  const int first = picture.ring + board_.border_bits, last = picture.modules - first;
  const double modules_of_side = picture.modules - 2 * picture.ring;
  std::vector<double> printed, seen;
  for (int row = first; row < last; ++row)
    for (int column = first; column < last; ++column) {
      const Eigen::Vector2d place(column + 0.5, row + 0.5);
      const double right = (place.x() - picture.ring) / modules_of_side,
                   up = 1 - (place.y() - picture.ring) / modules_of_side;
      const Eigen::Vector3d place_m =
          corners_m[0] + right * (corners_m[1] - corners_m[0]) + up * (corners_m[3] - corners_m[0]);
      printed.push_back(LevelAt(picture, place));
      seen.push_back(GreyAt(image, plane * place_m.head<2>()));
    }
  return Correlation(Eigen::Map<Eigen::ArrayXd>(printed.data(), std::ssize(printed)),
                     Eigen::Map<Eigen::ArrayXd>(seen.data(), std::ssize(seen)));
}

// Four a tag.
std::vector<ExpectedCorner> TagBoardDetector::Expected(const std::vector<ReadTag>& read) const {
  std::vector<ExpectedCorner> expected;
  for (const ReadTag& one : read) {
    const TagPlane plane(board_.tags[one.tag].corners_m, one.corners_px);
    for (size_t c = 0; c < 4; ++c) {
      const CornerPattern& pattern = patterns_[one.tag][c];
      const Eigen::Vector2d pixel = one.corners_px[c], place_m = board_.tags[one.tag].corners_m[c].head<2>();
      ExpectedCorner corner{
          static_cast<int>(4 * one.tag + c), {pixel, {}, pattern.cells, pattern.knows_beyond}, {}};
      for (size_t edge = 0; edge < 2; ++edge) {
        corner.site.edges_px[edge] = plane * (place_m + pattern.edges_m[edge]) - pixel;
        corner.sides_px[edge] = (one.corners_px[(c + (edge == 0 ? 1 : 3)) % 4] - pixel).norm();
      }
      expected.push_back(corner);
    }
  }
  return expected;
}

LeftOut TagBoardDetector::Named(const ReadTag& read, const std::string& reason) const {
  const int first = 4 * static_cast<int>(read.tag);
  return {fmt::format("tag {}", board_.tags[read.tag].id),
          reason,
          {first, first + 1, first + 2, first + 3},
          MiddleOf(read.corners_px)};
}

}  // namespace legible
