/* SPDX-License-Identifier: MIT
 *
 * few_bodies.c - contacts that stay, of some bodies that a test puts where it wants them.
 */
#include "few_bodies.h"

#include <math.h>
#include <stdlib.h>

#include "expect.h"
#include "step_world.h"

struct few *make_few(struct shape shape, size_t count, const narc_allocator *allocator) {
    struct few *const few = calloc(1, sizeof *few);
    assert_non_null(few);
    few->store = empty_store();
    store_shape(few->store, shape);
    for (size_t k = 0; k < count; k++) {
        few->body[k] = (narc_body){.x = (double)(k / 2) * 10 + 0.9 * (double)(k % 2), .cosine = 1, .scale = 1};
        few->id[k] = k + 1;
    }
    narc_view_bodies(few->body, count, &few->bodies);
    few->filter = (narc_pair_filter){.kind = NARC_ARRAY(few->kind)};
    few->step = (narc_step){
        .bodies = &few->bodies, .margin = 0.02f, .skin = 1, .id = NARC_ARRAY(few->id), .filter = &few->filter};
    few->contacts = make_contacts(NARC_MANIFOLD_ROWS, allocator);
    return few;
}

const narc_step_result *step_few(struct few *few) {
    const narc_step_result *r;
    narc_error error;
    expect_ok(narc_update_contacts(few->contacts, few->store, &few->step, &r, &error), &error);
    return r;
}

void destroy_few(struct few *few) {
    narc_destroy_contacts(few->contacts);
    narc_destroy_shapes(few->store);
    free(few);
}

void check_with_fresh(struct few *few) {
    narc_contacts *const kept = few->contacts;
    const narc_step_result *const r = step_few(few);
    few->contacts = make_contacts(NARC_MANIFOLD_ROWS, NULL);
    const narc_step_result *const fresh = step_few(few);
    assert_int_equal(r->count, fresh->count);
    assert_int_equal(r->touching_count, fresh->touching_count);
    assert_int_equal(r->more_count, fresh->more_count);
    for (size_t k = 0; k < r->touching_count; k++)
        check_row(&r->manifolds[r->touching[k]], fresh->manifolds[fresh->touching[k]], r->touching[k]);
    const narc_manifold *const more = r->more, *const fresh_more = fresh->more;
    for (size_t k = 0; k < r->more_count; k++)
        check_row(&more[k], fresh_more[k], more[k].pair);
    narc_destroy_contacts(few->contacts);
    few->contacts = kept;
}

size_t lay_entries(struct few *few, const narc_arc *arcs, size_t count, double weld, uint32_t *run) {
    static narc_chain_entry entries[256];
    const narc_chain_options options = {.weld = weld};
    size_t found = 0;
    narc_error error;
    expect_ok(narc_add_chain(few->store, arcs, count, &options, entries, 256, &found, &error), &error);
    run[0] = NARC_NO_RUN;
    for (size_t k = 0; k < found; k++) {
        few->body[1 + k] = (narc_body){entries[k].x, entries[k].y, 1, 0, 1, entries[k].shape};
        few->kind[1 + k] = NARC_STATIC;
        few->id[1 + k] = 2 + k;
        run[1 + k] = entries[k].run;
    }
    few->bodies.count = 1 + found;
    return found;
}

narc_body turn_about(narc_body body, double x, double y, double angle) {
    const double c = cos(angle), s = sin(angle), way_x = body.x - x, way_y = body.y - y;
    return (narc_body){x + c * way_x - s * way_y, y + s * way_x + c * way_y, (float)c, (float)s, 1, body.shape};
}
