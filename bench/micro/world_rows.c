/* SPDX-License-Identifier: MIT
 *
 * world_rows.c - a settled pile in the example world: its manifolds, and its solver's contacts made of them.
 */
#include "rows.h"

#include "../../examples/world.h" /* by its place: both folders have a scenes.h */
#include "common.h"

struct world_row {
    struct bench_row row;
    enum world_part part;
    struct workload_key key;
    const char *isa;
    world world;
};

static void find_manifolds(struct world_row *row) { must(world_find_manifolds(&row->world), &row->world.error); }

static void run(struct bench_row *bench_row) {
    struct world_row *row = bench_row->context;
    if (row->part == WORLD_MANIFOLDS)
        find_manifolds(row);
    else
        world_make_contacts(&row->world);
}

/* Without gravity: what has settled stays. No contact serves again, so that all are found. */
static void fill_world(world *w, const struct workload *workload) {
    world_settings settings = world_defaults;
    settings.gravity = (vec){0, 0};
    settings.recycling = 0;
    must(world_create(w, settings, workload->body_count + workload->shape_count), &w->error);
    for (uint32_t shape = 0; shape < workload->shape_count; shape++) {
        narc_arc arcs[NARC_MAX_ARCS];
        uint32_t index;
        must(world_add_shape(w, arcs, narc_get_arcs(workload->shapes, shape, arcs), &index), &w->error);
        if (index != shape)
            fail("two shapes of a pile are equal");
    }
    for (size_t k = 0; k < workload->body_count; k++) {
        const struct body *body = &workload->bodies[k];
        must(world_add_body(w, (world_body){.position = {body->x, body->y},
                                            .cosine = body->cosine,
                                            .sine = body->sine,
                                            .shape = body->shape,
                                            .friction = 0.5f}),
             &w->error);
    }
}

static void prepare(struct bench_row *bench_row) {
    struct world_row *row = bench_row->context;
    world *const w = &row->world;
    narc_error error;
    must(narc_set_isa(row->isa, &error), &error);
    if (w->bodies)
        return;
    fill_world(w, get_workload(&row->key));
    must(world_step(w), &w->error);
    find_manifolds(row);
    world_make_contacts(w);
    row->row.pairs = w->list->pairs.count;
    for (size_t k = 0; k < row->row.pairs; k++)
        row->row.colliding += (w->contacts[k].point_count > 0) / (double)row->row.pairs;
    for (size_t k = 0; k < w->row_count; k++)
        row->row.wrong += w->contacts[w->rows[k].pair].point_count != w->rows[k].count;
}

struct bench_row *make_world_part_row(const char *name, enum world_part part, const struct workload_key *key,
                                      const char *isa) {
    struct world_row *row = allocate(1, sizeof *row);
    bench_set(&row->row, name, prepare, run, row, true);
    row->part = part;
    row->key = *key;
    row->isa = isa;
    return &row->row;
}
