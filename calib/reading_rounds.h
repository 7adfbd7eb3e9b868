// The joint readings of a problem through the rounds of solving and re-weighting.
#pragma once

#include <cstddef>
#include <vector>

#include "calib/estimation_problem.h"

namespace legible {

// An image whose joint readings its edges contradict, so that they hardly count: the reading that is farthest
// off. One wrong reading moves the pose, and with it what the others seem to be off: all six go.
struct OutlyingReading {
  int image = 0;     // of the input
  int leg = 0;       // 0-based
  double off_m = 0;  // by which the reading is longer than the model's leg
};

// Holds on to the problem's units, whose number and places must stay.
class ReadingRounds {
 public:
  explicit ReadingRounds(EstimationProblem& problem);

  int count() const { return count_; }
  double Weight() const;   // sum of all weights
  double Squares() const;  // weighted sum of squares, in the readings' own sigmas
  double Rms() const;      // the root of their ratio; 0 without readings
  // By what factor the readings scatter about what each image alone predicts, beyond what their sigmas and
  // the prediction's allow: the median over the images. About 1 where the sigmas are right; 0 without
  // readings.
  double Scatter() const;
  std::vector<OutlyingReading> Outlying() const;

  // Finds the residuals where the problem stands, with the edges as they count there.
  void Evaluate();
  // For the first round, in which the edges count `scale` times less than later: sigmas so large that a wrong
  // reading stands out from its image's edges instead of taking them along.
  void Loosen(double scale);
  // From the residuals: the weights, which the problem's sigmas take up. Where half of the readings scatter
  // more than their sigmas say, that is the measure. Returns by how much the weights changed, in all.
  double Reweight();

 private:
  struct Reading {
    size_t leg = 0;      // observation of the unit
    double sigma_m = 0;  // as given
  };
  // Of one image.
  struct Row {
    size_t unit = 0;  // of the problem
    std::vector<Reading> readings;
    Eigen::VectorXd residual = {};  // model less reading, in the readings' sigmas
    double weight = 1;              // robust, [0, 1]
    double square = 0;              // of how far all readings are off from what edges and tags predict, chi^2
    size_t worst = 0;               // the reading that is farthest off
    double worst_off = 0;           // in its sigma, model less reading
  };
  struct Linearised {
    Eigen::VectorXd residual;
    Eigen::MatrixXd d_pose;
    Matrix6d image;  // information of edges and tags on the pose
  };
  Linearised Linearise(const Row& row) const;
  void Predict(const Linearised& at, Row& row) const;
  double MedianSquare() const;  // of the rows' squares, a reading; there is a row
  void SetSigmas(const Row& row, double factor);

  EstimationProblem& problem_;
  std::vector<Row> rows_;
  int count_ = 0;
};

}  // namespace legible
