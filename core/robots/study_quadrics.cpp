#include "core/robots/study_quadrics.h"

namespace legible {
namespace {

Eigen::Quaterniond FromScalarFirst(const Eigen::Vector4d& q) { return {q[0], q[1], q[2], q[3]}; }

Eigen::Vector4d ScalarFirst(const Eigen::Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }

}  // namespace

Eigen::Matrix<double, 8, 1> StudyCoordinates(const Rigid3& b_from_a) {
  Eigen::Quaterniond half_translation;
  half_translation.w() = 0;
  half_translation.vec() = 0.5 * b_from_a.translation;
  Eigen::Matrix<double, 8, 1> study;
  study << ScalarFirst(b_from_a.rotation), ScalarFirst(half_translation * b_from_a.rotation);
  return study;
}

Rigid3 MotionOf(const Eigen::Matrix<double, 8, 1>& study) {
  const Eigen::Quaterniond x = FromScalarFirst(study.head<4>()), y = FromScalarFirst(study.tail<4>());
  return {x.normalized(), 2 / x.squaredNorm() * (y * x.conjugate()).vec()};
}

}  // namespace legible
