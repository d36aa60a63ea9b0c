/* SPDX-License-Identifier: MIT
 *
 * pieces.inl - the marks of a chain's pieces (store.h), what of a run can touch, and what reaches pieces.
 */
#ifndef NARC_PIECE_PIECES_INL
#define NARC_PIECE_PIECES_INL

#include "base/call.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "column.h"
#include "kernels.h"
#include "piece.h"
#include "simd/simd.h"

/* Does a shape have one of these marks? */
INLINE vm has_mark(vi info, unsigned marks) { return vi_lt(vi_set(0), vi_and(info, vi_set((int32_t)(marks << 8)))); }

/* Asks the cache for the records of a piece. */
INLINE void fetch_piece(const narc_shapes *shapes, const narc_shape_header *header) {
    const narc_record *const first = shapes->records + header->first_record;
    if (narc_is_piece(header))
        for (size_t k = 0; k < narc_count_records(header); k += 2)
            FETCH(first + k);
}

/* narc_touches() (store.h) in lanes: may a shape touch with this feature, as a contact has it? Of a run only front ones
 * count: arcs 1 to count - 6 and edges 1 to count - 5. */
INLINE vm is_front(vi info, vi feature) {
    _Static_assert(NARC_FEATURE_EDGE == 64, "the shift divides by it");
    const vi number = vi_and(feature, vi_set(NARC_FEATURE_EDGE - 1));
    const vi edge = vi_and(vi_shift_right(feature, 6), vi_set(1));
    const vi end = vi_add(vi_sub(get_arc_count(info), vi_set(5)), edge);
    const vm front = vm_and(vi_lt(vi_set(0), number), vi_lt(number, end));
    return vm_or(vm_not(has_mark(info, NARC_PIECE_RUN)), front);
}

INLINE const narc_shape_header *find_header(const narc_batch *batch, const narc_bodies *bodies,
                                            narc_index_column column, size_t number) {
    const size_t body = column.base ? narc_index_at(column, number) : number;
    return &batch->shapes->headers[narc_index_at(bodies->shape, body)];
}

/* Is a body so shallow that it reaches the piece (narc_is_shallow()), for certain? By how deep it may be, twice its inner
 * radius, and how thick the piece's solid is. */
INLINE vm is_shallow(vf most, vf thickness, vf separation) {
    const vf depth = v_mul(v_set(-1 - 0x1p-17f), separation);
    return vm_and(v_le(depth, most), v_le(depth, thickness));
}

/* How far beside the sector of a concave arc, relative to the radii, the centre of a body's arc may lie: what the centres
 * were rounded by, of pieces whose distance is not much more than their size. */
#define CONCAVE_ROOM 0x1p-20f

/* Is n, from B's centre to A's, in the sector of a concave arc, beside a body's arc of this radius? Where both radii are
 * nearly one, n is next to nothing and its direction that of rounding. */
INLINE vm is_in_sector(const struct arcs *piece, vec2 n, vf radius) {
    const vf room = v_mul(v_set(-CONCAVE_ROOM), v_sub(radius, piece->radius));
    return vm_and(v_le(room, v2_cross(piece->start, n)), v_le(room, v2_cross(n, piece->end)));
}

/* Of the pairs k ... of a queue in the lanes `which`, those whose bodies do not reach each other's surface
 * (soa/piece.h). `n`: in A's frame. Most are shallow: of them no more is looked at than that. */
NOINLINE vm find_unreached(const struct call *call, const struct queue *queue, int k, vm which, vf separation, vec2 n) {
    const narc_batch *const batch = call->batch;
    const bool front_only = batch->query->front_only != 0;
    const vi info_a = get_bits(queue, INFO_A, k), info_b = get_bits(queue, INFO_B, k);
    const vm of_a = has_mark(info_a, NARC_PIECE_MARKS), both = vm_and(of_a, has_mark(info_b, NARC_PIECE_MARKS));
    const struct ring ring_a = get_ring_a(queue, k), ring_b = get_ring_b(queue, k);
    const vf scale_a = get(queue, SCALE_A, k), scale_b = get(queue, SCALE_B, k);
    const uint32_t piece_is_a = vm_bits(of_a);
    int32_t pair[V_WIDTH], solid[V_WIDTH];
    get_pairs(queue, k, pair);
    vi_store(solid, vi_select(of_a, vi_add(ring_a.base, ring_a.count), vi_add(ring_b.base, ring_b.count)));
    if (!front_only) {
        float inner[V_WIDTH] = {0};
        for (uint32_t lanes = vm_bits(which); lanes; lanes &= lanes - 1) {
            const int l = FIND_LOWEST(lanes);
            const bool of_b = piece_is_a >> l & 1;
            inner[l] = find_header(batch, of_b ? batch->b : batch->a, of_b ? batch->pairs->b : batch->pairs->a,
                                   find_number(call, pair[l]))
                           ->inner_radius;
        }
        const vf scaled = v_mul(v_load(inner), v_select(of_a, scale_b, scale_a));
        vf field[4];
        v_rows(batch->shapes->records, sizeof *batch->shapes->records, solid, field);
        const vm shallow =
            is_shallow(v_add(scaled, scaled), v_mul(field[0], v_select(of_a, scale_a, scale_b)), separation);
        which = vm_and_not(which, vm_and_not(shallow, both));
    }
    if (!vm_any(which))
        return which;
    float scale[2][V_WIDTH], depth[V_WIDTH], unreached[V_WIDTH] = {0};
    v_store(scale[0], scale_a);
    v_store(scale[1], scale_b);
    v_store(depth, separation);
    const vec2 rotation = get_vec2(queue, ROTATION, k), position = get_vec2(queue, POSITION, k);
    const vec2 normal[2] = {n, v2_unrotate(rotation, n)}, way[2] = {position, v2_unrotate_opposite(rotation, position)};
    float field[2][4][V_WIDTH];
    for (int side = 0; side < 2; side++) {
        const vf fields[4] = {normal[side].x, normal[side].y, way[side].x, way[side].y};
        for (int f = 0; f < 4; f++)
            v_store(field[side][f], fields[f]);
    }
    for (uint32_t lanes = vm_bits(which); lanes; lanes &= lanes - 1) {
        const int l = FIND_LOWEST(lanes), piece = piece_is_a >> l & 1 ? 0 : 1;
        const size_t number = find_number(call, pair[l]);
        const narc_shape_header *const header[2] = {find_header(batch, batch->a, batch->pairs->a, number),
                                                    find_header(batch, batch->b, batch->pairs->b, number)};
        const double thickness = (double)batch->shapes->records[(uint32_t)solid[l]].solid.thickness;
        if (!front_only && !narc_is_piece(header[1 - piece]) &&
            narc_is_shallow(header[1 - piece], (double)scale[1 - piece][l], (double)scale[piece][l] * thickness,
                            (double)depth[l]))
            continue;
        narc_contact_side touching[2];
        for (int s = 0; s < 2; s++) {
            const float x = field[s][0][l], y = field[s][1][l], to_x = field[s][2][l], to_y = field[s][3][l];
            touching[s] = (narc_contact_side){header[s],           narc_arcs_of(batch->shapes, header[s]),
                                              (double)scale[s][l], (double)x,
                                              (double)y,           (double)to_x,
                                              (double)to_y};
        }
        unreached[l] = narc_is_reached(&touching[0], &touching[1], (double)depth[l], front_only) ? 0 : 1;
    }
    return v_lt(v_set(0), v_load(unreached));
}

/* Of the pairs k ... of a queue in the lanes `keep`, but those where one is a piece that the other one
 * does not reach. */
INLINE vm keep_reached(const struct call *call, const struct queue *queue, int k, vm keep, vf separation, vec2 n) {
    const vm pieces = vm_or(has_mark(get_bits(queue, INFO_A, k), NARC_PIECE_MARKS),
                            has_mark(get_bits(queue, INFO_B, k), NARC_PIECE_MARKS));
    const vm deep = vm_and(vm_and(keep, pieces), v_lt(separation, v_set(0)));
    return vm_any(deep) ? vm_and_not(keep, find_unreached(call, queue, k, deep, separation, n)) : keep;
}

/* Of the pairs k ... of a queue in the lanes `keep`, those that touch with what may touch: all but with the back of a
 * run, or from behind a piece. */
INLINE vm keep_fronts(const struct call *call, const struct queue *queue, int k, vm keep, vf separation, vec2 n,
                      vi feature_a, vi feature_b) {
    if (!NARC_PIECES || BLOCK == 1 || LIKELY(!call->pieces))
        return keep;
    const vm front =
        vm_and(is_front(get_bits(queue, INFO_A, k), feature_a), is_front(get_bits(queue, INFO_B, k), feature_b));
    return keep_reached(call, queue, k, vm_and(keep, front), separation, n);
}

#endif
