#define LEGIBLE_KERNEL_NAMESPACE baseline
#define LEGIBLE_KERNEL_WIDTH 2  // poses side by side in a register
#include "accuracy/batch_kernel.inc"
