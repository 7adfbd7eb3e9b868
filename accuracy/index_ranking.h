// Whether an index orders poses as their errors do.
#pragma once

#include <cstddef>
#include <vector>

namespace legible {

// Kendall's tau-b of two lists of equal length: 1 where both order all pairs alike, -1 where all the other
// way round, 0 where they have nothing to do with each other; pairs tied in either count in neither. 0 where
// either list is all ties. Throws std::invalid_argument for lists of different lengths or with NaN.
double KendallTau(const std::vector<double>& a, const std::vector<double>& b);

// Two items that the index puts in the wrong order.
struct Inversion {
  size_t preferred = 0;  // of smaller badness, though its error is larger
  size_t rejected = 0;
};

struct Ranking {
  double tau = 0;
  // Of the pairs whose errors differ by more than kClearDifference, the part that the index puts in the wrong
  // order or does not tell apart.
  double misranked = 0;
  size_t clear_pairs = 0;
  std::vector<Inversion> worst;  // the inversions of largest ratio of errors first, no item twice
};

inline constexpr double kClearDifference = 0.1;    // relative to the smaller error
inline constexpr size_t kLeastClearPairs = 30;     // on which a judgement may rest
inline constexpr double kTrustedMisranked = 0.01;  // an index that misranks fewer pairs may be trusted

// `badness` is the index, turned round where its large values are the good ones. Infinite badness is allowed;
// errors are positive and finite.
Ranking RankAgainstErrors(const std::vector<double>& badness, const std::vector<double>& errors,
                          size_t worst_count);

}  // namespace legible
