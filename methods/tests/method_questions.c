/* SPDX-License-Identifier: MIT
 *
 * method_questions.c - the questions of narc_methods.h: each method with its settings, overlaps and contacts.
 */
#include "narc_methods.h"
#include "questions.h"

static narc_method_options options_of(const struct question *question, const struct asked *of) {
    narc_method_options options = *(const narc_method_options *)question->options;
    options.out_outcomes = of->outcomes;
    return options;
}

static narc_status ask_overlaps_by(const struct question *question, const struct asked *of, narc_error *error) {
    const narc_method_options options = options_of(question, of);
    return narc_find_overlaps_by(of->shapes, of->bodies, of->pairs, &options, of->query, of->rows, error);
}

static narc_status ask_contacts_by(const struct question *question, const struct asked *of, narc_error *error) {
    const narc_method_options options = options_of(question, of);
    return narc_find_contacts_by(of->shapes, of->bodies, of->pairs, &options, of->query, of->rows, of->capacity,
                                 of->out_count, error);
}

static const narc_method_options sat = {.method = NARC_METHOD_SAT}, first = {.method = NARC_METHOD_SAT_FIRST},
                                 polygon = {.method = NARC_METHOD_POLYGON_SAT}, gjk = {.method = NARC_METHOD_GJK},
                                 fine = {.method = NARC_METHOD_GJK, .tolerance = 1e-6f},
                                 coarse = {.method = NARC_METHOD_GJK, .tolerance = 1e-2f, .iterations = 3},
                                 circle = {.method = NARC_METHOD_CIRCLE}, aabb = {.method = NARC_METHOD_AABB},
                                 obb = {.method = NARC_METHOD_OBB};

const struct question questions[] = {
    {"overlaps by sat", ask_overlaps_by, 0, &sat, false, false},
    {"contacts by sat", ask_contacts_by, sizeof(narc_contact), &sat, false, false},
    {"overlaps by sat-first", ask_overlaps_by, 0, &first, false, false},
    {"contacts by sat-first", ask_contacts_by, sizeof(narc_contact), &first, false, false},
    {"overlaps by polygon-sat", ask_overlaps_by, 0, &polygon, true, false},
    {"contacts by polygon-sat", ask_contacts_by, sizeof(narc_contact), &polygon, true, false},
    {"overlaps by gjk", ask_overlaps_by, 0, &gjk, false, false},
    {"contacts by gjk", ask_contacts_by, sizeof(narc_contact), &gjk, false, false},
    {"overlaps by fine gjk", ask_overlaps_by, 0, &fine, false, false},
    {"contacts by fine gjk", ask_contacts_by, sizeof(narc_contact), &fine, false, false},
    {"overlaps by coarse gjk", ask_overlaps_by, 0, &coarse, false, false},
    {"contacts by coarse gjk", ask_contacts_by, sizeof(narc_contact), &coarse, false, false},
    {"circles", ask_overlaps_by, 0, &circle, false, false},
    {"aligned boxes", ask_overlaps_by, 0, &aabb, false, false},
    {"oriented boxes", ask_overlaps_by, 0, &obb, false, false},
};
const size_t question_count = sizeof questions / sizeof *questions;

const char *const shapes_name = "methods";
const void *take_shapes(const narc_shapes *store, const narc_allocator *allocator) {
    narc_methods *methods = NULL;
    assert_int_equal(narc_create_methods(store, allocator, &methods, NULL), NARC_OK);
    return methods;
}
void release_shapes(const void *shapes) { narc_destroy_methods((narc_methods *)(uintptr_t)shapes); }
