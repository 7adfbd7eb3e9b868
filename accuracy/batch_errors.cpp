#include "accuracy/batch_errors.h"

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

#include "accuracy/batch_kernel.h"
#include "accuracy/conditioning.h"
#include "accuracy/maximal_errors.h"

namespace legible {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

using Kernel = void (*)(const BatchRobot&, BatchBlock&);
static_assert(kLegCount == 6, "the kernels are written for six legs");
using Order = std::array<int, kLegCount>;  // of the kernel's legs, which of the robot's they are

Kernel KernelOf(InstructionSet set) {
  switch (set) {
    case InstructionSet::kBaseline:
      return baseline::EvaluateBlock;
#if defined(__x86_64__)
    case InstructionSet::kAvx2:
      return avx2::EvaluateBlock;
    case InstructionSet::kAvx512:
      return avx512::EvaluateBlock;
#else
    default:
      break;
#endif
  }
  throw std::invalid_argument("EvaluateBatch: this machine does not have the instruction set");
}

void CheckRobot(const GoughStewart& robot) {
  for (const Leg& leg : robot.legs)
    if (!leg.base_joint_m.allFinite() || !leg.platform_joint_m.allFinite() ||
        !std::isfinite(leg.joint_offset_m))
      throw std::invalid_argument("EvaluateBatch: a joint of the robot is not finite");
}

// The legs with those three first whose directions span the largest volume at home: what the blockwise
// inverse divides by stays far from zero around there.
Order OrderOfLegs(const GoughStewart& robot) {
  const Matrix6d jacobian = InverseJacobian(robot, robot.home);
  std::array<int, 3> best = {0, 2, 4};
  double largest = 0;
  for (int i = 0; i < kLegCount; ++i)
    for (int j = i + 1; j < kLegCount; ++j)
      for (int k = j + 1; k < kLegCount; ++k) {
        const Eigen::Vector3d u = jacobian.row(i).head<3>(), v = jacobian.row(j).head<3>(),
                              w = jacobian.row(k).head<3>();
        const double volume = std::abs(u.dot(v.cross(w)));
        if (volume > largest) largest = volume, best = {i, j, k};
      }
  Order order{};
  auto end = std::copy(best.begin(), best.end(), order.begin());
  for (int i = 0; i < kLegCount; ++i)
    if (std::find(best.begin(), best.end(), i) == best.end()) *end++ = i;
  return order;
}

double SignOf(const Order& order) {
  double sign = 1;
  for (size_t i = 0; i < order.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      if (order[j] > order[i]) sign = -sign;
  return sign;
}

// With r_j^2 = 1 + |m_j|^2 / L^2 the rows of the inverse Jacobian whose angular columns m_j are divided by L,
// and p_j, q_j the columns of the Jacobian, the squared condition number is 6 sum r_j^2 (|p_j|^2 + L^2
// |q_j|^2). 6 L^2 = sum |m_j|^2, so that r_j^2 <= 7; m_j is no longer than its arm; and an error is at least
// as large as the smallest bound times its row of the Jacobian.
void BoundCondition(BatchRobot& robot) {
  // A hundredth less than at the limit, so that rounding decides nothing: what is nearer is left to Invert.
  robot.largest_squared_condition = std::pow(0.99 / kNearSingularRatio, 2);
  double sum_m2 = 0, largest_m2 = 0;
  for (const auto& joint_m : robot.platform_joint_m) {
    const double squared_m2 = Eigen::Map<const Eigen::Vector3d>(joint_m).squaredNorm();
    sum_m2 += squared_m2;
    largest_m2 = std::max(largest_m2, squared_m2);
  }
  const double smallest_m =
      *std::min_element(robot.joint_error_bound_m, robot.joint_error_bound_m + kLegCount);
  const double over_squared = 1 / (smallest_m * smallest_m);  // infinite: bounds nothing
  robot.condition_by_linear = kLegCount * 7 * over_squared;
  robot.condition_by_angular = (sum_m2 + kLegCount * largest_m2) * over_squared;
}

BatchRobot RobotInOrder(const GoughStewart& robot, const Order& order, const BatchOptions& options) {
  BatchRobot ordered{};
  for (int i = 0; i < kLegCount; ++i) {
    const Leg& leg = robot.legs[order[i]];
    for (int k = 0; k < 3; ++k) {
      ordered.base_joint_m[i][k] = leg.base_joint_m[k];
      ordered.platform_joint_m[i][k] = leg.platform_joint_m[k];
    }
    ordered.joint_error_bound_m[i] = options.joint_error_bounds_m[order[i]];
  }
  ordered.order_sign = SignOf(order);
  ordered.characteristic_length_m = options.characteristic_length_m;
  BoundCondition(ordered);
  ordered.any_direction = options.any_direction;
  ordered.condition = options.condition;
  ordered.determinant = options.determinant;
  return ordered;
}

// Memory is handed out in pages of 4 KB as it is first written, which for a million poses takes half as long
// as the arithmetic; in pages of 2 MB it takes next to nothing. Only a hint: what it does shows in time
// alone.
void AskForLargePages([[maybe_unused]] void* data, [[maybe_unused]] size_t bytes) {
#if defined(__linux__)
  constexpr std::uintptr_t kPage_B = 4096;
  const auto begin = (reinterpret_cast<std::uintptr_t>(data) + kPage_B - 1) / kPage_B * kPage_B;
  const auto end = (reinterpret_cast<std::uintptr_t>(data) + bytes) / kPage_B * kPage_B;
  if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
#endif
}

template <typename Rows>
void Resize(Rows& rows, Eigen::Index count, bool wanted) {
  if (!wanted) return;
  rows.resize(count, rows.cols());
  AskForLargePages(rows.data(), static_cast<size_t>(rows.size()) * sizeof(double));
}

class Batch {
 public:
  Batch(const GoughStewart& robot, const std::vector<Rigid3>& poses, const BatchOptions& options)
      : robot_(robot),
        poses_(poses),
        options_(options),
        order_(OrderOfLegs(robot)),
        ordered_robot_(RobotInOrder(robot, order_, options)),
        kernel_(KernelOf(options.instruction_set.value_or(AvailableInstructionSets().back()))) {
    const auto count = static_cast<Eigen::Index>(poses.size());
    result_.status.reserve(poses.size());
    AskForLargePages(result_.status.data(), poses.size() * sizeof(PoseStatus));
    result_.status.resize(poses.size(), PoseStatus::kRegular);
    Resize(result_.of_coordinate, count, true);
    Resize(result_.position_m, count, options.any_direction);
    Resize(result_.rotation_rad, count, options.any_direction);
    Resize(result_.inverse_condition_two, count, options.condition);
    Resize(result_.determinant, count, options.determinant);
    Resize(result_.joint_readings_m, count, options.joint_readings);
  }

  BatchErrors Evaluate() {
    const size_t blocks = (poses_.size() + kBlockPoses - 1) / kBlockPoses;
    tbb::task_arena arena(std::min(options_.threads, tbb::info::default_concurrency()));
    arena.execute([&] {
      tbb::parallel_for(tbb::blocked_range<size_t>(0, blocks), [&](const tbb::blocked_range<size_t>& range) {
        BatchBlock block;
        for (size_t i = range.begin(); i < range.end(); ++i) EvaluateBlock(i * kBlockPoses, block);
      });
    });
    result_.careful = careful_;
    return std::move(result_);
  }

 private:
  void EvaluateBlock(size_t first, BatchBlock& block) {
    const size_t count = std::min<size_t>(kBlockPoses, poses_.size() - first);
    Fill(first, count, block);
    kernel_(ordered_robot_, block);
    Keep(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(count), block);
    size_t careful = 0;
    for (size_t i = 0; i < count; ++i) {
      const bool is_regular = block.is_regular[i] != 0;
      const bool has_condition = !options_.condition || block.has_condition[i] != 0;
      if (is_regular && has_condition) continue;
      ++careful;
      if (is_regular)
        SetCondition(first + i);
      else
        EvaluateCarefully(first + i);
    }
    if (careful > 0) careful_ += careful;
  }

  void Fill(size_t first, size_t count, BatchBlock& block) const {
    for (size_t i = 0; i < count; ++i) {
      const Rigid3& pose = poses_[first + i];
      for (int k = 0; k < 4; ++k) block.quaternion[k][i] = pose.rotation.coeffs()[k];
      for (int k = 0; k < 3; ++k) block.translation_m[k][i] = pose.translation[k];
    }
    for (size_t i = first + count; i < std::min(first + 2 * count, poses_.size()); ++i)
      __builtin_prefetch(&poses_[i]);
    // The first one again where there are too few for a block.
    for (size_t i = count; i < kBlockPoses; ++i) {
      for (auto& values : block.quaternion) values[i] = values[0];
      for (auto& values : block.translation_m) values[i] = values[0];
    }
  }

  void Keep(Eigen::Index first, Eigen::Index count, const BatchBlock& block) {
    const auto values = [&](const double* of_block) {
      return Eigen::Map<const Eigen::VectorXd>(of_block, count);
    };
    for (int i = 0; i < kLegCount; ++i)
      result_.of_coordinate.col(i).segment(first, count) = values(block.of_coordinate[i]);
    if (options_.any_direction) {
      result_.position_m.segment(first, count) = values(block.position_m);
      result_.rotation_rad.segment(first, count) = values(block.rotation_rad);
    }
    if (options_.condition)
      result_.inverse_condition_two.segment(first, count) = values(block.inverse_condition_two);
    if (options_.determinant) result_.determinant.segment(first, count) = values(block.determinant);
    if (!options_.joint_readings) return;
    for (int i = 0; i < kLegCount; ++i)
      result_.joint_readings_m.col(order_[i]).segment(first, count) =
          values(block.length_m[i]).array() - robot_.legs[order_[i]].joint_offset_m;
  }

  // ---- The careful path.

  void EvaluateCarefully(size_t i) {
    if (!poses_[i].rotation.coeffs().allFinite() || !poses_[i].translation.allFinite())
      throw std::invalid_argument("EvaluateBatch: pose " + std::to_string(i) + " is not finite");
    FullInverseJacobian inverse_jacobian = FullInverseJacobianOf(robot_, poses_[i]);
    // A leg without length has no direction, and bears no load in any.
    for (auto row : inverse_jacobian.matrix.rowwise())
      if (!row.allFinite()) row.setZero();
    const PlatformJacobian jacobian = Invert(inverse_jacobian);
    result_.status[i] = jacobian.status;
    const auto row = static_cast<Eigen::Index>(i);
    if (options_.determinant) result_.determinant[row] = DeterminantOf(inverse_jacobian);
    SetErrors(row, jacobian);
    if (options_.condition && jacobian.status == PoseStatus::kSingular)
      result_.inverse_condition_two[row] = 0;
    else if (options_.condition)
      SetCondition(i);
  }

  void SetErrors(Eigen::Index row, const PlatformJacobian& jacobian) {
    const bool is_singular = jacobian.status == PoseStatus::kSingular;
    MaximalErrors errors;
    if (!is_singular) errors = MaximalErrorsOf(jacobian, options_.joint_error_bounds_m);
    for (Eigen::Index k = 0; k < kLegCount; ++k)
      result_.of_coordinate(row, k) = is_singular ? kNaN : errors.of_coordinate[k];
    if (!options_.any_direction) return;
    result_.position_m[row] = is_singular ? kNaN : errors.position_m();
    result_.rotation_rad[row] = is_singular ? kNaN : errors.rotation_rad();
  }

  void SetCondition(size_t i) {
    Matrix6d matrix = InverseJacobian(robot_, poses_[i]);
    matrix.rightCols<3>() /= options_.characteristic_length_m;
    result_.inverse_condition_two[static_cast<Eigen::Index>(i)] = 1 / ConditionNumbersOf(matrix).two;
  }

  const GoughStewart& robot_;
  const std::vector<Rigid3>& poses_;
  const BatchOptions& options_;
  Order order_;
  BatchRobot ordered_robot_;
  Kernel kernel_;
  BatchErrors result_;
  std::atomic<size_t> careful_ = 0;
};

}  // namespace

const char* ToString(InstructionSet set) {
  switch (set) {
    case InstructionSet::kBaseline:
      return "baseline";
    case InstructionSet::kAvx2:
      return "avx2";
    case InstructionSet::kAvx512:
      return "avx512";
  }
  throw std::invalid_argument("ToString: not an InstructionSet");
}

std::vector<InstructionSet> AvailableInstructionSets() {
  std::vector<InstructionSet> sets = {InstructionSet::kBaseline};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) sets.push_back(InstructionSet::kAvx2);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("fma"))
    sets.push_back(InstructionSet::kAvx512);
#endif
  return sets;
}

void BatchOptions::Check() const {
  if (!joint_error_bounds_m.allFinite() || !(joint_error_bounds_m.minCoeff() >= 0))
    throw std::invalid_argument("EvaluateBatch: give one bound, 0 or more, for each joint");
  if (!std::isfinite(characteristic_length_m) || !(characteristic_length_m > 0))
    throw std::invalid_argument("EvaluateBatch: the characteristic length has to be positive");
  if (threads < 1) throw std::invalid_argument("EvaluateBatch: one thread at least");
  const std::vector<InstructionSet> available = AvailableInstructionSets();
  if (instruction_set && std::find(available.begin(), available.end(), *instruction_set) == available.end())
    throw std::invalid_argument("EvaluateBatch: this machine does not have the instruction set");
}

BatchErrors EvaluateBatch(const GoughStewart& robot, const std::vector<Rigid3>& base_from_platform,
                          const BatchOptions& options) {
  options.Check();
  CheckRobot(robot);
  return Batch(robot, base_from_platform, options).Evaluate();
}

}  // namespace legible
