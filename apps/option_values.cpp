#include "apps/option_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "datasets/text.h"

namespace legible {

std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(separator, begin), text.size());
    parts.emplace_back(Trimmed(std::string_view(text).substr(begin, end - begin)));
    begin = end + 1;
  }
  return parts;
}

double ParseNumber(const std::string& text) {
  const std::optional<double> value = ParseFinite(text);
  if (!value) throw std::invalid_argument(fmt::format("\"{}\" is not a finite number", text));
  return *value;
}

double ParsePositive(const std::string& text) {
  const double value = ParseNumber(text);
  if (!(value > 0)) throw std::invalid_argument(fmt::format("{} is not more than 0", text));
  return value;
}

Vector6d ParseSix(const std::string& text, const std::string& what) {
  std::string blanks = text;
  std::replace(blanks.begin(), blanks.end(), ',', ' ');
  std::istringstream stream(blanks);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  if (words.size() != 6)
    throw std::invalid_argument(
        fmt::format("\"{}\" has {} numbers, not the six {}", text, words.size(), what));
  Vector6d pose;
  for (size_t i = 0; i < 6; ++i) pose[static_cast<Eigen::Index>(i)] = ParseNumber(words[i]);
  return pose;
}

Vector6d ParsePose(const std::string& text) { return ParseSix(text, "x y z rx ry rz"); }

std::vector<int> ParseLegs(const std::string& text, int most) {
  std::vector<int> legs;
  for (const std::string& part : Split(text, ',')) {
    const std::optional<int> leg = ParseInteger(part);
    if (!leg || *leg < 1 || *leg > most)
      throw std::invalid_argument(fmt::format("\"{}\" is no leg: legs count from 1 to {}", part, most));
    if (std::find(legs.begin(), legs.end(), *leg - 1) != legs.end())
      throw std::invalid_argument(fmt::format("leg {} is named twice", *leg));
    legs.push_back(*leg - 1);
  }
  return legs;
}

}  // namespace legible
