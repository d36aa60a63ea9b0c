/* SPDX-License-Identifier: MIT
 *
 * encode.h - a shape as the store keeps it. Internal.
 */
#ifndef NARC_ENCODE_H
#define NARC_ENCODE_H

#include "store.h"

enum { NARC_MAX_RECORDS = NARC_MAX_ARCS / NARC_RECORD_ANGLES + NARC_MAX_ARCS + 1 };

/* A header that lacks its place in the store, and narc_count_records(&header) records. */
typedef struct narc_encoded_shape {
    narc_shape_header header;
    narc_record records[NARC_MAX_RECORDS];
} narc_encoded_shape;

/* Validates and encodes a list of arcs. Errors: those of narc_validate_arcs(), NARC_ERROR_SIZE. */
narc_status narc_encode_shape(const narc_arc *arcs, size_t count, narc_encoded_shape *out_shape, narc_error *error);

/* Encodes a closed run of a chain: its arcs are those of store.h, NARC_PIECE_RUN. */
narc_status narc_encode_run(const narc_arc *arcs, size_t count, const narc_solid *solid, narc_encoded_shape *out_shape,
                            narc_error *error);

/* Encodes a concave arc of a chain, radius below 0 or -0, with normals from `start` counter-clockwise to `end`. Its
 * circle gets this radius at least. NARC_ERROR_RADIUS (too flat), NARC_ERROR_SIZE. */
narc_status narc_encode_concave(const narc_arc *arc, double least_bound, const narc_solid *solid,
                                narc_encoded_shape *out_shape, narc_error *error);

/* A half-plane. NARC_ERROR_ARGUMENT: the small module has none. */
narc_status narc_encode_plane(narc_encoded_shape *out_shape, narc_error *error);

/* The form of a shape that is a box or a capsule, else one with info 0. */
narc_box_form narc_find_box_form(const narc_encoded_shape *shape);

/* What a circle touches of a piece of a chain; of another shape nothing. */
narc_piece_form narc_find_piece_form(const narc_encoded_shape *shape);

/* Checks the header and the arcs of a shape that was stored elsewhere, and writes the records of its angles.
 * Nothing that it lets through breaks what kernels rely on. NARC_ERROR_FORMAT. */
narc_status narc_restore_shape(narc_encoded_shape *shape, narc_error *error);

#endif
