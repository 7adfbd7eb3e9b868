#include "apps/board_fit_settings.h"

namespace legible {

std::vector<std::string> OptionWords(const BoardFitSettings& settings) {
  std::vector<std::string> words;
  if (settings.estimates_warp) words.emplace_back("--board-warp");
  if (settings.trusts_all) words.emplace_back("--all-corners");
  return words;
}

}  // namespace legible
