// Conditions on a rigid motion as quadrics in Study coordinates: docs/hidden-robots-formulation.md, "All
// assembly modes of the Gough-Stewart robot".
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/geometry/rigid3.h"

namespace legible {

// Study coordinates v = (x, y), eight homogeneous: quaternions x and y, scalar first, with x . y = 0. The
// motion p -> R p + t has x a multiple of R's quaternion and y = t x / 2.
//
// A linear condition on R, t, R^T t and |t|^2, of which a leg's length is one:
//   |t|^2 + constant + by_translation . t + by_turned_translation . R^T t + sum of by_rotation_ij R_ij = 0.
template <typename Scalar>
struct MotionCondition {
  Scalar constant;
  Eigen::Matrix<Scalar, 3, 1> by_translation, by_turned_translation;
  Eigen::Matrix<Scalar, 3, 3> by_rotation;
};

// |R b + t - a| = length.
template <typename Scalar>
MotionCondition<Scalar> LegCondition(const Eigen::Matrix<Scalar, 3, 1>& a,
                                     const Eigen::Matrix<Scalar, 3, 1>& b, const Scalar& length) {
  const Scalar two(2);
  return {a.dot(a) + b.dot(b) - length * length, a * -two, b * two, a * b.transpose() * -two};
}

template <typename Scalar>
Eigen::Matrix<Scalar, 3, 3> CrossProductMatrix(const Eigen::Matrix<Scalar, 3, 1>& a) {
  const Scalar zero(0);
  Eigen::Matrix<Scalar, 3, 3> matrix;
  matrix << zero, -a[2], a[1], a[2], zero, -a[0], -a[1], a[0], zero;
  return matrix;
}

// The symmetric 8 x 8 matrix Q with v^T Q v the condition times |x|^2.
template <typename Scalar>
Eigen::Matrix<Scalar, 8, 8> QuadricOf(const MotionCondition<Scalar>& condition) {
  const Eigen::Matrix<Scalar, 3, 3>& rotation = condition.by_rotation;
  const Scalar trace = rotation(0, 0) + rotation(1, 1) + rotation(2, 2);
  const Eigen::Matrix<Scalar, 3, 1> skew_part(
      rotation(2, 1) - rotation(1, 2), rotation(0, 2) - rotation(2, 0), rotation(1, 0) - rotation(0, 1));
  const Eigen::Matrix<Scalar, 3, 1> sum = condition.by_translation + condition.by_turned_translation;
  const Eigen::Matrix<Scalar, 3, 1> difference = condition.by_turned_translation - condition.by_translation;
  Eigen::Matrix<Scalar, 8, 8> quadric;
  quadric.setZero();
  quadric(0, 0) = trace + condition.constant;
  quadric.template block<1, 3>(0, 1) = skew_part.transpose();
  quadric.template block<3, 1>(1, 0) = skew_part;
  quadric.template block<3, 3>(1, 1) = rotation + rotation.transpose();
  for (int i = 1; i < 4; ++i) quadric(i, i) += condition.constant - trace;
  quadric.template block<1, 3>(0, 5) = sum.transpose();
  quadric.template block<3, 1>(1, 4) = -sum;
  quadric.template block<3, 3>(1, 5) = CrossProductMatrix(difference);
  quadric.template bottomLeftCorner<4, 4>() = quadric.template topRightCorner<4, 4>().transpose();
  for (int i = 4; i < 8; ++i) quadric(i, i) = Scalar(4);
  return quadric;
}

// The motions that satisfy six conditions: their quadrics, the last less than each of the others, and Study's
// x . y = 0. The difference leaves |y|^2 in one of them: far away, where y is much larger than x, it would
// drown the rest of the others.
template <typename Scalar>
std::array<Eigen::Matrix<Scalar, 8, 8>, 7> MotionQuadrics(
    const std::array<MotionCondition<Scalar>, 6>& conditions) {
  std::array<Eigen::Matrix<Scalar, 8, 8>, 7> quadrics;
  for (size_t i = 0; i < 6; ++i) quadrics[i] = QuadricOf(conditions[i]);
  for (size_t i = 0; i < 5; ++i) quadrics[i] -= quadrics[5];
  quadrics[6].setZero();
  for (int i = 0; i < 4; ++i) quadrics[6](i, i + 4) = quadrics[6](i + 4, i) = Scalar(1);
  return quadrics;
}

// Of a motion, x of length 1; and the motion of real coordinates with x other than 0.
Eigen::Matrix<double, 8, 1> StudyCoordinates(const Rigid3& b_from_a);
Rigid3 MotionOf(const Eigen::Matrix<double, 8, 1>& study);

}  // namespace legible
