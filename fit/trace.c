/* SPDX-License-Identifier: MIT
 *
 * trace.c - stub
 */

typedef int stub_unit;
