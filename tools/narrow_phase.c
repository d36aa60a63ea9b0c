/* SPDX-License-Identifier: MIT
 *
 * narrow_phase.c - pairs of bodies put to the library by a method, timed, and compared with the exact answer.
 */
#include "narrow_phase.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "calls.h"
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
    const narc_shapes *store;
    narc_methods *methods; /* NULL: the exact method, which needs none */
    narc_bodies bodies;
    narc_pairs pairs;
    narc_method_options options;
    narc_query query;
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

void free_narrow_result(narrow_result *result) {
    free(result->contacts);
    free(result->colliding);
}

static narc_status find_overlaps(const batch *asked, uint64_t *bits, narc_error *error) {
    return asked->methods ? narc_find_overlaps_by(asked->methods, &asked->bodies, &asked->pairs, &asked->options,
                                                  &asked->query, bits, error)
                          : narc_find_overlaps(asked->store, &asked->bodies, &asked->pairs, &asked->query, bits, error);
}

static narc_status find_contacts(const batch *asked, narrow_result *result, narc_error *error) {
    const size_t room = result->room;
    return asked->methods ? narc_find_contacts_by(asked->methods, &asked->bodies, &asked->pairs, &asked->options,
                                                  &asked->query, result->contacts, room, &result->contact_count, error)
                          : narc_find_contacts(asked->store, &asked->bodies, &asked->pairs, &asked->query,
                                               result->contacts, room, &result->contact_count, error);
}

/* The call that is timed. Pairs with a concave arc of a chain may have several contacts: it is made again with more room
 * then. */
static void call_library(const batch *asked, narrow_result *result) {
    narc_error error;
    const double start = seconds_now();
    const narc_status status = is_filter(asked->options.method) ? find_overlaps(asked, result->colliding, &error)
                                                                : find_contacts(asked, result, &error);
    result->seconds = seconds_now() - start;
    if (status == NARC_ERROR_CAPACITY) {
        result->room = result->contact_count;
        free(result->contacts);
        result->contacts = allocate(result->room, sizeof *result->contacts);
        call_library(asked, result);
        return;
    }
    check_call(status, &error);
}

static void measure_call(const batch *asked, narrow_result *result) {
    double seconds[MOST_RUNS], total = 0;
    while (result->runs < MOST_RUNS && total < MEASURED_SECONDS) {
        call_library(asked, result);
        total += result->seconds;
        seconds[result->runs++] = result->seconds;
    }
    result->seconds = find_median(seconds, (size_t)result->runs);
}

/* Which pairs collide, as the method finds it. With a margin below 0 they are not all among the contacts. */
static void find_colliding(const batch *asked, narrow_result *result) {
    if (is_filter(asked->options.method))
        return;
    if (asked->query.margin < 0) {
        batch again = *asked;
        again.options.out_outcomes = NULL;
        again.query.out_skipped = NULL;
        narc_error error;
        check_call(find_overlaps(&again, result->colliding, &error), &error);
        return;
    }
    memset(result->colliding, 0, NARC_BIT_WORDS(asked->pairs.count) * sizeof *result->colliding);
    for (size_t k = 0; k < result->contact_count; k++) {
        const narc_contact *contact = &result->contacts[k];
        if (contact->separation < 0)
            result->colliding[contact->pair / 64] |= (uint64_t)1 << contact->pair % 64;
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
    const narc_query query = {.workers = asked->query.workers};
    narc_error error;
    check_call(narc_find_overlaps(asked->store, &asked->bodies, &asked->pairs, &query, exact, &error), &error);
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
    const bool is_exact = chosen->method == NARC_METHOD_SAT;
    *out_result = (narrow_result){.call = is_filter(chosen->method) ? "narc_find_overlaps_by"
                                          : is_exact                ? "narc_find_contacts"
                                                                    : "narc_find_contacts_by",
                                  .room = count,
                                  .contacts = allocate(count, sizeof *out_result->contacts),
                                  .colliding = allocate(NARC_BIT_WORDS(count), sizeof *out_result->colliding)};
    uint8_t *outcomes = allocate(count, sizeof *outcomes);
    batch asked = {
        .store = shapes,
        .bodies = view_bodies(bodies),
        .pairs = view_pairs(pairs),
        .options = {.method = chosen->method,
                    .tolerance = chosen->tolerance,
                    .iterations = chosen->iterations,
                    .out_outcomes = outcomes},
        .query = {.margin = chosen->margin, .workers = &chosen->workers, .out_skipped = &out_result->skipped}};
    narc_error error;
    if (!is_exact)
        check_call(narc_create_methods(shapes, NULL, &asked.methods, &error), &error);
    show_stage("narrow phase", count, "pairs", count > MANY_PAIRS);
    measure_call(&asked, out_result);
    find_colliding(&asked, out_result);
    count_colliding(&asked, out_result);
    if (!is_exact) {
        compare_with_exact(&asked, out_result);
        for (size_t k = 0; k < count; k++)
            out_result->outcomes[outcomes[k]]++;
    }
    narc_destroy_methods(asked.methods);
    free(outcomes);
}
