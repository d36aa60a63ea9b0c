/* SPDX-License-Identifier: MIT
 *
 * discs.c - contacts of discs by a plain loop that knows nothing else: what one writes who has discs alone.
 */
#include <math.h>
#include <string.h>

#include "common.h"
#include "peers.h"

/* All that there is to know of a body. */
struct disc {
    float x, y, radius;
};

/* Every run takes the other of two frames, as this library's rows do. */
struct frames {
    const double *gaps; /* of the first */
    struct disc *discs[2];
    size_t runs;
    narc_contact *contacts;
};

static void *create(struct scene *scene) {
    struct frames *frames = allocate(1, sizeof *frames);
    frames->gaps = gaps_of(scene);
    frames->contacts = allocate(scene->pair_count, sizeof *frames->contacts);
    for (int frame = 0; frame < 2; frame++) {
        const struct scene *of = get_scene(scene->family, scene->kind, frame);
        frames->discs[frame] = allocate(of->body_count, sizeof *frames->discs[frame]);
        for (size_t k = 0; k < of->body_count; k++)
            frames->discs[frame][k] = (struct disc){of->bodies[k].x, of->bodies[k].y,
                                                    (float)of->outlines[of->bodies[k].shape].arcs[0].radius};
    }
    return frames;
}

/* Writes the contacts of the pairs that collide, in the order of the pairs. */
static size_t find_contacts(const struct disc *discs, const struct pair *pairs, size_t count, narc_contact *out) {
    size_t found = 0;
    for (size_t k = 0; k < count; k++) {
        const struct disc *a = &discs[pairs[k].a], *b = &discs[pairs[k].b];
        const float x = b->x - a->x, y = b->y - a->y, radii = a->radius + b->radius, square = x * x + y * y;
        if (!(square < radii * radii))
            continue;
        const float length = sqrtf(square), n_x = length > 0 ? x / length : 1, n_y = length > 0 ? y / length : 0;
        const float along = 0.5f * (length + a->radius - b->radius);
        out[found++] = (narc_contact){.pair = (uint32_t)k,
                                      .count = 1,
                                      .separation = length - radii,
                                      .normal_x = n_x,
                                      .normal_y = n_y,
                                      .point_x = n_x * along,
                                      .point_y = n_y * along,
                                      .radius_a = a->radius,
                                      .radius_b = b->radius};
    }
    return found;
}

/* A separation that is not the exact one is neither yes nor no. */
static size_t ask(void *context, const struct asked *asked, void *out) {
    struct frames *frames = context;
    uint8_t *colliding = out;
    const size_t frame = asked->checks ? 0 : frames->runs++ % 2;
    const size_t found = find_contacts(frames->discs[frame], asked->pairs, asked->count, frames->contacts);
    if (!asked->checks)
        return found;
    memset(colliding, 0, asked->count);
    for (size_t k = 0; k < found; k++) {
        const narc_contact *contact = &frames->contacts[k];
        colliding[contact->pair] = fabs((double)contact->separation - frames->gaps[contact->pair]) < TOUCHING ? 1 : 2;
    }
    return found;
}

const struct peer disc_loop = {
    .question = "contact", .name = "loop", .arcs = true, .max_edges = MAX_EDGES, .create = create, .ask = ask};
