/* SPDX-License-Identifier: MIT
 *
 * formula.h - the exact test of narc as a formula: short, slow, in double precision. docs/algorithm.md derives it.
 */
#ifndef FORMULA_H
#define FORMULA_H

typedef struct {
    double x, y;
} vector;

typedef struct { /* outward normals from the angle `start` counter-clockwise to `end`; radius 0 is a corner */
    vector center;
    double radius, start, end;
} arc;

typedef struct { /* closed, convex, counter-clockwise; a circle is one arc with a sweep of 2 pi */
    const arc *arcs;
    int count;
} shape;

typedef struct {
    vector position;
    double angle, scale;
} pose;

/* The signed distance of two bodies: positive when they are apart, minus the penetration depth when they overlap.
 * -INFINITY if a shape has no arcs. Shapes are not checked. */
double formula_separation(shape a, pose pose_a, shape b, pose pose_b);

#endif
