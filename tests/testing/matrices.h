// Comparison of vectors and matrices in tests.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace legible {

// Whether no element differs by more than the absolute tolerance; prints both matrices where one does.
// EXPECT_TRUE(AreNear(found, expected, 1e-12));
template <typename A, typename B>
testing::AssertionResult AreNear(const Eigen::MatrixBase<A>& found, const Eigen::MatrixBase<B>& expected,
                                 double absolute_tolerance) {
  if (found.rows() != expected.rows() || found.cols() != expected.cols()) {
    return testing::AssertionFailure() << "found " << found.rows() << " x " << found.cols() << ", expected "
                                       << expected.rows() << " x " << expected.cols();
  }
  const double difference = (found - expected).cwiseAbs().maxCoeff();
  if (found.allFinite() && difference <= absolute_tolerance) return testing::AssertionSuccess();
  const Eigen::IOFormat format(Eigen::FullPrecision);
  return testing::AssertionFailure() << "found\n"
                                     << found.format(format) << "\nexpected\n"
                                     << expected.format(format) << "\nlargest absolute difference "
                                     << difference << ", allowed " << absolute_tolerance;
}

}  // namespace legible
