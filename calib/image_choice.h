// Which of many images, of each of which it is known what it would tell, lower an uncertainty most.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace legible {

// The uncertainty is trace(M C), M = Q^T Q, with C the covariance of the parameters: the inverse of their
// information in the directions V (the columns of `directions`: combinations of parameters of about the same
// size), in each of which `assumed_sigma` is believed besides, so that C exists whatever the information.
class ImageChoice {
 public:
  // q: Q. roots: J of each image, whose information is J^T J; kept by reference.
  ImageChoice(Eigen::MatrixXd directions, double assumed_sigma, Eigen::MatrixXd q,
              const std::vector<Eigen::MatrixXd>& roots, int threads);

  double Uncertainty(const Eigen::MatrixXd& information) const;

  // By how much each image lowers the uncertainty; of those that are taken -1.
  std::vector<double> Gains(const Eigen::MatrixXd& information, const std::vector<bool>& taken) const;

  // The one that lowers it most at once; roots.size() where all are taken.
  size_t Best(const Eigen::MatrixXd& information, const std::vector<bool>& taken) const;

  // `count` images that lower it most together, or those that are not taken where these are fewer: one by one
  // to begin with, then each in turn exchanged for what is best beside the others, at most `passes` times
  // (Fedorov's exchange). The one that lowers it most by itself comes first.
  std::vector<size_t> BestTogether(Eigen::MatrixXd information, std::vector<bool> taken, int count,
                                   int passes) const;

 private:
  Eigen::MatrixXd Covariance(const Eigen::MatrixXd& information) const;
  Eigen::MatrixXd InformationOf(size_t image) const { return roots_[image].transpose() * roots_[image]; }

  Eigen::MatrixXd directions_, q_;
  double assumed_sigma_;
  const std::vector<Eigen::MatrixXd>& roots_;
  int threads_;
};

}  // namespace legible
