// Progress of the solver; for this project's .cpp files that know it.
#pragma once

#include <ceres/iteration_callback.h>

#include <functional>

namespace legible {

// Calls `report`, which has to outlive it, with the iteration and the cost after each.
class ProgressCallback final : public ceres::IterationCallback {
 public:
  explicit ProgressCallback(const std::function<void(int, double)>& report) : report_(report) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    report_(summary.iteration, summary.cost);
    return ceres::SOLVER_CONTINUE;
  }

 private:
  const std::function<void(int, double)>& report_;
};

}  // namespace legible
