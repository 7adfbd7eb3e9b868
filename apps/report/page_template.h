// The web page around a report's data, built from the sources in this folder.
#pragma once

#include <string_view>

namespace legible {

std::string_view PageBeforeData();  // up to the inside of the script element that holds the data
std::string_view PageAfterData();

}  // namespace legible
