// How a camera is fitted to a board's corners, as the user of several commands asks for it.
#pragma once

#include <string>
#include <vector>

namespace legible {

struct BoardFitSettings {
  bool estimates_warp = false;  // --board-warp
  bool trusts_all = false;      // --all-corners
};

// What is not as without options, as it would be typed.
std::vector<std::string> OptionWords(const BoardFitSettings& settings);

}  // namespace legible
