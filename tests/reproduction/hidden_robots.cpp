// The tables of Briot et al. (2016) again: hidden legs, assembly modes, the Quattro's simulations and errors;
// and a hexapod that three legs mislead. Markdown on stdout.
#include <fmt/format.h>

#include <cstdio>

#include "datasets/robot_file.h"
#include "tests/reproduction/hexapod_misled.h"
#include "tests/reproduction/hidden_families.h"
#include "tests/reproduction/quattro.h"

namespace legible {
namespace {

constexpr QuattroPlatform kFirstGuess{-0.0254, 0.0372, 0.0608};
constexpr int kTries = 2000;

void PrintQuattro() {
  const FittedPlatform fitted = FitPlatform(kFirstGuess);
  fmt::print(
      "\n## Quattro\n\nThe platform that agrees best with the published modes: D₁, D₂ = P + ({:.4f}, "
      "∓{:.4f}, 0) m at φ = 0, "
      "P fixed to the half of C₁ and C₂, D₂ turning about D₁ + (0, {:.4f}, 0) with an arm of {:.4f} m; "
      "{:.2f} mm rms a "
      "coordinate.\n\n",
      fitted.platform.x_m, fitted.platform.y_m, 2 * fitted.platform.y_m - fitted.platform.arm_m,
      fitted.platform.arm_m, 1e3 * fitted.rms_m);
  const ParallelRobot robot = Quattro(fitted.platform);
  fmt::print("{}\n{}\n{}\n{}", ModesTable(robot), ConvergenceTable(robot), EndsTable(robot),
             AccuracyTable(robot));
}

void PrintHexapod() {
  const GoughStewart robot = ReadRobot(LEGIBLE_SOURCE_DIR "/datasets/hexapod/robot.yaml");
  fmt::print("\n## Hexapod misled by three legs\n\n");
  const auto way = FindMisledWay(robot, kTries);
  fmt::print("{}", way ? MisledTable(robot, *way) : fmt::format("None found in {} goals.\n", kTries));
}

}  // namespace
}  // namespace legible

int main() {
  fmt::print("## Hidden legs\n\n{}\n## Assembly modes\n\n{}\n## Controllability\n\n{}",
             legible::HiddenLegsTable(), legible::ModeCountsTable(), legible::ControllabilityTable());
  std::fflush(stdout);
  legible::PrintQuattro();
  std::fflush(stdout);
  legible::PrintHexapod();
}
