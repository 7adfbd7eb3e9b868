// The session folder: session.yaml, the files that it names, and the images.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/session/session.h"

namespace legible {

// Reads session.yaml in `folder`, the files that it names (relative to `folder`) and the list of images; the
// images themselves stay closed. Throws InputError for whatever is missing, unknown or impossible: besides
// the errors of each file an image of joints.csv that is not there, and a reading so far from its leg's range
// that it cannot be in metres.
Session ReadSession(const std::filesystem::path& folder);

// Writes session.yaml, robot.yaml, camera.yaml, joints.csv and, where the session has tags, tags.yaml into
// `folder`, which is created if need be; the images belong into `folder`/images. ReadSession gives back the
// same bits. Throws InputError if a file cannot be written and std::invalid_argument if a number is not
// finite.
void WriteSession(const std::filesystem::path& folder, const Session& session);

// SHA-256 of what the session was read from, 64 hexadecimal digits: that of the lines that
// `sha256sum FILE…` prints, run in the session's folder on session.yaml, the files that it names in the order
// robot, camera, joints, tags, and the images in the order of joints.csv, then in their own folders on `more`
// files, in that order. Throws InputError if one cannot be read and std::invalid_argument if the session does
// not come from ReadSession.
std::string ContentHash(const Session& session, const std::vector<std::filesystem::path>& more = {});

}  // namespace legible
