#define LEGIBLE_KERNEL_NAMESPACE avx2
#define LEGIBLE_KERNEL_WIDTH 4  // poses side by side in a register
#include "accuracy/batch_kernel.inc"
