/* SPDX-License-Identifier: MIT
 *
 * index.c - builds and refits of an index by one worker and two; and a step with still scenery, all bodies by the broad
 * phase or an index of what stands still. Settled piles and sparse scenes of polygons.
 *
 *     bench_index [--bodies=1000, 30000 and 1000000] [--rounds=7]
 */
#include <stdio.h>
#include <stdlib.h>

#include "common.h"
#include "keys.h"
#include "narc_broad_phase.h"
#include "own.h"
#include "random.h"
#include "scenes.h"
#include "setting.h"

enum { STEPS = 10 };

/* ------------------------------------------------------------------------------------------------ builds */

/* The least time of all rounds: that in which the machine had two cores to give. */
static void compare_builds(const struct setting *s, const char *name, size_t bodies, double spread) {
    enum { GOOD, FAST, REFIT, WAYS };
    const struct own own = make_own(FAMILY_POLYGONS, bodies, spread);
    const size_t count = own.bodies.count;
    const narc_workers two = narc_openmp_workers(2);
    double ns[2 * WAYS][MOST_ROUNDS];
    for (size_t round = 0; round < s->rounds; round++)
        for (int way = 0; way < 2 * WAYS; way++) { /* by one worker, and by two */
            const narc_index_options options = {.fast = way / 2 == FAST, .workers = way % 2 ? &two : NULL};
            const double start = read_clock();
            must(way / 2 == REFIT ? narc_refit_index(own.index, own.boxes, count, &options, NULL, NULL)
                                  : narc_build_index(own.index, own.boxes, count, &options, NULL),
                 NULL);
            ns[way][round] = (read_clock() - start) / (double)count;
        }
    printf("| %zu %s", count, name);
    for (int way = 0; way < 2 * WAYS; way += 2) {
        const double one = quantile(ns[way], s->rounds, 0), by_two = quantile(ns[way + 1], s->rounds, 0);
        printf(" | %.1f, %.1f (%.1f)", one, by_two, one / by_two);
    }
    printf(" |\n");
    fflush(stdout);
}

/* ------------------------------------------------------------------------------------------------ steps */

/* Every eleventh body moves; those stand behind the others. */
struct moving {
    const narc_shapes *shapes;
    struct body *all;
    uint8_t *kinds;
    narc_box *boxes;
    size_t still, count;
    narc_index *index;
    narc_broad_phase *broad_all, *broad_moving;
};

static struct moving make_moving(const struct own *own) {
    const size_t count = own->bodies.count, moving = count / 11;
    struct moving m = {.shapes = own->scene->shapes, .still = count - moving, .count = moving, .index = own->index};
    m.all = allocate(count, sizeof *m.all);
    m.kinds = allocate(count, 1);
    m.boxes = allocate(m.still, sizeof *m.boxes); /* first of what stands still */
    size_t still = 0, end = m.still;
    for (size_t k = 0; k < count; k++)
        m.all[k % 11 == 10 ? end++ : still++] = own->scene->bodies[k];
    for (size_t k = 0; k < m.still; k++)
        m.kinds[k] = NARC_STATIC;
    const narc_bodies scenery = bodies_of(m.all, m.still);
    must(narc_compute_boxes(m.shapes, &scenery, NULL, m.boxes, NULL), NULL);
    must(narc_build_index(m.index, m.boxes, m.still, NULL, NULL), NULL);
    must(narc_create_broad_phase(NULL, &m.broad_all), NULL);
    must(narc_create_broad_phase(NULL, &m.broad_moving), NULL);
    return m;
}

/* All by the broad phase. */
static void step_all(const struct moving *m, float skin, const narc_pair_list **list) {
    const narc_bodies bodies = bodies_of(m->all, m->still + m->count);
    const narc_pair_filter filter = {.kind = {m->kinds, 1}};
    const narc_pair_options options = {.skin = skin, .filter = &filter};
    narc_error error;
    must(narc_update_pairs(m->broad_all, m->shapes, &bodies, &options, list, &error), &error);
}

/* What moves by the broad phase, and against the index. */
static void step_moving(const struct moving *m, float skin, const narc_pair_list **list, narc_pairs *still) {
    const narc_bodies bodies = bodies_of(m->all + m->still, m->count);
    const narc_pair_options options = {.skin = skin};
    narc_error error;
    must(narc_compute_boxes(m->shapes, &bodies, NULL, m->boxes, &error), &error);
    must(narc_query_index(m->index, m->boxes, m->count, NULL, still, &error), &error);
    must(narc_update_pairs(m->broad_moving, m->shapes, &bodies, &options, list, &error), &error);
}

/* Bodies are some 2 in size, and move by up to 0.02 in a step, each in its direction; in every other round back. */
static void compare_step(const struct setting *s, const char *name, size_t bodies, double spread, float skin) {
    const struct own own = make_own(FAMILY_POLYGONS, bodies / 10 * 11, spread);
    const struct moving m = make_moving(&own);
    const narc_pair_list *all = NULL, *moving = NULL;
    narc_pairs still = {0};
    double us[2][MOST_ROUNDS], median[2];
    step_all(&m, skin, &all);
    step_moving(&m, skin, &moving, &still);
    for (size_t round = 0; round < s->rounds; round++) {
        us[0][round] = us[1][round] = 0;
        for (int step = 0; step < STEPS; step++) {
            uint64_t random = 80;
            const double way = round % 2 ? -1 : 1;
            for (struct body *body = m.all + m.still; body < m.all + m.still + m.count; body++) {
                body->x += (float)(way * random_between(&random, -0.02, 0.02));
                body->y += (float)(way * random_between(&random, -0.02, 0.02));
            }
            const double start = now();
            step_all(&m, skin, &all);
            const double between = now();
            step_moving(&m, skin, &moving, &still);
            us[1][round] += (now() - between) / (1000 * STEPS);
            us[0][round] += (between - start) / (1000 * STEPS);
        }
    }
    for (int way = 0; way < 2; way++)
        median[way] = quantile(us[way], s->rounds, 0.5);
    const size_t most = all->pairs.count, room = still.count + moving->pairs.count;
    uint64_t *const left = allocate(most + 1, sizeof *left), *const right = allocate(room + 1, sizeof *right);
    const size_t left_count = add_keys(&all->pairs, 0, 0, left, 0);
    const narc_pairs turned = {.count = still.count, .a = still.b, .b = still.a};
    const size_t still_count = add_keys(&turned, 0, m.still, right, 0);
    const size_t right_count = add_keys(&moving->pairs, m.still, m.still, right, still_count);
    printf("| %zu, %zu %s | %.1f | %.0f | %.0f | %.1f | %zu, %zu | ", m.still, m.count, name, (double)skin, median[0],
           median[1], median[0] / median[1], left_count, right_count);
    if (skin > 0) /* kept boxes are larger, and not the same in both */
        printf(" |\n");
    else
        printf("%zu |\n", count_differences(left, left_count, right, right_count));
    fflush(stdout);
    free(left);
    free(right);
    narc_destroy_broad_phase(m.broad_all);
    narc_destroy_broad_phase(m.broad_moving);
}

static void compare_steps(const struct setting *s, const char *name, size_t bodies, double spread) {
    compare_step(s, name, bodies, spread, 0);
    compare_step(s, name, bodies, spread, 0.2f);
}

int main(int argc, char **argv) {
    const struct setting s = read_setting(argc, argv, "--steps=", STEPS, 7);
    printf("%s, %s, %s\n\n", processor_name(), compiler_name, choose_best_isa());
    printf("| Scene, ns a box by one worker, two (times) | Good | Fast | Refit |\n| --- | --- | --- | --- |\n");
    compare_scenes(&s, compare_builds);
    printf(
        "\n| Still, moving; us a step | Skin | All by the broad phase | Index of what stands still | Times | Pairs | "
        "Differ |\n| --- | --- | --- | --- | --- | --- | --- |\n");
    compare_scenes(&s, compare_steps);
    return 0;
}
