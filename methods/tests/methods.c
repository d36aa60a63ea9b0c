/* SPDX-License-Identifier: MIT
 *
 * methods.c - sat, sat-first, polygon-sat and the filters against references of their own, for all kinds of shapes
 * in all kinds of places.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "method_references.h"

static struct corpus corpora[4]; /* both precisions; the same of polygons only */
enum { ANYTHING = 0, POLYGONS = 2, CORPORA = 4 };

static int make_corpora(void **state) {
    (void)state;
    corpora[0] = make_corpus("methods, single", NARC_FLOAT32, 0.6, false);
    corpora[1] = make_corpus("methods, double", NARC_FLOAT64, 0.6, false);
    corpora[2] = make_corpus("methods, polygons, single", NARC_FLOAT32, 2, true);
    corpora[3] = make_corpus("methods, polygons, double", NARC_FLOAT64, 2, true);
    for (int k = 0; k < CORPORA; k++)
        solve_corpus(&corpora[k]);
    return 0;
}

static int destroy_corpora(void **state) {
    (void)state;
    for (int k = 0; k < CORPORA; k++)
        destroy_corpus(&corpora[k]);
    return 0;
}

static const float margins[] = {0, 0.2f, -0.1f, INFINITY};
enum { MARGINS = sizeof margins / sizeof *margins };

/* ------------------------------------------------------------------------------------------------ sat */

static void check_all_done(const uint8_t *outcomes, size_t count) {
    for (size_t k = 0; k < count; k++)
        assert_int_equal(outcomes[k], NARC_OUTCOME_DONE);
}

/* Settings that mean nothing to it change nothing. */
TEST(test_sat_is_narc_find) {
    for (int c = 0; c < CORPORA; c++) {
        const struct scene *scene = &corpora[c].scene;
        const size_t count = scene->pair_count;
        const narc_bodies bodies = scene_bodies(scene);
        const narc_pairs pairs = scene_pairs(scene);
        AUTO(free_at) uint8_t *outcomes = make_junk(count);
        const narc_method_options options = {.tolerance = 0.5f, .iterations = 1, .out_outcomes = outcomes};
        for (int m = 0; m < MARGINS; m++) {
            const narc_query query = {.margin = margins[m]};
            AUTO(free_at) struct contacts found = query_contacts(scene, &options, &query);
            AUTO(free_at) struct contacts expected = find_contacts(scene->store, &bodies, &pairs, &query);
            check_contacts_below(&found, &expected, INFINITY, "sat");
        }
        check_all_done(outcomes, count);
        memset(outcomes, 0xa5, count);
        AUTO(free_at) uint64_t *bits = query_overlaps(scene, &options, NULL), *expected_bits = scene_overlaps(scene);
        assert_memory_equal(bits, expected_bits, NARC_BIT_WORDS(count) * sizeof *bits);
        check_all_done(outcomes, count);
    }
}

/* Exact, in the hard places too. */
TEST(test_sat_is_exact) {
    size_t wrong_pairs = 0;
    for (int c = 0; c < CORPORA; c++) {
        const struct corpus *corpus = &corpora[c];
        AUTO(free_at)
        struct contacts all =
            query_contacts(&corpus->scene, &(narc_method_options){0}, &(narc_query){.margin = INFINITY});
        for (size_t k = 0; k < all.count; k++) {
            const struct exact_pair *pair = &corpus->pairs[k];
            const char *wrong = check_along_normal(pair, &all.rows[k], false);
            wrong = wrong ? wrong : check_between_touches(pair, &all.rows[k]);
            if (!wrong && distance_from_outlines(pair, &all.rows[k]) > point_bounds * pair->bound)
                wrong = "sat: the point is not on the outlines";
            if (!wrong && fabs((double)all.rows[k].separation - pair->gap) > pair->bound)
                wrong = "sat: not the exact separation";
            if (wrong)
                show_wrong_pair(corpus, k, "sat", wrong, &all.rows[k], 0, &wrong_pairs);
        }
    }
    assert_int_equal(wrong_pairs, 0);
}

/* ------------------------------------------------------------------------------------------------ sat-first */

/* What the reference says of a pair's answer. */
struct first_verdict {
    const char *wrong;
    bool doubted;             /* some pair of arcs was in doubt before the answer */
    bool found;               /* the answer is some pair of arcs */
    double value;             /* the separation that is right for these arcs */
    size_t before, arc_count; /* pairs of arcs that failed before it, of how many */
};

static double value_of(const struct first_body *a, const struct first_body *b, size_t i, size_t j) {
    return hypot(b->x[j] - a->x[i], b->y[j] - a->y[i]) - a->radius[i] - b->radius[j];
}

/* The number that is reported of an arc: where the normal seems to lie on its end it may be the next arc. */
static bool is_arc(const struct first_body *body, size_t arc, unsigned told, bool sure) {
    if (body->circle)
        return told == 0;
    return told == arc || (!sure && told == (arc + 1) % body->count);
}

/* Is this the answer for arcs i and j? Their u is off by less than the bound of a separation, of which its own error is
 * only a part; the normal is u over its length, and a dozen roundings. */
static bool is_first_pair(const struct exact_pair *pair, const struct first_body *a, const struct first_body *b,
                          size_t i, size_t j, const narc_contact *told, bool sure) {
    const double u_x = b->x[j] - a->x[i], u_y = b->y[j] - a->y[i], length = hypot(u_x, u_y);
    const double n_x = (double)told->normal_x, n_y = (double)told->normal_y;
    if (!is_arc(a, i, arc_of_a(told->feature), sure) || !is_arc(b, j, arc_of_b(told->feature), sure) ||
        fabs(value_of(a, b, i, j) - (double)told->separation) > pair->bound)
        return false;
    if (hypot(length * n_x - u_x, length * n_y - u_y) > pair->bound + 1e-6 * length)
        return false;
    if (!sure) /* the normal may seem to be that of an edge, whose middle is told then */
        return true;
    /* Halfway between the arcs' points; the normal's error counts times the radius. */
    const double off = length > 0 ? fmin(pair->bound / length + 1e-6, 2) : 2;
    const double p_x = (a->x[i] + b->x[j] + (a->radius[i] - b->radius[j]) * n_x) / 2,
                 p_y = (a->y[i] + b->y[j] + (a->radius[i] - b->radius[j]) * n_y) / 2;
    return hypot(p_x - (double)told->point_x, p_y - (double)told->point_y) <=
           1.5 * pair->bound + off * fmax(a->radius[i], b->radius[j]);
}

/* Goes through all pairs of arcs, those of A outside: the answer is the first that passes for certain, or one in doubt
 * before it, or none. */
static struct first_verdict judge_first(const struct exact_pair *pair, const narc_contact *told, unsigned outcome) {
    const struct first_body a = make_first_body(&pair->a, &pair->a), b = make_first_body(&pair->b, &pair->a);
    struct first_verdict verdict = {.value = INFINITY, .arc_count = a.count * b.count};
    const bool none = outcome == NARC_OUTCOME_NONE;
    for (size_t pair_of_arcs = 0; pair_of_arcs < verdict.arc_count; pair_of_arcs++) {
        const size_t i = pair_of_arcs / b.count, j = pair_of_arcs % b.count;
        const enum sureness sureness = test_arcs(&a, &b, pair->reach, i, j);
        verdict.before += sureness == FAILS;
        if (sureness == FAILS)
            continue;
        const bool sure = sureness == PASSES && !verdict.doubted;
        if (!none && is_first_pair(pair, &a, &b, i, j, told, sureness == PASSES)) {
            verdict.found = true;
            verdict.value = value_of(&a, &b, i, j);
            verdict.doubted = !sure;
            return verdict;
        }
        verdict.doubted = true;
        if (sureness == PASSES) {
            verdict.wrong = none ? "none, but a pair of arcs passes" : "not the first pair of arcs that passes";
            return verdict;
        }
    }
    verdict.wrong = none ? NULL : "a pair of arcs that does not pass";
    return verdict;
}

struct first_counts {
    size_t pairs, doubted, none, late, wrong;
    size_t inside,
        wrong_signs; /* pairs of shapes with all centres inside; all others whose answer has the wrong sign */
};

static bool centers_inside(const struct scene *scene, size_t k) {
    const uint32_t a = scene->bodies[scene->pairs[k].a].shape, b = scene->bodies[scene->pairs[k].b].shape;
    return (narc_shape_flags(scene->store, a) & narc_shape_flags(scene->store, b) & NARC_SHAPE_CENTERS_INSIDE) != 0;
}

static void check_first_pair(const struct corpus *corpus, const struct contacts *all, size_t k, unsigned outcome,
                             struct first_counts *counts) {
    const struct exact_pair *pair = &corpus->pairs[k];
    const double separation = (double)all->rows[k].separation;
    const struct first_verdict verdict = judge_first(pair, &all->rows[k], outcome);
    const char *wrong = verdict.wrong;
    const bool sure = !verdict.doubted && verdict.found;
    if (outcome != NARC_OUTCOME_DONE && outcome != NARC_OUTCOME_NONE)
        wrong = "outcome";
    else if (outcome == NARC_OUTCOME_NONE &&
             (!isinf(separation) || all->rows[k].normal_x != 0 || all->rows[k].normal_y != 0 ||
              all->rows[k].point_x != 0 || all->rows[k].point_y != 0 || arc_of_a(all->rows[k].feature) ||
              arc_of_b(all->rows[k].feature)))
        wrong = "none, but an answer";
    /* A pair of arcs that passes has the gap along u, which is never more than the largest gap. */
    if (!wrong && sure && verdict.value > pair->gap + pair->bound)
        wrong = "more than the exact separation";
    /* With all centres inside, what lies between two overlapping arcs' centres is in both shapes. */
    const bool outside_band = fabs(pair->gap) > pair->bound;
    if (!wrong && sure && outside_band && centers_inside(&corpus->scene, k)) {
        counts->inside++;
        if ((separation < 0) != (pair->gap < 0))
            wrong = "the wrong sign though all centres lie inside";
    } else if (outside_band) {
        counts->wrong_signs += (separation < 0) != (pair->gap < 0);
    }
    counts->pairs++;
    counts->doubted += verdict.doubted;
    counts->none += outcome == NARC_OUTCOME_NONE;
    counts->late += verdict.found && verdict.before > 0;
    if (wrong)
        show_wrong_pair(corpus, k, "sat-first", wrong, &all->rows[k], outcome, &counts->wrong);
}

TEST(test_first_pair) {
    struct first_counts counts = {0};
    for (int c = 0; c < CORPORA; c++) {
        const struct corpus *corpus = &corpora[c];
        const size_t count = corpus->scene.pair_count;
        AUTO(free_at) uint8_t *outcomes = make_junk(count), *again = make_junk(count);
        const narc_method_options options = {.method = NARC_METHOD_SAT_FIRST, .out_outcomes = outcomes};
        const narc_method_options other = {.method = NARC_METHOD_SAT_FIRST, .out_outcomes = again};
        const narc_query query = {.margin = INFINITY};
        AUTO(free_at) struct contacts all = query_contacts(&corpus->scene, &options, &query);
        assert_int_equal(all.count, count);
        AUTO(free_at) uint64_t *bits = query_overlaps(&corpus->scene, &other, NULL);
        assert_memory_equal(outcomes, again, count);
        for (size_t k = 0; k < count; k++) {
            assert_int_equal(bit_is_set(bits, k), all.rows[k].separation < 0);
            check_first_pair(corpus, &all, k, outcomes[k], &counts);
        }
        for (int m = 0; m < MARGINS; m++) {
            AUTO(free_at)
            struct contacts found = query_contacts(&corpus->scene, &other, &(narc_query){.margin = margins[m]});
            check_contacts_below(&found, &all, margins[m], "sat-first");
            assert_memory_equal(outcomes, again, count);
        }
    }
    printf("  sat-first: %zu pairs; in doubt %zu, without a pair of arcs %zu, with one that is not the first of all "
           "%zu; sign wrong %zu, of %zu with all centres inside 0\n",
           counts.pairs, counts.doubted, counts.none, counts.late, counts.wrong_signs, counts.inside);
    assert_int_equal(counts.wrong, 0);
    /* Hard places are in doubt on purpose, but only they are. */
    assert_true(counts.doubted < counts.pairs / 2);
    assert_true(counts.late > counts.pairs / 10);
}

/* ------------------------------------------------------------------------------------------------ polygon-sat */

static const char *check_polygon_pair(const struct exact_pair *pair, const narc_contact *told) {
    const double separation = (double)told->separation, right = polygon_gap(&pair->a, &pair->b);
    const char *wrong = check_along_normal(pair, told, false);
    wrong = wrong ? wrong : check_between_touches(pair, told);
    if (wrong)
        return wrong;
    if (fabs(separation - right) > pair->bound)
        return "not the largest gap along an edge normal";
    if (separation > pair->gap + pair->bound)
        return "more than the exact separation";
    /* Of polygons that are apart, the normal is mostly not that of the closest points. */
    if (pair->gap <= 0 && distance_from_outlines(pair, told) > point_bounds * pair->bound)
        return "the point is not on the outlines";
    return NULL;
}

TEST(test_polygons) {
    size_t wrong_pairs = 0, apart = 0, colliding = 0, less = 0;
    for (int c = POLYGONS; c < CORPORA; c++) {
        const struct corpus *corpus = &corpora[c];
        const size_t count = corpus->scene.pair_count;
        AUTO(free_at) uint8_t *outcomes = make_junk(count);
        const narc_method_options options = {.method = NARC_METHOD_POLYGON_SAT, .out_outcomes = outcomes};
        narc_query query = {.margin = INFINITY};
        AUTO(free_at) struct contacts all = query_contacts(&corpus->scene, &options, &query);
        assert_int_equal(all.count, count);
        check_all_done(outcomes, count);
        memset(outcomes, 0xa5, count);
        AUTO(free_at) uint64_t *bits = query_overlaps(&corpus->scene, &options, &query);
        check_all_done(outcomes, count);
        for (size_t k = 0; k < count; k++) {
            const struct exact_pair *pair = &corpus->pairs[k];
            const char *wrong = check_polygon_pair(pair, &all.rows[k]);
            if (bit_is_set(bits, k) != (all.rows[k].separation < 0))
                wrong = "bit and separation differ";
            else if (fabs(pair->gap) > pair->bound && bit_is_set(bits, k) != (pair->gap < 0))
                wrong = "overlap";
            apart += pair->gap > pair->bound;
            colliding += pair->gap < -pair->bound;
            less += (double)all.rows[k].separation < pair->gap - pair->bound;
            if (wrong)
                show_wrong_pair(corpus, k, "polygon-sat", wrong, &all.rows[k], outcomes[k], &wrong_pairs);
        }
        /* It may end early, but reports the same. */
        const float more[] = {0, 0.2f, 1e-6f, -1e-6f, -0.1f, -10, 10};
        for (size_t m = 0; m < sizeof more / sizeof *more; m++) {
            query.margin = more[m];
            AUTO(free_at) struct contacts found = query_contacts(&corpus->scene, &options, &query);
            check_contacts_below(&found, &all, more[m], "polygon-sat");
        }
    }
    printf("  polygon-sat: %zu pairs apart, of %zu of them less than the distance; %zu colliding\n", apart, less,
           colliding);
    assert_int_equal(wrong_pairs, 0);
    assert_true(apart > 0 && colliding > 0 && less > 0);
}

/* ------------------------------------------------------------------------------------------------ filters */

/* What a filter may be off by. Circles: the radii have room of 96 e of the extents, the filter loses 128 e of the
 * distance and its rounding is below 32 e of the reach: 256 e. Boxes: both half sides have room of 96 e of the extents,
 * of which at most the root of 2 counts along any axis, 136 e; their middles and axes are off like an arc's centre and
 * normal, 27 e and 12 e, and the dot products and sums round by 20 e more. */
static const double filter_band = 256.0 / 16777216.0;

struct filter_counts {
    size_t apart, colliding, wrong, false_alarms;
};

/* `least` and `most`: how far the filter's shapes are apart, where there is a choice of them. */
static void check_filter(const struct corpus *corpus, size_t k, bool told, double least, double most,
                         struct filter_counts *counts) {
    const struct exact_pair *pair = &corpus->pairs[k];
    const double band = filter_band * pair->reach;
    const char *wrong = NULL;
    if (pair->gap <= 0 && !told)
        wrong = "no, though the bodies collide";
    else if (least > band && told)
        wrong = "yes, though the filter's shapes are apart";
    else if (most < -band && !told)
        wrong = "no, though the filter's shapes overlap";
    counts->apart += least > band;
    counts->colliding += most < -band;
    counts->false_alarms += told && pair->gap > 0;
    if (wrong) {
        show_wrong_pair(corpus, k, "filter", wrong, NULL, 0, &counts->wrong);
        print_error("  filter: told %d, gap %.9g .. %.9g, band %.3g\n", told, least, most, band);
    }
}

TEST(test_filters) {
    struct filter_counts counts[3] = {{0}};
    for (int c = 0; c < CORPORA; c++) {
        const struct corpus *corpus = &corpora[c];
        const struct scene *scene = &corpus->scene;
        const size_t count = scene->pair_count;
        AUTO(free_at) struct smallest_boxes *boxes = malloc(scene->shape_count * sizeof *boxes);
        assert_non_null(boxes);
        for (size_t k = 0; k < scene->shape_count; k++)
            boxes[k] = find_boxes(&scene->shapes[k]);
        uint64_t *bits[3];
        AUTO(free_at) uint8_t *outcomes = make_junk(count);
        for (int f = 0; f < 3; f++) {
            const narc_method_options options = {.method = (narc_method)(NARC_METHOD_CIRCLE + f),
                                                 .out_outcomes = outcomes};
            memset(outcomes, 0xa5, count);
            bits[f] = query_overlaps(scene, &options, NULL);
            check_all_done(outcomes, count);
        }
        for (size_t k = 0; k < count; k++) {
            const struct reference_body *a = &corpus->pairs[k].a, *b = &corpus->pairs[k].b;
            const struct smallest_boxes *of_a = &boxes[scene->bodies[scene->pairs[k].a].shape],
                                        *of_b = &boxes[scene->bodies[scene->pairs[k].b].shape];
            double least[3], most[3];
            least[0] = most[0] = circle_gap(a, b);
            least[1] = least[2] = INFINITY;
            most[1] = most[2] = -INFINITY;
            for (size_t i = 0; i < of_a->count * of_b->count; i++) {
                const struct plain_box box_a = place_box(&of_a->box[i % of_a->count], a, a),
                                       box_b = place_box(&of_b->box[i / of_a->count], b, a);
                const double gap[3] = {0, axis_gap(&box_a, &box_b), box_gap(&box_a, &box_b)};
                for (int f = 1; f < 3; f++) {
                    least[f] = fmin(least[f], gap[f]);
                    most[f] = fmax(most[f], gap[f]);
                }
            }
            for (int f = 0; f < 3; f++)
                check_filter(corpus, k, bit_is_set(bits[f], k), least[f], most[f], &counts[f]);
        }
        for (int f = 0; f < 3; f++)
            free(bits[f]);
    }
    for (int f = 0; f < 3; f++) {
        printf("  %s: %zu apart, %zu overlapping; says yes of %zu separated pairs\n",
               narc_method_name((narc_method)(NARC_METHOD_CIRCLE + f)), counts[f].apart, counts[f].colliding,
               counts[f].false_alarms);
        assert_int_equal(counts[f].wrong, 0);
        assert_true(counts[f].apart > 0 && counts[f].colliding > 0);
    }
}

/* Filters say yes wherever the exact method does, of shapes far from their own origin too. */
TEST(test_filters_far_from_origin) {
    struct test_random random = test_random_named("filters far from origin");
    for (int decade = FIRST_FAR; decade <= LAST_FAR; decade++) {
        AUTO(destroy_scene) struct scene scene = make_far_scene(&random, decade);
        AUTO(free_at) uint64_t *exact = scene_overlaps(&scene);
        for (narc_method method = NARC_METHOD_CIRCLE; narc_method_name(method); method++) {
            AUTO(free_at) uint64_t *passed = query_overlaps(&scene, &(narc_method_options){.method = method}, NULL);
            for (size_t k = 0; k < NARC_BIT_WORDS(scene.pair_count); k++)
                assert_true((exact[k] & ~passed[k]) == 0);
        }
    }
}

/* Which bodies are broken is the core's rule, for bodies at the limits of what they may be; outcomes are those of any
 * other pair. */
TEST(test_broken_bodies) {
    enum { PAIRS = 1200 };
    struct test_random random = test_random_named("broken bodies");
    AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT64, 1, 2 * PAIRS, PAIRS);
    const struct shape box = box_of(2, 1, 0);
    scene_add_shape(&scene, &box);
    for (size_t k = 0; k < PAIRS; k++) {
        const double error = (random_below(&random, 2) ? 1 : -1) * NARC_ROTATION_TOLERANCE;
        const double length = sqrt(1 + error) * (1 + random_between(&random, -4e-7, 4e-7));
        const double size = (random_below(&random, 2) ? NARC_MIN_SIZE : NARC_MAX_SIZE) / hypot(1, 0.5);
        struct body a = turned_body(0, 1), b = turned_body(random_between(&random, -PI, PI), 1);
        if (k % 2) {
            b.cosine = (float)(length * (double)b.cosine);
            b.sine = (float)(length * (double)b.sine);
        } else {
            a.scale = b.scale = (float)(size * (1 + random_between(&random, -3e-5, 3e-5)));
        }
        scene_add_two(&scene, a, b);
    }
    AUTO(free_at) struct contacts all = scene_contacts(&scene, INFINITY);
    size_t broken = 0;
    for (size_t k = 0; k < all.count; k++)
        broken += all.rows[k].count == 0;
    assert_in_range(broken, PAIRS / 5, PAIRS * 4 / 5);
    for (narc_method method = NARC_METHOD_SAT; narc_method_name(method); method++) {
        uint8_t outcomes[PAIRS];
        size_t skipped = 0;
        const narc_method_options options = {.method = method, .out_outcomes = outcomes};
        const narc_query query = {.margin = INFINITY, .out_skipped = &skipped};
        free(query_overlaps(&scene, &options, &query));
        assert_int_equal(skipped, broken);
        if (method < NARC_METHOD_CIRCLE) {
            AUTO(free_at) struct contacts found = query_contacts(&scene, &options, &query);
            for (size_t k = 0; k < PAIRS; k++)
                if (all.rows[k].count == 0)
                    assert_true(found.rows[k].count == 0 && outcomes[k] == NARC_OUTCOME_DONE);
        }
        assert_int_equal(skipped, broken);
    }
}

/* ------------------------------------------------------------------------------------------------ circles */

/* Two bodies of one shape without rotation. */
static struct scene make_two(const struct shape *shape, double x, double y) {
    struct scene scene = create_scene(NARC_FLOAT64, 1, 2, 1);
    struct body a = turned_body(0, 1), b = a;
    b.x = x;
    b.y = y;
    scene_add_shape(&scene, shape);
    scene_add_two(&scene, a, b);
    return scene;
}

/* Every direction is as good. EPA's polygon with n corners comes as near as 1 - cos(pi / n) of the sum of radii, so that
 * a tolerance of 1e-2 takes 23 of them; 8 points and the triangle's 3 are too few; and one of 1e-6 takes more than there
 * may be: it ends with LIMIT then, though what it has found is right. */
TEST(test_circles_in_one_place) {
    static const struct {
        float tolerance;
        unsigned iterations, outcome;
        double off;
    } ways[] = {{1e-2f, 0, NARC_OUTCOME_DONE, 0.02 + 1e-5},
                {1e-2f, 8, NARC_OUTCOME_LIMIT, INFINITY},
                {1e-6f, 0, NARC_OUTCOME_LIMIT, 1e-5}};
    const struct shape disc = circle_of(1);
    AUTO(destroy_scene) struct scene scene = make_two(&disc, 0, 0);
    uint8_t outcome;
    for (size_t k = 0; k < sizeof ways / sizeof *ways; k++) {
        const narc_method_options options = {.method = NARC_METHOD_GJK,
                                             .tolerance = ways[k].tolerance,
                                             .iterations = ways[k].iterations,
                                             .out_outcomes = &outcome};
        AUTO(free_at) struct contacts found = query_contacts(&scene, &options, &(narc_query){.margin = INFINITY});
        assert_int_equal(outcome, ways[k].outcome);
        assert_true(fabs((double)found.rows[0].separation + 2) <= ways[k].off);
        AUTO(free_at) uint64_t *bits = query_overlaps(&scene, &options, NULL);
        assert_true(bit_is_set(bits, 0) && outcome == NARC_OUTCOME_DONE);
    }
    /* The first of Algorithm 2's arcs has no direction to look along. */
    const narc_method_options first = {.method = NARC_METHOD_SAT_FIRST, .out_outcomes = &outcome};
    AUTO(free_at) uint64_t *bits = query_overlaps(&scene, &first, NULL);
    assert_true(!bit_is_set(bits, 0) && outcome == NARC_OUTCOME_NONE);
}

/* A circle is two cones of half a turn, and the vector between the centres lies on the line where they meet: sat-first
 * must find it in one of them. */
TEST(test_first_at_the_seam) {
    static const float turns[][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {0.6f, 0.8f}};
    const struct shape disc = circle_of(1);
    for (size_t k = 0; k < 2 * sizeof turns / sizeof *turns; k++) {
        const float *turn = turns[k / 2], side = k % 2 ? 1 : -1;
        const narc_point to = {(double)(side * turn[0]), (double)(side * turn[1])};
        AUTO(destroy_scene) struct scene scene = make_two(&disc, to.x, to.y);
        for (size_t i = 0; i < 2; i++) {
            scene.bodies[i].cosine = turn[0];
            scene.bodies[i].sine = turn[1];
        }
        uint8_t outcome = 0xa5;
        const narc_method_options options = {.method = NARC_METHOD_SAT_FIRST, .out_outcomes = &outcome};
        AUTO(free_at) struct contacts found = query_contacts(&scene, &options, &(narc_query){.margin = INFINITY});
        assert_int_equal(outcome, NARC_OUTCOME_DONE);
        assert_true(fabs((double)found.rows[0].separation + 1) < 1e-6);
        assert_true(fabs((double)found.rows[0].normal_x - to.x) < 1e-6);
        assert_true(fabs((double)found.rows[0].normal_y - to.y) < 1e-6);
    }
}

int main(void) { return test_begin() ? test_run("methods", make_corpora, destroy_corpora) : TEST_SKIPPED; }
