// Merlet's maximal positioning errors of a Gough-Stewart robot in very many poses: what MaximalErrorsOf and
// ConditionNumbersOf say of each to 1e-9, several poses at once. A million take some 50 ms on one thread.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "accuracy/platform_jacobian.h"
#include "core/robots/gough_stewart.h"

namespace legible {

// What the arithmetic may use; results differ by rounding.
enum class InstructionSet { kBaseline, kAvx2, kAvx512 };
const char* ToString(InstructionSet set);  // "baseline", "avx2", "avx512"

// Those that this machine has, the widest last.
std::vector<InstructionSet> AvailableInstructionSets();

struct BatchOptions {
  Vector6d joint_error_bounds_m = Vector6d::Zero();  // one a leg, 0 or more
  // What else is wanted; each takes time.
  bool any_direction = false;
  bool condition = false;
  bool determinant = false;
  bool joint_readings = false;
  double characteristic_length_m = 1;  // that angular columns are divided by for the condition number
  int threads = 1;                     // at most; does not change the results
  std::optional<InstructionSet> instruction_set;  // the widest available unless given

  void Check() const;  // throws std::invalid_argument
};

// An entry or a row a pose; empty what was not asked for.
struct BatchErrors {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, kLegCount>;

  std::vector<PoseStatus> status;
  Rows of_coordinate;                     // at most: m, m, m, rad, rad, rad in base; NaN where singular
  Eigen::VectorXd position_m;             // any_direction: of the largest displacement; NaN where singular
  Eigen::VectorXd rotation_rad;           // any_direction: of the largest rotation; NaN where singular
  Eigen::VectorXd inverse_condition_two;  // condition: 1 / the 2-norm condition number; 0 where singular
  Eigen::VectorXd determinant;            // of the inverse Jacobian, SI: its sign tells the aspect
  Rows joint_readings_m;
  size_t careful = 0;  // poses that the scalar functions decided, for the fast arithmetic could not
};

// A leg without length makes a pose singular. Throws std::invalid_argument for options that Check refuses and
// for robots and poses that are not finite.
BatchErrors EvaluateBatch(const GoughStewart& robot, const std::vector<Rigid3>& base_from_platform,
                          const BatchOptions& options);

}  // namespace legible
