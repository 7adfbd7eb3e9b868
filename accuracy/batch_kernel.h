// The arithmetic of EvaluateBatch, a block of poses at a time, compiled once for each instruction set.
//
// Nothing but plain arrays here and in batch_kernel.inc: an inline function of a library, compiled for
// AVX-512 there, could be the copy that the linker keeps for the whole program.
#pragma once

namespace legible {

inline constexpr int kBlockPoses = 64;

// What is the same for all poses. The legs in an order whose first three directions are far from coplanar.
struct BatchRobot {
  double base_joint_m[6][3];
  double platform_joint_m[6][3];
  double joint_error_bound_m[6];
  double order_sign;               // of the permutation from the robot's order to this one
  double characteristic_length_m;  // of the condition number
  // Of the balanced inverse Jacobian's Frobenius condition number, squared: the largest that the fast path
  // takes, and factors that bound it by squared maximal errors.
  double largest_squared_condition, condition_by_linear, condition_by_angular;
  bool any_direction, condition, determinant;
};

// Poses in, errors out, structure of arrays.
struct alignas(64) BatchBlock {
  double quaternion[4][kBlockPoses];  // x, y, z, w
  double translation_m[3][kBlockPoses];

  double length_m[6][kBlockPoses];
  double of_coordinate[6][kBlockPoses];
  double determinant[kBlockPoses];                            // if determinant
  double position_m[kBlockPoses], rotation_rad[kBlockPoses];  // if any_direction
  double inverse_condition_two[kBlockPoses];                  // if condition
  // Whether the above hold: 1, or 0 where the careful path has to decide.
  double is_regular[kBlockPoses];
  double has_condition[kBlockPoses];  // if condition
};

namespace baseline {
void EvaluateBlock(const BatchRobot& robot, BatchBlock& block);
}
#if defined(__x86_64__)
namespace avx2 {
void EvaluateBlock(const BatchRobot& robot, BatchBlock& block);
}
namespace avx512 {
void EvaluateBlock(const BatchRobot& robot, BatchBlock& block);
}
#endif

}  // namespace legible
