#include "apps/progress.h"

#include <fmt/format.h>

namespace legible {

constexpr char kRewriteLine[] = "\r\x1b[K";  // to the line's start, and clear it

void ProgressLine::Show(const std::string& text) {
  if (!console_.err_is_terminal) return;
  const std::lock_guard lock(mutex_);
  console_.err << kRewriteLine << text << std::flush;
  is_shown_ = true;
}

void ProgressLine::Clear() {
  const std::lock_guard lock(mutex_);
  if (is_shown_) console_.err << kRewriteLine << std::flush;
  is_shown_ = false;
}

std::string StageText(const std::string& stage, int done, int total) {
  return total > 1 ? fmt::format("{} {} of {}", stage, done, total) : stage;
}

std::string IterationText(int iteration, double rms_px) {
  return fmt::format("solving, iteration {}: {:.3f} px", iteration, rms_px);
}

}  // namespace legible
