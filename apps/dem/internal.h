/* SPDX-License-Identifier: MIT
 *
 * internal.h - what the parts of the program call of each other.
 */
#ifndef DEM_INTERNAL_H
#define DEM_INTERNAL_H

#include "dem.h"

/* Contacts are worked on in blocks of this many. A block's sums do not depend on who makes them. */
enum { DEM_BLOCK = 256 };

/* What a block of contacts adds up to. */
typedef struct dem_sums {
    size_t count; /* of contacts */
    double normal_energy, tangential_energy, rolling_energy;
    double old_springs; /* what the springs of these contacts held in the last step */
    double damping, friction;
    size_t too_deep; /* the first pair that is, or SIZE_MAX */
} dem_sums;

/* A pair that narc does not find: across a periodic border, or with a plate. */
typedef struct dem_extra {
    uint32_t a, b;
    float shift_x, shift_y;
} dem_extra;

typedef struct dem_scratch {
    narc_box *boxes; /* parts, then images of parts */
    uint8_t *still;
    uint32_t *group;          /* the body + 1, of an image too */
    uint32_t *image_of;       /* a part */
    float *image_x, *image_y; /* where an image is, from its body */
    size_t box_capacity, image_count;
    const uint32_t *found_a, *found_b; /* pairs of boxes; the broad phase owns them */
    size_t found_count;
    uint32_t *match;
    dem_extra *extra;
    size_t extra_count, extra_capacity;
    bool adds; /* a single thread adds forces to bodies as it finds them, several do when all are found */
    dem_sums *sums;
    size_t sums_capacity;
    narc_body *poses; /* of all parts, when narc was last asked */
    size_t pose_capacity;
} dem_scratch;

/* model.c: an array with room for `needed` items; grows by halves. The items that there are stay. */
bool dem_reserve(dem *d, void *array_pointer, size_t *capacity, size_t needed, size_t size);
bool dem_resize(dem *d, void *array_pointer, size_t count, size_t size);
bool dem_grow_pairs(dem *d, dem_pairs *pairs, size_t needed);
/* The bodies of a pair. */
static inline size_t dem_body_a(const dem *d, size_t pair) { return d->parts.body[d->pairs.a[pair]]; }
static inline size_t dem_body_b(const dem *d, size_t pair) { return d->parts.body[d->pairs.b[pair]]; }

/* By how many cells the B of a pair is above A: its image. */
static inline int dem_find_lift(const dem *d, size_t pair) {
    return (d->pairs.shift_y[pair] > 0) - (d->pairs.shift_y[pair] < 0);
}

/* A rotation is a unit vector, and turns within a step by 2 atan(angle / 2), which is the angle to the third order and
 * needs no sine. What rounding takes from its length is given back each time. */
static inline dem_vec dem_find_turn(double angle) {
    const double half = 0.5 * angle, share = 1 / (1 + half * half);
    return (dem_vec){(1 - half * half) * share, 2 * half * share};
}

static inline void dem_turn(const dem_bodies *b, size_t k, dem_vec by) {
    const double c = b->cosine[k] * by.x - b->sine[k] * by.y, s = b->sine[k] * by.x + b->cosine[k] * by.y;
    const double unit = 1.5 - 0.5 * (c * c + s * s);
    b->cosine[k] = c * unit;
    b->sine[k] = s * unit;
}

/* All parts where they are now, for narc, until the next call. */
bool dem_make_poses(dem *d, narc_bodies *out);
bool dem_fail_narc(dem *d, const char *what, const narc_error *error);
bool dem_find_broken_body(dem *d);
unsigned dem_team(const dem *d); /* threads */
narc_workers dem_workers(const dem *d);
bool dem_has_rolling(const dem *d);
double dem_cell_width(const dem *d);
double dem_cell_height(const dem *d);

/* The arrays of bodies, as bytes: for the restart and the hash. NULL behind the last. */
void *dem_body_column(const dem *d, size_t index, size_t *out_item_size);

/* measures.c: FNV-1a, 64 bits, continued */
#define DEM_HASH_START 0xcbf29ce484222325u
uint64_t dem_hash_bytes(uint64_t hash, const void *bytes, size_t size);

/* neighbours.c */
bool dem_make_room_for_boxes(dem *d, size_t count);

/* step.c: as many as there is room for pairs */
bool dem_make_room_for_contacts(dem *d);

/* boundary.c */
void dem_wrap_bodies(dem *d);
bool dem_add_images(dem *d);
void dem_shear_cell(dem *d);                       /* the way of a step */
void dem_count_shear_work(dem *d);                 /* of half a step, with the forces as they are */
dem_vec dem_find_shift(const dem *d, size_t pair); /* of B, exactly */
double dem_find_drift(const dem *d);               /* the speed of the cell above */
bool dem_take_image_pairs(dem *d);                 /* adds the found pairs with images to the extra ones */

/* walls.c */
bool dem_steer_walls(dem *d);
void dem_move_walls(dem *d);
void dem_count_wall_work(dem *d);
bool dem_add_plate_pairs(dem *d);

/* laws.c */
void dem_find_dashpots(dem *d);
bool dem_apply_laws(dem *d);
bool dem_find_first_forces(dem *d); /* of where bodies begin */

#endif
