// model.yaml: the robot as calibrated, the camera, and how well they are known.
#pragma once

#include <filesystem>
#include <string>

#include "core/session/session.h"

namespace legible {

// Reads a model.yaml or a robot.yaml: it is a model if its "robot" is a section. A robot.yaml gives a model
// without camera, covariance and provenance. A section "simulation", which is the simulated rig's own
// (see datasets/simulation_file.h), is passed over. Throws InputError for what neither can hold, and for a
// covariance that is not finite, symmetric, of a non-negative diagonal and of the size of its parameter
// names.
CalibratedModel ReadModel(const std::filesystem::path& file);

// Whether the file is YAML with a "robot", as both are. Throws InputError if it cannot be read.
bool HoldsRobot(const std::filesystem::path& file);

// Whether the file is one that ReadModel is made for: a model, or the robot.yaml of a Gough-Stewart robot.
// Throws InputError if it cannot be read.
bool HoldsModel(const std::filesystem::path& file);

// Writes so that ReadModel gives back the same bits; of the covariance the lower triangle counts. Throws
// InputError if the file cannot be written and std::invalid_argument if the covariance is not square in the
// parameter names or a number is not finite.
void WriteModel(const std::filesystem::path& file, const CalibratedModel& model);

// The text that WriteModel writes, for files that hold more; throws std::invalid_argument as it does.
std::string ModelToYaml(const CalibratedModel& model);

}  // namespace legible
