/* SPDX-License-Identifier: MIT
 *
 * picture_bodies.h - a picture of bodies and their contacts.
 */
#ifndef NARC_TOOL_PICTURE_BODIES_H
#define NARC_TOOL_PICTURE_BODIES_H

#include <stdio.h>

#include "bodies.h"
#include "narc_scene.h"

/* From where a ray starts to what it hits, or to its end. */
typedef struct drawn_ray {
    double x, y, end_x, end_y;
    narc_ray_hit hit;
} drawn_ray;

typedef struct body_scene {
    const narc_shape_list *shapes;
    const narc_shapes *store; /* entries of chains are drawn as it has them */
    const body_list *bodies;
    const narc_aabb *boxes; /* of the bodies */
    const bool *marked;     /* of the bodies: is it in a colliding pair, or hit by a ray? */
    const pair_list *pairs; /* those that contacts are of */
    const narc_contact *contacts;
    size_t contact_count;
    bool is_filter; /* the pairs passed a filter: they may collide */
    const drawn_ray *rays;
    size_t ray_count, hits_per_ray; /* of each ray its nearest hit comes first */
} body_scene;

/* A picture that would have too many bodies is an error; `path` may be NULL, no picture. */
void check_picture_size(const char *path, size_t body_count);

/* `file` is an open output for `path`, whose suffix tells the kind. */
void draw_bodies(const char *path, FILE *file, const body_scene *scene);

#endif
