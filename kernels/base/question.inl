/* SPDX-License-Identifier: MIT
 *
 * question.inl - what is asked of pairs that gets a row for each answer.
 *
 * The pipeline knows pairs, queues and stages, and the search (sat/search.c) finds with what two bodies touch. A question
 * says how that is written. Its pairs go through sat/rows.c.
 */
#ifndef NARC_BASE_QUESTION_INL
#define NARC_BASE_QUESTION_INL

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/call.inl"
#include "base/queue.inl"
#include "kernels.h"

/* Answers the pairs `begin` ... of its queue, or passes them on to those of later stages. */
typedef void stage(const struct call *call, struct queue *queues, int begin);

/* Answers the pairs k ... of a queue of boxes, of capsules or with a circle, `live` of them (box/box_pairs.inl). */
struct box_queue;
typedef void box_stage(const struct call *call, const struct box_queue *queue, int k, int live);
enum { OF_BOXES, OF_CAPSULES, WITH_CIRCLE, BOX_QUEUES };

/* Answers pairs of a box or a capsule on an edge of a run; returns the lanes that it settles (piece/edges_below.inl). */
struct edge_contact;
typedef vm edge_answer(const struct call *call, const struct edge_contact *contact);

struct question {
    enum row_kind kind;
    size_t normal_at; /* where in a row its normal lies */
    /* The row of a pair without a contact; `separation` INFINITY: it has no answer. */
    void (*none)(char *place, uint32_t pair, float separation);
    /* What answers pairs that may have second points; NULL: nobody asks, and all rows are of one point. */
    stage *edges, *polygons;
    box_stage *boxes, *capsules;
    edge_answer *on_edges;
};

/* What finds their answers (sat/search.c): the stages but for those that write rows, and what answers pairs with a concave
 * arc that wait. */
struct row_search {
    stage *stages[STAGES];
    void (*concave)(const struct call *call);
};

extern const struct row_search NARC_NAMED(search);

/* Do rows tell how far normals may turn? */
INLINE bool has_reaches(const struct call *call) { return call->kind == MANIFOLD_ROWS; }

/* Answers all pairs of a call that begin_rows() has made (sat/rows.c). */
void NARC_NAMED(find_rows)(const struct call *call);

#endif
