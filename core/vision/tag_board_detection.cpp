#include "core/vision/tag_board_detection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

namespace legible {
namespace {

constexpr std::array<const char*, 4> kCornerNames = {"bottom-left", "bottom-right", "top-right", "top-left"};
constexpr double kLeastLikeness = 0.7;  // correlation of a tag's code with the image

Eigen::Vector2d MiddleOf(const std::array<Eigen::Vector2d, 4>& corners_px) {
  return (corners_px[0] + corners_px[1] + corners_px[2] + corners_px[3]) / 4;
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

bool IsFittedWhole(const CornerFit* fits) {
  return std::all_of(fits, fits + 4, [](const CornerFit& fit) {
    return fit.status == CornerStatus::kFitted && fit.contrast > 0;
  });
}

// What both left out, in this order.
std::vector<LeftOut> Joined(std::vector<LeftOut> a, const std::vector<LeftOut>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

TagBoardDetector::TagBoardDetector(const TagBoard& board)
    : board_(board), detector_(board.family, {.decimation = 1, .border_bits = board.border_bits}) {
  if (board.tags.empty()) throw std::invalid_argument("BoardDetector: the board has no tags");
  patterns_.reserve(board.tags.size());
  for (size_t tag = 0; tag < board.tags.size(); ++tag) {
    const int id = board.tags[tag].id;
    index_by_id_[id] = tag;
    patterns_.push_back(PatternOf(board.tags[tag], board.tags, detector_.PictureOf(id),
                                  {board.border_bits, board.has_corner_squares}));
  }
}

BoardSighting TagBoardDetector::Detect(const GrayImage& image) const {
  const Reading own = OwnTags(detector_.Detect(image));
  const Reading agreeing = Agreeing(own.tags);
  std::vector<LeftOut> left_out = Joined(own.left_out, agreeing.left_out);
  if (agreeing.tags.empty()) {
    const LeftOut board = WholeBoard(4 * static_cast<int>(board_.tags.size()), WhyNotFound(own));
    return {{}, Joined({board}, left_out)};
  }
  // Fitted corners say better where the next lines are, and other tags.
  const std::vector<CornerFit> rough = FitCorners(image, Expected(agreeing.tags), kDetectedSigma_px, {});
  const CornerExpectations expectations = ExpectationsFrom(rough);
  std::vector<ReadTag> whole, partial;
  for (size_t i = 0; i < agreeing.tags.size(); ++i) {
    const CornerFit* const fits = &rough[4 * i];
    (IsFittedWhole(fits) ? whole : partial)
        .push_back({agreeing.tags[i].tag, Refined(agreeing.tags[i].corners_px, fits)});
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

std::string TagBoardDetector::WhyNotFound(const Reading& own) const {
  if (own.tags.empty() && own.left_out.empty())
    return fmt::format("was not found: no tag of {} was", PrintOf(board_.family, board_.border_bits));
  if (own.tags.empty()) return fmt::format("was not found: the tags of {} there are not its", board_.family);
  return "was not found: no two of its tags were read where they belong";
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
  const ReadTag seen{predicted.tag, Refined(predicted.corners_px, fits.data())};
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
  expected.reserve(4 * read.size());
  for (const ReadTag& one : read)
    for (const ExpectedCorner& corner :
         ExpectedCornersOf(patterns_[one.tag], one.corners_px, static_cast<int>(4 * one.tag)))
      expected.push_back(corner);
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
