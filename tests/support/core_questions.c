/* SPDX-License-Identifier: MIT
 *
 * core_questions.c - the questions of narc.h.
 */
#include "questions.h"

static narc_status ask_overlaps_of(const struct question *question, const struct asked *of, narc_error *error) {
    (void)question;
    return narc_find_overlaps(of->shapes, of->bodies, of->pairs, of->query, of->rows, error);
}

static narc_status ask_contacts_of(const struct question *question, const struct asked *of, narc_error *error) {
    (void)question;
    return narc_find_contacts(of->shapes, of->bodies, of->pairs, of->query, of->rows, of->capacity, of->out_count,
                              error);
}

static narc_status ask_manifolds_of(const struct question *question, const struct asked *of, narc_error *error) {
    (void)question;
    return narc_find_manifolds(of->shapes, of->bodies, of->pairs, of->query, of->rows, of->capacity, of->out_count,
                               error);
}

const struct question questions[] = {
    {"overlaps", ask_overlaps_of, 0, NULL, false, true},
    {"contacts", ask_contacts_of, sizeof(narc_contact), NULL, false, true},
    {"manifolds", ask_manifolds_of, sizeof(narc_manifold), NULL, false, true},
};
const size_t question_count = sizeof questions / sizeof *questions;

const char *const shapes_name = "shapes";
const void *take_shapes(const narc_shapes *store, const narc_allocator *allocator) {
    (void)allocator;
    return store;
}
void release_shapes(const void *shapes) { (void)shapes; }
