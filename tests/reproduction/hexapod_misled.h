// The 3-UPS hidden in a hexapod: a way on which a servo of three legs ends at another pose with all errors at
// zero, first by directions alone, then by `legible servo` with images; and what the choice of legs makes of
// it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/robots/gough_stewart.h"

namespace legible {

struct MisledWay {
  std::vector<int> legs;  // three, from 0
  Rigid3 from, to;        // within the joint ranges
  Rigid3 ends_at;
  double largest_error_rad = 0;
};

// Searches poses of the robot within its joint ranges (fixed seed): goals that have a second mode of three
// legs within the joint ranges, and starts near that other mode. Nothing where there is none in so many
// tries.
std::optional<MisledWay> FindMisledWay(const GoughStewart& robot, int tries);

// Markdown: the way, where the directions of three legs lead, and what the choice of legs makes of it.
std::string MisledTable(const GoughStewart& robot, const MisledWay& way);

// Markdown: the sets of legs whose start and goal are proved to be in one aspect, and whose servo ends in
// another mode all the same, which is proved to be in that aspect, too.
std::string OneAspectTable(const GoughStewart& robot, const MisledWay& way);

// Markdown: the same way by `legible servo` with images, by directions and by edges, with these legs and with
// the choice. Logs in the folder.
std::string MisledByImagesTable(const std::filesystem::path& folder, const MisledWay& way);

// Markdown: `legible servo --legs auto` with images on ways drawn at random, one a row. Logs in the folder.
std::string ChosenLegsTable(const std::filesystem::path& folder, const GoughStewart& robot);

}  // namespace legible
