#include "servo/servo_model.h"

#include <Eigen/LU>
#include <stdexcept>

#include "servo/pseudo_inverse.h"

namespace legible {

ServoModel MakeServoModel(const GoughStewart& robot, const Camera& camera, const Rigid3& camera_from_base) {
  if (camera.width_px <= 0 || camera.height_px <= 0 || !(camera.fx_px > 0) || !(camera.fy_px > 0))
    throw std::invalid_argument("MakeServoModel: a camera needs a size and focal lengths");
  ServoModel model{robot, camera, camera_from_base, {}, PlatformRadius(robot), {}, {}, 0};
  for (size_t i = 0; i < kLegCount; ++i)
    model.base_joint_in_camera_m[i] = camera_from_base * robot.legs[i].base_joint_m;
  const double half_width_px = camera.width_px / 2.0;
  const double middle_x_px = (camera.width_px - 1) / 2.0, middle_y_px = (camera.height_px - 1) / 2.0;
  model.k << camera.fx_px, 0, camera.cx_px - middle_x_px,  //
      0, camera.fy_px, camera.cy_px - middle_y_px,         //
      0, 0, half_width_px;
  model.k /= half_width_px;
  model.k_inverse_transposed = model.k.inverse().transpose();
  model.focal_px = (camera.fx_px + camera.fy_px) / 2;
  return model;
}

Vector6d RotationsByRadius(const ServoModel& model) {
  Vector6d scale = Vector6d::Ones();
  scale.tail<3>().setConstant(1 / model.platform_radius_m);
  return scale;
}

Vector6d RobotSingularValues(const ServoModel& model, const Rigid3& base_from_platform) {
  return RightSingularOf(InverseJacobian(model.robot, base_from_platform) *
                         RotationsByRadius(model).asDiagonal())
      .values;
}

Vector6d LegLengths(const GoughStewart& robot, const Vector6d& joint_readings_m) {
  Vector6d lengths_m = joint_readings_m;
  for (int i = 0; i < kLegCount; ++i) lengths_m[i] += robot.legs[static_cast<size_t>(i)].joint_offset_m;
  return lengths_m;
}

}  // namespace legible
