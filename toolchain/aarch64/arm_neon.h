/* SPDX-License-Identifier: Apache-2.0
 * Stands before the compiler's own. Eigen asks by name for fused multiply-adds where the compiler says that
 * there are some, and would round once less than on the other architecture; the compiler's header itself must
 * see it. */
#pragma GCC system_header
#include_next <arm_neon.h>
#undef __ARM_FEATURE_FMA
