/* SPDX-License-Identifier: MIT
 *
 * shapes.h - the random shapes of the benchmarks, of a radius around 1.
 */
#ifndef NARC_BENCH_SHAPES_H
#define NARC_BENCH_SHAPES_H

#include "exact.h"
#include "narc.h"

/* A random n-arc. */
struct outline make_n_arc(uint64_t *random, size_t n);

/* The polygon whose vertices are the junctions of an n-arc. */
struct outline polygon_of(const struct outline *n_arc);

/* The same, grown around the origin to the area of the n-arc. */
struct outline polygon_as_large_as(const struct outline *n_arc);

/* The polygon of the junctions, 0.8 times as large, with an arc of radius 0.2 around each vertex. */
struct outline round_polygon(const struct outline *n_arc);

/* A rectangle, its sides 1 .. 2.4 long. */
struct outline make_box(uint64_t *random);

/* A square with sides of 1. */
struct outline make_square(void);

struct outline make_circle(double radius);

/* A capsule: a segment 1 .. 2.4 long with a radius of 0.35 .. 0.6. */
struct outline make_capsule(uint64_t *random);

/* The box that is as wide as a capsule, and has its area. */
struct outline box_as_large_as(const struct outline *capsule);

double area_of(const struct outline *outline);

/* No point of the outline is further from the origin. */
double reach_of(const struct outline *outline);

/* The radius of the smallest circle around the outline. */
double bounding_radius(const struct outline *outline);

/* The junctions: where arc k starts. */
struct vector junction_of(const struct outline *outline, size_t k);

/* Adds an outline to a store. */
void add_outline(narc_shapes *shapes, const struct outline *outline);

#endif
