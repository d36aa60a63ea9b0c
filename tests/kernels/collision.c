/* SPDX-License-Identifier: MIT
 *
 * collision.c - every family of shapes against every other, in every placement, compared with the reference.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "placements.h"

/* How many wrong pairs are shown in full. */
enum { SHOWN = 5 };

/* Errors add up at random, so they stay far below the bound, which adds their largest values: 0.13 is the most seen, of
 * separations in 20 million pairs. Above this, a kernel has become worse, though not wrong. */
static const double expected_part = 0.2;

struct report {
    struct contact_summary family[FAMILY_COUNT], placement[PLACE_COUNT];
    size_t wrong;
};

static void print_tally(const char *name, const struct contact_summary *tally) {
    printf("  %-11s %8zu %9zu %7zu %12.3f %7.3f %7.3f\n", name, tally->pairs, tally->colliding, tally->inside_band,
           tally->worst.separation, tally->worst.normal, tally->worst.point);
}

static void print_report(const struct report *report) {
    printf("  %-11s %8s %9s %7s %12s %7s %7s   (largest errors, as fractions of the bound)\n", "", "pairs", "colliding",
           "in band", "separation", "normal", "point");
    for (int k = 0; k < FAMILY_COUNT; k++)
        print_tally(family_name((enum family)k), &report->family[k]);
    for (int k = 0; k < PLACE_COUNT; k++)
        print_tally(placement_name((enum placement)k), &report->placement[k]);
}

/* The batch's answers for one scene, of which pair k was placed by placement k % PLACE_COUNT. */
static void check_scene(const struct scene *scene, enum family family_a, enum family family_b, struct report *report) {
    uint64_t *bits = scene_overlaps(scene);
    struct contacts all = scene_contacts(scene, INFINITY);
    assert_int_equal(all.count, scene->pair_count);
    for (size_t k = 0; k < scene->pair_count; k++) {
        struct reference_body a = scene_reference(scene, scene->pairs[k].a),
                              b = scene_reference(scene, scene->pairs[k].b);
        const double gap = reference_find_gap(&a, &b).gap, bound = separation_bound(&a, &b);
        const bool overlap = bit_is_set(bits, k);
        struct fractions errors = {0};
        const char *const wrong = check_answer(&a, &b, gap, k, overlap, &all.rows[k], &errors);
        const enum placement placement = (enum placement)(k % PLACE_COUNT);
        count_pair(&report->family[family_a], gap, bound, &errors);
        count_pair(&report->family[family_b], gap, bound, &errors);
        count_pair(&report->placement[placement], gap, bound, &errors);
        if (wrong && report->wrong++ < SHOWN) {
            print_error("%s - %s, %s: wrong %s\n", family_name(family_a), family_name(family_b),
                        placement_name(placement), wrong);
            print_answer(&a, &b, gap, overlap, &all.rows[k]);
        }
    }
    free(all.rows);
    free(bits);
}

static void check_all_families(const char *name, narc_precision precision, size_t rounds) {
    struct test_random random = test_random_named(name);
    struct report report = {0};
    size_t pairs = PLACE_COUNT * test_trials(rounds);
    for (int family_a = 0; family_a < FAMILY_COUNT; family_a++) {
        for (int family_b = 0; family_b < FAMILY_COUNT; family_b++) {
            struct scene scene =
                make_placed_scene(&random, precision, (enum family)family_a, (enum family)family_b, pairs);
            check_scene(&scene, (enum family)family_a, (enum family)family_b, &report);
            destroy_scene(&scene);
        }
    }
    print_report(&report);
    if (report.wrong)
        fail_msg("%zu wrong answers", report.wrong);
    for (int k = 0; k < FAMILY_COUNT; k++) {
        assert_true(report.family[k].worst.separation < expected_part);
        assert_true(report.family[k].worst.normal < expected_part);
        assert_true(report.family[k].worst.point < expected_part);
    }
}

TEST(test_single_positions) { check_all_families("collision, single positions", NARC_FLOAT32, 4); }

TEST(test_double_positions) { check_all_families("collision, double positions", NARC_FLOAT64, 2); }

TEST_MAIN("collision")
