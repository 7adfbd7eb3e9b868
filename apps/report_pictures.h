// Pictures for a page that has nothing beside it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/vision/gray_image.h"

namespace legible {

// The images as grey JPEG in "data:" addresses, empty where a file cannot be read. Works on `threads` at a
// time.
std::vector<std::string> EmbedPictures(const std::vector<std::filesystem::path>& files, int threads);

std::string EmbedPicture(const GrayImage& image);

}  // namespace legible
