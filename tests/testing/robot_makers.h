// Makers of random robots of one family each, for tests that go through several.
#pragma once

#include <functional>
#include <random>
#include <string>
#include <vector>

#include "tests/testing/random_robots.h"

namespace legible {

using RobotMaker = std::function<RobotAtPose(std::mt19937_64&)>;

inline RobotMaker Planar(const std::vector<std::string>& chains) {
  return [chains](std::mt19937_64& generator) { return RandomPlanarRobot(generator, chains); };
}
inline RobotMaker Spatial(const std::vector<std::string>& chains) {
  return [chains](std::mt19937_64& generator) { return RandomSpatialRobot(generator, chains); };
}
inline RobotMaker Delta(const char* chain) {
  return [chain](std::mt19937_64& generator) {
    return RandomTranslationRobot(generator, {chain, chain, chain});
  };
}
inline RobotMaker Quattro(const char* chain) {
  return [chain](std::mt19937_64& generator) { return RandomSchoenfliesRobot(generator, chain); };
}

}  // namespace legible
