/* SPDX-License-Identifier: MIT
 *
 * stack.c - every call of the library in a thread whose stack has NARC_STACK_SIZE bytes, those of the C library among
 * them, and a forbidden megabyte below: more ends the process.
 *
 * Each call has a process and a thread of its own, so that it is the first one there. The stack is filled with junk
 * before, and shared: what is left of the junk tells how much was used.
 */
#define _GNU_SOURCE /* MAP_ANONYMOUS */
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "methods.h"
#include "narc_broad_phase.h"

/* Sanitizers make frames larger, and so does a compiler that does not optimise. */
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__OPTIMIZE__)
enum { LARGE_FRAMES = 1 };
#elif defined(__has_feature)
enum { LARGE_FRAMES = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) };
#else
enum { LARGE_FRAMES = 0 };
#endif

enum { FORBIDDEN = 1 << 20, JUNK = 0xa5, BODIES = 1500, PAIRS = 30000, RING = 8 };

/* What calls work on: bodies of all shapes with columns for everything that pairs may have, polygons, and room for
 * answers. */
static struct scene scene, polygons;
static float margins[PAIRS], shifts[PAIRS], column[12][PAIRS];
static uint32_t hints[PAIRS], indices[2][PAIRS * 2], match[PAIRS];
static uint16_t features[2][PAIRS];
static uint8_t outcomes[PAIRS], small[2][PAIRS];
static uint64_t bits[NARC_BIT_WORDS(PAIRS)];
static narc_box boxes[BODIES], spread[BODIES];
static size_t found, skipped;
static narc_bodies bodies;
static narc_pairs pairs;
static narc_contacts contacts;
static narc_manifolds manifolds;
static narc_shapes *store;
static narc_broad_phase *broad;
static const narc_pair_list *pair_list;
static narc_arc arcs[NARC_MAX_ARCS];
static size_t arc_count;
static const narc_point ring[RING] = {{4, 0}, {3, 2}, {0, 3}, {-3, 2}, {-4, 0}, {-3, -2}, {0, -3}, {3, -2}};

struct call {
    const char *name;
    narc_status (*run)(unsigned threads, narc_method method, narc_error *error);
    narc_method method;
};

#define CALL(name, expression)                                                                                         \
    static narc_status name(unsigned threads, narc_method method, narc_error *error) {                                 \
        (void)threads, (void)method, (void)error;                                                                      \
        return expression;                                                                                             \
    }
#define TRUE(expression) ((expression) ? NARC_OK : NARC_ERROR_ARGUMENT)

/* ------------------------------------------------------------------------------------------------ queries */

static const narc_manifold_options manifold_options = {.margin = 0.5f, .hints = hints, .out_skipped = &skipped};
static const narc_box_options box_options = {
    .margin = 0.1f, .motion_x = NARC_ARRAY_INIT(margins), .motion_y = NARC_ARRAY_INIT(shifts), .out_skipped = &skipped};

static narc_method_query make_query(narc_method method) {
    return (narc_method_query){.method = method, .hints = hints, .out_outcomes = outcomes, .out_skipped = &skipped};
}

static narc_status query_bits(unsigned threads, narc_method method, narc_error *error) {
    const narc_method_query query = make_query(method);
    const struct scene *s = method == NARC_METHOD_POLYGON_SAT ? &polygons : &scene;
    const narc_bodies all = scene_bodies(s);
    const narc_pairs some = scene_pairs(s);
    return overlaps_by_method(s->store, &all, &some, &query, threads, bits, error);
}

static narc_status query_list(unsigned threads, narc_method method, narc_error *error) {
    const narc_method_query query = make_query(method);
    const struct scene *s = method == NARC_METHOD_POLYGON_SAT ? &polygons : &scene;
    const narc_bodies all = scene_bodies(s);
    const narc_pairs some = scene_pairs(s);
    const narc_status status =
        contacts_by_method(s->store, &all, &some, &query, INFINITY, threads, &contacts, &found, error);
    const bool filter = status == NARC_ERROR_ARGUMENT && method >= NARC_METHOD_CIRCLE; /* which have no contacts */
    return filter ? NARC_OK : status;
}

static narc_status match_lists(unsigned threads, narc_method method, narc_error *error) {
    (void)method;
    const narc_status status = narc_match_pairs(broad, &pairs, &pairs, threads, match, error);
    narc_gather(match, PAIRS, sizeof *hints, margins, hints);
    return status;
}

static narc_status find_one(bool manifold, narc_error *error) {
    narc_contact contact;
    narc_manifold points;
    const narc_body a = {.shape = 0, .angle = 1}, b = {.shape = 1, .x = 0.5, .angle = 0.25f};
    return manifold ? narc_find_manifold(store, &a, &b, &manifold_options, &points, error)
                    : narc_find_contact(store, &a, &b, &contact, error);
}

static narc_status fail_to_find(unsigned threads, narc_method method, narc_error *error) {
    (void)threads, (void)method;
    const narc_body a = {.shape = 0, .x = NAN}, b = {.shape = 1, .scale = 1e30f};
    narc_contact contact;
    return TRUE(narc_find_contact(store, &a, &b, &contact, error) != NARC_OK);
}

CALL(overlaps, narc_find_overlaps(store, &bodies, &pairs, threads, bits, error))
CALL(overlaps_range, narc_find_overlaps_range(store, &bodies, &pairs, 0, 640, bits, error))
CALL(list_contacts, narc_find_contacts(store, &bodies, &pairs, INFINITY, threads, &contacts, &found, error))
CALL(hinted, narc_find_contacts_hinted(store, &bodies, &pairs, 0.5f, threads, hints, &contacts, &found, error))
CALL(contacts_range, narc_find_contacts_range(store, &bodies, &pairs, 7, 2500, 0, &contacts, &found, error))
CALL(hinted_range, narc_find_contacts_hinted_range(store, &bodies, &pairs, 7, 2500, 0, hints, &contacts, &found, error))
CALL(list_manifolds, narc_find_manifolds(store, &bodies, &pairs, &manifold_options, threads, &manifolds, &found, error))
CALL(manifolds_range,
     narc_find_manifolds_range(store, &bodies, &pairs, 7, 2500, &manifold_options, &manifolds, &found, error))
CALL(one_contact, find_one(false, error))
CALL(one_manifold, find_one(true, error))
CALL(poses, narc_compute_poses(margins, PAIRS, column[0], column[1], error))
CALL(names,
     TRUE(narc_set_isa(test_isa(), error) == NARC_OK && narc_get_isa() && narc_isa_name(0) &&
          narc_isa_supported("scalar") && !narc_cpu_feature(SIZE_MAX) && narc_default_threads() && narc_version()))

CALL(all_boxes, narc_compute_boxes(store, &bodies, &box_options, threads, boxes, error))
CALL(some_boxes, narc_compute_boxes_range(store, &bodies, 3, 100, &box_options, boxes, error))
CALL(box_pairs, narc_find_pairs(broad, spread, BODIES, NULL, threads, indices[0], indices[1], PAIRS * 2, &found, error))

CALL(updated_pairs, narc_update_pairs(broad, store, &bodies, NULL, threads, &pair_list, error))
CALL(updated_box_pairs, narc_update_box_pairs(broad, spread, BODIES, NULL, threads, &pair_list, error))

/* ------------------------------------------------------------------------------------------------ shapes */

static narc_status derive(unsigned threads, narc_method method, narc_error *error) {
    (void)threads, (void)method, (void)error;
    narc_mass mass;
    narc_circle circle;
    narc_aabb box;
    narc_point point;
    double number;
    size_t arc;
    return TRUE(narc_compute_mass(arcs, arc_count, &mass) && narc_compute_bounding_circle(arcs, arc_count, &circle) &&
                narc_compute_inscribed_circle(arcs, arc_count, &circle) &&
                narc_compute_aabb(arcs, arc_count, 1, &box) && narc_compute_perimeter(arcs, arc_count, &number) &&
                narc_find_support(arcs, arc_count, 1, 2, &point, &arc) &&
                narc_compute_distance(arcs, arc_count, ring[0], &number) &&
                narc_contains_point(arcs, arc_count, (narc_point){0, 0}));
}

static narc_status keep_shapes(unsigned threads, narc_method method, narc_error *error) {
    (void)threads, (void)method;
    narc_shapes *shapes = NULL;
    narc_broad_phase *other = NULL;
    narc_aabb box;
    uint32_t shape;
    const bool fine = narc_create_shapes(NULL, &shapes) == NARC_OK && narc_reserve_shapes(shapes, 2, 100) == NARC_OK &&
                      narc_add_shape(shapes, arcs, arc_count, &shape, error) == NARC_OK &&
                      narc_replace_shape(shapes, shape, arcs, arc_count, error) == NARC_OK &&
                      narc_count_shapes(shapes) == 1 && narc_get_arcs(shapes, shape, arcs) == arc_count &&
                      narc_shape_flags(shapes, shape) != 0 && narc_get_aabb(shapes, shape, 1, 0, 1, &box) &&
                      narc_add_shape_at(shapes, shape + 2, arcs, arc_count, error) == NARC_OK &&
                      narc_count_uses(shapes, shape) == 1 && narc_remove_shape(shapes, shape, error) == NARC_OK &&
                      narc_create_broad_phase(NULL, &other) == NARC_OK;
    narc_destroy_broad_phase(other);
    narc_destroy_shapes(shapes);
    return TRUE(fine);
}

static narc_status save_and_load(unsigned threads, narc_method method, narc_error *error) {
    (void)threads, (void)method;
    static unsigned char bytes[1 << 16];
    narc_shapes *shapes = NULL;
    const size_t size = narc_count_saved_bytes(store);
    const bool fine = size <= sizeof bytes && narc_save_shapes(store, bytes, size, error) == NARC_OK &&
                      narc_load_shapes(NULL, bytes, size, &shapes, error) == NARC_OK;
    narc_destroy_shapes(shapes);
    return TRUE(fine);
}

static narc_status weld(unsigned threads, narc_method method, narc_error *error) {
    (void)threads, (void)method;
    narc_point points[RING];
    size_t count;
    return narc_weld_polygon(ring, RING, 1e-3, points, &count, error);
}

static narc_status range_of_radii(unsigned threads, narc_method method, narc_error *error) {
    (void)threads, (void)method;
    double least, largest, chosen;
    return narc_find_radius_range(ring, RING, &least, &largest, &chosen, error);
}

static narc_status adjust(unsigned threads, narc_method method, narc_error *error) {
    (void)threads, (void)method;
    narc_point points[RING];
    return narc_adjust_polygon(ring, RING, points, error);
}

/* Messages are printed on the stack. */
CALL(refuse, TRUE(narc_build_box(1e300, 1, 0, arcs, &arc_count, error) != NARC_OK))
CALL(circle, narc_build_circle(1, arcs, &arc_count, error))
CALL(capsule, narc_build_capsule(2, 1, arcs, &arc_count, error))
CALL(segment, narc_build_segment(ring[0], ring[1], 0, arcs, &arc_count, error))
CALL(skin, narc_build_skin_polygon(ring, RING, 0.25, arcs, &arc_count, error))
CALL(box, narc_build_box(4, 3, 0.5, arcs, &arc_count, error))
CALL(polygon, narc_build_polygon(ring, RING, 0.25, arcs, &arc_count, error))
CALL(regular, narc_build_regular_polygon(NARC_MAX_ARCS, 1, 0.01, arcs, &arc_count, error))
CALL(ellipse, narc_build_ellipse(3, 1, NARC_MAX_ARCS, arcs, &arc_count, NULL, error))
CALL(four_arc, narc_build_four_arc((narc_four_arc){5, 5, 8, 0.25, 0.25}, arcs, &arc_count, error))
CALL(points, narc_build_points(ring, RING, 0, arcs, &arc_count, error))
CALL(near_ring, narc_build_ring(ring, RING, arcs, &arc_count, error))
CALL(center, narc_center_arcs(arcs, arc_count, arcs, NULL, error))
CALL(mirror, narc_mirror_arcs(arcs, arc_count, arcs, error))
CALL(validate, narc_validate_arcs(arcs, arc_count, error))
CALL(validate_bodies, narc_validate_bodies(store, &bodies, error))

/* ------------------------------------------------------------------------------------------------ threads */

static const struct call calls[] = {
    {"narc_find_overlaps", overlaps, 0},
    {"narc_find_overlaps_range", overlaps_range, 0},
    {"narc_find_contacts", list_contacts, 0},
    {"narc_find_contacts_hinted", hinted, 0},
    {"narc_find_contacts_range", contacts_range, 0},
    {"narc_find_contacts_hinted_range", hinted_range, 0},
    {"narc_find_manifolds", list_manifolds, 0},
    {"narc_find_manifolds_range", manifolds_range, 0},
    {"narc_find_contact", one_contact, 0},
    {"narc_find_manifold", one_manifold, 0},
    {"narc_find_contact, of broken bodies", fail_to_find, 0},
    {"narc_compute_poses", poses, 0},
    {"the names of things", names, 0},
    {"narc_find_overlaps_by, sat", query_bits, NARC_METHOD_SAT},
    {"narc_find_overlaps_by, sat-first", query_bits, NARC_METHOD_SAT_FIRST},
    {"narc_find_overlaps_by, polygon-sat", query_bits, NARC_METHOD_POLYGON_SAT},
    {"narc_find_overlaps_by, gjk", query_bits, NARC_METHOD_GJK},
    {"narc_find_overlaps_by, circle", query_bits, NARC_METHOD_CIRCLE},
    {"narc_find_overlaps_by, aabb", query_bits, NARC_METHOD_AABB},
    {"narc_find_overlaps_by, obb", query_bits, NARC_METHOD_OBB},
    {"narc_find_contacts_by, sat", query_list, NARC_METHOD_SAT},
    {"narc_find_contacts_by, sat-first", query_list, NARC_METHOD_SAT_FIRST},
    {"narc_find_contacts_by, polygon-sat", query_list, NARC_METHOD_POLYGON_SAT},
    {"narc_find_contacts_by, gjk", query_list, NARC_METHOD_GJK},
    {"narc_find_contacts_by, circle", query_list, NARC_METHOD_CIRCLE},
    {"narc_compute_boxes", all_boxes, 0},
    {"narc_compute_boxes_range", some_boxes, 0},
    {"narc_find_pairs", box_pairs, 0},
    {"narc_match_pairs", match_lists, 0},
    {"narc_update_pairs", updated_pairs, 0},
    {"narc_update_box_pairs", updated_box_pairs, 0},
    {"narc_build_box, refused", refuse, 0},
    {"narc_build_circle", circle, 0},
    {"narc_build_capsule", capsule, 0},
    {"narc_build_segment", segment, 0},
    {"narc_build_box", box, 0},
    {"narc_build_polygon", polygon, 0},
    {"narc_build_skin_polygon", skin, 0},
    {"narc_weld_polygon", weld, 0},
    {"narc_build_regular_polygon", regular, 0},
    {"narc_build_ellipse", ellipse, 0},
    {"narc_build_four_arc", four_arc, 0},
    {"narc_build_points", points, 0},
    {"narc_build_ring", near_ring, 0},
    {"narc_find_radius_range", range_of_radii, 0},
    {"narc_adjust_polygon", adjust, 0},
    {"narc_center_arcs", center, 0},
    {"narc_mirror_arcs", mirror, 0},
    {"narc_validate_arcs", validate, 0},
    {"narc_validate_bodies", validate_bodies, 0},
    {"the derived quantities", derive, 0},
    {"the store", keep_shapes, 0},
    {"narc_save_shapes, narc_load_shapes", save_and_load, 0},
};
enum { CALLS = sizeof calls / sizeof *calls };

struct job {
    const struct call *call;
    unsigned threads;
    narc_error error;
    narc_status status;
};

static void *work(void *argument) {
    struct job *job = argument;
    job->status = job->call->run(job->threads, job->call->method, &job->error);
    return NULL;
}

/* In a process of its own: the call in a thread with that stack. */
static int run_call(const struct call *call, unsigned threads, void *stack) {
    static struct job job;
    pthread_attr_t attributes;
    pthread_t thread;
    job = (struct job){.call = call, .threads = threads, .status = NARC_ERROR_CANCELLED};
    if (pthread_attr_init(&attributes) || pthread_attr_setstack(&attributes, stack, NARC_STACK_SIZE) ||
        pthread_create(&thread, &attributes, work, &job) || pthread_join(thread, NULL))
        return 2;
    const bool fine = job.status == NARC_OK || job.status == NARC_ERROR_CAPACITY;
    if (!fine)
        print_error("%s: %s\n", call->name, job.error.message);
    return !fine;
}

static unsigned char *map_memory(size_t size, int protection) {
    void *memory = mmap(NULL, size, protection, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_true(memory != MAP_FAILED);
    return memory;
}

/* Runs all calls, and prints which one used most. NARC_TEST_STACKS=1 prints them all. */
static void run_calls(unsigned threads) {
    unsigned char *const map = map_memory(FORBIDDEN + NARC_STACK_SIZE, PROT_READ | PROT_WRITE);
    unsigned char *const stack = map + FORBIDDEN;
    assert_int_equal(mprotect(map, FORBIDDEN, PROT_NONE), 0);
    size_t most = 0;
    const char *hungry = "none";
    for (size_t k = 0; k < CALLS; k++) {
        memset(stack, JUNK, NARC_STACK_SIZE);
        const pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0)
            _exit(run_call(&calls[k], threads, stack));
        int status = 0;
        assert_int_equal(waitpid(child, &status, 0), child);
        if (WIFSIGNALED(status))
            fail_msg("%s, threads %u, %s: signal %d with a stack of %zu bytes", calls[k].name, threads, test_isa(),
                     WTERMSIG(status), (size_t)NARC_STACK_SIZE);
        assert_int_equal(WEXITSTATUS(status), 0);
        size_t left = 0;
        while (left < NARC_STACK_SIZE && stack[left] == JUNK)
            left++;
        if (getenv("NARC_TEST_STACKS"))
            print_message("%8zu  %s\n", (size_t)NARC_STACK_SIZE - left, calls[k].name);
        if (NARC_STACK_SIZE - left > most) {
            most = NARC_STACK_SIZE - left;
            hungry = calls[k].name;
        }
    }
    print_message("%zu of %zu bytes by %s\n", most, (size_t)NARC_STACK_SIZE, hungry);
    assert_true(most > NARC_STACK_SIZE / 2); /* the measure works, and the promise is near the need */
    munmap(map, FORBIDDEN + NARC_STACK_SIZE);
}

static void test_calling_thread(void **state) {
    (void)state;
    run_calls(1);
}

/* The calling thread is one of them. */
static void test_with_workers(void **state) {
    (void)state;
    run_calls(3);
}

static void make_polygons(struct test_random *random) {
    polygons = create_scene(NARC_FLOAT32, RING, BODIES, PAIRS);
    for (int k = 0; k < RING; k++) {
        const struct shape shape = make_shape(random, FAMILY_POLYGON);
        scene_add_shape(&polygons, &shape);
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
    struct test_random random = test_random_named("stack");
    scene = make_random_scene(&random, NARC_FLOAT64, BODIES, PAIRS);
    make_polygons(&random);
    for (int k = 0; k < PAIRS; k++) {
        margins[k] = k % 3 ? INFINITY : 0.25f;
        shifts[k] = 0.125f * (float)(k % 4);
    }
    store = scene.store;
    bodies = scene_bodies(&scene);
    pairs = scene_pairs(&scene);
    pairs.margin = NARC_ARRAY(margins);
    pairs.shift_x = pairs.shift_y = NARC_ARRAY(shifts);
    /* The last chunks find no room, and so fill their buffers. */
    contacts = (narc_contacts){PAIRS / 4, indices[0], column[0], column[1], column[2],
                               column[3], column[4],  small[0],  small[1]};
    manifolds = (narc_manifolds){.capacity = PAIRS / 4,
                                 .pair = indices[0],
                                 .point_count = small[0],
                                 .normal_x = column[0],
                                 .normal_y = column[1],
                                 .separation = {column[2], column[3]},
                                 .point_x = {column[4], column[5]},
                                 .point_y = {column[6], column[7]},
                                 .feature = {features[0], features[1]},
                                 .radius_a = {column[8], column[9]},
                                 .radius_b = {column[10], column[11]}};
    for (int k = 0; k < BODIES; k++) {
        const float x = (float)random_between(&random, 0, 60), y = (float)random_between(&random, 0, 60);
        spread[k] = (narc_box){x, y, x + 1, y + 1};
    }
    return narc_create_broad_phase(NULL, &broad) || narc_build_ellipse(3, 1, 16, arcs, &arc_count, NULL, NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_calling_thread), cmocka_unit_test(test_with_workers)};
    if (LARGE_FRAMES || !test_begin())
        return TEST_SKIPPED;
    return cmocka_run_group_tests_name("stack", tests, set_up, NULL);
}
