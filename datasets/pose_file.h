// poses.csv: poses by name.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry/rigid3.h"

namespace legible {

struct PoseRow {
  std::string name;      // that of the column `name`, or "1", "2", … by row
  Vector6d coordinates;  // x y z (m), then three orientation coordinates (rad) as whoever asks takes them
  int line = 0;          // from 1
};

// Reads the columns x, y, z, rx, ry, rz and, if there, name; or the same with units, x_m, …, rz_rad; in any
// order. A file whose first row is six numbers has no header. Blank lines and lines that begin with # are
// passed over. Throws InputError as ArrangeCsv does, for what is not a finite number, for a name given twice,
// and where there is no pose.
std::vector<PoseRow> ReadPoses(const std::filesystem::path& file);

}  // namespace legible
