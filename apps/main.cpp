#include <glog/logging.h>
#include <unistd.h>

#include <iostream>
#include <opencv2/core/utils/logger.hpp>

#include "apps/program.h"

int main(int argc, char** argv) {
  // What is wrong is said in one line, by the program itself.
  FLAGS_minloglevel = google::GLOG_FATAL;
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  const std::vector<std::string> arguments(argv + (argc > 0 ? 1 : 0), argv + argc);
  return legible::RunProgram(arguments, {std::cout, std::cerr, isatty(STDERR_FILENO) == 1});
}
