/* SPDX-License-Identifier: MIT
 *
 * dxf_entities.h - what dxflib, which is C++, reads of a DXF text. Internal.
 */
#ifndef NARC_DXF_ENTITIES_H
#define NARC_DXF_ENTITIES_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum narc_dxf_kind {
    NARC_DXF_LINE,
    NARC_DXF_ARC,
    NARC_DXF_CIRCLE,
    NARC_DXF_ELLIPSE,
    NARC_DXF_POLYLINE,
    NARC_DXF_SPLINE,
    NARC_DXF_INSERT,
    NARC_DXF_BLOCK,
    NARC_DXF_END_OF_BLOCK
} narc_dxf_kind;

/* `name` is that of a block, begun or inserted; `up` the z of the direction from which flat entities are seen. numbers:
 *     LINE      x y x y                          ARC      x y radius, angles in degrees (CIRCLE without)
 *     ELLIPSE   x y, axis x y, ratio, parameters BLOCK    base x y
 *     POLYLINE  flags; more: x y bulge           INSERT   x y, scales x y, degrees, columns, rows, their steps
 *     SPLINE    degree, flags; more: knots, then x y weight for each control point; numbers[2]: how many knots */
typedef struct narc_dxf_entity {
    narc_dxf_kind kind;
    const char *layer, *name;
    double up, numbers[9];
    const double *more;
    size_t more_count;
} narc_dxf_entity;

/* Calls add() for each entity in its order, until that is false. False without memory, or if add() was. */
bool narc_list_dxf_entities(const char *text, size_t size, bool (*add)(const narc_dxf_entity *, void *), void *context);

#ifdef __cplusplus
}
#endif

#endif
