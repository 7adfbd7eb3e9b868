// Checks of option values that the commands share; their messages name what is allowed.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace legible {

inline constexpr int kMostThreads = 1024;

CLI::ValidationError NoneOf(const std::string& option, const std::string& value,
                            const std::vector<std::string>& names);

// Throws that unless `value` is one of `names`.
void DemandOneOf(const std::string& option, const std::string& value, const std::vector<std::string>& names);

// A whole number of at most 9 digits, so that it fits into any of our types.
bool IsWholeNumber(const std::string& text);

// A check for CLI::Option::check.
std::function<std::string(const std::string&)> WholeNumberFrom(int least);

// "--threads", one a processor unless given.
void AddThreadsOption(CLI::App& command, int& threads);

}  // namespace legible
