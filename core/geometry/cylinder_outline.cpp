#include "core/geometry/cylinder_outline.h"

namespace legible {

Eigen::Matrix<double, 3, 7> OutlineJacobian(const Eigen::Vector3d& a_in_camera,
                                            const Eigen::Vector3d& b_in_camera,
                                            const Eigen::Vector3d& normal) {
  using Row7 = Eigen::Matrix<double, 1, 7>;
  const Eigen::Vector3d axis = b_in_camera - a_in_camera;
  const double length = axis.norm();
  const Eigen::Vector3d u = axis / length;
  const Eigen::Vector3d tangent = u.cross(normal);

  // n, u and u x n are orthonormal, so dn = along u + across (u x n). From d(u.n) = 0: along = -n.du, and
  // n.du = n.(dB - dA) / |B - A|.
  Row7 along;
  along << normal.transpose() / length, -normal.transpose() / length, 0;
  // From d(A.n) = -dR: across A.(u x n) = -dR - n.dA - along A.u.
  Row7 across = -a_in_camera.dot(u) * along;
  across.head<3>() -= normal.transpose();
  across[6] -= 1;
  across /= a_in_camera.dot(tangent);
  return u * along + tangent * across;
}

}  // namespace legible
