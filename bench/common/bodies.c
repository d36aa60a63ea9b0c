/* SPDX-License-Identifier: MIT
 *
 * bodies.c - bodies at random, pairs that touch, pairs whose boxes overlap.
 */
#include "bodies.h"

#include <math.h>
#include <stdlib.h>

#include "common.h"
#include "random.h"

/* Newton's method ends when no gap is above this, or after so many steps. */
static const double touching = 3e-6;
enum { NEWTON_STEPS = 50 };

struct body random_body(uint64_t *random, size_t shape, double half_width) {
    const double angle = random_between(random, -pi, pi);
    const double x = random_between(random, -half_width, half_width);
    return (struct body){(float)x, (float)random_between(random, -half_width, half_width), (float)cos(angle),
                         (float)sin(angle), (uint32_t)shape};
}

narc_bodies bodies_of(const struct body *bodies, size_t count) {
    return (narc_bodies){.count = count,
                         .x = NARC_POSITION_COLUMN(bodies, x),
                         .y = NARC_POSITION_COLUMN(bodies, y),
                         .cosine = NARC_COLUMN(bodies, cosine),
                         .sine = NARC_COLUMN(bodies, sine),
                         .shape = NARC_COLUMN(bodies, shape)};
}

narc_pairs neighbours(size_t pair_count) {
    static uint32_t *list;
    static size_t room;
    if (pair_count > room) {
        free(list);
        list = allocate(2 * pair_count, sizeof *list);
        room = pair_count;
        for (size_t k = 0; k < 2 * pair_count; k++)
            list[k] = (uint32_t)k;
    }
    return (narc_pairs){.count = pair_count, .a = {list, 2 * sizeof *list}, .b = {list + 1, 2 * sizeof *list}};
}

void separate(const narc_shapes *shapes, const struct body *bodies, size_t pair_count, narc_contact *out) {
    const narc_bodies columns = bodies_of(bodies, 2 * pair_count);
    const narc_pairs pairs = neighbours(pair_count);
    const narc_query query = {.margin = INFINITY, .workers = all_workers()};
    narc_error error;
    size_t found = 0;
    must(narc_find_contacts(shapes, &columns, &pairs, &query, out, pair_count, &found, &error), &error);
}

struct direction random_direction(uint64_t *random) {
    const double angle = random_between(random, -pi, pi);
    return (struct direction){cos(angle), sin(angle)};
}

void put_second(struct body *pair, struct direction direction, double distance) {
    pair[1].x = (float)(pair[0].x + distance * direction.x);
    pair[1].y = (float)(pair[0].y + distance * direction.y);
}

/* Along a line that starts inside, the gap is convex and crosses zero once: Newton's method comes down to it from
 * outside without passing it. */
void find_touching(const narc_shapes *shapes, struct body *bodies, const struct direction *directions,
                   size_t pair_count, double *distances) {
    narc_contact *contacts = allocate(pair_count, sizeof *contacts);
    double most = INFINITY;
    for (int step = 0; step < NEWTON_STEPS && most >= touching; step++) {
        for (size_t k = 0; k < pair_count; k++)
            put_second(&bodies[2 * k], directions[k], distances[k]);
        separate(shapes, bodies, pair_count, contacts);
        most = 0;
        for (size_t k = 0; k < pair_count; k++) {
            const double gap = contacts[k].separation;
            const double slope = contacts[k].normal_x * directions[k].x + contacts[k].normal_y * directions[k].y;
            distances[k] -= gap / slope;
            most = fmax(most, gap);
        }
    }
    free(contacts);
}

narc_aabb box_of(const narc_shapes *shapes, const struct body *body) {
    narc_aabb box;
    if (!narc_get_aabb(shapes, body->shape, body->cosine, body->sine, 1, &box))
        fail("a body without a box");
    return box;
}

void put_in_boxes(const narc_shapes *shapes, const struct body *a, struct body *b, uint64_t *random) {
    const narc_aabb box_a = box_of(shapes, a), box_b = box_of(shapes, b);
    b->x = (float)(a->x + random_between(random, box_a.min_x - box_b.max_x, box_a.max_x - box_b.min_x));
    b->y = (float)(a->y + random_between(random, box_a.min_y - box_b.max_y, box_a.max_y - box_b.min_y));
}
