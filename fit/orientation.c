/* SPDX-License-Identifier: MIT
 *
 * orientation.c - the sign of the area of a triangle, after Shewchuk, "Adaptive precision floating-point arithmetic and
 * fast robust geometric predicates" (1997): the rounded area if its sign is certain, else a sum without rounding.
 */
#include "orientation.h"

#include <float.h>
#include <math.h>
#include <stddef.h>

/* The rounded area is off by at most (3 + 16 u) u times the sum of its two products, u = DBL_EPSILON / 2. */
static const double ERROR_BOUND = 2 * DBL_EPSILON;

/* A sum without rounding: terms of rising size that do not overlap. */
typedef struct expansion {
    double terms[12];
    size_t count;
} expansion;

static void add_term(expansion *sum, double carry) {
    for (size_t i = 0; i < sum->count; i++) {
        /* carry + term = whole + rest, exactly (Knuth's two-sum). */
        const double term = sum->terms[i], whole = carry + term, part = whole - carry;
        sum->terms[i] = (carry - (whole - part)) + (term - part);
        carry = whole;
    }
    sum->terms[sum->count++] = carry;
}

static void add_product(expansion *sum, double a, double b) {
    const double product = a * b;
    add_term(sum, fma(a, b, -product)); /* what the product lost in rounding */
    add_term(sum, product);
}

static int sign_of(double value) { return (value > 0) - (value < 0); }

static int find_exactly(narc_point a, narc_point b, narc_point c) {
    expansion sum = {.count = 0};
    add_product(&sum, a.x, b.y);
    add_product(&sum, -a.y, b.x);
    add_product(&sum, b.x, c.y);
    add_product(&sum, -b.y, c.x);
    add_product(&sum, c.x, a.y);
    add_product(&sum, -c.y, a.x);
    for (size_t i = sum.count; i-- > 0;) { /* the largest term outweighs all others */
        if (sum.terms[i] != 0) {
            return sign_of(sum.terms[i]);
        }
    }
    return 0;
}

int narc_find_orientation(narc_point a, narc_point b, narc_point c) {
    const double left = (b.x - a.x) * (c.y - a.y), right = (b.y - a.y) * (c.x - a.x);
    const double area = left - right;
    return fabs(area) > ERROR_BOUND * (fabs(left) + fabs(right)) ? sign_of(area) : find_exactly(a, b, c);
}
