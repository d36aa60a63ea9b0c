/* SPDX-License-Identifier: MIT
 *
 * workload.c - workloads by their key: shapes, scene, order of pairs, exact separations.
 */
#include "workload.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common.h"
#include "pairs.h"
#include "random.h"
#include "settled.h"
#include "shapes.h"

enum { MAX_WORKLOADS = 256 };

static const size_t shape_counts[VARIETIES] = {[UNIQUE] = 4096, [TEMPLATES] = 16, [FEW] = 64};

static bool same_key(const struct workload_key *a, const struct workload_key *b) {
    return a->edges == b->edges && a->family == b->family && a->scene == b->scene && a->variety == b->variety &&
           a->sorted == b->sorted && a->moved == b->moved && a->pair_count == b->pair_count &&
           a->body_count == b->body_count;
}

bool is_settled(const struct workload_key *key) { return key->scene >= SCENE_SETTLED_SMALL; }

static bool is_stack(const struct workload_key *key) {
    return key->scene == SCENE_PYRAMID || key->scene == SCENE_LATTICE;
}

/* Shapes of even and of odd index are the first and second bodies' in FAMILY_GENERAL. */
static struct outline make_shape(const struct workload_key *key, size_t index, uint64_t *random) {
    const struct outline n_arc = make_n_arc(random, key->edges);
    switch (key->family) {
    case FAMILY_KINDS:
        return index % 4 == 0   ? make_circle(random_between(random, 0.6, 1.2))
               : index % 4 == 1 ? make_box(random)
               : index % 4 == 2 ? polygon_of(&n_arc)
                                : n_arc;
    case FAMILY_GENERAL:
        return index % 2 == 0 ? polygon_of(&n_arc) : n_arc;
    case FAMILY_ROUNDED:
        return round_polygon(&n_arc);
    case FAMILY_BOXES:
        return is_stack(key) ? make_square() : make_box(random);
    case FAMILY_DISCS:
        return make_circle(random_between(random, 0.6, 1.2));
    case FAMILY_CAPSULES:
        return make_capsule(random);
    default:
        return n_arc;
    }
}

static void store_shapes(struct workload *workload) {
    workload->shapes = NULL;
    if (narc_create_shapes(NULL, &workload->shapes) != NARC_OK)
        fail("out of memory");
    for (size_t k = 0; k < workload->shape_count; k++)
        add_outline(workload->shapes, &workload->outlines[k]);
}

static void make_shapes(struct workload *workload) {
    uint64_t random = workload->key.edges;
    workload->shape_count = shape_counts[workload->key.variety];
    workload->outlines = allocate(workload->shape_count, sizeof *workload->outlines);
    for (size_t k = 0; k < workload->shape_count; k++)
        workload->outlines[k] = make_shape(&workload->key, k, &random);
    store_shapes(workload);
}

static int compare_pairs(const void *left, const void *right) {
    const struct pair *l = left, *r = right;
    return l->a != r->a ? (l->a > r->a) - (l->a < r->a) : (l->b > r->b) - (l->b < r->b);
}

static void order_pairs(struct workload *workload) {
    uint64_t random = 1;
    if (workload->key.sorted) {
        qsort(workload->pairs, workload->pair_count, sizeof *workload->pairs, compare_pairs);
        return;
    }
    for (size_t k = workload->pair_count; k > 1; k--) {
        const size_t other = random_below(&random, k);
        const struct pair kept = workload->pairs[k - 1];
        workload->pairs[k - 1] = workload->pairs[other];
        workload->pairs[other] = kept;
    }
}

static void measure_gaps(struct workload *workload) {
    workload->gaps = allocate(workload->pair_count, sizeof *workload->gaps);
    for (size_t k = 0; k < workload->pair_count; k++) {
        struct vector normal;
        workload->gaps[k] = exact_gap(workload->outlines, &workload->bodies[workload->pairs[k].a],
                                      &workload->bodies[workload->pairs[k].b], &normal);
    }
}

static void move_bodies(struct workload *workload) {
    uint64_t random = 2;
    const double most = is_stack(&workload->key) ? 0 : is_settled(&workload->key) ? 0.001 : 0.01;
    struct body *bodies = allocate(workload->body_count, sizeof *bodies);
    for (size_t k = 0; k < workload->body_count; k++) {
        const struct body *body = &workload->bodies[k];
        const double turn = random_between(&random, -most, most), size = reach_of(&workload->outlines[body->shape]);
        const double angle = atan2(body->sine, body->cosine) + turn;
        bodies[k] = (struct body){(float)(body->x + most * size * random_between(&random, -1, 1)),
                                  (float)(body->y + most * size * random_between(&random, -1, 1)), (float)cos(angle),
                                  (float)sin(angle), body->shape};
    }
    workload->bodies = bodies;
}

/* What the shapes of a family are in the place of: itself, if of nothing. */
static enum family find_source(enum family family) {
    if (family == FAMILY_POLYGONS || family == FAMILY_BOUNDS)
        return FAMILY_N_ARCS;
    return family == FAMILY_CAPSULE_BOXES ? FAMILY_CAPSULES : family;
}

/* The same bodies and pairs, with something else in the place of each shape. */
static void replace_shapes(struct workload *workload) {
    struct outline *outlines = allocate(workload->shape_count, sizeof *outlines);
    for (size_t k = 0; k < workload->shape_count; k++) {
        const struct outline *n_arc = &workload->outlines[k];
        if (workload->key.family == FAMILY_BOUNDS)
            outlines[k] = make_circle(bounding_radius(n_arc));
        else if (workload->key.family == FAMILY_CAPSULE_BOXES)
            outlines[k] = box_as_large_as(n_arc);
        else
            outlines[k] = is_settled(&workload->key) ? polygon_as_large_as(n_arc) : polygon_of(n_arc);
    }
    workload->outlines = outlines;
    store_shapes(workload);
}

static void make_workload(struct workload *workload, const struct workload_key *key) {
    struct workload_key source = *key;
    source.family = find_source(key->family);
    const bool replaced = source.family != key->family;
    if (!replaced)
        source.moved = false;
    if (!same_key(&source, key))
        *workload = *get_workload(&source);
    workload->key = *key;
    if (replaced) {
        replace_shapes(workload);
    } else if (key->moved) {
        move_bodies(workload);
    } else {
        make_shapes(workload);
        if (is_settled(key))
            make_settled(workload);
        else if (is_stack(key))
            make_stack(workload);
        else if (key->scene == SCENE_PACKING)
            make_packing(workload);
        else
            make_pairs(workload);
        order_pairs(workload);
    }
    measure_gaps(workload);
}

const struct workload *get_workload(const struct workload_key *key) {
    static struct workload *workloads[MAX_WORKLOADS];
    static size_t count;
    for (size_t k = 0; k < count; k++)
        if (same_key(&workloads[k]->key, key))
            return workloads[k];
    struct workload *workload = allocate(1, sizeof *workload);
    make_workload(workload, key);
    if (count == MAX_WORKLOADS)
        fail("more than %d workloads", MAX_WORKLOADS);
    workloads[count++] = workload;
    return workload;
}

void name_workload(const struct workload_key *key, char *out, size_t size) {
    static const char *const scenes[] = {"disjoint", "colliding",     "mixed",   "packing",      "pyramid",
                                         "lattice",  "settled-small", "settled", "settled-large"};
    static const char *const varieties[VARIETIES] = {[UNIQUE] = "unique", [TEMPLATES] = "templates", [FEW] = "few"};
    static const char *const families[] = {
        [FAMILY_KINDS] = "kinds", [FAMILY_GENERAL] = "general", [FAMILY_ROUNDED] = "rounded",
        [FAMILY_BOXES] = "boxes", [FAMILY_DISCS] = "discs",     [FAMILY_CAPSULES] = "capsules"};
    char family[16];
    if (key->family >= FAMILY_KINDS && key->family <= FAMILY_CAPSULES)
        snprintf(family, sizeof family, "%s", families[key->family]);
    else
        snprintf(family, sizeof family, "n%u", key->edges % 100);
    snprintf(out, size, "%s/%s/%s/%s", family, scenes[key->scene], varieties[key->variety],
             key->sorted ? "sorted" : "random");
}
