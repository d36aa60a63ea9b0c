/* SPDX-License-Identifier: MIT
 *
 * manifold.c - the manifold kernel: contacts with a second point where edges face each other (manifold_edges.inl), with
 * ids of the points, and how far the touching arcs go on.
 */
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "base/call.inl"
#include "base/question.inl"
#include "base/queue.inl"
#include "base/rows.inl"
#include "box/box_pairs.inl"
#include "box/box_rows.inl"
#include "kernels.h"
#include "piece/edge_rows.inl"
#include "polygon/polygon_rows.inl"
#include "sat/answers.inl"

static void answer_edges(const struct call *call, struct queue *queues, int begin) {
    answer_settled(call, queues, begin, true);
}

static void answer_edges_of_polygons(const struct call *call, struct queue *queues, int begin) {
    answer_polygons(call, queues, begin, true);
}

static void answer_edges_of_boxes(const struct call *call, const struct box_queue *queue, int k, int live) {
    answer_boxes(call, queue, k, live, false, true);
}

static void answer_edges_of_capsules(const struct call *call, const struct box_queue *queue, int k, int live) {
    answer_boxes(call, queue, k, live, true, true);
}

static vm answer_manifolds_on_edges(const struct call *call, const struct edge_contact *contact) {
    return answer_on_edges(call, contact, true);
}

size_t NARC_NAMED(manifold)(const narc_batch *batch, size_t first, size_t count, size_t *skipped,
                            const narc_rows *out) {
    static const struct question manifolds = {.kind = MANIFOLD_ROWS,
                                              .normal_at = offsetof(narc_manifold, normal_x),
                                              .none = write_no_manifold,
                                              .edges = answer_edges,
                                              .polygons = NARC_SHORTCUTS ? answer_edges_of_polygons : NULL,
                                              .boxes = NARC_SHORTCUTS ? answer_edges_of_boxes : NULL,
                                              .capsules = NARC_SHORTCUTS ? answer_edges_of_capsules : NULL,
                                              .on_edges =
                                                  NARC_PIECES && NARC_CIRCLE_FORMS ? answer_manifolds_on_edges : NULL};
    struct rows rows;
    const struct call call = begin_rows(&manifolds, batch, first, count, skipped, out, &rows);
    NARC_NAMED(find_rows)(&call);
    return end_rows(&call, sizeof(narc_manifold));
}
