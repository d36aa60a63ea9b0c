/* SPDX-License-Identifier: MIT
 *
 * index.c - builds and refits of an index; and a step with still scenery, all bodies by the broad phase, or an index of
 * what stands still.
 */
#include <stdlib.h>

#include "common.h"
#include "random.h"
#include "rows.h"

/* ------------------------------------------------------------------------------------------------ builds */

enum build { GOOD, FAST, REFIT };

static void run_build(struct row *row) {
    struct scene *scene = row->scene;
    const narc_index_options options = {.fast = row->question->what == FAST,
                                        .workers = row->threads > 1 ? &row->workers : NULL};
    narc_index *index = row->state;
    narc_error error;
    if (row->question->what == REFIT)
        must(narc_refit_index(index, scene->boxes, scene->body_count, &options, NULL, &error), &error);
    else
        must(narc_build_index(index, scene->boxes, scene->body_count, &options, &error), &error);
}

static void prepare_build(struct row *row) {
    narc_index *index;
    index_scene(row->scene);
    row->bench.count = row->scene->body_count;
    must(narc_create_index(NULL, &index), NULL);
    must(narc_build_index(index, row->scene->boxes, row->scene->body_count, NULL, NULL), NULL);
    row->state = index;
}

/* ------------------------------------------------------------------------------------------------ steps */

enum way { ALL, INDEX, ALL_KEPT, INDEX_KEPT };

/* Every eleventh body moves; those stand behind the others. */
struct moving {
    struct body *all;
    uint8_t *kinds;
    narc_box *boxes;
    size_t still, count, steps;
    narc_index *index;
    narc_broad_phase *broad_all, *broad_moving;
    const narc_pair_list *list_all, *list_moving;
    narc_pairs with_still;
};

/* All by the broad phase. */
static void step_all(struct moving *m, const narc_shapes *shapes, float skin) {
    const narc_bodies bodies = bodies_of(m->all, m->still + m->count);
    const narc_pair_filter filter = {.kind = {m->kinds, 1}};
    const narc_pair_options options = {.skin = skin, .filter = &filter};
    narc_error error;
    must(narc_update_pairs(m->broad_all, shapes, &bodies, &options, &m->list_all, &error), &error);
}

/* What moves by the broad phase, and against the index. */
static void step_moving(struct moving *m, const narc_shapes *shapes, float skin) {
    const narc_bodies bodies = bodies_of(m->all + m->still, m->count);
    const narc_pair_options options = {.skin = skin};
    narc_error error;
    must(narc_compute_boxes(shapes, &bodies, NULL, m->boxes, &error), &error);
    must(narc_query_index(m->index, m->boxes, m->count, NULL, &m->with_still, &error), &error);
    must(narc_update_pairs(m->broad_moving, shapes, &bodies, &options, &m->list_moving, &error), &error);
}

/* Bodies are some 2 in size, and move by up to 0.02 in a step, each in its direction, ten steps there and ten back. */
static void run_step(struct row *row) {
    struct moving *m = row->state;
    const float skin = row->question->what >= ALL_KEPT ? 0.2f : 0;
    const double way = m->steps++ / 10 % 2 ? -1 : 1;
    uint64_t random = 80;
    for (struct body *body = m->all + m->still; body < m->all + m->still + m->count; body++) {
        body->x += (float)(way * random_between(&random, -0.02, 0.02));
        body->y += (float)(way * random_between(&random, -0.02, 0.02));
    }
    const double start = now();
    if (row->question->what % 2 == ALL)
        step_all(m, row->scene->shapes, skin);
    else
        step_moving(m, row->scene->shapes, skin);
    row->bench.seconds = 1e-9 * (now() - start);
}

/* Both find the same pairs, but that kept boxes are larger, and not the same in both. */
static double count_step_differences(struct moving *m, const narc_shapes *shapes) {
    step_all(m, shapes, 0);
    step_moving(m, shapes, 0);
    const size_t most = m->list_all->pairs.count, room = m->with_still.count + m->list_moving->pairs.count;
    uint64_t *left = allocate(most + 1, sizeof *left), *right = allocate(room + 1, sizeof *right);
    const size_t left_count = add_keys(&m->list_all->pairs, 0, 0, left, 0);
    const narc_pairs turned = {.count = m->with_still.count, .a = m->with_still.b, .b = m->with_still.a};
    size_t right_count = add_keys(&turned, 0, m->still, right, 0);
    right_count = add_keys(&m->list_moving->pairs, m->still, m->still, right, right_count);
    const size_t differences = count_differences(left, left_count, right, right_count);
    free(left);
    free(right);
    return (double)differences;
}

static void prepare_step(struct row *row) {
    struct moving *m = row->state = allocate(1, sizeof *m);
    const struct scene *scene = row->scene;
    const size_t count = scene->body_count, moving = count / 11;
    size_t still = 0, end = count - moving;
    *m = (struct moving){.still = count - moving, .count = moving};
    m->all = allocate(count, sizeof *m->all);
    m->kinds = allocate(count, 1);
    m->boxes = allocate(m->still, sizeof *m->boxes); /* first of what stands still */
    for (size_t k = 0; k < count; k++)
        m->all[k % 11 == 10 ? end++ : still++] = scene->bodies[k];
    for (size_t k = 0; k < m->still; k++)
        m->kinds[k] = NARC_STATIC;
    const narc_bodies scenery = bodies_of(m->all, m->still);
    must(narc_compute_boxes(scene->shapes, &scenery, NULL, m->boxes, NULL), NULL);
    must(narc_create_index(NULL, &m->index), NULL);
    must(narc_build_index(m->index, m->boxes, m->still, NULL, NULL), NULL);
    must(narc_create_broad_phase(NULL, &m->broad_all), NULL);
    must(narc_create_broad_phase(NULL, &m->broad_moving), NULL);
    row->bench.count = 1; /* a step */
    row->bench.wrong = count_step_differences(m, scene->shapes);
}

const struct question index_questions[] = {{"index-good", prepare_build, run_build, GOOD, false},
                                           {"index-fast", prepare_build, run_build, FAST, false},
                                           {"index-refit", prepare_build, run_build, REFIT, false},
                                           {"still-all", prepare_step, run_step, ALL, true},
                                           {"still-index", prepare_step, run_step, INDEX, true},
                                           {"still-all-kept", prepare_step, run_step, ALL_KEPT, true},
                                           {"still-index-kept", prepare_step, run_step, INDEX_KEPT, true},
                                           {.name = NULL}};
