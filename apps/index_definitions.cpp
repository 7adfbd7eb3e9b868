#include "apps/index_definitions.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace legible {
namespace {

using nlohmann::ordered_json;

struct IndexText {
  std::string key, label, definition;
};

const std::vector<IndexText>& IndexTexts() {
  static const std::vector<IndexText> texts = {
      {"determinant", "determinant",
       "of the inverse Jacobian; its sign tells on which side of a singularity the robot is"},
      {"manipulability", "manipulability",
       "Yoshikawa's sqrt(det(J J^T)) of the Jacobian J, the inverse of the inverse Jacobian: 1 / "
       "|determinant|"},
      {"condition.two", "condition number, 2-norm",
       "|M|_2 |M^-1|_2 of the inverse Jacobian M: largest over smallest singular value"},
      {"condition.frobenius", "condition number, Frobenius", "|M|_F |M^-1|_F; at least 6"},
      {"condition.infinity", "condition number, infinity norm",
       "|M|_inf |M^-1|_inf, of largest absolute row sums"},
      {"condition.frobenius_of_gram", "condition number, Frobenius of M M^T",
       "|M M^T|_F |(M M^T)^-1|_F = sqrt(sum l^2 sum l^-2), l the eigenvalues of M M^T: the other reading of "
       "Frobenius; at "
       "least 6"},
      {"condition.two_normalized", "condition number, 2-norm, normalised",
       "condition.two with columns 4 to 6 divided by the characteristic length"},
      {"condition.frobenius_normalized", "condition number, Frobenius, normalised",
       "condition.frobenius with columns 4 to 6 divided by the characteristic length"},
      {"condition.infinity_normalized", "condition number, infinity norm, normalised",
       "condition.infinity with columns 4 to 6 divided by the characteristic length"},
      {"condition.frobenius_of_gram_normalized", "condition number, Frobenius of M M^T, normalised",
       "condition.frobenius_of_gram with columns 4 to 6 divided by the characteristic length"},
      {"condition.two_three_point", "condition number, 2-norm, three points",
       "smallest and largest 2-norm condition number of the 6 x 9 matrices that take the velocities of three "
       "platform "
       "joints to leg speeds, over all triplets; free of units"},
      {"condition.frobenius_three_point", "condition number, Frobenius, three points",
       "the same of |M M^T|_F |(M M^T)^-1|_F, as Merlet's table has it"},
      {"condition.frobenius_three_point_plain", "condition number, Frobenius of M, three points",
       "the same of |M|_F |M^+|_F"},
  };
  return texts;
}

}  // namespace

std::string IndexLabel(const std::string& key) {
  const auto& texts = IndexTexts();
  const auto found =
      std::find_if(texts.begin(), texts.end(), [&](const IndexText& text) { return text.key == key; });
  return found == texts.end() ? key : found->label;
}

ordered_json UnitsJson(const AccuracyRun& run) {
  const std::string length = LengthUnitOf(run.settings).name, angle = AngleUnitOf(run.settings).name;
  // Rows of constraints, (0, s), have no length in them, and the legs' linear columns neither.
  const bool has_constraints = !std::holds_alternative<GoughStewart>(run.robot.mechanism);
  const std::string determinant = has_constraints ? "1/rad^3" : length + "^3/rad^3";
  return {{"length", length},
          {"angle", angle},
          {"joint", length},
          {"determinant", determinant},
          {"manipulability", has_constraints ? "rad^3" : "rad^3/" + length + "^3"},
          {"inverse_jacobian", fmt::format("columns 1 to 3: 1; columns 4 to 6: {}/rad{}", length,
                                           has_constraints ? ", of constraints 1/rad" : "")},
          {"volume", length + "^3 (position), " + angle + "^3 (rotation)"},
          {"volume_6d", fmt::format("{}^3 {}^3", length, angle)}};
}

ordered_json ConventionsJson(const AccuracyRun& run) {
  return {{"pose", "base_from_platform: x, y, z of the platform's origin in base, then its orientation"},
          {"orientation", run.settings.orientation.Description()},
          {"max_error",
           "largest error of each coordinate of the platform's displacement (v of its origin, rotation "
           "vector), both in "
           "base, over all joint errors within their bounds: row sums of |J| times the bounds (Merlet 2006); "
           "position and "
           "rotation: the largest in any direction, exact"},
          {"inverse_jacobian",
           "full inverse kinematic Jacobian: joint speeds (and zeros of constraints) from the twist (v, "
           "omega) in base; "
           "rows (n, CB x n), n the leg's direction, C the platform's origin"},
          {"indices", "computed with angles in radians whatever the unit of angles is"},
          {"bound",
           "no error is larger; of normally distributed sources (geometry by covariance, vision) 3 sigma"},
          {"value_95",
           "95 % of errors are smaller: 1.96 sigma, position and rotation by the radius that holds 95 %; "
           "bounded errors "
           "taken as uniform within their bounds; never above the bound"},
          {"contributions", "share of the variance times the 95 % value; negative where correlations cancel"},
          {"region_95",
           "a pose error e lies within e^T C^-1 e <= chi_squared with 95 % where normal errors rule, with "
           "more where bounded "
           "ones do; C the covariance"}};
}

ordered_json DefinitionsJson(const AccuracyRun& run) {
  ordered_json definitions;
  for (const IndexText& text : IndexTexts()) definitions[text.key] = text.definition;
  definitions["condition.characteristic_length"] =
      run.settings.characteristic_length_m ? "as given by --characteristic-length"
                                           : "the natural length of each norm: the one that minimises the "
                                             "normalised condition number at the pose";
  return definitions;
}

}  // namespace legible
