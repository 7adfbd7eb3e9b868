// Whether the board in the images is the one of its file.
#pragma once

#include <string>

#include "apps/intrinsics_run.h"

namespace legible {

// Throws InputError, with what the images show instead, where many of the tags that were read are not where
// the board's file has them, or are not in it.
void DemandAgreement(const IntrinsicsRun& run);

// Throws InputError where rows, columns or tags of the board were never seen: the file has too many.
void DemandWholeBoard(const IntrinsicsRun& run);

// Which other tags than the board's images without it show, as a sentence for people; empty where there are
// none, or the board has no tags.
std::string OtherTagsSeen(const IntrinsicsRun& run);

}  // namespace legible
