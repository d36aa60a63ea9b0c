/* SPDX-License-Identifier: MIT
 *
 * peer_geos.c - regions and the nearest body in GEOS' packed R-tree: GEOSSTRtree_query(), GEOSSTRtree_nearest(). Each
 * question is a geometry, which is made outside of the tree but within the time.
 */
#include "peers.h"

#include <geos_c.h>

#include "common.h"

enum { SLOTS = 10 }; /* of a node, as its documentation advises */

struct tree {
    GEOSContextHandle_t context;
    GEOSSTRtree *tree;
};

static struct tree *create_tree(void) {
    struct tree *const t = allocate(1, sizeof *t);
    t->context = GEOS_init_r();
    t->tree = GEOSSTRtree_create_r(t->context, SLOTS);
    return t;
}

static GEOSGeometry *make_rectangle(GEOSContextHandle_t context, const narc_box *box) {
    return GEOSGeom_createRectangle_r(context, (double)box->min_x, (double)box->min_y, (double)box->max_x,
                                      (double)box->max_y);
}

/* ------------------------------------------------------------------------------------------------ regions */

/* The pairs of the region that is asked for. */
struct pairs {
    uint64_t query, *out;
    size_t count;
};

static void add_pair(void *item, void *data) {
    struct pairs *const pairs = data;
    pairs->out[pairs->count++] = pairs->query << 32 | (uintptr_t)item;
}

static size_t find_regions(void *tree, const narc_box *regions, size_t count, uint64_t *out_pairs) {
    const struct tree *const t = tree;
    struct pairs pairs = {.out = out_pairs};
    for (; pairs.query < count; pairs.query++) {
        GEOSGeometry *const region = make_rectangle(t->context, &regions[pairs.query]);
        GEOSSTRtree_query_r(t->context, t->tree, region, add_pair, &pairs);
        GEOSGeom_destroy_r(t->context, region);
    }
    return pairs.count;
}

static void *create_boxes(const struct workload *workload, const narc_box *boxes) {
    struct tree *const t = create_tree();
    for (uintptr_t k = 0; k < workload->body_count; k++)
        GEOSSTRtree_insert_r(t->context, t->tree, make_rectangle(t->context, &boxes[k]), (void *)k);
    const narc_box nowhere = {-1e30f, -1e30f, -1e30f, -1e30f};
    find_regions(t, &nowhere, 1, NULL); /* the first question builds the tree */
    return t;
}

const struct region_peer geos_regions = {"GEOS", create_boxes, find_regions};

/* ------------------------------------------------------------------------------------------------ nearest */

void *geos_create_polygons(const struct workload *workload) {
    struct tree *const t = create_tree();
    for (size_t k = 0; k < workload->body_count; k++) {
        const struct body *const b = &workload->bodies[k];
        const struct outline *const outline = &workload->outlines[b->shape];
        const unsigned corners = (unsigned)outline->count;
        GEOSCoordSequence *const ring = GEOSCoordSeq_create_r(t->context, corners + 1, 2);
        for (unsigned i = 0; i <= corners; i++) {
            const struct arc *const at = &outline->arcs[i % corners];
            GEOSCoordSeq_setXY_r(t->context, ring, i,
                                 (double)b->x + (double)b->cosine * at->x - (double)b->sine * at->y,
                                 (double)b->y + (double)b->sine * at->x + (double)b->cosine * at->y);
        }
        GEOSGeometry *const polygon =
            GEOSGeom_createPolygon_r(t->context, GEOSGeom_createLinearRing_r(t->context, ring), NULL, 0);
        GEOSSTRtree_insert_r(t->context, t->tree, polygon, polygon);
    }
    geos_find_nearest(t, &(float){0}, &(float){0}, 1, &(float){0}); /* the first question builds the tree */
    return t;
}

void geos_find_nearest(void *polygons, const float *x, const float *y, size_t count, float *out_distances) {
    const struct tree *const t = polygons;
    for (size_t k = 0; k < count; k++) {
        GEOSGeometry *const point = GEOSGeom_createPointFromXY_r(t->context, (double)x[k], (double)y[k]);
        double distance = 0;
        GEOSDistance_r(t->context, point, GEOSSTRtree_nearest_r(t->context, t->tree, point), &distance);
        out_distances[k] = (float)distance;
        GEOSGeom_destroy_r(t->context, point);
    }
}
