// tags.yaml: rigid groups of fiducial tags on the base or the platform.
#pragma once

#include <filesystem>

#include "core/session/session.h"

namespace legible {

// Throws InputError for what is no tag layout: a family that libapriltag does not have, an id or a group's
// name given twice, a tag without area, a placement whose sigma is missing or not positive.
TagLayout ReadTags(const std::filesystem::path& file);

// Writes so that ReadTags gives back the same bits. Throws InputError if the file cannot be written and
// std::invalid_argument if a number is not finite.
void WriteTags(const std::filesystem::path& file, const TagLayout& tags);

}  // namespace legible
