/* SPDX-License-Identifier: MIT
 *
 * paper.c - the published test for two n-arcs, as its text describes it, goes wrong; this library does not.
 *
 * The published test looks for two arcs, one of each shape, such that each centre lies in the sector of the other arc
 * and the vector between the centres points the same way as that between the centroids (positive dot product). It
 * believes the first such pair: the shapes collide if the sum of the radii is more than the distance of the centres.
 * But a pair of arcs that overlap proves nothing as long as another pair may be apart, and the centroids don't always
 * tell which.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "check.h"
#include "placements.h"

static const double pi = 3.14159265358979323846;

struct vector {
    double x, y;
};

static double cross(struct vector a, struct vector b) { return a.x * b.y - a.y * b.x; }

static double dot(struct vector a, struct vector b) { return a.x * b.x + a.y * b.y; }

static struct vector minus(struct vector a, struct vector b) { return (struct vector){a.x - b.x, a.y - b.y}; }

/* A posed n-arc as the published test wants it: centres, directions of the sectors' ends, radii, centroid. */
struct placed {
    size_t count;
    struct vector center[NARC_MAX_ARCS], direction[NARC_MAX_ARCS + 1], centroid;
    double radius[NARC_MAX_ARCS];
};

static struct placed place(const struct reference_body *body) {
    struct placed placed = {.count = body->count};
    narc_mass mass;
    assert_true(narc_compute_mass(body->arcs, body->count, &mass));
    double c = body->cosine, s = body->sine, turn = atan2(s, c);
    placed.centroid = (struct vector){body->x + c * mass.centroid_x - s * mass.centroid_y,
                                      body->y + s * mass.centroid_x + c * mass.centroid_y};
    for (size_t i = 0; i < body->count; i++) {
        const narc_arc *arc = &body->arcs[i];
        placed.center[i] = (struct vector){body->x + c * arc->center_x - s * arc->center_y,
                                           body->y + s * arc->center_x + c * arc->center_y};
        placed.direction[i] = (struct vector){cos(arc->start + turn), sin(arc->start + turn)};
        placed.radius[i] = arc->radius;
    }
    placed.direction[body->count] = placed.direction[0];
    return placed;
}

enum verdict { NO_PAIR_OF_ARCS, APART, COLLIDING };

static enum verdict published_test(const struct placed *a, const struct placed *b) {
    struct vector centroids = minus(b->centroid, a->centroid);
    for (size_t i = 0; i < a->count; i++) {
        for (size_t j = 0; j < b->count; j++) {
            struct vector centers = minus(b->center[j], a->center[i]);
            if (cross(centers, a->direction[i + 1]) >= 0 && cross(centers, a->direction[i]) < 0 &&
                cross(centers, b->direction[j + 1]) < 0 && cross(centers, b->direction[j]) >= 0 &&
                dot(centers, centroids) > 0) {
                double radii = a->radius[i] + b->radius[j];
                return radii * radii > dot(centers, centers) ? COLLIDING : APART;
            }
        }
    }
    return NO_PAIR_OF_ARCS;
}

/* Two equal arcs that meet in small round tips, half as wide as 1 and 1 : 10 to 1 : 50 flat. */
static struct shape flat_lens(struct test_random *random) {
    struct shape shape;
    double sagitta = random_log_between(random, 0.02, 0.1), radius = (1 + sagitta * sagitta) / (2 * sagitta);
    narc_four_arc form = {radius, radius, 2 * (radius - sagitta), sagitta / 10, sagitta / 10};
    assert_int_equal(narc_build_four_arc(form, shape.arcs, &shape.count, NULL), NARC_OK);
    return shape;
}

static struct shape random_n_arc(struct test_random *random) {
    return make_shape(random, random_below(random, 2) ? FAMILY_SMOOTH : FAMILY_UNEQUAL);
}

struct tally {
    size_t apart, colliding;             /* pairs, by their exact gap, outside the error bound */
    size_t wrong_apart, wrong_colliding; /* of which the published test errs, */
    size_t ours_wrong;                   /* or we */
    double worst;                        /* the largest distance of shapes it says collide */
};

static void print_tally(const char *name, const struct tally *tally) {
    printf("  %s: published test wrong on %zu of %zu separated (%.3g %%, up to %.3g apart), %zu of %zu colliding; ours "
           "on %zu\n",
           name, tally->wrong_apart, tally->apart, 100.0 * (double)tally->wrong_apart / (double)tally->apart,
           tally->worst, tally->wrong_colliding, tally->colliding, tally->ours_wrong);
}

static struct tally compare(const char *name, struct shape (*make)(struct test_random *), size_t pairs) {
    struct test_random random = test_random_named(name);
    struct tally tally = {0};
    struct scene scene = create_scene(NARC_FLOAT64, 2 * pairs, 2 * pairs, pairs);
    for (size_t k = 0; k < pairs; k++) {
        struct shape shape_a = make(&random), shape_b = make(&random);
        struct body a = turned_body(random_between(&random, -pi, pi), 1),
                    b = turned_body(random_between(&random, -pi, pi), 1);
        place_at_gap(&shape_a, &shape_b, random_between(&random, -pi, pi), random_between(&random, -0.3, 0.5), &a, &b);
        a.shape = scene_add_shape(&scene, &shape_a);
        b.shape = scene_add_shape(&scene, &shape_b);
        scene_add_two(&scene, a, b);
    }
    uint64_t *bits = scene_overlaps(&scene);
    for (size_t k = 0; k < pairs; k++) {
        struct reference_body a = scene_reference(&scene, scene.pairs[k].a),
                              b = scene_reference(&scene, scene.pairs[k].b);
        double gap = reference_find_gap(&a, &b).gap;
        if (fabs(gap) <= separation_bound(&a, &b))
            continue;
        struct placed placed_a = place(&a), placed_b = place(&b);
        enum verdict verdict = published_test(&placed_a, &placed_b);
        tally.ours_wrong += bit_is_set(bits, k) != (gap < 0);
        if (gap > 0) {
            tally.apart++;
            tally.wrong_apart += verdict != APART;
            tally.worst = verdict == COLLIDING ? fmax(tally.worst, gap) : tally.worst;
        } else {
            tally.colliding++;
            tally.wrong_colliding += verdict != COLLIDING;
        }
    }
    print_tally(name, &tally);
    free(bits);
    destroy_scene(&scene);
    return tally;
}

TEST(test_flat_lenses) {
    /* It is a few per cent: even the shortest run needs this many pairs to say that it is more than one. */
    const size_t least = 3000;
    size_t pairs = test_trials(4000);
    struct tally tally = compare("flat lenses", flat_lens, pairs < least ? least : pairs);
    assert_int_equal(tally.ours_wrong, 0);
    assert_true((double)tally.wrong_apart > 0.01 * (double)tally.apart);
}

TEST(test_random_n_arcs) {
    struct tally tally = compare("random n-arcs", random_n_arc, test_trials(4000));
    assert_int_equal(tally.ours_wrong, 0);
}

TEST_MAIN("paper")
