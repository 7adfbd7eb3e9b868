// Random parallel robots of every family, each with a pose that all its legs reach clearly: no leg is nearer
// to being stretched or folded than |u . t| = 0.1.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "core/robots/parallel_robot.h"

namespace legible {

struct RobotAtPose {
  ParallelRobot robot;
  Rigid3 pose;  // base_from_platform, of the motion that robot.home belongs to
};

// As many legs as chains, of about 1 m: two move a point, three a platform.
RobotAtPose RandomPlanarRobot(std::mt19937_64& generator, const std::vector<std::string>& chains);

// Of legs U_PS, R_PS, _PUS or _RUS that end in a platform of all six freedoms, less what RPS legs forbid.
RobotAtPose RandomSpatialRobot(std::mt19937_64& generator, const std::vector<std::string>& chains);

// Like a Delta: legs about a base of 0.3 m, their axes and rails tilted at random; the platform translates,
// in a random orientation. Legs U_PU, _R-{2-US}, _P-{2-US}, _RUU, _PUU.
RobotAtPose RandomTranslationRobot(std::mt19937_64& generator, const std::vector<std::string>& chains);

// Like a Quattro: four legs of that chain; the first two hold one half of the platform and the others the
// other, which turns.
RobotAtPose RandomSchoenfliesRobot(std::mt19937_64& generator, const std::string& chain);
// The same of four chains.
RobotAtPose RandomSchoenfliesRobot(std::mt19937_64& generator, const std::vector<std::string>& chains);

// A pose of the robot near the given one, moved by up to `displacement` m and rad in each of its freedoms.
Rigid3 RandomPoseNear(std::mt19937_64& generator, const ParallelRobot& robot, const Rigid3& pose,
                      double displacement);

// Unit vectors: in all directions, and across an axis.
Eigen::Vector3d RandomDirection(std::mt19937_64& generator);
Eigen::Vector3d RandomDirectionAcross(std::mt19937_64& generator, const Eigen::Vector3d& axis);

// All legs, from 0.
std::vector<int> AllLegs(const ParallelRobot& robot);

}  // namespace legible
