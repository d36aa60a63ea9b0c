/* SPDX-License-Identifier: MIT
 *
 * svg_path.c - stub
 */

typedef int stub_unit;
