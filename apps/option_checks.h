// Checks of option values that the commands share; their messages name what is allowed.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/board_fit_settings.h"

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

// An option whose text `take` takes apart; what that throws as std::invalid_argument becomes the option's
// error. `type` stands in the help.
CLI::Option* AddText(CLI::App& command, const std::string& name, const std::string& type,
                     const std::function<void(const std::string&)>& take, const std::string& description);

// "--known NAME=SIGMA", comma separated or repeated, which the description need not say; nor the names.
void AddKnownOption(CLI::App& command, std::vector<std::pair<std::string, std::optional<double>>>& known,
                    const std::string& description);

// "--board-warp" and "--all-corners".
std::vector<CLI::Option*> AddBoardFitOptions(CLI::App& command, BoardFitSettings& settings);

// "--format" with these names; `take` gets the place of the one named among them.
void AddFormat(CLI::App& command, const std::vector<std::string>& names,
               const std::function<void(size_t)>& take, const std::string& description);

// "--format table|json".
void AddTableOrJson(CLI::App& command, bool& prints_json, const std::string& description);

// "--threads", one a processor unless given.
void AddThreadsOption(CLI::App& command, int& threads);

}  // namespace legible
