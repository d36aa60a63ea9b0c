/* SPDX-License-Identifier: MIT
 *
 * lanes.inl - how pairs take turns in the lanes of a vector, and where they go when they are done.
 *
 * Pairs need different numbers of steps. Each lane works on one pair, and takes the next one of a queue when it is
 * done: so all lanes are busy until the queue is empty.
 */
#ifndef NARC_METHODS_LANES_INL
#define NARC_METHODS_LANES_INL

#include <stdbool.h>
#include <stdint.h>

#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/queue.inl"
#include "base/vec2.inl"
#include "methods/run.inl"
#include "methods/simplex.inl"
#include "simd/simd.h"

struct lanes {
    struct queue pair;    /* the first V_WIDTH items */
    int32_t age[V_WIDTH]; /* steps done; -1: the lane is idle */
    int from[V_WIDTH];    /* the place in the queue */
    bool begins[V_WIDTH]; /* has the lane just taken a pair? */
    int next;             /* the first pair of the queue that no lane has taken */
};

static inline void copy_item(const struct queue *from, int i, struct queue *to, int k) {
    for (int f = 0; f < FIELDS; f++)
        to->item[f][k] = from->item[f][i];
}

static inline void start_lanes(struct lanes *lanes, int begin) {
    lanes->next = begin;
    lanes->pair.count = 0;
    pad(&lanes->pair);
    for (int lane = 0; lane < V_WIDTH; lane++)
        lanes->age[lane] = -1;
}

/* Gives the idle lanes something to do. False if none has. */
static inline bool fill_lanes(struct lanes *lanes, const struct queue *queue) {
    bool busy = false;
    for (int lane = 0; lane < V_WIDTH; lane++) {
        lanes->begins[lane] = lanes->age[lane] < 0 && lanes->next < queue->count;
        if (lanes->begins[lane]) {
            lanes->from[lane] = lanes->next;
            copy_item(queue, lanes->next++, &lanes->pair, lane);
            lanes->age[lane] = 0;
        }
        busy = busy || lanes->age[lane] >= 0;
    }
    return busy;
}

/* Another step is done; the lanes `done` are idle. */
INLINE void end_step(struct lanes *lanes, vm done) {
    const vi age = vi_load(lanes->age), idle = vi_set(-1);
    vi_store(lanes->age, vi_select(vm_or(done, vi_lt(age, vi_set(0))), idle, vi_add(age, vi_set(1))));
}

/* Fields of a pair that a search has no more use for hold what it has found; record_a and record_b the arcs. */
enum { FOUND_SEPARATION = CORE, FOUND_NORMAL = DIRECTION, FOUND_POINT = AXIS };

/* Appends the pairs of the lanes `which`, with what was found of them, to a queue. */
INLINE void append_found(const struct lanes *lanes, vm which, const struct best *best, struct queue *found) {
    static const int fields[] = {FOUND_SEPARATION, FOUND_NORMAL, FOUND_NORMAL + 1, FOUND_POINT, FOUND_POINT + 1};
    const vf values[] = {best->separation, best->n.x, best->n.y, best->across, best->along};
    enum { COUNT = sizeof fields / sizeof fields[0] };
    float value[COUNT][V_WIDTH];
    int32_t record[2][V_WIDTH];
    for (int f = 0; f < COUNT; f++)
        v_store(value[f], values[f]);
    vi_store(record[0], best->record_a);
    vi_store(record[1], best->record_b);
    for (uint32_t bits = vm_bits(which); bits; bits &= bits - 1) {
        const int lane = FIND_LOWEST(bits), k = found->count++;
        copy_item(&lanes->pair, lane, found, k);
        for (int f = 0; f < COUNT; f++)
            found->item[fields[f]][k] = value[f][lane];
        found->record_a[k] = record[0][lane];
        found->record_b[k] = record[1][lane];
    }
}

/* The radii of the arcs in some records. */
INLINE vf load_radii(const narc_record *records, vi record, vf scale) {
    int32_t index[V_WIDTH];
    vf circle[4];
    vi_store(index, record);
    v_rows(records, sizeof *records, index, circle);
    return v_mul(circle[2], scale);
}

/* What was found of the pairs k ... on one body; a point is across and along. */
INLINE struct feature find_found(const struct call *call, const struct queue *queue, int k, vec2 point,
                                 const int32_t *records, int scale) {
    const vi record = vi_select(vm_front(queue->count - k), vi_load(records + k), vi_set(0));
    return (struct feature){.across = point.x,
                            .along_min = point.y,
                            .along_max = point.y,
                            .record = record,
                            .radius = load_radii(call->batch->shapes->records, record, get(queue, scale, k))};
}

/* Stores the contacts of such a queue. */
static inline void store_found(const struct call *call, const struct queue *queue) {
    for (int k = 0; k < queue->count; k += V_WIDTH) {
        const vf separation = get(queue, FOUND_SEPARATION, k);
        const vec2 n = get_vec2(queue, FOUND_NORMAL, k), point = get_vec2(queue, FOUND_POINT, k);
        const struct feature on_a = find_found(call, queue, k, point, queue->record_a, SCALE_A);
        const struct feature on_b = find_found(call, queue, k, point, queue->record_b, SCALE_B);
        const vm keep = vm_and(vm_front(queue->count - k), is_below(separation, get_margins(call, queue, k)));
        store_contacts(call, queue, k, keep, separation, n, &on_a, &on_b);
    }
}

#endif
