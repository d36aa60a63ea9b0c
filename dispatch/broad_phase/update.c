/* SPDX-License-Identifier: MIT
 *
 * update.c - narc_update_pairs(): pairs that are kept while no body has left its skin, and found and matched otherwise.
 *
 * Whatever may fail comes before the last list is touched: the next list is made in memory of its own, and takes its
 * place when it is whole.
 */
#include "column.h"
#include "dispatch.h"
#include "error.h"
#include "narc_broad_phase.h"
#include "steps.h"

#include <math.h>
#include <string.h>

/* Bodies that a thread looks at at a time, and pairs that it matches: some 10 microseconds of work. */
enum { BODY_PART = 4096, PAIR_PART = 4096 };

typedef struct update {
    narc_broad_phase *broad;
    const narc_box *boxes; /* of the bodies, without the skin */
    size_t count;
    const narc_pair_options *options;
    narc_error *error;
} update;

/* ------------------------------------------------------------------------------------------------ boxes */

static const narc_box empty = {INFINITY, INFINITY, -INFINITY, -INFINITY};

/* x - by or less, finite: a rounding errs by half of the step that is added, or less. */
static float lower(float x, float by) {
    const float rounded = x - by, down = rounded - (fabsf(rounded) * 0x1p-23f + FLT_TRUE_MIN);
    return by == 0 ? x : down < -FLT_MAX ? -FLT_MAX : down;
}

static narc_box widen(narc_box box, float by) {
    return (narc_box){lower(box.min_x, by), lower(box.min_y, by), -lower(-box.max_x, by), -lower(-box.max_y, by)};
}

/* The boxes with half of the margin, `half`, and each body's own reach. A body whose reach is broken has none. */
static void add_room(const update *u, const narc_box *boxes, float half, narc_box *out_boxes) {
    const narc_float_column reach = u->options->reach;
    for (size_t k = 0; k < u->count; k++) {
        const float own = reach.base ? narc_float_at(reach, k) : 0;
        const bool fine = narc_is_box(&boxes[k]) && own >= 0 && own <= FLT_MAX;
        out_boxes[k] = fine ? widen(widen(boxes[k], half), own) : empty;
    }
}

/* ------------------------------------------------------------------------------------------------ what has changed */

/* RENEW: a body has left its kept box, or may form other pairs. REST: one fell asleep or woke. */
enum { RENEW = 1, REST = 2 };

static bool is_inside(const narc_box *box, const narc_box *around) {
    return box->min_x >= around->min_x && box->min_y >= around->min_y && box->max_x <= around->max_x &&
           box->max_y <= around->max_y;
}

static narc_body_filter filter_of(const update *u, size_t body) {
    static const narc_pair_filter none = {.kind = {0}};
    return narc_read_filter(u->options->filter ? u->options->filter : &none, body);
}

typedef struct changes {
    const update *update;
    bool use_filters;
    atomic_uint found;
} changes;

/* Bodies first .. end - 1, whose kept boxes and filters are those of the last list. */
static void look(void *argument, size_t part, size_t first, size_t end) {
    changes *const all = argument;
    const update *const u = all->update;
    const narc_broad_phase *const broad = u->broad;
    bool renew = false, rest = false;
    (void)part;
    for (size_t k = first; k < end; k++) {
        const bool has = narc_is_box(&u->boxes[k]), had = broad->kept_boxes[k].min_x <= broad->kept_boxes[k].max_x;
        renew |= has ? !is_inside(&u->boxes[k], &broad->kept_boxes[k]) : had;
        if (!all->use_filters)
            continue;
        const narc_body_filter now = filter_of(u, k), *const then = &broad->filters[k];
        const unsigned other = now.kind ^ then->kind;
        renew |= now.category != then->category || now.mask != then->mask || now.group != then->group ||
                 (other & (NARC_STATIC | NARC_SENSOR));
        rest |= (other & NARC_ASLEEP) != 0;
    }
    if (renew || rest)
        atomic_fetch_or_explicit(&all->found, (renew ? RENEW : 0u) | (rest ? REST : 0u), memory_order_relaxed);
}

static unsigned look_at_all(const update *u) {
    const bool filter = u->options->filter, had_filter = u->broad->has_filter;
    changes all = {u, filter || had_filter, 0};
    if (!u->broad->is_current || (filter && !had_filter))
        return RENEW;
    narc_run_ranges(u->options->workers, u->count, BODY_PART, look, &all);
    return atomic_load_explicit(&all.found, memory_order_relaxed);
}

static uint64_t id_of(const update *u, size_t body) {
    return u->options->id.base ? narc_word_at(u->options->id, body) : body;
}

/* Are body k and body k of the last list the same, for all of both? */
static bool are_same(const update *u) {
    const narc_kept_list *const last = &u->broad->lists[u->broad->last];
    bool same = u->count == last->body_count;
    if (u->options->id.base || last->has_ids)
        for (size_t k = 0; same && k < u->count; k++)
            same = id_of(u, k) == (last->has_ids ? last->ids[k] : k);
    return same;
}

/* ------------------------------------------------------------------------------------------------ marks */

static unsigned kind_of(const narc_broad_phase *broad, uint32_t body) {
    return broad->has_filter ? broad->filters[body].kind : 0;
}

/* Marks all pairs by the kinds of their bodies, and lists those to be tested that have a sensor, or have none. */
static size_t mark_pairs(const narc_broad_phase *broad, const narc_kept_list *made, unsigned sensor, uint32_t *out) {
    const unsigned rest = NARC_STATIC | NARC_ASLEEP;
    size_t count = 0;
    for (size_t k = 0; k < made->list.pairs.count; k++) {
        const unsigned a = kind_of(broad, made->a[k]), b = kind_of(broad, made->b[k]);
        made->marks[k] = (uint8_t)((made->marks[k] & NARC_FLIPPED) | a | b);
        if (!(a & rest && b & rest) && ((a | b) & NARC_SENSOR) == sensor)
            out[count++] = (uint32_t)k;
    }
    return count;
}

static void mark_all_pairs(const narc_broad_phase *broad, narc_kept_list *made) {
    narc_pair_list *const list = &made->list;
    list->contact_count = mark_pairs(broad, made, 0, made->selected);
    list->sensors = made->selected + list->contact_count;
    list->sensor_count = mark_pairs(broad, made, NARC_SENSOR, made->selected + list->contact_count);
}

/* The last list once more. */
static void keep(const update *u, bool rest) {
    narc_broad_phase *const broad = u->broad;
    narc_kept_list *const last = &broad->lists[broad->last];
    if (broad->renewed)
        for (size_t k = 0; k < last->list.pairs.count; k++) {
            last->previous[k] = (uint32_t)k;
            last->marks[k] &= NARC_KINDS;
        }
    broad->renewed = false;
    last->list.kept = true;
    last->list.added_count = last->list.lost_count = 0;
    if (!rest)
        return;
    for (size_t k = 0; k < u->count; k++)
        broad->filters[k].kind = filter_of(u, k).kind;
    mark_all_pairs(broad, last);
}

/* ------------------------------------------------------------------------------------------------ bodies by ids */

static narc_status fail_memory(const update *u, size_t count, const char *what) {
    return narc_fail(u->error, NARC_ERROR_MEMORY, 0, (double)count, "not enough memory for %zu %s", count, what);
}

/* Ids as pairs of their halves. */
static narc_pairs view_ids(const narc_kept_list *list) {
    const uint32_t *halves = (const void *)list->ids;
    return (narc_pairs){
        .count = list->body_count, .a = {halves, sizeof *list->ids}, .b = {halves + 1, sizeof *list->ids}};
}

/* The ids of a list whose bodies had none: their numbers. */
static narc_status number_bodies(const update *u, narc_kept_list *list) {
    if (list->has_ids)
        return NARC_OK;
    if (narc_reserve_ids(u->broad, list, list->body_count) != NARC_OK)
        return fail_memory(u, list->body_count, "bodies");
    for (size_t k = 0; k < list->body_count; k++)
        list->ids[k] = k;
    list->has_ids = true;
    return NARC_OK;
}

/* Gives the new list its ids, if bodies have any. Unless all bodies are the `same`, finds the number that each had in
 * the last list, or NARC_NO_MATCH. */
static narc_status find_last_indices(const update *u, narc_kept_list *last, narc_kept_list *made, bool same) {
    narc_broad_phase *const broad = u->broad;
    made->body_count = u->count;
    made->has_ids = u->options->id.base || last->has_ids;
    if (!made->has_ids)
        return NARC_OK; /* body k is body k */
    if (narc_reserve_ids(broad, made, u->count) != NARC_OK)
        return fail_memory(u, u->count, "bodies");
    for (size_t k = 0; k < u->count; k++)
        made->ids[k] = id_of(u, k);
    if (same)
        return NARC_OK;
    narc_status status = number_bodies(u, last);
    const narc_pairs before = view_ids(last), now = view_ids(made);
    if (status == NARC_OK)
        status = narc_match_pairs(broad, &before, &now, u->options->workers, broad->last_index, u->error);
    if (status != NARC_OK)
        return status;
    if (last->body_count > 0)
        memset(broad->taken, 0, last->body_count);
    for (size_t k = 0; k < u->count; k++) {
        const uint32_t index = broad->last_index[k];
        if (index != NARC_NO_MATCH && broad->taken[index]++)
            return narc_fail(u->error, NARC_ERROR_ARGUMENT, k, (double)made->ids[k],
                             "body %zu: id %llu is also that of a body before it", k, (unsigned long long)made->ids[k]);
    }
    return NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ matching */

static bool is_pair(const narc_kept_list *list, size_t k, uint32_t a, uint32_t b) {
    return k < list->list.pairs.count && list->a[k] == a && list->b[k] == b;
}

typedef struct matching {
    const narc_kept_list *last;
    narc_kept_list *made;
    const uint32_t *last_index;
} matching;

/* New pairs first .. end - 1 by the numbers that their bodies had. Behind the last match comes the next, mostly. */
static void match_part(void *argument, size_t part, size_t first, size_t end) {
    const matching *const m = argument;
    size_t at = first;
    (void)part;
    for (size_t k = first; k < end; k++) {
        const uint32_t a = m->last_index[m->made->a[k]], b = m->last_index[m->made->b[k]];
        const uint32_t low = a < b ? a : b, high = a < b ? b : a;
        if (!is_pair(m->last, at, low, high))
            at = narc_find_pair(&m->last->list.pairs, narc_join_pair(low, high));
        const bool found = high != NARC_NO_MATCH && is_pair(m->last, at, low, high);
        m->made->previous[k] = found ? (uint32_t)at++ : NARC_NO_MATCH;
        m->made->marks[k] = found && b < a ? NARC_FLIPPED : 0;
    }
}

/* Lists the pairs that are new. Marks those of the last list that are still there, and returns how many are not. */
static size_t list_added(narc_kept_list *last, narc_kept_list *made) {
    const size_t count = made->list.pairs.count, last_count = last->list.pairs.count;
    size_t added = 0;
    memset(last->matched, 0, last_count);
    for (size_t k = 0; k < count; k++)
        if (made->previous[k] == NARC_NO_MATCH)
            made->added[added++] = (uint32_t)k;
        else
            last->matched[made->previous[k]] = 1;
    made->list.added_count = added;
    return last_count - (count - added);
}

static void list_lost(const narc_kept_list *last, narc_kept_list *made, size_t lost_count) {
    size_t lost = 0;
    for (size_t k = 0; lost < lost_count; k++) {
        const uint32_t a = last->a[k], b = last->b[k];
        if (!last->matched[k])
            made->lost[lost++] = (narc_lost_pair){.pair = (uint32_t)k,
                                                  .a = a,
                                                  .b = b,
                                                  .marks = last->marks[k] & NARC_KINDS,
                                                  .id_a = last->has_ids ? last->ids[a] : a,
                                                  .id_b = last->has_ids ? last->ids[b] : b};
    }
    made->list.lost_count = lost_count;
}

/* ------------------------------------------------------------------------------------------------ a new list */

/* Boxes with their skin and filters, as the new list knows them; returns how many bodies have no box. */
static size_t keep_bodies(const update *u) {
    narc_broad_phase *const broad = u->broad;
    size_t skipped = 0;
    broad->has_filter = u->options->filter;
    for (size_t k = 0; k < u->count; k++) {
        const bool has = narc_is_box(&u->boxes[k]);
        skipped += !has;
        broad->kept_boxes[k] = has ? widen(u->boxes[k], u->options->skin) : empty;
    }
    for (size_t k = 0; k < u->count && broad->has_filter; k++)
        broad->filters[k] = filter_of(u, k);
    return skipped;
}

/* Makes the next list. The last one stays as it is, but for `matched`, and for ids that are numbers. */
static narc_status find(const update *u, bool same, narc_kept_list *last, narc_kept_list *made) {
    narc_broad_phase *const broad = u->broad;
    const narc_pair_filter *const filter = u->options->filter;
    size_t found = 0;
    narc_status status = find_last_indices(u, last, made, same);
    if (status != NARC_OK)
        return status;
    broad->is_current = false; /* as long as the kept boxes are not the last list's */
    const size_t skipped = keep_bodies(u);
    status = narc_sweep_boxes(broad, broad->kept_boxes, u->count, filter, u->options->workers, &found, u->error);
    if (status != NARC_OK)
        return status;
    if (found > UINT32_MAX - 1)
        return narc_fail(u->error, NARC_ERROR_COUNT, 0, (double)found, "%zu pairs of boxes overlap, at most %lu", found,
                         (unsigned long)(UINT32_MAX - 1));
    if (narc_reserve_pairs(broad, made, found) != NARC_OK || narc_reserve_pairs(broad, last, 0) != NARC_OK)
        return fail_memory(u, found, "pairs");
    status = narc_list_found_pairs(broad, u->count, filter, u->options->workers, found, made->a, made->b, u->error);
    if (status != NARC_OK)
        return status;
    made->list = (narc_pair_list){.pairs = {.count = found, .a = NARC_ARRAY(made->a), .b = NARC_ARRAY(made->b)},
                                  .previous = made->previous,
                                  .marks = made->marks,
                                  .contacts = made->selected,
                                  .added = made->added,
                                  .skipped = skipped};
    memset(made->marks, 0, found);
    if (!same && made->has_ids) {
        matching m = {last, made, broad->last_index};
        narc_run_ranges(u->options->workers, found, PAIR_PART, match_part, &m);
    } else
        status = narc_match_pairs(broad, &last->list.pairs, &made->list.pairs, u->options->workers, made->previous,
                                  u->error);
    if (status != NARC_OK)
        return status;
    const size_t lost_count = list_added(last, made);
    if (narc_reserve_lost(broad, made, lost_count) != NARC_OK)
        return fail_memory(u, lost_count, "lost pairs");
    list_lost(last, made, lost_count);
    made->list.lost = made->lost;
    mark_all_pairs(broad, made);
    return NARC_OK;
}

static narc_status finish(const update *u, const narc_pair_list **out_list) {
    narc_broad_phase *const broad = u->broad;
    const bool same = are_same(u);
    const unsigned found = same ? look_at_all(u) : RENEW;
    if (found & RENEW) {
        const int next = 1 - broad->last;
        const narc_status status = find(u, same, &broad->lists[broad->last], &broad->lists[next]);
        if (status != NARC_OK)
            return status;
        broad->last = next;
        broad->is_current = broad->renewed = true;
    } else
        keep(u, found & REST);
    *out_list = &broad->lists[broad->last].list;
    return NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ the calls */

/* Checks what both calls share, and makes room for the bodies. */
static narc_status begin(const update *u, const narc_pair_list **out_list) {
    if (!u->broad || !out_list)
        return narc_fail_missing(u->error, u->broad ? "out_list" : "broad");
    narc_status status = narc_check_length(u->options->margin, "margin", u->error);
    if (status == NARC_OK)
        status = narc_check_length(u->options->skin, "skin", u->error);
    if (status == NARC_OK)
        status = narc_check_reserved(u->options->reserved, 4, "options", u->error);
    if (status == NARC_OK && u->options->filter)
        status = narc_check_reserved(u->options->filter->reserved, 2, "filter", u->error);
    if (status != NARC_OK)
        return status;
    if (u->count > UINT32_MAX - 1)
        return narc_fail(u->error, NARC_ERROR_ARGUMENT, 0, (double)u->count, "%zu bodies, at most %lu", u->count,
                         (unsigned long)(UINT32_MAX - 1));
    const size_t last_count = u->broad->lists[u->broad->last].body_count;
    return narc_reserve_bodies(u->broad, u->count > last_count ? u->count : last_count) == NARC_OK
               ? NARC_OK
               : fail_memory(u, u->count, "bodies");
}

static const narc_pair_options defaults = {.margin = 0};

narc_status narc_update_pairs(narc_broad_phase *broad, const narc_shapes *shapes, const narc_bodies *bodies,
                              const narc_pair_options *options, const narc_pair_list **out_list, narc_error *error) {
    if (!shapes || !bodies)
        return narc_fail_missing(error, shapes ? "bodies" : "shapes");
    update u = {broad, NULL, bodies->count, options ? options : &defaults, error};
    narc_status status = begin(&u, out_list);
    if (status != NARC_OK)
        return status;
    const narc_box_options box_options = {.margin = u.options->margin * 0.5f,
                                          .motion_x = u.options->motion_x,
                                          .motion_y = u.options->motion_y,
                                          .workers = u.options->workers};
    narc_box *const boxes = broad->boxes_now;
    status = narc_compute_boxes(shapes, bodies, &box_options, boxes, error);
    if (status != NARC_OK)
        return status;
    if (u.options->reach.base)
        add_room(&u, boxes, 0, boxes);
    u.boxes = boxes;
    return finish(&u, out_list);
}

narc_status narc_update_box_pairs(narc_broad_phase *broad, const narc_box *boxes, size_t count,
                                  const narc_pair_options *options, const narc_pair_list **out_list,
                                  narc_error *error) {
    update u = {broad, boxes, count, options ? options : &defaults, error};
    const narc_status status = begin(&u, out_list);
    if (status != NARC_OK)
        return status;
    if (count > 0 && !boxes)
        return narc_fail_missing(error, "boxes");
    if (u.options->motion_x.base || u.options->motion_y.base)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "options.motion with boxes, which hold their motion");
    if (u.options->margin > 0 || u.options->reach.base) {
        add_room(&u, boxes, u.options->margin * 0.5f, broad->boxes_now);
        u.boxes = broad->boxes_now;
    }
    return finish(&u, out_list);
}

void narc_forget_pairs(narc_broad_phase *broad) {
    if (!broad)
        return;
    narc_kept_list *const last = &broad->lists[broad->last];
    last->list = (narc_pair_list){.kept = false};
    last->body_count = 0;
    last->has_ids = broad->is_current = false;
}
