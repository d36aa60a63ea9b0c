/* SPDX-License-Identifier: MIT
 *
 * plain.c - compares a batch's answers with those of the deciding formula.
 */
#include "plain.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "layouts.h"
#include "plain_kernels.h"

/* Finds a batch's rows group by group; returns how many. */
static size_t find_rows(narc_row_kernel *kernel, const narc_batch *batch, size_t size, void *rows) {
    size_t found = 0, skipped = 0;
    for (size_t k = 0; k < batch->asked; k += NARC_ROW_GROUP) {
        const size_t left = batch->asked - k;
        const narc_rows out = {.base = (char *)rows + found * size, .stride = (ptrdiff_t)size};
        found += kernel(batch, k, left < NARC_ROW_GROUP ? left : NARC_ROW_GROUP, &skipped, &out);
    }
    return found;
}

static narc_batch begin_plain(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                              const narc_query *query) {
    const float angle = query->flat_angle == 0 ? NARC_FLAT_ANGLE : query->flat_angle;
    return (narc_batch){.shapes = shapes,
                        .a = bodies,
                        .b = bodies,
                        .pairs = pairs,
                        .query = query,
                        .flat_sine = angle < 0 ? -1 : (float)sin((double)angle),
                        .count = pairs->count,
                        .asked = pairs->count};
}

struct contacts find_plain_contacts(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs) {
    size_t skipped = 0;
    const narc_query query = {.margin = INFINITY};
    const narc_batch batch = begin_plain(shapes, bodies, pairs, &query);
    const size_t count = pairs->count;
    struct contacts plain = {make_junk(count * sizeof *plain.rows), count};
    AUTO(free_at) uint64_t *bits = make_junk(NARC_BIT_WORDS(count) * sizeof *bits);
    assert_int_equal(find_rows(narc_kernels_plain.contact, &batch, sizeof *plain.rows, plain.rows), count);
    narc_kernels_plain.overlap(&batch, 0, count, &skipped, bits);
    for (size_t k = 0; k < count; k++) {
        assert_int_equal(plain.rows[k].pair, k);
        assert_int_equal(bit_is_set(bits, k), plain.rows[k].separation < 0);
    }
    return plain;
}

struct manifolds find_plain_manifolds(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                      const narc_query *query) {
    const narc_batch batch = begin_plain(shapes, bodies, pairs, query);
    struct manifolds plain = {make_junk(pairs->count * sizeof *plain.rows), 0};
    plain.count = find_rows(narc_kernels_plain.manifold, &batch, sizeof *plain.rows, plain.rows);
    return plain;
}

struct plain_batch make_plain_batch(const struct scene *scene, const narc_bodies *bodies, const narc_pairs *pairs,
                                    const char *name) {
    narc_contact *const right = find_plain_contacts(scene->store, bodies, pairs).rows;
    return (struct plain_batch){scene->store, bodies, pairs, right, scene, name};
}

static void fail_at(const struct plain_batch *batch, size_t pair, const char *what) {
    const struct pair indices = batch->scene->pairs[pair];
    const struct reference_body a = scene_reference(batch->scene, indices.a);
    const struct reference_body b = scene_reference(batch->scene, indices.b);
    const narc_contact *right = &batch->right[pair];
    print_pair(&a, &b);
    fail_msg("%s: pair %zu (bodies %u and %u): %s; right are separation %a, normal (%a, %a), point (%a, %a), feature "
             "%04x; the exact separation is %.17g",
             batch->name, pair, indices.a, indices.b, what, (double)right->separation, (double)right->normal_x,
             (double)right->normal_y, (double)right->point_x, (double)right->point_y, right->feature,
             reference_find_gap(&a, &b).gap);
}

void check_plain_overlaps(const struct plain_batch *batch, const narc_workers *workers) {
    AUTO(free_at)
    uint64_t *bits = find_overlaps(batch->shapes, batch->bodies, batch->pairs, &(narc_query){.workers = workers});
    for (size_t k = 0; k < batch->pairs->count; k++)
        if (bit_is_set(bits, k) != (batch->right[k].separation < 0))
            fail_at(batch, k, bit_is_set(bits, k) ? "collides by its bit" : "does not collide by its bit");
}

/* What differs between a contact and another, NULL if nothing does. Zeros of either sign are not the same. */
static const char *find_difference(const narc_contact *a, const narc_contact *b) {
    if (memcmp(a, b, sizeof *a) == 0)
        return NULL;
    if (memcmp(&a->separation, &b->separation, sizeof(float)) != 0)
        return "separation";
    if (memcmp(&a->normal_x, &b->normal_x, 2 * sizeof(float)) != 0)
        return "normal";
    if (memcmp(&a->point_x, &b->point_x, 2 * sizeof(float)) != 0)
        return "point";
    return a->feature != b->feature ? "feature" : a->count != b->count ? "count" : "radius";
}

static void fail_contact(const struct plain_batch *batch, const narc_contact *found, const char *difference,
                         float margin) {
    char what[256];
    snprintf(what, sizeof what,
             "margin %a: %s differs: separation %a, normal (%a, %a), point (%a, %a), feature %04x, radii %a and %a",
             (double)margin, difference, (double)found->separation, (double)found->normal_x, (double)found->normal_y,
             (double)found->point_x, (double)found->point_y, found->feature, (double)found->radius_a,
             (double)found->radius_b);
    fail_at(batch, found->pair, what);
}

void check_plain_contacts(const struct plain_batch *batch, const narc_query *query) {
    const float margin = query->margin;
    AUTO(free_at) struct contacts found = find_contacts(batch->shapes, batch->bodies, batch->pairs, query);
    size_t at = 0;
    for (size_t k = 0; k < batch->pairs->count; k++) {
        const bool wanted = margin == INFINITY || batch->right[k].separation < margin;
        const bool there = at < found.count && found.rows[at].pair == k;
        if (wanted != there)
            fail_at(batch, k, there ? "reported" : "not reported");
        if (there) {
            const char *difference = find_difference(&found.rows[at], &batch->right[k]);
            if (difference)
                fail_contact(batch, &found.rows[at], difference, margin);
            at++;
        }
    }
    assert_int_equal(at, found.count);
}

/* Fails with the first row that differs. */
static void check_rows(const struct scene *scene, const struct manifolds *right, const struct manifolds *found,
                       const char *name) {
    for (size_t k = 0; k < right->count && k < found->count; k++) {
        const narc_manifold *r = &right->rows[k], *f = &found->rows[k];
        if (memcmp(r, f, sizeof *r) == 0)
            continue;
        const struct pair pair = scene->pairs[r->pair];
        const struct reference_body a = scene_reference(scene, pair.a), b = scene_reference(scene, pair.b);
        print_pair(&a, &b);
        const narc_manifold *const both[] = {r, f};
        for (int i = 0; i < 2; i++)
            print_error("%s: pair %u, %u points, normal (%a, %a), radii %a %a, reaches %u %u %u %u; (%a, %a) %a %04x; "
                        "(%a, %a) %a %04x\n",
                        i ? "found" : "right", both[i]->pair, both[i]->count, (double)both[i]->normal_x,
                        (double)both[i]->normal_y, (double)both[i]->radius_a, (double)both[i]->radius_b,
                        both[i]->reach_a[0], both[i]->reach_a[1], both[i]->reach_b[0], both[i]->reach_b[1],
                        (double)both[i]->point[0].x, (double)both[i]->point[0].y, (double)both[i]->point[0].separation,
                        both[i]->point[0].feature, (double)both[i]->point[1].x, (double)both[i]->point[1].y,
                        (double)both[i]->point[1].separation, both[i]->point[1].feature);
        fail_msg("%s: row %zu differs", name, k);
    }
    assert_int_equal(right->count, found->count);
}

enum layout any_layout(struct test_random *random) {
    const enum layout layouts[] = {LAYOUT_ARRAYS, LAYOUT_STRUCTURES, LAYOUT_STRUCTURES, LAYOUT_REVERSED};
    return layouts[random_below(random, sizeof layouts / sizeof *layouts)];
}

void check_plain_scene(struct test_random *random, const struct scene *scene, const char *name) {
    AUTO(destroy_columns) struct columns columns = create_columns(scene, any_layout(random), 0, scene->pair_count);
    const narc_pairs *pairs = &columns.pairs;
    const struct plain_batch batch = make_plain_batch(scene, &columns.bodies, pairs, name);
    const float flats[] = {0, 0.05f, 0.7f, 0.7853982f, NARC_MAX_FLAT_ANGLE, -1};
    const float some = batch.right[random_below(random, scene->pair_count)].separation;
    const float margins[] = {0.02f, 0, INFINITY, some, nextafterf(some, INFINITY), -0.01f};
    AUTO(free_at) float *each = malloc(scene->pair_count * sizeof *each);
    for (size_t k = 0; k < scene->pair_count; k++) { /* the separation itself is not below it */
        const float separation = batch.right[k].separation;
        each[k] = random_below(random, 2) ? separation : nextafterf(separation, INFINITY);
        each[k] = random_below(random, 20) ? each[k] : NAN;
    }
    for (size_t m = 0; m < sizeof margins / sizeof *margins; m++) {
        narc_query query = {.margin = margins[m], .flat_angle = flats[random_below(random, 6)]};
        const narc_workers workers = openmp_workers((unsigned)random_below(random, 3));
        query.second_margin = random_below(random, 2) ? 0 : 0.1f;
        query.workers = &workers;
        if (m == 1)
            query.margins = (narc_float_column){each, sizeof *each};
        AUTO(free_at) struct manifolds right = find_plain_manifolds(scene->store, &columns.bodies, pairs, &query);
        AUTO(free_at) struct manifolds found = find_manifolds(scene->store, &columns.bodies, pairs, &query);
        check_rows(scene, &right, &found, name);
        if (m != 1)
            check_plain_contacts(&batch, &(narc_query){.margin = margins[m], .workers = &workers});
    }
    check_plain_overlaps(&batch, NULL);
    free(batch.right);
}
