// The tables of Briot et al. (2016) again: hidden legs, assembly modes, the Quattro's simulations and errors;
// and a hexapod that three legs mislead. Markdown on stdout; logs of servos in the folder that is named.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "tests/reproduction/hexapod_misled.h"
#include "tests/reproduction/hidden_families.h"
#include "tests/reproduction/quattro.h"
#include "tests/testing/hexapod_servo.h"

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

void PrintHexapod(const std::filesystem::path& folder) {
  const GoughStewart robot = ShippedHexapod().robot;
  fmt::print("\n## Hexapod misled by three legs\n\n");
  const auto way = FindMisledWay(robot, kTries);
  if (way)
    fmt::print("{}\n{}\n### Two modes in one aspect\n\n{}", MisledTable(robot, *way),
               MisledByImagesTable(folder / "misled", *way), OneAspectTable(robot, *way));
  else
    fmt::print("None found in {} goals.\n", kTries);
  std::fflush(stdout);
  fmt::print("\n## Hexapod by the legs chosen\n\n{}", ChosenLegsTable(folder / "chosen", robot));
}

}  // namespace
}  // namespace legible

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: {} FOLDER\n", argv[0]);
    return 2;
  }
  fmt::print("## Hidden legs\n\n{}\n## Assembly modes\n\n{}\n## Controllability\n\n{}",
             legible::HiddenLegsTable(), legible::ModeCountsTable(), legible::ControllabilityTable());
  std::fflush(stdout);
  legible::PrintQuattro();
  std::fflush(stdout);
  legible::PrintHexapod(argv[1]);
}
