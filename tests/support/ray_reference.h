/* SPDX-License-Identifier: MIT
 *
 * ray_reference.h - rays that are hard to answer, and what is right, in long double and straight from the definition.
 *
 * The signed distance from a point to a convex body is the largest of n.p - h(n) over all unit normals, h the support
 * function. Along a line it is a convex function, so that its least value is found by narrowing down. Whether a hit is
 * right is asked of the hit itself: is its point on the outline and on the ray, and is nothing before it inside?
 */
#ifndef NARC_TEST_RAY_REFERENCE_H
#define NARC_TEST_RAY_REFERENCE_H

#include "narc_scene.h"
#include "scene.h"

/* A shape with the normals at the ends of its arcs. */
struct outline_reference {
    size_t count;
    const narc_arc *arcs;
    long double center_x[NARC_MAX_ARCS], center_y[NARC_MAX_ARCS], radius[NARC_MAX_ARCS];
    long double start_x[NARC_MAX_ARCS], start_y[NARC_MAX_ARCS], end_x[NARC_MAX_ARCS], end_y[NARC_MAX_ARCS];
    long double extent;
    bool is_own; /* is the extent less than 250 radii of the circle around the shape? */
};

struct outline_reference make_outline_reference(const struct shape *shape);

/* Signed distance from a point in the shape's coordinates. */
long double find_signed_distance(const struct outline_reference *outline, long double x, long double y);

/* A ray as its caller gives it. */
struct test_ray {
    double x, y; /* rounded to the precision of the columns */
    float motion_x, motion_y;
    float fraction;
};

/* What a ray does to a body, as it should be: the ray is near the outline at most (grazes), starts near it or within. */
struct ray_truth {
    long double start; /* the signed distance where it starts */
    long double least; /* and the least one on its way */
    long double bound; /* what is allowed; all three in the shape's unit */
};
struct ray_truth find_ray_truth(const struct outline_reference *outline, const struct body *body,
                                const struct test_ray *ray);

/* Errors as parts of what is allowed. */
struct ray_errors {
    double outline, ray, early, normal;
};

/* Is a hit right, or that there is none (hit->count 0)? NULL, or what is wrong. */
const char *check_ray_hit(const struct outline_reference *outline, const struct body *body, const struct test_ray *ray,
                          narc_inside inside, const narc_ray_hit *hit, struct ray_errors *worst);

/* Rays at a body that shortcuts go wrong on. */
enum ray_kind {
    RAY_ANY,      /* somewhere near the body */
    RAY_TANGENT,  /* along a support line, or beside it by 1e-9 .. 1e-3 sizes */
    RAY_JUNCTION, /* along that at a junction */
    RAY_POINT,    /* through the end of an arc: a junction, a corner, the seam of a circle; in any direction */
    RAY_EDGE,     /* nearly along an edge */
    RAY_INSIDE,   /* from within, or from the outline */
    RAY_KINDS
};
const char *ray_kind_name(enum ray_kind kind);
struct test_ray make_ray(struct test_random *random, const struct shape *shape, const struct body *body,
                         narc_precision precision, enum ray_kind kind);

/* Rays as columns. */
narc_rays view_rays(const struct test_ray *rays, size_t count);

#endif
