// Programs that have the last word on their own formats, run as a user runs them.
#pragma once

#include <array>
#include <cstdio>
#include <string>

namespace legible {

struct ProgramOutput {
  int exit_code = -1;
  std::string out;  // with what went to standard error
};

inline ProgramOutput RunShell(const std::string& command) {
  ProgramOutput output;
  FILE* pipe = popen(("(" + command + ") 2>&1").c_str(), "r");
  if (pipe == nullptr) return output;
  std::array<char, 4096> buffer;
  for (size_t read = 0; (read = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    output.out.append(buffer.data(), read);
  const int status = pclose(pipe);
  output.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return output;
}

}  // namespace legible
