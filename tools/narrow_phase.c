/* SPDX-License-Identifier: MIT
 *
 * narrow_phase.c - pairs of bodies put to the library by a method, timed, and compared with the exact answer.
 */
#include "narrow_phase.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fail.h"
#include "progress.h"
#include "text.h"

/* One batch call is repeated until this much time has been measured, or this often. */
static const double MEASURED_SECONDS = 0.2;
enum { MOST_RUNS = 9 };

/* A batch call with more pairs may take a second on one thread without vector instructions. */
enum { MANY_PAIRS = 4000000 };

/* What every call gets. */
typedef struct batch {
    const narrow_settings *chosen;
    const narc_shapes *store;
    narc_methods *methods;
    narc_bodies bodies;
    narc_pairs pairs;
    narc_method_query query;
} batch;

narc_method find_method(const char *name) {
    char names[256] = "";
    for (int i = 0; narc_method_name((narc_method)i); i++) {
        const char *known = narc_method_name((narc_method)i);
        if (strcmp(known, name) == 0)
            return (narc_method)i;
        const size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", i ? ", " : "", known);
    }
    fail("--method must be one of %s, not '%s'", names, narc_make_excerpt(name).text);
}

bool is_filter(narc_method method) {
    return method == NARC_METHOD_CIRCLE || method == NARC_METHOD_AABB || method == NARC_METHOD_OBB;
}

static void check(narc_status status, const narc_error *error) {
    if (status != NARC_OK)
        fail("%s", error->message);
}

static void allocate_contacts(narc_contacts *contacts, size_t capacity) {
    *contacts = (narc_contacts){.capacity = capacity,
                                .pair = allocate(capacity, sizeof(uint32_t)),
                                .separation = allocate(capacity, sizeof(float)),
                                .normal_x = allocate(capacity, sizeof(float)),
                                .normal_y = allocate(capacity, sizeof(float)),
                                .point_x = allocate(capacity, sizeof(float)),
                                .point_y = allocate(capacity, sizeof(float)),
                                .arc_a = allocate(capacity, 1),
                                .arc_b = allocate(capacity, 1)};
}

void free_narrow_result(narrow_result *result) {
    free(result->contacts.pair);
    free(result->contacts.separation);
    free(result->contacts.normal_x);
    free(result->contacts.normal_y);
    free(result->contacts.point_x);
    free(result->contacts.point_y);
    free(result->contacts.arc_a);
    free(result->contacts.arc_b);
    free(result->colliding);
}

/* The call that is timed. */
static void call_library(const batch *asked, narrow_result *result) {
    const float margin = asked->chosen->margin;
    const unsigned threads = asked->chosen->threads;
    narc_status status;
    narc_error error;
    const double start = seconds_now();
    if (is_filter(asked->query.method)) {
        result->call = "narc_find_overlaps_by";
        status = narc_find_overlaps_by(asked->methods, &asked->bodies, &asked->pairs, &asked->query, threads,
                                       result->colliding, &error);
    } else {
        result->call = "narc_find_contacts_by";
        status = narc_find_contacts_by(asked->methods, &asked->bodies, &asked->pairs, &asked->query, margin, threads,
                                       &result->contacts, &result->contact_count, &error);
    }
    result->seconds = seconds_now() - start;
    check(status, &error);
}

static int compare_numbers(const void *left, const void *right) {
    const double *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

static void measure_call(const batch *asked, narrow_result *result) {
    double seconds[MOST_RUNS], total = 0;
    while (result->runs < MOST_RUNS && total < MEASURED_SECONDS) {
        call_library(asked, result);
        total += result->seconds;
        seconds[result->runs++] = result->seconds;
    }
    qsort(seconds, (size_t)result->runs, sizeof *seconds, compare_numbers);
    result->seconds = seconds[result->runs / 2];
}

/* Which pairs collide, as the method finds it. With a margin below 0 they are not all among the contacts. */
static void find_colliding(const batch *asked, narrow_result *result) {
    const float margin = asked->chosen->margin;
    if (is_filter(asked->query.method))
        return;
    if (margin < 0) {
        narc_method_query again = asked->query;
        again.out_outcomes = NULL;
        again.out_skipped = NULL;
        narc_error error;
        check(narc_find_overlaps_by(asked->methods, &asked->bodies, &asked->pairs, &again, asked->chosen->threads,
                                    result->colliding, &error),
              &error);
        return;
    }
    memset(result->colliding, 0, NARC_BIT_WORDS(asked->pairs.count) * sizeof *result->colliding);
    for (size_t k = 0; k < result->contact_count; k++) {
        if (result->contacts.separation[k] < 0) {
            const uint32_t of = result->contacts.pair[k];
            result->colliding[of / 64] |= (uint64_t)1 << of % 64;
        }
    }
}

static bool bit_at(const uint64_t *bits, size_t index) { return bits[index / 64] >> index % 64 & 1; }

bool pair_collides(const narrow_result *result, size_t index) { return bit_at(result->colliding, index); }

static void count_colliding(const batch *asked, narrow_result *result) {
    for (size_t k = 0; k < asked->pairs.count; k++)
        result->colliding_count += bit_at(result->colliding, k);
}

/* Counts the pairs of which the exact method says otherwise. */
static void compare_with_exact(const batch *asked, narrow_result *result) {
    const size_t count = asked->pairs.count;
    uint64_t *exact = allocate(NARC_BIT_WORDS(count), sizeof *exact);
    narc_error error;
    check(narc_find_overlaps(asked->store, &asked->bodies, &asked->pairs, asked->chosen->threads, exact, &error),
          &error);
    for (size_t k = 0; k < count; k++) {
        const bool is_told = bit_at(result->colliding, k), is_true = bit_at(exact, k);
        result->missed += is_true && !is_told;
        result->extra += is_told && !is_true;
    }
    free(exact);
}

void run_narrow_phase(const narrow_settings *chosen, const narc_shapes *shapes, const body_list *bodies,
                      const pair_list *pairs, narrow_result *out_result) {
    const size_t count = pairs->count;
    uint8_t *outcomes = allocate(count, sizeof *outcomes);
    narc_error error;
    batch asked = {.chosen = chosen,
                   .store = shapes,
                   .bodies = view_bodies(bodies),
                   .pairs = view_pairs(pairs),
                   .query = {.method = chosen->method,
                             .tolerance = chosen->tolerance,
                             .iterations = chosen->iterations,
                             .out_outcomes = chosen->method == NARC_METHOD_SAT ? NULL : outcomes,
                             .out_skipped = &out_result->skipped}};
    check(narc_create_methods(shapes, NULL, &asked.methods, &error), &error);
    *out_result = (narrow_result){.colliding = allocate(NARC_BIT_WORDS(count), sizeof *out_result->colliding)};
    if (!is_filter(chosen->method))
        allocate_contacts(&out_result->contacts, count);
    show_stage("narrow phase", count, "pairs", count > MANY_PAIRS);
    measure_call(&asked, out_result);
    find_colliding(&asked, out_result);
    count_colliding(&asked, out_result);
    if (chosen->method != NARC_METHOD_SAT) {
        compare_with_exact(&asked, out_result);
        for (size_t k = 0; k < count; k++)
            out_result->outcomes[outcomes[k]]++;
    }
    narc_destroy_methods(asked.methods);
    free(outcomes);
}
