#include "core/rig/simulation_options.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace legible {
namespace {

void Demand(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument("SimulationOptions: " + what);
}

template <typename Options>
void CheckNumbers(const Options& options, const std::vector<NumberField<Options>>& fields,
                  const std::string& prefix) {
  for (const NumberField<Options>& field : fields) {
    const double value = options.*field.value;
    if (value >= field.lowest && value <= field.highest) continue;
    std::ostringstream what;
    what << prefix << field.name << " is " << value << "; give " << field.lowest << " to " << field.highest;
    Demand(false, what.str());
  }
}

void CheckFault(const Fault& fault, const std::string& prefix) {
  CheckNumbers(fault, kFaultFields, prefix);
  Demand(fault.from_s < fault.until_s, prefix + "until_s must be later than from_s");
  Demand(fault.leg >= 0 && fault.leg < kLegCount, prefix + "leg must be 0 to 5");
}

}  // namespace

std::optional<double> ReadingSigma(const DriveOptions& drives) {
  const double sigma_m = std::hypot(drives.reading_noise_m, drives.reading_step_m / std::sqrt(12.0));
  return sigma_m > 0 ? std::optional(sigma_m) : std::nullopt;
}

void SimulationOptions::Check() const {
  CheckNumbers(*this, kSimulationFields, "");
  CheckNumbers(drives, kDriveFields, "drives.");
  Demand(drives.sliding_loss_m_per_s <= drives.breakaway_speed_m_per_s,
         "drives.sliding_loss_m_per_s must not exceed drives.breakaway_speed_m_per_s");
  CheckNumbers(scene, kSceneFields, "scene.");
  Demand(scene.light_in_camera.allFinite() && scene.light_in_camera.norm() > 0,
         "scene.light_in_camera must be finite and not 0");
  for (size_t i = 0; i < faults.size(); ++i) CheckFault(faults[i], "faults[" + std::to_string(i + 1) + "].");
  if (!start) return;
  Demand(start->translation.allFinite(), "start.translation must be finite");
  Demand(std::abs(start->rotation.norm() - 1) < 1e-6, "start.rotation must be a unit quaternion");
}

}  // namespace legible
