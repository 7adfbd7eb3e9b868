// The web pages around a report's data, built from the sources in this folder.
#pragma once

#include <string_view>

namespace legible {

struct PageTemplate {
  std::string_view before_data;  // up to the inside of the script element that holds the data
  std::string_view after_data;
};

PageTemplate CalibrationPage();
PageTemplate AccuracyPage();
PageTemplate ServoPage();
PageTemplate IntrinsicsPage();
PageTemplate LegsPage();

}  // namespace legible
