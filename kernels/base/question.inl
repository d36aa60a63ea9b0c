/* SPDX-License-Identifier: MIT
 *
 * question.inl - what is asked of pairs that gets a row for each answer.
 *
 * The pipeline knows pairs, queues and stages, and the search finds with what two bodies touch. A question says how that is
 * written: a row_writer, from which NARC_QUESTION() (sat/answers.inl) makes the rest, one for each way of pairs.
 */
#ifndef NARC_BASE_QUESTION_INL
#define NARC_BASE_QUESTION_INL

#include <stdint.h>

#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "kernels.h"
#include "simd/simd.h"

/* Answers the pairs `begin` ... of its queue, or passes them on to those of later stages. */
typedef void stage(const struct call *call, struct queue queues[STAGES], int begin);

/* Answers the pairs k ... of a queue of boxes or of capsules, `live` of them (box/box_pairs.inl). */
struct box_queue;
typedef void box_stage(const struct call *call, const struct box_queue *queue, int k, int live);
enum { OF_BOXES, OF_CAPSULES, BOX_QUEUES };

/* What may hold a second point of contact: an edge of each body (sat/manifold_edges.inl). */
struct sides;

/* Writes the row of a pair in each lane to its place. `sides`: NULL where a body has no edge. */
typedef void row_writer(const struct call *call, char *const *place, vi numbers, const struct answer *answer,
                        const struct sides *sides);

struct question {
    size_t size;        /* bytes of a row */
    size_t normal_at;   /* where its normal lies */
    uint32_t extra_row; /* what the word behind the pair gains for another row of it: NARC_MORE_ROW to the count */
    /* The row of a pair without a contact; `separation` INFINITY: it has no answer. */
    void (*none)(char *place, uint32_t pair, float separation);
    row_writer *discs;            /* the rows of circles; NULL: write_contacts(), inline */
    stage *answer;                /* the rows of pairs that are settled */
    stage *edges;                 /* those of pairs that may have second points; NULL: nobody asks */
    stage *polygons;              /* those of polygons */
    box_stage *boxes[BOX_QUEUES]; /* and of boxes and capsules */
    void (*gaps)(const struct call *call, const struct queue *queue, int k, const struct gap *gap, char *const *place);
};

/* What finds their answers (sat/search.c): the stages but for those of the question, the first of calls with hints, and what
 * answers pairs with a concave arc that wait. */
struct row_search {
    stage *stages[STAGES], *hinted;
    void (*concave)(const struct call *call);
};

extern const struct row_search NARC_NAMED(search);

/* Answers any question that has no second points, and whose rows are contacts or dense (sat/contact.c). */
size_t NARC_NAMED(rows)(const struct question *question, const narc_batch *batch, size_t first, size_t count,
                        size_t *skipped, const narc_rows *out);

#endif
