// Which of the indices in use orders poses as their errors do: Merlet's question (2006, section 4), asked of
// any robot.
#pragma once

#include <string>
#include <vector>

#include "accuracy/index_ranking.h"
#include "accuracy/pose_accuracy.h"

namespace legible {

// An index of a pose as a number that should grow with its errors.
struct ComparedIndex {
  std::string key;             // "condition.two", "determinant", …
  std::vector<double> values;  // of each pose, as reported
  Ranking by_position, by_rotation;
};

struct IndexComparison {
  std::vector<double> position_m, rotation_rad;  // largest errors of each pose, in the order given
  std::vector<ComparedIndex> indices;
};

// Of poses with errors and indices, two at least. Throws std::invalid_argument for fewer, or one without
// them.
IndexComparison CompareIndices(const std::vector<const PoseAccuracy*>& poses);

// Whether the index misranks less than kTrustedMisranked of the pairs of poses whose errors differ clearly;
// never where there is no such pair.
bool MayBeTrusted(const Ranking& ranking);

}  // namespace legible
