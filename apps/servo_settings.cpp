#include "apps/servo_settings.h"

#include <fmt/format.h>

#include <stdexcept>
#include <vector>

#include "apps/option_values.h"

namespace legible {

AdaptiveGain ParseGain(const std::string& text) {
  const std::vector<std::string> parts = Split(text, ':');
  if (parts.size() == 1) return AdaptiveGain::Constant(ParsePositive(parts[0]));
  if (parts.size() != 3)
    throw std::invalid_argument(
        fmt::format("\"{}\" is neither a gain nor AT_ZERO:FAR:SLOPE, as in 6:2:300", text));
  const AdaptiveGain gain{ParsePositive(parts[0]), ParsePositive(parts[1]), ParsePositive(parts[2])};
  gain.Check();
  return gain;
}

}  // namespace legible
