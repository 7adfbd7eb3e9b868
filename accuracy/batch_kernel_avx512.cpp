#define LEGIBLE_KERNEL_NAMESPACE avx512
#define LEGIBLE_KERNEL_WIDTH 8  // poses side by side in a register
#include "accuracy/batch_kernel.inc"
