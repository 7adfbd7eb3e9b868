#include "calib/held_values.h"

#include <algorithm>
#include <cmath>

#include "calib/calibrated_model.h"

namespace legible {
namespace {

void AppendDifferences(const LegCalibration& held, const LegCalibration& released, double least_sigmas,
                       std::vector<HeldDifference>& differences) {
  const ModelCovariance before = CovarianceOfModel(held), after = CovarianceOfModel(released);
  const Eigen::VectorXd change = ValuesOfModel(held) - ValuesOfModel(released);
  for (Eigen::Index i = 0; i < change.size(); ++i) {
    if (before.WasEstimated(i) || !after.WasEstimated(i)) continue;
    const double sigmas = change[i] / std::sqrt(after.covariance(i, i));
    if (std::abs(sigmas) > least_sigmas) differences.push_back({after.names[static_cast<size_t>(i)], sigmas});
  }
}

}  // namespace

std::vector<HeldDifference> DifferencesOfHeld(const LegCalibrationInput& input,
                                              const LegCalibration& solution,
                                              const LegCalibrationOptions& options, double least_sigmas) {
  LegCalibrationInput again = input;
  again.start = CalibrationStart{solution.camera, solution.robot, solution.camera_from_base,
                                 solution.camera_from_platform};
  std::vector<HeldDifference> differences;
  for (const auto& [name, thing] : kHoldFields) {
    if (!(options.hold.*thing)) continue;
    LegCalibrationOptions released = options;
    released.hold.*thing = false;
    released.progress = nullptr;
    const LegCalibration found = CalibrateLegs(again, released);
    if (found.status == CalibrationStatus::kConverged)
      AppendDifferences(solution, found, least_sigmas, differences);
  }
  std::sort(differences.begin(), differences.end(), [](const HeldDifference& a, const HeldDifference& b) {
    return std::abs(a.sigmas) > std::abs(b.sigmas);
  });
  return differences;
}

}  // namespace legible
