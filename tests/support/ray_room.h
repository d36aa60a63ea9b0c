/* SPDX-License-Identifier: MIT
 *
 * ray_room.h - scenes of many bodies with their index, and rays through them.
 */
#ifndef NARC_TEST_RAY_ROOM_H
#define NARC_TEST_RAY_ROOM_H

#include "ray_reference.h"

/* A scene with its index and its boxes. */
struct room {
    struct scene scene;
    narc_index *index;
    narc_box *boxes;
    uint64_t *category;
};

/* Bodies of all families over and beside each other; every fifth one stands where the one before it does, and is the
 * same. One is broken, and one has a removed shape. */
struct room create_room(struct test_random *random, narc_precision precision, size_t count, double side);
void destroy_room(struct room *room);

/* Computes the boxes and builds the index anew. */
void index_room(struct room *room, bool fast, bool masks);

/* Long and short ones, from anywhere, along axes and past corners of bodies; half of them in fans. */
struct test_ray *make_rays(struct test_random *random, const struct room *room, size_t count, double side);

/* What they hit, in guarded memory. */
narc_ray_hit *cast_in_room(const struct room *room, const narc_rays *rays, const narc_ray_options *options);

#endif
