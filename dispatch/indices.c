/* SPDX-License-Identifier: MIT
 *
 * indices.c - do all pairs name bodies, and all bodies shapes, that exist?
 */
#include "column.h"
#include "dispatch.h"

/* Pairs that one thread looks at in one go: some 50 microseconds of work. A batch of one part needs no threads, and
 * OpenMP is left alone: it takes a quarter of a microsecond even for a team of one. */
enum { PART = 65536 };

static uint32_t larger(uint32_t a, uint32_t b) { return a > b ? a : b; }

/* The largest of items first .. last - 1 of a column. Compilers make vectors of the loop over a plain array; the other
 * one keeps four results, because one comparison would wait for the other. */
static uint32_t find_largest(narc_column column, size_t first, size_t last) {
    uint32_t largest[4] = {0};
    size_t k = first;
    if (column.stride == sizeof(uint32_t)) {
        const uint32_t *index = column.base;
        for (; k < last; k++)
            largest[0] = larger(largest[0], index[k]);
    }
    for (; k + 4 <= last; k += 4)
        for (size_t i = 0; i < 4; i++)
            largest[i] = larger(largest[i], narc_index_at(column, k + i));
    for (; k < last; k++)
        largest[0] = larger(largest[0], narc_index_at(column, k));
    return larger(larger(largest[0], largest[1]), larger(largest[2], largest[3]));
}

/* The largest body that pairs first .. last - 1 name. */
static uint32_t find_largest_body(const narc_pairs *pairs, size_t first, size_t last) {
    const narc_column a = pairs->a, b = pairs->b;
    const size_t item = sizeof(uint32_t);
    if (a.stride == 2 * item && b.stride == 2 * item && (const char *)b.base == (const char *)a.base + item)
        return find_largest((narc_column){a.base, item}, 2 * first, 2 * last); /* both columns are one */
    return larger(find_largest(a, first, last), find_largest(b, first, last));
}

/* Are all bodies of a part's pairs in range, and all shapes of a part of the bodies? Reads columns from front to back,
 * which is much faster than looking up every pair's bodies. */
static bool part_in_range(const narc_batch *batch, size_t first, size_t count, size_t parts, size_t part) {
    const narc_bodies *bodies = batch->bodies;
    const size_t bodies_in_part = bodies->count / parts + 1;
    const size_t start = part * PART, end = count - start < PART ? count : start + PART;
    const size_t body = part * bodies_in_part, rest = bodies->count > body ? bodies->count - body : 0;
    const size_t last_body = body + (rest < bodies_in_part ? rest : bodies_in_part);
    return find_largest_body(batch->pairs, first + start, first + end) < bodies->count &&
           (rest == 0 || find_largest(bodies->shape, body, last_body) < batch->shapes->count);
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

/* The first of pairs first .. last - 1 that names a body or a shape that does not exist; last if none. */
static size_t find_bad_pair(const narc_batch *batch, size_t first, size_t last) {
    const narc_bodies *bodies = batch->bodies;
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
    const size_t parts = (count + PART - 1) / PART;
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
    const size_t parts = (count + PART - 1) / PART;
    const int team = narc_team_size(threads, parts);
    size_t bad = first + count;
    (void)team;
#ifdef _OPENMP
#pragma omp parallel for schedule(static) num_threads(team) reduction(min : bad) if (team > 1)
#endif
    for (size_t part = 0; part < parts; part++) {
        const size_t start = first + part * PART, end = count - part * PART < PART ? first + count : start + PART;
        if (find_largest(bodies->shape, start, end) < shapes->count)
            continue;
        size_t body = start;
        while (narc_index_at(bodies->shape, body) < shapes->count)
            body++;
        bad = body < bad ? body : bad;
    }
    return bad;
}
