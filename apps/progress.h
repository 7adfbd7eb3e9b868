// One line on a terminal that says how far the work has come.
#pragma once

#include <mutex>
#include <string>

#include "apps/console.h"

namespace legible {

// Rewrites its line with every Show, from any thread, and leaves none behind. Silent where the console's
// `err` is no terminal.
class ProgressLine {
 public:
  explicit ProgressLine(const Console& console) : console_(console) {}
  ~ProgressLine() { Clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void Show(const std::string& text);
  void Clear();

 private:
  Console console_;
  std::mutex mutex_;
  bool is_shown_ = false;
};

// "finding edges 12 of 40"; a stage of one step is named without numbers.
std::string StageText(const std::string& stage, int done, int total);

// "solving, iteration 7: 0.052 px"
std::string IterationText(int iteration, double rms_px);

}  // namespace legible
