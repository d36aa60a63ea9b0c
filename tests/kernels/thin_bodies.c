/* SPDX-License-Identifier: MIT
 *
 * thin_bodies.c - thin bodies that lean deep into curved ground: what lies across the surface is told of, also where the
 * piece that is deepest below it is not the one that its outline crosses. Of rods that lean by more than two pieces some
 * are not, one of thousands of all bodies.
 */
#include <math.h>
#include <stdlib.h>

#include "expect.h"
#include "families.h"
#include "narc.h"
#include "narc_chains.h"
#include "turtle.h"

enum { WAVES = 8, ENTRIES = 64, ROWS = 4 * ENTRIES, KINDS = 5 };

#define WAVE_TURN 1.0

/* Hills and bowls whose arcs are 0.5 to 2 long, in turn. */
static narc_arc *walk_waves(struct test_random *random, size_t *out_count) {
    struct turtle t = create_turtle(9, 0, TEST_PI / 2 - WAVE_TURN / 2);
    for (int k = 0; k < WAVES; k++) {
        walk_arc(&t, random_log_between(random, 0.5, 2), WAVE_TURN);
        walk_arc(&t, random_log_between(random, 0.5, 2), -WAVE_TURN);
    }
    *out_count = t.count;
    return t.arcs;
}

static void build(struct test_random *random, int kind, narc_arc *arcs, size_t *out_count) {
    const double length = random_log_between(random, 0.2, 2);
    narc_error error = {0};
    const narc_status status =
        kind == 0 ? narc_build_box(length, length * random_log_between(random, 0.002, 0.05), 0, arcs, out_count, &error)
        : kind == 1 ? narc_build_capsule(length, 0.02 * length, arcs, out_count, &error)
        : kind == 2 ? narc_build_box(length, length * random_between(random, 0.1, 0.9), 0, arcs, out_count, &error)
        : kind == 3 ? narc_build_regular_polygon(3, length / 2, 0, arcs, out_count, &error)
                    : narc_build_ellipse(length / 2, length * random_between(random, 0.05, 0.45), 8, arcs, out_count,
                                         NULL, &error);
    expect_ok(status, &error);
}

/* A body whose point that lies furthest down along a normal of the ground is `depth` below a place of one of its arcs,
 * turned at random or with an edge along it. */
static narc_body lean(struct test_random *random, const narc_arc *ground, const narc_arc *arcs, size_t count,
                      uint32_t shape, double *out_depth) {
    const double part = random_between(random, 0, 1), angle = ground->start + part * (ground->end - ground->start);
    const double n_x = cos(angle), n_y = sin(angle);
    const double turned = random_below(random, 3) ? random_between(random, -TEST_PI, TEST_PI)
                                                  : angle + (double)random_below(random, 4) * TEST_PI / 2 +
                                                        random_log_between(random, 1e-7, 0.1);
    const float cosine = (float)cos(turned), sine = (float)sin(turned);
    const double c = (double)cosine, s = (double)sine, down_x = -(n_x * c + n_y * s), down_y = n_x * s - n_y * c;
    narc_point low, high;
    assert_true(narc_find_support(arcs, count, down_x, down_y, &low, NULL));
    assert_true(narc_find_support(arcs, count, -down_x, -down_y, &high, NULL));
    const double width = (low.x - high.x) * down_x + (low.y - high.y) * down_y;
    *out_depth = random_log_between(random, 1e-3, 0.5) * width;
    return (narc_body){.x = ground->center_x + (ground->radius - *out_depth) * n_x - (c * low.x - s * low.y),
                       .y = ground->center_y + (ground->radius - *out_depth) * n_y - (s * low.x + c * low.y),
                       .cosine = cosine,
                       .sine = sine,
                       .scale = 1,
                       .shape = shape};
}

static size_t count_rows(const narc_shapes *store, const narc_body *bodies, size_t entries) {
    uint32_t a[ENTRIES], b[ENTRIES];
    narc_contact rows[ROWS];
    size_t count = 0;
    narc_error error = {0};
    for (size_t k = 0; k < entries; k++) {
        a[k] = (uint32_t)entries;
        b[k] = (uint32_t)k;
    }
    narc_bodies columns;
    narc_view_bodies(bodies, entries + 1, &columns);
    const narc_pairs pairs = {.count = entries, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
    expect_ok(narc_find_contacts(store, &columns, &pairs, NULL, rows, ROWS, &count, &error), &error);
    return count;
}

TEST(test_leaning_bodies_keep_contacts) {
    struct test_random random = test_random_named("leaning bodies");
    size_t lost = 0, placed = 0;
    for (size_t round = 0; round < test_trials(1000); round++) {
        AUTO(narc_destroy_shapes_at) narc_shapes *store = empty_store();
        narc_chain_entry entries[ENTRIES];
        narc_body bodies[ENTRIES + 1];
        narc_arc arcs[NARC_MAX_ARCS];
        size_t waves, count, entry_count;
        uint32_t shape;
        narc_error error = {0};
        AUTO(free_at) narc_arc *ground = walk_waves(&random, &waves);
        expect_ok(narc_add_chain(store, ground, waves, NULL, entries, ENTRIES, &entry_count, &error), &error);
        for (size_t k = 0; k < entry_count; k++)
            bodies[k] =
                (narc_body){.x = entries[k].x, .y = entries[k].y, .cosine = 1, .scale = 1, .shape = entries[k].shape};
        build(&random, (int)(round % KINDS), arcs, &count);
        expect_ok(narc_add_shape(store, arcs, count, &shape, &error), &error);
        for (int k = 0; k < 20; k++) {
            const size_t at = 2 + random_below(&random, (uint32_t)waves - 4); /* not at open ends */
            double depth;
            bodies[entry_count] = lean(&random, &ground[at], arcs, count, shape, &depth);
            if (depth > 0.25 * fabs(ground[at].radius * WAVE_TURN))
                continue;
            placed++;
            if (count_rows(store, bodies, entry_count) == 0) {
                lost++;
                print_error("kind %zu, depth %g: nothing told\n", round % KINDS, depth);
            }
        }
    }
    print_message("%zu bodies, %zu lost\n", placed, lost);
    assert_true(placed > 0 && 1000 * lost <= placed + 1000);
}

TEST_MAIN("thin_bodies")
