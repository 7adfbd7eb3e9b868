#include "apps/intrinsics_text.h"

#include <fmt/format.h>

#include "apps/calibrate_settings.h"
#include "apps/intrinsics_judgement.h"
#include "apps/wording.h"

namespace legible {
namespace {

std::string ParameterTable(const BoardCalibration& result) {
  const Eigen::VectorXd values = UnknownsOf(result.camera);
  const Eigen::VectorXd variances = result.information.CameraCovariance().diagonal();
  std::string text = fmt::format("\n{:<10}{:>14}{:>14}\n", "Camera", "found", "± σ");
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const int decimals = i < 4 ? 3 : 6;
    text += fmt::format("  {:<8}{:>14.{}f}{:>13.{}f}\n",
                        CameraParameterName(result.camera.lens, static_cast<int>(i)), values[i], decimals,
                        std::sqrt(variances[i]), decimals);
  }
  return text;
}

std::string FitText(const IntrinsicsRun& run) {
  const BoardCalibration& result = run.result;
  std::string text =
      fmt::format("{} of {} ({}), {} x {} px, {} lens\n", Plural(ViewsUsed(result), "view"), run.board.name,
                  BoardText(run.board), run.input.width_px, run.input.height_px, LensName(run.settings.lens));
  text += fmt::format(
      "  {} corners, {} left out as outliers, {} not measured; residual {:.3f} px rms, noise {:.3f} px a "
      "coordinate\n",
      CornersOf(result), result.corners_left_out, CornersNotMeasured(run), result.rms_px,
      result.corner_sigma_px);
  for (size_t i = 0; i < result.views.size(); ++i)
    if (!result.views[i].left_out.empty())
      text += fmt::format("  without {}: {}\n", run.input.views[i].name, result.views[i].left_out);
  if (run.settings.board_fit.estimates_warp)
    text += fmt::format("  the board's middle stands out by {:.3g} and {:.3g} mm\n",
                        1e3 * result.warp.bend_m[0], 1e3 * result.warp.bend_m[1]);
  return text;
}

std::string UncertaintyText(const IntrinsicsRun& run) {
  std::string text = "\nA point's image is known to (1 σ over the image)\n";
  for (const UncertaintyMap& map : run.maps)
    text += fmt::format("  {:.3f} px rms, {:.3f} px at worst {}\n", map.rms_px, map.worst_px,
                        DistanceText(run, map.grid.distance_m));
  return text;
}

}  // namespace

std::string SummaryText(const IntrinsicsRun& run) {
  std::string text = FitText(run) + ParameterTable(run.result) + UncertaintyText(run);
  text += fmt::format("\n{}.\n{}.\n", Capitalised(HalvesSentence(run)), Capitalised(CoverageSentence(run)));
  if (run.next_view) text += fmt::format("To know it better, {}.\n", NextViewSentence(run));
  return text + fmt::format("\nWrote camera.yaml, intrinsics.json and report.html to {} ({:.1f} s).\n",
                            run.settings.out.string(), run.seconds);
}

}  // namespace legible
