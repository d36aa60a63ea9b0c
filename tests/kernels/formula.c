/* SPDX-License-Identifier: MIT
 *
 * formula.c - the formula of docs/algorithm.md (examples/formula.c) against the reference's search of all
 * directions, and the kernels against the formula.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "check.h"
#include "formula.h"
#include "placements.h"

/* A body of the tests as the formula wants it. Its rotation counts without its length, as in the kernels. */
struct formula_body {
    arc arcs[NARC_MAX_ARCS];
    shape shape;
    pose pose;
};

static void read_body(const struct shape *from, const struct body *body, struct formula_body *out) {
    for (size_t i = 0; i < from->count; i++) {
        const narc_arc *a = &from->arcs[i];
        out->arcs[i] = (arc){{a->center_x, a->center_y}, a->radius, a->start, a->end};
    }
    out->shape = (shape){out->arcs, (int)from->count};
    out->pose = (pose){{body->x, body->y}, atan2((double)body->sine, (double)body->cosine), (double)body->scale};
}

static double separation_of(const struct scene *scene, size_t pair) {
    struct formula_body a, b;
    const struct body *body_a = &scene->bodies[scene->pairs[pair].a], *body_b = &scene->bodies[scene->pairs[pair].b];
    read_body(&scene->shapes[body_a->shape], body_a, &a);
    read_body(&scene->shapes[body_b->shape], body_b, &b);
    return formula_separation(a.shape, a.pose, b.shape, b.pose);
}

/* Every pair's separation from narc_find_contacts() is within the documented bound of the formula's, and whether
 * narc_find_overlaps() sets its bit can differ only where the formula is that close to 0. */
static void check_kernels(const struct scene *scene, double *worst) {
    struct contacts contacts = scene_contacts(scene, INFINITY);
    uint64_t *bits = scene_overlaps(scene);
    size_t overlaps = 0;
    assert_int_equal(contacts.count, scene->pair_count);
    for (size_t k = 0; k < scene->pair_count; k++) {
        const struct reference_body a = scene_reference(scene, scene->pairs[k].a);
        const struct reference_body b = scene_reference(scene, scene->pairs[k].b);
        const double formula = separation_of(scene, k), kernel = (double)contacts.rows[k].separation;
        const double bound = separation_bound(&a, &b);
        *worst = fmax(*worst, fabs(kernel - formula) / bound);
        if (!(fabs(kernel - formula) <= bound) || (fabs(formula) > bound && bit_is_set(bits, k) != (formula < 0))) {
            print_pair(&a, &b);
            fail_msg("pair %zu: the kernels say %.9g, the formula %.17g; bound %.3g", k, kernel, formula, bound);
        }
        overlaps += formula < 0;
    }
    assert_in_range(overlaps, 1, scene->pair_count - 1);
    free(bits);
    free(contacts.rows);
}

TEST(test_random_pairs) {
    struct test_random random = test_random_named("formula");
    double worst = 0;
    for (int precision = 0; precision < 2; precision++) {
        struct scene scene =
            make_random_scene(&random, precision ? NARC_FLOAT64 : NARC_FLOAT32, 1000, test_trials(4000));
        check_kernels(&scene, &worst);
        destroy_scene(&scene);
    }
    printf("largest error: %.2f of the bound\n", worst);
}

/* All kinds of shapes in all the places where collision tests go wrong. */
TEST(test_placed_pairs) {
    struct test_random random = test_random_named("placed formula");
    const size_t per_pair = test_trials(3), pairs = (size_t)FAMILY_COUNT * FAMILY_COUNT * per_pair;
    double worst = 0;
    for (enum placement placement = 0; placement < PLACE_COUNT; placement++) {
        struct scene scene = create_scene(NARC_FLOAT64, 2 * pairs, 2 * pairs, pairs);
        for (size_t k = 0; k < pairs; k++) {
            struct shape shape_a = make_shape(&random, (enum family)(k % FAMILY_COUNT));
            struct shape shape_b = make_shape(&random, (enum family)(k / FAMILY_COUNT % FAMILY_COUNT));
            struct body a, b;
            place_pair(&random, placement, NARC_FLOAT64, &shape_a, &shape_b, &a, &b);
            a.shape = scene_add_shape(&scene, &shape_a);
            b.shape = scene_add_shape(&scene, &shape_b);
            scene_add_two(&scene, a, b);
        }
        check_kernels(&scene, &worst);
        destroy_scene(&scene);
    }
    printf("largest error: %.2f of the bound\n", worst);
}

/* In double precision the formula and a search of all directions agree far below what the kernels promise. */
TEST(test_against_search) {
    struct test_random random = test_random_named("formula and search");
    for (size_t k = 0; k < test_trials(3000); k++) {
        struct shape shape_a = make_shape(&random, (enum family)(k % FAMILY_COUNT));
        struct shape shape_b = make_shape(&random, (enum family)(k / FAMILY_COUNT % FAMILY_COUNT));
        struct body body_a, body_b;
        struct formula_body a, b;
        place_pair(&random, (enum placement)random_below(&random, PLACE_SCALED), NARC_FLOAT64, &shape_a, &shape_b,
                   &body_a, &body_b);
        read_body(&shape_a, &body_a, &a);
        read_body(&shape_b, &body_b, &b);
        struct reference_body reference_a = pose_shape(&shape_a, &body_a), reference_b = pose_shape(&shape_b, &body_b);
        /* The reference takes the rotation with its length. */
        a.pose.scale *= hypot((double)body_a.cosine, (double)body_a.sine);
        b.pose.scale *= hypot((double)body_b.cosine, (double)body_b.sine);
        const double formula = formula_separation(a.shape, a.pose, b.shape, b.pose);
        const double searched = reference_find_gap(&reference_a, &reference_b).gap;
        if (fabs(formula - searched) > 1e-11 * reference_reach(&reference_a, &reference_b)) {
            print_pair(&reference_a, &reference_b);
            fail_msg("the formula says %.17g, the search %.17g", formula, searched);
        }
    }
}

TEST_MAIN("formula")
