#include "apps/option_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>
#include <thread>

#include "apps/calibrate_settings.h"

namespace legible {

CLI::ValidationError NoneOf(const std::string& option, const std::string& value,
                            const std::vector<std::string>& names) {
  return CLI::ValidationError(option, fmt::format("\"{}\" is none of {}", value, fmt::join(names, ", ")));
}

void DemandOneOf(const std::string& option, const std::string& value, const std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), value) == names.end()) throw NoneOf(option, value, names);
}

bool IsWholeNumber(const std::string& text) {
  return !text.empty() && text.size() <= 9 && text.find_first_not_of("0123456789") == std::string::npos;
}

std::function<std::string(const std::string&)> WholeNumberFrom(int least) {
  return [least](const std::string& text) {
    if (IsWholeNumber(text) && std::stoi(text) >= least) return std::string();
    return least > 0 ? fmt::format("give a whole number from {}, of at most 9 digits", least)
                     : std::string("give a whole number of at most 9 digits");
  };
}

CLI::Option* AddText(CLI::App& command, const std::string& name, const std::string& type,
                     const std::function<void(const std::string&)>& take, const std::string& description) {
  const auto take_or_refuse = [name, take](const std::string& text) {
    try {
      take(text);
    } catch (const std::invalid_argument& error) {
      throw CLI::ValidationError(name, error.what());
    }
  };
  return command.add_option_function<std::string>(name, take_or_refuse, description)->type_name(type);
}

void AddKnownOption(CLI::App& command, std::vector<std::pair<std::string, std::optional<double>>>& known,
                    const std::string& description) {
  const auto take = [&known](const std::vector<std::string>& texts) {
    try {
      known.clear();
      for (const std::string& text : texts) known.push_back(ParseKnown(text));
    } catch (const std::invalid_argument& error) {
      throw CLI::ValidationError("--known", error.what());
    }
  };
  command
      .add_option_function<std::vector<std::string>>(
          "--known", take,
          fmt::format("{}\nComma separated or repeated. Names:\n{}", description,
                      fmt::join(KnownNames(), "\n")))
      ->type_name("NAME=SIGMA")
      ->delimiter(',')
      ->allow_extra_args(false);
}

std::vector<CLI::Option*> AddBoardFitOptions(CLI::App& command, BoardFitSettings& settings) {
  return {
      command.add_flag("--board-warp", settings.estimates_warp,
                       "Estimate by how much the board is bent as well"),
      command.add_flag("--all-corners", settings.trusts_all,
                       "Every corner of the board counts alike, however far\noff: no weights, no outliers")};
}

void AddFormat(CLI::App& command, const std::vector<std::string>& names,
               const std::function<void(size_t)>& take, const std::string& description) {
  const auto take_name = [names, take](const std::string& format) {
    DemandOneOf("--format", format, names);
    take(static_cast<size_t>(std::find(names.begin(), names.end(), format) - names.begin()));
  };
  command.add_option_function<std::string>("--format", take_name, description)
      ->type_name(fmt::format("{}", fmt::join(names, "|")));
}

void AddTableOrJson(CLI::App& command, bool& prints_json, const std::string& description) {
  AddFormat(
      command, {"table", "json"}, [&prints_json](size_t format) { prints_json = format == 1; }, description);
}

void AddThreadsOption(CLI::App& command, int& threads) {
  threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  command.add_option("--threads", threads, "How many threads work at a time;\nwithout it one a processor")
      ->check(CLI::Range(1, kMostThreads).description(""))
      ->type_name("N");
}

}  // namespace legible
