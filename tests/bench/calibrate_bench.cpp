// How time and memory of a calibration grow with the number of images.
#include <sys/resource.h>

#include <string>

#include "calib/leg_calibration.h"
#include "core/stopwatch.h"
#include "datasets/synthetic_session.h"
#include "tests/bench/bench_table.h"

namespace legible {
namespace {

double PeakMemory_MB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

struct Measured {
  double solve_s = 0, covariance_s = 0, peak_memory_MB = 0;
  int iterations = 0;
  bool converged = false;
};

Measured Calibrate(int images) {
  SyntheticOptions options;
  options.image_count = images;
  const SyntheticSession session = GenerateSession(options);
  LegCalibrationInput input{session.nominal_robot,
                            session.nominal_camera,
                            session.nominal_camera_from_base,
                            session.observations,
                            {},
                            {}};
  input.known.joint_reading_m = options.joint_reading_sigma_m;
  const Stopwatch total;
  const LegCalibration found = CalibrateLegs(input, {});
  const double total_s = total.Seconds();
  return {total_s - found.covariance_s, found.covariance_s, PeakMemory_MB(), found.iterations,
          found.status == CalibrationStatus::kConverged};
}

// The peak memory of a row is that of all rows up to it: the counts ascend.
BenchTable Growth() {
  BenchTable table{"calibration of synthetic sessions", {}};
  double solve_of_first_s = 0;
  for (const int images : {40, 100, 300, 1000}) {
    const Measured measured = Calibrate(images);
    if (solve_of_first_s == 0) solve_of_first_s = measured.solve_s;
    table.rows.push_back({std::to_string(images) + " images",
                          {{"solve_s", measured.solve_s},
                           {"covariance_s", measured.covariance_s},
                           {"solve_over_40", measured.solve_s / solve_of_first_s},
                           {"peak_memory_MB", measured.peak_memory_MB},
                           {"iterations", measured.iterations},
                           {"converged", measured.converged ? 1.0 : 0.0}}});
  }
  return table;
}

}  // namespace
}  // namespace legible

int main(int argc, char** argv) { return legible::Report({legible::Growth()}, argc, argv); }
