/* SPDX-License-Identifier: MIT
 *
 * stack.c - every call of the library in a thread whose stack has NARC_STACK_SIZE bytes, those of the C library among
 * them, and the tasks of its workers in such threads, too.
 */
#include <math.h>
#include <stdlib.h>

#include "narc_broad_phase.h"
#include "narc_chains.h"
#include "narc_contacts.h"
#include "narc_scene.h"
#include "scene.h"
#include "stacks.h"
#include "turtle.h"

enum { BODIES = 1500, PAIRS = 30000, SHORT = PAIRS / 4, RING = 8 };

/* What calls work on: bodies of all shapes with columns for everything that pairs may have, and room for answers; of
 * lists too little, so that calls fill what they have for that. */
static struct scene scene;
static narc_shapes *store;
static narc_bodies bodies, own, broken;
static narc_pairs pairs;
static const narc_pairs one = {.count = 1};
static const narc_body two[] = {{.cosine = 1, .scale = 1}, {.x = 0.5, .sine = 1, .scale = 1, .shape = 1}};
static narc_query query, dense, selected, range;
static narc_box_options box_options;
static narc_broad_phase *broad;
static float margins[PAIRS], shifts[PAIRS], cosines[PAIRS], sines[PAIRS];
static uint32_t selection[PAIRS], indices[2][PAIRS * 2], shape;
static uint64_t bits[NARC_BIT_WORDS(PAIRS)];
static narc_contact contacts[PAIRS];
static narc_refined_contact refined[PAIRS];
static const narc_refinement refinement;
static narc_manifold manifolds[PAIRS];
static float separations[PAIRS];
static narc_impact impacts[PAIRS];
static narc_motions motions;
static const narc_motion way = {.x = 0.25f, .angle = 1};
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

static narc_status count_workers(void) {
    const narc_workers workers = openmp_workers(0);
    return TRUE(workers.count);
}

static narc_status keep_shapes(narc_error *error) {
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = NULL, *loaded = NULL;
    AUTO(narc_destroy_broad_phase_at) narc_broad_phase *other = NULL;
    const size_t size = narc_count_saved_bytes(store);
    const bool fine = narc_create_shapes(NULL, &shapes) == NARC_OK && narc_reserve_shapes(shapes, 2, 100) == NARC_OK &&
                      narc_add_shape(shapes, arcs, arc_count, &shape, error) == NARC_OK &&
                      narc_replace_shape(shapes, shape, arcs, arc_count, error) == NARC_OK &&
                      narc_count_shapes(shapes) == 1 && narc_get_arcs(shapes, shape, arcs) == arc_count &&
                      narc_shape_flags(shapes, shape) != 0 && narc_get_aabb(shapes, shape, 1, 0, 1, &aabb) &&
                      narc_add_shape_at(shapes, shape + 2, arcs, arc_count, error) == NARC_OK &&
                      narc_count_uses(shapes, shape) == 1 && narc_remove_shape(shapes, shape, error) == NARC_OK &&
                      size <= sizeof bytes && narc_save_shapes(store, bytes, size, error) == NARC_OK &&
                      narc_load_shapes(NULL, bytes, size, &loaded, error) == NARC_OK &&
                      narc_create_broad_phase(NULL, &other) == NARC_OK;
    return TRUE(fine);
}

static narc_status add_chain(narc_error *error) {
    enum { ARCS = 4000 };
    static narc_chain_entry entries[ARCS];
    AUTO(free_at) struct turtle t = create_turtle(0, 0, 1);
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = NULL;
    for (int k = 0; k < ARCS; k++)
        walk_arc(&t, 2, k % 2 ? -1 : 1);
    const bool fine = narc_create_shapes(NULL, &shapes) == NARC_OK &&
                      narc_add_chain(shapes, t.arcs, t.count, NULL, entries, ARCS, &count, error) == NARC_OK;
    return TRUE(fine);
}

/* Steps that ask all and keep their rows, of all pairs and of given ones, some as of ground, whose rows are merged. */
static narc_status keep_contacts(narc_error *error) {
    enum { FEW = 90 };
    static const uint32_t runs[FEW] = {[1] = NARC_NO_RUN, [2] = NARC_NO_RUN};
    static const uint64_t ids[] = {3, 5};
    uint32_t all[FEW];
    for (uint32_t k = 0; k < FEW; k++)
        all[k] = k;
    const narc_pairs given = {.count = FEW - 1, .a = NARC_ARRAY(all), .b = NARC_ARRAY(all + 1)};
    narc_bodies few = bodies;
    few.count = FEW;
    narc_step step = {.bodies = &few, .margin = 0.1f, .skin = 0.05f, .recycling = 0.01f, .workers = query.workers};
    AUTO(narc_destroy_contacts_at) narc_contacts *slots = NULL;
    const narc_step_result *r;
    const uint32_t *of_body;
    bool fine = narc_create_contacts(NULL, &slots, error) == NARC_OK;
    for (int k = 0; k < 6 && fine; k++) {
        step.margin += k == 1 ? 0.01f : 0;
        step.run = (narc_index_column){k == 2 ? runs : NULL, sizeof *runs};
        step.pairs = k > 3 ? &given : NULL;
        fine = narc_update_contacts(slots, store, &step, &r, error) == NARC_OK &&
               narc_find_body_slots(slots, 3, &of_body, &count, error) == NARC_OK &&
               (k < 4 || narc_forget_bodies(slots, ids, 2, error) == NARC_OK);
    }
    const size_t size = narc_count_contact_bytes(slots);
    AUTO(free_at) char *const saved = malloc(size + 1);
    fine = fine && saved && narc_save_contacts(slots, saved, size, error) == NARC_OK &&
           narc_load_contacts(slots, store, saved, size, &r, error) == NARC_OK &&
           narc_load_contacts(slots, store, saved, size - 8, &r, error) == NARC_ERROR_FORMAT;
    narc_forget_contacts(slots);
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
    static uint32_t order[BODIES];
    const narc_ray_options leave = {.search.workers = query.workers,
                                    .inside = NARC_INSIDE_LEAVES,
                                    .most = 3,
                                    .out_skipped = &skipped,
                                    .out_order = query.workers ? order : NULL};
    AUTO(narc_destroy_index_at) narc_index *index = NULL;
    narc_pairs met;
    size_t found_nodes;
    const bool fine =
        narc_create_index(NULL, &index) == NARC_OK &&
        narc_compute_boxes(store, &bodies, NULL, boxes, error) == NARC_OK &&
        narc_build_index(index, boxes, BODIES, &fast, error) == NARC_OK &&
        narc_build_index(index, boxes, BODIES, &index_options, error) == NARC_OK &&
        narc_update_index(index, boxes, BODIES, NULL, 0, &index_options, error) == NARC_OK &&
        narc_query_index(index, boxes, BODIES, &three.search, &met, error) == NARC_OK &&
        narc_copy_nodes(index, 0, boxes, 0, BODIES, &found_nodes, error) == NARC_OK &&
        narc_find_nearest(index, store, &bodies, &at, &three, distances, 3 * BODIES, error) == NARC_OK &&
        narc_cast_rays(index, store, &bodies, &rays, &leave, hits, 3 * BODIES, error) == NARC_OK && skipped < BODIES &&
        narc_find_distances(store, &bodies, &at, &NARC_ARRAY(selection), query.workers, distances, error) ==
            NARC_ERROR_INDEX &&
        narc_find_distances(store, &bodies, &at, NULL, query.workers, distances, error) == NARC_OK &&
        narc_find_inside(store, &bodies, &at, NULL, query.workers, bits, error) == NARC_OK &&
        narc_cast_ray_pairs(store, &bodies, &rays, NULL, &leave, hits, BODIES, error) == NARC_OK;
    return TRUE(fine);
}

/* All calls. Messages are printed on the stack. */
#define CALLS(CALL)                                                                                                    \
    CALL(overlaps, narc_find_overlaps(store, &bodies, &pairs, &query, bits, error))                                    \
    CALL(overlaps_selected, narc_find_overlaps(store, &bodies, &pairs, &selected, bits, error))                        \
    CALL(overlaps_range, narc_find_overlaps(store, &bodies, &pairs, &range, bits, error))                              \
    CALL(separations, narc_find_separations(store, &bodies, &pairs, &query, separations, error))                       \
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
    CALL(one_separation, narc_find_separations(store, &own, &one, NULL, separations, error))                           \
    CALL(one_contact, narc_find_contacts(store, &own, &one, NULL, contacts, 1, &count, error))                         \
    CALL(one_manifold, narc_find_manifolds(store, &own, &one, NULL, manifolds, 1, &count, error))                      \
    CALL(two_contact, narc_find_contact(store, &two[0], &two[1], NULL, contacts, error))                               \
    CALL(two_manifold, narc_find_manifold(store, &two[0], &two[1], NULL, manifolds, error))                            \
    CALL(two_cast, narc_cast_pair(store, &two[0], &way, &two[1], NULL, &cast_options, impacts, error))                 \
    CALL(cast_pairs, narc_cast_pairs(store, &bodies, &motions, &pairs, NULL, &cast_options, impacts, PAIRS, error))    \
    CALL(cast_shapes,                                                                                                  \
         narc_cast_shapes(scenery, store, &bodies, &bodies, &motions, &search, &cast_options, impacts, PAIRS, error))  \
    CALL(index, ask_index(error))                                                                                      \
    CALL(poses, narc_compute_poses(margins, PAIRS, cosines, sines, error))                                             \
    CALL(parts, narc_place_parts(&bodies, &bodies, &pairs.a, query.workers, placed, error))                            \
    CALL(names, TRUE(narc_set_isa(test_isa(), error) == NARC_OK && narc_get_isa() && narc_isa_name(0) &&               \
                     narc_isa_supported("scalar") && !narc_cpu_feature(SIZE_MAX) && narc_version()))                   \
    CALL(workers, count_workers())                                                                                     \
    CALL(copy_pairs, narc_copy_pairs(&pairs, NULL, PAIRS, indices[0], indices[1], 0, error))                           \
    CALL(boxes, narc_compute_boxes(store, &bodies, &box_options, boxes, error))                                        \
    CALL(find_pairs, narc_find_pairs(broad, spread, BODIES, NULL, query.workers, indices[0], indices[1], 0, PAIRS * 2, \
                                     &count, error))                                                                   \
    CALL(keep_contacts, keep_contacts(error))                                                                          \
    CALL(validate_bodies, narc_validate_bodies(store, &bodies, error))                                                 \
    CALL(refuse_bodies, TRUE(narc_validate_bodies(store, &broken, error) != NARC_OK))                                  \
    CALL(refuse_box, TRUE(narc_build_box(1e300, 1, 0, arcs, &arc_count, error) != NARC_OK))                            \
    CALL(circles, narc_build_circle(1, arcs, &arc_count, error))                                                       \
    CALL(capsule, narc_build_capsule(2, 1, arcs, &arc_count, error))                                                   \
    CALL(segment, narc_build_segment(&ring[0], &ring[1], 0, arcs, &arc_count, error))                                  \
    CALL(box, narc_build_box(4, 3, 0.5, arcs, &arc_count, error))                                                      \
    CALL(polygon, narc_build_polygon(ring, RING, 0.25, arcs, &arc_count, error))                                       \
    CALL(skin_polygon, narc_build_skin_polygon(ring, RING, 0.25, arcs, &arc_count, error))                             \
    CALL(weld, narc_weld_polygon(ring, RING, 1e-3, points, &count, error))                                             \
    CALL(regular, narc_build_regular_polygon(NARC_MAX_ARCS, 1, 0.01, arcs, &arc_count, error))                         \
    CALL(ellipse, narc_build_ellipse(3, 1, NARC_MAX_ARCS, arcs, &arc_count, NULL, error))                              \
    CALL(four_arc, narc_build_four_arc(&(narc_four_arc){5, 5, 8, 0.25, 0.25}, arcs, &arc_count, error))                \
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
              narc_compute_distance(arcs, arc_count, &ring[0], number) &&                                              \
              narc_contains_point(arcs, arc_count, &(narc_point){0, 0})))                                              \
    CALL(chain, add_chain(error))                                                                                      \
    CALL(keep, keep_shapes(error))

#define DEFINE(name, expression)                                                                                       \
    static narc_status call_##name(narc_error *error) {                                                                \
        (void)error;                                                                                                   \
        return expression;                                                                                             \
    }
CALLS(DEFINE)

#define LIST_CALL(name, expression) {#name, call_##name},
static const struct stack_call calls[] = {CALLS(LIST_CALL)};

static void set_workers(const narc_workers *workers) {
    query.workers = dense.workers = selected.workers = range.workers = box_options.workers = cast_options.workers =
        search.workers = workers;
}

TEST(test_calls) {
    static const narc_body bad[] = {{.x = NAN, .cosine = 1, .scale = 1}};
    struct test_random random = test_random_named("stack");
    scene = make_random_scene(&random, NARC_FLOAT64, BODIES, PAIRS);
    for (uint32_t k = 0; k < PAIRS; k++) {
        margins[k] = k % 3 ? INFINITY : 0.25f;
        shifts[k] = 0.125f * (float)(k % 4);
        selection[k] = PAIRS - 1 - k;
    }
    store = scene.store;
    bodies = scene_bodies(&scene);
    narc_view_bodies(two, 2, &own);
    narc_view_bodies(bad, 1, &broken);
    pairs = scene_pairs(&scene);
    pairs.shift_x = pairs.shift_y = NARC_ARRAY(shifts);
    query = (narc_query){.margins = NARC_ARRAY(margins), .out_skipped = &skipped};
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
    assert_true(narc_create_index(NULL, &scenery) == NARC_OK &&
                narc_build_index(scenery, spread, BODIES, NULL, NULL) == NARC_OK &&
                narc_create_broad_phase(NULL, &broad) == NARC_OK &&
                narc_build_ellipse(3, 1, 16, arcs, &arc_count, NULL, NULL) == NARC_OK);
    run_on_stacks(calls, sizeof calls / sizeof *calls, NARC_STACK_SIZE, set_workers);
}

int main(void) { return !large_frames && test_begin() ? test_run("stack", NULL, NULL) : TEST_SKIPPED; }
