/* SPDX-License-Identifier: MIT
 *
 * broad.c - lists of pairs and questions of an index, from arbitrary boxes that move, beside all pairs one after the
 * other.
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
    uint64_t id[MOST];
    uint64_t category[MOST];
    size_t count;
};

static bool may_pair(const struct world *w, size_t a, size_t b) {
    return !(w->kind[a] & w->kind[b] & (NARC_STATIC | NARC_SENSOR)) && (w->category[a] & w->category[b]) != 0;
}

static narc_pair_filter filter_of(const struct world *w) {
    return (narc_pair_filter){
        .kind = {w->kind, 1}, .category = NARC_ARRAY(w->category), .mask = NARC_ARRAY(w->category)};
}

static narc_box take_box(struct bytes *from) {
    const float x = (float)take_number(from, 8), y = (float)take_number(from, 8);
    const float width = (float)take_number(from, 1) + 1, height = (float)take_number(from, 1) + 1;
    return (narc_box){x, y, x + width, y + height};
}

/* Some bodies move, come or go, or change their kind. */
static void change(struct bytes *from, struct world *w) {
    for (unsigned changes = take_below(from, 12); changes > 0; changes--) {
        const size_t k = take_below(from, MOST);
        const unsigned what = take_below(from, 6);
        if (what == 0 && w->count > 0) {
            w->count--;
            w->boxes[k % (w->count + 1)] = w->boxes[w->count];
            w->id[k % (w->count + 1)] = w->id[w->count];
        } else if (what == 1 && w->count < MOST) {
            w->boxes[w->count] = take_box(from);
            w->id[w->count++] = (uint64_t)take_word(from) << 32 | from->left;
        } else if (what == 2) {
            w->kind[k] = (uint8_t)take_below(from, 8);
        } else {
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
    narc_broad_phase *broad = NULL;
    memset(list, 0, sizeof *list);
    assert_int_equal(narc_create_broad_phase(NULL, &broad), NARC_OK);
    assert_int_equal(
        narc_find_pairs(broad, w->boxes, w->count, &filter, workers, list->a, list->b, MOST * MOST, &list->count, NULL),
        NARC_OK);
    narc_destroy_broad_phase(broad);
}

static void check_pairs(const struct world *w) {
    struct list *const list = ask_everywhere(ask_pairs, w, sizeof *list, NULL);
    size_t at = 0;
    for (uint32_t a = 0; a < w->count; a++)
        for (uint32_t b = a + 1; b < w->count; b++)
            if (overlap(&w->boxes[a], &w->boxes[b]) && may_pair(w, a, b)) {
                assert_true(at < list->count && list->a[at] == a && list->b[at] == b);
                at++;
            }
    assert_int_equal(at, list->count);
    free(list);
}

static void ask_index(const void *question, const narc_workers *workers, void *out_list) {
    const struct world *const w = question;
    struct list *const list = out_list;
    const narc_index_options options = {
        .category = NARC_ARRAY(w->category), .fast = w->kind[0] & 1, .workers = workers};
    const narc_index_query query = {.mask = NARC_ARRAY(w->category), .workers = workers};
    narc_index *index = NULL;
    narc_pairs pairs;
    memset(list, 0, sizeof *list);
    assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
    assert_int_equal(narc_build_index(index, w->boxes, w->count, &options, NULL), NARC_OK);
    assert_int_equal(narc_query_index(index, w->boxes, w->count, &query, &pairs, NULL), NARC_OK);
    assert_true(pairs.count <= MOST * MOST);
    list->count = pairs.count;
    for (size_t k = 0; k < pairs.count; k++) {
        list->a[k] = *(const uint32_t *)(const void *)((const char *)pairs.a.base + (ptrdiff_t)k * pairs.a.stride);
        list->b[k] = *(const uint32_t *)(const void *)((const char *)pairs.b.base + (ptrdiff_t)k * pairs.b.stride);
    }
    narc_destroy_index(index);
}

static void check_index(const struct world *w) {
    struct list *const list = ask_everywhere(ask_index, w, sizeof *list, NULL);
    size_t at = 0;
    for (uint32_t a = 0; a < w->count; a++)
        for (uint32_t b = 0; b < w->count; b++)
            if (overlap(&w->boxes[a], &w->boxes[b]) && (w->category[a] & w->category[b])) {
                assert_true(at < list->count && list->a[at] == a && list->b[at] == b);
                at++;
            }
    assert_int_equal(at, list->count);
    free(list);
}

static uint32_t at(narc_index_column column, size_t k) {
    return *(const uint32_t *)(const void *)((const char *)column.base + (ptrdiff_t)k * column.stride);
}

/* Bodies with the same id may not be, so ids are made different. */
static void part_ids(struct world *w) {
    for (size_t k = 0; k < w->count; k++)
        for (size_t i = 0; i < k; i++)
            if (w->id[i] == w->id[k]) {
                w->id[k] += 0x10001;
                i = (size_t)-1;
            }
}

/* A list that is kept: every pair that overlaps is in it, in order; what is told of the last list is so. */
static void check_list(const struct world *w, const narc_pair_list *list, const struct world *last,
                       const struct list *last_pairs, struct list *out_pairs) {
    size_t next = 0, added = 0, found = 0;
    out_pairs->count = list->pairs.count;
    assert_true(list->pairs.count <= MOST * MOST);
    for (size_t k = 0; k < list->pairs.count; k++) {
        const uint32_t a = out_pairs->a[k] = at(list->pairs.a, k), b = out_pairs->b[k] = at(list->pairs.b, k);
        assert_true(a < b && b < w->count && may_pair(w, a, b));
        assert_true(k == 0 || out_pairs->a[k - 1] < a || (out_pairs->a[k - 1] == a && out_pairs->b[k - 1] < b));
        const uint32_t before = list->previous[k];
        if (before == NARC_NO_MATCH) {
            assert_true(added < list->added_count && list->added[added++] == k);
            continue;
        }
        assert_true(before < last_pairs->count);
        const uint64_t ids[2] = {last->id[last_pairs->a[before]], last->id[last_pairs->b[before]]};
        assert_true((ids[0] == w->id[a] && ids[1] == w->id[b]) || (ids[0] == w->id[b] && ids[1] == w->id[a]));
        found++;
    }
    assert_int_equal(added, list->added_count);
    assert_int_equal(found + list->lost_count, last_pairs->count);
    for (uint32_t a = 0; a < w->count; a++)
        for (uint32_t b = a + 1; b < w->count; b++)
            if (overlap(&w->boxes[a], &w->boxes[b]) && may_pair(w, a, b)) {
                while (next < list->pairs.count && (out_pairs->a[next] != a || out_pairs->b[next] != b))
                    next++;
                assert_true(next < list->pairs.count);
            }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct bytes from = {data, size};
    struct world w = {.count = take_below(&from, MOST + 1)}, last;
    static struct list pairs, last_pairs;
    narc_broad_phase *broad = NULL;
    const narc_pair_list *list = NULL;
    const float skin = (float)take_below(&from, 16) / 64;
    for (size_t k = 0; k < MOST; k++) {
        w.boxes[k] = take_box(&from);
        w.id[k] = k;
        w.kind[k] = take_below(&from, 4) ? 0 : (uint8_t)take_below(&from, 8);
        w.category[k] = take_below(&from, 4) ? ~(uint64_t)0 : (uint64_t)1 << take_below(&from, 3);
    }
    assert_int_equal(narc_create_broad_phase(NULL, &broad), NARC_OK);
    last_pairs.count = 0;
    last = w;
    for (int step = 0; step < STEPS; step++) {
        const narc_pair_filter filter = filter_of(&w);
        const narc_pair_options options = {.skin = skin, .id = NARC_ARRAY(w.id), .filter = &filter};
        test_use_isa(step % 2 ? "scalar" : NULL);
        assert_int_equal(narc_update_box_pairs(broad, w.boxes, w.count, &options, &list, NULL), NARC_OK);
        check_list(&w, list, &last, &last_pairs, &pairs);
        last_pairs = pairs;
        last = w;
        check_pairs(&w);
        check_index(&w);
        change(&from, &w);
        part_ids(&w);
    }
    for (size_t flights = take_below(&from, 4); flights > 0 && w.count > 0; flights--) { /* some are far away */
        static const float away[] = {1e20f, 1e24f, 1e30f, 1e38f};
        const unsigned way = take_below(&from, 8);
        const float far = way & 4 ? -away[way & 3] : away[way & 3];
        w.boxes[take_byte(&from) % w.count] =
            take_below(&from, 2) ? (narc_box){far, 0, far, 1} : (narc_box){0, far, 1, far};
    }
    check_pairs(&w);
    check_index(&w);
    narc_destroy_broad_phase(broad);
    return 0;
}
