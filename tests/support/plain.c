/* SPDX-License-Identifier: MIT
 *
 * plain.c - compares a batch's answers with those of the deciding formula.
 */
#include "plain.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "plain_kernels.h"

/* The same list from contact k on. */
static narc_contacts offset_contacts(const narc_contacts *list, size_t k) {
    return (narc_contacts){list->capacity - k, list->pair + k,     list->separation + k,
                           list->normal_x + k, list->normal_y + k, list->point_x + k,
                           list->point_y + k,  list->arc_a + k,    list->arc_b + k};
}

struct contacts find_plain_contacts(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs) {
    const narc_batch batch = {.shapes = shapes, .bodies = bodies, .pairs = pairs};
    const size_t count = pairs->count;
    struct contacts plain = create_contacts(count);
    for (size_t k = 0; k < count; k += NARC_CONTACT_GROUP) {
        const size_t group = count - k < NARC_CONTACT_GROUP ? count - k : NARC_CONTACT_GROUP;
        const narc_contacts out = offset_contacts(&plain.view, k);
        assert_int_equal(narc_kernels_plain.contact(&batch, k, group, INFINITY, &out), group);
    }
    plain.count = count;
    uint64_t *bits = malloc(NARC_BIT_WORDS(count) * sizeof *bits + 1);
    assert_non_null(bits);
    narc_kernels_plain.overlap(&batch, 0, count, bits);
    for (size_t k = 0; k < count; k++) {
        assert_int_equal(plain.view.pair[k], k);
        assert_int_equal(bit_is_set(bits, k), plain.view.separation[k] < 0);
    }
    free(bits);
    return plain;
}

static void fail_at(const struct plain_batch *batch, size_t pair, const char *what) {
    const struct pair indices = batch->scene->pairs[pair];
    const struct reference_body a = scene_reference(batch->scene, indices.a);
    const struct reference_body b = scene_reference(batch->scene, indices.b);
    const narc_contacts *right = batch->right;
    print_pair(&a, &b);
    fail_msg("%s: pair %zu (bodies %u and %u): %s; right are separation %a, normal (%a, %a), point (%a, %a), arcs %u "
             "and %u; the exact separation is %.17g",
             batch->name, pair, indices.a, indices.b, what, (double)right->separation[pair],
             (double)right->normal_x[pair], (double)right->normal_y[pair], (double)right->point_x[pair],
             (double)right->point_y[pair], right->arc_a[pair], right->arc_b[pair], reference_find_gap(&a, &b).gap);
}

void check_plain_overlaps(const struct plain_batch *batch, unsigned threads) {
    const size_t count = batch->pairs->count, words = NARC_BIT_WORDS(count);
    uint64_t *bits = malloc(words * sizeof *bits + 1);
    narc_error error;
    assert_non_null(bits);
    memset(bits, 0xa5, words * sizeof *bits);
    if (narc_find_overlaps(batch->shapes, batch->bodies, batch->pairs, threads, bits, &error) != NARC_OK)
        fail_msg("%s: narc_find_overlaps: %s", batch->name, error.message);
    for (size_t k = 0; k < count; k++)
        if (bit_is_set(bits, k) != (batch->right->separation[k] < 0))
            fail_at(batch, k, bit_is_set(bits, k) ? "collides by its bit" : "does not collide by its bit");
    free(bits);
}

/* What differs between a contact and another, NULL if nothing does. Zeros of either sign are not the same. */
static const char *find_difference(const narc_contacts *a, size_t i, const narc_contacts *b, size_t j) {
    if (memcmp(&a->separation[i], &b->separation[j], sizeof(float)) != 0)
        return "separation";
    if (memcmp(&a->normal_x[i], &b->normal_x[j], sizeof(float)) != 0 ||
        memcmp(&a->normal_y[i], &b->normal_y[j], sizeof(float)) != 0)
        return "normal";
    if (memcmp(&a->point_x[i], &b->point_x[j], sizeof(float)) != 0 ||
        memcmp(&a->point_y[i], &b->point_y[j], sizeof(float)) != 0)
        return "point";
    return a->arc_a[i] != b->arc_a[j] || a->arc_b[i] != b->arc_b[j] ? "arcs" : NULL;
}

static void fail_contact(const struct plain_batch *batch, size_t pair, const narc_contacts *found, size_t at,
                         const char *difference, float margin) {
    char what[256];
    snprintf(what, sizeof what, "margin %a: %s differs: separation %a, normal (%a, %a), point (%a, %a), arcs %u and %u",
             (double)margin, difference, (double)found->separation[at], (double)found->normal_x[at],
             (double)found->normal_y[at], (double)found->point_x[at], (double)found->point_y[at], found->arc_a[at],
             found->arc_b[at]);
    fail_at(batch, pair, what);
}

void check_plain_contacts(const struct plain_batch *batch, float margin, unsigned threads, uint32_t *hints) {
    const narc_contacts *right = batch->right;
    const size_t count = batch->pairs->count;
    struct contacts found = create_contacts(count);
    narc_error error;
    const narc_status status = hints ? narc_find_contacts_hinted(batch->shapes, batch->bodies, batch->pairs, margin,
                                                                 threads, hints, &found.view, &found.count, &error)
                                     : narc_find_contacts(batch->shapes, batch->bodies, batch->pairs, margin, threads,
                                                          &found.view, &found.count, &error);
    if (status != NARC_OK)
        fail_msg("%s: narc_find_contacts: %s", batch->name, error.message);
    size_t at = 0;
    for (size_t k = 0; k < count; k++) {
        const bool wanted = margin == INFINITY || right->separation[k] < margin;
        const bool there = at < found.count && found.view.pair[at] == k;
        if (wanted != there)
            fail_at(batch, k, there ? "reported" : "not reported");
        if (there) {
            const char *difference = find_difference(&found.view, at, right, k);
            if (difference)
                fail_contact(batch, k, &found.view, at, difference, margin);
            at++;
        }
    }
    assert_int_equal(at, found.count);
    destroy_contacts(&found);
}
