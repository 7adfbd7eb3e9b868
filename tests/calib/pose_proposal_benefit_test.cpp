// How many images proposed poses save against random ones.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include "calib/pose_proposal.h"
#include "core/stopwatch.h"
#include "tests/calib/random_rigs.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

constexpr int kRigs = 20;
constexpr int kLeastImages = 10, kMostImages = 24;  // of a session in random poses
constexpr int kRandomSessions = 5;                  // of each rig; their median counts
constexpr std::uint64_t kRandomSeed = 1000;         // of the first; the candidates' is 1
constexpr double kLever_m = 0.195;                  // the platform's radius

double MedianOf(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

LegCalibrationInput InputOf(const RigModel& model) {
  LegCalibrationInput input{model.robot, model.camera, model.camera_from_base, {}, {}, std::nullopt};
  input.known.joint_reading_m = 2e-5;
  input.known.radius_m = 5e-4;
  return input;
}

// One standard deviation of what a calibration's model predicts; infinite where that is open.
struct Sigmas {
  double position_m = INFINITY, rotation_rad = INFINITY;

  double Pose_m() const { return std::hypot(position_m, kLever_m * rotation_rad); }
};
// After 1, 2, … images.
using Course = std::vector<Sigmas>;

// What calibrations of a growing session would state at the truth.
class Judge {
 public:
  explicit Judge(const RandomRig& rig) : proposer_(InputOf(rig.truth), {}, WithCandidates(1)) {}

  void Add(const ImageObservation& image) {
    proposer_.Add(image);
    const ExpectedSigma expected = proposer_.Expected();
    course_.push_back({expected.position_m.value_or(INFINITY), expected.rotation_rad.value_or(INFINITY)});
  }
  const Course& course() const { return course_; }

 private:
  static PoseProposalOptions WithCandidates(int count) {
    PoseProposalOptions options;
    options.candidates.count = count;
    return options;
  }

  PoseProposer proposer_;
  Course course_;
};

Course RandomCourse(const RandomRig& rig, std::uint64_t seed) {
  PoseCandidateOptions options;
  options.count = kMostImages;
  options.seed = seed;
  Judge judge(rig);
  for (const PoseCandidate& pose : DrawPoseCandidates(rig.guess, options).poses)
    judge.Add(SeenIn(rig, pose.base_from_platform, options.edges));
  return judge.course();
}

// The sigmas of several random sessions of a rig, and in how many images proposed poses reach their median.
class Comparison {
 public:
  explicit Comparison(const RandomRig& rig) {
    random_.reserve(kRandomSessions);
    for (std::uint64_t i = 0; i < kRandomSessions; ++i) random_.push_back(RandomCourse(rig, kRandomSeed + i));
    Propose(rig);
  }

  // Of the images that random poses need to reach the sigma that they have after `images`.
  template <typename F>
  double Share(int images, const F& sigma_of) const {
    std::vector<double> sigmas;
    sigmas.reserve(random_.size());
    for (const Course& course : random_) sigmas.push_back(sigma_of(course.at(images - 1)));
    const double sigma = MedianOf(sigmas);
    const auto reached = std::find_if(proposed_.begin(), proposed_.end(),
                                      [&](const Sigmas& after) { return sigma_of(after) <= sigma; });
    return static_cast<double>(reached - proposed_.begin() + 1) / images;
  }
  double set_up_s() const { return set_up_s_; }
  double slowest_s() const { return slowest_s_; }
  // Position sigma that the proposer, which only knows the drawing, states in the end, by that at the truth.
  double foretold() const { return foretold_; }

 private:
  void Propose(const RandomRig& rig) {
    const PoseProposalOptions options;
    const Stopwatch of_set_up;
    PoseProposer proposer(InputOf(rig.guess), {}, options);
    set_up_s_ = of_set_up.Seconds();
    Judge judge(rig);
    for (int i = 0; i < kMostImages; ++i) {
      const Stopwatch stopwatch;
      const auto proposal = proposer.Next();
      slowest_s_ = std::max(slowest_s_, stopwatch.Seconds());
      const ImageObservation seen =
          SeenIn(rig, proposal.value().base_from_platform, options.candidates.edges);
      proposer.Add(seen);
      judge.Add(seen);
    }
    proposed_ = judge.course();
    foretold_ = proposer.Expected().position_m.value_or(INFINITY) / proposed_.back().position_m;
  }

  std::vector<Course> random_;
  Course proposed_;
  double set_up_s_ = 0, slowest_s_ = 0, foretold_ = 0;
};

// Over rigs: tenth, median, nine tenths.
struct Spread {
  explicit Spread(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const auto at = [&](double share) {
      return values[static_cast<size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
    };
    low = at(0.1);
    median = at(0.5);
    high = at(0.9);
  }
  double low, median, high;
};
std::string Text(const Spread& spread) {
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", spread.median, spread.low, spread.high);
}

TEST(PoseProposal, NeedsAtMostSixtyPercentOfTheImagesThatRandomPosesNeed) {
  std::mt19937_64 generator = TestGenerator();
  std::vector<Comparison> rigs;
  rigs.reserve(kRigs);
  for (int i = 0; i < kRigs; ++i) rigs.emplace_back(DrawRig(generator));
  const auto pose = [](const Sigmas& sigmas) { return sigmas.Pose_m(); };
  const auto position = [](const Sigmas& sigmas) { return sigmas.position_m; };
  const auto rotation = [](const Sigmas& sigmas) { return sigmas.rotation_rad; };
  const auto shares = [&](int images, const auto& sigma_of) {
    std::vector<double> of_rigs;
    of_rigs.reserve(rigs.size());
    for (const Comparison& rig : rigs) of_rigs.push_back(rig.Share(images, sigma_of));
    return of_rigs;
  };
  std::vector<double> all;
  std::cout << "share of images needed, median (10 % to 90 %) of " << kRigs << " rigs\n"
            << "random images | pose | position | rotation\n";
  for (int images = kLeastImages; images <= kMostImages; ++images) {
    const std::vector<double> of_pose = shares(images, pose);
    all.insert(all.end(), of_pose.begin(), of_pose.end());
    std::cout << fmt::format("{} | {} | {} | {}\n", images, Text(Spread(of_pose)),
                             Text(Spread(shares(images, position))), Text(Spread(shares(images, rotation))));
  }
  std::vector<double> set_up_s, slowest_s, foretold;
  for (std::vector<double>* values : {&set_up_s, &slowest_s, &foretold}) values->reserve(rigs.size());
  for (const Comparison& rig : rigs) {
    set_up_s.push_back(rig.set_up_s());
    slowest_s.push_back(rig.slowest_s());
    foretold.push_back(rig.foretold());
  }
  std::cout << fmt::format("all | {}\nset-up {:.2f} s, slowest proposal {:.3f} s (medians)\n",
                           Text(Spread(all)), MedianOf(set_up_s), MedianOf(slowest_s));
  std::cout << "sigma foretold from the drawing by that at the truth: " << Text(Spread(foretold))
            << std::endl;
  EXPECT_LE(Spread(all).median, 0.6);
  EXPECT_NEAR(Spread(foretold).median, 1, 0.1);
}

}  // namespace
}  // namespace legible
