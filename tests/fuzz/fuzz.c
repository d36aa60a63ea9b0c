/* SPDX-License-Identifier: MIT
 *
 * fuzz.c - a fuzzer's bytes as numbers, shapes and bodies.
 */
#include "fuzz.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "narc.h"

unsigned take_byte(struct bytes *from) {
    if (from->left == 0)
        return 0;
    from->left--;
    return *from->next++;
}

uint32_t take_word(struct bytes *from) {
    uint32_t word = 0;
    for (int k = 0; k < 4; k++)
        word = word << 8 | take_byte(from);
    return word;
}

unsigned take_below(struct bytes *from, unsigned limit) { return take_byte(from) % limit; }

float take_any(struct bytes *from) {
    const uint32_t bits = take_word(from);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

double take_number(struct bytes *from, double size) {
    const unsigned kind = take_byte(from);
    if (kind < 120)
        return size * ((double)take_byte(from) - 128) / 128;
    return kind < 240 ? size * ((double)take_word(from) / 0x1p31 - 1) : (double)take_any(from);
}

/* Points around the origin, so that many rings of them are convex. */
static size_t take_ring(struct bytes *from, narc_point *points) {
    const size_t count = 3 + take_below(from, 10);
    for (size_t k = 0; k < count; k++) {
        const double angle = 6.28318530717958648 * ((double)k + take_number(from, 0.5)) / (double)count;
        const double away = 1 + take_number(from, 0.25);
        points[k] = (narc_point){away * cos(angle), away * sin(angle)};
    }
    return count;
}

static narc_status build_shape(struct bytes *from, struct shape *shape) {
    narc_point ring[16];
    narc_arc *const arcs = shape->arcs;
    size_t *const count = &shape->count;
    const unsigned kind = take_below(from, 12);
    const double a = 1 + take_number(from, 1), b = 1 + take_number(from, 1), radius = 0.25 + take_number(from, 0.25);
    switch (kind) {
    case 0:
        return narc_build_capsule(a, b, arcs, count, NULL);
    case 1:
        return narc_build_segment(&(narc_point){a, b}, &(narc_point){-b, a}, radius, arcs, count, NULL);
    case 2:
    case 3:
        return narc_build_box(a, b, kind == 2 ? 0 : radius, arcs, count, NULL);
    case 4:
        return narc_build_ellipse(a, b, 4 + 4 * (size_t)take_below(from, 4), arcs, count, NULL, NULL);
    case 5:
        return narc_build_four_arc(&(narc_four_arc){4 * a, 4 * b, 2 * (a + b), radius, radius / 2}, arcs, count, NULL);
    case 6:
        return narc_build_regular_polygon(3 + take_below(from, 62), a, radius, arcs, count, NULL);
    case 7:
    case 8:
        return narc_build_polygon(ring, take_ring(from, ring), kind == 7 ? 0 : radius, arcs, count, NULL);
    case 9:
        return narc_build_skin_polygon(ring, take_ring(from, ring), radius, arcs, count, NULL);
    case 10:
        return narc_build_ring(ring, take_ring(from, ring), arcs, count, NULL);
    default: /* arcs as they come */
        *count = 1 + take_below(from, 5);
        for (size_t k = 0; k < *count; k++)
            arcs[k] = (narc_arc){take_number(from, 2), take_number(from, 2), fabs(take_number(from, 2)),
                                 take_number(from, 3.25), take_number(from, 3.25)};
        return narc_validate_arcs(arcs, *count, NULL);
    }
}

struct shape take_shape(struct bytes *from) {
    struct shape shape;
    if (build_shape(from, &shape) != NARC_OK)
        shape = circle_of(1);
    assert_int_equal(narc_validate_arcs(shape.arcs, shape.count, NULL), NARC_OK);
    return shape;
}

static void take_body(struct bytes *from, struct scene *scene) {
    const unsigned kind = take_byte(from);
    const double angle = take_number(from, 3.25);
    struct body body = turned_body(kind & 1 && isfinite(angle) ? angle : 0, kind & 2 ? 1 + take_number(from, 0.75) : 1);
    body.x = take_number(from, 4);
    body.y = take_number(from, 4);
    body.shape = take_below(from, (unsigned)scene->shape_count);
    if (kind >> 5 == 7)
        *(take_below(from, 2) ? &body.cosine : &body.scale) = take_any(from);
    scene_add_body(scene, body);
}

struct scene take_scene(struct bytes *from, size_t shapes, size_t bodies, size_t pairs) {
    struct scene scene = create_scene(take_below(from, 2) ? NARC_FLOAT64 : NARC_FLOAT32, shapes, bodies, pairs);
    for (size_t k = 0; k < shapes; k++) {
        const struct shape shape = take_shape(from);
        scene_add_shape(&scene, &shape);
    }
    for (size_t k = 0; k < bodies; k++)
        take_body(from, &scene);
    for (size_t k = 0; k < pairs; k++)
        scene_add_pair(&scene, (uint32_t)(k % bodies), (uint32_t)((k + 1 + k / bodies) % bodies));
    return scene;
}

void take_flights(struct bytes *from, struct scene *scene) {
    for (unsigned flights = take_below(from, 4); flights > 0; flights--) {
        struct body *const body = &scene->bodies[take_below(from, (unsigned)scene->body_count)];
        *body = fly_away(*body, take_below(from, 24), scene->precision);
    }
}
