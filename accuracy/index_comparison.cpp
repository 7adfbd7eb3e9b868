#include "accuracy/index_comparison.h"

#include <cmath>
#include <functional>
#include <stdexcept>

namespace legible {
namespace {

constexpr size_t kWorstInversions = 3;

// What an index says of a pose, and whether its large values are the good ones.
struct IndexDefinition {
  std::string key;
  bool is_better_when_larger = false;
  std::function<double(const Indices&)> value;
};

std::vector<IndexDefinition> Definitions(bool has_three_point) {
  std::vector<IndexDefinition> all = {
      {"determinant", true, [](const Indices& i) { return std::abs(i.determinant); }},
      {"manipulability", false, [](const Indices& i) { return i.manipulability; }},
      {"condition.two", false, [](const Indices& i) { return i.plain.two; }},
      {"condition.frobenius", false, [](const Indices& i) { return i.plain.frobenius; }},
      {"condition.infinity", false, [](const Indices& i) { return i.plain.infinity; }},
      {"condition.frobenius_of_gram", false, [](const Indices& i) { return i.plain.frobenius_of_gram; }},
      {"condition.two_normalized", false, [](const Indices& i) { return i.normalized.two; }},
      {"condition.frobenius_normalized", false, [](const Indices& i) { return i.normalized.frobenius; }},
      {"condition.infinity_normalized", false, [](const Indices& i) { return i.normalized.infinity; }},
  };
  all.push_back({"condition.frobenius_of_gram_normalized", false,
                 [](const Indices& i) { return i.normalized.frobenius_of_gram; }});
  if (has_three_point) {
    all.push_back(
        {"condition.two_three_point", false, [](const Indices& i) { return i.three_point->two.largest; }});
    all.push_back({"condition.frobenius_three_point", false,
                   [](const Indices& i) { return i.three_point->frobenius_of_gram.largest; }});
    all.push_back({"condition.frobenius_three_point_plain", false,
                   [](const Indices& i) { return i.three_point->frobenius.largest; }});
  }
  return all;
}

}  // namespace

IndexComparison CompareIndices(const std::vector<const PoseAccuracy*>& poses) {
  if (poses.size() < 2) throw std::invalid_argument("CompareIndices: give two poses at least");
  IndexComparison comparison;
  for (const PoseAccuracy* pose : poses) {
    if (!pose->max_error || !pose->indices)
      throw std::invalid_argument("CompareIndices: a pose without errors");
    comparison.position_m.push_back(pose->max_error->position_m());
    comparison.rotation_rad.push_back(pose->max_error->rotation_rad());
  }
  for (const IndexDefinition& definition : Definitions(poses.front()->indices->three_point.has_value())) {
    ComparedIndex index{definition.key, {}, {}, {}};
    std::vector<double> badness;
    for (const PoseAccuracy* pose : poses) {
      index.values.push_back(definition.value(*pose->indices));
      badness.push_back(definition.is_better_when_larger ? -index.values.back() : index.values.back());
    }
    index.by_position = RankAgainstErrors(badness, comparison.position_m, kWorstInversions);
    index.by_rotation = RankAgainstErrors(badness, comparison.rotation_rad, kWorstInversions);
    comparison.indices.push_back(std::move(index));
  }
  return comparison;
}

bool MayBeTrusted(const Ranking& ranking) {
  return ranking.clear_pairs >= kLeastClearPairs && ranking.misranked < kTrustedMisranked;
}

}  // namespace legible
