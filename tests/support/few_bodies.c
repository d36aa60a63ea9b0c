/* SPDX-License-Identifier: MIT
 *
 * few_bodies.c - contacts that stay, of some bodies that a test puts where it wants them.
 */
#include "few_bodies.h"

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
