/* SPDX-License-Identifier: MIT
 *
 * pipeline.inl - what all kernels do with the pairs of a call: block by block through one stage after another.
 *
 * A pair is set up, and its circles are compared. A triage then answers it or puts it into the queue of the first
 * stage, or of a later one (enter()). Each stage waits for FLUSH pairs, so that vectors are full, and answers
 * them or passes them on; after the last block they take what is left.
 */
#ifndef NARC_BASE_PIPELINE_INL
#define NARC_BASE_PIPELINE_INL

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "base/bodies.inl"
#include "base/call.inl"
#include "base/pair_setup.inl"
#include "base/question.inl"
#include "base/queue.inl"
#include "base/rows.inl"
#include "column.h"
#include "kernels.h"
#include "piece/pieces.inl"
#include "polygon/polygon_edges.inl"
#include "simd/simd.h"

/* Answers what it can of a vector of pairs, the first of which has the number `pair`, and returns the other lanes. */
typedef vm triage(const struct call *call, size_t pair, const struct filter *circles, const vf item[FIELDS]);

/* Takes pairs of a kind that has a way of its own, of those in the lanes `open`, and returns the other lanes. `number`:
 * of the first. */
typedef vm detour(const struct call *call, const struct pair_indices *indices, int k, const struct placement *placement,
                  vm open, int32_t number);

/* Takes pairs of a run and another body in the lanes `open`, and returns those that it does not settle. */
typedef vm settling(const struct call *call, vm open, vf margin, vf item[FIELDS]);

/* The way of a kernel's pairs: constants but for `stages` and `edged`. */
struct course {
    detour *take;   /* if call->boxes: what comes before all else */
    triage *settle; /* what is answered as it is set up; all others go to stage `first` */
    settling *runs; /* if call->runs: what takes pairs with a run; or NULL */
    int fields;     /* what travels from there on */
    stage *const *stages;
    int first;
    int edged; /* where pairs with edges may begin instead, or 0 */
    int end;   /* behind the last stage */
};

/* Triage for methods that treat all pairs alike. */
INLINE vm take_valid(const struct call *call, size_t pair, const struct filter *circles, const vf item[FIELDS]) {
    (void)pair;
    if (call->rows)
        put_no_answer(call, vi_bits(item[PAIR]), circles->invalid);
    return circles->valid;
}

/* Pairs after which the first stage is tried anew with pairs that have edges: later ones may lie otherwise. */
enum { REMEMBERED = 64 * BLOCK };

/* Appends the lanes `open` of `item` to the first stage's queue. Where that one can't answer most of the pairs that
 * have edges, as among bodies that rest on each other, these go to the stage that can; polygons if it can't answer half
 * of them, or `not_first`. */
INLINE void enter(const struct course *course, struct queue *queues, vm open, const vf item[FIELDS], bool not_first) {
    vm here = open;
    if (POLYGONS > 0 && course->first == 0 && (not_first || 2 * queues->edged_left > queues->edged)) {
        const vm polygons = are_polygons(open, item[INFO_A], item[INFO_B]);
        here = vm_and_not(open, polygons);
        if (vm_any(polygons))
            push(&queues[POLYGONS], polygons, item, course->fields);
    }
    if (course->edged > 0 && 4 * queues->edged_left > 3 * queues->edged) {
        const vm edged = vm_and_not(here, both_have(item, NARC_SHAPE_SMOOTH));
        here = vm_and_not(here, edged);
        if (vm_any(edged))
            push(&queues[course->edged], edged, item, course->fields);
    }
    if (vm_any(here))
        push(&queues[course->first], here, item, course->fields);
}

/* The stage that is to take pairs from its queue, or -1. The last one that has FLUSH goes first, so that all before it
 * find room. Those that have less wait, but for the `end`, when the first one goes first. */
INLINE int find_due(const struct course *course, const struct queue *queues, bool end) {
    for (int s = course->end - 1; s >= 0; s--)
        if (queues[s].count >= FLUSH)
            return s;
    for (int s = 0; s < course->end && end; s++)
        if (queues[s].count > 0)
            return s;
    return -1;
}

/* Takes the last pairs of a queue through its stage. */
INLINE void run_stage(const struct call *call, stage *run, struct queue *queues, int s) {
    struct queue *const queue = &queues[s];
    const int begin = queue->count > STEP ? queue->count - STEP : 0;
    if (queue->count % V_WIDTH != 0 && begin == 0)
        pad(queue);
    run(call, queues, begin);
    queue->count = begin;
}

INLINE void run_stages(const struct call *call, const struct course *course, struct queue *queues, bool end) {
    if (call->count <= STEP) { /* no queue can be full: each stage runs once, when all pairs are in */
        for (int s = 0; s < course->end; s++)
            if (queues[s].count > 0)
                run_stage(call, course->stages[s], queues, s);
        return;
    }
    for (int s = find_due(course, queues, end); s >= 0;) {
        run_stage(call, course->stages[s], queues, s);
        const int due = find_due(course, queues, end);
        s = queues[s].count >= STEP && due <= s ? s : due;
    }
}

/* Of which shapes records lie all over the memory: what a pair reads of such is asked of the cache ahead. Fewer are mostly in
 * one of its levels, where waiting costs no more than asking. */
enum { MANY_RECORDS = 1 << 17 };

/* A side of the pairs of a call, from number `first` to before `end`: first what tells the shapes, then the headers, then the
 * records of pieces; `forms`: what circles read of both, instead. */
enum fetching { FETCH_BODIES, FETCH_HEADERS, FETCH_PIECES };

INLINE void fetch_range(const struct call *call, const struct sources *given, bool of_b, bool forms, size_t first,
                        size_t end, enum fetching what) {
    const narc_shapes *const shapes = call->batch->shapes;
    const narc_index_column selection = given->selection, body = of_b ? given->pairs.b : given->pairs.a;
    const narc_index_column shape = of_b ? given->b.shape : given->a.shape;
    for (size_t k = first; k < end && k < call->count; k++) {
        const size_t number = selection.base ? narc_index_at(selection, call->first + k) : call->first + k;
        const size_t own = body.base ? narc_index_at(body, number) : number;
        if (what == FETCH_BODIES)
            FETCH(narc_at(shape.base, shape.stride, own));
        else if (forms && what == FETCH_HEADERS)
            FETCH(&shapes->boxes[narc_index_at(shape, own)]);
        else if (forms && shapes->fronts)
            FETCH(&shapes->fronts[narc_index_at(shape, own)]);
        else if (what == FETCH_HEADERS)
            FETCH(&shapes->headers[narc_index_at(shape, own)]);
        else
            fetch_piece(shapes, &shapes->headers[narc_index_at(shape, own)]);
    }
}

/* What pairs read that come one block, two and three after a vector of them, the first of which is number `first`: the records
 * of pieces, the headers, the bodies; before the first one all up to there. A vector at a time, as the memory takes few
 * requests at once. */
NOINLINE void fetch_ahead(const struct call *call, const struct sources *given, bool of_b, bool forms, size_t first) {
    const size_t bodies = first + 3 * BLOCK, headers = first + 2 * BLOCK, pieces = first + BLOCK;
    HAS_EFFECT;
    fetch_range(call, given, of_b, forms, first > 0 ? bodies : 0, bodies + V_WIDTH, FETCH_BODIES);
    fetch_range(call, given, of_b, forms, first > 0 ? headers : 0, headers + V_WIDTH, FETCH_HEADERS);
    fetch_range(call, given, of_b, forms, first > 0 ? pieces : 0, pieces + V_WIDTH, FETCH_PIECES);
}

/* Where the pairs of a call have pieces, and what became of them. */
struct pieces_met {
    bool many;       /* are there MANY_RECORDS? */
    bool of_a, of_b; /* has a pair of the last block one? Of the first block: the first pair */
    bool by_forms;   /* was one taken by its form? */
    bool fetches;    /* so they are asked for ahead: of B, or of A */
    bool fetches_b, fetches_forms;
    bool forms, formed; /* are pairs of forms looked for in this block; have there been any? */
};

INLINE bool begins_with_piece(const struct call *call, narc_index_column body, narc_index_column shape) {
    const size_t number = narc_pair_at(call->batch, call->first);
    return narc_is_piece(
        &call->batch->shapes->headers[narc_index_at(shape, body.base ? narc_index_at(body, number) : number)]);
}

INLINE struct pieces_met meet_pieces(const struct call *call, const struct sources *given) {
    struct pieces_met met = {.forms = true, .many = FETCHES && call->batch->shapes->record_count >= MANY_RECORDS};
    if (met.many && call->count > BLOCK) {
        met.of_a = begins_with_piece(call, given->pairs.a, given->a.shape);
        met.of_b = begins_with_piece(call, given->pairs.b, given->b.shape);
    }
    return met;
}

/* Before a block of a call with pieces. Pairs of forms are looked for in the block behind one that had some, and in each
 * fourth. */
INLINE void begin_block_of_pieces(struct pieces_met *met, size_t block) {
    met->forms = met->formed || block % (4 * BLOCK) == 0;
    met->formed = false;
    met->fetches = met->many && (met->of_a || met->of_b);
    met->fetches_b = met->of_b;
    met->fetches_forms = met->by_forms;
    met->of_a = met->of_b = met->by_forms = false;
}

/* Of pairs that were taken by their forms, the first is looked at. */
INLINE void note_forms(const struct call *call, struct pieces_met *met, int32_t shape_a, int32_t shape_b) {
    const narc_box_form *const forms = call->batch->shapes->boxes;
    const bool of_a = forms[shape_a].info & NARC_HAS_FRONT, of_b = forms[shape_b].info & NARC_HAS_FRONT;
    met->of_a = met->of_a || of_a;
    met->of_b = met->of_b || of_b;
    met->by_forms = met->by_forms || of_a || of_b;
}

INLINE void note_pieces(struct pieces_met *met, const vf item[FIELDS]) {
    met->of_a = met->of_a || vm_any(has_mark(get_item_bits(item, INFO_A), NARC_PIECE_MARKS));
    met->of_b = met->of_b || vm_any(has_mark(get_item_bits(item, INFO_B), NARC_PIECE_MARKS));
}

/* Takes what waits in the first stage's queue, if that is full, through all stages. */
INLINE void run_full_stages(const struct call *call, const struct course *course, struct queue *queues) {
    if (queues[course->first].count >= FLUSH || queues[course->edged].count >= FLUSH || queues[POLYGONS].count >= FLUSH)
        run_stages(call, course, queues, false);
}

/* Pairs with a run wait until there is a vector of them, as most bodies are near concave pieces, too. Takes the last ones. */
NOINLINE void take_waiting_runs(const struct call *call, const struct course *course, struct queue *queues) {
    struct queue *const runs = call->runs;
    vf item[FIELDS];
    const int k = runs->count > V_WIDTH ? runs->count - V_WIDTH : 0;
    const vm live = vm_front(runs->count - k);
    if (runs->count < V_WIDTH)
        pad(runs);
    get_item(runs, k, item, QUEUE_FIELDS);
    const vm left = course->runs(call, live, get_margins(call, runs, k), item);
    runs->count = k;
    if (vm_any(left)) {
        enter(course, queues, left, item, false);
        run_full_stages(call, course, queues);
    }
}

/* Takes the pairs with a run of those in the lanes `open`, pairs k ... of a block; returns those that go on. */
INLINE vm take_runs(const struct call *call, settling *settle, const struct course *waiting, struct queue *queues,
                    const struct pair_indices *indices, int k, vm open, vf margin, vf item[FIELDS]) {
    const vi info_a = get_item_bits(item, INFO_A), info_b = get_item_bits(item, INFO_B);
    const vm is_a = has_mark(info_a, NARC_PIECE_RUN), one = vm_xor(is_a, has_mark(info_b, NARC_PIECE_RUN));
    const vm with_run = vm_and(open, one), others = vm_and_not(open, one);
    if (!vm_any(with_run))
        return open;
    item[BODY_SHAPE] = v_of_bits(vi_select(is_a, vi_load(indices->shape_b + k), vi_load(indices->shape_a + k)));
    if (COUNT_BITS(vm_bits(with_run)) == V_WIDTH)
        return settle(call, with_run, margin, item);
    push(call->runs, with_run, item, QUEUE_FIELDS);
    if (call->runs->count >= V_WIDTH)
        take_waiting_runs(call, waiting, queues);
    return others;
}

/* For so few pairs it is not worth a look how their poses lie, nor one whether polygons need no enumeration. */
enum { FEW_PAIRS = 4 };

/* Runs all pairs of a call. `queues`: NULL if the triage answers all. */
INLINE void run_pairs(const struct call *call, const struct course *course, struct queue *queues) {
    const struct sources given = copy_sources(call->batch);
    const bool not_first = course->edged == 0 || call->count <= FEW_PAIRS; /* do polygons skip the first stage? */
    const enum pose_layout layout = call->batch->of_casts      ? POSE_LANES
                                    : call->count <= FEW_PAIRS ? POSE_COLUMNS
                                                               : find_layout(&given);
    const struct course waiting = *course; /* compilers know what is in the one whose address goes nowhere */
    struct pair_indices indices;
    struct found_arcs arcs;
    struct pieces_met met = {.forms = true};
    if (NARC_PIECES && !LIKELY(!call->pieces) && call->count > 0)
        met = meet_pieces(call, &given);
    for (int s = 0; s < course->end; s++)
        start_queue(&queues[s], &arcs);
    for (size_t block = 0; block < call->count; block += BLOCK) {
        const int n = (int)(call->count - block < BLOCK ? call->count - block : BLOCK);
        load_pairs(&given, call->first + block, n, layout != POSE_DOUBLE_ROWS, &indices);
        if (NARC_PIECES && !LIKELY(!call->pieces))
            begin_block_of_pieces(&met, block);
        if (course->edged > 0 && block % REMEMBERED == 0)
            queues->edged = queues->edged_left = 0;
        if (queues && block % (4 * BLOCK) == 0)
            queues->whole = false;
        for (int k = 0; k < n; k += V_WIDTH) {
            vf item[FIELDS];
            if (NARC_PIECES && !LIKELY(!met.fetches))
                fetch_ahead(call, &given, met.fetches_b, met.fetches_forms, block + (size_t)k);
            const struct placement placement = place_pairs(call, &given, &indices, k, layout, true);
            vm asked = vm_front(n - k);
            if (course->take && !LIKELY(!call->boxes) && met.forms) {
                const vm all = asked;
                asked = course->take(call, &indices, k, &placement, asked, (int32_t)(uint32_t)block + k);
                const vm taken = vm_and_not(all, asked);
                if (NARC_PIECES && !LIKELY(!call->pieces) && vm_any(taken)) {
                    const int lane = k + FIND_LOWEST(vm_bits(taken));
                    met.formed = true;
                    if (met.many)
                        note_forms(call, &met, indices.shape_a[lane], indices.shape_b[lane]);
                }
                if (!vm_any(asked))
                    continue;
            }
            const struct filter circles =
                set_up_pairs(call, &indices, k, &placement, asked, (int32_t)(uint32_t)block, item);
            *call->skipped += (size_t)COUNT_BITS(vm_bits(circles.invalid));
            vm open = course->settle(call, block + (size_t)k, &circles, item);
            if (NARC_PIECES && !LIKELY(!call->pieces)) {
                note_pieces(&met, item);
                if (course->runs && call->runs && vm_any(open))
                    open = take_runs(call, course->runs, &waiting, queues, &indices, k, open, circles.margin, item);
            }
            if (queues && vm_any(open)) {
                enter(course, queues, open, item, not_first);
                run_full_stages(call, course, queues);
            }
        }
    }
    if (NARC_PIECES && course->runs && call->runs && call->runs->count > 0)
        take_waiting_runs(call, &waiting, queues);
    if (queues)
        run_stages(call, course, queues, true);
}

static inline struct call begin_overlaps(const narc_batch *batch, size_t first, size_t count, size_t *skipped,
                                         uint64_t *out_bits) {
    memset(out_bits, 0, (count + 63) / 64 * sizeof *out_bits);
    return (struct call){.batch = batch,
                         .first = first,
                         .count = count,
                         .skipped = skipped,
                         .bits = out_bits,
                         .pieces = has_pieces(batch),
                         .planes = has_planes(batch)};
}

#endif
