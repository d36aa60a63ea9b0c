/* SPDX-License-Identifier: MIT
 *
 * update.c - narc_update_pairs(): pairs that are kept while no body has left its skin, and found and matched otherwise; or
 * pairs that the caller gives, which are matched alike.
 *
 * Whatever may fail comes before the last list is touched: the next list is made in memory of its own, and takes its
 * place when it is whole.
 */
#include "column.h"
#include "dispatch.h"
#include "error.h"
#include "narc_broad_phase.h"
#include "steps.h"

#include <string.h>

/* Bodies that a thread looks at at a time: some 10 microseconds of work. */
enum { BODY_PART = 4096 };

typedef struct update {
    narc_broad_phase *broad;
    size_t count; /* of bodies */
    const narc_step *step;
    narc_error *error;
} update;

/* ------------------------------------------------------------------------------------------------ what has changed */

/* LEFT: a body has left its kept box, or may form other pairs. REST: one fell asleep or woke. WHOLE: no kept box is of
 * use. */
enum { LEFT = 1, REST = 2, WHOLE = 4 };

static bool is_inside(const narc_box *box, const narc_box *around) {
    return box->min_x >= around->min_x && box->min_y >= around->min_y && box->max_x <= around->max_x &&
           box->max_y <= around->max_y;
}

static bool has_kept_box(const narc_broad_phase *broad, size_t body) {
    return broad->kept_boxes[body].min_x <= broad->kept_boxes[body].max_x;
}

/* From the skin, `room` may have gone on a side, or come. */
static bool has_room(float room, float half) { return room >= half && room <= 3 * half; }

/* Has each side of a box moved by at most `half` of the skin since its kept box was made? */
static bool is_near(const narc_box *box, const narc_box *kept, float half) {
    return has_room(box->min_x - kept->min_x, half) && has_room(box->min_y - kept->min_y, half) &&
           has_room(kept->max_x - box->max_x, half) && has_room(kept->max_y - box->max_y, half);
}

static narc_pair_filter filter_in_use(const update *u) {
    return u->step->filter ? *u->step->filter : (narc_pair_filter){.kind = {0}};
}

static bool has_sets(const update *u) {
    const narc_pair_filter filter = filter_in_use(u);
    return filter.category.base || filter.mask.base || filter.owner.base || filter.world.base;
}

static narc_body_filter filter_of(const update *u, size_t body) {
    const narc_pair_filter filter = filter_in_use(u);
    return narc_read_filter(&filter, body);
}

static bool is_other_set(const narc_body_filter *now, const narc_body_filter *then) {
    return now->category != then->category || now->mask != then->mask || now->owner != then->owner ||
           now->world != then->world;
}

typedef struct changes {
    const update *update;
    bool use_kinds, use_sets;
    bool marks; /* broad->fresh is wanted, as a new list will be made */
    atomic_uint found;
    atomic_size_t fresh_count;
} changes;

static uint8_t kind_at(narc_byte_column kind, size_t body) {
    return kind.base ? narc_byte_at(kind, body) & NARC_KINDS : 0;
}

/* The first of bodies from .. end - 1 that has moved, or whose kind is another; `end` without one. */
static size_t find_changed(const narc_broad_phase *broad, narc_byte_column kind, size_t from, size_t end) {
    const uint64_t all = NARC_KINDS * UINT64_C(0x0101010101010101);
    size_t k = from;
    for (; kind.base && kind.stride == 1 && k + 8 <= end; k += 8) {
        uint64_t now, then, moved;
        memcpy(&now, narc_at(kind.base, 1, k), sizeof now);
        memcpy(&then, broad->kinds + k, sizeof then);
        memcpy(&moved, broad->known.moved + k, sizeof moved);
        if (moved | ((now & all) ^ then))
            break;
    }
    while (k < end && !broad->known.moved[k] && kind_at(kind, k) == broad->kinds[k])
        k++;
    return k;
}

/* The next body from `from` on that something is to be asked of. */
static size_t find_next(const changes *all, narc_byte_column kind, size_t from, size_t end) {
    const narc_broad_phase *const broad = all->update->broad;
    return all->use_sets    ? from
           : all->use_kinds ? find_changed(broad, kind, from, end)
                            : narc_find_flag(broad->known.moved, from, end);
}

/* Pairs that are given have no boxes. */
static inline bool has_moved(const narc_broad_phase *broad, size_t body) {
    return broad->known.moved[body] && !broad->is_given;
}

/* What one body asks for: nothing, or LEFT and REST. */
static inline unsigned look_at_body(const changes *all, const narc_pair_filter *filter, size_t k) {
    const narc_broad_phase *const broad = all->update->broad;
    const narc_box *const box = &broad->boxes_now[k];
    unsigned other = 0;
    bool left =
        has_moved(broad, k) && (narc_is_box(box) ? !is_inside(box, &broad->kept_boxes[k]) : has_kept_box(broad, k));
    if (all->use_kinds)
        other = kind_at(filter->kind, k) ^ broad->kinds[k];
    if (all->use_sets) {
        const narc_body_filter now = narc_read_filter(filter, k);
        left |= is_other_set(&now, &broad->filters[k]);
    }
    return (left || other & (NARC_STATIC | NARC_SENSOR) ? LEFT : 0u) | (other & NARC_ASLEEP ? REST : 0u);
}

/* Bodies first .. end - 1, whose kept boxes and filters are those of the last list. */
static void look_at_some(void *argument, size_t part, size_t first, size_t end) {
    changes *const all = argument;
    const update *const u = all->update;
    const narc_broad_phase *const broad = u->broad;
    const narc_pair_filter filter = filter_in_use(u); /* a copy, which nothing that is written could change */
    const float half = narc_find_kept_skin(u->step) / 2;
    unsigned found = 0;
    size_t fresh_count = 0, k = first;
    (void)part;
    if (all->marks)
        memset(broad->fresh + first, 0, end - first);
    for (; (k = find_next(all, filter.kind, k, end)) < end; k++) {
        const narc_box *const box = &broad->boxes_now[k];
        const unsigned own = look_at_body(all, &filter, k);
        found |= own;
        if (!all->marks)
            continue;
        const bool fresh =
            own & LEFT || (has_moved(broad, k) && narc_is_box(box) && !is_near(box, &broad->kept_boxes[k], half));
        broad->fresh[k] = fresh;
        fresh_count += fresh;
    }
    atomic_fetch_add_explicit(&all->fresh_count, fresh_count, memory_order_relaxed);
    if (found)
        atomic_fetch_or_explicit(&all->found, found, memory_order_relaxed);
}

/* Are the pairs others than the last list's, whatever bodies do now: given ones, or found ones and no longer given, or were
 * bodies taken out? */
static bool are_other_pairs(const update *u) {
    const narc_broad_phase *const broad = u->broad;
    return broad->lists[broad->last].has_gone || broad->is_given != (u->step->pairs != NULL) ||
           (u->step->pairs && !u->step->same_pairs);
}

static unsigned look_at_all(const update *u, size_t *out_fresh_count) {
    const bool filter = u->step->filter, had_filter = u->broad->has_filter;
    changes all = {u, filter || had_filter, has_sets(u) || (had_filter && u->broad->has_sets), false, 0, 0};
    if (!u->broad->is_current || (filter && !had_filter) || are_other_pairs(u))
        return WHOLE;
    narc_run_ranges(u->step->workers, u->count, BODY_PART, look_at_some, &all);
    all.marks = atomic_load_explicit(&all.found, memory_order_relaxed) & LEFT;
    if (all.marks) /* mostly none has left */
        narc_run_ranges(u->step->workers, u->count, BODY_PART, look_at_some, &all);
    *out_fresh_count = atomic_load_explicit(&all.fresh_count, memory_order_relaxed);
    return atomic_load_explicit(&all.found, memory_order_relaxed);
}

static uint64_t id_of(const update *u, size_t body) {
    return u->step->id.base ? narc_word_at(u->step->id, body) : body;
}

/* Can a look at the listed bodies stand for one at all, as the others are those of the last list? */
static bool may_trust(const update *u, const narc_shapes *shapes) {
    const narc_broad_phase *const broad = u->broad;
    const narc_kept_list *const last = &broad->lists[broad->last];
    return !broad->reframed && broad->is_current && u->count == last->body_count && u->count == broad->known.count &&
           !are_other_pairs(u) && narc_are_poses_known(broad, shapes, u->step) &&
           !broad->has_filter == !u->step->filter && broad->has_sets == has_sets(u) &&
           !last->has_ids == !u->step->id.base;
}

/* What listed bodies ask for: nothing, REST, or a look at all, WHOLE. */
static unsigned look_at_listed(const update *u) {
    const narc_broad_phase *const broad = u->broad;
    const narc_kept_list *const last = &broad->lists[broad->last];
    const narc_pair_filter filter = filter_in_use(u);
    const changes all = {.update = u, .use_kinds = broad->has_filter, .use_sets = broad->has_sets};
    unsigned found = 0;
    for (size_t i = 0; i < u->step->moved_count && !(found & LEFT); i++) {
        const size_t k = narc_index_at(u->step->moved, i);
        found |= last->has_ids && id_of(u, k) != last->ids[k] ? LEFT : look_at_body(&all, &filter, k);
    }
    return found & LEFT ? WHOLE : found;
}

/* Are body k and body k of the last list the same, for all of both? */
static bool are_same(const update *u) {
    const narc_kept_list *const last = &u->broad->lists[u->broad->last];
    bool same = u->count == last->body_count && !last->has_gone;
    if (u->step->id.base || last->has_ids)
        for (size_t k = 0; same && k < u->count; k++)
            same = id_of(u, k) == (last->has_ids ? last->ids[k] : k);
    return same;
}

/* The last list once more. */
static void keep_list(const update *u, bool rest) {
    narc_broad_phase *const broad = u->broad;
    narc_kept_list *const last = &broad->lists[broad->last];
    if (broad->renewed)
        for (size_t k = 0; k < last->list.pairs.count; k++) {
            last->previous[k] = (uint32_t)k;
            last->marks[k] &= NARC_KINDS;
        }
    broad->renewed = last->list.renumbered = false;
    last->list.kept = true;
    last->list.added_count = last->list.lost_count = 0;
    broad->marked = rest;
    if (!rest)
        return;
    for (size_t k = 0; k < u->count; k++)
        broad->kinds[k] = filter_of(u, k).kind;
    broad->has_other_kinds = true;
    narc_mark_pairs(broad, last);
}

/* ------------------------------------------------------------------------------------------------ bodies by ids */

static narc_status fail_memory(const update *u, size_t count, const char *what) {
    return narc_fail(u->error, NARC_ERROR_MEMORY, 0, (double)count, "not enough memory for %zu %s", count, what);
}

/* Ids as pairs of their halves. */
static narc_pairs view_ids(const uint64_t *ids, size_t count) {
    const uint32_t *const halves = (const void *)ids; /* NULL: there was no body yet */
    return (narc_pairs){.count = count, .a = {halves, sizeof *ids}, .b = {halves ? halves + 1 : NULL, sizeof *ids}};
}

/* The ids of a list whose bodies had none: their numbers. */
static narc_status number_bodies(const update *u, narc_kept_list *list) {
    if (list->has_ids)
        return NARC_OK;
    if (narc_reserve_ids(u->broad, list, list->body_count) != NARC_OK)
        return fail_memory(u, list->body_count, "bodies");
    for (size_t k = 0; k < list->body_count; k++)
        list->ids[k] = k;
    if (list->body_count > 0)
        memset(list->gone, 0, list->body_count);
    list->has_ids = true;
    return NARC_OK;
}

/* Gives the new list its ids, if bodies have any. Unless all bodies are the `same`, finds the number that each had in
 * the last list, or NARC_NO_MATCH. */
static narc_status find_last_indices(const update *u, narc_kept_list *last, narc_kept_list *made, bool same) {
    narc_broad_phase *const broad = u->broad;
    made->body_count = u->count;
    made->has_ids = u->step->id.base || last->has_ids;
    made->has_gone = false;
    if (!made->has_ids)
        return NARC_OK; /* body k is body k */
    if (narc_reserve_ids(broad, made, u->count) != NARC_OK)
        return fail_memory(u, u->count, "bodies");
    for (size_t k = 0; k < u->count; k++)
        made->ids[k] = id_of(u, k);
    if (u->count > 0)
        memset(made->gone, 0, u->count);
    if (same)
        return NARC_OK;
    narc_status status = number_bodies(u, last);
    const narc_pairs before = view_ids(last->ids, last->body_count), now = view_ids(made->ids, u->count);
    if (status == NARC_OK)
        status = narc_match_pairs(broad, &before, &now, u->step->workers, broad->last_index) == NARC_OK
                     ? NARC_OK
                     : fail_memory(u, u->count, "bodies");
    if (status != NARC_OK)
        return status;
    if (last->body_count > 0)
        memset(broad->taken, 0, last->body_count);
    for (size_t k = 0; k < u->count; k++) {
        uint32_t *const last_index = &broad->last_index[k], index = *last_index;
        if (index != NARC_NO_MATCH && last->gone[index])
            *last_index = index = NARC_NO_MATCH;
        if (index != k) /* its pose was compared with another body's */
            broad->known.changed[k] = NARC_ALL_CHANGED;
        if (index != NARC_NO_MATCH && broad->taken[index]++)
            return narc_fail(u->error, NARC_ERROR_ARGUMENT, k, (double)made->ids[k],
                             "body %zu: id %llu is also that of a body before it", k, (unsigned long long)made->ids[k]);
    }
    return NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ a new list */

/* Gives fresh bodies boxes with the skin, as the new list knows them, and all bodies their filters. Returns how many
 * have no box, if it was so many in the last list. */
static size_t keep_bodies(const update *u, unsigned found, size_t skipped) {
    narc_broad_phase *const broad = u->broad;
    const narc_box nowhere = narc_empty_box();
    const bool whole = found & WHOLE;
    if (whole) {
        memset(broad->fresh, 1, u->count);
        skipped = 0;
    }
    broad->has_other_kinds = whole || found & REST || (broad->has_filter && !u->step->filter);
    broad->has_filter = u->step->filter;
    broad->has_sets = has_sets(u);
    broad->is_given = u->step->pairs;
    for (size_t k = 0; k < u->count && broad->has_filter && (found & REST); k++)
        broad->kinds[k] = filter_of(u, k).kind;
    for (size_t k = 0; (k = narc_find_flag(broad->fresh, k, u->count)) < u->count; k++) {
        const narc_box box = broad->is_given ? nowhere : broad->boxes_now[k]; /* given pairs need no boxes */
        const bool has = narc_is_box(&box);
        skipped += !has && !broad->is_given;
        skipped -= !whole && !has_kept_box(broad, k) && !broad->is_given;
        broad->kept_boxes[k] = has ? narc_widen_box(box, narc_find_kept_skin(u->step)) : nowhere;
        broad->known.moved[k] = 0;
        if (broad->has_filter) {
            broad->filters[k] = filter_of(u, k);
            broad->has_other_kinds |= broad->kinds[k] != broad->filters[k].kind;
            broad->kinds[k] = broad->filters[k].kind;
        }
    }
    return skipped;
}

/* Room for so many pairs in the next list. */
static narc_status begin_list(const update *u, narc_kept_list *last, narc_kept_list *made, size_t count,
                              size_t skipped) {
    if (count > UINT32_MAX - 1)
        return narc_fail(u->error, NARC_ERROR_COUNT, 0, (double)count, "%zu pairs of boxes overlap, at most %lu", count,
                         (unsigned long)(UINT32_MAX - 1));
    if (narc_reserve_pairs(u->broad, made, count) != NARC_OK || narc_reserve_pairs(u->broad, last, 0) != NARC_OK)
        return fail_memory(u, count, "pairs");
    made->list = (narc_pair_list){.pairs = {.count = count, .a = NARC_ARRAY(made->a), .b = NARC_ARRAY(made->b)},
                                  .previous = made->previous,
                                  .marks = made->marks,
                                  .added = made->added,
                                  .skipped = skipped};
    memset(made->marks, 0, count);
    return NARC_OK;
}

/* Of the pairs that the caller gives none stands twice. */
static narc_status check_each_once(const update *u, const narc_kept_list *made) {
    for (size_t k = 1; k < made->list.pairs.count; k++)
        if (made->a[k] == made->a[k - 1] && made->b[k] == made->b[k - 1])
            return narc_fail(u->error, NARC_ERROR_ARGUMENT, made->a[k], made->b[k],
                             "step.pairs has bodies %lu and %lu twice", (unsigned long)made->a[k],
                             (unsigned long)made->b[k]);
    return NARC_OK;
}

/* Finds all pairs, or takes the given ones, and what they were. */
static narc_status find_all(const update *u, bool same, narc_kept_list *last, narc_kept_list *made, size_t skipped,
                            size_t *out_lost) {
    narc_broad_phase *const broad = u->broad;
    const narc_pair_filter *const filter = u->step->filter;
    const narc_workers *const workers = u->step->workers;
    size_t found = 0;
    narc_status status = u->step->pairs
                             ? narc_hold_pairs(broad, u->step->pairs, u->count, filter, &found, u->error)
                             : narc_sweep_boxes(broad, broad->kept_boxes, u->count, filter, workers, &found, u->error);
    if (status == NARC_OK)
        status = begin_list(u, last, made, found, skipped);
    if (status == NARC_OK)
        status = narc_list_found_pairs(broad, u->count, filter, workers, found, made->a, made->b, u->error);
    if (status == NARC_OK && u->step->pairs)
        status = check_each_once(u, made);
    if (status != NARC_OK)
        return status;
    if (!same && made->has_ids)
        narc_match_lists(last, made, broad->last_index, workers);
    else
        narc_match_in_order(&last->list.pairs, &made->list.pairs, workers, made->previous);
    *out_lost = narc_list_added(last, made);
    return NARC_OK;
}

/* Lists `found` pairs of fresh bodies, and those of others that were there. */
static narc_status merge_lists(const update *u, narc_kept_list *last, narc_kept_list *made, size_t skipped,
                               size_t found, size_t *out_lost) {
    narc_broad_phase *const broad = u->broad;
    if (narc_reserve_matches(broad, found, found) != NARC_OK)
        return fail_memory(u, found, "pairs");
    uint32_t *const a = broad->match_memory, *const b = found ? a + found : a; /* of nothing it may be NULL */
    narc_status status = begin_list(u, last, made, last->list.pairs.count + found, skipped);
    if (status == NARC_OK)
        status = narc_list_found_pairs(broad, u->count, u->step->filter, u->step->workers, found, a, b, u->error);
    if (status == NARC_OK)
        *out_lost = narc_merge_pairs(broad->fresh, last, made, a, b, found);
    return status;
}

/* Makes the next list. The last one stays as it is, but for `matched`, and for ids that are numbers. */
static narc_status make_list(const update *u, bool same, unsigned found, size_t fresh_count, narc_kept_list *last,
                             narc_kept_list *made) {
    narc_broad_phase *const broad = u->broad;
    const bool sorted = !(found & WHOLE) && broad->is_sorted && !u->step->pairs;
    size_t lost_count = 0, fresh_pairs = 0;
    narc_status status = find_last_indices(u, last, made, same);
    if (status != NARC_OK)
        return status;
    broad->is_current = false; /* as long as the kept boxes are not the last list's */
    const size_t skipped = keep_bodies(u, found, last->list.skipped);
    if (sorted &&
        narc_sweep_fresh(broad, broad->kept_boxes, u->count, fresh_count, u->step->filter, u->step->workers,
                         &fresh_pairs) &&
        fresh_pairs < UINT32_MAX - last->list.pairs.count)
        status = merge_lists(u, last, made, skipped, fresh_pairs, &lost_count);
    else {
        broad->has_other_kinds = true; /* no marks are taken over */
        status = find_all(u, same, last, made, skipped, &lost_count);
    }
    if (status != NARC_OK)
        return status;
    if (narc_reserve_lost(broad, made, lost_count) != NARC_OK)
        return fail_memory(u, lost_count, "lost pairs");
    made->list.renumbered = !same;
    narc_list_lost(last, made, lost_count);
    narc_mark_pairs(broad, made);
    return NARC_OK;
}

static narc_status finish(const update *u, bool listed, const narc_pair_list **out_list) {
    narc_broad_phase *const broad = u->broad;
    const unsigned asked = listed ? look_at_listed(u) : WHOLE;
    if (!(asked & WHOLE)) {
        keep_list(u, asked & REST);
        *out_list = &broad->lists[broad->last].list;
        return NARC_OK;
    }
    const bool same = are_same(u);
    if (same && !u->step->id.base)
        broad->lists[broad->last].has_ids = false; /* all are numbers, as after narc_forget_ids() */
    size_t fresh_count = 0;
    const unsigned found = same ? look_at_all(u, &fresh_count) : WHOLE;
    if (found & (LEFT | WHOLE)) {
        const int next = 1 - broad->last;
        const narc_status status =
            make_list(u, same, found, fresh_count, &broad->lists[broad->last], &broad->lists[next]);
        if (status != NARC_OK)
            return status;
        broad->last = next;
        broad->is_current = broad->renewed = broad->marked = true;
        broad->is_sorted = !broad->is_given;
    } else
        keep_list(u, found & REST);
    *out_list = &broad->lists[broad->last].list;
    return NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ the origin */

/* So many times as far as the skin is wide the step's origin may be from that of the boxes: rounding takes next to nothing of
 * the skin there. */
enum { NEAR_ORIGIN = 8192 };

/* A side as it is from another origin, or further inwards (`in` 1 or -1): by what double precision and its own round. */
static float move_side(float side, double by, double in) {
    const double moved = (double)side + by;
    return (float)(moved + in * ((fabs((double)side) + fabs(by)) * 0x1p-51 + fabs(moved) * 0x1p-23));
}

/* Boxes are from the step's origin if that is far from theirs. Kept ones are smaller then, so that bodies in them are where
 * they were: the list has all their pairs still, and the next one is made of all boxes. */
static void move_origin(narc_broad_phase *broad, const narc_step *step, size_t count) {
    const narc_point to = step->origin ? *step->origin : (narc_point){0, 0}, from = broad->origin;
    const double x = from.x - to.x, y = from.y - to.y, near = (double)step->skin * NEAR_ORIGIN;
    broad->reframed = !(step->pairs || (x == 0 && y == 0) || (broad->is_current && fabs(x) + fabs(y) <= near));
    if (!broad->reframed)
        return;
    broad->origin = to;
    broad->is_sorted = false;
    for (size_t k = 0; k < count && broad->is_current; k++) {
        narc_box *const box = &broad->kept_boxes[k];
        *box = (narc_box){move_side(box->min_x, x, 1), move_side(box->min_y, y, 1), move_side(box->max_x, x, -1),
                          move_side(box->max_y, y, -1)};
    }
}

/* ------------------------------------------------------------------------------------------------ the call */

static narc_status check_own_pairs(const update *u) {
    const narc_pairs *const pairs = u->step->pairs;
    if (pairs->count > 0 && (!pairs->a.base || !pairs->b.base))
        return narc_fail_missing(u->error, pairs->a.base ? "step.pairs.b" : "step.pairs.a");
    if (pairs->other_bodies || pairs->shift_x.base || pairs->shift_y.base)
        return narc_fail(u->error, NARC_ERROR_ARGUMENT, 0, 0,
                         "step.pairs with %s: contacts are of one set, as it stands",
                         pairs->other_bodies ? "other_bodies" : "shifts");
    narc_status status = narc_check_reserved(pairs->reserved, 2, "step.pairs", u->error);
    return status == NARC_OK ? narc_check_count(pairs->count, UINT32_MAX - 1, "pairs", u->error) : status;
}

narc_status narc_update_pairs(narc_broad_phase *broad, const narc_shapes *shapes, const narc_step *step,
                              const narc_pair_list **out_list, narc_error *error) {
    const size_t count = step->bodies->count, last_count = broad->lists[broad->last].body_count;
    const update u = {broad, count, step, error};
    narc_status status = narc_check_count(count, UINT32_MAX - 1, "bodies", error);
    if (status == NARC_OK && step->pairs)
        status = check_own_pairs(&u);
    if (status == NARC_OK && narc_reserve_bodies(broad, count > last_count ? count : last_count) != NARC_OK)
        status = fail_memory(&u, count, "bodies");
    if (status != NARC_OK)
        return status;
    move_origin(broad, step, last_count);
    const bool listed = (step->moved.base || step->moved.stride) && may_trust(&u, shapes);
    status = narc_compute_step_boxes(broad, shapes, step, listed, error);
    if (status != NARC_OK && broad->reframed)
        narc_forget_poses(broad); /* their boxes are from another origin */
    return status == NARC_OK ? finish(&u, listed, out_list) : status;
}

void narc_take_back_pairs(narc_broad_phase *broad, bool made) {
    broad->last = made ? 1 - broad->last : broad->last;
    broad->is_current = false;
    if (broad->body_capacity > 0)
        memset(broad->known.changed, NARC_ALL_CHANGED, broad->body_capacity);
}

narc_status narc_forget_ids(narc_broad_phase *broad, const uint64_t *ids, size_t count, narc_error *error) {
    const update u = {.broad = broad, .error = error};
    narc_kept_list *const last = &broad->lists[broad->last];
    const narc_pairs given = view_ids(ids, count);
    narc_status status = number_bodies(&u, last);
    if (status != NARC_OK || last->body_count == 0)
        return status;
    const narc_pairs known = view_ids(last->ids, last->body_count);
    if (narc_match_pairs(broad, &given, &known, NULL, broad->last_index) != NARC_OK)
        return fail_memory(&u, count, "ids");
    for (size_t body = 0; body < last->body_count; body++)
        if (broad->last_index[body] != NARC_NO_MATCH)
            last->gone[body] = last->has_gone = true;
    return NARC_OK;
}

void narc_forget_pairs(narc_broad_phase *broad) {
    narc_kept_list *const last = &broad->lists[broad->last];
    last->list = (narc_pair_list){.kept = false};
    last->body_count = 0;
    last->has_ids = last->has_gone = broad->is_current = false;
}
