/* SPDX-License-Identifier: MIT
 *
 * queue.inl - pairs that wait for a stage: dense, structure of arrays.
 */
#ifndef NARC_BASE_QUEUE_INL
#define NARC_BASE_QUEUE_INL

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "base/shape.inl"
#include "base/vec2.inl"
#include "simd/simd.h"

/* Pairs that are loaded at once. */
#ifdef NARC_ONE_PAIR
enum { BLOCK = 1 };
#else
enum { BLOCK = 32 };
#endif

/* A stage waits for FLUSH pairs, so that vectors are full and its code is fetched once for several, and takes STEP at a
 * time as long as the stages behind it have room: so all queues together lie in the first cache, and on a small stack.
 * Those of methods have one stage, overlaps none for polygons, and none that writes rows. */
#if defined(NARC_QUEUE_PAIRS)
enum { FLUSH = NARC_QUEUE_PAIRS, STEP = NARC_QUEUE_PAIRS };
enum { METHOD, STAGES, POLYGONS = 0 };
#elif defined(NARC_OVERLAPS)
enum { FLUSH = 32, STEP = 32 };
enum { PROBE, PROBE_AGAIN, CLIMB, DECIDE, STAGES, POLYGONS = 0 };
#else
#ifdef NARC_ONE_PAIR
enum { FLUSH = 1, STEP = 1 };
#else
enum { FLUSH = V_WIDTH > 8 ? 16 : 24, STEP = FLUSH };
#endif
enum { PROBE, PROBE_AGAIN, CLIMB, POLYGONS, DECIDE, ANSWER, ANSWER_EDGES, STAGES };
#endif

/* A queue has less than FLUSH pairs when a stage before it, or a vector of new pairs, adds STEP at most. push() and
 * pad() write up to a vector behind the last one. */
#ifdef NARC_ONE_PAIR
enum { CAPACITY = 1 };
#else
enum { CAPACITY = FLUSH + STEP + V_WIDTH };
#endif
_Static_assert(STEP % V_WIDTH == 0 && STEP <= FLUSH, "stages take whole vectors");

/* The fields of a pair. Integers are kept as their bits; the two coordinates of a vector follow each other. */
enum {
    POSITION,     /* B's pose in A's frame */
    ROTATION = 2, /* cosine and sine */
    SCALE_A = 4,
    SCALE_B,
    AXIS,           /* from the centre of A's inscribed circle to that of B's */
    CORE = 8,       /* the sum of both inner radii; below 0: room for rounding has used them up */
    SLACK,          /* see find_slack() */
    FIRST_RECORD_A, /* the first two words of the shapes' headers (shape.inl) */
    FIRST_RECORD_B,
    INFO_A,
    INFO_B,
    PAIR,            /* counted from the first of the call */
    DIRECTION,       /* what the next stage probes along, or walks near; at first the axis, or out of a run */
    ROTATION_A = 17, /* A's rotation in the world */
    SIZE = 19,       /* the sum of both bounding radii */
    FIELDS,
    OVERLAP_FIELDS = ROTATION_A, /* overlaps need no rotation */
    ROW_FIELDS = SIZE,
    /* Of pairs whose answer is certain (settle()), in place of what the search needs: along which normal they touch, in
     * A's frame, and with which arcs. */
    NORMAL = AXIS,
    SEPARATION = CORE,
    RECORD_A = SLACK,
    RECORD_B = DIRECTION,
    /* Of pairs with a run of a chain that wait: the shape of the other body. */
    BODY_SHAPE = SIZE
};

/* Those that queues have room for. */
#ifdef NARC_OVERLAPS
enum { QUEUE_FIELDS = OVERLAP_FIELDS };
#else
enum { QUEUE_FIELDS = FIELDS };
#endif

/* A field in a queue: numbers, or of one pair by itself what is in the register. */
#ifdef NARC_ONE_PAIR
typedef vf queue_field;
INLINE vf load_field(const vf *field) { return *field; }
INLINE void store_field(vf *field, vf a) { *field = a; }
#else
typedef float queue_field;
INLINE vf load_field(const float *field) { return v_load(field); }
INLINE void store_field(float *field, vf a) { v_store(field, a); }
#endif

struct queue {
    _Alignas(64) queue_field item[QUEUE_FIELDS][CAPACITY]; /* aligned: whole vectors do not lie across cache lines */
    int32_t *record_a, *record_b;                          /* the arcs that a stage found: push() leaves them out */
    int count;
    int edged, edged_left; /* first stage: pairs with edges that it took, and passed on */
    bool whole;            /* first stage of overlaps: are whole arcs worth their price? */
};

/* Where a stage keeps what it finds. Queues whose stages take turns share one. */
struct found_arcs {
    int32_t record_a[CAPACITY], record_b[CAPACITY];
};

/* An empty queue. */
INLINE void start_queue(struct queue *queue, struct found_arcs *arcs) {
    queue->count = 0;
    queue->edged = queue->edged_left = 0;
    queue->whole = false;
    queue->record_a = arcs->record_a;
    queue->record_b = arcs->record_b;
}

INLINE vf get(const struct queue *queue, int field, int k) { return load_field(queue->item[field] + k); }

INLINE vi get_bits(const struct queue *queue, int field, int k) { return vi_bits(get(queue, field, k)); }

INLINE vec2 get_vec2(const struct queue *queue, int field, int k) {
    return (vec2){get(queue, field, k), get(queue, field + 1, k)};
}

INLINE struct pose get_pose(const struct queue *queue, int k) {
    return (struct pose){get_vec2(queue, POSITION, k), get_vec2(queue, ROTATION, k), get(queue, SCALE_A, k),
                         get(queue, SCALE_B, k)};
}

INLINE struct ring get_ring_a(const struct queue *queue, int k) {
    return make_ring(get_bits(queue, FIRST_RECORD_A, k), get_bits(queue, INFO_A, k));
}

INLINE struct ring get_ring_b(const struct queue *queue, int k) {
    return make_ring(get_bits(queue, FIRST_RECORD_B, k), get_bits(queue, INFO_B, k));
}

INLINE void store_vec2(struct queue *queue, int field, int k, vec2 a) {
    store_field(queue->item[field] + k, a.x);
    store_field(queue->item[field + 1] + k, a.y);
}

/* Are both shapes of the pairs k ... smooth? */
INLINE vm find_smooth(const struct queue *queue, int k) {
    return has_flag(vi_and(get_bits(queue, INFO_A, k), get_bits(queue, INFO_B, k)), NARC_SHAPE_SMOOTH);
}

INLINE vi get_item_bits(const vf item[FIELDS], int field) { return vi_bits(item[field]); }

/* Do both shapes of a pair have a flag? */
INLINE vm both_have(const vf item[FIELDS], int flag) {
    return has_flag(vi_and(get_item_bits(item, INFO_A), get_item_bits(item, INFO_B)), flag);
}

/* Notes how a first stage fared with pairs that have edges: what it took, and what is left of it. */
INLINE void count_edged(struct queue *queue, vm taken, vm left) {
    queue->edged += COUNT_BITS(vm_bits(taken));
    queue->edged_left += COUNT_BITS(vm_bits(left));
}

INLINE void set_vec2(vf *item, int field, vec2 a) {
    item[field] = a.x;
    item[field + 1] = a.y;
}

INLINE void get_item(const struct queue *queue, int k, vf *item, int fields) {
    UNROLL
    for (int f = 0; f < fields; f++)
        item[f] = get(queue, f, k);
}

/* Appends the lanes `keep` of `item`. */
SHARED void push(struct queue *queue, vm keep, const vf *item, int fields) {
    const vp packing = vm_packing(keep);
    const int end = queue->count;
    UNROLL
    for (int f = 0; f < fields; f++)
        store_field(queue->item[f] + end, v_pack(packing, item[f]));
    queue->count = end + COUNT_BITS(vm_bits(keep));
}

/* Passes on the pairs k ... of a queue in the lanes `left`. */
INLINE void pass_on(const struct queue *queue, int k, vm left, int fields, struct queue *to) {
    vf item[FIELDS];
    if (!vm_any(left))
        return;
    if (CAPACITY == 1) {
        memmove(to->item, queue->item, sizeof to->item);
        to->count = 1;
        return;
    }
    get_item(queue, k, item, fields);
    push(to, left, item, fields);
}

/* Fills the rest of a queue's last vector with harmless lanes: one arc, the first of all. */
static inline void pad(struct queue *queue) {
    if (CAPACITY == 1)
        return;
    UNROLL
    for (int f = 0; f < QUEUE_FIELDS; f++)
        store_field(queue->item[f] + queue->count, v_set(0));
    store_field(queue->item[INFO_A] + queue->count, v_of_bits(vi_set(1)));
    store_field(queue->item[INFO_B] + queue->count, v_of_bits(vi_set(1)));
}

/* The numbers of the pairs k ..., counted from the first of the call. */
INLINE void get_pairs(const struct queue *queue, int k, int32_t pair[V_WIDTH]) {
    vi_store(pair, get_bits(queue, PAIR, k));
}

#endif
