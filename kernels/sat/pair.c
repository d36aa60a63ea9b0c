/* SPDX-License-Identifier: MIT
 *
 * pair.c - the pair kernel: one pair by itself, with one lane. The functions are those of all pairs, one after the other,
 * and so are the bits; there is no block, and no queue has more than one pair. What only the whole formula decides, what
 * more than two edges of boxes may, pieces of chains and pairs without an answer are left to the other kernels.
 *
 * Without vectors there is no kernel: all is left. SSE4.1's lanes take more instructions and text than plain C.
 */
#define NARC_ONE_PAIR
#undef NARC_SIMD
#ifdef __AVX__
#define NARC_SIMD "simd/one.h"
#else
#define NARC_SIMD "simd/scalar.h"
#endif

#include <stdbool.h>
#include <stdint.h>

#include "kernels.h"

/* What becomes of a pair. */
enum { UNANSWERED = -1, WITHOUT_ROW, WITH_ROW };

#if NARC_SHORTCUTS && (defined(__SSE4_1__) || defined(__ARM_NEON))

#include "base/call.inl"
#include "base/pair_setup.inl"
#include "base/question.inl"
#include "base/queue.inl"
#include "base/rows.inl"
#include "base/vec2.inl"
#include "box/box_pairs.inl"
#include "box/box_rows.inl"
#include "box/capsules.inl"
#include "box/circles.inl"
#include "sat/answers.inl"
#include "sat/certificates.inl"
#include "sat/faces.inl"
#include "sat/normal_fan.inl"
#include "sat/row_stages.inl"
#include "sat/search.inl"
#include "sat/stages.inl"
#include "simd/simd.h"

/* The call of one pair. */
struct one {
    struct call call;
    struct rows rows;
    struct placement placement;
};

static const struct question contacts = {.kind = CONTACT_ROWS}, manifolds = {.kind = MANIFOLD_ROWS};

/* No initialiser: that would clear much that nobody reads. */
INLINE void start_one(struct one *one, const narc_batch *batch, const narc_one_pair *at, bool manifold, void *out) {
    const struct body_pair bodies = {{v_set(at->x), v_set(at->y)},
                                     {v_set(at->cosine_a), v_set(at->sine_a)},
                                     {v_set(at->cosine_b), v_set(at->sine_b)},
                                     v_set(at->scale_a),
                                     v_set(at->scale_b)};
    one->call.batch = batch;
    one->call.first = at->number;
    one->call.margin = at->margin;
    one->call.question = manifold ? &manifolds : &contacts;
    one->call.rows = &one->rows;
    one->call.bits = NULL;
    one->rows.out.base = out;
    one->rows.dense = false;
    one->rows.known[0] = 0;
    one->placement = place_bodies(&bodies, v_set(at->margin));
}

INLINE int end_one(const struct one *one) { return one->rows.known[0] ? WITH_ROW : WITHOUT_ROW; }

INLINE struct filter set_up_one(const struct one *one, const narc_one_pair *at, vf item[FIELDS]) {
    struct pair_indices in;
    in.shape_a[0] = (int32_t)at->shape_a;
    in.shape_b[0] = (int32_t)at->shape_b;
    return set_up_pairs(&one->call, &in, 0, &one->placement, vm_front(1), 0, item);
}

/* What waits for the deciding formula, where the walk past two junctions tells it: settles it, or returns false. */
INLINE bool decide_one(const struct call *call, struct queue *queues) {
    const struct queue *const queue = &queues[DECIDE];
    const vm live = vm_front(1);
    vm certain;
    const struct gap gap = walk_near(call->batch->shapes->records, queue, 0, live, &certain);
    if (!vm_any(certain) || vm_any(find_loose(call, queue, 0, live, &gap)))
        return false;
    if (vm_any(is_below(gap.separation, get_margins(call, queue, 0))))
        settle(call, queues, queue, 0, live, gap.separation, v2_divide(gap.normal, gap.length), gap.record_a,
               gap.record_b);
    return true;
}

/* Pairs of polygons and all that is searched for, in the order of rows.c's stages. */
NOINLINE int search_one(struct one *one, const narc_one_pair *at, bool manifold) {
    struct queue queues[STAGES];
    struct found_arcs arcs;
    vf item[FIELDS];
    const struct filter circles = set_up_one(one, at, item);
    if (vm_any(vm_or(circles.invalid, circles.apart)))
        return vm_any(circles.invalid) ? UNANSWERED : WITHOUT_ROW;
    for (int s = 0; s < STAGES; s++)
        queues[s].count = 0;
    const struct call *const call = &one->call;
    const bool polygons = vm_any(are_polygons(vm_front(1), item[INFO_A], item[INFO_B])),
               smooth = !polygons && vm_any(both_have(item, NARC_SHAPE_SMOOTH));
    for (int s = PROBE; s <= CLIMB; s++)
        start_queue(&queues[s], &arcs);
    push(&queues[polygons ? POLYGONS : smooth ? PROBE : CLIMB], vm_front(1), item, ROW_FIELDS);
    if (polygons)
        compare_edges(call, queues, 0);
    if (queues[POLYGONS].count > 0)
        answer_compared(call, queues, 0, manifold);
    if (smooth)
        probe_axis(&rows, call, queues, 0);
    if (queues[PROBE_AGAIN].count > 0)
        probe_again(&rows, call, queues, 0);
    if (queues[CLIMB].count > 0)
        climb_from(&rows, call, queues, 0);
    if (queues[DECIDE].count > 0 && !decide_one(call, queues))
        return UNANSWERED;
    const bool edges = queues[ANSWER_EDGES].count > 0;
    if (edges || queues[ANSWER].count > 0)
        answer_settled(call, queues, 0, edges);
    return end_one(one);
}

/* Two boxes or two capsules. */
INLINE int find_of_forms(struct one *one, const narc_one_pair *at, bool manifold, bool capsules) {
    struct box_queue queue = {.count = 0};
    const narc_box_form *const forms = one->call.batch->shapes->boxes;
    const int32_t shape_a = (int32_t)at->shape_a, shape_b = (int32_t)at->shape_b;
    const struct box_form a = load_box_forms(forms, &shape_a), b = load_box_forms(forms, &shape_b);
    const vm in_range = one->placement.in_range;
    const vm taken = capsules ? take_capsules(&one->call, &a, &b, &one->placement, in_range, 0, &queue)
                              : take_boxes(&one->call, &a, &b, &one->placement, in_range, 0, &queue);
    if (!vm_any(taken))
        return search_one(one, at, manifold);
    if (queue.count > 0 && !answer_boxes(&one->call, &queue, 0, 1, capsules, manifold))
        return UNANSWERED;
    return end_one(one);
}

NOINLINE int find_of_boxes(struct one *one, const narc_one_pair *at, bool manifold) {
    return find_of_forms(one, at, manifold, false);
}

NOINLINE int find_of_capsules(struct one *one, const narc_one_pair *at, bool manifold) {
    return find_of_forms(one, at, manifold, true);
}

/* A circle, and any shape that has a form. */
NOINLINE int find_with_circle(struct one *one, const narc_one_pair *at, bool manifold) {
    struct box_queue queue;
    const narc_box_form *const forms = one->call.batch->shapes->boxes;
    const int32_t shape_a = (int32_t)at->shape_a, shape_b = (int32_t)at->shape_b;
    const struct box_form a = load_box_forms(forms, &shape_a), b = load_box_forms(forms, &shape_b);
    queue.count = 0;
    if (!vm_any(take_circles(&one->call, &a, &b, &one->placement, one->placement.in_range, 0, &queue)))
        return search_one(one, at, manifold);
    if (queue.count > 0)
        answer_circles(&one->call, &queue, 0, 1);
    return end_one(one);
}

int NARC_ISA_SYMBOL(narc_pair_, NARC_ISA_NAME)(const narc_batch *batch, const narc_one_pair *at, bool manifold,
                                               void *out_row) {
    const narc_shapes *const shapes = batch->shapes;
    const narc_shape_header *const a = &shapes->headers[at->shape_a], *const b = &shapes->headers[at->shape_b];
    struct one one;
    if (narc_is_piece(a) || narc_is_piece(b))
        return UNANSWERED;
    start_one(&one, batch, at, manifold, out_row);
    const uint32_t form_a = shapes->boxes[at->shape_a].info, form_b = shapes->boxes[at->shape_b].info;
    return (form_a && form_b && (form_a | form_b) & NARC_IS_CIRCLE ? find_with_circle
            : form_a & form_b & NARC_IS_BOX                        ? find_of_boxes
            : form_a & form_b & NARC_IS_CAPSULE                    ? find_of_capsules
                                                                   : search_one)(&one, at, manifold);
}

#else

int NARC_ISA_SYMBOL(narc_pair_, NARC_ISA_NAME)(const narc_batch *batch, const narc_one_pair *at, bool manifold,
                                               void *out_row) {
    (void)batch, (void)at, (void)manifold, (void)out_row;
    return UNANSWERED;
}

#endif
