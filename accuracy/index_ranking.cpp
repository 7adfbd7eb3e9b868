#include "accuracy/index_ranking.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

namespace legible {
namespace {

int Sign(double a, double b) { return (a > b) - (a < b); }

void DemandComparable(const std::vector<double>& a, const std::vector<double>& b) {
  const auto is_nan = [](double value) { return std::isnan(value); };
  if (a.size() != b.size() || std::any_of(a.begin(), a.end(), is_nan) ||
      std::any_of(b.begin(), b.end(), is_nan))
    throw std::invalid_argument("KendallTau: lists of different lengths, or with NaN");
}

double RatioOf(const Inversion& inversion, const std::vector<double>& errors) {
  return errors[inversion.preferred] / errors[inversion.rejected];
}

// The largest ratios, no item twice: else one bad pose would fill the list.
std::vector<Inversion> Worst(std::vector<Inversion> all, const std::vector<double>& errors, size_t count) {
  std::stable_sort(all.begin(), all.end(),
                   [&](const auto& a, const auto& b) { return RatioOf(a, errors) > RatioOf(b, errors); });
  std::vector<Inversion> worst;
  std::set<size_t> named;
  for (const Inversion& inversion : all) {
    if (worst.size() == count) break;
    if (named.count(inversion.preferred) + named.count(inversion.rejected) > 0) continue;
    named.insert({inversion.preferred, inversion.rejected});
    worst.push_back(inversion);
  }
  return worst;
}

}  // namespace

double KendallTau(const std::vector<double>& a, const std::vector<double>& b) {
  DemandComparable(a, b);
  double agreement = 0, untied_a = 0, untied_b = 0;
  for (size_t i = 0; i < a.size(); ++i)
    for (size_t j = 0; j < i; ++j) {
      const int of_a = Sign(a[i], a[j]), of_b = Sign(b[i], b[j]);
      agreement += of_a * of_b;
      untied_a += of_a != 0;
      untied_b += of_b != 0;
    }
  return untied_a > 0 && untied_b > 0 ? agreement / std::sqrt(untied_a * untied_b) : 0;
}

Ranking RankAgainstErrors(const std::vector<double>& badness, const std::vector<double>& errors,
                          size_t worst_count) {
  Ranking ranking;
  ranking.tau = KendallTau(badness, errors);
  std::vector<Inversion> inversions;
  size_t misranked = 0;
  for (size_t i = 0; i < errors.size(); ++i)
    for (size_t j = 0; j < i; ++j) {
      const size_t larger = errors[i] > errors[j] ? i : j, smaller = i + j - larger;
      const int told = Sign(badness[larger], badness[smaller]);
      if (told < 0 && errors[larger] > errors[smaller]) inversions.push_back({larger, smaller});
      if (!(errors[larger] > (1 + kClearDifference) * errors[smaller])) continue;
      ++ranking.clear_pairs;
      misranked += told <= 0;
    }
  if (ranking.clear_pairs > 0)
    ranking.misranked = static_cast<double>(misranked) / static_cast<double>(ranking.clear_pairs);
  ranking.worst = Worst(std::move(inversions), errors, worst_count);
  return ranking;
}

}  // namespace legible
