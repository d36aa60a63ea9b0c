/* SPDX-License-Identifier: MIT
 *
 * check.c - the checks of a batch: its numbers and columns, and whether all indices name something that exists.
 */
#include "column.h"
#include "dispatch.h"
#include "error.h"

#include <math.h>
#include <stdatomic.h>

narc_status narc_fail_missing(narc_error *error, const char *name) {
    return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL", name);
}

narc_status narc_check_reserved(void *const *reserved, size_t count, const char *name, narc_error *error) {
    for (size_t k = 0; k < count; k++)
        if (reserved[k])
            return narc_fail(error, NARC_ERROR_ARGUMENT, k, 0, "%s.reserved[%zu] is not NULL", name, k);
    return NARC_OK;
}
#define CHECK_RESERVED(member, name, error)                                                                            \
    narc_check_reserved((member).reserved, sizeof(member).reserved / sizeof(void *), name, error)

narc_status narc_check_count(size_t count, size_t most, const char *items, narc_error *error) {
    if (count > most)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)count, "%zu %s, at most %zu", count, items, most);
    return NARC_OK;
}

narc_status narc_check_origin(const narc_point *origin, const char *owner, narc_error *error) {
    if (origin && !(isfinite(origin->x) && isfinite(origin->y)))
        return narc_fail(error, NARC_ERROR_NOT_FINITE, 0, isfinite(origin->x) ? origin->y : origin->x,
                         "%s.origin is (%g, %g)", owner, origin->x, origin->y);
    return NARC_OK;
}

narc_status narc_check_range(size_t first, size_t *count, size_t total, const char *items, narc_error *error) {
    if (first > total || *count > total - first)
        return narc_fail(error, NARC_ERROR_ARGUMENT, first, (double)*count,
                         "%s %zu and the %zu from there on, but there are %zu", items, first, *count, total);
    if (*count == 0)
        *count = total - first;
    return NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ bodies */

/* Bodies without poses stand at the origin, not turned. */
static void stand_at_origin(narc_bodies *bodies) {
    static const float row[] = {0, 0, 1, 0};
    bodies->x = (narc_position_column){&row[0], 0, NARC_FLOAT32};
    bodies->y = (narc_position_column){&row[1], 0, NARC_FLOAT32};
    bodies->cosine = (narc_float_column){&row[2], 0};
    bodies->sine = (narc_float_column){&row[3], 0};
}

/* One side's set of bodies, with all columns: the caller's own, or `filled`. */
static narc_status find_set(const narc_bodies *bodies, narc_bodies *filled, const narc_bodies **out,
                            narc_error *error) {
    *out = bodies;
    if (!bodies->x.base && !bodies->y.base && !bodies->cosine.base && !bodies->sine.base) {
        *filled = *bodies;
        stand_at_origin(filled);
        *out = filled;
    }
    const narc_status status = bodies->count > 0 ? narc_check_columns(*out, error) : NARC_OK;
    return status == NARC_OK ? CHECK_RESERVED(*bodies, "bodies", error) : status;
}

/* Every other body of a set, beginning with the first or the second one. */
static void take_every_other(const narc_bodies *set, size_t offset, narc_bodies *bodies) {
    bodies->count = (set->count + 1 - offset) / 2;
/* clang-format off */
#define TAKE(column)                                                                                                   \
    bodies->column = set->column;                                                                                      \
    if (set->column.base) {                                                                                            \
        bodies->column.base = narc_at(set->column.base, set->column.stride, offset);                                   \
        bodies->column.stride = 2 * set->column.stride;                                                                \
    }
    TAKE(x) TAKE(y) TAKE(cosine) TAKE(sine) TAKE(scale) TAKE(shape)
#undef TAKE
    /* clang-format on */
}

/* The sets that A and B are of. Where pairs have no indices, body k is pair k's. */
static narc_status find_sets(const narc_bodies *bodies, const narc_pairs *pairs, narc_batch *batch, narc_error *error) {
    const bool own = narc_have_own_bodies(pairs);
    narc_status status = find_set(bodies, &batch->filled[0], &batch->a, error);
    if (status == NARC_OK && pairs->other_bodies)
        status = find_set(pairs->other_bodies, &batch->filled[1], &batch->b, error);
    if (status != NARC_OK)
        return status;
    if (!pairs->other_bodies) {
        batch->b = batch->a;
        if (!own && (!pairs->a.base || !pairs->b.base))
            return narc_fail_missing(error, pairs->a.base ? "pairs.b" : "pairs.a");
    }
    if (own) {
        take_every_other(batch->a, 1, &batch->filled[1]); /* first: `a` may be filled[0] */
        take_every_other(batch->a, 0, &batch->filled[0]);
        batch->a = &batch->filled[0];
        batch->b = &batch->filled[1];
    }
    const size_t room_a = pairs->a.base ? SIZE_MAX : batch->a->count;
    const size_t room_b = pairs->b.base ? SIZE_MAX : batch->b->count, room = room_a < room_b ? room_a : room_b;
    if (room < pairs->count)
        return narc_fail(error, NARC_ERROR_INDEX, room, (double)pairs->count,
                         "pair %zu has no indices, and there are bodies for %zu pairs only", room, room);
    return NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ a query */

static narc_status check_number(float number, const char *owner, const char *name, narc_error *error) {
    return isnan(number)
               ? narc_fail(error, NARC_ERROR_NOT_FINITE, 0, (double)number, "%s.%s is not a number", owner, name)
               : NARC_OK;
}

narc_status narc_check_numbers(const narc_query *query, const char *name, narc_error *error) {
    narc_status status = check_number(query->margin, name, "margin", error);
    if (status == NARC_OK)
        status = check_number(query->second_margin, name, "second_margin", error);
    if (status == NARC_OK)
        status = check_number(query->flat_angle, name, "flat_angle", error);
    if (status == NARC_OK && query->flat_angle > NARC_MAX_FLAT_ANGLE)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)query->flat_angle, "%s.flat_angle is %g, more than %g",
                         name, (double)query->flat_angle, (double)NARC_MAX_FLAT_ANGLE);
    return status;
}

narc_status narc_check_asking(const narc_query *query, narc_error *error) {
    const narc_status status = narc_check_numbers(query, "query", error);
    return status == NARC_OK ? CHECK_RESERVED(*query, "query", error) : status;
}

static narc_status check_query(const narc_query *query, size_t pair_count, narc_error *error) {
    const narc_status status = narc_check_asking(query, error);
    if (status == NARC_OK && !query->selection.base && query->selection_count > 0)
        return narc_fail_missing(error, "query.selection");
    if (status == NARC_OK && query->selection_count > pair_count)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)query->selection_count,
                         "query.selection_count is %zu, but there are %zu pairs", query->selection_count, pair_count);
    return status;
}

struct narc_side narc_find_side(const narc_batch *batch, size_t pair, int side) {
    const narc_pairs *pairs = batch->pairs;
    const narc_index_column column = side == 0 ? pairs->a : pairs->b;
    const size_t item = column.base ? narc_index_at(column, pair) : pair;
    return (struct narc_side){narc_body_at(pairs, side, pair),
                              narc_index_at(side == 0 ? batch->a->shape : batch->b->shape, item)};
}

/* ------------------------------------------------------------------------------------------------ indices */

/* Pairs that one worker looks at in one go: some 50 microseconds of work. */
enum { PART = 65536 };

/* So few pairs are looked at one by one. */
enum { FEW = 32 };

/* A limit that are_below() can take. What it then finds wrong may be right, and is looked at again. */
static uint32_t clip(size_t limit) { return limit < 0x80000000u ? (uint32_t)limit : 0x80000000u; }

/* Are items first .. last - 1 of a column below `limit`? With limit at most 2^31, the upper bit of k - limit is that of
 * a k below it, if k has none itself. So all that is kept of the items is the union and the intersection of bits: two
 * operations each, on four items at a time, because one would wait for the other. */
static bool are_below(narc_index_column column, size_t first, size_t last, uint32_t limit) {
    uint32_t any[4] = {0}, all[4] = {UINT32_MAX, UINT32_MAX, UINT32_MAX, UINT32_MAX};
    size_t k = first;
    if (column.stride == sizeof(uint32_t)) { /* of a plain array compilers make vectors */
        const uint32_t *index = column.base;
        for (; k < last; k++) {
            any[0] |= index[k];
            all[0] &= index[k] - limit;
        }
    }
    for (; k + 4 <= last; k += 4)
        for (size_t i = 0; i < 4; i++) {
            const uint32_t index = narc_index_at(column, k + i);
            any[i] |= index;
            all[i] &= index - limit;
        }
    for (; k < last; k++) {
        any[0] |= narc_index_at(column, k);
        all[0] &= narc_index_at(column, k) - limit;
    }
    const uint32_t one = any[0] | any[1] | any[2] | any[3], every = all[0] & all[1] & all[2] & all[3];
    return (~one & every) >> 31;
}

/* Are all bodies that pairs first .. last - 1 name there? */
static bool are_bodies_there(const narc_batch *batch, size_t first, size_t last) {
    const narc_index_column a = batch->pairs->a, b = batch->pairs->b;
    const ptrdiff_t item = sizeof(uint32_t);
    if (a.stride == 2 * item && b.stride == 2 * item && b.base == a.base + 1 && batch->a->count == batch->b->count)
        return are_below((narc_index_column){a.base, item}, 2 * first, 2 * last,
                         clip(batch->a->count)); /* one column */
    return (!a.base || are_below(a, first, last, clip(batch->a->count))) &&
           (!b.base || are_below(b, first, last, clip(batch->b->count)));
}

/* A search for what is wrong, part by part. */
struct search {
    const narc_batch *batch;
    narc_index_column column; /* or without a batch: are all of its items below the limit? */
    size_t limit;
    const narc_shapes *shapes; /* or are the bodies that they name there, and their shapes? */
    const narc_bodies *bodies;
    size_t first, count, parts;
    atomic_bool fine;
    atomic_size_t bad; /* the first that was found */
};

/* The range of a part. */
static void find_part(const struct search *search, size_t part, size_t *out_first, size_t *out_end) {
    const size_t start = part * PART, left = search->count - start;
    *out_first = search->first + start;
    *out_end = search->first + start + (left < PART ? left : PART);
}

/* Are the shapes of a part of some bodies there? */
static bool are_shapes_there(const narc_batch *batch, const narc_bodies *bodies, size_t parts, size_t part) {
    const size_t bodies_in_part = bodies->count / parts + 1, body = part * bodies_in_part;
    const size_t rest = bodies->count > body ? bodies->count - body : 0;
    const size_t end = body + (rest < bodies_in_part ? rest : bodies_in_part);
    return are_below(bodies->shape, body, end, clip(batch->shapes->count));
}

static bool is_one_set(const narc_batch *batch) {
    return batch->a->shape.base == batch->b->shape.base && batch->a->shape.stride == batch->b->shape.stride &&
           batch->a->count == batch->b->count;
}

/* Are all bodies of a part's pairs in range, and all shapes of a part of the bodies? Reads columns from front to back,
 * which is much faster than looking up every pair's bodies. */
static void look_at_columns(void *argument, size_t part) {
    struct search *const search = argument;
    const narc_batch *batch = search->batch;
    size_t first, end;
    find_part(search, part, &first, &end);
    if (!are_bodies_there(batch, first, end) || !are_shapes_there(batch, batch->a, search->parts, part) ||
        !(is_one_set(batch) || are_shapes_there(batch, batch->b, search->parts, part)))
        atomic_store_explicit(&search->fine, false, memory_order_relaxed);
}

/* The body of an item: that in the column, or without one that of the same number. */
static size_t find_named(narc_index_column column, size_t item) {
    return column.base ? narc_index_at(column, item) : item;
}

static bool is_body_fine(const narc_shapes *shapes, narc_index_column column, const narc_bodies *bodies, size_t item) {
    const size_t body = find_named(column, item);
    return body < bodies->count && narc_index_at(bodies->shape, body) < shapes->count;
}

/* Asks the cache for the shape of B of a pair that is looked at later. */
static void fetch_shape(const narc_batch *batch, size_t place) {
    const size_t pair = narc_pair_at(batch, place);
    if (pair < batch->pairs->count)
        FETCH(narc_at(batch->b->shape.base, batch->b->shape.stride, find_named(batch->pairs->b, pair)));
}

/* The first place from `place` on of a pair that is not fine, or `end`. */
static size_t find_bad_place(const narc_batch *batch, size_t place, size_t end) {
    enum { AHEAD = 16 };
    for (; place < end; place++) {
        if (FETCHES && end - place > AHEAD)
            fetch_shape(batch, place + AHEAD);
        const size_t pair = narc_pair_at(batch, place);
        if (pair >= batch->pairs->count || !is_body_fine(batch->shapes, batch->pairs->a, batch->a, pair) ||
            !is_body_fine(batch->shapes, batch->pairs->b, batch->b, pair))
            break;
    }
    return place;
}

/* Keeps the first of what is bad. */
static void keep_first(struct search *search, size_t bad) {
    size_t known = atomic_load_explicit(&search->bad, memory_order_relaxed);
    while (bad < known && !atomic_compare_exchange_weak_explicit(&search->bad, &known, bad, memory_order_relaxed,
                                                                 memory_order_relaxed))
        continue;
}

static void look_at_pairs(void *argument, size_t part) {
    struct search *const search = argument;
    size_t place, end;
    find_part(search, part, &place, &end);
    place = find_bad_place(search->batch, place, end);
    if (place < end)
        keep_first(search, place);
}

size_t narc_find_bad_pair(const narc_batch *batch) {
    const size_t first = batch->first, count = batch->count;
    if (count < FEW)
        return find_bad_place(batch, first, first + count);
    struct search search = {.batch = batch, .first = first, .count = count, .parts = (count - 1) / PART + 1};
    atomic_init(&search.fine, true);
    atomic_init(&search.bad, first + count);
    /* With many more bodies than pairs it is better to look up those that are named. A body that no pair names may have
     * any shape, so what the quick way finds wrong is looked at again. */
    const size_t others = is_one_set(batch) ? 0 : batch->b->count;
    if (!batch->query->selection.base && (batch->a->count + others) / 4 <= count) {
        narc_run_parts(batch->query->workers, search.parts, look_at_columns, &search);
        if (atomic_load(&search.fine))
            return first + count;
    }
    narc_run_parts(batch->query->workers, search.parts, look_at_pairs, &search);
    return atomic_load(&search.bad);
}

static void look_at_items(void *argument, size_t part) {
    struct search *const search = argument;
    size_t item, end;
    find_part(search, part, &item, &end);
    if (are_below(search->column, item, end, clip(search->limit)))
        return;
    while (item < end && narc_index_at(search->column, item) < search->limit)
        item++;
    if (item < end)
        keep_first(search, item);
}

size_t narc_find_bad_index(narc_index_column column, size_t first, size_t count, size_t limit,
                           const narc_workers *workers) {
    struct search search = {.column = column, .limit = limit, .first = first, .count = count};
    atomic_init(&search.bad, first + count);
    narc_run_parts(workers, count / PART + (count % PART != 0), look_at_items, &search);
    return atomic_load(&search.bad);
}

static void look_at_named(void *argument, size_t part) {
    struct search *const search = argument;
    size_t item, end;
    find_part(search, part, &item, &end);
    while (item < end && is_body_fine(search->shapes, search->column, search->bodies, item))
        item++;
    if (item < end)
        keep_first(search, item);
}

narc_status narc_check_named(const narc_shapes *shapes, const narc_bodies *bodies, narc_index_column column,
                             size_t count, const char *item, const narc_workers *workers, narc_error *error) {
    struct search search = {.shapes = shapes, .bodies = bodies, .column = column, .count = count};
    atomic_init(&search.bad, count);
    narc_run_parts(workers, count / PART + (count % PART != 0), look_at_named, &search);
    const size_t bad = atomic_load(&search.bad), body = bad < count ? find_named(column, bad) : 0;
    if (bad == count)
        return NARC_OK;
    if (body >= bodies->count)
        return narc_fail(error, NARC_ERROR_INDEX, bad, (double)body,
                         "%s %zu: the body is %zu, but there are %zu bodies", item, bad, body, bodies->count);
    const uint32_t shape = narc_index_at(bodies->shape, body);
    return narc_fail(error, NARC_ERROR_INDEX, bad, shape, "%s %zu: body %zu has shape %lu, but there are %zu shapes",
                     item, bad, body, (unsigned long)shape, shapes->count);
}

/* ------------------------------------------------------------------------------------------------ the whole */

narc_status narc_check_set(const narc_bodies *bodies, narc_error *error) {
    narc_status status = narc_check_count(bodies->count, UINT32_MAX, "bodies", error);
    if (status == NARC_OK)
        status = CHECK_RESERVED(*bodies, "bodies", error);
    return status == NARC_OK && bodies->count > 0 ? narc_check_columns(bodies, error) : status;
}

narc_status narc_check_indexed(const narc_index *index, const narc_bodies *bodies, narc_error *error) {
    if (bodies->count != index->count)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)bodies->count,
                         "%zu bodies, but the index was built from %zu boxes", bodies->count, index->count);
    return narc_check_set(bodies, error);
}

narc_status narc_check_search(const narc_index *index, const narc_index_query *query, const char *name,
                              narc_error *error) {
    const narc_owners *const owners = query->owners;
    if (owners && !owners->owner.base && index->count > 0)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s.owners->owner is NULL", name);
    for (size_t k = 0; owners && k < sizeof owners->reserved / sizeof(void *); k++)
        if (owners->reserved[k])
            return narc_fail(error, NARC_ERROR_ARGUMENT, k, 0, "%s.owners->reserved[%zu] is not NULL", name, k);
    if (query->world.base && !index->worlds && index->count > 0)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0,
                         "%s.world is asked for, but the index was built without worlds", name);
    return CHECK_RESERVED(*query, name, error);
}

narc_status narc_check_bodies(const narc_shapes *shapes, const narc_bodies *bodies, size_t first, size_t *count,
                              const narc_workers *workers, narc_error *error) {
    narc_status status = narc_check_set(bodies, error);
    if (status == NARC_OK)
        status = narc_check_range(first, count, bodies->count, "bodies", error);
    if (status != NARC_OK)
        return status;
    const size_t bad = narc_find_bad_index(bodies->shape, first, *count, shapes->count, workers);
    if (bad == first + *count)
        return NARC_OK;
    const uint32_t shape = narc_index_at(bodies->shape, bad);
    return narc_fail(error, NARC_ERROR_INDEX, bad, shape, "body %zu: shape is %lu, but there are %zu shapes", bad,
                     (unsigned long)shape, shapes->count);
}

/* Says what of the pair at a place is out of range. */
static narc_status describe_bad_pair(const narc_batch *batch, size_t place, narc_error *error) {
    const size_t pair = narc_pair_at(batch, place);
    if (pair >= batch->pairs->count)
        return narc_fail(error, NARC_ERROR_INDEX, place, (double)pair,
                         "query.selection[%zu] is pair %zu, but there are %zu pairs", place, pair, batch->pairs->count);
    for (int side = 0; side < 2; side++) {
        const narc_index_column column = side == 0 ? batch->pairs->a : batch->pairs->b;
        const narc_bodies *set = side == 0 ? batch->a : batch->b;
        const size_t body = column.base ? narc_index_at(column, pair) : pair;
        if (body >= set->count)
            return narc_fail(error, NARC_ERROR_INDEX, pair, (double)body,
                             "pair %zu: body %c is %zu, but there are %zu bodies", pair, "ab"[side], body,
                             set -> count);
        const struct narc_side s = narc_find_side(batch, pair, side);
        if (s.shape >= batch->shapes->count)
            return narc_fail(error, NARC_ERROR_INDEX, pair, s.shape,
                             "pair %zu: body %zu has shape %lu, but there are %zu shapes", pair, s.body,
                             (unsigned long)s.shape, batch->shapes->count);
    }
    return NARC_OK;
}

narc_status narc_fill_batch(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                            const narc_query *query, narc_batch *out_batch, narc_error *error) {
    static const narc_query defaults = {0};
    if (!shapes || !bodies || !pairs)
        return narc_fail_missing(error, !shapes ? "shapes" : !bodies ? "bodies" : "pairs");
    const narc_query *const q = query ? query : &defaults;
    narc_status status = narc_check_count(pairs->count, UINT32_MAX, "pairs in one batch", error);
    if (status == NARC_OK)
        status = check_query(q, pairs->count, error);
    if (status == NARC_OK)
        status = CHECK_RESERVED(*pairs, "pairs", error);
    if (status != NARC_OK)
        return status;
    out_batch->shapes = shapes; /* one by one: `filled` is large, and mostly not needed */
    out_batch->pairs = pairs;
    out_batch->query = q;
    out_batch->row_size = out_batch->more_at = 0;
    out_batch->of_casts = false;
    out_batch->first = q->first;
    out_batch->count = q->count;
    out_batch->asked = q->selection.base || q->selection.stride ? q->selection_count : pairs->count;
    status = narc_check_range(q->first, &out_batch->count, out_batch->asked, "pairs", error);
    return status != NARC_OK || out_batch->count == 0 ? status : find_sets(bodies, pairs, out_batch, error);
}

narc_status narc_begin_batch(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                             const narc_query *query, narc_batch *out_batch, narc_error *error) {
    const narc_status status = narc_fill_batch(shapes, bodies, pairs, query, out_batch, error);
    if (status != NARC_OK || out_batch->count == 0)
        return status;
    const size_t bad = narc_find_bad_pair(out_batch);
    return bad < out_batch->first + out_batch->count ? describe_bad_pair(out_batch, bad, error) : NARC_OK;
}
