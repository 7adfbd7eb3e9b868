// How long the simulated camera takes for an image.
#include <ctime>

#include "core/rig/scene_camera.h"
#include "core/stopwatch.h"
#include "datasets/synthetic_session.h"
#include "tests/bench/bench_table.h"

namespace legible {
namespace {

double CpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Camera Scaled(Camera camera, int divisor) {
  camera.width_px /= divisor;
  camera.height_px /= divisor;
  camera.fx_px /= divisor;
  camera.fy_px /= divisor;
  camera.cx_px = (camera.cx_px + 0.5) / divisor - 0.5;
  camera.cy_px = (camera.cy_px + 0.5) / divisor - 0.5;
  return camera;
}

BenchTable::Row Measure(const Camera& camera) {
  constexpr int kImages = 100;
  const GoughStewart robot = DesktopHexapod();
  const Stopwatch preparing;
  const SceneCamera scene({robot, camera, LookAt({0.94, 0.074, 0.285}, {0, 0, 0.13})}, {}, 1);
  const double preparation_s = preparing.Seconds(), cpu_before_s = CpuSeconds();
  const Stopwatch taking;
  for (int i = 0; i < kImages; ++i) {
    Rigid3 pose = robot.home;
    pose.translation.z() += 2e-4 * i;
    scene.Take(pose, {}, static_cast<std::uint64_t>(i));
  }
  return {std::to_string(camera.width_px) + " x " + std::to_string(camera.height_px),
          {{"images_per_s", kImages / taking.Seconds()},
           {"cpu_ms_an_image", 1e3 * (CpuSeconds() - cpu_before_s) / kImages},
           {"preparation_s", preparation_s}}};
}

}  // namespace
}  // namespace legible

int main(int argc, char** argv) {
  using namespace legible;  // NOLINT(google-build-using-namespace)
  const Camera camera = DesktopCamera(true);
  return Report({{"images of the simulated camera", {Measure(Scaled(camera, 2)), Measure(camera)}}}, argc,
                argv);
}
