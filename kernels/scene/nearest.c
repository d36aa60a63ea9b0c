/* SPDX-License-Identifier: MIT
 *
 * nearest.c - the kernel of the bodies of an index that are nearest to points; and whether a body holds a point. Lanes are the
 * slots of a node or the arcs of one shape, and points only when rows are written.
 */
#define NARC_EIGHT_LANES

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/bodies.inl"
#include "base/contact_point.inl"
#include "base/rows.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "index.h"
#include "kernels.h"
#include "scene/body_frame.inl"
#include "scene/near_walk.inl"
#include "scene/piece_places.inl"
#include "scene/point_rows.inl"
#include "scene/things.inl"
#include "scene/way_out.inl"
#include "simd/simd.h"

/* The separation of one point, with arcs in lanes. */
INLINE float find_separation(const struct body_frame *frame, float x, float y) {
    const vec2 point = {v_set(x), v_set(y)};
    const vec2 middle = {v_set(frame->header->bound_x), v_set(frame->header->bound_y)};
    const vf scale = v_set((float)frame->scale);
    vf most = v_set(-INFINITY);
    for (int k = 0; k < (int)frame->header->count; k += V_WIDTH) {
        const struct own_arcs arcs = load_own_arcs(frame->arcs + k);
        const vec2 u = v2_sub(point, v2_scale(v2_sub(arcs.center, middle), scale));
        const struct arc_view view = view_arc(u, arcs.start, arcs.end);
        const vf separation = find_arc_separation(&view, v_mul(arcs.radius, scale));
        most = v_max(most, v_select(vm_front((int)frame->header->count - k), separation, v_set(-INFINITY)));
    }
    float lane[V_WIDTH];
    v_store(lane, most);
    for (int k = 1; k < V_WIDTH; k++)
        lane[0] = lane[0] < lane[k] ? lane[k] : lane[0];
    return lane[0];
}

bool NARC_NAMED(is_within)(const struct body_frame *frame, place point) {
    float x, y;
    return place_point(frame, point, &x, &y) && find_separation(frame, x, y) < 0;
}

/* A point's search. */
struct search {
    const narc_point_batch *batch;
    place point;
    struct chosen chosen;
    struct near_walk walk;
    narc_distance
        *rows; /* the nearest so far, in their order: body and separation; all, with a count, of things that hold it */
    size_t found;
    float limit; /* of a separation that still counts */
    float reach; /* of one that is looked at: a part that holds the point tells of a thing that may be deeper */
};

INLINE bool is_nearer(uint32_t body, float separation, const narc_distance *row) {
    return separation < row->separation || (separation == row->separation && body < row->body);
}

INLINE void set_limit(struct search *search, float limit) {
    search->limit = limit;
    search->reach = search->chosen.owners && limit < 0 ? 0 : limit;
    search->walk.limit_key = find_limit_key(search->reach);
}

/* Puts a body among the nearest ones if it belongs there: of a thing the nearest part alone. `whole`: its row, or NULL. */
INLINE void add_row(struct search *search, uint32_t body, float separation, const narc_distance *whole) {
    narc_distance *const rows = search->rows;
    const size_t most = search->batch->most;
    const uint32_t owner = find_owner(&search->chosen, body);
    if (!(separation < search->limit) && !(search->found == most && is_nearer(body, separation, &rows[most - 1])))
        return;
    for (size_t k = 0; owner != UINT32_MAX && k < search->found; k++)
        if (find_owner(&search->chosen, rows[k].body) == owner) {
            if (!is_nearer(body, separation, &rows[k]))
                return;
            for (search->found--; k < search->found; k++)
                rows[k] = rows[k + 1];
        }
    size_t k = search->found;
    k -= k == most;
    for (; k > 0 && is_nearer(body, separation, &rows[k - 1]); k--)
        rows[k] = rows[k - 1];
    rows[k] = whole ? *whole : (narc_distance){.body = body, .separation = separation};
    search->found += search->found < most;
    if (search->found == most)
        set_limit(search, rows[most - 1].separation);
}

/* Adds a thing that holds the point, one part of it so deep, by how far it is to the outside. */
NOINLINE void add_thing(struct search *search, uint32_t body, float separation) {
    const narc_point_batch *const batch = search->batch;
    const struct thing thing = {
        batch->shapes, batch->bodies, batch->index, &search->chosen, find_owner(&search->chosen, body), search->point};
    struct way_out out;
    struct body_frame frame;
    narc_distance row = {.body = body, .separation = separation};
    for (size_t k = 0; k < search->found; k++)
        if (search->rows[k].count && find_owner(&search->chosen, search->rows[k].body) == thing.owner)
            return; /* by another part */
    if (find_way_out(&thing, body, &out) && load_body_frame(batch->shapes, batch->bodies, out.body, &frame))
        row = (narc_distance){.body = out.body,
                              .feature = (uint16_t)out.feature,
                              .count = 1,
                              .separation = (float)-out.distance,
                              .normal_x = (float)out.normal.x,
                              .normal_y = (float)out.normal.y,
                              .place_x = (float)(out.at.x + search->point.x - frame.position.x),
                              .place_y = (float)(out.at.y + search->point.y - frame.position.y),
                              .radius = (float)out.radius};
    add_row(search, row.body, row.separation, &row);
}

INLINE void add_body(struct search *search, uint32_t body, float separation) {
    if (search->chosen.owners && separation < 0 && find_owner(&search->chosen, body) != UINT32_MAX)
        add_thing(search, body, separation);
    else
        add_row(search, body, separation, NULL);
}

/* The frame of a piece of a chain, and its nearest place. False for all else. */
INLINE bool find_piece(const narc_point_batch *batch, uint32_t body, place point, struct body_frame *frame,
                       struct piece_place *out) {
    return NARC_PIECES && batch->shapes->piece_count > 0 &&
           load_body_frame(batch->shapes, batch->bodies, body, frame) && narc_is_piece(frame->header) &&
           find_piece_place(frame, point, out);
}

INLINE void look_at_body(struct search *search, uint32_t body) {
    const float shrink = 1 - 0x1p-16f; /* of a square, as in base/pair_setup.inl: the radius has room for separations */
    struct body_frame frame;
    struct piece_place nearest;
    float x, y;
    if (!is_chosen(&search->chosen, body))
        return;
    if (find_piece(search->batch, body, search->point, &frame, &nearest))
        add_row(search, body, (float)(frame.scale * nearest.distance), NULL);
    if (!load_body_frame(search->batch->shapes, search->batch->bodies, body, &frame) || narc_is_piece(frame.header) ||
        !place_point(&frame, search->point, &x, &y))
        return;
    const float reach = (float)frame.scale * frame.header->bound_radius + search->reach;
    if (reach < 0 || reach * reach < (x * x + y * y) * shrink)
        return;
    add_body(search, body, find_separation(&frame, x, y));
}

/* Writes the rows of what was found, or sees to it. */
INLINE void ask_nearest(const struct search *search, size_t point, struct point_queries *waiting) {
    const narc_point_batch *const batch = search->batch;
    for (size_t i = 0; i < batch->most; i++) {
        narc_distance *const row = &search->rows[i];
        struct body_frame frame;
        struct piece_place nearest;
        if (i >= search->found)
            put_nothing(row, point);
        else if (row->count)
            row->point = (uint32_t)point;
        else if (find_piece(batch, row->body, search->point, &frame, &nearest))
            *row = make_piece_row(&frame, &nearest, point, row->body);
        else
            ask(batch, point, row->body, row, waiting);
    }
}

void NARC_NAMED(nearest)(const narc_point_batch *batch, size_t first, size_t end) {
    const narc_index_query *const query = batch->search;
    struct point_queries waiting;
    waiting.count = 0;
    for (size_t k = first; k < end; k++) {
        struct search search;
        search.batch = batch;
        search.point = load_point(batch->points, k);
        search.chosen = read_chosen(query, k);
        search.found = 0;
        search.rows = batch->out + k * batch->most;
        set_limit(&search, -find_lower(FARTHEST, -find_lower(FARTHEST, batch->distance)));
        uint32_t body;
        if (batch->index->level_count > 0 && search.chosen.mask != 0 &&
            begin_near_walk(&search.walk, batch->index, &search.chosen, search.point, search.walk.limit_key))
            while (find_next_near(&search.walk, &body))
                look_at_body(&search, body);
        ask_nearest(&search, k, &waiting);
    }
    answer(batch->shapes, &waiting);
}
