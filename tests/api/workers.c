/* SPDX-License-Identifier: MIT
 *
 * workers.c - the caller's own threads: every batch call gives the same bytes whoever runs its tasks, and asks for no more
 * than it was told that there are, never within a task, and never for little work.
 */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <string.h>

#include "narc.h"
#include "narc_broad_phase.h"
#include "narc_contacts.h"
#include "narc_scene.h"
#include "support.h"

enum { BODIES = 8000, FEW = 40, PAIRS = 60000, THREADS = 3 };

#define OK(call) assert_int_equal(call, NARC_OK)

typedef void task_function(void *argument, unsigned index);
typedef void run_function(void *context, unsigned count, task_function *task, void *argument);

/* ------------------------------------------------------------------------------------------------ ways to run tasks */

static void run_one_by_one(void *context, unsigned count, task_function *task, void *argument) {
    (void)context;
    for (unsigned index = 0; index < count; index++)
        task(argument, index);
}

static void run_backwards(void *context, unsigned count, task_function *task, void *argument) {
    (void)context;
    while (count-- > 0)
        task(argument, count);
}

typedef struct pool_job {
    task_function *task;
    void *argument;
    unsigned count;
    atomic_uint next;
} pool_job;

static void *work(void *argument) {
    pool_job *job = argument;
    for (unsigned index; (index = atomic_fetch_add_explicit(&job->next, 1, memory_order_relaxed)) < job->count;)
        job->task(job->argument, index);
    return NULL;
}

static void run_in_pool(void *context, unsigned count, task_function *task, void *argument) {
    pool_job job = {task, argument, count, 0};
    pthread_t threads[THREADS];
    (void)context;
    for (int k = 0; k < THREADS; k++)
        assert_int_equal(pthread_create(&threads[k], NULL, work, &job), 0);
    for (int k = 0; k < THREADS; k++)
        pthread_join(threads[k], NULL);
}

/* ------------------------------------------------------------------------------------------------ what is promised */

/* A way whose calls are watched. */
typedef struct watch {
    run_function *run;
    unsigned count;
    bool wrong;
} watch;

static uint64_t runs; /* since it was last set to 0 */
static _Thread_local bool inside_task;

static void watch_task(void *argument, unsigned index) {
    const pool_job *job = argument;
    const bool nested = inside_task;
    inside_task = true;
    job->task(job->argument, index);
    inside_task = nested;
}

static void watch_run(void *context, unsigned count, task_function *task, void *argument) {
    watch *w = context;
    pool_job job = {.task = task, .argument = argument};
    runs++;
    w->wrong = w->wrong || inside_task || count < 2 || count > w->count;
    w->run(NULL, count, watch_task, &job);
}

/* ------------------------------------------------------------------------------------------------ all calls */

/* Of each answer a hash, and how often workers were asked to run. */
enum { FEW_CONTACTS = 9, ANSWERS = 14 };
typedef struct answers {
    uint64_t hash[ANSWERS], runs[ANSWERS];
    size_t count;
} answers;

static void note(answers *out, uint64_t hash) {
    assert_true(out->count < ANSWERS);
    out->hash[out->count] = hash;
    out->runs[out->count++] = runs;
    runs = 0;
}

/* What is asked of, and room for answers. */
static narc_shapes *shapes;
static narc_body rows[BODIES];
static uint64_t ids[BODIES];
static narc_box boxes[BODIES];
static uint32_t a[PAIRS], b[PAIRS], selection[PAIRS];
static uint64_t bits[NARC_BIT_WORDS(PAIRS)];
static narc_contact contacts[PAIRS];
static narc_manifold manifolds[PAIRS];
static float separations[PAIRS];
static narc_ray_hit hits[2 * BODIES];

static void place_bodies(size_t count) {
    static const float rotations[][2] = {{1, 0}, {0.8f, 0.6f}, {-0.6f, 0.8f}};
    struct test_random random = test_random_named("workers");
    const double side = sqrt((double)count / 2);
    for (size_t k = 0; k < count; k++) {
        const float *rotation = rotations[random_below(&random, 3)];
        rows[k] = (narc_body){.x = random_between(&random, 0, side),
                              .y = random_between(&random, 0, side),
                              .cosine = rotation[0],
                              .sine = rotation[1],
                              .scale = (float)random_between(&random, 0.9, 1.1),
                              .shape = (uint32_t)random_below(&random, 3)};
        ids[k] = 7 * k;
    }
}

/* All that a step says. */
static uint64_t hash_step(const narc_step_result *r) {
    const size_t slots = r->pairs.count, item = sizeof(uint32_t);
    uint64_t hash = test_hash(TEST_HASH_START, r->pairs.a.base, slots * item);
    hash = test_hash(hash, r->pairs.b.base, slots * item);
    hash = test_hash(hash, r->order, r->count * item);
    hash = test_hash(hash, r->state, slots);
    hash = test_hash(hash, r->manifolds, slots * sizeof *r->manifolds);
    hash = test_hash(hash, r->touching, r->touching_count * item);
    hash = test_hash(hash, r->began, r->began_count * sizeof *r->began);
    hash = test_hash(hash, r->ended, r->ended_count * sizeof *r->ended);
    return test_hash(hash, &r->skipped, sizeof r->skipped);
}

/* Three steps: all is new; little moves; a third of the bodies move, and two change their numbers. */
static void ask_steps(size_t count, const narc_workers *workers, answers *out) {
    narc_bodies bodies;
    narc_view_bodies(rows, count, &bodies);
    const narc_step step = {
        .bodies = &bodies, .margin = 0.0625f, .skin = 0.125f, .id = NARC_ARRAY(ids), .workers = workers};
    AUTO(narc_destroy_contacts_at) narc_contacts *slots = NULL;
    OK(narc_create_contacts(NULL, &slots, NULL));
    for (int frame = 0; frame < 3; frame++) {
        const narc_step_result *r;
        for (size_t k = 0; k < count && frame > 0; k += 3)
            rows[k].x += frame == 1 ? 0.03125 : 0.5;
        if (frame == 2) {
            ids[3] = 7 * 30;
            ids[30] = 7 * 3;
        }
        OK(narc_update_contacts(slots, shapes, &step, &r, NULL));
        assert_true(r->touching_count > count / 2);
        note(out, hash_step(r));
    }
}

/* From each body through its neighbours; those of the broken one have no answer. */
static void ask_rays(size_t count, const narc_workers *workers, answers *out) {
    static const float motion[] = {3, -1, 0, 2, -4};
    narc_bodies bodies;
    narc_view_bodies(rows, count, &bodies);
    size_t skipped = 0, found = 0;
    float motions[BODIES + 2];
    for (size_t k = 0; k < count + 2; k++)
        motions[k] = motion[k % 5];
    const narc_rays rays = {.count = count,
                            .x = bodies.x,
                            .y = bodies.y,
                            .motion_x = NARC_ARRAY(motions),
                            .motion_y = {motions + 2, sizeof *motions}};
    static uint32_t order[BODIES];
    const narc_ray_options options = {.search.workers = workers,
                                      .inside = NARC_INSIDE_LEAVES,
                                      .most = 2,
                                      .out_skipped = &skipped,
                                      .out_order = order};
    AUTO(narc_destroy_index_at) narc_index *index = NULL;
    OK(narc_create_index(NULL, &index));
    OK(narc_build_index(index, boxes, count, NULL, NULL));
    OK(narc_cast_rays(index, shapes, &bodies, &rays, &options, hits, 2 * count, NULL));
    for (size_t k = 0; k < 2 * count; k++)
        found += hits[k].count;
    assert_true(skipped == 1 && found > count);
    note(out, test_hash(TEST_HASH_START, hits, 2 * count * sizeof *hits));
}

static answers ask(size_t count, const narc_workers *workers) {
    answers out = {0};
    size_t found = 0, listed = 0, skipped = 0;
    uint64_t hash;
    narc_broad_phase *broad = NULL;
    place_bodies(count);
    rows[9].x = NAN;
    narc_bodies bodies;
    narc_view_bodies(rows, count, &bodies);
    const narc_box_options box_options = {.margin = 0.03125f, .workers = workers, .out_skipped = &skipped};
    OK(narc_compute_boxes(shapes, &bodies, &box_options, boxes, NULL));
    assert_int_equal(skipped, 1);
    note(&out, test_hash(TEST_HASH_START, boxes, count * sizeof *boxes));
    ask_rays(count, workers, &out);

    OK(narc_create_broad_phase(NULL, &broad));
    OK(narc_find_pairs(broad, boxes, count, NULL, workers, a, b, 0, PAIRS, &found, NULL));
    assert_true(found > 2 * count);
    note(&out, test_hash(test_hash(TEST_HASH_START, a, found * sizeof *a), b, found * sizeof *b));

    const narc_pairs pairs = {.count = found, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
    narc_destroy_broad_phase(broad);

    for (size_t k = 5; k < count; k += 100) /* broken ones, which have pairs */
        rows[k].scale = NAN;
    narc_query query = {.margin = 0.03125f, .workers = workers, .out_skipped = &skipped};
    OK(narc_find_overlaps(shapes, &bodies, &pairs, &query, bits, NULL));
    assert_true(skipped > 0);
    hash = test_hash(TEST_HASH_START, bits, NARC_BIT_WORDS(found) * sizeof *bits);
    note(&out, test_hash(hash, &skipped, sizeof skipped));
    OK(narc_find_separations(shapes, &bodies, &pairs, &query, separations, NULL));
    note(&out, test_hash(TEST_HASH_START, separations, found * sizeof *separations));
    for (uint32_t kind = 0; kind < 4; kind++) { /* contacts, manifolds; both dense */
        query.dense = kind / 2;
        if (kind % 2)
            OK(narc_find_manifolds(shapes, &bodies, &pairs, &query, manifolds, PAIRS, &listed, NULL));
        else
            OK(narc_find_contacts(shapes, &bodies, &pairs, &query, contacts, PAIRS, &listed, NULL));
        const size_t written = query.dense ? found : listed;
        hash = kind % 2 ? test_hash(TEST_HASH_START, manifolds, written * sizeof *manifolds)
                        : test_hash(TEST_HASH_START, contacts, written * sizeof *contacts);
        hash = test_hash(hash, &skipped, sizeof skipped);
        note(&out, test_hash(hash, &listed, sizeof listed));
    }
    query = (narc_query){.margin = INFINITY, .workers = workers};
    hash = narc_find_contacts(shapes, &bodies, &pairs, &query, contacts, found / 2, &listed, NULL);
    assert_true(hash == NARC_ERROR_CAPACITY && listed == found);
    assert_int_equal(out.count, FEW_CONTACTS);
    note(&out, test_hash(TEST_HASH_START, contacts, found / 2 * sizeof *contacts));
    query.selection = NARC_ARRAY(selection);
    query.selection_count = found / 2;
    for (size_t k = 0; k < found / 2; k++)
        selection[k] = (uint32_t)(found - 1 - 2 * k);
    OK(narc_find_contacts(shapes, &bodies, &pairs, &query, contacts, PAIRS, &listed, NULL));
    note(&out, test_hash(TEST_HASH_START, contacts, listed * sizeof *contacts));
    place_bodies(count);
    ask_steps(count, workers, &out);
    return out;
}

/* ------------------------------------------------------------------------------------------------ tests */

TEST(gives_the_same_bytes_whoever_works) {
    static run_function *const ways[] = {run_backwards, run_in_pool, run_one_by_one};
    static const unsigned counts[] = {2, 5, 300};
    const answers expected = ask(BODIES, NULL);
    for (size_t k = 0; k < 9 && k < test_trials(9); k++) {
        const unsigned count = counts[k % 3];
        watch watched = {ways[k / 3], count, false};
        const answers found = ask(BODIES, &(narc_workers){&watched, count, watch_run});
        for (size_t answer = 0; answer < ANSWERS; answer++)
            if (found.hash[answer] != expected.hash[answer])
                fail_msg("answer %zu of %u workers, way %zu, is another", answer, count, k / 3);
            else if (found.runs[answer] == 0 && answer != FEW_CONTACTS) /* these may be one worker's */
                fail_msg("answer %zu is that of one thread, of %u workers", answer, count);
        assert_false(watched.wrong);
    }
    const narc_workers built_in = openmp_workers(3);
    const answers found = ask(BODIES, &built_in);
    assert_memory_equal(&found, &expected, sizeof found);
}

TEST(asks_nobody_for_little_work) {
    watch watched = {run_one_by_one, 8, false};
    const narc_workers workers = {&watched, 8, watch_run}, alone = {&watched, 1, watch_run}, none = {0};
    const narc_workers *const lone[] = {&alone, &none};
    answers expected = ask(FEW, NULL), found = ask(FEW, &workers); /* nobody runs anything */
    assert_memory_equal(&found, &expected, sizeof found);
    expected = ask(BODIES, NULL);
    for (size_t k = 0; k < 2 && k < test_trials(2); k++) {
        found = ask(BODIES, lone[k]);
        assert_memory_equal(&found, &expected, sizeof found);
    }
}

/* More workers than anything is divided for. */
TEST(takes_any_number_of_workers) {
    enum { HALF = 200000 };
    static narc_box row[2 * HALF];
    static uint32_t one[HALF], other[HALF];
    watch watched = {run_backwards, UINT32_MAX, false};
    const narc_workers workers = {&watched, UINT32_MAX, watch_run};
    AUTO(narc_destroy_broad_phase_at) narc_broad_phase *broad = NULL;
    size_t found = 0;
    for (size_t k = 0; k < 2 * HALF; k++) /* two at each place, with half of the boxes between them */
        row[k] = (narc_box){2 * (float)(k % HALF), 0, 2 * (float)(k % HALF) + 1, 1};
    OK(narc_create_broad_phase(NULL, &broad));
    OK(narc_find_pairs(broad, row, 2 * HALF, NULL, &workers, one, other, 0, HALF, &found, NULL));
    assert_int_equal(found, HALF);
    for (uint32_t k = 0; k < HALF; k++)
        assert_true(one[k] == k && other[k] == k + HALF);
    assert_true(runs > 0 && !watched.wrong);
    runs = 0;
}

static int set_up(void **state) {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    uint32_t shape;
    (void)state;
    return narc_create_shapes(NULL, &shapes) || narc_build_circle(0.5, arcs, &count, NULL) ||
           narc_add_shape(shapes, arcs, count, &shape, NULL) || narc_build_box(1, 0.75, 0.125, arcs, &count, NULL) ||
           narc_add_shape(shapes, arcs, count, &shape, NULL) || narc_build_box(0.9, 0.9, 0, arcs, &count, NULL) ||
           narc_add_shape(shapes, arcs, count, &shape, NULL);
}

static int tear_down(void **state) {
    (void)state;
    narc_destroy_shapes(shapes);
    return 0;
}

int main(void) { return test_begin() ? test_run("workers", set_up, tear_down) : TEST_SKIPPED; }
