// Where a command writes for people and other programs.
#pragma once

#include <ostream>

namespace legible {

struct Console {
  std::ostream& out;             // the result
  std::ostream& err;             // messages, warnings, progress
  bool err_is_terminal = false;  // a line may rewrite itself
};

}  // namespace legible
