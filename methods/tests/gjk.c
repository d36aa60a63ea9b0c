/* SPDX-License-Identifier: MIT
 *
 * gjk.c - gjk for all kinds of shapes in all kinds of places: what it promises, with any tolerance, any
 * number of iterations, and from any cached simplexes.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "guard.h"
#include "method_support.h"

static struct corpus corpora[3]; /* both precisions, and polygons */
enum { CORPORA = 3 };

static int make_corpora(void **state) {
    (void)state;
    corpora[0] = make_corpus("gjk, single", NARC_FLOAT32, 0.4, false);
    corpora[1] = make_corpus("gjk, double", NARC_FLOAT64, 0.4, false);
    corpora[2] = make_corpus("gjk, polygons", NARC_FLOAT32, 1, true);
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

/* What a run on a corpus came to. */
struct counts {
    size_t pairs, outcomes[4], wrong;
    double worst; /* by how much a separation is less than the exact one, of what is allowed */
    double off;   /* by how much a point is off the outlines, of what is allowed */
};

static void print_counts(const char *name, const struct counts *t) {
    printf("  %-28s %7zu pairs: done %zu, limit %zu, rounding %zu; largest error %.3f of the tolerance, points' %.3f\n",
           name, t->pairs, t->outcomes[NARC_OUTCOME_DONE], t->outcomes[NARC_OUTCOME_LIMIT],
           t->outcomes[NARC_OUTCOME_ROUNDING], t->worst, t->off);
}

/* ------------------------------------------------------------------------------------------------ contacts */

static double tolerance_of(const narc_method_options *options) {
    return options->tolerance > 0 ? (double)options->tolerance : (double)NARC_DEFAULT_TOLERANCE;
}

/* How far from the outlines the closest points may be. They lie on both support lines, beside points of A and B whose
 * difference is the nearest point of a segment within the difference: that falls short of the support line of the
 * difference by `allowed` at most, and each of the two points of its own body's by no more. */
static double allowed_distance(const struct exact_pair *pair, double allowed) {
    return allowed + point_bounds * pair->bound;
}

/* The separation is the gap along the normal, so it is never more than the exact one; less by the tolerance at most if
 * the search ended well. Both but for rounding: the bound for the separation that is told, and as much for the other
 * limit, the distance of the segment from the origin, which is made of two support points. */
static const char *check_gjk_contact(const struct exact_pair *pair, const narc_contact *told,
                                     const narc_method_options *options, unsigned outcome, struct counts *counts) {
    const double separation = (double)told->separation;
    const double allowed = tolerance_of(options) * pair->size + 2 * pair->bound;
    /* GJK ended before it knew whether they collide, so the separation is not negative. */
    const bool unknown = outcome != NARC_OUTCOME_DONE && separation == 0;
    const char *wrong = check_along_normal(pair, told, unknown);
    if (wrong || unknown)
        return wrong;
    if (outcome > NARC_OUTCOME_ROUNDING)
        return "no such outcome";
    if (separation > pair->gap + pair->bound)
        return "more than the exact separation";
    if (outcome == NARC_OUTCOME_DONE) {
        const double allowed_off = allowed_distance(pair, allowed), off = distance_from_outlines(pair, told);
        counts->worst = fmax(counts->worst, (pair->gap - separation) / allowed);
        counts->off = fmax(counts->off, off / allowed_off);
        if (pair->gap - separation > allowed)
            return "further from the exact separation than the tolerance";
        if (off > allowed_off)
            return "the closest points are too far from the outlines";
    }
    return NULL;
}

/* All contacts of a corpus. Outcomes must be wanted. */
static struct counts check_contacts(const struct corpus *corpus, const narc_method_options *options, const char *name) {
    const size_t count = corpus->scene.pair_count;
    struct counts counts = {.pairs = count};
    memset(options->out_outcomes, 0xa5, count);
    AUTO(free_at) struct contacts all = query_contacts(&corpus->scene, options, &(narc_query){.margin = INFINITY});
    assert_int_equal(all.count, count);
    for (size_t k = 0; k < count; k++) {
        const unsigned outcome = options->out_outcomes[k];
        const char *wrong = check_gjk_contact(&corpus->pairs[k], &all.rows[k], options, outcome, &counts);
        counts.outcomes[outcome % 4]++;
        if (all.rows[k].pair != k)
            wrong = "pair index";
        if (wrong)
            show_wrong_pair(corpus, k, name, wrong, &all.rows[k], outcome, &counts.wrong);
    }
    return counts;
}

TEST(test_tolerances) {
    static const float tolerances[] = {0, 1e-1f, 1e-2f, 1e-3f, 1e-4f, 1e-5f, 1e-6f, 1e-30f, 1e30f};
    size_t wrong = 0;
    for (size_t t = 0; t < sizeof tolerances / sizeof *tolerances; t++) {
        for (int c = 0; c < CORPORA; c++) {
            char name[64];
            AUTO(free_at) uint8_t *outcomes = make_junk(corpora[c].scene.pair_count);
            const narc_method_options options = {
                .method = NARC_METHOD_GJK, .tolerance = tolerances[t], .out_outcomes = outcomes};
            snprintf(name, sizeof name, "tolerance %g, scene %d", (double)tolerances[t], c);
            const struct counts counts = check_contacts(&corpora[c], &options, name);
            print_counts(name, &counts);
            wrong += counts.wrong;
        }
    }
    assert_int_equal(wrong, 0);
}

typedef struct counts check_corpus(const struct corpus *corpus, const narc_method_options *options, const char *name);

/* How many pairs of all corpora run out of iterations; none is wrong. */
static size_t count_all_limits(check_corpus *check, const char *what, unsigned iterations) {
    size_t limits = 0;
    for (int c = 0; c < CORPORA; c++) {
        char name[64];
        AUTO(free_at) uint8_t *outcomes = make_junk(corpora[c].scene.pair_count);
        const narc_method_options options = {
            .method = NARC_METHOD_GJK, .iterations = iterations, .out_outcomes = outcomes};
        snprintf(name, sizeof name, "%s, iterations %u, scene %d", what, iterations, c);
        const struct counts counts = check(&corpora[c], &options, name);
        print_counts(name, &counts);
        assert_int_equal(counts.wrong, 0);
        limits += counts.outcomes[NARC_OUTCOME_LIMIT];
    }
    return limits;
}

/* Few iterations: less exact, and told so, but never more than exact. */
TEST(test_iterations) {
    static const unsigned iterations[] = {1, 2, 3, 4, 5, 8, 16, 128, 129, UINT32_MAX};
    size_t limits[sizeof iterations / sizeof *iterations];
    for (size_t i = 0; i < sizeof iterations / sizeof *iterations; i++)
        limits[i] = count_all_limits(check_contacts, "contacts", iterations[i]);
    /* More iterations, fewer that run out; as many as there are, however many are asked for. */
    for (size_t i = 1; i < sizeof iterations / sizeof *iterations; i++)
        assert_true(limits[i] <= limits[i - 1]);
    assert_true(limits[0] > 0);
    assert_int_equal(limits[8], limits[7]);
    assert_int_equal(limits[9], limits[7]);
}

/* A margin only saves work: a pair that is closer is reported, one that is further by more than the tolerance is not.
 * With margin 0 it is reported exactly if its bit is set. */
TEST(test_margins) {
    static const float margins[] = {0, 0.25f, 1e-3f, -1e-3f, -0.1f};
    size_t wrong_pairs = 0;
    for (int c = 0; c < CORPORA; c++) {
        const struct corpus *corpus = &corpora[c];
        const size_t count = corpus->scene.pair_count;
        AUTO(free_at) uint8_t *outcomes = make_junk(count);
        const narc_method_options options = {.method = NARC_METHOD_GJK, .out_outcomes = outcomes};
        for (size_t m = 0; m < sizeof margins / sizeof *margins; m++) {
            AUTO(free_at) uint64_t *bits = query_overlaps(&corpus->scene, &options, NULL);
            AUTO(free_at)
            struct contacts found = query_contacts(&corpus->scene, &options, &(narc_query){.margin = margins[m]});
            struct counts counts = {0};
            size_t next = 0;
            for (size_t k = 0; k < count; k++) {
                const struct exact_pair *pair = &corpus->pairs[k];
                const bool listed = next < found.count && found.rows[next].pair == k;
                const double away = pair->gap - (double)margins[m];
                const char *wrong = NULL;
                if (listed) {
                    wrong = check_gjk_contact(pair, &found.rows[next], &options, outcomes[k], &counts);
                    wrong = found.rows[next].separation < margins[m] ? wrong : "reported, but not below the margin";
                }
                if (!listed && away < -pair->bound)
                    wrong = "below the margin, but not reported";
                else if (listed && outcomes[k] == NARC_OUTCOME_DONE &&
                         away > tolerance_of(&options) * pair->size + 2 * pair->bound)
                    wrong = "above the margin, but reported";
                if (margins[m] == 0 && listed != bit_is_set(bits, k))
                    wrong = "bit and list differ";
                if (wrong) {
                    show_wrong_pair(corpus, k, "margin", wrong, NULL, outcomes[k], &wrong_pairs);
                    print_error("  margin %g, outcome %u\n", (double)margins[m], outcomes[k]);
                }
                next += listed;
            }
            assert_int_equal(next, found.count);
        }
    }
    assert_int_equal(wrong_pairs, 0);
}

/* ------------------------------------------------------------------------------------------------ overlaps */

/* Bits and outcomes of a corpus. With a limit on iterations an answer may be missing, and then says so. */
static struct counts check_overlaps(const struct corpus *corpus, const narc_method_options *options, const char *name) {
    const size_t count = corpus->scene.pair_count;
    struct counts counts = {.pairs = count};
    memset(options->out_outcomes, 0xa5, count);
    AUTO(free_at) uint64_t *bits = query_overlaps(&corpus->scene, options, NULL);
    for (size_t k = 0; k < count; k++) {
        const struct exact_pair *pair = &corpus->pairs[k];
        const unsigned outcome = options->out_outcomes[k];
        const char *wrong = NULL;
        counts.outcomes[outcome % 4]++;
        if (outcome > NARC_OUTCOME_ROUNDING)
            wrong = "no such outcome";
        else if (outcome == NARC_OUTCOME_LIMIT && bit_is_set(bits, k))
            wrong = "iterations ran out, but it collides";
        else if (outcome == NARC_OUTCOME_LIMIT && options->iterations == 0)
            wrong = "iterations ran out";
        else if (outcome == NARC_OUTCOME_ROUNDING && !options->simplexes && fabs(pair->gap) > pair->bound)
            wrong = "rounding ended the search";
        else if (fabs(pair->gap) > pair->bound && bit_is_set(bits, k) != (pair->gap < 0) &&
                 (outcome == NARC_OUTCOME_DONE || bit_is_set(bits, k)))
            wrong = "overlap";
        if (wrong) {
            show_wrong_pair(corpus, k, name, wrong, NULL, outcome, &counts.wrong);
            print_error("  answer: outcome %u, bit %d\n", outcome, bit_is_set(bits, k));
        }
    }
    return counts;
}

TEST(test_overlaps) {
    static const unsigned iterations[] = {0, 1, 2, 3, 5, 10};
    size_t limits = 0;
    for (size_t i = 0; i < sizeof iterations / sizeof *iterations; i++)
        limits += count_all_limits(check_overlaps, "overlaps", iterations[i]);
    assert_true(limits > 0);
}

/* ------------------------------------------------------------------------------------------------ warm starts */

static uint32_t *create_simplexes(size_t count) {
    uint32_t *const simplexes = calloc(count, sizeof *simplexes);
    assert_non_null(simplexes);
    return simplexes;
}

/* Overlaps and contacts from these simplexes, and from what those calls leave of them. */
static size_t check_warm_starts(const struct corpus *corpus, uint32_t *simplexes, const char *what) {
    const size_t count = corpus->scene.pair_count, size = count * sizeof *simplexes;
    AUTO(free_at) uint8_t *outcomes = make_junk(count);
    AUTO(free_at) uint32_t *of_overlaps = memcpy(create_simplexes(count), simplexes, size);
    narc_method_options options = {.method = NARC_METHOD_GJK, .out_outcomes = outcomes, .simplexes = of_overlaps};
    size_t wrong = 0;
    for (int again = 0; again < 2; again++) { /* the second time with what the first one left */
        const struct counts counts = check_overlaps(corpus, &options, what);
        wrong += counts.wrong;
        /* Rounding may leave a search from a useless simplex no way on; hardly ever. */
        assert_true(counts.outcomes[NARC_OUTCOME_ROUNDING] <= count / 1000);
    }
    options.simplexes = simplexes;
    for (int again = 0; again < 2; again++) {
        const struct counts counts = check_contacts(corpus, &options, what);
        print_counts(what, &counts);
        wrong += counts.wrong;
    }
    return wrong;
}

static size_t count_limits(const struct corpus *corpus, unsigned iterations, uint32_t *simplexes) {
    const size_t count = corpus->scene.pair_count;
    AUTO(free_at) uint8_t *outcomes = make_junk(count);
    size_t limits = 0;
    const narc_method_options options = {
        .method = NARC_METHOD_GJK, .iterations = iterations, .out_outcomes = outcomes, .simplexes = simplexes};
    free(query_overlaps(&corpus->scene, &options, NULL));
    for (size_t k = 0; k < count; k++)
        limits += outcomes[k] == NARC_OUTCOME_LIMIT;
    return limits;
}

/* What warm starts are for: where nothing has moved, of the pairs for which some steps are too few, most need no more of
 * them. */
TEST(test_warm_start) {
    for (int c = 0; c < CORPORA; c++) {
        AUTO(free_at) uint32_t *simplexes = create_simplexes(corpora[c].scene.pair_count);
        const size_t cold = count_limits(&corpora[c], 3, NULL);
        assert_int_equal(count_limits(&corpora[c], 0, simplexes), 0);
        const size_t warm = count_limits(&corpora[c], 3, simplexes);
        printf("  three steps are too few for %zu pairs, of a warm start for %zu\n", cold, warm);
        assert_true(warm < cold / 2 || cold < 100); /* of fewer pairs it is chance */
    }
}

/* Simplexes of a scene in motion. */
TEST(test_frames) {
    struct test_random random = test_random_named("gjk frames");
    struct corpus corpus = make_corpus("gjk frames", NARC_FLOAT64, 0.3, false);
    solve_corpus(&corpus);
    const size_t count = corpus.scene.pair_count;
    AUTO(free_at) uint32_t *simplexes = create_simplexes(count);
    size_t wrong = check_warm_starts(&corpus, simplexes, "zeros, then own");
    for (size_t k = 0; k < count; k++)
        assert_true(simplexes[k] != 0);
    static const double steps[] = {1e-6, 0.01, 0.1, 3};
    for (size_t s = 0; s < sizeof steps / sizeof *steps; s++) {
        scene_move_bodies(&corpus.scene, &random, steps[s]);
        solve_corpus(&corpus);
        wrong += check_warm_starts(&corpus, simplexes, "after a step");
    }
    destroy_corpus(&corpus);
    assert_int_equal(wrong, 0);
}

TEST(test_any_simplexes) {
    struct test_random random = test_random_named("gjk garbage");
    size_t wrong = 0;
    for (int c = 0; c < CORPORA; c++) {
        const size_t count = corpora[c].scene.pair_count;
        AUTO(free_at) uint32_t *simplexes = create_simplexes(count);
        for (int kind = 0; kind < 6; kind++) {
            static const char *const names[] = {"random bits", "all ones",       "single bits",
                                                "random axes", "random triples", "three times the same"};
            for (size_t k = 0; k < count; k++) {
                const uint32_t bits = (uint32_t)random_bits(&random), ten = bits >> 2 & 1023;
                const uint32_t values[] = {bits,
                                           UINT32_MAX,
                                           0x80000000u >> k % 32,
                                           (bits & ~3u) | 1,
                                           bits | 3,
                                           (ten | ten << 10 | ten << 20) << 2 | 3};
                simplexes[k] = values[kind];
            }
            wrong += check_warm_starts(&corpora[c], simplexes, names[kind]);
        }
    }
    assert_int_equal(wrong, 0);
}

/* What is left behind is the same on every instruction set and with any number of threads, between forbidden pages. Pairs
 * that are not asked of, and a call that is refused, leave what is there; so does another method. */
TEST(test_simplexes_of_a_batch) {
    struct test_random random = test_random_named("gjk simplexes");
    const struct scene *const scene = &corpora[0].scene;
    const size_t count = scene->pair_count, first = count < 64 ? 0 : 64, size = count * sizeof(uint32_t);
    const narc_workers three = openmp_workers(3);
    AUTO(free_at) uint32_t *const right = create_simplexes(count);
    AUTO(free_at) uint32_t *const start = create_simplexes(count);
    AUTO(free_at) uint32_t *selection = make_junk(size);
    for (uint32_t k = 0; k < count; k++) {
        start[k] = random_below(&random, 4) ? (uint32_t)random_bits(&random) : 0;
        selection[k] = (uint32_t)count - 1 - k;
    }
    for (int contacts = 0; contacts < 2; contacts++) {
        narc_method_options options = {.method = NARC_METHOD_GJK, .simplexes = memcpy(right, start, size)};
        const narc_query whole = {.margin = 0.25f, .workers = &three},
                         part = {.margin = 0.25f, .first = first, .count = count - first},
                         chosen = {.margin = 0.25f, .selection = {selection, 4}, .selection_count = count - first};
        const narc_query *const queries[] = {&whole, &part, &chosen};
        test_use_isa("scalar");
        if (contacts)
            free(query_contacts(scene, &options, &(narc_query){.margin = 0.25f}).rows);
        else
            free(query_overlaps(scene, &options, NULL));
        test_use_isa(test_isa());
        for (int q = 0; q < 3; q++) {
            AUTO(guard_release_at) uint32_t *const found = options.simplexes = guard_copy(start, size);
            if (contacts)
                free(query_contacts(scene, &options, queries[q]).rows);
            else
                free(query_overlaps(scene, &options, queries[q]));
            for (size_t k = 0; k < count; k++)
                assert_int_equal(found[k], q == 0 || k >= first ? right[k] : start[k]);
        }
        options.simplexes = memcpy(right, start, size);
        options.method = NARC_METHOD_SAT;
        free(query_overlaps(scene, &options, NULL));
        options.method = NARC_METHOD_SAT_FIRST;
        free(query_contacts(scene, &options, &whole).rows);
        assert_memory_equal(right, start, size);
    }
    AUTO(narc_destroy_methods_at) narc_methods *const methods = create_methods(scene->store);
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    const narc_method_options options = {.method = NARC_METHOD_GJK, .simplexes = right};
    size_t found;
    assert_int_equal(
        narc_find_contacts_by(methods, &bodies, &pairs, &options, &(narc_query){.margin = NAN}, NULL, 0, &found, NULL),
        NARC_ERROR_NOT_FINITE);
    assert_memory_equal(right, start, size);
}

int main(void) { return test_begin() ? test_run("methods_gjk", make_corpora, destroy_corpora) : TEST_SKIPPED; }
