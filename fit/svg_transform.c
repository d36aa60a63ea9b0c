/* SPDX-License-Identifier: MIT
 *
 * svg_transform.c - stub
 */

typedef int stub_unit;
