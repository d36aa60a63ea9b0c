/* SPDX-License-Identifier: MIT
 *
 * indices.c - do all pairs name bodies, and all bodies shapes, that exist?
 */
#include "column.h"
#include "dispatch.h"

/* Pairs that one thread looks at in one go: some 50 microseconds of work. A batch of one part needs no threads, and
 * OpenMP is left alone: it takes a quarter of a microsecond even for a team of one. */
enum { PART = 65536 };

/* A limit that are_below() can take. What it then finds wrong may be right, and is looked at again. */
static uint32_t clip(size_t limit) { return limit < 0x80000000u ? (uint32_t)limit : 0x80000000u; }

/* Are items first .. last - 1 of a column below `limit`? With limit at most 2^31, the upper bit of k - limit is that of a
 * k below it, if k has none itself. So all that is kept of the items is the union and the intersection of bits: two
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

/* Are all bodies that pairs first .. last - 1 name below `limit`? */
static bool are_bodies_below(const narc_pairs *pairs, size_t first, size_t last, uint32_t limit) {
    const narc_index_column a = pairs->a, b = pairs->b;
    const ptrdiff_t item = sizeof(uint32_t);
    if (a.stride == 2 * item && b.stride == 2 * item && b.base == a.base + 1)
        return are_below((narc_index_column){a.base, item}, 2 * first, 2 * last, limit); /* both columns are one */
    return are_below(a, first, last, limit) && are_below(b, first, last, limit);
}

/* Are all bodies of a part's pairs in range, and all shapes of a part of the bodies? Reads columns from front to back,
 * which is much faster than looking up every pair's bodies. */
static bool part_in_range(const narc_batch *batch, size_t first, size_t count, size_t parts, size_t part) {
    const narc_bodies *bodies = batch->bodies;
    const size_t bodies_in_part = bodies->count / parts + 1;
    const size_t start = part * PART, end = count - start < PART ? count : start + PART;
    const size_t body = part * bodies_in_part, rest = bodies->count > body ? bodies->count - body : 0;
    const size_t last_body = body + (rest < bodies_in_part ? rest : bodies_in_part);
    return are_bodies_below(batch->pairs, first + start, first + end, clip(bodies->count)) &&
           are_below(bodies->shape, body, last_body, clip(batch->shapes->count));
}

/* The same for all parts. */
static bool all_in_range(const narc_batch *batch, size_t first, size_t count, size_t parts, int team) {
    bool fine = true;
    if (team <= 1) {
        for (size_t part = 0; part < parts && fine; part++)
            fine = part_in_range(batch, first, count, parts, part);
        return fine;
    }
#ifdef _OPENMP
#pragma omp parallel for schedule(static) num_threads(team) reduction(&& : fine)
#endif
    for (size_t part = 0; part < parts; part++)
        fine = fine && part_in_range(batch, first, count, parts, part);
    return fine;
}

/* Are the shapes of all bodies that pairs first .. last - 1 name below `limit`? The bodies exist. */
static bool are_shapes_below(const narc_batch *batch, size_t first, size_t last, uint32_t limit) {
    const narc_index_column shape = batch->bodies->shape;
    uint32_t any = 0, all = UINT32_MAX;
    for (size_t pair = first; pair < last; pair++) {
        const uint32_t a = narc_index_at(shape, narc_index_at(batch->pairs->a, pair));
        const uint32_t b = narc_index_at(shape, narc_index_at(batch->pairs->b, pair));
        any |= a | b;
        all &= (a - limit) & (b - limit);
    }
    return (~any & all) >> 31;
}

/* The first of pairs first .. last - 1 that names a body or a shape that does not exist; last if none. */
static size_t find_bad_pair(const narc_batch *batch, size_t first, size_t last) {
    const narc_bodies *bodies = batch->bodies;
    if (are_bodies_below(batch->pairs, first, last, clip(bodies->count)) &&
        are_shapes_below(batch, first, last, clip(batch->shapes->count)))
        return last;
    for (size_t pair = first; pair < last; pair++) {
        const uint32_t a = narc_index_at(batch->pairs->a, pair);
        const uint32_t b = narc_index_at(batch->pairs->b, pair);
        if (a >= bodies->count || b >= bodies->count || narc_index_at(bodies->shape, a) >= batch->shapes->count ||
            narc_index_at(bodies->shape, b) >= batch->shapes->count)
            return pair;
    }
    return last;
}

size_t narc_find_bad_pair(const narc_batch *batch, size_t first, size_t count, unsigned threads) {
    const size_t parts = count / PART + (count % PART != 0);
    const int team = narc_team_size(threads, parts);
    /* With many more bodies than pairs it is better to look up those that are named. A body that no pair names may have
     * any shape, so what the quick way finds wrong is looked at again. */
    if (batch->bodies->count / 4 <= count && all_in_range(batch, first, count, parts, team))
        return first + count;
    size_t bad = first + count;
    if (team <= 1)
        return find_bad_pair(batch, first, bad);
#ifdef _OPENMP
#pragma omp parallel for schedule(static) num_threads(team) reduction(min : bad)
#endif
    for (size_t part = 0; part < parts; part++) {
        const size_t start = part * PART, end = count - start < PART ? count : start + PART;
        const size_t found = find_bad_pair(batch, first + start, first + end);
        if (found < first + end && found < bad)
            bad = found;
    }
    return bad;
}

size_t narc_find_bad_body(const narc_shapes *shapes, const narc_bodies *bodies, size_t first, size_t count,
                          unsigned threads) {
    const size_t parts = count / PART + (count % PART != 0);
    const int team = narc_team_size(threads, parts);
    size_t bad = first + count;
    (void)team;
#ifdef _OPENMP
#pragma omp parallel for schedule(static) num_threads(team) reduction(min : bad) if (team > 1)
#endif
    for (size_t part = 0; part < parts; part++) {
        const size_t start = first + part * PART, end = count - part * PART < PART ? first + count : start + PART;
        if (are_below(bodies->shape, start, end, clip(shapes->count)))
            continue;
        size_t body = start;
        while (body < end && narc_index_at(bodies->shape, body) < shapes->count)
            body++;
        if (body < end && body < bad)
            bad = body;
    }
    return bad;
}
