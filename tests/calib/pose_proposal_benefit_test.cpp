// How many images proposed poses save against random ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>

#include "calib/pose_proposal.h"
#include "core/stopwatch.h"
#include "tests/calib/random_rigs.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

constexpr int kRigs = 20;
constexpr int kLeastImages = 10, kMostImages = 24;  // of a session in random poses
constexpr int kRandomSessions = 5;                  // of each rig; their median counts

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

// What calibrations of growing sessions would state, if they ended at the truth.
class Judge {
 public:
  explicit Judge(const RandomRig& rig) : proposer_(InputOf(rig.truth), {}, Options()) {}

  void Add(const ImageObservation& image) { proposer_.Add(image); }
  // Position error of predicted poses, m; infinite where it is open.
  double Position() const { return proposer_.Expected().position_m.value_or(INFINITY); }
  double Rotation() const { return proposer_.Expected().rotation_rad.value_or(INFINITY); }

 private:
  static PoseProposalOptions Options() {
    PoseProposalOptions options;
    options.candidates.count = 1;
    return options;
  }
  PoseProposer proposer_;
};

// Sigmas after 1, 2, … images.
struct Course {
  std::vector<double> position_m, rotation_rad;
  void Note(const Judge& judge) {
    position_m.push_back(judge.Position());
    rotation_rad.push_back(judge.Rotation());
  }
};

Course RandomCourse(const RandomRig& rig, std::uint64_t seed) {
  PoseCandidateOptions options;
  options.count = kMostImages;
  options.seed = seed;
  Judge judge(rig);
  Course course;
  for (const PoseCandidate& pose : DrawPoseCandidates(rig.guess, options).poses) {
    judge.Add(SeenIn(rig, pose.base_from_platform, options.edges));
    course.Note(judge);
  }
  return course;
}

Course ProposedCourse(const RandomRig& rig, double& seconds_a_proposal) {
  PoseProposalOptions options;
  if (getenv("CANDS")) options.candidates.count = atoi(getenv("CANDS"));
  const Stopwatch set;
  PoseProposer proposer(InputOf(rig.guess), {}, options);
  if (getenv("V")) printf("set-up %.2f s, drawn %d reach- %d sight- %d\n", set.Seconds(), proposer.candidates().drawn, proposer.candidates().out_of_reach, proposer.candidates().out_of_sight);
  Judge judge(rig);
  Course course;
  double seconds = 0;
  for (int i = 0; i < kMostImages; ++i) {
    const Stopwatch stopwatch;
    const auto proposal = proposer.Next();
    seconds += stopwatch.Seconds();
    if (!proposal) break;
    const ImageObservation seen = SeenIn(rig, proposal->base_from_platform, options.candidates.edges);
    proposer.Add(seen);
    judge.Add(seen);
    course.Note(judge);
  }
  seconds_a_proposal = seconds / kMostImages;
  return course;
}

double ImagesTo(double sigma, const std::vector<double>& course) {
  return 1.0 + static_cast<double>(std::find_if(course.begin(), course.end(), [&](double x) { return x <= sigma; }) -
                                   course.begin());
}

TEST(PoseProposal, NeedsAtMostSixtyPercentOfTheImagesThatRandomPosesNeed) {
  std::mt19937_64 generator = TestGenerator();
  std::map<int, std::vector<double>> ratios, rotation_ratios;
  std::vector<double> all, all_rotation, seconds;
  for (int i = 0; i < kRigs; ++i) {
    const RandomRig rig = DrawRig(generator);
    std::vector<Course> random;
    for (int k = 0; k < kRandomSessions; ++k) random.push_back(RandomCourse(rig, 1000 + k));
    double s = 0;
    const Course proposed = ProposedCourse(rig, s);
    seconds.push_back(s);
    for (int n = kLeastImages; n <= kMostImages; ++n) {
      std::vector<double> p, r;
      for (const Course& c : random) {
        p.push_back(c.position_m.at(n - 1));
        r.push_back(c.rotation_rad.at(n - 1));
      }
      ratios[n].push_back(ImagesTo(MedianOf(p), proposed.position_m) / n);
      rotation_ratios[n].push_back(ImagesTo(MedianOf(r), proposed.rotation_rad) / n);
      all.push_back(ratios[n].back());
      all_rotation.push_back(rotation_ratios[n].back());
      if (getenv("V") && (n == 10 || n == 16 || n == 24))
        printf("rig %d n %d random %.1f um proposed %.1f um\n", i, n, 1e6 * MedianOf(p), 1e6 * proposed.position_m[n - 1]);
    }
    printf("rig %d s/proposal %.3f\n", i, s);
    fflush(stdout);
  }
  for (auto& [n, r] : ratios) {
    std::sort(r.begin(), r.end());
    printf("%2d images: %.2f (%.2f to %.2f), rotation %.2f\n", n, MedianOf(r), r[r.size() / 10], r[r.size() * 9 / 10],
           MedianOf(rotation_ratios[n]));
  }
  printf("all %.3f rotation %.3f\n", MedianOf(all), MedianOf(all_rotation));
  EXPECT_LE(MedianOf(all), 0.6);
}

}  // namespace
}  // namespace legible
