/* SPDX-License-Identifier: MIT
 *
 * pair.c - narc_find_contact() and narc_find_manifold(): a batch of one pair, without what a batch needs.
 *
 * The scalar kernels answer, whatever the instruction set: with one lane in use a vector takes twice to three times as
 * long. The bits are the same.
 */
#include "dispatch.h"
#include "error.h"

#include <math.h>

/* Two bodies as a batch takes them. A's position is the origin: B's is subtracted in double precision, as those of a
 * batch are, and the difference of the rounded ones is the rounded difference. */
struct two_bodies {
    struct {
        float x, y, cosine, sine, scale;
        uint32_t shape;
    } body[2];
    uint32_t index[2];
    narc_bodies bodies;
    narc_pairs pairs;
};

/* The rotation of a body that names an angle instead of its cosine and sine. */
static narc_status find_rotation(const narc_body *body, float *out_cosine, float *out_sine, narc_error *error) {
    *out_cosine = body->cosine;
    *out_sine = body->sine;
    if (body->cosine != 0 || body->sine != 0)
        return NARC_OK;
    *out_cosine = 1;
    return body->angle == 0 ? NARC_OK : narc_compute_poses(&body->angle, 1, out_cosine, out_sine, error);
}

static narc_status place_bodies(const narc_shapes *shapes, const narc_body *a, const narc_body *b,
                                struct two_bodies *out, narc_error *error) {
    if (!shapes || !a || !b)
        return narc_fail_missing(error, !shapes ? "shapes" : !a ? "a" : "b");
    const narc_body *const body[2] = {a, b};
    for (uint32_t k = 0; k < 2; k++) {
        out->index[k] = k;
        out->body[k].x = k == 0 ? 0 : (float)(b->x - a->x);
        out->body[k].y = k == 0 ? 0 : (float)(b->y - a->y);
        out->body[k].scale = body[k]->scale == 0 ? 1 : body[k]->scale;
        out->body[k].shape = body[k]->shape;
        const narc_status status = find_rotation(body[k], &out->body[k].cosine, &out->body[k].sine, error);
        if (status != NARC_OK)
            return status;
    }
    out->bodies = (narc_bodies){.count = 2,
                                .x = NARC_POSITION_COLUMN(out->body, x),
                                .y = NARC_POSITION_COLUMN(out->body, y),
                                .cosine = NARC_COLUMN(out->body, cosine),
                                .sine = NARC_COLUMN(out->body, sine),
                                .scale = NARC_COLUMN(out->body, scale),
                                .shape = NARC_COLUMN(out->body, shape)};
    out->pairs = (narc_pairs){.count = 1, .a = {&out->index[0], 0}, .b = {&out->index[1], 0}};
    return NARC_OK;
}

/* Why the kernels take a pair of bodies for broken. NARC_OK: it is not, but too far apart. */
static narc_status find_fault(const narc_shapes *shapes, const struct two_bodies *two, const narc_body *a,
                              const narc_body *b, narc_error *error) {
    const double x[2] = {a->x, b->x}, y[2] = {a->y, b->y};
    narc_bodies bodies = two->bodies;
    bodies.x = NARC_POSITION_ARRAY(x);
    bodies.y = NARC_POSITION_ARRAY(y);
    return narc_validate_bodies(shapes, &bodies, error);
}

narc_status narc_find_contact(const narc_shapes *shapes, const narc_body *a, const narc_body *b,
                              narc_contact *out_contact, narc_error *error) {
    struct two_bodies two;
    narc_status status = place_bodies(shapes, a, b, &two, error);
    if (status != NARC_OK)
        return status;
    if (!out_contact)
        return narc_fail_missing(error, "out_contact");
    if (a->shape >= narc_count_shapes(shapes) || b->shape >= narc_count_shapes(shapes))
        return find_fault(shapes, &two, a, b, error);
    size_t skipped = 0;
    narc_contact contact = {0};
    const narc_batch batch = {.shapes = shapes, .bodies = &two.bodies, .pairs = &two.pairs, .skipped = &skipped};
    const narc_contacts list = {.capacity = 1,
                                .separation = &contact.separation,
                                .normal_x = &contact.normal_x,
                                .normal_y = &contact.normal_y,
                                .point_x = &contact.point_x,
                                .point_y = &contact.point_y,
                                .arc_a = &contact.arc_a,
                                .arc_b = &contact.arc_b};
    narc_kernels_scalar.contact(&batch, 0, 1, INFINITY, &list);
    if (skipped > 0)
        status = find_fault(shapes, &two, a, b, error);
    if (status == NARC_OK)
        *out_contact = contact;
    return status;
}

narc_status narc_find_manifold(const narc_shapes *shapes, const narc_body *a, const narc_body *b,
                               const narc_manifold_options *options, narc_manifold *out_manifold, narc_error *error) {
    static const narc_manifold_options defaults = {0};
    const narc_manifold_options *const o = options ? options : &defaults;
    struct two_bodies two;
    size_t skipped = 0;
    narc_manifold m = {0};
    narc_batch batch = {
        .shapes = shapes, .bodies = &two.bodies, .pairs = &two.pairs, .hints = o->hints, .skipped = &skipped};
    narc_status status = place_bodies(shapes, a, b, &two, error);
    if (status == NARC_OK)
        status = narc_read_manifold_options(o, &batch, error);
    if (status != NARC_OK)
        return status;
    if (!out_manifold)
        return narc_fail_missing(error, "out_manifold");
    if (a->shape >= narc_count_shapes(shapes) || b->shape >= narc_count_shapes(shapes))
        return find_fault(shapes, &two, a, b, error);
    const narc_manifolds list = {.capacity = 1,
                                 .point_count = &m.point_count,
                                 .normal_x = &m.normal_x,
                                 .normal_y = &m.normal_y,
                                 .separation = {&m.separation[0], &m.separation[1]},
                                 .point_x = {&m.point_x[0], &m.point_x[1]},
                                 .point_y = {&m.point_y[0], &m.point_y[1]},
                                 .feature = {&m.feature[0], &m.feature[1]},
                                 .radius_a = {&m.radius_a[0], &m.radius_a[1]},
                                 .radius_b = {&m.radius_b[0], &m.radius_b[1]}};
    narc_kernels_scalar.manifold(&batch, 0, 1, o->margin, &list);
    if (skipped > 0)
        status = find_fault(shapes, &two, a, b, error);
    if (status != NARC_OK)
        return status;
    if (o->out_skipped)
        *o->out_skipped = skipped;
    *out_manifold = m;
    return NARC_OK;
}
