// board.yaml: calibration boards, and Kalibr's target.yaml.
#pragma once

#include <filesystem>

#include "core/session/board.h"

namespace legible {

// The board of a file in this program's own form (with `board`) or in Kalibr's (with `target_type`); its name
// is the file's without folder and ending. Throws InputError for what is no board: unknown keys, a family
// that libapriltag does not have, ids that it does not have or that occur twice, tags that are no squares or
// overlap, lengths that are not those of a board, a kind that cannot be read (circles).
Board ReadBoard(const std::filesystem::path& file);

}  // namespace legible
