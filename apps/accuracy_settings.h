// What the user of `legible accuracy` asks for.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/workspace.h"
#include "apps/option_values.h"
#include "core/geometry/orientation.h"
#include "core/geometry/rigid3.h"

namespace legible {

enum class AccuracyFormat { kTable, kJson, kCsv, kHtml };

// A unit of the output: its name, and how much of the SI unit it is.
struct OutputUnit {
  std::string name;
  double si = 1;
};
const std::vector<OutputUnit>& LengthUnits();  // m, cm, mm
const std::vector<OutputUnit>& AngleUnits();   // rad, deg

// What is not named is held, or with `is_reachable` x, y and z range over all that the joint ranges allow.
struct BoxSetting {
  bool is_reachable = false;
  CoordinateRanges ranges;
};

// Of a joint reading, where the user says nothing.
inline constexpr double kAssumedJointError_m = 1e-4;

struct AccuracySettings {
  std::filesystem::path model;
  std::vector<Vector6d> poses;  // x y z (m) and three orientation coordinates (rad)
  std::optional<std::filesystem::path> poses_file, session;
  std::optional<BoxSetting> box;
  bool within_joint_ranges = false;
  Sampling sampling;
  int threads = 2;
  std::vector<double>
      joint_error_m;  // one for all joints, or one each; kAssumedJointError_m where none is given
  std::optional<double> geometry_error_m, edge_noise_px, characteristic_length_m;
  std::vector<std::vector<int>> leg_sets = {{0, 1, 2, 3, 4, 5}};  // from 0
  std::optional<std::string> length_unit, angle_unit;             // else by format
  OrientationConvention orientation;
  AccuracyFormat format = AccuracyFormat::kTable;
  std::optional<std::filesystem::path> out;  // else standard output
};

// As asked for; else millimetres and degrees where people read (table, html), metres and radians where
// programs do.
OutputUnit LengthUnitOf(const AccuracySettings& settings);
OutputUnit AngleUnitOf(const AccuracySettings& settings);

// Texts of options taken apart; throw std::invalid_argument with a message for the user.
BoxSetting ParseBox(const std::string& text);                   // "reachable,rz=-0.1:0.1"
std::vector<double> ParseJointErrors(const std::string& text);  // "1e-4" or "1e-4,1e-4,…"
// Errors of lengths, m: from a picometre to a metre.
double ParseLengthError(const std::string& text);

}  // namespace legible
