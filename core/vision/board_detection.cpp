#include "core/vision/board_detection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <opencv2/calib3d.hpp>
#include <set>
#include <stdexcept>

#include "core/vision/corner_fit.h"
#include "core/vision/tag_agreement.h"
#include "core/vision/tags.h"

namespace legible {
namespace {

const std::array<const char*, 4> kCornerNames = {"bottom-left", "bottom-right", "top-right", "top-left"};

// How well the corners that an edge is drawn between are known, and how much a lens bends it. (An edge at
// half the focal length from the middle of the image and k1 = -0.2 are 1 / 10 of the focal length in
// curvature's radius.)
constexpr double kRoughSigma_px = 0.5, kFittedSigma_px = 0.05;
constexpr double kBend_per_px = 1 / 10000.0;
// What straight edges and a Gaussian blur leave of a window of a real lens's image.
constexpr double kModelSigma_px = 0.002;
constexpr double kLeastLikeness = 0.7;  // correlation of a tag's picture with the image
constexpr double kBlurSigma = 0.1;      // of the blur, over an image
constexpr double kLeastNoise = 0.3;     // grey levels: that of rounding
constexpr double kNoiseFreedoms = 40;   // that the noise of all corners is worth in one corner's

std::vector<int> PointsFrom(int first, int count) {
  std::vector<int> points(static_cast<size_t>(count));
  std::iota(points.begin(), points.end(), first);
  return points;
}

std::vector<int> PointsOfTag(size_t tag) { return PointsFrom(4 * static_cast<int>(tag), 4); }

std::array<Eigen::Vector2d, 4> Predicted(const TagPlane& plane, const Tag& tag) {
  std::array<Eigen::Vector2d, 4> corners_px;
  for (size_t i = 0; i < 4; ++i) corners_px[i] = plane * tag.corners_m[i].head<2>();
  return corners_px;
}

double DistanceFromTag_m(const Eigen::Vector3d& point, const Tag& tag) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& corner : tag.corners_m) nearest = std::min(nearest, (corner - point).norm());
  return nearest;
}

Eigen::Vector2d MiddleOf(const std::array<Eigen::Vector2d, 4>& corners_px) {
  return (corners_px[0] + corners_px[1] + corners_px[2] + corners_px[3]) / 4;
}

double MedianOf(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// What all corners of an image say of blur and noise; nothing is expected where none was fitted.
CornerExpectations ExpectedFrom(const std::vector<CornerFit>& fits) {
  std::vector<double> blurs_px, variances;
  for (const CornerFit& fit : fits)
    if (fit.status == CornerStatus::kFitted) {
      blurs_px.push_back(fit.blur_px);
      variances.push_back(fit.rms * fit.rms);
    }
  CornerExpectations expected;
  if (blurs_px.empty()) return expected;
  expected.blur_px = MedianOf(blurs_px);
  expected.blur_sigma_px = kBlurSigma * expected.blur_px;
  expected.noise = std::max(std::sqrt(MedianOf(variances)), kLeastNoise);
  expected.noise_freedoms = kNoiseFreedoms;
  return expected;
}

// A corner with the distances of those that its edges are drawn to.
struct Candidate {
  CornerSite site;
  std::array<double, 2> sides_px;
};

std::vector<CornerFit> FitCorners(const GrayImage& image, const std::vector<Candidate>& candidates,
                                  double corner_sigma_px, CornerExpectations expected) {
  std::vector<CornerFit> fits;
  for (const Candidate& candidate : candidates) {
    const auto [shorter_px, longer_px] = std::minmax(candidate.sides_px[0], candidate.sides_px[1]);
    expected.direction_sigma_rad = corner_sigma_px / shorter_px + kBend_per_px * longer_px;
    fits.push_back(FitCorner(image, candidate.site, expected));
  }
  return fits;
}

double Correlation(const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) {
  const Eigen::ArrayXd from_a = a - a.mean(), from_b = b - b.mean();
  const double scale = std::sqrt(from_a.square().sum() * from_b.square().sum());
  return scale > 0 ? (from_a * from_b).sum() / scale : 0;
}

// Bilinear; the place is inside the image.
double GreyAt(const GrayImage& image, const Eigen::Vector2d& place) {
  const int x = std::clamp(static_cast<int>(place.x()), 0, image.width - 2),
            y = std::clamp(static_cast<int>(place.y()), 0, image.height - 2);
  const double right = place.x() - x, down = place.y() - y;
  return (1 - down) * ((1 - right) * image(x, y) + right * image(x + 1, y)) +
         down * ((1 - right) * image(x, y + 1) + right * image(x + 1, y + 1));
}

// To the corners, or to what is left out. The cells know which side is dark.
void Add(const CornerFit& fit, int point, const std::string& what, BoardSighting& sighting) {
  const CornerStatus status =
      fit.status == CornerStatus::kFitted && fit.contrast < 0 ? CornerStatus::kUnlike : fit.status;
  const Eigen::Matrix2d model_px2 = kModelSigma_px * kModelSigma_px * Eigen::Matrix2d::Identity();
  if (status == CornerStatus::kFitted)
    sighting.corners.push_back({point, fit.pixel, fit.covariance_px2 + model_px2});
  else
    sighting.left_out.push_back({what, ToString(status), {point}, fit.pixel});
}

}  // namespace

class BoardDetector::Kind {
 public:
  virtual ~Kind() = default;
  virtual BoardSighting Detect(const GrayImage& image) const = 0;
};

class BoardDetector::Tags : public Kind {
 public:
  explicit Tags(const TagBoard& board)
      : board_(board), detector_(board.family, {.decimation = 1, .border_bits = board.border_bits}) {
    if (board.tags.empty()) throw std::invalid_argument("BoardDetector: the board has no tags");
    for (size_t i = 0; i < board.tags.size(); ++i) {
      index_by_id_[board.tags[i].id] = i;
      patterns_.push_back(PatternsOf(i));
    }
  }

  BoardSighting Detect(const GrayImage& image) const override {
    BoardSighting sighting;
    const std::vector<ReadTag> read = OwnTags(detector_.Detect(image), sighting);
    std::vector<ReadTag> agreeing;
    const std::vector<size_t> chosen = AgreeingTags(board_.tags, read);
    for (size_t i = 0; i < read.size(); ++i) {
      if (std::binary_search(chosen.begin(), chosen.end(), i))
        agreeing.push_back(read[i]);
      else
        LeaveOut(read[i],
                 "contradicts where the other tags predict it: another tag or pattern was read as it",
                 sighting);
    }
    if (agreeing.empty()) {
      sighting.left_out.push_back({"the board",
                                   "was not found: no two of its tags were read where they belong",
                                   PointsFrom(0, 4 * static_cast<int>(board_.tags.size())), std::nullopt});
      return sighting;
    }
    const Refined refined = Refine(image, agreeing);
    const Search search = FindOthers(image, refined);
    for (const ReadTag& missing : search.missing)
      LeaveOut(missing, "was not found, although the other tags predict it to be inside the image", sighting);
    AddCorners(image, search.found, refined.expected, sighting);
    std::sort(sighting.corners.begin(), sighting.corners.end(),
              [](const BoardCorner& a, const BoardCorner& b) { return a.point < b.point; });
    return sighting;
  }

 private:
  // What is printed about one corner of a tag.
  struct CornerPattern {
    std::array<Eigen::Vector2d, 2> edges_m;  // along both edges to the next lines
    CornerCells cells;
    bool knows_beyond;
  };

  std::array<CornerPattern, 4> PatternsOf(size_t index) const {
    const Tag& tag = board_.tags[index];
    const TagPicture picture = detector_.PictureOf(tag.id);
    std::array<CornerPattern, 4> patterns;
    for (size_t c = 0; c < 4; ++c) {
      const int modules = picture.modules - 2 * picture.ring;
      const bool is_wide = board_.border_bits > 1;
      const double pitch = static_cast<double>(board_.border_bits) / modules;  // of a side
      for (size_t edge = 0; edge < 2; ++edge) {
        const Eigen::Vector3d side = tag.corners_m[(c + (edge == 0 ? 1 : 3)) % 4] - tag.corners_m[c];
        patterns[c].edges_m[edge] = side.head<2>() * std::min(pitch, Gap_m(index, c) / side.norm());
      }
      patterns[c].cells = is_wide ? DarkWedge() : CellsOf(picture, static_cast<int>(c));
      if (board_.has_corner_squares) patterns[c].cells.topLeftCorner<2, 2>().setZero();
      patterns[c].knows_beyond = !is_wide && !board_.has_corner_squares;
    }
    return patterns;
  }

  // From a corner to the nearest other tag.
  double Gap_m(size_t index, size_t corner) const {
    double gap_m = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < board_.tags.size(); ++i)
      if (i != index)
        gap_m = std::min(gap_m, DistanceFromTag_m(board_.tags[index].corners_m[corner], board_.tags[i]));
    return gap_m;
  }

  // The modules about a corner, along its edges to the next corner and to the one before.
  static CornerCells CellsOf(const TagPicture& picture, int corner) {
    const int low = picture.ring, high = picture.modules - picture.ring;
    const Eigen::Vector2d at(corner == 1 || corner == 2 ? high : low,
                             corner >= 2 ? low : high);  // column, row
    const std::array<Eigen::Vector2d, 4> along = {Eigen::Vector2d(1, 0), {0, -1}, {-1, 0}, {0, 1}};
    const Eigen::Vector2d edge_1 = along[static_cast<size_t>(corner)],
                          edge_2 = -along[static_cast<size_t>(corner + 3) % 4];
    CornerCells cells;
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column)
        cells(row, column) = LevelAt(picture, at + (column - 1.5) * edge_1 + (row - 1.5) * edge_2);
    return cells;
  }

  // Paper is light.
  static double LevelAt(const TagPicture& picture, const Eigen::Vector2d& place) {
    if (place.minCoeff() < 0 || place.maxCoeff() > picture.modules) return 1;
    const auto column = static_cast<size_t>(place.x()), row = static_cast<size_t>(place.y());
    return picture.is_light[row * static_cast<size_t>(picture.modules) + column] ? 1 : 0;
  }

  std::vector<ReadTag> OwnTags(const std::vector<TagDetection>& detections, BoardSighting& sighting) const {
    std::vector<ReadTag> read;
    for (const TagDetection& detection : detections) {
      const auto found = index_by_id_.find(detection.id);
      if (found != index_by_id_.end())
        read.push_back({found->second, detection.corners_px});
      else
        sighting.left_out.push_back({fmt::format("tag {}", detection.id),
                                     "is not among the board's tags",
                                     {},
                                     MiddleOf(detection.corners_px)});
    }
    return read;
  }

  void LeaveOut(const ReadTag& read, const std::string& reason, BoardSighting& sighting) const {
    sighting.left_out.push_back({fmt::format("tag {}", board_.tags[read.tag].id), reason,
                                 PointsOfTag(read.tag), MiddleOf(read.corners_px)});
  }

  struct Refined {
    std::vector<ReadTag> read;
    CornerExpectations expected;
  };

  // Corners fitted one by one say better where the next lines are, and other tags.
  Refined Refine(const GrayImage& image, std::vector<ReadTag> read) const {
    const std::vector<CornerFit> fits = FitCorners(image, CandidatesOf(read), kRoughSigma_px, {});
    for (size_t i = 0; i < fits.size(); ++i)
      if (fits[i].status == CornerStatus::kFitted) read[i / 4].corners_px[i % 4] = fits[i].pixel;
    return {std::move(read), ExpectedFrom(fits)};
  }

  struct Search {
    std::vector<ReadTag> found;
    std::vector<ReadTag> missing;  // where they ought to be
  };

  // Looks for each tag where the nearest of the found ones predicts it to be wholly inside the image.
  Search FindOthers(const GrayImage& image, const Refined& refined) const {
    Search search{refined.read, {}};
    bool is_growing = true;
    while (is_growing) {
      is_growing = false;
      search.missing.clear();
      std::set<size_t> found;
      for (const ReadTag& read : search.found) found.insert(read.tag);
      for (size_t i = 0; i < board_.tags.size(); ++i) {
        if (found.contains(i)) continue;
        const ReadTag predicted{i, PredictedByNearest(i, search.found)};
        if (!IsInside(predicted.corners_px, image)) continue;
        const std::optional<ReadTag> seen = LookFor(image, predicted, refined.expected);
        if (seen)
          search.found.push_back(*seen);
        else
          search.missing.push_back(predicted);
        is_growing |= seen.has_value();
      }
    }
    return search;
  }

  // The tag, if its corners fit and its picture is seen between them.
  std::optional<ReadTag> LookFor(const GrayImage& image, const ReadTag& predicted,
                                 const CornerExpectations& expected) const {
    ReadTag seen = predicted;
    const std::vector<CornerFit> fits =
        FitCorners(image, CandidatesOf({predicted}), kRoughSigma_px, expected);
    for (size_t c = 0; c < 4; ++c) {
      if (fits[c].status != CornerStatus::kFitted || fits[c].contrast < 0) return std::nullopt;
      seen.corners_px[c] = fits[c].pixel;
    }
    if (Likeness(image, seen) < kLeastLikeness) return std::nullopt;
    return seen;
  }

  // Correlation of the tag's code with the image at the middles of its modules.
  double Likeness(const GrayImage& image, const ReadTag& read) const {
    const Tag& tag = board_.tags[read.tag];
    const TagPicture picture = detector_.PictureOf(tag.id);
    const TagPlane plane(tag.corners_m, read.corners_px);
    const int first = picture.ring + board_.border_bits, last = picture.modules - first;
    const double border = picture.modules - 2 * picture.ring;
    std::vector<double> printed, seen;
    for (int row = first; row < last; ++row)
      for (int column = first; column < last; ++column) {
        const double right = (column + 0.5 - picture.ring) / border,
                     up = 1 - (row + 0.5 - picture.ring) / border;
        const Eigen::Vector3d place_m = tag.corners_m[0] + right * (tag.corners_m[1] - tag.corners_m[0]) +
                                        up * (tag.corners_m[3] - tag.corners_m[0]);
        printed.push_back(LevelAt(picture, {column + 0.5, row + 0.5}));
        seen.push_back(GreyAt(image, plane * place_m.head<2>()));
      }
    return Correlation(Eigen::Map<Eigen::ArrayXd>(printed.data(), std::ssize(printed)),
                       Eigen::Map<Eigen::ArrayXd>(seen.data(), std::ssize(seen)));
  }

  std::array<Eigen::Vector2d, 4> PredictedByNearest(size_t index,
                                                    const std::vector<ReadTag>& agreeing) const {
    const auto distance = [&](const ReadTag& read) {
      return (board_.tags[read.tag].corners_m[0] - board_.tags[index].corners_m[0]).norm();
    };
    const ReadTag& nearest =
        *std::min_element(agreeing.begin(), agreeing.end(),
                          [&](const ReadTag& a, const ReadTag& b) { return distance(a) < distance(b); });
    return Predicted(TagPlane(board_.tags[nearest.tag].corners_m, nearest.corners_px), board_.tags[index]);
  }

  // With room for the light margin about it.
  static bool IsInside(const std::array<Eigen::Vector2d, 4>& corners_px, const GrayImage& image) {
    constexpr double kMargin_px = 4;
    const Eigen::Array2d largest(image.width - 1 - kMargin_px, image.height - 1 - kMargin_px);
    return std::all_of(corners_px.begin(), corners_px.end(), [&](const Eigen::Vector2d& corner) {
      return corner.allFinite() && (corner.array() > kMargin_px).all() && (corner.array() < largest).all();
    });
  }

  // Four a tag.
  std::vector<Candidate> CandidatesOf(const std::vector<ReadTag>& read) const {
    std::vector<Candidate> candidates;
    for (const ReadTag& one : read) {
      const Tag& tag = board_.tags[one.tag];
      const TagPlane plane(tag.corners_m, one.corners_px);
      for (size_t c = 0; c < 4; ++c) {
        const CornerPattern& pattern = patterns_[one.tag][c];
        CornerSite site{one.corners_px[c], {}, pattern.cells, pattern.knows_beyond};
        for (size_t edge = 0; edge < 2; ++edge)
          site.edges_px[edge] =
              plane * (tag.corners_m[c].head<2>() + pattern.edges_m[edge]) - one.corners_px[c];
        candidates.push_back({site,
                              {(one.corners_px[(c + 1) % 4] - one.corners_px[c]).norm(),
                               (one.corners_px[(c + 3) % 4] - one.corners_px[c]).norm()}});
      }
    }
    return candidates;
  }

  void AddCorners(const GrayImage& image, const std::vector<ReadTag>& read,
                  const CornerExpectations& expected, BoardSighting& sighting) const {
    const std::vector<CornerFit> fits = FitCorners(image, CandidatesOf(read), kFittedSigma_px, expected);
    for (size_t i = 0; i < fits.size(); ++i) {
      const ReadTag& tag = read[i / 4];
      const int point = 4 * static_cast<int>(tag.tag) + static_cast<int>(i % 4);
      Add(fits[i], point,
          fmt::format("the {} corner of tag {}", kCornerNames[i % 4], board_.tags[tag.tag].id), sighting);
    }
  }

  TagBoard board_;
  TagDetector detector_;
  std::map<int, size_t> index_by_id_;
  std::vector<std::array<CornerPattern, 4>> patterns_;
};

class BoardDetector::Chess : public Kind {
 public:
  explicit Chess(const Chessboard& board) : board_(board) {
    if (board.columns < 3 || board.rows < 3)
      throw std::invalid_argument("BoardDetector: a chessboard has at least 3 inner corners a side");
  }

  BoardSighting Detect(const GrayImage& image) const override {
    std::vector<Eigen::Vector2d> corners = Find(image);
    BoardSighting sighting;
    if (corners.empty()) {
      sighting.left_out.push_back(
          {"the board", "was not found with all of its corners: a chessboard counts only as a whole",
           PointsFrom(0, board_.columns * board_.rows), std::nullopt});
      return sighting;
    }
    const std::vector<CornerFit> rough = FitCorners(image, CandidatesOf(corners), kRoughSigma_px, {});
    for (size_t i = 0; i < corners.size(); ++i)
      if (rough[i].status == CornerStatus::kFitted) corners[i] = rough[i].pixel;
    std::vector<CornerFit> fits =
        FitCorners(image, CandidatesOf(corners), kFittedSigma_px, ExpectedFrom(rough));
    const double darkness = DarknessOfFirst(fits);
    if ((board_.columns + board_.rows) % 2 == 1 && darkness < 0) std::reverse(fits.begin(), fits.end());
    const double sign = (board_.columns + board_.rows) % 2 == 1 || darkness > 0 ? 1 : -1;
    for (int point = 0; point < std::ssize(fits); ++point) {
      CornerFit& fit = fits[static_cast<size_t>(point)];
      fit.contrast *= sign * Parity(point);
      Add(fit, point,
          fmt::format("corner {} of row {}", point % board_.columns + 1, point / board_.columns + 1),
          sighting);
    }
    return sighting;
  }

 private:
  // Roughly, row by row as the board's points; empty where the board is not found as a whole.
  std::vector<Eigen::Vector2d> Find(const GrayImage& image) const {
    const cv::Mat view(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.pixels.data()));
    std::vector<cv::Point2f> found;
    if (!cv::findChessboardCornersSB(view, {board_.columns, board_.rows}, found,
                                     cv::CALIB_CB_NORMALIZE_IMAGE) &&
        !cv::findChessboardCornersSB(view, {board_.columns, board_.rows}, found,
                                     cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE))
      return {};
    std::vector<Eigen::Vector2d> corners;
    for (const cv::Point2f& corner : found) corners.emplace_back(corner.x, corner.y);
    // Rows go down where columns go right, seen from the printed side.
    const Eigen::Vector2d right = corners[1] - corners[0], down = corners[At(1, 0)] - corners[0];
    if (right.x() * down.y() - right.y() * down.x() < 0)
      for (int row = 0; row < board_.rows; ++row)
        std::reverse(corners.begin() + row * board_.columns, corners.begin() + (row + 1) * board_.columns);
    return corners;
  }

  size_t At(int row, int column) const { return static_cast<size_t>(row * board_.columns + column); }

  double Parity(int point) const {
    return (point % board_.columns + point / board_.columns) % 2 == 0 ? 1 : -1;
  }

  std::vector<Candidate> CandidatesOf(const std::vector<Eigen::Vector2d>& corners) const {
    std::vector<Candidate> candidates;
    for (int row = 0; row < board_.rows; ++row)
      for (int column = 0; column < board_.columns; ++column) {
        const int left = std::max(column - 1, 0), right = std::min(column + 1, board_.columns - 1);
        const int above = std::max(row - 1, 0), below = std::min(row + 1, board_.rows - 1);
        const Eigen::Vector2d step_right =
            (corners[At(row, right)] - corners[At(row, left)]) / (right - left);
        const Eigen::Vector2d step_down =
            (corners[At(below, column)] - corners[At(above, column)]) / (below - above);
        candidates.push_back({{corners[At(row, column)], {step_right, step_down}, DarkSaddle()},
                              {step_right.norm(), step_down.norm()}});
      }
    return candidates;
  }

  // Above 0 where the square from the first corner towards the middle is dark.
  double DarknessOfFirst(const std::vector<CornerFit>& fits) const {
    double sum = 0;
    for (int point = 0; point < std::ssize(fits); ++point)
      if (fits[static_cast<size_t>(point)].status == CornerStatus::kFitted)
        sum += Parity(point) * fits[static_cast<size_t>(point)].contrast;
    return sum;
  }

  Chessboard board_;
};

BoardDetector::BoardDetector(const Board& board) {
  if (board.tags.has_value() == board.chessboard.has_value())
    throw std::invalid_argument("BoardDetector: a board has either tags or a chessboard");
  if (board.tags)
    kind_ = std::make_unique<Tags>(*board.tags);
  else
    kind_ = std::make_unique<Chess>(*board.chessboard);
}

BoardDetector::~BoardDetector() = default;

BoardSighting BoardDetector::Detect(const GrayImage& image) const { return kind_->Detect(image); }

}  // namespace legible
