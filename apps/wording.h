// How counts, legs and warnings are put into words.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cctype>
#include <string>
#include <string_view>
#include <vector>

namespace legible {

// "1 image", "2 images".
inline std::string Plural(int count, const std::string& noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

// Legs as people count them, from 1.
inline std::vector<int> FromOne(std::vector<int> legs) {
  for (int& leg : legs) ++leg;
  return legs;
}

// "1,2,6", of legs that count from 0.
inline std::string LegNumbers(const std::vector<int>& legs, std::string_view between = ",") {
  return fmt::format("{}", fmt::join(FromOne(legs), between));
}

// Of legs (from 0) of which it is not proved, for a reason, where a servo by them ends.
inline std::string NotProvedText(const std::vector<int>& legs, const std::string& why) {
  return fmt::format("legs {} are not proved to lead to the goal: {}", LegNumbers(legs), why);
}

// With its first letter in capitals.
inline std::string Capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

// A line for each warning.
inline std::string WarningsText(const std::vector<std::string>& warnings) {
  std::string text;
  for (const std::string& sentence : warnings) text += fmt::format("legible: warning: {}\n", sentence);
  return text;
}

}  // namespace legible
