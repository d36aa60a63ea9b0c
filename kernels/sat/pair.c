/* SPDX-License-Identifier: MIT
 *
 * pair.c - the pair kernel: one pair by itself, with one lane. The functions are those of all pairs, one after the other,
 * and so are the bits; there is no block, and no queue has more than one pair. What only the whole formula decides (but
 * in WebAssembly), what more than two edges of boxes may, pieces of chains and pairs without an answer are left to the other
 * kernels.
 *
 * Without vectors there is no kernel but in narc_small.wasm: all is left. SSE4.1's lanes take more instructions and text than plain C.
 */
#define NARC_ONE_PAIR
#undef NARC_SIMD
#ifdef __AVX2__
#define NARC_SIMD "simd/one.h"
#else
#define NARC_SIMD "simd/scalar.h"
#endif

#include <stdbool.h>
#include <stdint.h>

#include "kernels.h"

/* What becomes of a pair. */
enum { UNANSWERED = -1, WITHOUT_ROW, WITH_ROW };

#if NARC_SHORTCUTS && (defined(__SSE4_1__) || defined(__ARM_NEON) || defined(__wasm_simd128__) || NARC_SMALL)

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

/* The call of one pair. No initialiser: that would clear much that nobody reads. */
INLINE void start_one(const narc_one_pair *asked, struct call *call, struct rows *out_rows) {
    call->batch = asked->batch;
    call->first = asked->number;
    call->margin = asked->margin;
    call->kind = asked->manifold ? MANIFOLD_ROWS : CONTACT_ROWS;
    call->rows = out_rows;
    call->bits = NULL;
    out_rows->out.base = asked->out_row;
    out_rows->known[0] = 0;
}

/* Where there is no contact the row is as dense ones are. */
INLINE int write_none(const struct call *call) {
    if (call->kind == MANIFOLD_ROWS)
        write_no_manifold(call->rows->out.base, (uint32_t)call->first, 0);
    else
        write_no_contact(call->rows->out.base, (uint32_t)call->first, 0);
    return WITHOUT_ROW;
}

INLINE int end_one(const struct call *call) { return call->rows->known[0] ? WITH_ROW : write_none(call); }

INLINE struct placement place_one(const narc_one_pair *asked) {
    const narc_body *const a = asked->a, *const b = asked->b;
    /* One by one: a load of both would wait for a caller's stores of each. */
    const struct body_pair bodies = {{v_set((float)(b->x - a->x)), v_set((float)(b->y - a->y))},
                                     {v_set(a->cosine), v_set(a->sine)},
                                     {v_set(b->cosine), v_set(b->sine)},
                                     v_set(a->scale),
                                     v_set(b->scale)};
    return place_bodies(&bodies, v_set(asked->margin));
}

INLINE struct filter set_up_one(const struct call *call, const narc_one_pair *asked, vf item[FIELDS]) {
    const struct placement placement = place_one(asked);
    struct pair_indices in;
    in.shape_a[0] = (int32_t)asked->a->shape;
    in.shape_b[0] = (int32_t)asked->b->shape;
    return set_up_pairs(call, &in, 0, &placement, vm_front(1), 0, item);
}

INLINE void fill_one(struct queue *queue, const vf item[FIELDS]) {
    UNROLL
    for (int f = 0; f < ROW_FIELDS; f++)
        store_field(queue->item[f], item[f]);
    queue->count = 1;
}

/* In WebAssembly's modules there are no other kernels of one lane, and a batch of one pair takes twice the time. */
#ifdef __wasm__
enum { HAS_FORMULA = 1 };
#else
enum { HAS_FORMULA = 0 };
#endif

/* What waits for the deciding formula, where the walk past two junctions tells it: settles it, or returns false. */
INLINE bool decide_one(const struct call *call, struct queue *queues) {
    const struct queue *const queue = &queues[DECIDE];
    const vm live = vm_front(1);
    vm certain;
    struct gap gap = walk_near(call->batch->shapes->records, queue, 0, live, &certain);
    if (HAS_FORMULA && !vm_any(certain))
        gap = find_gap(call->batch->shapes, queue, 0, live, true);
    if ((!HAS_FORMULA && !vm_any(certain)) || vm_any(find_loose(call, queue, 0, live, &gap)))
        return false;
    if (vm_any(is_below(gap.separation, get_margins(call, queue, 0))))
        settle(call, queues, queue, 0, live, gap.separation, v2_divide(gap.normal, gap.length), gap.record_a,
               gap.record_b);
    return true;
}

/* The last stages. */
NOINLINE int finish_one(const struct call *call, struct queue *queues) {
    if (queues[DECIDE].count > 0 && !decide_one(call, queues))
        return UNANSWERED;
    const bool edges = queues[ANSWER_EDGES].count > 0;
    if (edges || queues[ANSWER].count > 0)
        answer_settled(call, queues, 0, edges);
    return end_one(call);
}

/* All that is searched for, in the order of rows.c's stages. `polygons`: two polygons, sharp or each with corners of one
 * radius. Equal radii only take their sum from every gap. */
NOINLINE int search_one(const narc_one_pair *asked, bool polygons) {
    struct queue queues[STAGES];
    struct found_arcs arcs;
    struct call call;
    struct rows found;
    vf item[FIELDS];
    start_one(asked, &call, &found);
    const struct filter circles = set_up_one(&call, asked, item);
    if (vm_any(vm_or(circles.invalid, circles.apart)))
        return vm_any(circles.invalid) ? UNANSWERED : write_none(&call);
    for (int s = 0; s < STAGES; s++)
        queues[s].count = 0;
    if (polygons) {
        fill_one(&queues[POLYGONS], item);
        compare_edges(&call, queues, 0);
        if (queues[POLYGONS].count > 0)
            answer_compared(&call, queues, 0, asked->manifold);
        return queues[DECIDE].count > 0 ? finish_one(&call, queues) : end_one(&call);
    }
    for (int s = PROBE; s <= CLIMB; s++) {
        queues[s].record_a = arcs.record_a;
        queues[s].record_b = arcs.record_b;
    }
    const bool smooth = vm_any(both_have(item, NARC_SHAPE_SMOOTH));
    fill_one(&queues[smooth ? PROBE : CLIMB], item);
    if (smooth)
        probe_axis(&rows, &call, queues, 0);
    if (queues[PROBE_AGAIN].count > 0)
        probe_again(&rows, &call, queues, 0);
    if (queues[CLIMB].count > 0)
        climb_from(&rows, &call, queues, 0);
    return finish_one(&call, queues);
}

/* Two boxes or two capsules. */
INLINE int find_of_forms(const narc_one_pair *asked, bool capsules) {
    struct box_queue queue = {.count = 0};
    struct call call;
    struct rows found;
    const narc_box_form *const forms = asked->batch->shapes->boxes;
    const int32_t shape_a = (int32_t)asked->a->shape, shape_b = (int32_t)asked->b->shape;
    const struct box_form a = load_box_forms(forms, &shape_a), b = load_box_forms(forms, &shape_b);
    const struct placement placement = place_one(asked);
    start_one(asked, &call, &found);
    const vm taken = capsules ? take_capsules(&call, &a, &b, &placement, placement.in_range, 0, &queue)
                              : take_boxes(&call, &a, &b, &placement, placement.in_range, 0, &queue);
    if (!vm_any(taken))
        return search_one(asked, !capsules);
    if (queue.count > 0 && !answer_boxes(&call, &queue, 0, 1, capsules, asked->manifold))
        return UNANSWERED;
    return end_one(&call);
}

NOINLINE int find_of_boxes(const narc_one_pair *asked) { return find_of_forms(asked, false); }

NOINLINE int find_of_capsules(const narc_one_pair *asked) { return find_of_forms(asked, true); }

/* A circle, and any shape that has a form. Whether two circles touch can't be foreseen: all is found and written without a
 * branch, if need be to nowhere. */
INLINE int find_with_circle(const narc_one_pair *asked, enum circle_pairs of) {
    struct call call;
    struct rows found;
    struct circle_pair pair;
    const narc_box_form *const forms = asked->batch->shapes->boxes;
    const int32_t shape_a = (int32_t)asked->a->shape, shape_b = (int32_t)asked->b->shape;
    const struct box_form a = load_box_forms(forms, &shape_a), b = load_box_forms(forms, &shape_b);
    const struct placement placement = place_one(asked);
    char spare[sizeof(narc_manifold)];
    start_one(asked, &call, &found);
    const struct circle_verdict verdict = judge_circles(&call, &a, &b, &placement, placement.in_range, 0, of, &pair);
    if (!vm_any(of == TWO_CIRCLES ? verdict.known : verdict.near))
        return vm_any(verdict.taken) ? write_none(&call) : search_one(asked, false);
    const struct circle_contact c = find_circle_contact(&pair, of);
    const bool touch = vm_any(v_lt(c.separation, v_set(asked->margin)));
    char *place = asked->out_row;
    if (of == TWO_CIRCLES) {
        write_none(&call);
        place = choose(touch, place, spare);
    } else if (!touch) {
        return write_none(&call);
    }
    write_circles(&call, &pair, &c, vi_set(0), of, &place);
    return touch ? WITH_ROW : WITHOUT_ROW;
}

NOINLINE int find_beside_a(const narc_one_pair *asked) { return find_with_circle(asked, CIRCLE_IS_FIRST); }

NOINLINE int find_beside_b(const narc_one_pair *asked) { return find_with_circle(asked, CIRCLE_IS_LAST); }

int NARC_ISA_SYMBOL(narc_pair_, NARC_ISA_NAME)(const narc_one_pair *asked) {
    const narc_shapes *const shapes = asked->batch->shapes;
    const uint32_t a = asked->a->shape, b = asked->b->shape;
    const uint32_t form_a = shapes->boxes[a].info, form_b = shapes->boxes[b].info;
    if (form_a & form_b & NARC_IS_CIRCLE)
        return find_with_circle(asked, TWO_CIRCLES);
    if (form_a & form_b & NARC_IS_BOX)
        return find_of_boxes(asked);
    if (form_a & form_b & NARC_IS_CAPSULE)
        return find_of_capsules(asked);
    if ((form_a | form_b) & (NARC_IS_PLANE | NARC_HAS_FRONT))
        return UNANSWERED;
    if ((form_a | form_b) & NARC_IS_CIRCLE && narc_has_form(&shapes->boxes[a]) && narc_has_form(&shapes->boxes[b]))
        return form_a & NARC_IS_CIRCLE ? find_beside_a(asked) : find_beside_b(asked);
    const uint32_t polygons = NARC_IS_POLYGON | NARC_IS_BOX;
    return search_one(asked, form_a & polygons && form_b & polygons);
}

#else

int NARC_ISA_SYMBOL(narc_pair_, NARC_ISA_NAME)(const narc_one_pair *asked) {
    (void)asked;
    return UNANSWERED;
}

#endif
