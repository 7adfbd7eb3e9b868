#include "servo/error_text.h"

#include <fmt/format.h>

namespace legible {

std::string ErrorText(ControlMode mode, double error) {
  if (mode == ControlMode::kEdges) return fmt::format("{:.2f} px", error);
  if (mode == ControlMode::kDirections) return fmt::format("{:.2f} mrad", 1e3 * error);
  return fmt::format("{:.3f} mm", 1e3 * error);
}

std::string CertaintyText(const ControlLawOptions& law, const LawResult& result) {
  if (!LooksAtImages(law)) return "";
  return fmt::format("; one image tells the platform's place to a σ of {:.2g} mm",
                     1e3 * result.motion_sigma_m);
}

}  // namespace legible
