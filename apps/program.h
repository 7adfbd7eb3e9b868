// The program: chooses the command, and turns what goes wrong into one line and an exit code.
#pragma once

#include <string>
#include <vector>

#include "apps/console.h"

namespace legible {

// Exit codes of every command.
inline constexpr int kExitSuccess = 0;
inline constexpr int kExitNoResult = 1;  // no usable result, or standard output cannot be written
inline constexpr int kExitBadInput = 2;  // bad usage or bad input; nothing was written

// "0.1.0"
const char* ProgramVersion();

// Runs the program on its arguments (without the program's name) and returns the exit code. Never throws; bad
// usage and bad input give one line on `err`: "legible: what is wrong; what to do".
int RunProgram(const std::vector<std::string>& arguments, const Console& console);

}  // namespace legible
