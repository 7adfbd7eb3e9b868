// The Adept Quattro of Briot et al. (2016), section 5 and Appendix B: the geometry that agrees best with its
// published assembly modes, and what becomes of the published simulations with it.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/robots/parallel_robot.h"

namespace legible {

// What Appendix B leaves open. At phi = 0 the platform's halves have the points D_1 = P + (x, -y), D_2 = P +
// (x, y); D_2 turns about D_1 on a circle of radius `arm`, about a centre that is (0, 2 y - arm) from D_1.
struct QuattroPlatform {
  double x_m = 0, y_m = 0, arm_m = 0;
};

// Appendix B, as datasets/robots/quattro.yaml has it, with that platform.
ParallelRobot Quattro(const QuattroPlatform& platform);

struct PublishedMode {
  std::vector<int> legs;  // from 0
  Eigen::Vector3d position_m;
};
// Section 5.1.3, solutions 2 to 4 for both pairs; solution 1 is the goal itself.
std::vector<PublishedMode> PublishedModes();
inline const Eigen::Vector3d kPublishedGoal_m(-0.2, 0, -0.56);

// The mode of the robot nearest to the published one.
Rigid3 NearestMode(const ParallelRobot& robot, const PublishedMode& published);

struct FittedPlatform {
  QuattroPlatform platform;
  double rms_m = 0;  // of a coordinate of a mode
};
// Least squares over the coordinates of the published modes.
FittedPlatform FitPlatform(const QuattroPlatform& start);

// Markdown.
std::string ModesTable(const ParallelRobot& robot);
std::string ConvergenceTable(const ParallelRobot& robot);
std::string AccuracyTable(const ParallelRobot& robot);
// Where a servo of all four legs ends between poses drawn over the workspace (fixed seed).
std::string EndsTable(const ParallelRobot& robot);

}  // namespace legible
