// How fast a robot's maximal positioning errors are found in very many poses, against a plain loop over them.
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "accuracy/batch_errors.h"
#include "core/stopwatch.h"
#include "tests/bench/bench_table.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

constexpr size_t kPoses = 1'000'000;
constexpr int kRuns = 5;  // the fastest counts, of either
constexpr double kCharacteristicLength_m = 0.2;

struct Workload {
  GoughStewart robot;
  std::vector<Rigid3> poses;
  BatchOptions options;
};

// Up to 5 cm along and 0.2 rad about every axis from home.
Workload RandomWorkload() {
  std::mt19937_64 generator(1);
  Workload workload{DesktopHexapod(generator, 0.002), {}, {}};
  workload.poses.reserve(kPoses);
  for (size_t i = 0; i < kPoses; ++i) {
    Vector6d displacement;
    displacement << UniformVector(generator, -0.05, 0.05), UniformVector(generator, -0.2, 0.2);
    workload.poses.push_back(Displaced(workload.robot.home, displacement));
  }
  workload.options.joint_error_bounds_m << 10e-6, 12e-6, 9e-6, 11e-6, 10e-6, 8e-6;
  workload.options.characteristic_length_m = kCharacteristicLength_m;
  return workload;
}

// ---- The plain loop.

struct Plain {
  std::vector<Vector6d> of_coordinate;
  std::vector<double> inverse_condition_two;
};

double InverseConditionOf(Matrix6d matrix, double length_m) {
  matrix.rightCols<3>() /= length_m;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(matrix.transpose() * matrix, Eigen::EigenvaluesOnly);
  return std::sqrt(solver.eigenvalues()[0] / solver.eigenvalues()[5]);
}

void EvaluatePose(const Workload& workload, size_t i, Plain& plain) {
  const BatchOptions& options = workload.options;
  const Matrix6d inverse_jacobian = InverseJacobian(workload.robot, workload.poses[i]);
  plain.of_coordinate[i] = inverse_jacobian.inverse().cwiseAbs() * options.joint_error_bounds_m;
  if (options.condition)
    plain.inverse_condition_two[i] = InverseConditionOf(inverse_jacobian, options.characteristic_length_m);
}

Plain EvaluatePlainly(const Workload& workload) {
  const size_t count = workload.poses.size();
  Plain plain{std::vector<Vector6d>(count), std::vector<double>(workload.options.condition ? count : 0)};
  tbb::task_arena arena(workload.options.threads);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<size_t>(0, count), [&](const tbb::blocked_range<size_t>& range) {
      for (size_t i = range.begin(); i < range.end(); ++i) EvaluatePose(workload, i, plain);
    });
  });
  return plain;
}

// ---- The comparison.

template <typename Result>
struct Timed {
  Result result;
  double fastest_s = std::numeric_limits<double>::infinity();
};

template <typename Function>
void Run(const Function& function, Timed<decltype(function())>& timed) {
  timed.result = {};
  const Stopwatch stopwatch;
  timed.result = function();
  timed.fastest_s = std::min(timed.fastest_s, stopwatch.Seconds());
}

// Not a number where one of them is none.
double LargestRelativeDifference(const Plain& plain, const BatchErrors& batch) {
  double largest = 0;
  const auto compare = [&](double found, double expected) {
    const double difference = std::abs(found - expected) / expected;
    if (!(difference <= largest)) largest = difference;
  };
  for (size_t i = 0; i < plain.of_coordinate.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (int k = 0; k < kLegCount; ++k) compare(batch.of_coordinate(row, k), plain.of_coordinate[i][k]);
    if (!plain.inverse_condition_two.empty())
      compare(batch.inverse_condition_two[row], plain.inverse_condition_two[i]);
    if (std::isnan(largest)) break;
  }
  return largest;
}

BenchTable::Row Compare(const std::string& label, const Workload& workload) {
  Timed<Plain> plain;
  Timed<BatchErrors> batch;
  for (int run = 0; run < kRuns; ++run) {
    Run([&] { return EvaluatePlainly(workload); }, plain);
    Run([&] { return EvaluateBatch(workload.robot, workload.poses, workload.options); }, batch);
  }
  const auto count = static_cast<double>(workload.poses.size());
  return {label,
          {{"plain_ns_a_pose", 1e9 * plain.fastest_s / count},
           {"batch_ns_a_pose", 1e9 * batch.fastest_s / count},
           {"times_as_fast", plain.fastest_s / batch.fastest_s},
           {"largest_relative_difference", LargestRelativeDifference(plain.result, batch.result)},
           {"careful_share", static_cast<double>(batch.result.careful) / count}}};
}

BenchTable Batches() {
  Workload workload = RandomWorkload();
  BenchTable table{"maximal errors of 10^6 poses", {}};
  for (const bool condition : {false, true})
    for (const int threads : {1, 2}) {
      workload.options.condition = condition;
      workload.options.threads = threads;
      const std::string what = condition ? "with condition, " : "errors, ";
      table.rows.push_back(Compare(what + std::to_string(threads) + " thr.", workload));
    }
  return table;
}

}  // namespace
}  // namespace legible

int main(int argc, char** argv) { return legible::Report({legible::Batches()}, argc, argv); }
