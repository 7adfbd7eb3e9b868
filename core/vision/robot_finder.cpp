#include "core/vision/robot_finder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include "core/geometry/cylinder_outline.h"

namespace legible {
namespace {

constexpr int kSmallWidth_px = 320;    // of the image that candidates are scored on
constexpr double kSmallBlur_px = 1.5;  // there
constexpr double kMostContrast = 10;   // grey levels per px there: a stronger edge counts no more
constexpr int kPointsPerLeg = 10;
constexpr int kClimbSteps = 160;
constexpr double kFirstStep_m = 0.02, kLastStep_m = 0.002;  // of a climb; and as much at the platform's rim
constexpr double kSamePose_m = 0.01;
constexpr double kSameEdge = 0.004;    // within that share of the image's width
constexpr double kSurelyWorse = 0.95;  // times the best score

using Vector12d = Eigen::Matrix<double, 12, 1>;

// The image's gradients, small and blurred.
class GradientField {
 public:
  explicit GradientField(const GrayImage& image) {
    const int factor = std::max(1, image.width / kSmallWidth_px);
    scale_ = 1.0 / factor;
    GrayImage small{image.width / factor, image.height / factor, {}};
    small.pixels.reserve(static_cast<size_t>(small.width) * static_cast<size_t>(small.height));
    for (int y = 0; y < small.height; ++y)
      for (int x = 0; x < small.width; ++x) small.pixels.push_back(MeanOf(image, x, y, factor));
    blurred_ = Blurred(small, kSmallBlur_px);
  }

  // Along `direction` (unit), grey levels per px of the small image; 0 outside.
  double Along(const Eigen::Vector2d& pixel, const Eigen::Vector2d& direction) const {
    const int x = static_cast<int>(std::lround((pixel.x() + 0.5) * scale_ - 0.5));
    const int y = static_cast<int>(std::lround((pixel.y() + 0.5) * scale_ - 0.5));
    if (x < 1 || y < 1 || x + 1 >= blurred_.width || y + 1 >= blurred_.height) return 0;
    return 0.5 * (direction.x() * (blurred_(x + 1, y) - blurred_(x - 1, y)) +
                  direction.y() * (blurred_(x, y + 1) - blurred_(x, y - 1)));
  }

 private:
  static std::uint8_t MeanOf(const GrayImage& image, int x, int y, int factor) {
    int sum = 0;
    for (int v = 0; v < factor; ++v)
      for (int u = 0; u < factor; ++u) sum += image(x * factor + u, y * factor + v);
    return static_cast<std::uint8_t>((sum + factor * factor / 2) / (factor * factor));
  }

  double scale_ = 1;
  GrayImage blurred_;
};

// How leg-like the image is where a view has its legs: the mean over points along all legs of the weaker of
// both edges' contrasts, with legs brighter than what is behind them or darker, whichever is more.
double ScoreOf(const GradientField& field, const ModelledView& view) {
  double brighter = 0, darker = 0;
  const Eigen::Vector2d focal_px(view.camera.fx_px, view.camera.fy_px);
  for (const LegInCamera& leg : PlaceLegs(view)) {
    if (leg.a_in_camera.z() <= 0 || leg.b_in_camera.z() <= 0) continue;
    const auto axis = LineThrough<double>(leg.a_in_camera, leg.b_in_camera);
    if (!CameraIsOutside(axis, leg.radius_m)) continue;
    const auto normals = CylinderOutline(axis, leg.radius_m);
    for (int i = 0; i < kPointsPerLeg; ++i) {
      const Eigen::Vector3d x = leg.AxisPoint(0.1 + 0.8 * i / (kPointsPerLeg - 1));
      std::array<double, 2> outward;
      for (size_t side = 0; side < 2; ++side) {
        const Eigen::Vector2d pixel =
            ProjectNormalised(view.camera, (x + leg.radius_m * normals[side]).hnormalized());
        outward[side] = field.Along(pixel, normals[side].head<2>().cwiseQuotient(focal_px).normalized());
      }
      brighter += std::clamp(std::min(-outward[0], -outward[1]), 0.0, kMostContrast);
      darker += std::clamp(std::min(outward[0], outward[1]), 0.0, kMostContrast);
    }
  }
  return std::max(brighter, darker) / (kLegCount * kPointsPerLeg);
}

struct Candidate {
  ModelledView view;
  double score = 0;
};

bool HasHigherScore(const Candidate& a, const Candidate& b) { return a.score > b.score; }

// Halton's sequence.
double RadicalInverse(int number, int base) {
  double result = 0, digit = 1;
  for (; number > 0; number /= base) {
    digit /= base;
    result += digit * (number % base);
  }
  return result;
}

// Over the joint ranges; the home pose too.
std::vector<Candidate> SpreadCandidates(const GradientField& field, const ModelledView& home, int count) {
  constexpr std::array<int, kLegCount> kBases = {2, 3, 5, 7, 11, 13};
  std::vector<Candidate> candidates = {{home, ScoreOf(field, home)}};
  for (int number = 1; number <= count; ++number) {
    Vector6d readings_m;
    for (size_t i = 0; i < kLegCount; ++i) {
      const auto& [shortest_m, longest_m] = home.robot.legs[i].joint_range_m;
      readings_m[static_cast<Eigen::Index>(i)] =
          shortest_m + (longest_m - shortest_m) * RadicalInverse(number, kBases[i]);
    }
    const auto forward = ForwardKinematics(home.robot, readings_m, home.base_from_platform);
    if (forward.status != ForwardKinematicsStatus::kConverged) continue;
    Candidate candidate{home, 0};
    candidate.view.base_from_platform = forward.base_from_platform;
    candidate.score = ScoreOf(field, candidate.view);
    candidates.push_back(candidate);
  }
  return candidates;
}

// Steps of random directions, shorter and shorter, kept where they score better: of the platform, and of the
// camera as far as it may be off.
Candidate Climb(const GradientField& field, Candidate candidate,
                const RobotFinderOptions::Knowledge& knowledge, std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  const double radius_m = PlatformRadius(candidate.view.robot);
  for (int i = 0; i < kClimbSteps; ++i) {
    const double step_m = kFirstStep_m * std::pow(kLastStep_m / kFirstStep_m, double{1} * i / kClimbSteps);
    Vector6d platform, camera;
    for (Eigen::Index k = 0; k < 6; ++k) {
      platform[k] = 0.5 * step_m * normal(generator) / (k < 3 ? 1 : radius_m);
      camera[k] = step_m / kFirstStep_m * normal(generator) * 0.5 *
                  (k < 3 ? knowledge.camera_m : knowledge.camera_rad);
    }
    Candidate moved = candidate;
    moved.view.base_from_platform = Displaced(moved.view.base_from_platform, platform);
    moved.view.camera_from_base = Displaced(moved.view.camera_from_base, camera);
    moved.score = ScoreOf(field, moved.view);
    if (moved.score > candidate.score) candidate = std::move(moved);
  }
  return candidate;
}

double DistanceBetween(const ModelledView& a, const ModelledView& b) {
  const Vector6d way = Displacement(a.base_from_platform, b.base_from_platform);
  return way.head<3>().norm() + PlatformRadius(a.robot) * way.tail<3>().norm();
}

// The best, each some way from all better ones.
std::vector<Candidate> BestApart(std::vector<Candidate> candidates, int count) {
  std::sort(candidates.begin(), candidates.end(), HasHigherScore);
  std::vector<Candidate> best;
  for (Candidate& candidate : candidates) {
    const bool is_apart = std::all_of(best.begin(), best.end(), [&](const Candidate& better) {
      return DistanceBetween(candidate.view, better.view) > kSamePose_m;
    });
    if (is_apart) best.push_back(std::move(candidate));
    if (static_cast<int>(best.size()) == count) break;
  }
  return best;
}

EdgeTrackerOptions LookOptions(const Camera& camera, const RobotFinderOptions::Knowledge& knowledge) {
  EdgeTrackerOptions options;
  options.first_look.lock->range_px = std::max(10.0, knowledge.lock_range_px * camera.width_px / 1280);
  options.model_errors = {knowledge.camera_m, knowledge.camera_rad, 0.02, 0.1};
  options.leg_m = knowledge.leg_m;
  options.least_first_edges = knowledge.least_edges;
  options.least_first_share = knowledge.least_share;
  return options;
}

class Finder {
 public:
  Finder(const GrayImage& image, const ModelledView& home, const RobotFinderOptions& options)
      : image_(image), home_(home), options_(options), field_(image) {
    spread_ = BestApart(SpreadCandidates(field_, home_, options.candidates), options.climbs);
  }

  FoundRobot FindWith(const RobotFinderOptions::Knowledge& knowledge) const {
    std::mt19937_64 generator(1);
    std::vector<Candidate> climbed;
    for (const Candidate& candidate : spread_)
      climbed.push_back(Climb(field_, candidate, knowledge, generator));
    std::vector<Sighting> sightings;
    int looks = 0;
    for (const Candidate& candidate : BestApart(std::move(climbed), options_.looks)) {
      ++looks;
      if (auto sighting = LookAt(candidate, knowledge)) sightings.push_back(std::move(*sighting));
    }
    return Decide(std::move(sightings), looks);
  }

 private:
  struct Sighting {
    ModelledView view;
    SeenEdges seen;
    double score = 0;
  };

  std::optional<Sighting> LookAt(const Candidate& candidate,
                                 const RobotFinderOptions::Knowledge& knowledge) const {
    const Rigid3& pose = candidate.view.base_from_platform;
    EdgeTracker tracker(home_.robot, home_.camera, home_.camera_from_base,
                        LookOptions(home_.camera, knowledge));
    Sighting sighting{{}, tracker.Track(image_, 0, pose).seen, 0};
    if (sighting.seen.edges.empty()) return std::nullopt;
    sighting.view = tracker.Corrected(pose);
    sighting.score = ScoreOf(field_, sighting.view);
    if (!IsWithinRanges(sighting.view)) return std::nullopt;  // no robot of this kind stands like that
    return sighting;
  }

  // A wrong pose may agree with most of its edges, for six legs leave no pose of the platform impossible:
  // then it has a leg where there is none, and none where there is one.
  static FoundRobot Decide(std::vector<Sighting> sightings, int looks) {
    FoundRobot found;
    found.candidates_looked_at = looks;
    if (sightings.empty()) {
      found.reason = fmt::format(
          "shows no robot: of the {} poses that look most like it none has its legs' edges where there are "
          "edges",
          looks);
      return found;
    }
    const Sighting best =
        *std::max_element(sightings.begin(), sightings.end(),
                          [](const Sighting& a, const Sighting& b) { return a.score < b.score; });
    for (const Sighting& other : sightings) {
      if (other.score < kSurelyWorse * best.score || HaveSameEdges(other, best)) continue;
      found.status = RobotFinderStatus::kAmbiguous;
      found.reason = "shows edges that fit more than one pose";
      return found;
    }
    found.status = RobotFinderStatus::kFound;
    found.seen = best.seen;
    found.base_from_platform = best.view.base_from_platform;
    found.camera_from_base = best.view.camera_from_base;
    return found;
  }

  // Whatever edges both have are the same lines in the image.
  static bool HaveSameEdges(const Sighting& a, const Sighting& b) {
    const double same = kSameEdge * a.view.camera.width_px / a.view.camera.fx_px;
    for (const SeenEdge& in_a : a.seen.edges)
      for (const SeenEdge& in_b : b.seen.edges) {
        if (in_a.leg != in_b.leg || in_a.edge != in_b.edge) continue;
        for (const Eigen::Vector2d& end : in_a.ends)
          if (std::abs(in_b.normal.dot(end.homogeneous())) / in_b.normal.head<2>().norm() > same)
            return false;
      }
    return true;
  }

  // With some room for a drawing's errors.
  static bool IsWithinRanges(const ModelledView& view) {
    constexpr double kRoom_m = 0.01;
    const Vector6d readings_m = InverseKinematics(view.robot, view.base_from_platform);
    for (Eigen::Index i = 0; i < kLegCount; ++i) {
      const auto& [shortest_m, longest_m] = view.robot.legs[static_cast<size_t>(i)].joint_range_m;
      if (readings_m[i] < shortest_m - kRoom_m || readings_m[i] > longest_m + kRoom_m) return false;
    }
    return true;
  }

  const GrayImage& image_;
  ModelledView home_;
  const RobotFinderOptions& options_;
  GradientField field_;
  std::vector<Candidate> spread_;
};

}  // namespace

void RobotFinderOptions::Check() const {
  if (candidates < 0 || climbs < 1 || looks < 1)
    throw std::invalid_argument("RobotFinderOptions: at least one climb and one look");
}

FoundRobot FindRobot(const GrayImage& image, const GoughStewart& robot, const Camera& camera,
                     const Rigid3& camera_from_base, const RobotFinderOptions& options) {
  options.Check();
  if (image.width != camera.width_px || image.height != camera.height_px)
    throw std::invalid_argument(fmt::format("FindRobot: an image of {} x {} px for a camera of {} x {} px",
                                            image.width, image.height, camera.width_px, camera.height_px));
  const Finder finder(image, {robot, camera, camera_from_base, robot.home}, options);
  FoundRobot found = finder.FindWith(options.calibrated);
  if (found.status == RobotFinderStatus::kNoRobot && options.tries_drawing)
    found = finder.FindWith(options.drawing);
  return found;
}

}  // namespace legible
