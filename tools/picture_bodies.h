/* SPDX-License-Identifier: MIT
 *
 * picture_bodies.h - a picture of bodies and their contacts.
 */
#ifndef NARC_TOOL_PICTURE_BODIES_H
#define NARC_TOOL_PICTURE_BODIES_H

#include <stdio.h>

#include "bodies.h"

typedef struct body_scene {
    const narc_shape_list *shapes;
    const body_list *bodies;
    const narc_aabb *boxes; /* of the bodies */
    const bool *colliding;  /* of the bodies: is it in a colliding pair? */
    const pair_list *pairs;
    const narc_contact *contacts;
    size_t contact_count;
    bool is_filter; /* the pairs passed a filter: they may collide */
} body_scene;

/* A picture that would have too many bodies is an error; `path` may be NULL, no picture. */
void check_picture_size(const char *path, size_t body_count);

/* `file` is an open output for `path`, whose suffix tells the kind. */
void draw_bodies(const char *path, FILE *file, const body_scene *scene);

#endif
