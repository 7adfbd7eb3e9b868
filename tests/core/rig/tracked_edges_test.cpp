// Edges followed in the images of a simulated rig.
#include "core/rig/tracked_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tests/core/rig/desktop_rig.h"
#include "tests/core/rig/moving_robot.h"

namespace legible {
namespace {

// A rig with its camera; the model knows it exactly or by its drawing.
struct FollowedRig {
  FollowedRig(const RobotAndDrawing& robot, const BelievedRobot& believed, const SimulationOptions& options)
      : scene(robot.truth, {}, 1),
        rig(robot.truth, options,
            [this](const Rigid3& pose, const std::vector<int>& covered, std::uint64_t frame) {
              return scene.Take(pose, covered, frame);
            }),
        source(rig, believed.robot, believed.camera, believed.camera_from_base, Options()) {}

  static EdgeTrackerOptions Options() {
    EdgeTrackerOptions options;
    options.first_look.lock->range_px = 120;
    return options;
  }

  SeenEdges See() {
    const StampedReadings readings = rig.ReadJoints();
    return source.See({readings.time_s, readings.joint_readings_m, speeds_m_per_s});
  }
  void Command(const Vector6d& speeds) {
    speeds_m_per_s = speeds;
    rig.CommandSpeeds(speeds);
  }

  SceneCamera scene;
  SimulatedRig rig;
  TrackedEdgeSource source;
  Vector6d speeds_m_per_s = Vector6d::Zero();
};

int CountOfLeg(const SeenEdges& seen, int leg) {
  return static_cast<int>(std::count_if(seen.edges.begin(), seen.edges.end(),
                                        [&](const SeenEdge& edge) { return edge.leg == leg; }));
}

Vector6d SmallWays(double time_s) {
  Vector6d speeds;
  for (Eigen::Index i = 0; i < 6; ++i) speeds[i] = 0.03 * std::sin(4 * time_s + static_cast<double>(i));
  return speeds;
}

TEST(TrackedEdges, OfALegThatComesOutOfHidingAreSeenAgainWithinThreeFrames) {
  for (const bool is_perfect : {true, false}) {
    SimulationOptions options;
    options.faults = {Fault{FaultKind::kLegCovered, 0.2, 0.5, 1}, Fault{FaultKind::kLegCovered, 0.3, 1.1, 4}};
    const RobotAndDrawing robot = DrawRobot(5, true);
    FollowedRig followed(robot, is_perfect ? robot.Perfect() : robot.drawing, options);
    std::map<int, int> frames_until_seen;
    int seen_though_covered = 0;
    for (int frame = 0; frame < 70; ++frame) {
      const double time_s = 0.02 * frame;
      followed.rig.WaitUntil(time_s);
      const SeenEdges seen = followed.See();
      followed.Command(SmallWays(time_s));
      const bool is_any_covered = time_s >= options.faults[0].from_s;  // a board may stand before others too
      for (const Fault& fault : options.faults) {
        const int of_leg = CountOfLeg(seen, fault.leg);
        if (fault.IsActiveAt(time_s)) {
          seen_though_covered += of_leg;  // what looks out beside the board
        } else if (time_s >= fault.until_s && of_leg < 2) {
          ++frames_until_seen[fault.leg];
        } else if (!is_any_covered) {
          EXPECT_EQ(of_leg, 2) << "leg " << fault.leg + 1 << " at " << time_s << " s";
        }
      }
      for (const SeenEdge& edge : seen.edges)
        EXPECT_LT(LargestOff(robot.truth, followed.rig.NewestFrame().base_from_platform,
                             is_perfect ? robot.truth.camera : robot.drawing.camera, edge),
                  1)
            << "leg " << edge.leg + 1 << " at " << time_s << " s";
    }
    EXPECT_LE(seen_though_covered, 5);  // of 110
    for (const auto& [leg, frames] : frames_until_seen) EXPECT_LE(frames, 3) << "leg " << leg + 1;
  }
}

TEST(TrackedEdges, AreTheSameAgainWhereNoNewerImageHasCome) {
  const RobotAndDrawing robot = DrawRobot(6, true);
  FollowedRig followed(robot, robot.Perfect(), WithFault(Fault{FaultKind::kFramesDropped, 0.05, 0.2}));
  std::vector<double> times_s;
  SeenEdges last;
  for (int frame = 0; frame < 13; ++frame) {
    followed.rig.WaitUntil(0.02 * frame);
    const SeenEdges seen = followed.See();
    if (seen.time_s == last.time_s && frame > 0) {
      ASSERT_EQ(seen.edges.size(), last.edges.size());
      for (size_t i = 0; i < seen.edges.size(); ++i) EXPECT_EQ(seen.edges[i].normal, last.edges[i].normal);
    } else {
      times_s.push_back(seen.time_s);
    }
    EXPECT_EQ(followed.source.newest()->seen.time_s, followed.source.image().time_s);
    last = seen;
  }
  ASSERT_EQ(times_s.size(), 6u);
  EXPECT_EQ(times_s[2], 0.04);
  EXPECT_EQ(times_s[3], 0.2);
}

// Though the robot moves on, and with it the place where the legs are expected: a supervisor must see it.
TEST(TrackedEdges, AreTheSameToTheLastBitWhereTheCameraRepeatsItsImage) {
  const RobotAndDrawing robot = DrawRobot(6, true);
  FollowedRig followed(robot, robot.Perfect(), WithFault(Fault{FaultKind::kFramesFrozen, 0.05}));
  followed.Command(Vector6d::Constant(0.02));
  SeenEdges frozen;
  for (int frame = 0; frame < 10; ++frame) {
    followed.rig.WaitUntil(0.02 * frame);
    const SeenEdges seen = followed.See();
    EXPECT_NEAR(seen.time_s, 0.02 * frame, 1e-9);
    if (frame > 3) {
      ASSERT_EQ(seen.edges.size(), frozen.edges.size());
      for (size_t i = 0; i < seen.edges.size(); ++i) EXPECT_EQ(seen.edges[i].normal, frozen.edges[i].normal);
    }
    frozen = seen;
  }
}

TEST(TrackedEdges, GoOnWhereReadingsAreNotNumbers) {
  const RobotAndDrawing robot = DrawRobot(7, true);
  FollowedRig followed(robot, robot.Perfect(), WithFault(Fault{FaultKind::kReadingsNan, 0.05, 0.1}));
  for (int frame = 0; frame < 8; ++frame) {
    followed.rig.WaitUntil(0.02 * frame);
    EXPECT_EQ(followed.See().edges.size(), 12u) << frame;
  }
}

}  // namespace
}  // namespace legible
