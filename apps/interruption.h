// Ctrl-C while something moves: it ends in order instead of the process.
#pragma once

namespace legible {

// While it lives, SIGINT, SIGTERM, SIGHUP (a terminal that is closed) and SIGQUIT are noted instead of ending
// the process. One at a time.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  bool HasCome() const;
};

}  // namespace legible
