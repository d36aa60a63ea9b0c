/* SPDX-License-Identifier: MIT
 *
 * plain_kernels.h - the kernels without their shortcuts: every pair goes to the deciding formula.
 */
#ifndef NARC_TEST_PLAIN_KERNELS_H
#define NARC_TEST_PLAIN_KERNELS_H

#include "kernels.h"

extern const narc_kernel_table narc_kernels_plain;

#endif
