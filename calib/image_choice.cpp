#include "calib/image_choice.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

#include "calib/image_information.h"

namespace legible {

ImageChoice::ImageChoice(Eigen::MatrixXd directions, double assumed_sigma, Eigen::MatrixXd q,
                         const std::vector<Eigen::MatrixXd>& roots, int threads)
    : directions_(std::move(directions)),
      q_(std::move(q)),
      assumed_sigma_(assumed_sigma),
      roots_(roots),
      threads_(threads) {}

// V (V^T information V + 1 / assumed_sigma^2)^-1 V^T
Eigen::MatrixXd ImageChoice::Covariance(const Eigen::MatrixXd& information) const {
  Eigen::MatrixXd relative = directions_.transpose() * information * directions_;
  relative.diagonal().array() += 1 / (assumed_sigma_ * assumed_sigma_);
  const Eigen::MatrixXd root = relative.llt().matrixL().solve(directions_.transpose());
  return root.transpose() * root;
}

double ImageChoice::Uncertainty(const Eigen::MatrixXd& information) const {
  return (q_ * Covariance(information) * q_.transpose()).trace();
}

std::vector<double> ImageChoice::Gains(const Eigen::MatrixXd& information,
                                       const std::vector<bool>& taken) const {
  const Eigen::MatrixXd covariance = Covariance(information);
  const Eigen::MatrixXd q_covariance = q_ * covariance;
  std::vector<double> gains(roots_.size(), -1);
  tbb::task_arena arena(threads_);
  arena.execute([&] {
    tbb::parallel_for(size_t{0}, gains.size(), [&](size_t i) {
      if (!taken[i]) gains[i] = GainOf(roots_[i], covariance, q_covariance);
    });
  });
  return gains;
}

size_t ImageChoice::Best(const Eigen::MatrixXd& information, const std::vector<bool>& taken) const {
  const std::vector<double> gains = Gains(information, taken);
  const auto best = std::max_element(gains.begin(), gains.end());
  return best == gains.end() || *best < 0 ? gains.size() : static_cast<size_t>(best - gains.begin());
}

std::vector<size_t> ImageChoice::BestTogether(Eigen::MatrixXd information, std::vector<bool> taken, int count,
                                              int passes) const {
  std::vector<size_t> chosen;
  const auto take = [&](size_t image) {
    taken[image] = true;
    information += InformationOf(image);
  };
  while (static_cast<int>(chosen.size()) < count) {
    const size_t best = Best(information, taken);
    if (best == roots_.size()) break;
    if (chosen.empty() && count == 1) return {best};
    take(best);
    chosen.push_back(best);
  }
  for (int pass = 0, changes = 1; pass < passes && changes > 0; ++pass) {
    changes = 0;
    for (size_t& image : chosen) {
      const size_t before = image;
      taken[before] = false;
      information -= InformationOf(before);
      image = Best(information, taken);
      take(image);
      changes += image != before ? 1 : 0;
    }
  }
  for (const size_t image : chosen) {
    taken[image] = false;
    information -= InformationOf(image);
  }
  const std::vector<double> alone = Gains(information, taken);
  std::sort(chosen.begin(), chosen.end(), [&](size_t a, size_t b) { return alone[a] > alone[b]; });
  return chosen;
}

}  // namespace legible
