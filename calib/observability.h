// What the data can tell of the shared parameters and what they cannot, in words.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "calib/estimation_problem.h"

namespace legible {

// A combination of parameters that the data leave open (or nearly so).
struct WeakDirection {
  std::string description;  // a sentence for the user, with the mend
  double relative_sigma =
      0;  // standard deviation along it, relative to the size of the things it moves; may be inf
  Eigen::VectorXd direction;  // of the shared parameters, largest entry relative to its natural size is 1
};

struct Observability {
  std::vector<WeakDirection> unobservable;  // known no better than to a third of their own size
  std::vector<WeakDirection> weak;          // the three least certain of the rest
  Eigen::MatrixXd covariance;  // kSharedParameterCount square, SI units and px, in the platform gauge
  // Per parameter: held, or untouched by an unobservable direction and, where there is one, by others that
  // are known no better than to a twentieth; a joint as a whole.
  std::vector<bool> known;
};

// Eigenvalues of the problem's information in natural units (each parameter relative to the size of its
// thing: the focal length, a joint's distance, …) after the platform gauge is taken out. Where nothing is
// unobservable the covariance is the inverse of the information; otherwise it covers the observable rest, and
// parameters that are not `known` must not be reported.
Observability AnalyseObservability(const EstimationProblem& problem);

// The same of information (as SharedInformation's) that was added up elsewhere: of the problem's units only
// whether there are rigid ones counts.
Observability AnalyseObservability(const EstimationProblem& problem, const Eigen::MatrixXd& information);

// Columns (kSharedParameterCount rows, SI units and px) that span what the analysis is about: the free
// parameters without the platform gauge, orthonormal in natural units. A combination z of them is a relative
// change.
Eigen::MatrixXd AnalysedDirections(const EstimationProblem& problem);

}  // namespace legible
