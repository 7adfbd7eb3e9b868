#include "datasets/image_folder.h"

#include <algorithm>
#include <cctype>

#include "datasets/input_error.h"

namespace legible {
namespace {

const std::set<std::string> kImageExtensions = {".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".pgm"};

}  // namespace

std::set<std::string> ImagesIn(const std::filesystem::path& folder) {
  std::error_code error;
  const std::filesystem::directory_iterator entries(folder, error);
  if (error)
    throw InputError(folder, 0, "cannot be listed: " + error.message(), "give it the right to be read");
  std::set<std::string> names;
  for (const std::filesystem::directory_entry& entry : entries) {
    std::string extension = entry.path().extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    if (kImageExtensions.contains(extension)) names.insert(entry.path().filename().string());
  }
  return names;
}

}  // namespace legible
