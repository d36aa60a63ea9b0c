/* SPDX-License-Identifier: MIT
 *
 * contacts.c - overlaps, separations, contacts and manifolds of bodies from arbitrary bytes: the same bits on every instruction set,
 * the same answers from all three, and those of the reference where the bodies are sound.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "fuzz.h"
#include "narc.h"

enum { BODIES = 6, PAIRS = 24 };

struct question {
    struct scene scene;
    narc_query query;
    size_t chosen;  /* for the reference, which takes long */
    bool has_plane; /* tests/kernels/half_planes.c has its reference */
};

struct answer {
    uint64_t bits;
    size_t contact_count, manifold_count, skipped;
    narc_contact contacts[PAIRS], far[PAIRS];
    narc_manifold manifolds[PAIRS];
    float separations[PAIRS];
};

static void ask(const void *question, const narc_workers *workers, void *out_answer) {
    const struct question *const q = question;
    struct answer *const answer = out_answer;
    const narc_bodies bodies = scene_bodies(&q->scene);
    const narc_pairs pairs = scene_pairs(&q->scene);
    const narc_shapes *const store = q->scene.store;
    narc_query query = q->query, all = {.margin = INFINITY, .dense = 1, .workers = workers};
    size_t count;
    query.workers = workers;
    query.out_skipped = &answer->skipped;
    memset(answer, 0, sizeof *answer);
    assert_int_equal(narc_find_overlaps(store, &bodies, &pairs, &all, &answer->bits, NULL), NARC_OK);
    assert_int_equal(narc_find_contacts(store, &bodies, &pairs, &all, answer->far, PAIRS, &count, NULL), NARC_OK);
    assert_int_equal(
        narc_find_contacts(store, &bodies, &pairs, &query, answer->contacts, PAIRS, &answer->contact_count, NULL),
        NARC_OK);
    assert_int_equal(
        narc_find_manifolds(store, &bodies, &pairs, &query, answer->manifolds, PAIRS, &answer->manifold_count, NULL),
        NARC_OK);
    query.out_skipped = NULL;
    assert_int_equal(narc_find_separations(store, &bodies, &pairs, &query, answer->separations, NULL), NARC_OK);
    /* Behind the last row there may be anything. */
    memset(answer->contacts + answer->contact_count, 0, (PAIRS - answer->contact_count) * sizeof *answer->contacts);
    memset(answer->manifolds + answer->manifold_count, 0, (PAIRS - answer->manifold_count) * sizeof *answer->manifolds);
}

/* Makes body 0 a half-plane, which is in no pair with itself. */
static void make_ground(struct question *q) {
    uint32_t plane;
    if (narc_add_half_plane(q->scene.store, &plane, NULL) != NARC_OK)
        return;
    q->scene.bodies[0].shape = plane;
    for (size_t k = 0; k < PAIRS; k++)
        if (q->scene.pairs[k].a == 0 && q->scene.pairs[k].b == 0)
            q->scene.pairs[k].b = 1;
    q->has_plane = true;
}

/* A pair that has an answer. */
static void check_pair(const struct question *q, const struct answer *answer, size_t k) {
    const narc_contact *const contact = &answer->far[k];
    const struct reference_body a = scene_reference(&q->scene, q->scene.pairs[k].a);
    const struct reference_body b = scene_reference(&q->scene, q->scene.pairs[k].b);
    struct fractions worst = {0};
    const char *const wrong = check_contact(&a, &b, reference_find_gap(&a, &b).gap, contact, &worst);
    if (wrong) {
        print_pair(&a, &b);
        fail_msg("wrong %s", wrong);
    }
}

static void check(const struct question *q, const struct answer *answer) {
    size_t listed = 0, skipped = 0;
    for (size_t k = 0; k < PAIRS; k++) {
        const narc_contact *const contact = &answer->far[k];
        assert_true(contact->pair == k && !isnan(contact->separation));
        assert_true((answer->bits >> k & 1) == (contact->separation < 0));
        skipped += contact->count == 0;
        if (contact->count != 0 && k == q->chosen &&
            !(q->has_plane && (q->scene.pairs[k].a == 0 || q->scene.pairs[k].b == 0)))
            check_pair(q, answer, k);
        const float told = contact->separation < q->query.margin ? contact->separation : INFINITY;
        assert_memory_equal(&answer->separations[k], &told, sizeof told);
        if (contact->separation < q->query.margin) {
            assert_memory_equal(&answer->contacts[listed], contact, sizeof *contact);
            const narc_manifold *const manifold = &answer->manifolds[listed++];
            assert_true(manifold->pair == k && (manifold->count == 1 || manifold->count == 2));
            assert_true(manifold->normal_x == contact->normal_x && manifold->normal_y == contact->normal_y);
            assert_true(manifold->point[0].separation == contact->separation ||
                        manifold->point[1].separation == contact->separation);
        }
    }
    assert_int_equal(answer->contact_count, listed);
    assert_int_equal(answer->manifold_count, listed);
    assert_int_equal(answer->skipped, skipped);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct bytes from = {data, size};
    struct question q = {.chosen = take_below(&from, PAIRS)};
    q.scene = take_scene(&from, 3, BODIES, PAIRS);
    const double margin = take_number(&from, 1), second = take_number(&from, 1), flat = take_number(&from, 1.5);
    q.query.margin = fabs(margin) < 10 ? (float)margin : 0;
    q.query.second_margin = fabs(second) < 10 ? (float)second : 0;
    q.query.flat_angle = fabs(flat) < 1.5 ? (float)flat : 0;
    take_flights(&from, &q.scene);
    if (take_below(&from, 4) == 1)
        make_ground(&q);
    AUTO(free_at) struct answer *const answer = ask_everywhere(ask, &q, sizeof *answer, NULL);
    check(&q, answer);
    destroy_scene(&q.scene);
    return 0;
}
