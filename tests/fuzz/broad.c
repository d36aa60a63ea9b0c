/* SPDX-License-Identifier: MIT
 *
 * broad.c - pairs of boxes and questions of an index, from arbitrary boxes that move, beside all pairs one after the other.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "boxes.h"
#include "fuzz.h"
#include "narc.h"
#include "narc_broad_phase.h"
#include "narc_scene.h"

enum { MOST = 40, STEPS = 6 };

struct list {
    uint32_t a[MOST * MOST], b[MOST * MOST];
    size_t count;
};

struct world {
    narc_box boxes[MOST];
    uint8_t kind[MOST];
    uint64_t category[MOST];
    uint32_t world[MOST];
    uint32_t changed[MOST + 24]; /* by the last change, */
    size_t changed_count, count;
    narc_index *index; /* which has followed until then */
};

static bool may_pair(const struct world *w, size_t a, size_t b) {
    return w->world[a] == w->world[b] && !(w->kind[a] & w->kind[b] & (NARC_STATIC | NARC_SENSOR)) &&
           (w->category[a] & w->category[b]) != 0;
}

static narc_pair_filter filter_of(const struct world *w) {
    return (narc_pair_filter){.kind = {w->kind, 1},
                              .category = NARC_ARRAY(w->category),
                              .mask = NARC_ARRAY(w->category),
                              .world = NARC_ARRAY(w->world)};
}

static narc_box take_box(struct bytes *from) {
    const float x = (float)take_number(from, 8), y = (float)take_number(from, 8);
    const float width = (float)take_number(from, 1) + 1, height = (float)take_number(from, 1) + 1;
    return (narc_box){x, y, x + width, y + height};
}

/* Some bodies move, come or go, or change their kind or world. */
static void change(struct bytes *from, struct world *w) {
    w->changed_count = 0;
    for (unsigned changes = take_below(from, 12); changes > 0; changes--) {
        const size_t k = take_below(from, MOST);
        const unsigned what = take_below(from, 7);
        if (what == 0 && w->count > 0) {
            w->count--;
            w->boxes[k % (w->count + 1)] = w->boxes[w->count];
            w->changed[w->changed_count++] = (uint32_t)(k % (w->count + 1));
        } else if (what == 1 && w->count < MOST) {
            w->boxes[w->count++] = take_box(from);
            w->changed[w->changed_count++] = (uint32_t)w->count - 1;
        } else if (what == 2) {
            w->kind[k] = (uint8_t)take_below(from, 8);
        } else if (what == 3) {
            w->world[k] = take_below(from, 3) * 0x40000000;
            w->changed[w->changed_count++] = (uint32_t)k;
        } else {
            w->changed[w->changed_count++] = (uint32_t)k;
            const float x = (float)take_number(from, 0.5), y = (float)take_number(from, 0.5);
            w->boxes[k].min_x += x;
            w->boxes[k].max_x += x;
            w->boxes[k].min_y += y;
            w->boxes[k].max_y += y;
        }
    }
}

static void ask_pairs(const void *question, const narc_workers *workers, void *out_list) {
    const struct world *const w = question;
    struct list *const list = out_list;
    const narc_pair_filter filter = filter_of(w);
    AUTO(narc_destroy_broad_phase_at) narc_broad_phase *broad = NULL;
    memset(list, 0, sizeof *list);
    assert_int_equal(narc_create_broad_phase(NULL, &broad), NARC_OK);
    assert_int_equal(narc_find_pairs(broad, w->boxes, w->count, &filter, workers, list->a, list->b, 0, MOST * MOST,
                                     &list->count, NULL),
                     NARC_OK);
}

static void check_pairs(const struct world *w) {
    AUTO(free_at) struct list *const list = ask_everywhere(ask_pairs, w, sizeof *list, NULL);
    size_t at = 0;
    for (uint32_t a = 0; a < w->count; a++)
        for (uint32_t b = a + 1; b < w->count; b++)
            if (overlap(&w->boxes[a], &w->boxes[b]) && may_pair(w, a, b)) {
                assert_true(at < list->count && list->a[at] == a && list->b[at] == b);
                at++;
            }
    assert_int_equal(at, list->count);
}

static narc_index_options options_of(const struct world *w, const narc_workers *workers) {
    return (narc_index_options){
        .category = NARC_ARRAY(w->category), .world = NARC_ARRAY(w->world), .fast = w->kind[0] & 1, .workers = workers};
}

static void list_found(const struct world *w, narc_index *index, const narc_workers *workers, struct list *list) {
    const narc_index_query query = {.mask = NARC_ARRAY(w->category), .world = NARC_ARRAY(w->world), .workers = workers};
    narc_pairs pairs;
    memset(list, 0, sizeof *list);
    assert_int_equal(narc_query_index(index, w->boxes, w->count, &query, &pairs, NULL), NARC_OK);
    assert_true(pairs.count <= MOST * MOST);
    list->count = pairs.count;
    for (size_t k = 0; k < pairs.count; k++) {
        list->a[k] = *(const uint32_t *)(const void *)((const char *)pairs.a.base + (ptrdiff_t)k * pairs.a.stride);
        list->b[k] = *(const uint32_t *)(const void *)((const char *)pairs.b.base + (ptrdiff_t)k * pairs.b.stride);
    }
}

static void ask_index(const void *question, const narc_workers *workers, void *out_list) {
    const struct world *const w = question;
    const narc_index_options options = options_of(w, workers);
    AUTO(narc_destroy_index_at) narc_index *index = NULL;
    assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
    assert_int_equal(narc_build_index(index, w->boxes, w->count, &options, NULL), NARC_OK);
    list_found(w, index, workers, out_list);
}

/* An index that has followed from the beginning answers as a new one. */
static void follow(struct world *w, const struct list *expected) {
    const narc_index_options options = options_of(w, NULL);
    const narc_index_column changed = NARC_ARRAY(w->changed);
    struct list list;
    size_t count = 0;
    for (size_t k = 0; k < w->changed_count; k++) /* the last ones may have gone */
        if (w->changed[k] < w->count)
            w->changed[count++] = w->changed[k];
    assert_int_equal(narc_update_index(w->index, w->boxes, w->count, &changed, count, &options, NULL), NARC_OK);
    list_found(w, w->index, NULL, &list);
    assert_memory_equal(&list, expected, sizeof list);
}

static void check_index(struct world *w) {
    AUTO(free_at) struct list *const list = ask_everywhere(ask_index, w, sizeof *list, NULL);
    size_t at = 0;
    for (uint32_t a = 0; a < w->count; a++)
        for (uint32_t b = 0; b < w->count; b++)
            if (overlap(&w->boxes[a], &w->boxes[b]) && (w->category[a] & w->category[b]) &&
                w->world[a] == w->world[b]) {
                assert_true(at < list->count && list->a[at] == a && list->b[at] == b);
                at++;
            }
    assert_int_equal(at, list->count);
    follow(w, list);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct bytes from = {data, size};
    struct world w = {.count = take_below(&from, MOST + 1)};
    for (size_t k = 0; k < MOST; k++) {
        w.boxes[k] = take_box(&from);
        w.kind[k] = take_below(&from, 4) ? 0 : (uint8_t)take_below(&from, 8);
        w.world[k] = take_below(&from, 4) ? 7 : take_below(&from, 3) * 0x40000000;
        w.category[k] = take_below(&from, 4) ? ~(uint64_t)0 : (uint64_t)1 << take_below(&from, 3);
    }
    assert_int_equal(narc_create_index(NULL, &w.index), NARC_OK);
    for (int step = 0; step < STEPS; step++) {
        check_pairs(&w);
        check_index(&w);
        change(&from, &w);
    }
    for (size_t flights = take_below(&from, 4); flights > 0 && w.count > 0; flights--) { /* some are far away */
        static const float away[] = {1e20f, 1e24f, 1e30f, 1e38f};
        const unsigned way = take_below(&from, 8);
        const float far = way & 4 ? -away[way & 3] : away[way & 3];
        const size_t k = take_byte(&from) % w.count;
        w.changed[w.changed_count++] = (uint32_t)k;
        w.boxes[k] = take_below(&from, 2) ? (narc_box){far, 0, far, 1} : (narc_box){0, far, 1, far};
    }
    check_pairs(&w);
    check_index(&w);
    narc_destroy_index(w.index);
    return 0;
}
