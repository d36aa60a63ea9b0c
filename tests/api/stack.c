/* SPDX-License-Identifier: MIT
 *
 * stack.c - every call of the library in a thread whose stack has NARC_STACK_SIZE bytes (other methods:
 * NARC_METHODS_STACK_SIZE), those of the C library among them, and the tasks of its workers in such threads, too. Below
 * each stack lies a forbidden megabyte: more ends the process, and the last line that it printed names the call. Stacks
 * are filled with junk before: what is left of it tells how much was used.
 */
#define _GNU_SOURCE /* MAP_ANONYMOUS */
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "guard.h"
#include "methods.h"
#include "narc_broad_phase.h"
#include "narc_scene.h"
#include "turtle.h"

/* Sanitizers make frames larger, and so does a compiler that does not optimise. */
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__OPTIMIZE__)
enum { LARGE_FRAMES = 1 };
#elif defined(__has_feature)
enum { LARGE_FRAMES = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) };
#else
enum { LARGE_FRAMES = 0 };
#endif

enum { FORBIDDEN = 1 << 20, BODIES = 1500, PAIRS = 30000, SHORT = PAIRS / 4, RING = 8 };

/* What calls work on: bodies of all shapes with columns for everything that pairs may have, polygons, and room for
 * answers; of lists too little, so that calls fill what they have for that. */
static struct scene scene, polygons;
static narc_shapes *store;
static narc_bodies bodies, own, broken;
static narc_pairs pairs;
static const narc_pairs one = {.count = 1};
static narc_query query, dense, selected, range;
static narc_box_options box_options;
static narc_pair_options pair_options;
static narc_broad_phase *broad;
static const narc_pair_list *pair_list;
static float margins[PAIRS], shifts[PAIRS], cosines[PAIRS], sines[PAIRS];
static uint32_t hints[PAIRS], selection[PAIRS], indices[2][PAIRS * 2], match[PAIRS], shape;
static uint8_t outcomes[PAIRS];
static uint64_t bits[NARC_BIT_WORDS(PAIRS)];
static narc_contact contacts[PAIRS];
static narc_refined_contact refined[PAIRS];
static const narc_refinement refinement;
static narc_manifold manifolds[PAIRS];
static narc_impact impacts[PAIRS];
static narc_motions motions;
static narc_cast_options cast_options;
static narc_index *scenery;
static narc_index_query search;
static narc_distance distances[3 * BODIES];
static narc_ray_hit hits[3 * BODIES];
static narc_box boxes[BODIES], spread[BODIES];
static narc_body placed[BODIES];
static unsigned char bytes[1 << 16];
static narc_arc arcs[NARC_MAX_ARCS];
static const narc_point ring[RING] = {{4, 0}, {3, 2}, {0, 3}, {-3, 2}, {-4, 0}, {-3, -2}, {0, -3}, {3, -2}};
static narc_point points[RING];
static narc_mass mass;
static narc_circle circle;
static narc_aabb aabb;
static double number[3];
static size_t arc_count, count, skipped;

#define TRUE(expression) ((expression) ? NARC_OK : NARC_ERROR_ARGUMENT)

/* Bits, and contacts of methods that have them. */
static narc_status ask_method(narc_method method, narc_error *error) {
    const struct scene *of = method == NARC_METHOD_POLYGON_SAT ? &polygons : &scene;
    const narc_bodies all = scene_bodies(of);
    const narc_pairs some = scene_pairs(of);
    const narc_method_options options = {.method = method, .out_outcomes = outcomes};
    const narc_status status = narc_find_overlaps_by(of->methods, &all, &some, &options, &query, bits, error);
    if (status != NARC_OK || method >= NARC_METHOD_CIRCLE)
        return status;
    return narc_find_contacts_by(of->methods, &all, &some, &options, &query, contacts, SHORT, &count, error);
}

static narc_status keep_shapes(narc_error *error) {
    narc_shapes *shapes = NULL, *loaded = NULL;
    narc_methods *methods = NULL;
    narc_broad_phase *other = NULL;
    const size_t size = narc_count_saved_bytes(store);
    const bool fine = narc_create_shapes(NULL, &shapes) == NARC_OK && narc_reserve_shapes(shapes, 2, 100) == NARC_OK &&
                      narc_add_shape(shapes, arcs, arc_count, &shape, error) == NARC_OK &&
                      narc_replace_shape(shapes, shape, arcs, arc_count, error) == NARC_OK &&
                      narc_count_shapes(shapes) == 1 && narc_get_arcs(shapes, shape, arcs) == arc_count &&
                      narc_shape_flags(shapes, shape) != 0 && narc_get_aabb(shapes, shape, 1, 0, 1, &aabb) &&
                      narc_add_shape_at(shapes, shape + 2, arcs, arc_count, error) == NARC_OK &&
                      narc_create_methods(shapes, NULL, &methods, error) == NARC_OK &&
                      narc_count_uses(shapes, shape) == 1 && narc_remove_shape(shapes, shape, error) == NARC_OK &&
                      narc_refresh_methods(methods, error) == NARC_OK && size <= sizeof bytes &&
                      narc_save_shapes(store, bytes, size, error) == NARC_OK &&
                      narc_load_shapes(NULL, bytes, size, &loaded, error) == NARC_OK &&
                      narc_create_broad_phase(NULL, &other) == NARC_OK;
    narc_destroy_broad_phase(other);
    narc_destroy_methods(methods);
    narc_destroy_shapes(loaded);
    narc_destroy_shapes(shapes);
    return TRUE(fine);
}

/* A chain, and rows as of its entries. */
static narc_status add_chain(narc_error *error) {
    enum { ARCS = 4000 };
    static narc_chain_entry entries[ARCS];
    struct turtle t = create_turtle(0, 0, 1);
    narc_shapes *shapes = NULL;
    for (int k = 0; k < ARCS; k++)
        walk_arc(&t, 2, k % 2 ? -1 : 1);
    const bool fine = narc_create_shapes(NULL, &shapes) == NARC_OK &&
                      narc_add_chain(shapes, t.arcs, t.count, NULL, entries, ARCS, &count, error) == NARC_OK &&
                      narc_merge_contacts(&one, (narc_index_column){0}, contacts, 1) <= 1 &&
                      narc_merge_manifolds(&one, (narc_index_column){0}, manifolds, 1) <= 1;
    narc_destroy_shapes(shapes);
    free(t.arcs);
    return TRUE(fine);
}

/* An index of the bodies' boxes, and what is asked through it. */
static narc_status ask_index(narc_error *error) {
    const narc_points at = {.count = BODIES, .x = bodies.x, .y = bodies.y};
    const narc_index_options index_options = {.workers = query.workers}, fast = {.fast = 1, .workers = query.workers};
    const narc_nearest_options three = {.search.workers = query.workers, .most = 3};
    const narc_float_column shift = NARC_ARRAY(shifts);
    const narc_rays rays = {
        .count = BODIES, .x = at.x, .y = at.y, .motion_x = shift, .motion_y = shift, .fraction = NARC_ARRAY(margins)};
    const narc_ray_options leave = {
        .search.workers = query.workers, .inside = NARC_INSIDE_LEAVES, .most = 3, .out_skipped = &skipped};
    narc_index *index = NULL;
    narc_pairs met;
    const bool fine =
        narc_create_index(NULL, &index) == NARC_OK &&
        narc_compute_boxes(store, &bodies, NULL, boxes, error) == NARC_OK &&
        narc_build_index(index, boxes, BODIES, &fast, error) == NARC_OK &&
        narc_build_index(index, boxes, BODIES, &index_options, error) == NARC_OK &&
        narc_refit_index(index, boxes, BODIES, &index_options, NULL, error) == NARC_OK &&
        narc_query_index(index, boxes, BODIES, &three.search, &met, error) == NARC_OK &&
        narc_find_nearest(index, store, &bodies, &at, &three, distances, 3 * BODIES, error) == NARC_OK &&
        narc_cast_rays(index, store, &bodies, &rays, &leave, hits, 3 * BODIES, error) == NARC_OK && skipped < BODIES &&
        narc_find_distances(store, &bodies, &at, NARC_ARRAY(selection), query.workers, distances, error) ==
            NARC_ERROR_INDEX &&
        narc_find_distances(store, &bodies, &at, (narc_index_column){0}, query.workers, distances, error) == NARC_OK;
    narc_destroy_index(index);
    return TRUE(fine);
}

/* All calls. Messages are printed on the stack. */
#define CALLS(CALL, METHOD)                                                                                            \
    CALL(overlaps, narc_find_overlaps(store, &bodies, &pairs, &query, bits, error))                                    \
    CALL(overlaps_selected, narc_find_overlaps(store, &bodies, &pairs, &selected, bits, error))                        \
    CALL(overlaps_range, narc_find_overlaps(store, &bodies, &pairs, &range, bits, error))                              \
    CALL(contacts, narc_find_contacts(store, &bodies, &pairs, &query, contacts, SHORT, &count, error))                 \
    CALL(contacts_dense, narc_find_contacts(store, &bodies, &pairs, &dense, contacts, PAIRS, &count, error))           \
    CALL(contacts_selected, narc_find_contacts(store, &bodies, &pairs, &selected, contacts, SHORT, &count, error))     \
    CALL(contacts_range, narc_find_contacts(store, &bodies, &pairs, &range, contacts, 9, &count, error))               \
    CALL(refine, narc_refine_contacts(store, &bodies, &pairs, &refinement, contacts, SHORT, refined, error))           \
    CALL(manifolds, narc_find_manifolds(store, &bodies, &pairs, &query, manifolds, SHORT, &count, error))              \
    CALL(manifolds_dense, narc_find_manifolds(store, &bodies, &pairs, &dense, manifolds, PAIRS, &count, error))        \
    CALL(manifolds_selected, narc_find_manifolds(store, &bodies, &pairs, &selected, manifolds, SHORT, &count, error))  \
    CALL(manifolds_range, narc_find_manifolds(store, &bodies, &pairs, &range, manifolds, 9, &count, error))            \
    CALL(one_overlap, narc_find_overlaps(store, &own, &one, NULL, bits, error))                                        \
    CALL(one_contact, narc_find_contacts(store, &own, &one, NULL, contacts, 1, &count, error))                         \
    CALL(one_manifold, narc_find_manifolds(store, &own, &one, NULL, manifolds, 1, &count, error))                      \
    CALL(cast_pairs, narc_cast_pairs(store, &bodies, &motions, &pairs, NULL, &cast_options, impacts, PAIRS, error))    \
    CALL(cast_shapes,                                                                                                  \
         narc_cast_shapes(scenery, store, &bodies, &bodies, &motions, &search, &cast_options, impacts, PAIRS, error))  \
    CALL(index, ask_index(error))                                                                                      \
    METHOD(sat, ask_method(NARC_METHOD_SAT, error))                                                                    \
    METHOD(sat_first, ask_method(NARC_METHOD_SAT_FIRST, error))                                                        \
    METHOD(polygon_sat, ask_method(NARC_METHOD_POLYGON_SAT, error))                                                    \
    METHOD(gjk, ask_method(NARC_METHOD_GJK, error))                                                                    \
    METHOD(circle_filter, ask_method(NARC_METHOD_CIRCLE, error))                                                       \
    METHOD(aabb_filter, ask_method(NARC_METHOD_AABB, error))                                                           \
    METHOD(obb_filter, ask_method(NARC_METHOD_OBB, error))                                                             \
    CALL(poses, narc_compute_poses(margins, PAIRS, cosines, sines, error))                                             \
    CALL(parts, narc_place_parts(&bodies, &bodies, pairs.a, query.workers, placed, error))                             \
    CALL(names, TRUE(narc_set_isa(test_isa(), error) == NARC_OK && narc_get_isa() && narc_isa_name(0) &&               \
                     narc_isa_supported("scalar") && !narc_cpu_feature(SIZE_MAX) && narc_version() &&                  \
                     narc_openmp_workers(0).count))                                                                    \
    CALL(boxes, narc_compute_boxes(store, &bodies, &box_options, boxes, error))                                        \
    CALL(find_pairs, narc_find_pairs(broad, spread, BODIES, NULL, query.workers, indices[0], indices[1], PAIRS * 2,    \
                                     &count, error))                                                                   \
    CALL(match_pairs, narc_match_pairs(broad, &pairs, &pairs, query.workers, match, error))                            \
    CALL(update_pairs, narc_update_pairs(broad, store, &bodies, &pair_options, &pair_list, error))                     \
    CALL(update_box_pairs, narc_update_box_pairs(broad, spread, BODIES, &pair_options, &pair_list, error))             \
    CALL(validate_bodies, narc_validate_bodies(store, &bodies, error))                                                 \
    CALL(refuse_bodies, TRUE(narc_validate_bodies(store, &broken, error) != NARC_OK))                                  \
    CALL(refuse_box, TRUE(narc_build_box(1e300, 1, 0, arcs, &arc_count, error) != NARC_OK))                            \
    CALL(circles, narc_build_circle(1, arcs, &arc_count, error))                                                       \
    CALL(capsule, narc_build_capsule(2, 1, arcs, &arc_count, error))                                                   \
    CALL(segment, narc_build_segment(ring[0], ring[1], 0, arcs, &arc_count, error))                                    \
    CALL(box, narc_build_box(4, 3, 0.5, arcs, &arc_count, error))                                                      \
    CALL(polygon, narc_build_polygon(ring, RING, 0.25, arcs, &arc_count, error))                                       \
    CALL(skin_polygon, narc_build_skin_polygon(ring, RING, 0.25, arcs, &arc_count, error))                             \
    CALL(weld, narc_weld_polygon(ring, RING, 1e-3, points, &count, error))                                             \
    CALL(regular, narc_build_regular_polygon(NARC_MAX_ARCS, 1, 0.01, arcs, &arc_count, error))                         \
    CALL(ellipse, narc_build_ellipse(3, 1, NARC_MAX_ARCS, arcs, &arc_count, NULL, error))                              \
    CALL(four_arc, narc_build_four_arc((narc_four_arc){5, 5, 8, 0.25, 0.25}, arcs, &arc_count, error))                 \
    CALL(build_points, narc_build_points(ring, RING, 0, arcs, &arc_count, error))                                      \
    CALL(build_ring, narc_build_ring(ring, RING, arcs, &arc_count, error))                                             \
    CALL(radius_range, narc_find_radius_range(ring, RING, &number[0], &number[1], &number[2], error))                  \
    CALL(adjust, narc_adjust_polygon(ring, RING, points, error))                                                       \
    CALL(center, narc_center_arcs(arcs, arc_count, arcs, NULL, error))                                                 \
    CALL(mirror, narc_mirror_arcs(arcs, arc_count, arcs, error))                                                       \
    CALL(move, narc_move_arcs(arcs, arc_count, 1, 2, 3, 4, arcs, error))                                               \
    CALL(union_mass, narc_compute_union_mass(arcs, &arc_count, 1, NULL, &mass, error))                                 \
    CALL(validate, narc_validate_arcs(arcs, arc_count, error))                                                         \
    CALL(derive,                                                                                                       \
         TRUE(narc_compute_mass(arcs, arc_count, &mass) && narc_compute_bounding_circle(arcs, arc_count, &circle) &&   \
              narc_compute_inscribed_circle(arcs, arc_count, &circle) &&                                               \
              narc_compute_aabb(arcs, arc_count, 1, &aabb) && narc_compute_perimeter(arcs, arc_count, number) &&       \
              narc_find_support(arcs, arc_count, 1, 2, points, &count) &&                                              \
              narc_compute_distance(arcs, arc_count, ring[0], number) &&                                               \
              narc_contains_point(arcs, arc_count, (narc_point){0, 0})))                                               \
    CALL(chain, add_chain(error))                                                                                      \
    CALL(keep, keep_shapes(error))

#define DEFINE(name, expression)                                                                                       \
    static narc_status call_##name(narc_error *error) {                                                                \
        (void)error;                                                                                                   \
        return expression;                                                                                             \
    }
CALLS(DEFINE, DEFINE)

/* With the stacks they are promised to do with: those of the core, and the larger ones of casts and other methods. */
enum { CORE, METHODS, STACKS };
static const size_t stack_size[STACKS] = {NARC_STACK_SIZE, NARC_METHODS_STACK_SIZE};
#define LIST_CALL(name, expression)   {#name, call_##name, CORE},
#define LIST_METHOD(name, expression) {#name, call_##name, METHODS},
static const struct call {
    const char *name;
    narc_status (*run)(narc_error *error);
    int stack;
} calls[] = {CALLS(LIST_CALL, LIST_METHOD)};

/* ------------------------------------------------------------------------------------------------ threads */

/* What a thread is given: on some platforms none may have as little as calls are promised to need. */
static size_t thread_size(size_t size) {
    const long least = sysconf(_SC_THREAD_STACK_MIN);
    return least > 0 && (size_t)least > size ? (size_t)least : size;
}

static unsigned char *map_stack(size_t size) {
    size = thread_size(size);
    unsigned char *map = mmap(NULL, FORBIDDEN + size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    assert_true(map != MAP_FAILED);
    assert_int_equal(mprotect(map, FORBIDDEN, PROT_NONE), 0);
    return map + FORBIDDEN;
}

/* Runs a thread that may use `promised` bytes of a stack and returns how much of that it used. */
static size_t run_thread(unsigned char *stack, size_t promised, void *(*work)(void *), void *argument) {
    const size_t size = thread_size(promised);
    pthread_attr_t attributes;
    pthread_t thread;
    size_t left = 0;
    memset(stack, GUARD_JUNK, size);
    assert_int_equal(pthread_attr_init(&attributes), 0);
    assert_int_equal(pthread_attr_setstack(&attributes, stack, size), 0);
    assert_int_equal(pthread_create(&thread, &attributes, work, argument), 0);
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_int_equal(pthread_attr_destroy(&attributes), 0);
    while (left < size && stack[left] == GUARD_JUNK)
        left++;
    if (size - left > promised)
        fail_msg("%zu of %zu bytes", size - left, promised);
    return size - left;
}

static unsigned char *call_stack[STACKS], *task_stack[STACKS];
static int kind; /* of the call that runs */
static size_t most[STACKS];

struct job {
    const struct call *call;
    narc_error error;
    narc_status status;
};

static void *run_job(void *argument) {
    struct job *job = argument;
    job->status = job->call->run(&job->error);
    return NULL;
}

struct task {
    void (*run)(void *argument, unsigned index);
    void *argument;
    unsigned index;
};

static void *run_task(void *argument) {
    const struct task *task = argument;
    task->run(task->argument, task->index);
    return NULL;
}

static void keep_most(size_t used) { most[kind] = used > most[kind] ? used : most[kind]; }

/* Workers whose tasks have threads of their own, one after the other. */
static void run_tasks(void *context, unsigned task_count, void (*run)(void *argument, unsigned index), void *argument) {
    (void)context;
    for (unsigned index = 0; index < task_count; index++) {
        struct task task = {run, argument, index};
        keep_most(run_thread(task_stack[kind], stack_size[kind], run_task, &task));
    }
}

/* Runs all calls, and tells how much each used. */
static void run_calls(const narc_workers *workers) {
    query.workers = dense.workers = selected.workers = range.workers = box_options.workers = pair_options.workers =
        cast_options.workers = search.workers = workers;
    memset(most, 0, sizeof most);
    for (size_t k = 0; k < sizeof calls / sizeof *calls; k++) {
        struct job job = {.call = &calls[k], .status = NARC_ERROR_CANCELLED};
        printf("%s", calls[k].name);
        fflush(stdout);
        kind = calls[k].stack;
        const size_t used = run_thread(call_stack[kind], stack_size[kind], run_job, &job);
        printf(" %zu\n", used);
        if (job.status != NARC_OK && job.status != NARC_ERROR_CAPACITY)
            fail_msg("%s: %s", calls[k].name, job.error.message);
        keep_most(used);
    }
    for (kind = 0; kind < STACKS; kind++) {
        printf("at most %zu of %zu bytes\n", most[kind], stack_size[kind]);
        assert_true(most[kind] > stack_size[kind] / 4); /* the measure works */
    }
}

TEST(test_calling_thread) { run_calls(NULL); }

/* The calling thread is one of them. */
TEST(test_openmp) {
    const narc_workers workers = narc_openmp_workers(3);
    run_calls(&workers);
}

TEST(test_tasks) { run_calls(&(narc_workers){.count = 3, .run = run_tasks}); }

static void make_polygons(struct test_random *random) {
    polygons = create_scene(NARC_FLOAT32, RING, BODIES, PAIRS);
    for (int k = 0; k < RING; k++) {
        const struct shape polygon = make_shape(random, FAMILY_POLYGON);
        scene_add_shape(&polygons, &polygon);
    }
    for (int k = 0; k < BODIES; k++) {
        struct body body = scene.bodies[k];
        body.shape = (uint32_t)(k % RING);
        scene_add_body(&polygons, body);
    }
    for (int k = 0; k < PAIRS; k++)
        scene_add_pair(&polygons, scene.pairs[k].a, scene.pairs[k].b);
}

static int set_up(void **state) {
    (void)state;
    static const narc_body two[] = {{.cosine = 1, .scale = 1}, {.x = 0.5, .sine = 1, .scale = 1, .shape = 1}};
    static const narc_body bad[] = {{.x = NAN, .cosine = 1, .scale = 1}};
    struct test_random random = test_random_named("stack");
    scene = make_random_scene(&random, NARC_FLOAT64, BODIES, PAIRS);
    make_polygons(&random);
    scene_methods(&scene);
    scene_methods(&polygons);
    for (uint32_t k = 0; k < PAIRS; k++) {
        margins[k] = k % 3 ? INFINITY : 0.25f;
        shifts[k] = 0.125f * (float)(k % 4);
        selection[k] = PAIRS - 1 - k;
    }
    store = scene.store;
    bodies = scene_bodies(&scene);
    own = narc_view_bodies(two, 2);
    broken = narc_view_bodies(bad, 1);
    pairs = scene_pairs(&scene);
    pairs.shift_x = pairs.shift_y = NARC_ARRAY(shifts);
    query = (narc_query){.margins = NARC_ARRAY(margins), .hints = NARC_HINT_ARRAY(hints), .out_skipped = &skipped};
    dense = selected = range = query;
    dense.dense = 1;
    selected.selection = NARC_ARRAY(selection);
    selected.selection_count = PAIRS;
    range.first = 64;
    range.count = 2560;
    box_options = (narc_box_options){
        .margin = 0.1f, .motion_x = NARC_ARRAY(shifts), .motion_y = NARC_ARRAY(shifts), .out_skipped = &skipped};
    motions = (narc_motions){.x = NARC_ARRAY(shifts), .angle = NARC_ARRAY(shifts)};
    for (int k = 0; k < BODIES; k++) {
        const float x = (float)random_between(&random, 0, 60), y = (float)random_between(&random, 0, 60);
        spread[k] = (narc_box){x, y, x + 1, y + 1};
    }
    for (int k = 0; k < STACKS; k++) {
        call_stack[k] = map_stack(stack_size[k]);
        task_stack[k] = map_stack(stack_size[k]);
    }
    if (narc_create_index(NULL, &scenery) || narc_build_index(scenery, spread, BODIES, NULL, NULL))
        return 1;
    return narc_create_broad_phase(NULL, &broad) || narc_build_ellipse(3, 1, 16, arcs, &arc_count, NULL, NULL);
}

int main(void) {
    if (LARGE_FRAMES || !test_begin())
        return TEST_SKIPPED;
    return test_run("stack", set_up, NULL);
}
