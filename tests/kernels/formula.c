/* SPDX-License-Identifier: MIT
 *
 * formula.c - the formula of docs/algorithm.md (examples/formula.c) against the reference's search of all directions.
 */
#include <math.h>

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
