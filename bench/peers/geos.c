/* SPDX-License-Identifier: MIT
 *
 * geos.c - regions in GEOS' packed R-tree: GEOSSTRtree_query(). Each question is a geometry, which is made outside of the
 * tree but within the time. The first question, which is not timed, builds the tree.
 */
#include "peers.h"

#include <geos_c.h>

#include "common.h"

enum { SLOTS = 10 }; /* of a node, as its documentation advises */

struct tree {
    GEOSContextHandle_t context;
    GEOSSTRtree *tree;
};

static GEOSGeometry *make_rectangle(GEOSContextHandle_t context, const narc_box *box) {
    return GEOSGeom_createRectangle_r(context, (double)box->min_x, (double)box->min_y, (double)box->max_x,
                                      (double)box->max_y);
}

/* The pairs of the region that is asked for. */
struct found {
    uint64_t region, *out;
    size_t count;
};

static void add_pair(void *item, void *data) {
    struct found *found = data;
    found->out[found->count++] = found->region << 32 | (uintptr_t)item;
}

static size_t find_regions(void *tree, const struct asked *asked, void *out) {
    const struct tree *t = tree;
    struct found found = {.out = out};
    for (; found.region < asked->count; found.region++) {
        GEOSGeometry *region = make_rectangle(t->context, &asked->regions[found.region]);
        GEOSSTRtree_query_r(t->context, t->tree, region, add_pair, &found);
        GEOSGeom_destroy_r(t->context, region);
    }
    return found.count;
}

static void *create_boxes(struct scene *scene) {
    struct tree *t = allocate(1, sizeof *t);
    t->context = GEOS_init_r();
    t->tree = GEOSSTRtree_create_r(t->context, SLOTS);
    index_scene(scene);
    for (uintptr_t k = 0; k < scene->body_count; k++)
        GEOSSTRtree_insert_r(t->context, t->tree, make_rectangle(t->context, &scene->boxes[k]), (void *)k);
    return t;
}

const struct peer geos_regions = {
    .question = "region", .name = "geos", .max_edges = MAX_EDGES, .create = create_boxes, .ask = find_regions};
