/* SPDX-License-Identifier: MIT
 *
 * fit_svg.h - what the tests of the SVG reader share.
 */
#ifndef NARC_TEST_FIT_SVG_H
#define NARC_TEST_FIT_SVG_H

#include "fit_support.h"

/* One command of an outline that is to come out, in absolute SVG coordinates (y down). The last has kind 0. */
struct op {
    char kind; /* M, L, Q or C */
    double n[6];
};

/* The contours of an SVG file whose root holds `body`, from line 2 on, at the default flatness. */
narc_contours read_body(const char *body);

/* The same, for another root: `attributes` stand in its tag. */
narc_contours read_root(const char *attributes, const char *body);

/* What comes out of `body` is the outline that `ops` draws, bit for bit but for the sign of zero. */
void expect_outline(const char *body, const struct op *ops);

/* The same up to `tolerance` in each coordinate; for outlines without curves. */
void expect_outline_near(const char *body, const struct op *ops, double tolerance);

int test_svg_tree(void);
int test_svg_damage(void);

#endif
