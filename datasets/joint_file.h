// joints.csv: one row an image, its name and the six joint readings.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry/rigid3.h"

namespace legible {

struct JointRow {
  std::string image;
  Vector6d readings_m;
  int line = 0;  // from 1
};

// Reads the columns image, q1_m, …, q6_m, named by the first row and in any order; blank lines and lines that
// begin with # are passed over. Throws InputError for a missing, repeated or further column, a row of another
// length, a reading that is not a finite number, an image without a name, with a folder in its name or named
// twice, and where there is no row ("no image").
std::vector<JointRow> ReadJoints(const std::filesystem::path& file);

// Writes so that ReadJoints gives back the same bits (`line` apart). Throws InputError if the file cannot be
// written and std::invalid_argument if a reading is not finite.
void WriteJoints(const std::filesystem::path& file, const std::vector<JointRow>& rows);

}  // namespace legible
