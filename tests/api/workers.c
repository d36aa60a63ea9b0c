/* SPDX-License-Identifier: MIT
 *
 * workers.c - the caller's own threads: every batch call gives the same bytes whoever runs its tasks, and asks for no more
 * than it was told that there are, never within a task, and never for little work.
 */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "narc.h"
#include "narc_broad_phase.h"
#include "support.h"

enum { BODIES = 8000, FEW = 40, PAIRS = 60000, THREADS = 3 };

typedef void task_function(void *argument, unsigned index);

/* ------------------------------------------------------------------------------------------------ in one thread */

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

/* ------------------------------------------------------------------------------------------------ enkiTS */

/* What stands for enkiTS: its task sets, whose numbers below the size are divided among threads. */
typedef void (*enkiTaskExecuteRange)(uint32_t start, uint32_t end, uint32_t thread, void *args);
typedef struct enkiTaskScheduler {
    int unused;
} enkiTaskScheduler;
typedef struct enkiTaskSet {
    enkiTaskExecuteRange execute;
    void *args;
    uint32_t size;
    atomic_uint begun;
    pthread_t threads[THREADS];
} enkiTaskSet;

static void *work(void *argument) {
    enkiTaskSet *set = argument;
    const uint32_t thread = atomic_fetch_add(&set->begun, 1);
    const uint32_t start = set->size * thread / THREADS, end = set->size * (thread + 1) / THREADS;
    if (start < end)
        set->execute(start, end, thread, set->args);
    return NULL;
}

static enkiTaskSet *enkiCreateTaskSet(enkiTaskScheduler *scheduler, enkiTaskExecuteRange execute) {
    enkiTaskSet *set = calloc(1, sizeof *set);
    (void)scheduler;
    assert_non_null(set);
    set->execute = execute;
    return set;
}

static void enkiAddTaskSetArgs(enkiTaskScheduler *scheduler, enkiTaskSet *set, void *args, uint32_t size) {
    (void)scheduler;
    set->args = args;
    set->size = size;
    for (int k = 0; k < THREADS; k++)
        assert_int_equal(pthread_create(&set->threads[k], NULL, work, set), 0);
}

static void enkiWaitForTaskSet(enkiTaskScheduler *scheduler, enkiTaskSet *set) {
    (void)scheduler;
    for (int k = 0; k < THREADS; k++)
        pthread_join(set->threads[k], NULL);
}

static void enkiDeleteTaskSet(enkiTaskScheduler *scheduler, enkiTaskSet *set) {
    (void)scheduler;
    free(set);
}

/* What a caller writes. */
typedef struct range_job {
    task_function *task;
    void *argument;
} range_job;

static void execute_range(uint32_t start, uint32_t end, uint32_t thread, void *args) {
    const range_job *job = args;
    (void)thread;
    for (uint32_t index = start; index < end; index++)
        job->task(job->argument, index);
}

static void run_by_enki(void *context, unsigned count, task_function *task, void *argument) {
    range_job job = {task, argument};
    enkiTaskSet *set = enkiCreateTaskSet(context, execute_range);
    enkiAddTaskSetArgs(context, set, &job, count);
    enkiWaitForTaskSet(context, set);
    enkiDeleteTaskSet(context, set);
}

/* ------------------------------------------------------------------------------------------------ Box2D */

/* What stands for the hooks that a b2WorldDef has. Whoever runs a task at once returns NULL, and is not asked to finish
 * it. */
typedef void b2TaskCallback(int start, int end, uint32_t worker, void *task_context);
typedef void *b2EnqueueTaskCallback(b2TaskCallback *task, int item_count, int min_range, void *task_context,
                                    void *user_context);
typedef void b2FinishTaskCallback(void *user_task, void *user_context);
typedef struct b2WorldDef {
    b2EnqueueTaskCallback *enqueueTask;
    b2FinishTaskCallback *finishTask;
    void *userTaskContext;
} b2WorldDef;

typedef struct user_task {
    b2TaskCallback *task;
    void *task_context;
    enkiTaskSet *set;
} user_task;

static void execute_user_task(uint32_t start, uint32_t end, uint32_t thread, void *args) {
    const user_task *user = args;
    user->task((int)start, (int)end, thread, user->task_context);
}

static void *enqueue(b2TaskCallback *task, int item_count, int min_range, void *task_context, void *user_context) {
    user_task *user = malloc(sizeof *user);
    assert_non_null(user);
    if (item_count <= 2 * min_range) {
        task(0, item_count, 0, task_context);
        free(user);
        return NULL;
    }
    *user = (user_task){task, task_context, enkiCreateTaskSet(user_context, execute_user_task)};
    enkiAddTaskSetArgs(user_context, user->set, user, (uint32_t)item_count);
    return user;
}

static void finish(void *task, void *user_context) {
    user_task *user = task;
    enkiWaitForTaskSet(user_context, user->set);
    enkiDeleteTaskSet(user_context, user->set);
    free(user);
}

/* What a caller writes. */
static void execute_items(int start, int end, uint32_t worker, void *task_context) {
    execute_range((uint32_t)start, (uint32_t)end, worker, task_context);
}

static void run_by_box2d(void *context, unsigned count, task_function *task, void *argument) {
    const b2WorldDef *def = context;
    range_job job = {task, argument};
    void *user = def->enqueueTask(execute_items, (int)count, 1, &job, def->userTaskContext);
    if (user)
        def->finishTask(user, def->userTaskContext);
}

/* ------------------------------------------------------------------------------------------------ what is promised */

/* Workers whose calls are watched. */
typedef struct watch {
    narc_workers workers;
    bool wrong;
} watch;

static uint64_t runs; /* since it was last set to 0 */
static _Thread_local bool inside_task;

static void watch_task(void *argument, unsigned index) {
    const range_job *job = argument;
    const bool nested = inside_task;
    inside_task = true;
    job->task(job->argument, index);
    inside_task = nested;
}

static void watch_run(void *context, unsigned count, task_function *task, void *argument) {
    watch *w = context;
    range_job job = {task, argument};
    runs++;
    w->wrong = w->wrong || inside_task || count < 2 || count > w->workers.count;
    w->workers.run(w->workers.context, count, watch_task, &job);
}

/* ------------------------------------------------------------------------------------------------ all calls */

enum answer {
    BOXES,
    FOUND_PAIRS,
    OVERLAPS,
    CONTACTS,
    FEW_CONTACTS,
    SELECTED_CONTACTS,
    DENSE_CONTACTS,
    MANIFOLDS,
    DENSE_MANIFOLDS,
    MATCHES,
    FIRST_LIST,
    KEPT_LIST,
    NEXT_LIST,
    ANSWERS
};

/* Of each answer a hash, and how often workers were asked to run. */
typedef struct answers {
    uint64_t hash[ANSWERS], runs[ANSWERS];
} answers;

static void note(answers *out, enum answer answer, uint64_t hash) {
    out->hash[answer] = hash;
    out->runs[answer] = runs;
    runs = 0;
}

/* What is asked of, and room for answers. */
static narc_shapes *shapes;
static narc_body rows[BODIES];
static uint64_t ids[BODIES];
static narc_box boxes[BODIES];
static uint32_t a[PAIRS], b[PAIRS], match[PAIRS], hints[PAIRS], selection[PAIRS];
static uint64_t bits[NARC_BIT_WORDS(PAIRS)];
static narc_contact contacts[PAIRS];
static narc_manifold manifolds[PAIRS];

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

static uint64_t hash_list(const narc_pair_list *list) {
    const size_t count = list->pairs.count, item = sizeof(uint32_t);
    uint64_t hash = test_hash(TEST_HASH_START, list->pairs.a.base, count * item);
    hash = test_hash(hash, list->pairs.b.base, count * item);
    hash = test_hash(hash, list->previous, count * item);
    hash = test_hash(hash, list->marks, count);
    hash = test_hash(hash, list->contacts, list->contact_count * item);
    hash = test_hash(hash, list->added, list->added_count * item);
    hash = test_hash(hash, list->lost, list->lost_count * sizeof *list->lost);
    return test_hash(hash, &list->skipped, sizeof list->skipped);
}

/* Three steps: all is new; little moves; a third of the bodies move, and two change their numbers. */
static void ask_lists(size_t count, const narc_workers *workers, answers *out) {
    const narc_bodies bodies = narc_view_bodies(rows, count);
    const narc_pair_options options = {.margin = 0.0625f, .skin = 0.125f, .id = NARC_ARRAY(ids), .workers = workers};
    narc_broad_phase *broad = NULL;
    assert_int_equal(narc_create_broad_phase(NULL, &broad), NARC_OK);
    for (int step = 0; step < 3; step++) {
        const narc_pair_list *list;
        for (size_t k = 0; k < count && step > 0; k += 3)
            rows[k].x += step == 1 ? 0.03125 : 0.5;
        if (step == 2) {
            const uint64_t id = ids[3];
            ids[3] = ids[30];
            ids[30] = id;
        }
        assert_int_equal(narc_update_pairs(broad, shapes, &bodies, &options, &list, NULL), NARC_OK);
        assert_int_equal(list->kept, step == 1);
        note(out, (enum answer)(FIRST_LIST + step), hash_list(list));
    }
    narc_destroy_broad_phase(broad);
}

static void ask(size_t count, const narc_workers *workers, answers *out) {
    size_t found = 0, listed = 0, skipped = 0;
    uint64_t hash;
    narc_broad_phase *broad = NULL;
    place_bodies(count);
    rows[9].x = NAN;
    const narc_bodies bodies = narc_view_bodies(rows, count);
    const narc_box_options box_options = {.margin = 0.03125f, .workers = workers, .out_skipped = &skipped};
    assert_int_equal(narc_compute_boxes(shapes, &bodies, &box_options, boxes, NULL), NARC_OK);
    assert_int_equal(skipped, 1);
    note(out, BOXES, test_hash(TEST_HASH_START, boxes, count * sizeof *boxes));

    assert_int_equal(narc_create_broad_phase(NULL, &broad), NARC_OK);
    assert_int_equal(narc_find_pairs(broad, boxes, count, NULL, workers, a, b, PAIRS, &found, NULL), NARC_OK);
    assert_true(found > 2 * count);
    hash = test_hash(test_hash(TEST_HASH_START, a, found * sizeof *a), b, found * sizeof *b);
    note(out, FOUND_PAIRS, hash);

    const narc_pairs pairs = {.count = found, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
    const narc_pairs backwards = {.count = found, .a = {a + found - 1, -4}, .b = {b + found - 1, -4}};
    assert_int_equal(narc_match_pairs(broad, &pairs, &pairs, workers, match, NULL), NARC_OK);
    hash = test_hash(TEST_HASH_START, match, found * sizeof *match);
    assert_int_equal(narc_match_pairs(broad, &backwards, &pairs, workers, match, NULL), NARC_OK);
    note(out, MATCHES, test_hash(hash, match, found * sizeof *match));
    narc_destroy_broad_phase(broad);

    for (size_t k = 5; k < count; k += 100) /* broken ones, which have pairs */
        rows[k].scale = NAN;
    narc_query query = {.margin = 0.03125f, .workers = workers, .out_skipped = &skipped};
    assert_int_equal(narc_find_overlaps(shapes, &bodies, &pairs, &query, bits, NULL), NARC_OK);
    assert_true(skipped > 0);
    hash = test_hash(TEST_HASH_START, bits, NARC_BIT_WORDS(found) * sizeof *bits);
    note(out, OVERLAPS, test_hash(hash, &skipped, sizeof skipped));
    for (uint32_t dense = 0; dense < 2; dense++) {
        query.dense = dense;
        query.hints = NARC_HINT_ARRAY(hints);
        memset(hints, 0, sizeof hints);
        assert_int_equal(narc_find_contacts(shapes, &bodies, &pairs, &query, contacts, PAIRS, &listed, NULL), NARC_OK);
        hash = test_hash(TEST_HASH_START, contacts, (dense ? found : listed) * sizeof *contacts);
        hash = test_hash(test_hash(hash, hints, found * sizeof *hints), &skipped, sizeof skipped);
        note(out, dense ? DENSE_CONTACTS : CONTACTS, test_hash(hash, &listed, sizeof listed));
        memset(hints, 0, sizeof hints);
        assert_int_equal(narc_find_manifolds(shapes, &bodies, &pairs, &query, manifolds, PAIRS, &listed, NULL),
                         NARC_OK);
        hash = test_hash(TEST_HASH_START, manifolds, (dense ? found : listed) * sizeof *manifolds);
        hash = test_hash(test_hash(hash, hints, found * sizeof *hints), &skipped, sizeof skipped);
        note(out, dense ? DENSE_MANIFOLDS : MANIFOLDS, test_hash(hash, &listed, sizeof listed));
    }
    query = (narc_query){.margin = INFINITY, .workers = workers};
    assert_int_equal(narc_find_contacts(shapes, &bodies, &pairs, &query, contacts, found / 2, &listed, NULL),
                     NARC_ERROR_CAPACITY);
    assert_int_equal(listed, found);
    note(out, FEW_CONTACTS, test_hash(TEST_HASH_START, contacts, found / 2 * sizeof *contacts));
    query.selection = NARC_ARRAY(selection);
    query.selection_count = found / 2;
    for (size_t k = 0; k < found / 2; k++)
        selection[k] = (uint32_t)(found - 1 - 2 * k);
    assert_int_equal(narc_find_contacts(shapes, &bodies, &pairs, &query, contacts, PAIRS, &listed, NULL), NARC_OK);
    note(out, SELECTED_CONTACTS, test_hash(TEST_HASH_START, contacts, listed * sizeof *contacts));
    place_bodies(count);
    ask_lists(count, workers, out);
}

/* ------------------------------------------------------------------------------------------------ tests */

static enkiTaskScheduler scheduler;
static b2WorldDef world_def = {enqueue, finish, &scheduler};
static const struct way {
    const char *name;
    void *context;
    void (*run)(void *context, unsigned count, task_function *task, void *argument);
} ways[] = {
    {"one by one", NULL, run_one_by_one},
    {"backwards", NULL, run_backwards},
    {"enkiTS", &scheduler, run_by_enki},
    {"Box2D", &world_def, run_by_box2d},
};
enum { WAYS = sizeof ways / sizeof *ways };

static void gives_the_same_bytes_whoever_works(void **state) {
    (void)state;
    static const unsigned counts[] = {2, 5, 300};
    answers expected, found;
    ask(BODIES, NULL, &expected);
    for (size_t way = 0; way < WAYS; way++)
        for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
            watch watched = {{ways[way].context, counts[k], ways[way].run}, false};
            const narc_workers workers = {&watched, counts[k], watch_run};
            ask(BODIES, &workers, &found);
            for (int answer = 0; answer < ANSWERS; answer++)
                if (found.hash[answer] != expected.hash[answer])
                    fail_msg("answer %d of %u workers, %s, is another", answer, counts[k], ways[way].name);
                else if (found.runs[answer] == 0 && answer != FEW_CONTACTS) /* these may be one worker's */
                    fail_msg("answer %d is that of one thread, of %u workers", answer, counts[k]);
            assert_false(watched.wrong);
        }
    const narc_workers built_in = narc_openmp_workers(3);
    ask(BODIES, &built_in, &found);
    assert_memory_equal(found.hash, expected.hash, sizeof found.hash);
}

static void asks_nobody_for_little_work(void **state) {
    (void)state;
    answers expected, found;
    watch watched = {{NULL, 8, run_one_by_one}, false};
    const narc_workers workers = {&watched, 8, watch_run}, alone = {&watched, 1, watch_run}, none = {0};
    ask(FEW, NULL, &expected); /* nobody runs anything */
    ask(FEW, &workers, &found);
    assert_memory_equal(&found, &expected, sizeof found);
    ask(BODIES, NULL, &expected);
    ask(BODIES, &alone, &found);
    assert_memory_equal(&found, &expected, sizeof found);
    ask(BODIES, &none, &found);
    assert_memory_equal(&found, &expected, sizeof found);
}

/* More workers than anything is divided for. */
static void takes_any_number_of_workers(void **state) {
    (void)state;
    enum { COUNT = 400000 };
    narc_box *row = malloc(COUNT * sizeof *row);
    watch watched = {{NULL, UINT32_MAX, run_backwards}, false};
    const narc_workers workers = {&watched, UINT32_MAX, watch_run};
    narc_broad_phase *broad = NULL;
    size_t found = 0;
    assert_non_null(row);
    for (size_t k = 0; k < COUNT; k++) /* two at each place, with half of the boxes between them */
        row[k] = (narc_box){2 * (float)(k % (COUNT / 2)), 0, 2 * (float)(k % (COUNT / 2)) + 1, 1};
    uint32_t *one = malloc(COUNT / 2 * sizeof *one), *other = malloc(COUNT / 2 * sizeof *other);
    assert_true(one && other);
    assert_int_equal(narc_create_broad_phase(NULL, &broad), NARC_OK);
    assert_int_equal(narc_find_pairs(broad, row, COUNT, NULL, &workers, one, other, COUNT / 2, &found, NULL), NARC_OK);
    assert_int_equal(found, COUNT / 2);
    for (uint32_t k = 0; k < COUNT / 2; k++)
        assert_true(one[k] == k && other[k] == k + COUNT / 2);
    assert_true(runs > 0 && !watched.wrong);
    runs = 0;
    narc_destroy_broad_phase(broad);
    free(row);
    free(one);
    free(other);
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gives_the_same_bytes_whoever_works),
        cmocka_unit_test(asks_nobody_for_little_work),
        cmocka_unit_test(takes_any_number_of_workers),
    };
    return test_begin() ? cmocka_run_group_tests_name("workers", tests, set_up, tear_down) : TEST_SKIPPED;
}
